// Equilibria told as stable or not, beside the natural frequencies about the same equilibrium, over random scenes:
// columns under loads along them, straight or bent at rest, alone or tied to another one, pulled by tendons or not.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "sinew/sim/modal.hpp"
#include "sinew/sim/newton.hpp"
#include "sinew/sim/run.hpp"
#include "support/random.hpp"
#include "support/scenes.hpp"

namespace sinew {
namespace {

using test::Random;

/// Stress-free with this curvature [1/m].
RestStrains bent(double length, double curvature) {
  Eigen::Matrix<double, 6, 1> strains = Eigen::Matrix<double, 6, 1>::Zero();
  strains[static_cast<int>(Strain::bending_y)] = curvature;
  return {{0.0, length}, {strains, strains}};
}

Scene column(Random& random) {
  using enum Strain;
  static const std::vector<std::vector<Strain>> kStrains = {
      {torsion, bending_y, bending_z, elongation, shear_y, shear_z},
      {torsion, bending_y, bending_z, elongation},
      {torsion, bending_y, bending_z},
      {bending_y, bending_z}};
  Scene scene;
  scene.analysis = Analysis::quasi_static;
  scene.time = {1.0, 1.0};
  scene.gravity = random.chance(0.1) ? Vec3(0, 0, -9.81) : Vec3(Vec3::Zero());
  const double length = random(0.1, 0.3), radius = random(0.5e-3, 4e-3), young = std::pow(10.0, random(6.0, 10.0));
  Rod rod;
  rod.path = {Vec3::Zero(), Vec3(length, 0, 0)};
  const int sections = random.whole(3, 10);
  rod.sections = sections;
  rod.strains = kStrains[static_cast<std::size_t>(random.whole(0, 3))];
  rod.order.fill(random.whole(0, 2));
  rod.section = Circle{radius};
  rod.material = {young, 0.4, 1100.0, 0.0, 0.0};
  if (random.chance(0.3)) {
    rod.start = Start::path;
    rod.rest = bent(length, random(-5.0, 5.0));
  }
  scene.rods.emplace_back("a", rod);
  if (random.chance(0.5)) {
    if (rod.start) rod.rest = bent(length, random(-8.0, 8.0));
    scene.rods.emplace_back("b", rod);
    const int ties = random.whole(1, std::min(4, sections));
    for (int i = 0; i < ties; ++i) {
      Tie tie;
      tie.rod = "a";
      tie.other = "b";
      tie.at = tie.other_at = length * (i + 1) / (ties + 1);
      tie.along = {random.chance(0.3) && rod.strains.size() > 3, true, true};
      scene.couplings.emplace_back(tie);
    }
  }
  const double buckles = std::numbers::pi * std::numbers::pi * young * std::numbers::pi * std::pow(radius, 4) / 4.0 /
                         (4.0 * length * length);
  RodLoad push;
  push.rod = "a";
  push.force = Vec3(-buckles * random(0.0, 4.0), 0, 0);
  if (random.chance(0.2)) push.force.y() = buckles * random(-0.5, 0.5);
  scene.loads.emplace_back("push", push);
  if (random.chance(0.3)) {
    Actuator pull;
    pull.rod = "a";
    pull.tendon = Tendon{};
    pull.tendon->distance = {0.6 * radius, 0.6 * radius};
    pull.driven = Driven::force;
    pull.drive = Table{{0.0}, {buckles * random(0.0, 2.0)}};
    scene.actuators.emplace_back("pull", pull);
  }
  return scene;
}

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

TEST(Stability, IsToldAsNaturalFrequenciesSay) { look_at(60, 1); }
TEST(Stability, IsToldAsNaturalFrequenciesSayManyTimes_slow) { look_at(300, 2); }

}  // namespace
}  // namespace sinew
