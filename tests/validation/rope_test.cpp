// Ropes on a fixed drum: Euler's and Eytelwein's law, and how far a heavy one may hang over.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "sinew/rod/path.hpp"
#include "support/scenes.hpp"

namespace sinew {
namespace {

using test::mm;

constexpr double kDrum = 50 * mm, kRope = 1 * mm, kMu = 0.3, kGravity = 9.81;

/// A rope over the upper half of a drum about y, hanging down by `left` and `right` [m].
Scene rope_over_drum(double left, double right, const RodMaterial& material) {
  Scene scene;
  scene.contact.friction = kMu;
  Obstacle drum;
  drum.shape = CylinderShape{kDrum, 100 * mm};
  drum.pose.rotate = {0.5 * std::numbers::pi, 0, 0};
  scene.obstacles.emplace_back("drum", drum);
  Rod rope;
  const double axis = kDrum + kRope;
  rope.path.emplace_back(-axis, 0, -left);
  constexpr int kParts = 30;
  std::vector<double> ends{0.0};
  const auto add = [&](double length, int parts) {
    const double from = ends.back();
    for (int k = 1; k <= parts; ++k) ends.push_back(from + length * k / parts);
  };
  for (int k = 0; k <= kParts; ++k) {
    const double turned = std::numbers::pi * k / kParts;
    rope.path.emplace_back(-axis * std::cos(turned), 0, axis * std::sin(turned));
  }
  rope.path.emplace_back(axis, 0, -right);
  const int coarse = 8;
  add(left, coarse);
  add(axis * std::numbers::pi, kParts);
  add(right, coarse);
  const double length = rod::Path(rope.path).length();
  for (double& end : ends) end *= length / ends.back();
  rope.sections = ends;
  rope.section = Circle{kRope};
  rope.rest = Rest::path;  // what it takes to bend it is left out
  rope.start = Start::path;
  rope.material = material;
  rope.strains = {Strain::torsion, Strain::bending_y, Strain::bending_z, Strain::elongation};
  scene.rods.emplace_back("rope", rope);
  return scene;
}

TEST(Rope, DrawnOverADrumFollowsTheCapstanLaw) {
  Scene scene = rope_over_drum(40 * mm, 40 * mm, {3e7, 0.4, 1000.0, 300.0});
  scene.time = {0.005, 0.4};
  Actuator draw;
  draw.rod = "rope";
  draw.drive = Table{{0.1, 0.4}, {0.0, 12 * mm}};
  scene.actuators.emplace_back("draw", draw);
  RodLoad weight;
  weight.rod = "rope";
  weight.force = Vec3(0, 0, -1.0);
  weight.factor = Table{{0.0, 0.1}, {0.0, 1.0}};
  scene.loads.emplace_back("weight", weight);
  const Model model = build(scene, test::read_block);
  const test::Trace trace = test::run_all(model);
  ASSERT_EQ(trace.end, RunEnd::done) << to_string(trace.failure.status);
  // Friction acts at the surface, tension along the axis: by moments about the drum's own, exp(mu pi) is exact for a
  // thin rope, and for this one there are 2 % of its logarithm less.
  const double thin = std::exp(kMu * std::numbers::pi),
               thick = std::exp(kMu * std::numbers::pi * kDrum / (kDrum + kRope));
  EXPECT_NEAR(trace.states.back().actuators[0], thin, 0.02 * thin);
  EXPECT_NEAR(trace.states.back().actuators[0], thick, 0.007 * thick);
}

/// How far the right end may hang down before a rope with the left one at `left` slides: the solution of
/// dT/dt = mu (T + w R sin t) + w R cos t over the upper half of the drum, t from its left end.
double critical_overhang(double left) {
  const double R = kDrum + kRope, B = 2.0 * kMu * R / (1.0 + kMu * kMu);
  return (left + B) * std::exp(kMu * std::numbers::pi) + B;
}

TEST(Rope, HeavyOneHoldsAndSlidesAtTheCriticalOverhang_slow) {
  const double left = 40 * mm;
  for (const double part : {0.5, 0.8, 0.95, 1.1, 1.5}) {
    Scene scene = rope_over_drum(left, part * critical_overhang(left), {3e5, 0.5, 1000.0, 10.0});
    scene.time = {0.005, part < 1.0 ? 0.8 : 0.5};
    scene.gravity = Vec3(0, 0, -kGravity);
    scene.rods[0].second.base = {BaseAxis::x,      BaseAxis::y,      BaseAxis::z,
                                 BaseAxis::turn_x, BaseAxis::turn_y, BaseAxis::turn_z};
    // Its weight comes on slowly: let go at once, it would bounce on its own elongation.
    RodLoad lift;
    lift.rod = "rope";
    lift.from = 0.0;
    lift.to = rod::Path(scene.rods[0].second.path).length();
    lift.force = -scene.gravity * 1000.0 * std::numbers::pi * kRope * kRope;
    lift.factor = Table{{0.0, 0.3}, {1.0, 0.0}};
    scene.loads.emplace_back("lift", lift);
    Output tip;
    tip.rod = "rope";
    scene.outputs.emplace_back("tip", tip);
    tip.at = 0.0;
    scene.outputs.emplace_back("base", tip);
    const Model model = build(scene, test::read_block);
    const test::Trace trace = test::run_all(model);
    ASSERT_EQ(trace.end, RunEnd::done) << to_string(trace.failure.status);
    const auto height = [&](const State& state) { return output_position(model, state, model.outputs[1]).z(); };
    double slid = 0.0, later = 0.0;
    for (const State& state : trace.states) {
      slid = std::max(slid, std::abs(height(state) - height(trace.states.front())));
      if (state.time > 0.5) later = std::max(later, std::abs(height(state) - height(trace.states.back())));
    }
    if (part < 1.0) {
      EXPECT_LT(slid, 1 * mm) << part;  // by its elongation
      EXPECT_LT(later, 0.01 * mm) << part;
    } else {
      EXPECT_GT(slid, 10 * mm) << part;
    }
  }
}

}  // namespace
}  // namespace sinew
