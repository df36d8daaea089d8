#include "sinew/sim/step.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

#include "support/scenes.hpp"

namespace sinew {
namespace {

using test::mm;

TEST(Step, is_a_function_of_its_arguments_to_the_last_bit) {
  const Model model = build(test::cable_block(), test::read_block);
  Workspace used = make_workspace(model);
  State state = initial_state(model);
  for (int i = 0; i < 5; ++i) {
    const Command command = command_at(model, state.time + 0.01);
    const StepResult a = step(model, used, command, state, 0.01);
    Workspace other = make_workspace(model);
    const StepResult b = step(model, other, command, state, 0.01);
    ASSERT_EQ(a.report.status, Status::converged);
    EXPECT_EQ(pack(a.next), pack(b.next));
    state = a.next;
  }
}

/// Where this has to change, kStateLayout has to be raised.
TEST(State, is_packed_in_the_order_that_its_layout_names) {
  ASSERT_EQ(kStateLayout, 9u);
  double next = 0.0;
  const auto number = [&next] { return next += 1.0; };
  const auto fill = [&](auto& array, int rows, int columns) {
    array.resize(rows, columns);
    for (double& value : array.reshaped()) value = number();
  };
  State state;
  state.grid = static_cast<long>(number());
  number();  // contacts
  state.halvings = static_cast<int>(number());
  state.spent = static_cast<int>(number());
  state.points.push_back({0.0, 0.0, true});
  number();  // on
  state.path.stable = true;
  number();
  state.time = number();
  SolidState& solid = state.solids.emplace_back();
  fill(solid.x, 3, 2);
  fill(solid.v, 3, 2);
  fill(solid.reaction, 2, 1);
  RodState& rod = state.rods.emplace_back();
  fill(rod.q, 2, 1);
  for (double& value : rod.turned.reshaped()) value = number();
  fill(rod.masses, 3, 1);
  fill(rod.velocity, 3, 1);
  fill(rod.q_rate, 2, 1);
  fill(rod.internal, 2, 2);
  fill(state.cables.emplace_back().z, 2, 1);
  rigid::Motion& body = state.bodies.emplace_back();
  for (double& value : body.p) value = number();
  for (double& value : body.R.reshaped()) value = number();
  for (Vec3* three : {&body.v, &body.w}) {
    for (double& value : *three) value = number();
  }
  state.points[0].s = number();
  state.points[0].friction = number();
  fill(state.followed, 2, 1);
  fill(state.lambda, 2, 1);
  state.actuators = {number()};
  state.loads = {number()};
  state.energies.work = number();
  state.energies.work_bound = number();
  for (double* value : {&state.path.step, &state.path.rate}) *value = number();
  state.path.count = number();
  state.path.farthest = number();
  state.path.work = number();
  state.path.work_at_farthest = number();
  fill(state.path.direction, 2, 1);
  state.frequency = number();
  ContactState& contact = state.contacts.emplace_back();
  contact.pair = static_cast<int>(number());
  contact.part = static_cast<std::uint64_t>(number());
  contact.on_second = true;
  const auto on_second = static_cast<std::size_t>(number()) - 1;
  for (Vec3* three : {&contact.force, &contact.point, &contact.normal}) {
    for (double& value : *three) value = number();
  }
  contact.gap = number();
  contact.slip = number();
  std::vector<double> expected(static_cast<std::size_t>(next));
  std::iota(expected.begin(), expected.end(), 1.0);
  expected[1] = expected[4] = expected[5] = expected[on_second] = 1.0;  // contacts, on, stable
  EXPECT_EQ(pack(state), expected);
}

TEST(Step, ends_where_it_does_wherever_velocities_would_lead) {
  const Model model = build(test::cable_block(), test::read_block);
  Workspace workspace = make_workspace(model);
  State state = initial_state(model);
  constexpr double kStep = 0.002;
  int moved_on = 0, stayed = 0;
  for (int i = 0; i < 20; ++i) {
    const Command command = command_at(model, state.time + kStep);
    const auto made_with = [&](double factor) {
      State start = state;
      start.rods[0].q_rate *= factor;
      return step(model, workspace, command, start, kStep);
    };
    const StepResult made = made_with(1.0), lost = made_with(1e6);
    ASSERT_EQ(made.report.status, Status::converged);
    ASSERT_EQ(lost.report.status, Status::converged);
    if (i > 0) {
      EXPECT_GT(lost.report.newton, made.report.newton);
    }
    EXPECT_LT((lost.next.solids[0].x - made.next.solids[0].x).norm(), 1e-8);
    EXPECT_LT((lost.next.rods[0].q - made.next.rods[0].q).norm(), 1e-5);
    moved_on += made.report.newton;
    State start = state;
    start.rods[0].q_rate.setZero();
    stayed += step(model, workspace, command, start, kStep).report.newton;
    state = made.next;
  }
  EXPECT_LT(moved_on, stayed);
}

TEST(Step, leaving_out_the_last_evaluation_changes_no_motion) {
  Scene scene = test::cable_block();
  scene.newton.iterations = 1;
  const Model model = build(scene, test::read_block);
  Workspace whole = make_workspace(model), half = make_workspace(model);
  State full = initial_state(model), motion = full;
  for (int i = 0; i < 5; ++i) {
    ASSERT_TRUE(accepted(advance(model, whole, full).status));
    ASSERT_TRUE(accepted(advance(model, half, motion, {Evaluation::motion}).status));
    EXPECT_EQ(motion.solids[0].x, full.solids[0].x);
    EXPECT_EQ(motion.solids[0].v, full.solids[0].v);
    EXPECT_EQ(motion.rods[0].q, full.rods[0].q);
    EXPECT_EQ(motion.rods[0].masses, full.rods[0].masses);
    EXPECT_EQ(motion.rods[0].velocity, full.rods[0].velocity);
    EXPECT_EQ(motion.lambda, full.lambda);
    EXPECT_EQ(motion.actuators, full.actuators);
    EXPECT_EQ(motion.time, full.time);
  }
  EXPECT_GT(full.lambda.norm(), 0.0);
}

TEST(Step, whoever_steps_can_have_it_converge_whatever_the_scene_says) {
  Scene scene = test::cable_block();
  scene.newton.iterations = 1;
  for (const Analysis analysis : {Analysis::dynamic, Analysis::quasi_static}) {
    scene.analysis = analysis;
    Scene same = scene;
    same.newton.iterations = 0;
    const Model once = build(scene, test::read_block), converged = build(same, test::read_block);
    Workspace a = make_workspace(once), b = make_workspace(converged);
    State x = initial_state(once), y = initial_state(converged);
    for (int i = 0; i < 3; ++i) {
      EXPECT_EQ(advance(once, a, x, {.converged = true}).status, Status::converged);
      ASSERT_EQ(advance(converged, b, y).status, Status::converged);
      EXPECT_EQ(pack(x), pack(y));
    }
    EXPECT_EQ(advance(once, a, x).status, Status::linearized);
  }
}

TEST(Step, packing_and_unpacking_gives_the_same_state_and_continuation) {
  const Model model = build(test::cable_block(), test::read_block);
  const test::Trace trace = test::run_all(model);
  ASSERT_EQ(trace.end, RunEnd::done);
  State middle = unpack(model, pack(trace.states[7]));
  EXPECT_EQ(pack(middle), pack(trace.states[7]));
  Workspace workspace = make_workspace(model);
  ASSERT_TRUE(accepted(advance(model, workspace, middle).status));
  EXPECT_EQ(pack(middle), pack(trace.states[8]));
  EXPECT_THROW(unpack(model, {1.0, 2.0}), std::invalid_argument);
}

TEST(Step, pull_is_met_exactly_and_the_cable_stays_in_its_points) {
  const Model model = build(test::cable_block(), test::read_block);
  const test::Trace trace = test::run_all(model);
  ASSERT_EQ(trace.end, RunEnd::done);
  EXPECT_NEAR(trace.states.back().rods[0].q[0], 2 * mm, 1e-12);
  EXPECT_GT(trace.states.back().actuators[0], 0.1);
  EXPECT_GT(test::tip(model, trace.states.back()).z() - 5 * mm, 3 * mm);  // bends towards the cable's side
  for (const StepReport& report : trace.reports) EXPECT_LT(report.violation, 1e-10);
}

TEST(Step, power_of_the_motor_goes_into_the_body) {
  // Pulled slowly, the work of the motor is the elastic energy of block and cable, up to damping and the integrator.
  Scene scene = test::cable_block(2 * mm, 0.002);
  scene.time = {0.01, 1.2};
  scene.solids[0].second.rayleigh = {0.0, 0.002};
  const Model model = build(scene, test::read_block);
  const test::Trace trace = test::run_all(model);
  ASSERT_EQ(trace.end, RunEnd::done);
  double work = 0.0;
  for (std::size_t i = 1; i < trace.states.size(); ++i) {
    const double rate = trace.states[i].rods[0].q[0] - trace.states[i - 1].rods[0].q[0];
    work += 0.5 * (trace.states[i].actuators[0] + trace.states[i - 1].actuators[0]) * rate;
  }
  const State& last = trace.states.back();
  double stored = solid::elastic_energy(model.solids[0].body, last.solids[0].x);
  const rod::Rod& rod = model.rods[0].rod;
  for (int i = 0; i < rod.count(); ++i) {
    const Eigen::VectorXd q = rod.of_section(last.rods[0].q, i);
    stored += 0.5 * q.dot(rod.sections[i].stiffness * q);
  }
  EXPECT_GT(work, 1e-5);
  EXPECT_NEAR(stored, work, 0.03 * work);
}

TEST(Step, forces_of_the_motor_and_of_the_clamp_balance) {
  // At rest what the cable does to the solid is what the motor does to the cable: multipliers are forces [N].
  Scene scene = test::cable_block();
  scene.time.duration = 2.0;
  const Model model = build(scene, test::read_block);
  const test::Trace trace = test::run_all(model);
  Vec3 total = Vec3::Zero();
  for (const PointModel& point : model.points) total += trace.states.back().lambda.segment<3>(point.row);
  const double motor = trace.states.back().actuators[0];
  EXPECT_GT(motor, 0.1);
  EXPECT_NEAR(total.x(), -motor, 1e-6 * motor);  // the base pulls out along -x, the tip is pulled towards it
}

TEST(Step, force_driven_and_displacement_driven_agree) {
  Scene scene = test::cable_block();
  scene.time.duration = 2.0;
  const Model by_displacement = build(scene, test::read_block);
  const test::Trace a = test::run_all(by_displacement);
  scene.actuators[0].second.driven = Driven::force;
  scene.actuators[0].second.drive = Table{{0.0}, {a.states.back().actuators[0]}};
  const Model by_force = build(scene, test::read_block);
  const test::Trace b = test::run_all(by_force);
  ASSERT_EQ(b.end, RunEnd::done);
  EXPECT_NEAR(b.states.back().rods[0].q[0], 2 * mm, 1e-8);
  EXPECT_LT((test::tip(by_displacement, a.states.back()) - test::tip(by_force, b.states.back())).norm(), 1e-8);
}

TEST(Step, multipliers_are_forces_whatever_the_time_step) {
  std::vector<double> force;
  for (double h : {0.02, 0.005}) {
    Scene scene = test::cable_block();
    scene.time = {h, 2.0};
    const Model model = build(scene, test::read_block);
    force.push_back(test::run_all(model).states.back().actuators[0]);
  }
  EXPECT_NEAR(force[0], force[1], 1e-6 * force[0]);
}

TEST(Step, newton_converges_quadratically_with_the_exact_tangent) {
  // The residual after n linearisations of one large step: its logarithm at least doubles near the end.
  std::vector<double> residual;
  for (int n = 1; n <= 6; ++n) {
    Scene scene = test::cable_block(2 * mm, 0.2);
    scene.newton.limit = n;
    scene.newton.tolerance = 1e-30;  // never met
    const Model model = build(scene, test::read_block);
    Workspace workspace = make_workspace(model);
    const StepReport report = step(model, workspace, command_at(model, 0.01), initial_state(model), 0.01).report;
    EXPECT_EQ(report.status, Status::max_iterations);
    EXPECT_EQ(report.newton, n);
    residual.push_back(report.residual);
  }
  bool seen = false;
  for (std::size_t i = 1; i + 1 < residual.size(); ++i) {
    if (residual[i] < 1e-2 && residual[i + 1] > 1e-13) {
      EXPECT_GT(std::log(residual[i + 1]) / std::log(residual[i]), 1.7) << i;
      seen = true;
    }
  }
  EXPECT_TRUE(seen);
  EXPECT_LT(residual.back(), 1e-11);
}

TEST(Step, one_linearisation_is_a_first_order_predictor_of_the_converged_step) {
  std::vector<double> gap;
  for (double h : {0.02, 0.01, 0.005}) {
    Scene scene = test::cable_block(4 * mm, 0.02);
    scene.time = {h, 0.2};
    const Model converged = build(scene, test::read_block);
    scene.newton.iterations = 1;
    const Model linearized = build(scene, test::read_block);
    const test::Trace a = test::run_all(converged), b = test::run_all(linearized);
    EXPECT_EQ(b.reports.back().status, Status::linearized);
    EXPECT_EQ(b.reports.back().newton, 1);
    gap.push_back((test::tip(converged, a.states.back()) - test::tip(linearized, b.states.back())).norm());
  }
  EXPECT_GT(gap[0], 1e-7);
  EXPECT_LT(gap[1], 0.7 * gap[0]);
  EXPECT_LT(gap[2], 0.7 * gap[1]);
}

TEST(Step, geometric_cable_bends_like_a_rod_that_hardly_resists) {
  Scene scene = test::cable_block();
  scene.time.duration = 1.5;
  scene.rods[0].second.section = Circle{0.05 * mm};
  const Model thin = build(scene, test::read_block);
  scene.rods[0].second.cable = Cable::geometric;
  const Model geometric = build(scene, test::read_block);
  const test::Trace a = test::run_all(thin), b = test::run_all(geometric);
  ASSERT_EQ(a.end, RunEnd::done);
  ASSERT_EQ(b.end, RunEnd::done);
  const Vec3 rest = test::tip(thin, a.states.front());
  const double travel = (test::tip(thin, a.states.back()) - rest).norm();
  EXPECT_LT((test::tip(thin, a.states.back()) - test::tip(geometric, b.states.back())).norm(), 0.02 * travel);
  EXPECT_NEAR(a.states.back().actuators[0], b.states.back().actuators[0], 0.02 * b.states.back().actuators[0]);
  const double tension = b.states.back().lambda[geometric.cables[0].length_row];
  EXPECT_NEAR(tension, b.states.back().actuators[0], 1e-3 * tension);
}

TEST(Step, geometric_cable_along_a_curved_path_starts_at_rest) {
  Scene scene = test::cable_block(1 * mm, 0.01);
  Rod& rod = scene.rods[0].second;
  rod.cable = Cable::geometric;
  rod.path = {Vec3(0, 5 * mm, 3 * mm), Vec3(20 * mm, 5 * mm, 8 * mm), Vec3(40 * mm, 5 * mm, 3 * mm),
              Vec3(60 * mm, 5 * mm, 8 * mm)};
  Slide first = test::slide(scene, 0);
  first.anchor_tip = AnchorTip::position;
  first.points = std::vector<double>{45 * mm, build(scene, test::read_block).points.back().abscissa};
  scene.couplings = {first};
  const Model model = build(scene, test::read_block);
  State state = initial_state(model);
  Workspace workspace = make_workspace(model);
  const StepResult still = step(model, workspace, {{0.0}, {}}, state, 0.01);
  ASSERT_EQ(still.report.status, Status::converged);
  EXPECT_LT((test::tip(model, still.next) - test::tip(model, state)).norm(), 1e-12);
  const test::Trace trace = test::run_all(model);
  ASSERT_EQ(trace.end, RunEnd::done);
  EXPECT_GT(trace.states.back().actuators[0], 0.01);
}

TEST(Step, turning_the_base_of_a_straight_round_cable_costs_nothing) {
  // Anchored by position only, the cable's tip is free to turn.
  Scene scene = test::cable_block();
  scene.actuators.clear();
  Actuator twist;
  twist.rod = "cable";
  twist.motion = Motion::rotation;
  twist.driven = Driven::angle;
  twist.drive = Table{{0.0, 0.1}, {0.0, 1.0}};
  scene.actuators.emplace_back("twist", twist);
  scene.rods[0].second.material.density = 0.0;
  const Model model = build(scene, test::read_block);
  const test::Trace trace = test::run_all(model);
  ASSERT_EQ(trace.end, RunEnd::done);
  EXPECT_NEAR(trace.states.back().rods[0].q[0], 1.0, 1e-12);
  EXPECT_NEAR(trace.states.back().actuators[0], 0.0, 1e-9);
}

TEST(Step, a_moving_frame_carries_everything_attached_to_it) {
  Scene scene = test::cable_block();
  scene.actuators[0].second.drive = Table{{0.0}, {0.0}};
  FrameMotion motion;
  motion.times = {0.0, 0.1};
  motion.rotate = {Vec3::Zero(), Vec3(0.2, -0.1, 0.5)};
  motion.translate = {Vec3::Zero(), Vec3(0.02, 0.01, -0.03)};
  scene.frames.emplace_back("hand", Frame{{Vec3(0.1, 0.2, 0.3), Vec3(0.5, 0, 0)}, motion});
  scene.solids[0].second.frame = "hand";
  scene.rods[0].second.frame = "hand";
  scene.time.duration = 3.0;
  const Model model = build(scene, test::read_block);
  const test::Trace trace = test::run_all(model);
  ASSERT_EQ(trace.end, RunEnd::done) << to_string(trace.failure.status);
  for (const StepReport& report : trace.reports) EXPECT_FALSE(report.redundant);
  const Placement moved = frame_displacement(model.scene.frames[0].second, 3.0);
  EXPECT_GT((apply(moved, test::tip(model, trace.states.front())) - test::tip(model, trace.states.front())).norm(),
            0.1);
  EXPECT_LT((apply(moved, test::tip(model, trace.states.front())) - test::tip(model, trace.states.back())).norm(),
            1e-7);
  for (int i = 0; i < model.solids[0].body.nodes(); ++i) {
    if (model.solids[0].body.unknown(0, i) >= 0) continue;
    EXPECT_LT((trace.states.back().solids[0].x.col(i) - apply(moved, model.solids[0].body.rest.col(i))).norm(), 1e-15);
  }
}

TEST(Step, a_free_tip_leaves_points_behind_and_finds_them_again) {
  // Pulled out 25 mm of 60, the rod leaves the points near its old tip; pushed back, it meets them again.
  Scene scene = test::cable_block();
  test::slide(scene, 0).anchor_tip = AnchorTip::none;
  scene.actuators[0].second.drive = Table{{0.0, 0.5, 1.0}, {0.0, 25 * mm, 0.0}};
  scene.time = {0.01, 1.0};
  scene.rods[0].second.material.density = 0.0;
  const Model model = build(scene, test::read_block);
  const test::Trace trace = test::run_all(model);
  ASSERT_EQ(trace.end, RunEnd::done) << to_string(trace.failure.status);
  const auto on = [](const State& state) {
    return std::count_if(state.points.begin(), state.points.end(), [](const auto& p) { return p.on; });
  };
  EXPECT_EQ(on(trace.states[0]), 5);   // of 0, 12, .. 60 mm; the first sits in the clamp and was dropped
  EXPECT_EQ(on(trace.states[50]), 2);  // 12 and 24 mm remain
  EXPECT_GE(on(trace.states[100]), 4);
}

TEST(Step, a_tip_that_stops_before_a_point_stays_on_it) {
  // Within the fifth step the motor stops 1.1 mm before the tip leaves the point at 48 mm, which its velocity would.
  Scene scene = test::cable_block();
  test::slide(scene, 0).anchor_tip = AnchorTip::none;
  scene.actuators[0].second.drive = Table{{0.0, 10.9 / 260.0, 0.1}, {0.0, 10.9 * mm, 10.9 * mm}};
  scene.time = {0.01, 0.08};
  scene.rods[0].second.material.density = 0.0;
  const Model model = build(scene, test::read_block);
  const test::Trace trace = test::run_all(model);
  ASSERT_EQ(trace.end, RunEnd::done) << to_string(trace.failure.status);
  for (std::size_t i = 4; i < trace.states.size(); ++i) {
    const State& state = trace.states[i];
    EXPECT_EQ(std::count_if(state.points.begin(), state.points.end(), [](const auto& p) { return p.on; }), 4) << i;
  }
}

// Each way to fail, provoked.

}  // namespace
}  // namespace sinew
