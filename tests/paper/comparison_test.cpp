// The comparison finger on the public mesh: against an independent prototype, and against itself.
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>

#include "sinew/io/mesh_file.hpp"
#include "support/scenes.hpp"

namespace sinew::test {
namespace {

const std::filesystem::path kFinger = std::filesystem::path(SINEW_SHARED_MESHES) / "finger.vtk";

Trace simulate(const Scene& scene, Model* keep = nullptr) {
  const Model model = build(scene, io::read_mesh);
  Trace trace = run_all(model);
  EXPECT_EQ(trace.end, RunEnd::done) << to_string(trace.failure.status);
  for (const StepReport& report : trace.reports) {
    EXPECT_LT(report.violation, 1e-9);
    EXPECT_EQ(report.status, Status::converged);
  }
  if (keep) *keep = model;
  return trace;
}

/// Tip positions [mm] of an independent prototype of the same scene (polar rotations, converged Newton).
struct Reference {
  double pull;
  Vec3 tip;
  double travel;
};
const Reference kPrototype[] = {{5 * mm, {79.63, 14.21, 0.54}, 20.6}, {10 * mm, {68.22, 30.55, 0.30}, 39.3}};
/// The same with the geometric cable (another program: frames from edges, one linearised step).
const Reference kGeometric[] = {{5 * mm, {79.11, 16.26, 0.25}, 22.7}, {10 * mm, {65.81, 33.66, -0.41}, 43.8}};

TEST(Comparison, tip_is_within_two_percent_of_its_travel_of_the_prototype) {
  for (const Reference& reference : kPrototype) {
    Model model;
    const Trace trace = simulate(comparison_finger(kFinger, reference.pull), &model);
    const double off = (tip(model, trace.states.back()) / mm - reference.tip).norm();
    RecordProperty("off_mm_at_" + std::to_string(static_cast<int>(reference.pull / mm)), std::to_string(off));
    EXPECT_LT(off, 0.02 * reference.travel) << "pull " << reference.pull;
  }
}

TEST(Comparison, geometric_cable_is_within_eight_percent) {
  for (const Reference& reference : kGeometric) {
    Scene scene = comparison_finger(kFinger, reference.pull);
    scene.rods[0].second.cable = Cable::geometric;
    Model model;
    const Trace trace = simulate(scene, &model);
    EXPECT_LT((tip(model, trace.states.back()) / mm - reference.tip).norm(), 0.08 * reference.travel)
        << "pull " << reference.pull;
  }
}

/// From 0 to `pull` in `seconds` without a jump of speed or acceleration. (Pulled at full speed at once, the body's
/// start-up is a jump of the tip's speed of its own.)
Table smooth_pull(double pull, double seconds) {
  Table table;
  for (int i = 0; i <= 400; ++i) {
    const double t = i / 400.0;
    table.times.push_back(seconds * t);
    table.values.push_back(pull * t * t * t * (10.0 + t * (6.0 * t - 15.0)));
  }
  return table;
}

TEST(Comparison, force_grows_with_the_pull_and_the_tip_moves_smoothly) {
  double force = 0.0;
  for (double pull : {5 * mm, 10 * mm, 15 * mm, 20 * mm}) {
    Model model;
    Scene scene = comparison_finger(kFinger, pull);
    const double seconds = pull / 0.01;
    scene.actuators[0].second.drive = smooth_pull(pull, seconds);
    const Trace trace = simulate(scene, &model);
    EXPECT_GT(trace.states.back().actuators[0], force);
    force = trace.states.back().actuators[0];

    std::vector<double> second;  // differences of the tip's path, every step of the pull
    const long pulling = std::lround(seconds / model.scene.time.step);
    for (long i = 1; i + 1 <= pulling; ++i) {
      second.push_back(
          (tip(model, trace.states[i + 1]) - 2.0 * tip(model, trace.states[i]) + tip(model, trace.states[i - 1]))
              .norm());
    }
    std::vector<double> sorted = second;
    std::sort(sorted.begin(), sorted.end());
    const double median = sorted[sorted.size() / 2];
    EXPECT_GT(median, 0.0);
    EXPECT_LT(sorted.back(), 5.0 * median) << "pull " << pull;
    RecordProperty("ratio_at_" + std::to_string(static_cast<int>(pull / mm + 0.5)),
                   std::to_string(sorted.back() / median));
  }
}

TEST(Comparison, force_at_rest_does_not_depend_on_the_time_step) {
  std::vector<double> forces;
  for (double h : {0.02, 0.01, 0.005}) {
    Scene scene = comparison_finger(kFinger, 20 * mm);
    scene.time.step = h;
    forces.push_back(simulate(scene).states.back().actuators[0]);
  }
  EXPECT_GT(forces[0], 1.0);
  EXPECT_NEAR(forces[0], forces[1], 1e-3 * forces[1]);
  EXPECT_NEAR(forces[2], forces[1], 1e-3 * forces[1]);
}

TEST(Comparison, a_rigid_motion_of_the_scene_changes_nothing) {
  const Pose rigid{{0.7, -0.4, 2.1}, {0.3, -1.2, 0.8}};
  const Placement move = placement(rigid);
  Model here_model, there_model;
  const Trace here = simulate(comparison_finger(kFinger, 10 * mm), &here_model);
  const Trace there = simulate(comparison_finger(kFinger, 10 * mm, 0.01, rigid), &there_model);
  ASSERT_EQ(here.states.size(), there.states.size());
  const double travel = (tip(here_model, here.states.back()) - tip(here_model, here.states.front())).norm();
  const double force = here.states.back().actuators[0];
  EXPECT_GT(travel, 30 * mm);
  for (std::size_t i = 0; i < here.states.size(); ++i) {
    EXPECT_LT((apply(move, tip(here_model, here.states[i])) - tip(there_model, there.states[i])).norm(), 1e-8 * travel)
        << i;
    EXPECT_NEAR(here.states[i].actuators[0], there.states[i].actuators[0], 1e-8 * force) << i;
  }
}

TEST(Comparison, turning_by_moving_the_frame_gives_what_a_rigid_motion_gives) {
  // Attached to a frame at rest there, instead of posed there.
  const Pose rigid{{0.7, -0.4, 2.1}, {0.3, -1.2, 0.8}};
  Scene scene = comparison_finger(kFinger, 5 * mm);
  scene.frames.emplace_back("hand", Frame{rigid, std::nullopt});
  scene.solids[0].second.frame = "hand";
  scene.rods[0].second.frame = "hand";
  Model a, b;
  const Trace there = simulate(scene, &a), posed = simulate(comparison_finger(kFinger, 5 * mm, 0.01, rigid), &b);
  EXPECT_LT((tip(a, there.states.back()) - tip(b, posed.states.back())).norm(), 1e-10);
}

// No meshing rule: every pair of sections and points.
class Meshing : public testing::TestWithParam<std::tuple<int, int>> {};

TEST_P(Meshing, any_sections_with_any_points_converge) {
  const auto [sections, points] = GetParam();
  Scene scene = comparison_finger(kFinger, 20 * mm, 0.04);
  scene.time = {0.02, 0.6};
  scene.rods[0].second.sections = sections;
  test::slide(scene, 0).points = points;
  Model model;
  const Trace trace = simulate(scene, &model);
  const Vec3 x = tip(model, trace.states.back()) / mm;
  EXPECT_TRUE(x.allFinite());
  EXPECT_GT((x - Vec3(85.5, -5.5, 0.5)).norm(), 60.0);  // it bends, however it is tied: no locking
  EXPECT_EQ(model.couplings[0].asked, points);
  EXPECT_EQ(model.couplings[0].kept + static_cast<int>(model.couplings[0].redundant.size()), points);
  if (points == 101) {
    EXPECT_GT(model.couplings[0].redundant.size(), 50u);
  }
  if (points == 5) {
    EXPECT_TRUE(model.couplings[0].redundant.empty());
  }
}

INSTANTIATE_TEST_SUITE_P(EveryPair, Meshing,
                         testing::Combine(testing::Values(3, 6, 15, 80), testing::Values(5, 15, 31, 101)));

}  // namespace
}  // namespace sinew::test
