// Scenes that fail, and took minutes to say so: each ends soon, with what is the matter.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/faults.hpp"
#include "support/scenes.hpp"

namespace sinew::test {
namespace {

using testing::HasSubstr;

// Two meshes stand inside each other when the run begins, and meet at some 300 places: not one step in minutes. The
// work of their contacts is limited.
TEST(SlowFailures, two_meshes) {
  const RecordedRun run = fault("two_meshes");
  EXPECT_EQ(run.recorded.end, RunEnd::stopped);
  EXPECT_EQ(run.failure().status, Status::max_iterations) << run.why();
  EXPECT_THAT(run.failure().detail, HasSubstr("of disc and ring"));
  EXPECT_LT(run.failure().contact.work, 1.2e11);  // (it was without end)
  EXPECT_TRUE(run.warning("overlap_at_start"));
}

// A capsule on a hull, nine contacts at most: single steps took 40 s and 310 000 sweeps.
TEST(SlowFailures, slow_capsule_hull) {
  const RecordedRun run = fault("slow_capsule_hull");
  EXPECT_TRUE(run.done()) << run.why();
  long sweeps = 0;
  for (const io::RecordedStep& step : run.steps) sweeps += step.counts.sweeps;
  EXPECT_LT(sweeps, 20'000);
}

// 80 kPa in the chambers of a bar of 100 kPa, quadratic tetrahedra: the path turns back at 30 % of the load. It
// wandered on for 240 steps and 40 s, and named neither the pressure nor the place.
TEST(SlowFailures, too_much_pressure) {
  const RecordedRun run = fault("too_much_pressure");
  EXPECT_EQ(run.recorded.end, RunEnd::stopped);
  EXPECT_EQ(run.failure().status, Status::path_lost) << run.why();
  EXPECT_THAT(run.failure().detail, HasSubstr("it came as far as 30 % of the load"));
  EXPECT_THAT(run.failure().detail, HasSubstr("a limit point"));
  EXPECT_THAT(run.failure().detail, HasSubstr("loads.air: pressure 80 kPa on "));
  EXPECT_THAT(run.failure().detail, HasSubstr("0.8 of its Young's modulus"));
  EXPECT_LT(run.steps.size(), 120U);
  int iterations = 0;
  for (const io::RecordedStep& step : run.steps) iterations += static_cast<int>(step.newton);
  EXPECT_LT(iterations, 800);  // (1575)
}

}  // namespace
}  // namespace sinew::test
