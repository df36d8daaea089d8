// What contact does not do, or does not know, is told; and what it does is not told as trouble.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "support/faults.hpp"

namespace sinew::test {
namespace {

// Nothing can give way between what is held and an obstacle. It went through the floor without a word.
TEST(ContactTold, held_nodes_in_an_obstacle) {
  const RecordedRun run = fault("held_in_floor");
  ASSERT_TRUE(run.done()) << run.why();
  const Warning* told = run.warning("held_in_obstacle");
  ASSERT_TRUE(told);
  EXPECT_NEAR(told->value, 5e-3, 1e-9);
  EXPECT_NEAR(told->time, 0.16, 1e-9);  // (at 0.15 s it touches)
  EXPECT_NE(told->message.find("floor and beam: nodes that are held lie up to 5 mm"), std::string::npos)
      << told->message;
  // The same with what comes to it, and with a mesh; and nothing where it stays outside, or goes with the beam.
  for (const char* shape : {"{plane: {point: [0, 0, -15 mm], normal: [0, 0, 1]}, frame: lift}",
                            "{box: {size: [300 mm, 300 mm, 40 mm]}, pose: {translate: [0, 0, -35 mm]}, frame: lift}",
                            "{mesh: {file: cube.vtk, scale: 0.3}, pose: {translate: [-150 mm, -150 mm, -315 mm]}, "
                            "frame: lift}"}) {
    SCOPED_TRACE(shape);
    for (const auto& [up, inside] : {std::pair{"5 mm", true}, {"-5 mm", false}}) {
      const RecordedRun lifted = fault(
          "held_in_floor", {std::string("obstacles.floor=") + shape, "time.duration=50 ms",
                            "frames={hand: {}, lift: {motion: {times: [0, 50 ms], translate: [[0, 0, 0], [0, 0, " +
                                std::string(up) + "]]}}}"});
      ASSERT_TRUE(lifted.done()) << lifted.why();
      const Warning* of_it = lifted.warning("held_in_obstacle");
      ASSERT_EQ(of_it != nullptr, inside);
      if (inside) EXPECT_NEAR(of_it->value, 5e-3, 1e-6);
    }
  }
}

TEST(ContactTold, held_nodes_that_go_with_an_obstacle) {
  const std::string box = "{box: {size: [4 mm, 40 mm, 40 mm]}, pose: {translate: [-1 mm, 0, -32 mm]}, frame: ";
  for (const auto& [frame, told] : {std::pair{"hand", false}, {"stays", true}}) {
    SCOPED_TRACE(frame);
    const RecordedRun run =
        fault("held_in_floor", {"obstacles.floor=" + box + frame + "}", "frames.stays={}", "time.duration=20 ms"});
    ASSERT_TRUE(run.done()) << run.why();
    EXPECT_EQ(run.warning("held_in_obstacle") != nullptr, told);
  }
}

TEST(ContactTold, flat_rods_that_touch_as_round_ones) {
  const Model model = fault("ribbon_lies_flat").loaded.model;
  const Warning* told = find_warning(model.warnings, "round_in_contact", "rods.ribbon");
  ASSERT_TRUE(told);
  EXPECT_NEAR(told->value, std::hypot(0.5e-3, 5e-3) - 0.5e-3, 1e-12);
  for (const char* change : {"rods.ribbon.section={circle: {radius: 5 mm}}", "obstacles={}"}) {
    SCOPED_TRACE(change);
    std::vector<std::string> changes = {change};
    if (std::string(change) == "obstacles={}") changes.push_back("outputs={}");
    EXPECT_FALSE(find_warning(fault("ribbon_lies_flat", changes).loaded.model.warnings, "round_in_contact"));
  }
}

// Euler's load of a column, clamped and pinned: 20.19 E I / L^2. What friction holds was never judged: 23 times that
// load stood, straight, as `not known`.
TEST(ContactTold, a_column_that_friction_holds_buckles) {
  const RecordedRun run = fault("rod_pushed_at_wall");
  ASSERT_TRUE(run.done()) << run.why();
  const double euler = 20.19 * 100e6 * 0.25 * std::numbers::pi * std::pow(2e-3, 4) / (0.2 * 0.2);
  const Warning* told = run.warning("unstable");
  ASSERT_TRUE(told);
  const std::vector<double> force = run.signal("f.normal");
  const auto at = static_cast<std::size_t>(std::lround(told->time / 1e-3));
  EXPECT_LT(force[at - 1], 1.02 * euler);
  EXPECT_GT(force[at], 0.98 * euler);
  EXPECT_FALSE(fault("rod_pushed_at_wall", {"time.duration=" + std::to_string(told->time - 2e-3)}).warning("unstable"));
}

// What lifts it is the contact's work, and no energy from nowhere.
TEST(ContactTold, what_overlaps_at_the_start_is_lifted_by_contacts) {
  const RecordedRun run = fault("cube_in_floor");
  ASSERT_TRUE(run.done()) << run.why();
  EXPECT_TRUE(run.warning("overlap_at_start"));
  EXPECT_FALSE(run.warning("energy_gain"));
  const double lifted = 1000.0 * std::pow(0.02, 3) * 9.81 * 3e-3;
  EXPECT_GT(run.last("energy.work"), lifted);
  EXPECT_NEAR(run.last("energy.weight") - run.signal("energy.weight").front(), lifted, 0.02 * lifted);
  EXPECT_GT(run.last("energy.dissipated"), 0.0);
}

TEST(ContactTold, rounding_is_no_contact_that_was_not_solved) {
  const RecordedRun run = fault("box_tips_linearised");
  ASSERT_TRUE(run.done()) << run.why();
  EXPECT_TRUE(run.warning("linearisation_off"));
  EXPECT_FALSE(run.warning("contact_unsolved"));
}

}  // namespace
}  // namespace sinew::test
