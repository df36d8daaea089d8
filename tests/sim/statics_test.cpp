#include "sinew/sim/statics.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "support/scenes.hpp"

namespace sinew {
namespace {

/// A circular arch of radius 100 in the x-y plane, opening 215 degrees, E I = 1e6, clamped at its base, pinned at its
/// tip, with a dead load on the apex.
Scene deep_arch(double load, int sections, int order) {
  Scene scene;
  scene.analysis = Analysis::statics;
  scene.time.duration = 1.0;
  Rod rod;
  constexpr int kPoints = 200;
  for (int i = 0; i <= kPoints; ++i) {
    const double angle = (197.5 - 215.0 * i / kPoints) * std::numbers::pi / 180.0;
    rod.path.push_back(100.0 * Vec3(std::cos(angle), std::sin(angle), 0.0));
  }
  rod.sections = sections;
  rod.strains = {Strain::bending_y};  // y is z of the world
  rod.order[1] = order;
  GivenSection section;
  section.stiffness.diagonal().setConstant(1e6);
  section.radius = 1.0;
  rod.section = section;
  scene.rods.emplace_back("arch", rod);
  Tie pin;
  pin.rod = "arch";
  pin.along = {true, true, false};
  scene.couplings.emplace_back(pin);
  Load down;
  down.rod = "arch";
  down.at = 0.5 * 100.0 * 215.0 * std::numbers::pi / 180.0;
  down.force = Vec3(0, -load, 0);
  scene.loads.emplace_back("down", down);
  return scene;
}

TEST(Statics, DeepArchBucklesAtTheLoadOfDaDeppoAndSchmidt) {
  // P_cr = 897 (DaDeppo and Schmidt 1975); the path goes on past the limit point.
  const Scene scene = deep_arch(1200.0, 40, 0);
  const Model model = build(scene, test::read_block);
  Workspace workspace = make_workspace(model);
  State state = initial_state(model);
  double highest = 0.0;
  bool fell = false;
  int steps = 0;
  while (state.grid == 0 && steps < 400) {
    const StepResult result = advance(model, workspace, state);
    ASSERT_TRUE(accepted(result.report.status)) << to_string(result.report.status) << " at " << state.time;
    state = result.next;
    ++steps;
    highest = std::max(highest, 1200.0 * state.time);
    if (1200.0 * state.time < highest - 50.0) {
      fell = true;
      break;
    }
  }
  EXPECT_TRUE(fell) << "no limit point up to " << highest;
  EXPECT_NEAR(highest, 897.0, 0.01 * 897.0);
  std::printf("limit load %.2f in %d steps\n", highest, steps);
}

}  // namespace
}  // namespace sinew
