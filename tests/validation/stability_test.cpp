// Equilibria told as stable or not, beside the natural frequencies about the same equilibrium, over random scenes:
// columns under loads along them, straight or bent at rest, alone or tied to another one, pulled by tendons or not.
#include <gtest/gtest.h>

#include <cmath>

#include "sinew/sim/modal.hpp"
#include "sinew/sim/newton.hpp"
#include "sinew/sim/run.hpp"
#include "support/columns.hpp"
#include "support/scenes.hpp"

namespace sinew {
namespace {

using test::column;
using test::Random;

struct Verdicts {
  int stable = 0, unstable = 0, unknown = 0, neutral = 0, stopped = 0, wrong = 0;
};

Verdicts judge(int count, unsigned seed) {
  Random random(seed);
  Verdicts found;
  for (int i = 0; i < count; ++i) {
    Scene scene = column(random);
    const Model at_rest = build(scene, test::read_block);
    Workspace workspace(at_rest);
    State state = initial_state(at_rest);
    const StepReport report = advance(at_rest, workspace, state);
    if (!accepted(report.status)) {
      ++found.stopped;
      continue;
    }
    scene.analysis = Analysis::modal;
    scene.modes = 4;
    const Model modal = build(scene, test::read_block);
    Workspace room(modal);
    std::string failed;
    const std::vector<NaturalMode> modes = natural_modes(modal, room, state, 4, failed);
    EXPECT_FALSE(modes.empty()) << failed;
    if (modes.empty()) continue;
    const double first = modes.front().frequency;
    double highest = 0.0;
    for (const NaturalMode& mode : modes) highest = std::max(highest, std::abs(mode.frequency));
    if (std::abs(first) < 1e-3 * highest) {
      ++found.neutral;
    } else if (!report.stability_known) {
      ++found.unknown;
    } else {
      const bool wrong = report.unstable != (first < 0.0);
      found.wrong += wrong;
      EXPECT_FALSE(wrong) << "scene " << i << ": told as " << (report.unstable ? "unstable" : "stable") << ", " << first
                          << " Hz of " << highest << " Hz";
      ++(report.unstable ? found.unstable : found.stable);
    }
  }
  return found;
}

void look_at(int count, unsigned seed) {
  const Verdicts found = judge(count, seed);
  EXPECT_GT(found.stable, count / 10);
  EXPECT_GT(found.unstable, count / 10);
  EXPECT_LE(found.unknown, 0.03 * count);
}

// A force that turns with the rod has no potential: eigenvalues of its tangent say nothing of how the rod moves.
TEST(Stability, OfAFollowerLoadIsNotKnown) {
  for (const bool follower : {false, true}) {
    Random random(3);
    Scene scene = column(random);
    scene.actuators.clear();
    std::get<RodLoad>(scene.loads[0].second).follower = follower;
    const Model model = build(scene, test::read_block);
    Workspace workspace(model);
    State state = initial_state(model);
    const StepReport report = advance(model, workspace, state);
    ASSERT_TRUE(accepted(report.status)) << report.detail;
    EXPECT_EQ(report.stability_known, !follower);
    EXPECT_FALSE(follower && report.unstable);
  }
}

// A round rod that may spin about its axis rests as well at any turn: its verdict was chance, the sign of rounding.
TEST(Stability, OfARodThatSpinsFreelyIsNotChance) {
  for (const bool spins : {false, true}) {
    Scene scene = test::lone_rod();
    scene.analysis = Analysis::quasi_static;
    scene.time = {0.1, 1.0};
    scene.gravity = Vec3(0, 0, -9.81);
    Rod& rod = scene.rods[0].second;
    rod.strains = {Strain::torsion, Strain::bending_y, Strain::bending_z};
    if (spins) rod.base = {BaseAxis::turn_x};
    RodLoad swings;
    swings.rod = "rod";
    swings.force = Vec3(0, 0, -0.1);
    swings.factor = Table{{0.0, 1.0}, {0.0, 1.0}};
    scene.loads.emplace_back("swings", swings);
    const Model model = build(scene, test::read_block);
    Workspace workspace(model);
    State state = initial_state(model);
    for (int i = 0; i < 10; ++i) {
      const StepReport report = advance(model, workspace, state);
      ASSERT_TRUE(accepted(report.status)) << report.detail;
      EXPECT_TRUE(report.stability_known);
      EXPECT_FALSE(report.unstable) << "spins " << spins << ", step " << i;
      EXPECT_EQ(find_warning(report.warnings, "free_motion", "rods.rod") != nullptr, spins) << "step " << i;
    }
  }
}

/// A steel pin that stands up from a hinge (1), or hangs from it (-1).
Scene pin_on_a_hinge(double up, Analysis analysis) {
  Scene scene = test::lone_rod(7800.0, 2);
  scene.analysis = analysis;
  scene.time = {0.5, 1.0};
  scene.gravity = Vec3(0, 0, -9.81);
  Rod& pin = scene.rods[0].second;
  pin.path = {Vec3::Zero(), Vec3(0, 0, up * 0.01)};
  pin.base = {BaseAxis::turn_y};
  pin.section = Circle{4e-3};
  pin.material.young = 2e11;
  scene.outputs.clear();
  return scene;
}

// A stiff pin on a hinge: its weight resists little beside its bending stiffness, 5e-8 of it, and decides all the same.
TEST(Stability, OfAPinOnAHingeIsThatOfAPendulum) {
  for (const double up : {-1.0, 1.0}) {
    const Model model = build(pin_on_a_hinge(up, Analysis::quasi_static), test::read_block);
    Workspace workspace(model);
    State state = initial_state(model);
    const StepReport report = advance(model, workspace, state);
    ASSERT_TRUE(accepted(report.status)) << report.detail;
    EXPECT_TRUE(report.stability_known);
    EXPECT_EQ(report.unstable, up > 0.0);
    EXPECT_EQ(find_warning(report.warnings, "free_motion"), nullptr);
  }
}

// And nothing resists it where the path of equilibria begins, without its weight: that is no chance of where it rests.
TEST(Stability, OfAPinThatHangsIsNotJudgedWithoutItsWeight) {
  const Scene scene = pin_on_a_hinge(-1.0, Analysis::statics);
  const Model model = build(scene, test::read_block);
  Workspace workspace(model);
  State state = initial_state(model);
  for (int step = 0; !run_whole(scene, state.time) && step < 100; ++step) {
    const StepReport report = advance(model, workspace, state);
    ASSERT_TRUE(accepted(report.status)) << report.detail;
    EXPECT_EQ(find_warning(report.warnings, "free_motion"), nullptr) << state.time;
  }
  EXPECT_TRUE(run_whole(scene, state.time));
}

TEST(Stability, IsToldAsNaturalFrequenciesSay) { look_at(60, 1); }
TEST(Stability, IsToldAsNaturalFrequenciesSayManyTimes_slow) { look_at(300, 2); }

}  // namespace
}  // namespace sinew
