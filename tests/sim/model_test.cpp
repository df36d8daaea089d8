// What `build` refuses and warns of.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "sinew/error/input_error.hpp"
#include "sinew/sim/step.hpp"
#include "support/scenes.hpp"

namespace sinew {
namespace {

using test::mm;

TEST(Build, a_solid_that_nothing_holds_may_fly_but_has_no_equilibrium) {
  Scene scene = test::cable_block();
  scene.solids[0].second.fixed.clear();
  scene.rods.clear();
  scene.couplings.clear();
  scene.actuators.clear();
  const Model model = build(scene, test::read_block);
  ASSERT_EQ(model.warnings.size(), 1u);
  EXPECT_NE(to_string(model.warnings[0]).find("free to move and turn every way"), std::string::npos);
  scene.analysis = Analysis::quasi_static;
  try {
    build(scene, test::read_block);
    FAIL() << "accepted";
  } catch (const InputError& error) {
    EXPECT_EQ(error.fault().path, "solids.block.fixed");
    EXPECT_NE(error.fault().rule.find("free to move and turn every way"), std::string::npos);
  }
}

TEST(Warnings, numbers_that_are_too_large_and_rods_beside_their_solid_are_told) {
  const auto warnings = [](const auto& change) {
    Scene scene = test::cable_block();
    change(scene);
    return to_strings(build(scene, test::read_block).warnings);
  };
  EXPECT_THAT(warnings([](Scene&) {}), testing::IsEmpty());
  EXPECT_THAT(warnings([](Scene& scene) {
                scene.actuators[0].second.drive = Table{{0.0}, {2.0}};
              }),
              testing::ElementsAre("actuators.pull.displacement: 2 m is more than the rod's length of 0.06 m; numbers "
                                   "without a unit are metres"));
  EXPECT_THAT(warnings([](Scene& scene) {
                scene.actuators[0].second.driven = Driven::force;
                scene.actuators[0].second.drive = Table{{0.0}, {2.0}};
              }),
              testing::IsEmpty());
  EXPECT_THAT(warnings([](Scene& scene) { scene.rods[0].second.section = Circle{0.04}; }),
              testing::ElementsAre("rods.cable: its radius of 0.04 m is more than half its length of 0.06 m; numbers "
                                   "without a unit are metres"));
  EXPECT_THAT(
      warnings([](Scene& scene) { scene.solids[0].second.material.law = solid::corotational(0.25, 0.4); }),
      testing::ElementsAre("solids.block: Young's modulus is 0.25 Pa, less than that of any gel; numbers without "
                           "a unit are pascals"));
  EXPECT_THAT(warnings([](Scene& scene) { scene.rods[0].second.material.young = 5; }),
              testing::ElementsAre("rods.cable: Young's modulus is 5 Pa, less than that of any gel; numbers without a "
                                   "unit are pascals"));
  EXPECT_THAT(warnings([](Scene& scene) { scene.time.step = 10; }),
              testing::ElementsAre("time.step: 10 s is longer than the run of 0.2 s; numbers without a unit are "
                                   "seconds"));
  EXPECT_THAT(warnings([](Scene& scene) { scene.rods[0].second.path[1].x() = 63 * mm; }),
              testing::ElementsAre("couplings.0.slide: the rod's tip, which is anchored, lies 0.003 m outside "
                                   "solids.block; should the rod end in the body?"));
  EXPECT_THAT(warnings([](Scene& scene) {
                for (Vec3& x : scene.rods[0].second.path) x.z() += 4 * mm;
              }),
              testing::ElementsAre("couplings.0.slide: 6 of 6 points lie outside solids.block, up to 0.002 m, and are "
                                   "tied to the nearest elements; is the rod where it should be?"));
}

}  // namespace
}  // namespace sinew
