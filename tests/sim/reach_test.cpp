// What the motors can bring an output to.
#include "sinew/sim/reach.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>

#include "sinew/error/input_error.hpp"
#include "sinew/sim/motors.hpp"
#include "sinew/sim/places.hpp"
#include "sinew/sim/statics.hpp"
#include "support/meshes.hpp"
#include "support/robots.hpp"

namespace sinew::test {
namespace {

Scene two_cables(double most) {
  Scene scene = block();
  scene.analysis = Analysis::quasi_static;
  scene.newton.iterations = 0;
  add_cable(scene, "other", {Vec3(0, 3 * mm, 5 * mm), Vec3(50 * mm, 3 * mm, 5 * mm)}, 10, evenly(50 * mm, 10), 0.5 * mm,
            0.0);
  add_target(scene, Vec3(50 * mm, 5 * mm, 5 * mm), most);
  return scene;
}

TEST(Reach, SpreadsCommandsOverTheLimits) {
  const Model two = build(two_cables(4.0), block_of(100));
  const auto many = spread_commands(two, 400);
  ASSERT_EQ(many.size(), 400U);
  for (const double a : {0.0, 4.0}) {
    for (const double b : {0.0, 4.0}) EXPECT_NE(std::find(many.begin(), many.end(), std::vector{a, b}), many.end());
  }
  int counts[4][4] = {};
  for (std::size_t i = 4; i < many.size(); ++i) {
    for (const double force : many[i]) {
      EXPECT_GE(force, 0.0);
      EXPECT_LE(force, 4.0);
    }
    ++counts[std::min(3, static_cast<int>(many[i][0]))][std::min(3, static_cast<int>(many[i][1]))];
  }
  for (const auto& row : counts) {
    for (const int count : row) EXPECT_NEAR(count, 396 / 16.0, 4.0);
  }
  Scene scene = two_cables(4.0);
  scene.actuators[1].second.drive = Table{{0.0}, {0.0}};
  const auto line = spread_commands(build(scene, block_of(100)), 5);
  ASSERT_EQ(line.size(), 5U);
  for (std::size_t i = 0; i < line.size(); ++i) EXPECT_DOUBLE_EQ(line[i][0], static_cast<double>(i));
  EXPECT_THROW(spread_commands(build(two_cables(INFINITY), block_of(100)), 5), InputError);
}

/// Each is the equilibrium of its commands, whatever was found before it.
TEST(Reach, FindsTheEquilibriumOfEach) {
  Scene scene = two_cables(4.0);
  scene.actuators[0].second.limits.displacement = {-1.0, 0.4 * mm};
  const Model model = build(scene, block_of(300));
  Workspace workspace = make_workspace(model);
  int count = 0, within = 0;
  sample_reach(model, spread_commands(model, 12), [&](const ReachSample& sample) {
    ++count;
    EXPECT_TRUE(accepted(sample.status));
    const StepResult own = equilibrium_step(model, workspace, {sample.commands, {}}, initial_state(model), 0.01);
    EXPECT_TRUE(accepted(own.report.status));
    EXPECT_LT(
        (output_position(model, own.next, model.outputs[0]) - output_position(model, sample.state, model.outputs[0]))
            .norm(),
        1e-8);
    EXPECT_EQ(sample.forces, sample.commands);
    EXPECT_NEAR(sample.positions[0], motor_positions(model, own.next)[0], 1e-9);
    EXPECT_EQ(sample.within, sample.positions[0] <= 0.4 * mm);
    within += sample.within ? 1 : 0;
    return count < 10;
  });
  EXPECT_EQ(count, 10);
  EXPECT_GT(within, 0);
  EXPECT_LT(within, 10);
}

}  // namespace
}  // namespace sinew::test
