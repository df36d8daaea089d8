// Rods alone: statics against beam theory, dynamics against conservation laws.
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <numbers>

#include "sinew/rod/kinematics.hpp"
#include "sinew/rod/section.hpp"
#include "sinew/sim/internal.hpp"
#include "support/scenes.hpp"
#include "validation/rods.hpp"

namespace sinew {
namespace {

using test::mm;

double kinetic_energy(const Model& model, const State& state) {
  double energy = 0.0;
  for (std::size_t i = 0; i < model.rods[0].rod.masses.size(); ++i) {
    energy +=
        0.5 * model.rods[0].rod.masses[i].mass * state.rods[0].velocity.col(static_cast<Eigen::Index>(i)).squaredNorm();
  }
  return energy;
}

double elastic_energy(const Model& model, const State& state) {
  const rod::Rod& rod = model.rods[0].rod;
  double energy = 0.0;
  for (int i = 0; i < rod.count(); ++i) {
    const Eigen::VectorXd q = rod.of_section(state.rods[0].q, i);
    energy += 0.5 * q.dot(rod.sections[i].stiffness * q);
  }
  return energy;
}

double potential_energy(const Model& model, const State& state) {
  double energy = 0.0;
  for (std::size_t i = 0; i < model.rods[0].rod.masses.size(); ++i) {
    energy -= model.rods[0].rod.masses[i].mass *
              model.scene.gravity.dot(state.rods[0].masses.col(static_cast<Eigen::Index>(i)));
  }
  return energy;
}

TEST(LoneRod, hangs_as_beam_theory_says) {
  // A light load: deflection q L^4 / (8 E I); backward Euler's own damping brings it to rest at long steps.
  Scene scene = test::lone_rod(1000.0, 20);
  scene.gravity = Vec3(0, -9.81e-3, 0);
  scene.time = {0.5, 40.0};
  const Model model = build(scene, test::read_block);
  const test::Trace trace = test::run_all(model);
  ASSERT_EQ(trace.end, RunEnd::done) << to_string(trace.failure.status);
  const double A = std::numbers::pi * 25e-6, EI = 10e6 * std::numbers::pi * 625e-12 / 4;
  const double expected = 1000.0 * A * 9.81e-3 * std::pow(0.5, 4) / (8 * EI);
  EXPECT_NEAR(-test::tip(model, trace.states.back()).y(), expected, 0.003 * expected);
}

TEST(LoneRod, energy_never_grows_and_is_kept_as_the_step_shrinks) {
  std::vector<double> lost;
  for (double h : {4e-3, 2e-3, 1e-3}) {
    Scene scene = test::lone_rod(1000.0, 6);
    scene.gravity = Vec3(0, 0, -9.81);
    scene.time = {h, 0.4};
    const Model model = build(scene, test::read_block);
    const test::Trace trace = test::run_all(model);
    ASSERT_EQ(trace.end, RunEnd::done) << to_string(trace.failure.status);
    const auto total = [&](const State& s) {
      return kinetic_energy(model, s) + elastic_energy(model, s) + potential_energy(model, s);
    };
    double last = total(trace.states.front()), exchanged = 0.0;
    for (const State& state : trace.states) {
      EXPECT_LE(total(state), last + 1e-10);
      last = total(state);
      exchanged = std::max(exchanged, kinetic_energy(model, state));
    }
    EXPECT_GT(exchanged, 1e-3);
    lost.push_back((total(trace.states.front()) - last) / exchanged);
  }
  EXPECT_GT(lost[0], 0.0);
  EXPECT_LT(lost[2], 0.65 * lost[1]);  // first order
  EXPECT_LT(lost[1], 0.75 * lost[0]);
}

TEST(LoneRod, free_fall_of_the_base_is_the_backward_euler_recurrence) {
  // Driven by no force, the base slides along its axis under gravity along it: v = n h g, x = h^2 g n (n + 1) / 2.
  Scene scene = test::lone_rod(1000.0, 4);
  scene.gravity = Vec3(-9.81, 0, 0);
  Actuator free;
  free.rod = "rod";
  free.driven = Driven::force;
  free.drive = Table{{0.0}, {0.0}};
  scene.actuators.emplace_back("free", free);
  scene.time = {0.01, 0.1};
  const Model model = build(scene, test::read_block);
  const test::Trace trace = test::run_all(model);
  ASSERT_EQ(trace.end, RunEnd::done);
  for (std::size_t n = 0; n < trace.states.size(); ++n) {
    EXPECT_NEAR(trace.states[n].rods[0].q[0], 1e-4 * 9.81 * static_cast<double>(n * (n + 1)) / 2, 1e-12);
  }
}

TEST(LoneRod, motor_force_accelerates_the_rods_mass) {
  Scene scene = test::lone_rod(1000.0, 4);
  Actuator motor;
  motor.rod = "rod";
  motor.driven = Driven::force;
  motor.drive = Table{{0.0}, {2.0}};
  scene.actuators.emplace_back("motor", motor);
  scene.time = {0.001, 0.01};
  const Model model = build(scene, test::read_block);
  const test::Trace trace = test::run_all(model);
  const double mass = 1000.0 * 0.5 * std::numbers::pi * 25e-6;
  // Ten steps from rest: h^2 F / m 55 along -x: force > 0 pulls the rod out.
  EXPECT_NEAR(trace.states.back().rods[0].q[0], 1e-6 * 2.0 / mass * 55, 1e-12);
  EXPECT_LT(test::tip(model, trace.states.back()).x(), 0.5);
}

TEST(LoneRod, free_vibration_is_the_backward_euler_recurrence_of_mass_and_stiffness) {
  // One small step from a bent start against (M / h^2 + K) dq = -K q, M = sum m J^T J at the start.
  Scene scene = test::lone_rod(1000.0, 3);
  const Model model = build(scene, test::read_block);
  State state = initial_state(model);
  const rod::Rod& rod = model.rods[0].rod;
  for (int i = 0; i < state.rods[0].q.size(); ++i) state.rods[0].q[i] += 1e-7 * std::cos(2.0 * i);
  const auto shape = rod::configure(rod, model.rods[0].base, state.rods[0].q);
  const int n = rod.coordinates();
  Eigen::MatrixXd A = Eigen::MatrixXd::Zero(n, n);
  Eigen::VectorXd right(n);
  const double h = 0.01;
  for (std::size_t i = 0; i < rod.masses.size(); ++i) {
    state.rods[0].masses.col(static_cast<Eigen::Index>(i)) =
        rod::position(shape, rod.masses[i].s, rod.masses[i].offset);
    const Eigen::MatrixXd J = rod::position_jacobian(shape, rod.masses[i].s, rod.masses[i].offset);
    A += rod.masses[i].mass / (h * h) * J.transpose() * J;
  }
  for (int i = 0; i < rod.count(); ++i) {
    const int at = rod.first[i], m = rod.first[i + 1] - at;
    A.block(at, at, m, m) += rod.sections[i].stiffness;
    right.segment(at, m) = -(rod.sections[i].stiffness * state.rods[0].q.segment(at, m));
  }
  const Eigen::VectorXd dq = A.ldlt().solve(right);
  Workspace workspace = make_workspace(model);
  const StepResult result = step(model, workspace, {}, state, h);
  ASSERT_EQ(result.report.status, Status::converged);
  EXPECT_GT(dq.norm(), 1e-9);
  EXPECT_LT((result.next.rods[0].q - state.rods[0].q - dq).norm(), 1e-5 * dq.norm());
}

TEST(LoneRod, spinning_base_keeps_its_angular_momentum_law) {
  // A constant torque on a straight rod about its own axis: angle = T / J h^2 n (n + 1) / 2 with J = m r^2 / 2.
  Scene scene = test::lone_rod(1000.0, 2);
  scene.rods[0].second.strains = {Strain::bending_y};
  Actuator motor;
  motor.rod = "rod";
  motor.motion = Motion::rotation;
  motor.driven = Driven::torque;
  const double mass = 1000.0 * 0.5 * std::numbers::pi * 25e-6, inertia = mass * 25e-6 / 2;
  motor.drive = Table{{0.0}, {inertia * 0.1}};  // 0.1 rad/s^2
  scene.actuators.emplace_back("motor", motor);
  scene.time = {0.01, 0.1};
  const Model model = build(scene, test::read_block);
  const test::Trace trace = test::run_all(model);
  ASSERT_EQ(trace.end, RunEnd::done);
  EXPECT_NEAR(trace.states.back().rods[0].q[0], 0.1 * 1e-4 * 55, 1e-8);
}

TEST(LoneRod, a_driven_turn_may_be_beyond_a_right_angle_in_a_step) {
  Scene scene = test::lone_rod(1000.0, 1);
  Actuator motor;
  motor.rod = "rod";
  motor.motion = Motion::rotation;
  motor.driven = Driven::angle;
  motor.drive = Table{{0.0, 0.2}, {0.0, 40.0}};
  motor.axis = 2;
  scene.actuators.emplace_back("motor", motor);
  scene.time = {0.01, 0.2};
  const Model model = build(scene, test::read_block);
  const test::Trace trace = test::run_all(model);
  ASSERT_EQ(trace.end, RunEnd::done);
  for (const StepReport& report : trace.reports) EXPECT_EQ(report.halvings, 0);
}

TEST(LoneRod, massless_rods_are_legal) {
  Scene scene = test::lone_rod(0.0, 4);
  scene.gravity = Vec3(0, 0, -9.81);
  const Model model = build(scene, test::read_block);
  const test::Trace trace = test::run_all(model);
  ASSERT_EQ(trace.end, RunEnd::done);
  EXPECT_LT((test::tip(model, trace.states.back()) - Vec3(0.5, 0, 0)).norm(), 1e-12);
}

TEST(LoneRod, strains_outside_the_basis_keep_their_value_from_the_path) {
  Scene scene = test::lone_rod(1000.0, 16);
  Rod& rod = scene.rods[0].second;
  rod.path.clear();
  for (int i = 0; i <= 20; ++i)
    rod.path.emplace_back(0.1 * std::sin(0.05 * i * 1.5), 0.0, 0.1 * (1 - std::cos(0.05 * i * 1.5)));
  rod.strains = {Strain::torsion, Strain::elongation};
  scene.outputs[0].second.at.reset();
  scene.gravity = Vec3(0, 0, -9.81);
  const Model model = build(scene, test::read_block);
  const test::Trace trace = test::run_all(model);
  ASSERT_EQ(trace.end, RunEnd::done);
  for (int i = 0; i < 16; ++i) {
    const rod::Vec6 xi = rod::strain(model.rods[0].rod, trace.states.back().rods[0].q, i);
    EXPECT_NEAR(std::hypot(xi[1], xi[2]), 10.0, 0.5) << i;
  }
}

TEST(InternalForces, stand_on_both_sides_of_concentrated_loads) {
  // One section whose length and cross-sections are rigid: what holds it follows from balance alone.
  const double L = 0.5, F = 3.0;
  Scene scene = test::straight_rod(L, 1, test::given({1, 1, 1, 1, 1, 1}));
  test::add_load(scene, Vec3(F, 0, 0), Vec3::Zero(), 0.3);
  test::add_load(scene, Vec3(1.0, 0, 0));
  Actuator tendon;
  tendon.rod = "rod";
  tendon.driven = Driven::force;
  tendon.tendon.emplace();
  tendon.tendon->from = 0.1;
  tendon.tendon->to = 0.4;
  tendon.drive = Table{{0.0}, {2.0}};
  scene.actuators.emplace_back("tendon", tendon);
  const test::Solved solved = test::solve(scene);
  const auto axial = [&](double s) { return internal_wrench(solved.model, solved.end(), 0, s)[3]; };
  EXPECT_NEAR(axial(0.0), F + 1.0, 1e-9);
  EXPECT_NEAR(axial(0.099), F + 1.0, 1e-9);
  EXPECT_NEAR(axial(0.1), F - 1.0, 1e-9);
  EXPECT_NEAR(axial(0.299), F - 1.0, 1e-9);
  EXPECT_NEAR(axial(0.301), -1.0, 1e-9);
  EXPECT_NEAR(axial(0.399), -1.0, 1e-9);
  EXPECT_NEAR(axial(0.401), 1.0, 1e-9);
  EXPECT_NEAR(axial(L), 1.0, 1e-9);
}

TEST(InternalForces, shear_beside_a_tie_and_under_weight) {
  // A clamped rod propped at half its length: the shear force jumps by the prop's force.
  const double L = 0.5, F = 0.01;
  Scene scene = test::straight_rod(L, 3, test::given({1, 1, 1, 1, 1, 1}), test::kBending, 3);
  test::add_load(scene, Vec3(0, F, 0));
  test::add_tie(scene, {false, true, false}).at = 0.5 * L;
  const test::Solved solved = test::solve(scene);
  const auto shear = [&](double s) { return internal_wrench(solved.model, solved.end(), 0, s)[4]; };
  EXPECT_NEAR(shear(0.5 * L), F, 1e-6 * F);
  EXPECT_NEAR(shear(L), F, 1e-6 * F);
  EXPECT_NEAR(shear(0.5 * L - 1e-6), -1.5 * F, 1e-3 * F);  // prop at half: 5/2 F
  EXPECT_NEAR(shear(0.01), -1.5 * F, 1e-3 * F);
}

TEST(Work, of_a_load_is_what_a_static_path_stores) {
  for (const Analysis analysis : {Analysis::statics, Analysis::quasi_static}) {
    Scene scene = test::straight_rod(0.5, 4, test::given({1, 1, 1, 1, 1, 1}), test::kBending, 1, 50);
    scene.analysis = analysis;
    test::add_load(scene, Vec3(0, 0.5, 0));
    const test::Solved solved = test::solve(scene);
    const double stored = elastic_energy(solved.model, solved.end());
    EXPECT_GT(stored, 1e-3);
    EXPECT_NEAR(solved.end().energies.work, stored, 2e-3 * stored);
  }
  // A constant load counts from nothing on a static path, too.
  Scene scene = test::straight_rod(0.5, 4, test::given({1, 1, 1, 1, 1, 1}), test::kBending, 1);
  scene.analysis = Analysis::statics;
  test::add_load(scene, Vec3(0, 0.5, 0)).factor = Table{{0.0}, {1.0}};
  const test::Solved solved = test::solve(scene);
  const double stored = elastic_energy(solved.model, solved.end());
  EXPECT_NEAR(solved.end().energies.work, stored, 0.02 * stored);
}

}  // namespace
}  // namespace sinew
