// What tables do between two steps is told where steps do not see it.
#include <gtest/gtest.h>

#include <numbers>

#include "sinew/sim/model.hpp"
#include "support/scenes.hpp"

namespace sinew {
namespace {

/// What is said of a rod whose tip is pushed by a table, in steps of 10 ms.
const Warning* told(const Model& model) { return find_warning(model.warnings, "between_steps"); }
Model pushed(const Table& table, Analysis analysis = Analysis::dynamic) {
  Scene scene = test::lone_rod();
  scene.analysis = analysis;
  RodLoad push;
  push.rod = "rod";
  push.at = 0.5;
  push.force = Vec3(0, 0, 0.1);
  push.factor = table;
  scene.loads.emplace_back("push", push);
  return build(scene, test::read_block);
}
Model carried(const FrameMotion& motion) {
  Scene scene = test::lone_rod();
  Frame hand;
  hand.motion = motion;
  scene.frames.emplace_back("hand", hand);
  scene.rods[0].second.frame = "hand";
  return build(scene, test::read_block);
}

TEST(Tables, PulsesBetweenStepsAreTold) {
  const Table pulse{{0.1, 0.104, 0.108}, {0.0, 1.0, 0.0}};
  const Model model = pushed(pulse);
  ASSERT_TRUE(told(model));
  EXPECT_EQ(told(model)->where, "loads.push");
  EXPECT_NEAR(told(model)->value, 1.0, 1e-9);
  EXPECT_EQ(told(model)->remedy, "take steps of 0.004 s at most");
  EXPECT_TRUE(told(pushed(pulse, Analysis::quasi_static)));
  EXPECT_FALSE(told(pushed(pulse, Analysis::statics)));  // of one load, without a grid
}

TEST(Tables, WhatStepsSeeIsNotTold) {
  EXPECT_FALSE(told(pushed({{0.1, 0.2, 0.3}, {0.0, 1.0, 0.0}})));      // on the grid
  EXPECT_FALSE(told(pushed({{0.1, 0.104}, {0.0, 1.0}})));              // it stays: late by less than a step
  EXPECT_FALSE(told(pushed({{0.0, 0.2049, 0.4}, {0.0, 1.0, 0.0}})));   // a peak that is cut by 3 %
  EXPECT_TRUE(told(pushed({{0.0, 0.055, 0.1}, {0.0, 1.0, 0.0}})));     // and by 10 %
  EXPECT_FALSE(told(pushed({{0.6, 0.604, 0.608}, {0.0, 1.0, 0.0}})));  // after the run
  EXPECT_FALSE(told(pushed({{0.0}, {1.0}})));
}

TEST(Tables, FramesThatGoAndComeBackOrTurnFarAreTold) {
  const auto along = [](double x) { return Vec3(x, 0, 0); };
  const Model piston = carried({{0.1, 0.105, 0.11}, {}, {along(0), along(0.1), along(0)}});
  ASSERT_TRUE(told(piston));
  EXPECT_EQ(told(piston)->where, "frames.hand");
  EXPECT_FALSE(told(carried({{0.1, 0.2, 0.3}, {}, {along(0), along(0.1), along(0)}})));
  const auto turning = [&](double each_step) { return carried({{0.0, 0.5}, {along(0), along(50 * each_step)}, {}}); };
  const Model fast = turning(2.0 * std::numbers::pi);
  ASSERT_TRUE(told(fast));
  EXPECT_NEAR(told(fast)->value, 360.0, 1e-9);
  EXPECT_TRUE(told(turning(0.8)));
  EXPECT_FALSE(told(turning(0.7)));
}

}  // namespace
}  // namespace sinew
