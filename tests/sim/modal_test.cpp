#include "sinew/sim/modal.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "support/scenes.hpp"

namespace sinew {
namespace {

constexpr double kRodLength = 1.0, kRadius = 2e-3, kYoung = 2e9, kDensity = 1200.0;
const double kStiffness = kYoung * std::numbers::pi * std::pow(kRadius, 4) / 4;
const double kLineDensity = kDensity * std::numbers::pi * kRadius * kRadius;

Scene slender(int sections, int order) {
  Scene scene;
  scene.analysis = Analysis::modal;
  Rod rod;
  rod.path = {Vec3::Zero(), Vec3(kRodLength, 0, 0)};
  rod.sections = sections;
  rod.strains = {Strain::bending_z};
  rod.order[2] = order;
  rod.section = Circle{kRadius};
  rod.material = {kYoung, 0.3, kDensity};
  scene.rods.emplace_back("rod", rod);
  return scene;
}

std::vector<NaturalMode> modes_of(const Scene& scene, int count) {
  const Model model = build(scene, test::read_block);
  Workspace workspace = make_workspace(model);
  const StepResult rest = step(model, workspace, command_at(model, 0.0), initial_state(model), 0.0);
  EXPECT_TRUE(accepted(rest.report.status)) << to_string(rest.report.status);
  std::string failed;
  return natural_modes(model, workspace, rest.next, count, failed);
}

TEST(Modal, CantileverHasTheFrequenciesOfEulerAndBernoulli) {
  // (beta L)^2 of cos cosh = -1.
  const double roots[] = {1.8751040687, 4.6940911330, 7.8547574382};
  for (const auto& [sections, order] : {std::pair(24, 0), std::pair(2, 3)}) {
    const auto modes = modes_of(slender(sections, order), 3);
    ASSERT_EQ(modes.size(), 3u);
    for (std::size_t i = 0; i < 3; ++i) {
      const double omega = std::pow(roots[i] / kRodLength, 2) * std::sqrt(kStiffness / kLineDensity);
      EXPECT_NEAR(2 * std::numbers::pi * modes[i].frequency, omega, 0.01 * omega) << sections << " mode " << i;
    }
  }
}

TEST(Modal, TautRodRisesWithTension) {
  // Pinned-pinned with tension T: omega_n = (n pi / L)^2 sqrt(EI/m) sqrt(1 + T L^2 / (EI n^2 pi^2)) (Euler-Bernoulli).
  for (const double ratio : {0.0, 1.0, 10.0, 100.0, 1000.0}) {  // T L^2 / (pi^2 EI)
    const double tension = ratio * std::pow(std::numbers::pi / kRodLength, 2) * kStiffness;
    Scene scene = slender(40, 0);
    Rod& rod = scene.rods[0].second;
    rod.base = {BaseAxis::turn_z};
    Tie pin;  // across only, so that the tip is free to be pulled
    pin.rod = "rod";
    pin.along = {false, false, true};
    rod.up = Vec3(0, 0, 1);  // bending_z moves the rod along world z, turning about -y
    rod.base = {BaseAxis::turn_z};
    scene.couplings.emplace_back(pin);
    RodLoad pull;
    pull.rod = "rod";
    pull.force = Vec3(tension, 0, 0);
    scene.loads.emplace_back("pull", pull);
    const auto modes = modes_of(scene, 3);
    ASSERT_EQ(modes.size(), 3u);
    for (int n = 1; n <= 3; ++n) {
      const double omega = std::pow(n * std::numbers::pi / kRodLength, 2) * std::sqrt(kStiffness / kLineDensity) *
                           std::sqrt(1.0 + ratio / (n * n));
      EXPECT_NEAR(2 * std::numbers::pi * modes[static_cast<std::size_t>(n - 1)].frequency, omega, 0.01 * omega)
          << "T L^2 / pi^2 EI = " << ratio << ", mode " << n;
    }
  }
}

TEST(Modal, AnUnstableColumnHasANegativeFrequency) {
  // A cantilever under a dead axial load buckles at pi^2 EI / (4 L^2): there the lowest frequency passes zero.
  const double critical = std::pow(std::numbers::pi / (2 * kRodLength), 2) * kStiffness;
  for (const double part : {0.99, 1.01}) {
    Scene scene = slender(30, 0);
    RodLoad push;
    push.rod = "rod";
    push.force = Vec3(-part * critical, 0, 0);
    scene.loads.emplace_back("push", push);
    EXPECT_EQ(modes_of(scene, 1).at(0).frequency > 0.0, part < 1.0) << part;
  }
}

TEST(Modal, AFreeRodHasSixRigidModes) {
  Scene scene = slender(6, 0);
  scene.rods[0].second.strains = {Strain::torsion, Strain::bending_y, Strain::bending_z};
  scene.rods[0].second.base = {BaseAxis::x,      BaseAxis::y,      BaseAxis::z,
                               BaseAxis::turn_x, BaseAxis::turn_y, BaseAxis::turn_z};
  const auto modes = modes_of(scene, 8);
  ASSERT_EQ(modes.size(), 8u);
  for (int i = 0; i < 6; ++i)
    EXPECT_LT(std::abs(modes[static_cast<std::size_t>(i)].frequency), 1e-4 * modes[6].frequency);
  // Free-free bending: (beta L) = 4.7300.
  const double omega = std::pow(4.7300407449 / kRodLength, 2) * std::sqrt(kStiffness / kLineDensity);
  EXPECT_NEAR(2 * std::numbers::pi * modes[6].frequency, omega, 0.03 * omega);
}

TEST(Modal, MasslessRodsAreRefusedWithAReason) {
  Scene scene = slender(3, 0);
  scene.rods[0].second.material.density = 0.0;
  const Model model = build(scene, test::read_block);
  Workspace workspace = make_workspace(model);
  State state = initial_state(model);
  const StepReport report = advance(model, workspace, state);
  EXPECT_EQ(report.status, Status::singular);
  EXPECT_NE(report.detail.find("density"), std::string::npos);
}

TEST(Modal, BlockAndRodOfTheSameShapeHaveTheSameFrequencies) {
  Scene scene;
  scene.analysis = Analysis::modal;
  Solid block;
  block.mesh = "block";
  block.material.law = solid::neo_hookean(1e6, 0.0);
  block.density = 1000.0;
  block.mass_matrix = solid::MassMatrix::consistent;
  block.fixed.push_back({Plane{Vec3::Zero(), Vec3::UnitX()}});
  scene.solids.emplace_back("block", block);
  const Model model =
      build(scene, [](const auto&) { return test::block_mesh(20, 1, 1, Vec3(0.4, 0.01, 0.01), solid::Kind::tet10); });
  Workspace workspace = make_workspace(model);
  std::string failed;
  const auto modes = natural_modes(model, workspace, initial_state(model), 6, failed);
  ASSERT_EQ(modes.size(), 6u) << failed;
  const double bend = std::sqrt(1e6 * 1e-8 / 12 / (1000.0 * 1e-4)) / (0.4 * 0.4);
  for (const auto& [number, root] :
       {std::pair(0, 1.8751040687), {1, 1.8751040687}, {2, 4.6940911330}, {4, 7.8547574382}}) {
    const double omega = root * root * bend;
    EXPECT_NEAR(2 * std::numbers::pi * modes[static_cast<std::size_t>(number)].frequency, omega, 0.015 * omega)
        << number;
  }
}

TEST(Modal, BlockWithItsCableIsFoundByTheSameModesAsItsMatrices) {
  Scene scene = test::cable_block();
  scene.analysis = Analysis::modal;
  const Model model = build(scene, test::read_block);
  const test::Trace trace = test::run_all(model);
  ASSERT_EQ(trace.end, RunEnd::done) << trace.failure.detail;
  EXPECT_GT(trace.states[1].frequency, 1.0);
  for (std::size_t i = 2; i < trace.states.size(); ++i)
    EXPECT_GE(trace.states[i].frequency, trace.states[i - 1].frequency);
}

}  // namespace
}  // namespace sinew
