// A rod whose base a motor turns or pushes, in motion: the motor's torque or force is what changes the momentum.
#include <ostream>

#include "validation/rods.hpp"

namespace sinew::test {
namespace {

struct Case {
  const char* name;
  Motion motion;
  Driven driven;
};
void PrintTo(const Case& own, std::ostream* out) { *out << own.name; }

class DrivenBase : public testing::TestWithParam<std::tuple<Case, int>> {};

/// Backward Euler: sum of m (v_1 - v_0) = h F, and of x_1 x m (v_1 - v_0) = h M, about the axis of the motor.
double change_of_momentum(const Model& model, const State& before, const State& after, Motion motion) {
  double sum = 0.0;
  for (std::size_t i = 0; i < model.rods[0].rod.masses.size(); ++i) {
    const auto column = static_cast<Eigen::Index>(i);
    const Vec3 change =
        model.rods[0].rod.masses[i].mass * (after.rods[0].velocity.col(column) - before.rods[0].velocity.col(column));
    const Vec3 x = after.rods[0].masses.col(column);
    sum += motion == Motion::rotation ? x.cross(change).x() : -change.x();  // a pull goes back along the rod
  }
  return sum;
}

// Nothing but the motor moves it: forces along the rod balance to nothing but inertia against strain.
TEST_P(DrivenBase, what_the_motor_gives_is_the_change_of_momentum) {
  const auto& [kind, sections] = GetParam();
  Scene scene = straight_rod(0.3, sections, Circle{0.01}, kExtensible);
  scene.analysis = Analysis::dynamic;
  scene.time = {0.02, 1.0};
  scene.newton.tolerance = 1e-12;
  scene.rods[0].second.material = {1e6, 0.5, 1000.0};
  Actuator motor;
  motor.rod = "rod";
  motor.motion = kind.motion;
  motor.driven = kind.driven;
  const double most = kind.driven == Driven::angle          ? pi / 2
                      : kind.driven == Driven::displacement ? 0.05
                      : kind.driven == Driven::torque       ? 1e-4
                                                            : 1e-2;
  motor.drive = Table{{0.0, 1.0}, {0.0, most}};
  scene.actuators.emplace_back("motor", motor);
  const Model model = build(scene, read_block);
  const Trace trace = run_all(model);
  ASSERT_EQ(trace.end, RunEnd::done);
  ASSERT_EQ(trace.states.size(), 51u);
  double largest = 0.0;
  for (const State& state : trace.states) largest = std::max(largest, std::abs(state.actuators[0]));
  EXPECT_GT(largest, 0.0);
  for (std::size_t n = 1; n < trace.states.size(); ++n) {
    EXPECT_NEAR(change_of_momentum(model, trace.states[n - 1], trace.states[n], kind.motion),
                0.02 * trace.states[n].actuators[0], 1e-8 * 0.02 * largest)
        << n << " " << trace.reports[n - 1].newton << " " << trace.reports[n - 1].residual;
  }
}

INSTANTIATE_TEST_SUITE_P(
    Motors, DrivenBase,
    testing::Combine(testing::Values(Case{"angle", Motion::rotation, Driven::angle},
                                     Case{"torque", Motion::rotation, Driven::torque},
                                     Case{"displacement", Motion::translation, Driven::displacement},
                                     Case{"force", Motion::translation, Driven::force}),
                     testing::Values(1, 2, 6, 40)),
    [](const auto& own) { return std::get<0>(own.param).name + std::to_string(std::get<1>(own.param)); });

}  // namespace
}  // namespace sinew::test
