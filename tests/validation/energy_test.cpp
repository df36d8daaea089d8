// Rods in motion: what backward Euler takes of their energy and momentum, and what it must never add.
#include "validation/rods.hpp"

namespace sinew::test {
namespace {

/// A rod of natural frequency 3.5 rad/s: length 0.5 m, radius 5 mm, E = 10 MPa.
Scene moving_rod(int sections, double step, double duration) {
  Scene scene = straight_rod(0.5, sections, Circle{0.005});
  scene.analysis = Analysis::dynamic;
  scene.time = {step, duration};
  scene.rods[0].second.material = {10e6, 0.45, 1000.0};
  return scene;
}

/// The start of a run with the rod bent by these mean curvatures, at rest.
State bent(const Model& model, const std::function<Vec3(double)>& curvature) {
  State state = initial_state(model);
  RodState& own = state.rods[0];
  const rod::Rod& rod = model.rods[0].rod;
  for (int i = 0; i < rod.count(); ++i) {
    const Vec3 k = curvature(0.5 * (rod.sections[i].begin + rod.sections[i].end));
    for (std::size_t c = 0; c < rod.sections[i].modes.size(); ++c) {
      const rod::Mode& mode = rod.sections[i].modes[c];
      if (mode.strain < 3 && mode.degree == 0)
        own.q[rod.base_coordinates() + rod.first[i] + static_cast<int>(c)] = k[mode.strain];
    }
  }
  const auto shape = rod_shape(model, state, 0);
  for (Eigen::Index m = 0; m < own.masses.cols(); ++m)
    own.masses.col(m) = rod::position(shape, rod.masses[m].s, rod.masses[m].offset);
  return state;
}

/// States of a run that must reach its end.
std::vector<State> states_from(const Model& model, const State& start) {
  std::vector<State> states = {start};
  StepReport failure;
  const RunEnd end = run(
      model, start, [&](const State& state, const StepReport&) { return states.push_back(state), true; }, &failure);
  EXPECT_EQ(end, RunEnd::done) << to_string(failure.status);
  return states;
}

/// Curvature of the first mode of a clamped rod, in both planes, and so little that others are hardly touched.
Vec3 first_mode(double s) {
  const double b = 1.87510407 * s / 0.5, ratio = 0.73409551;
  const double k = std::cosh(b) + std::cos(b) - ratio * (std::sinh(b) + std::sin(b));
  return 0.02 * Vec3(0, 1.0, 2.0) * k;
}

TEST(Energy, undamped_free_vibration_loses_energy_in_proportion_to_the_step) {
  std::vector<double> lost;
  for (double step : {4e-3, 2e-3, 1e-3}) {
    const Model model = build(moving_rod(8, step, 0.4), read_block);
    const State start = bent(model, first_mode);
    const std::vector<State> states = states_from(model, start);
    EXPECT_EQ(static_cast<long>(states.size()), 1 + grid_steps(model.scene));  // none was halved
    const double before = energy_balance(model, start).total(), after = energy_balance(model, states.back()).total();
    EXPECT_LT(after, before);
    EXPECT_GT(energy_balance(model, states.back()).kinetic, 0.3 * before);
    lost.push_back((before - after) / before);
  }
  EXPECT_LT(lost[2], 0.02);
  EXPECT_NEAR(std::log2(lost[0] / lost[1]), 1.0, 0.15);
  EXPECT_NEAR(std::log2(lost[1] / lost[2]), 1.0, 0.15);
}

class DampedRod : public testing::TestWithParam<std::tuple<double, double, double>> {};

TEST_P(DampedRod, never_gains_energy_in_any_step) {
  const auto [viscosity, damping, step] = GetParam();
  Scene scene = moving_rod(8, step, 100 * step);
  scene.gravity = Vec3(1.0, -9.81, 2.0);
  scene.rods[0].second.strains = kAll;
  scene.rods[0].second.material.viscosity = viscosity;
  scene.rods[0].second.material.damping = damping;
  const Model model = build(scene, read_block);
  const std::vector<State> states = states_from(model, bent(model, [](double s) { return Vec3(6, 10 * s, 8); }));
  const double first = energy_balance(model, states.front()).total();
  double last = first, exchanged = 0.0;
  for (const State& state : states) {
    const EnergyBalance now = energy_balance(model, state);
    EXPECT_LE(now.total(), last + 1e-9 * std::abs(first));
    last = now.total();
    exchanged = std::max(exchanged, now.kinetic);
  }
  EXPECT_GT(exchanged, 1e-3 * std::abs(first));
  EXPECT_LT(last, first - 1e-3 * std::abs(first));
}

INSTANTIATE_TEST_SUITE_P(DampingAndStep, DampedRod,
                         testing::Values(std::tuple(0.0, 0.0, 2e-3), std::tuple(3e3, 0.0, 2e-3),
                                         std::tuple(0.0, 0.01, 2e-3), std::tuple(3e3, 0.01, 1e-2),
                                         std::tuple(1e5, 0.0, 5e-2)));

TEST(Energy, viscosity_takes_more_of_a_vibration_than_the_step_does) {
  double left[2];
  for (int i = 0; i < 2; ++i) {
    Scene scene = moving_rod(6, 1e-3, 0.5);
    scene.rods[0].second.material.damping = i == 0 ? 0.0 : 0.1;
    const Model model = build(scene, read_block);
    left[i] = energy_balance(model, states_from(model, bent(model, first_mode)).back()).total();
  }
  EXPECT_LT(left[1], 0.7 * left[0]);
}

/// Where nothing moves by itself, a load that stands from the start is brought on from nothing: all of its work is
/// stored, however far it bends.
TEST(Energy, equilibria_under_loads_of_the_start_store_their_work) {
  for (const double force : {0.3e-3, 5e-3}) {  // [N] the tip moves by less, and by more, than 1 % of the length
    Scene scene = straight_rod(0.5, 8, Circle{0.005}, kBending, 0, 2);
    scene.rods[0].second.material = {10e6, 0.45, 1000.0};
    add_load(scene, Vec3(0, force, 0)).factor = Table{{0.0}, {1.0}};
    const Model model = build(scene, read_block);
    const State end = states_from(model, initial_state(model)).back();
    const double stored = energy_balance(model, end).elastic;
    EXPECT_GT(stored, 0.0);
    EXPECT_NEAR(end.energies.work, stored, 0.01 * stored) << force;
  }
}

}  // namespace
}  // namespace sinew::test
