// Rods whose sections are too long to follow what bends them: how much of the elastic energy these miss, and how much
// too little the rod gives way.
#include "sinew/sim/coarse_rods.hpp"

#include "support/recorded_run.hpp"
#include "validation/rods.hpp"

namespace sinew::test {
namespace {

constexpr double kLength = 2.0, kBendingStiffness = 3.0, kForce = 2e-3;

Scene cantilever(int sections, int order) {
  Scene scene =
      straight_rod(kLength, sections, given({0.7, 3.0, kBendingStiffness, 1.0, 1.0, 1.0}), kBending, order, 2);
  add_load(scene, Vec3(0, kForce, 0));
  return scene;
}

// U = F w / 2 of the tip's deflection w: what is missed of it is missed of the energy.
TEST(CoarseRod, misses_a_quarter_over_the_square_of_its_sections_under_a_load_at_its_tip) {
  const double exact = kForce * std::pow(kLength, 3) / (3.0 * kBendingStiffness);
  for (const int sections : {1, 2, 3, 8}) {
    const Solved solved = solve(cantilever(sections, 0));
    const double share = 0.25 / (sections * sections);
    EXPECT_NEAR(missed_energy(solved.model, solved.end(), 0), share, 1e-6) << sections;
    EXPECT_NEAR(1.0 - solved.tip().y() / exact, share, 1e-6) << sections;
    EXPECT_EQ(assess_coarse_rods(solved.model, solved.end()).empty(), share < 0.05) << sections;
  }
  const Solved linear = solve(cantilever(1, 1));  // as its moment is
  EXPECT_NEAR(missed_energy(linear.model, linear.end(), 0), 0.0, 1e-6);
}

// A moment is constant along the rod, as that of a tendon beside it is.
TEST(CoarseRod, misses_nothing_of_an_arc) {
  Scene scene = straight_rod(kLength, 1, given({0.7, 3.0, kBendingStiffness, 1.0, 1.0, 1.0}), kBending, 0, 2);
  add_load(scene, Vec3::Zero(), Vec3(0, 0, 2.0));
  const Solved solved = solve(scene);
  EXPECT_NEAR(missed_energy(solved.model, solved.end(), 0), 0.0, 1e-9);
}

TEST(CoarseRod, is_warned_of_at_rest_and_once_motion_has_died_away) {
  const std::filesystem::path file =
      std::filesystem::path(SINEW_SOURCE_DIR) / "tests/validation/faults/one_section_sags.yaml";
  for (const std::string analysis : {"static", "quasi_static", "dynamic"}) {
    const RecordedRun run = run_file(file, {"analysis=" + analysis}),
                      fine = run_file(file, {"analysis=" + analysis, "rods.a.sections=4"});
    ASSERT_TRUE(run.done()) << run.why();
    ASSERT_TRUE(fine.done()) << fine.why();
    const Warning* told = run.warning("coarse_rod", "rods.a");
    ASSERT_TRUE(told) << analysis;
    EXPECT_GT(told->value, 0.4);
    EXPECT_LT(run.last("tip.z"), 0.0);
    EXPECT_FALSE(fine.warning("coarse_rod")) << analysis;
  }
}

}  // namespace
}  // namespace sinew::test
