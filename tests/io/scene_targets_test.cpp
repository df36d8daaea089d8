// What is to be found, and where it is to lead.
#include <gtest/gtest.h>

#include <numbers>

#include "broken_scene.hpp"
#include "full_scene.hpp"

namespace sinew::io {
namespace {

constexpr double kDegree = std::numbers::pi / 180.0;

TEST(SceneTargets, ReadsTargetsAndLimits) {
  const Scene scene = parse_scene(inverse_scene, "scene.yaml", "").scene;
  const Actuator& pull = scene.actuators[0].second;
  EXPECT_TRUE(std::holds_alternative<Sought>(pull.drive));
  EXPECT_EQ(pull.driven, Driven::force);
  ASSERT_TRUE(pull.limits.force.has_value());
  EXPECT_EQ(pull.limits.force->least, 0.5);
  EXPECT_EQ(pull.limits.force->most, 20.0);
  EXPECT_EQ(pull.limits.displacement.least, -1e-3);
  EXPECT_EQ(pull.limits.displacement.most, 0.03);
  EXPECT_EQ(pull.limits.speed, 0.05);
  EXPECT_EQ(pull.limits.force_rate, 20.0);
  EXPECT_EQ(pull.preferred, 1.0);
  const Limits& turn = scene.actuators[1].second.limits;
  EXPECT_EQ(turn.force->least, -std::numeric_limits<double>::infinity());
  EXPECT_EQ(turn.force->most, 2e-3);
  EXPECT_DOUBLE_EQ(turn.displacement.most, 90 * kDegree);
  EXPECT_DOUBLE_EQ(*turn.speed, 90 * kDegree);

  ASSERT_EQ(scene.targets.size(), 3u);
  const Target& tip = scene.targets[0];
  EXPECT_EQ(tip.output, "tip");
  EXPECT_EQ(tip.weights, (std::vector<double>{1, 1, 0}));
  EXPECT_EQ(tip.tolerance, 1e-3);
  const Track& track = std::get<Track>(tip.at);
  EXPECT_EQ(track.times, (std::vector<double>{0, 1}));
  EXPECT_EQ(track.values[1], Vec3(0.09, 0, 0.03));
  const Target& nail = scene.targets[1];
  EXPECT_TRUE(std::get<Track>(nail.at).values[0].isApprox(Vec3(0, 0, 20 * kDegree)));
  EXPECT_DOUBLE_EQ(*nail.tolerance, kDegree);
  EXPECT_TRUE(std::holds_alternative<External>(scene.targets[2].at));
  EXPECT_EQ(scene.targets[2].strain, Strain::bending_z);
}

TEST(SceneTargets, SaysWhatIsWrong) {
  const Broken cases[] = {
      {"  tip: {at:", "  hand: {at:", 26, "targets.hand", "", "is not the name of an output", "outputs:"},
      {"[0.1, 0, 0]", "[0.1, 0]", 26, "targets.tip.at.values.0", "", "3", ""},
      {"[0, 0, 20 deg]", "[0, 0, 20 mm]", 27, "targets.nail.at.2", "20 mm", "angle", "deg"},
      {"times: [0, 1], values", "times: [1, 0], values", 26, "targets.tip.at.times.1", "0", "greater than", ""},
      {"weights: [1, 1, 0]", "weights: [1, -1, 0]", 26, "targets.tip.weights.1", "-1", "at least 0", ""},
      {"tolerance: 1 mm", "tolerance: 0 mm", 26, "targets.tip.tolerance", "0 mm", "greater than 0", ""},
      {"tolerance: 1 deg", "tolerance: 1 mm", 27, "targets.nail.tolerance", "1 mm", "angle", "deg"},
      {"strain: bending_z", "strain: bending", 28, "targets.bend.strain", "bending", "must be one of", "bending_y"},
      {"at: external, ", "", 28, "targets.bend.at", "", "is missing", "at"},
      {"[0.5 N, 20 N]", "[20 N, 0.5 N]", 15, "actuators.pull.limits.force", "", "least above its most", "least first"},
      {"[0.5 N, 20 N]", "{}", 15, "actuators.pull.limits.force.least", "", "", "least"},
      {"speed: 50 mm/s", "speed: 0 mm/s", 15, "actuators.pull.limits.speed", "0 mm/s", "greater than 0", ""},
      {"speed: 50 mm/s", "torque: [0, 1]", 15, "actuators.pull.limits.torque", "", "does not turn", "force"},
      {"angle: [-90 deg, 90 deg]", "displacement: [0, 1]", 17, "actuators.turn.limits.displacement", "", "what turns",
       "angle"},
      {"force_rate: 20 N/s", "force_rate: 20 N", 15, "actuators.pull.limits.force_rate", "20 N", "rate of force",
       "N/s"},
  };
  for (const Broken& broken : cases) expect_refused(inverse_scene, broken);
}

}  // namespace
}  // namespace sinew::io
