#include "sinew/sim/reduced.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>

#include "sinew/error/input_error.hpp"
#include "support/difference.hpp"
#include "support/scenes.hpp"

namespace sinew {
namespace {

solve::CoupledProblem linearized(const StepContext& context, const State& iterate) {
  Reduced reduced;
  linearize(context, iterate, {}, reduced);
  return std::move(reduced.problem);
}

/// Everything the coupled problem is linear in, as one vector: the unknowns in the order of written_out().
solve::CoupledSolution unit(const solve::CoupledProblem& problem, Eigen::Index at) {
  solve::CoupledSolution u;
  u.dz.setZero(problem.r.size());
  u.dlambda.setZero(problem.c.size());
  for (const auto& part : problem.chains) u.dq.emplace_back(Eigen::VectorXd::Zero(part.r.size()));
  if (at < u.dz.size()) {
    u.dz[at] = 1.0;
    return u;
  }
  at -= u.dz.size();
  if (at < u.dlambda.size()) {
    u.dlambda[at] = 1.0;
    return u;
  }
  at -= u.dlambda.size();
  for (auto& dq : u.dq) {
    if (at < dq.size()) {
      dq[at] = 1.0;
      return u;
    }
    at -= dq.size();
  }
  return u;
}

Eigen::VectorXd right(const solve::CoupledProblem& problem) {
  Eigen::Index size = problem.r.size() + problem.c.size();
  for (const auto& part : problem.chains) size += part.r.size();
  Eigen::VectorXd b(size);
  b.head(problem.r.size()) = -problem.r;
  b.segment(problem.r.size(), problem.c.size()) = problem.c;
  Eigen::Index at = problem.r.size() + problem.c.size();
  for (const auto& part : problem.chains) {
    b.segment(at, part.r.size()) = -part.r;
    at += part.r.size();
  }
  return b;
}

/// A state in the middle of things: bent rods, points off the section edges and off the rod, multipliers of order one.
State busy_state(const Model& model, double size) {
  State state = initial_state(model);
  for (std::size_t r = 0; r < state.rods.size(); ++r) {
    for (int i = 0; i < state.rods[r].q.size(); ++i)
      state.rods[r].q[i] += size * std::cos(1.3 * i + 0.4 * static_cast<double>(r));
    for (int i = 0; i < model.rods[r].rod.base_coordinates(); ++i)
      state.rods[r].q[i] = (model.rods[r].rod.base[i].turns ? 0.1 : 1e-3) * (1 + i);
  }
  for (auto& cable : state.cables) {
    for (int i = 0; i < cable.z.size(); ++i) cable.z[i] += 1e-3 * std::cos(1.3 * i);
  }
  for (std::size_t k = 0; k < state.points.size(); ++k) {
    if (model.points[k].unknown >= 0) state.points[k].s += 1.3e-3;
  }
  for (int i = 0; i < state.lambda.size(); ++i) state.lambda[i] = std::cos(1.0 + 0.7 * i);
  for (int i = 0; i < state.followed.size(); ++i) state.followed[i] += 1e-3 * std::sin(2.0 * i);
  return state;
}

/// The whole matrix against central differences of the right side, column by column: they differ by ten orders of
/// magnitude (elongation, bending, abscissae).
void expect_exact_tangent(const Model& model, double size) {
  const State start = initial_state(model);
  Command command = command_at(model, 0.01);
  for (double& load : command.loads) load = 1.0;
  const StepContext context = make_context(model, start, command, 0.01);
  const State state = busy_state(model, size);
  const solve::CoupledProblem problem = linearized(context, state);
  const Eigen::MatrixXd K = written_out(problem);
  Eigen::MatrixXd D(K.rows(), K.cols());
  for (Eigen::Index j = 0; j < K.cols(); ++j) {
    const double e = 1e-6;
    State plus = state, minus = state;
    advance_reduced(context, unit(problem, j), e, plus);
    advance_reduced(context, unit(problem, j), -e, minus);
    D.col(j) = (right(linearized(context, minus)) - right(linearized(context, plus))) / (2 * e);
  }
  EXPECT_GT(D.norm(), 1e-3);
  for (Eigen::Index j = 0; j < K.cols(); ++j)
    EXPECT_LT((K.col(j) - D.col(j)).norm(), 1e-6 * D.col(j).norm() + 3e-8) << "column " << j << " of " << K.cols();
}

class Tangent : public testing::TestWithParam<std::tuple<bool, double>> {};

TEST_P(Tangent, matches_finite_differences) {
  const auto [geometric, size] = GetParam();
  Scene scene = test::cable_block();
  scene.gravity = Vec3(0, 0, -9.81);
  Rod& rod = scene.rods[0].second;
  rod.strains = {Strain::torsion,    Strain::bending_y, Strain::bending_z,
                 Strain::elongation, Strain::shear_y,   Strain::shear_z};
  if (size > 1.0) rod.strains.resize(3);  // 10 1/m of curvature; elongation of that size is none
  if (geometric) rod.cable = Cable::geometric;
  const Model model = build(scene, test::read_block);
  expect_exact_tangent(model, size);
  // The curvature of the multipliers along the curve is there, and is not nothing.
  if (!geometric && size > 1.0) {
    const State start = initial_state(model);
    const auto problem = linearized(make_context(model, start, command_at(model, 0.01), 0.01), busy_state(model, size));
    double along = 0.0;
    for (const PointModel& point : model.points) {
      for (const auto& entry : problem.B)
        if (entry.row == point.unknown && entry.column == point.unknown) along = std::max(along, std::abs(entry.value));
    }
    EXPECT_GT(along, 1.0);
  }
}

INSTANTIATE_TEST_SUITE_P(Reduced, Tangent,
                         testing::Combine(testing::Bool(), testing::Values(0.0, 1e-8, 1e-5, 0.1, 10.0)));

/// Two soft rods side by side, varying strains, tendons, loads of every kind, and ties of every kind.
Scene everything(Coupling tie) {
  Scene scene;
  scene.time.step = 0.01;
  scene.gravity = Vec3(0.3, 0, -9.81);
  for (const char* name : {"a", "b"}) {
    Rod rod;
    const double y = name[0] == 'a' ? 0.0 : 0.05;
    rod.path = {Vec3(0, y, 0), Vec3(0.3, y, 0.02)};
    rod.sections = 3;
    rod.strains = {Strain::torsion, Strain::bending_y, Strain::bending_z, Strain::elongation};
    rod.order = {1, 2, 0, 0, 0, 0};
    rod.section = Circle{Taper(10e-3, 6e-3)};
    rod.material = {1e6, 0.45, 1000.0, 20.0, 1e-3};
    rod.base = {BaseAxis::y, BaseAxis::turn_x, BaseAxis::turn_z};
    scene.rods.emplace_back(name, rod);
  }
  Actuator tendon;
  tendon.rod = "a";
  tendon.tendon = Tendon{0.02, 0.28, Taper(8e-3, 5e-3), Taper(0.3, 4.0)};
  tendon.drive = Table{{0.0}, {1e-3}};
  scene.actuators.emplace_back("drawn", tendon);
  tendon.driven = Driven::force;
  tendon.drive = Table{{0.0}, {2.0}};
  scene.actuators.emplace_back("pulled", tendon);
  RodLoad load;
  load.rod = "b";
  load.force = Vec3(0.1, -0.2, 0.3);
  load.moment = Vec3(0.01, 0.02, -0.03);
  scene.loads.emplace_back("dead", load);
  load.follower = true;
  load.at = 0.17;
  scene.loads.emplace_back("follower", load);
  load.at.reset();
  load.from = 0.05;
  load.to = 0.25;
  scene.loads.emplace_back("distributed", load);
  scene.couplings = {std::move(tie)};
  return scene;
}

class TieTangent : public testing::TestWithParam<std::tuple<std::string, int>> {};

TEST_P(TieTangent, matches_finite_differences) {
  const auto& [holder, kind] = GetParam();
  Tie tie;
  tie.rod = "a";
  tie.at = 0.21;
  if (kind == 1) tie.along = {false, true, false};
  if (kind == 2) tie.about = {true, true, true};
  if (kind == 3) {
    tie.along = {false, false, false};
    tie.about = {false, false, true};
  }
  if (holder == "rod") {
    tie.other = "b";
    tie.other_at = 0.12;
  }
  Scene scene = everything(tie);
  if (holder == "frame") {
    Frame frame;
    frame.pose = {Vec3(0.2, 0.4, -0.3), Vec3(0.1, 0, 0)};
    frame.motion = FrameMotion{{0.0, 1.0}, {Vec3::Zero(), Vec3(1, 2, 3)}, {}};
    scene.frames.emplace_back("hand", frame);
    std::get<Tie>(scene.couplings[0]).frame = "hand";
  }
  for (const double size : {0.0, 1e-5, 1.0}) expect_exact_tangent(build(scene, test::read_block), size);
}

INSTANTIATE_TEST_SUITE_P(Reduced, TieTangent,
                         testing::Combine(testing::Values("ground", "frame", "rod"), testing::Range(0, 4)));

TEST(SolidTieTangent, matches_finite_differences) {
  for (const bool pose : {true, false}) {
    Scene scene = test::cable_block();
    if (pose) {
      test::slide(scene, 0).anchor_tip = AnchorTip::pose;
    } else {
      Tie tie;
      tie.rod = "cable";
      tie.solid = scene.solids[0].first;
      tie.at = 0.03;
      tie.along = {true, false, true};
      tie.about = {false, true, false};
      scene.couplings.emplace_back(tie);
    }
    const Model model = build(scene, test::read_block);
    ASSERT_FALSE(model.ties.empty());
    for (const double size : {0.0, 1.0}) expect_exact_tangent(model, size);
  }
}

TEST(Build, an_anchor_is_kept_where_nothing_else_could_be) {
  // In a clamped region, on a rod that can only stretch: no row across it says anything, the anchor's row along it
  // does.
  Scene scene = test::cable_block();
  std::get<Box>(scene.solids[0].second.fixed[0].region).upper = Vec3(61 * test::mm, 11 * test::mm, 4 * test::mm);
  scene.rods[0].second.path = {Vec3(0, 5 * test::mm, 3 * test::mm), Vec3(60 * test::mm, 5 * test::mm, 3 * test::mm)};
  scene.rods[0].second.strains = {Strain::elongation};
  test::slide(scene, 0).points = std::vector<double>{60 * test::mm};
  std::get<Box>(scene.solids[0].second.fixed[0].region).upper.z() = 6 * test::mm;
  const Model model = build(scene, test::read_block);
  EXPECT_EQ(model.couplings[0].kept, 1);
  const test::Trace trace = test::run_all(model);
  ASSERT_EQ(trace.end, RunEnd::done) << to_string(trace.failure.status);
  const double EA = rod::stiffness_at(model.rods[0].rod.profile, 0.0)(3, 3);
  EXPECT_NEAR(trace.states.back().actuators[0], EA * 2e-3 / 60e-3, 1e-6 * EA);
}

TEST(Build, a_second_coupling_does_not_repeat_the_rows_of_the_first) {
  Scene scene = test::cable_block();
  scene.couplings.push_back(scene.couplings[0]);
  test::slide(scene, 1).anchor_tip = AnchorTip::none;
  const Model model = build(scene, test::read_block);
  EXPECT_EQ(model.couplings[0].kept, 5);
  EXPECT_EQ(model.couplings[1].kept, 0);
}

TEST(Build, a_geometric_cable_that_nothing_holds_is_refused) {
  Scene scene = test::cable_block();
  scene.rods[0].second.cable = Cable::geometric;
  EXPECT_NO_THROW(build(scene, test::read_block));
  scene.actuators.clear();
  EXPECT_THROW(build(scene, test::read_block), InputError);
}

TEST(Build, points_and_outputs_beyond_the_reach_are_refused_and_within_it_extrapolated) {
  Scene scene = test::cable_block();
  scene.outputs[0].second.point.x = Vec3(63e-3, 5e-3, 5e-3);
  const Model model = build(scene, test::read_block);
  EXPECT_LT((test::tip(model, initial_state(model)) - Vec3(63e-3, 5e-3, 5e-3)).norm(), 1e-15);
  EXPECT_EQ(model.warnings.size(), 1u);
  scene.outputs[0].second.reach = 2e-3;
  EXPECT_THROW(build(scene, test::read_block), InputError);
  scene = test::cable_block();
  for (Vec3& p : scene.rods[0].second.path) p.z() += 10e-3;
  EXPECT_THROW(build(scene, test::read_block), InputError);
}

}  // namespace
}  // namespace sinew
