// The tendon-driven rod that rod codes are timed with: two links of 0.3 m, radius 30 mm, Legendre order 1 on torsion,
// bendings and elongation, two tendons of 1 N, gravity across (gvs_tendon_model of SoRoSim and SoRoMoX).
#include <gtest/gtest.h>

#include <algorithm>

#include "support/scenes.hpp"

namespace sinew {
namespace {

Scene tendon_arm(double step, double duration, Analysis analysis) {
  Scene scene;
  scene.analysis = analysis;
  scene.time = {step, duration};
  scene.gravity = Vec3(0, 0, -9.81);
  Rod rod;
  rod.path = {Vec3::Zero(), Vec3(0.6, 0, 0)};
  rod.sections = 2;
  rod.strains = {Strain::torsion, Strain::bending_y, Strain::bending_z, Strain::elongation};
  rod.order = {1, 1, 1, 1, 0, 0};
  rod.section = Circle{0.03};
  rod.material.young = 1e6;
  rod.material.poisson = 0.5;
  rod.material.density = 1000.0;
  rod.material.viscosity = 1e4;
  scene.rods.emplace_back("arm", rod);
  int number = 0;
  for (const double angle : {0.0, 0.5 * std::numbers::pi}) {
    Actuator pull;
    pull.rod = "arm";
    pull.driven = Driven::force;
    pull.drive = Table{{0.0}, {1.0}};
    pull.tendon = Tendon{0.0, std::nullopt, Taper(0.02), Taper(angle)};
    scene.actuators.emplace_back("tendon" + std::to_string(number++), pull);
  }
  Output tip;
  tip.rod = "arm";
  tip.at = 0.6;
  scene.outputs.emplace_back("tip", tip);
  return scene;
}

TEST(TendonArm, LosesEnergyOnlyAndComesToItsStaticShape) {
  // The material is so viscous that it takes long to settle.
  const Model model = build(tendon_arm(5e-3, 20.0, Analysis::dynamic), test::read_block);
  const test::Trace trace = test::run_all(model);
  ASSERT_EQ(trace.end, RunEnd::done);
  double dissipated = 0.0, highest = 0.0;
  for (const State& state : trace.states) {
    const double now = model.start_energy + state.energies.work - energy_balance(model, state).total();
    highest = std::max(highest, std::abs(energy_balance(model, state).elastic));
    EXPECT_GE(now, dissipated - 1e-6 * highest) << state.time;
    dissipated = now;
  }
  EXPECT_GT(dissipated, 0.01 * highest);
  const Model still = build(tendon_arm(0.1, 0.1, Analysis::statics), test::read_block);
  const test::Trace rest = test::run_all(still);
  ASSERT_EQ(rest.end, RunEnd::done) << to_string(rest.failure.status);
  const Vec3 end = test::tip(still, rest.states.back());
  EXPECT_GT((end - Vec3(0.6, 0, 0)).norm(), 0.05);
  EXPECT_LT((test::tip(model, trace.states.back()) - end).norm(), 1e-4);
}

TEST(TendonArm, TrajectoryConvergesWithTheTimeStep) {
  const auto tip_at = [](double step) {
    const Model model = build(tendon_arm(step, 0.2, Analysis::dynamic), test::read_block);
    return test::tip(model, test::run_all(model).states.back());
  };
  const Vec3 coarse = tip_at(4e-3), middle = tip_at(2e-3), fine = tip_at(1e-3);
  EXPECT_NEAR((coarse - middle).norm() / (middle - fine).norm(), 2.0, 0.3);  // backward Euler
}

}  // namespace
}  // namespace sinew
