// A pre-bent rod in a soft block, pushed and turned at its base (the paper's Fig. 8).
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "support/scenes.hpp"

namespace sinew {
namespace {

using test::mm;

constexpr double kPush = 8 * mm, kCurvature = 25.0;  // [1/m]

/// A block of 60 x 20 x 20 mm that stands on z = 0, and a rod along its axis whose stress-free shape is an arc. The rod
/// sticks out by 12 mm at x = 0, where a motor holds, pushes and turns it.
Scene prebent_rod(int steps) {
  Scene scene;
  scene.analysis = Analysis::quasi_static;
  scene.time = {1.0 / steps, 2.0};
  scene.newton.limit = 60;
  Solid block;
  block.mesh = "block";
  block.material.law = solid::corotational(20e3, 0.4);
  block.density = 1000.0;
  block.fixed.push_back({Box{Vec3(-1, -1, -1 * mm), Vec3(1, 1, 0.1 * mm), In::world}});
  scene.solids.emplace_back("block", block);
  Rod rod;
  rod.path = {Vec3(-12 * mm, 10 * mm, 10 * mm), Vec3(45 * mm, 10 * mm, 10 * mm)};
  rod.sections = 12;
  rod.section = Circle{0.8 * mm};
  rod.material = {2e9, 0.4, 0.0};
  RestStrains arc;
  arc.at = {0.0};
  arc.strains = {Eigen::Matrix<double, 6, 1>::Unit(2) * kCurvature};
  rod.rest = arc;
  rod.start = Start::path;
  scene.rods.emplace_back("rod", rod);
  Slide slide;
  slide.rod = "rod";
  slide.solid = "block";
  slide.anchor_tip = AnchorTip::none;
  for (int i = 0; i <= 10; ++i) slide.channel.emplace_back((2.5 + 5 * i) * mm, 10 * mm, 10 * mm);
  scene.couplings.emplace_back(slide);
  Actuator push;
  push.rod = "rod";
  push.axis = 0;
  push.drive = Table{{0.0, 1.0}, {0.0, kPush}};
  scene.actuators.emplace_back("push", push);
  Actuator turn;
  turn.rod = "rod";
  turn.motion = Motion::rotation;
  turn.driven = Driven::angle;
  turn.drive = Table{{1.0, 2.0}, {0.0, 2.0 * std::numbers::pi}};
  scene.actuators.emplace_back("turn", turn);
  return scene;
}

solid::Mesh read_wide_block(const std::filesystem::path&) {
  return test::block_mesh(12, 4, 4, Vec3(60 * mm, 20 * mm, 20 * mm));
}

int points_on(const State& state) {
  return static_cast<int>(std::count_if(state.points.begin(), state.points.end(), [](const auto& p) { return p.on; }));
}

TEST(Prebent, AFullTurnGivesBackItsWorkAndTwistsTheRod) {
  const Model model = build(prebent_rod(36), read_wide_block);
  Workspace workspace = make_workspace(model);
  State state = initial_state(model);
  double work = 0.0, highest = 0.0, lowest = 0.0, twist = 0.0, uneven = 0.0;
  int on_before = 0, on_after = 0;
  Eigen::Matrix3Xd before;
  State last = state;
  while (state.grid < grid_steps(model.scene)) {
    const StepReport report = advance(model, workspace, state);
    ASSERT_TRUE(accepted(report.status)) << to_string(report.status) << " at " << state.time;
    if (state.time <= 1.0 + 1e-9) {
      if (state.grid == 1) on_before = points_on(state);
      before = state.solids[0].x;
      on_after = points_on(state);
    } else {
      const double dphi = state.rods[0].q[1] - last.rods[0].q[1];
      work += 0.5 * (state.actuators[1] + last.actuators[1]) * dphi;
      highest = std::max(highest, work);
      lowest = std::min(lowest, work);
      const double base = rod::strain(model.rods[0].rod, state.rods[0].q, 0.0)[0];
      const double tip = rod::strain(model.rods[0].rod, state.rods[0].q, 0.99 * model.rods[0].rod.length())[0];
      twist = std::max(twist, std::abs(base));
      uneven = std::max(uneven, std::abs(base - tip));
    }
    last = state;
  }
  RecordProperty("work_J", std::to_string(work));
  RecordProperty("peak_J", std::to_string(highest - lowest));
  RecordProperty("twist_per_m", std::to_string(twist));
  EXPECT_GT(on_after, on_before);  // the tip has reached points that waited for it
  EXPECT_GT(highest - lowest, 1e-6);
  EXPECT_LT(std::abs(work), 0.01 * (highest - lowest));
  EXPECT_LT((state.solids[0].x - before).colwise().norm().maxCoeff(), 1e-6);
  // The torsion is largest at the motor and dies out towards the free tip.
  EXPECT_GT(twist, 0.05);
  EXPECT_GT(uneven, 0.5 * twist);
}

}  // namespace
}  // namespace sinew
