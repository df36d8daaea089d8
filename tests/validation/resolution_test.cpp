// Sections that are too long, and steps between which something happens, are told.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "support/faults.hpp"

namespace sinew::test {
namespace {

using testing::HasSubstr;

// The cable of the example finger, thinner and pushed in: with the density of sections that was recommended, its force
// was 30 % too large without a word.
TEST(Resolution, of_a_cable_that_is_pushed) {
  const auto moved = [](const char* by, int sections) {
    return run_file(std::filesystem::path(SINEW_SOURCE_DIR) / "examples/finger.yaml",
                    {"analysis=quasi_static", "time={step: 0.1, duration: 1}", "gravity=[0, 0, 0]",
                     "rods.cable.section={circle: {radius: 0.2 mm}}", "rods.cable.sections=" + std::to_string(sections),
                     std::string("actuators.pull.displacement={times: [0, 1], values: [0 mm, ") + by + "]}"});
  };
  const RecordedRun few = moved("-5 mm", 15), many = moved("-5 mm", 75);
  ASSERT_TRUE(few.done()) << few.why();
  ASSERT_TRUE(many.done()) << many.why();
  EXPECT_LT(few.last("pull.force"), 1.2 * many.last("pull.force"));  // (both push: below zero)
  const Warning* told = few.warning("coarse_under_push", "rods.cable");
  ASSERT_TRUE(told);
  EXPECT_EQ(told->limit, 0.2);
  // Half a wave of pi sqrt(B / N) for sections of 6 mm.
  const double stiffness = 5e9 * 0.25 * std::numbers::pi * std::pow(0.2e-3, 4),
               half = std::numbers::pi * std::sqrt(stiffness / -few.last("pull.force"));
  EXPECT_NEAR(told->value, 6e-3 / half, 0.1 * told->value);
  EXPECT_FALSE(many.warning("coarse_under_push"));
  const RecordedRun pulled = moved("5 mm", 15);
  ASSERT_TRUE(pulled.done()) << pulled.why();
  EXPECT_FALSE(pulled.warning("coarse_under_push"));
}

// A load that swings between two steps, and is 0 at their ends.
TEST(Resolution, of_formulas_between_steps) {
  const auto told = [](const std::string& formula) {
    const auto file = std::filesystem::path(SINEW_SOURCE_DIR) / "tests/validation/faults/soft_bundle.yaml";
    const runs::LoadedScene scene = runs::load(io::read_scene(file, {"loads.up.factor={formula: '" + formula + "'}"}));
    const Warning* warning = find_warning(scene.model.warnings, "between_steps", "loads.up");
    return warning ? warning->value : 0.0;
  };
  EXPECT_NEAR(told("abs(sin(1000 * pi * t))"), 1.0, 1e-9);  // in steps of 1 ms
  EXPECT_NEAR(told("sin(2000 * pi * t)"), 0.5, 1e-9);
  EXPECT_EQ(told("sin(100 * pi * t)"), 0.0);
  EXPECT_EQ(told("min(1, 50 * t)"), 0.0);
}

// One linearisation for a step of one second: 30 % off, without a word.
TEST(Resolution, of_one_linearisation_for_a_long_step) {
  const RecordedRun run = fault("long_step");
  ASSERT_TRUE(run.done()) << run.why();
  const Warning* told = run.warning("linearisation_off");
  ASSERT_TRUE(told);
  EXPECT_THAT(told->remedy, HasSubstr("leave `newton: 1` out"));
  const Warning* off = run.warning("linearised_step_off");
  ASSERT_TRUE(off);
  EXPECT_NEAR(off->value, 0.3, 0.05);
  const RecordedRun converged = fault("long_step", {"newton={}"});
  EXPECT_EQ(converged.warning("linearisation_off"), nullptr);
  EXPECT_EQ(converged.warning("linearised_step_off"), nullptr);
  // Where the converged step is found in parts alone.
  const RecordedRun stiffer = fault(
      "long_step", {"solids.finger.material.young=1.889 MPa", "actuators.pull.displacement.values=[0, 5.614 mm]"});
  ASSERT_TRUE(stiffer.warning("linearised_step_off"));
  EXPECT_NEAR(stiffer.warning("linearised_step_off")->value, 0.25, 0.05);
}

}  // namespace
}  // namespace sinew::test
