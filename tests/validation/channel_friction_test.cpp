// Coulomb friction of a rod in its channel: Euler's and Eytelwein's capstan law.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "sinew/rod/path.hpp"
#include "support/scenes.hpp"

namespace sinew {
namespace {

using test::mm;

constexpr double kRadius = 20 * mm, kStraight = 40 * mm, kWeight = 1.0;
constexpr int kParts = 24;

/// A limp rod in a channel that turns half round in a block, from its base on the left and back; a weight pulls at its
/// tip, and its base is drawn out by `pull` [m] from 0.05 to 0.25 s.
Scene half_turn(double friction, double pull) {
  Scene scene;
  scene.time = {0.01, 0.3};
  Solid block;
  block.mesh = "block";
  block.material.law = solid::corotational(100e6, 0.3);
  block.density = 1000.0;
  block.fixed = {{Box{Vec3::Constant(-1.0), Vec3(1, 1, 1 * mm)}}};
  scene.solids.emplace_back("block", block);
  Rod rod;
  rod.path = {Vec3(-10 * mm, 10 * mm, 5 * mm)};
  for (int k = 0; k <= kParts; ++k) {
    const double turned = std::numbers::pi * k / kParts;
    rod.path.emplace_back(30 * mm + kRadius * std::sin(turned), 30 * mm - kRadius * std::cos(turned), 5 * mm);
  }
  rod.path.emplace_back(-10 * mm, 50 * mm, 5 * mm);
  rod.sections = 112;  // short beside the distance of points: those that pass one are straight or bent as a whole
  const double length = rod::Path(rod.path).length(), arc = length - 2.0 * kStraight;
  std::vector<double> points;
  for (int k = 0; k <= kParts; ++k) points.push_back(kStraight + arc * k / kParts);
  rod.section = Circle{0.25 * mm};
  rod.material = {1e7, 0.4, 1100.0, 100.0};
  scene.rods.emplace_back("rod", rod);
  Slide slide;
  slide.rod = "rod";
  slide.solid = "block";
  slide.points = points;
  slide.anchor_tip = AnchorTip::none;
  slide.friction = friction;
  scene.couplings.emplace_back(slide);
  Actuator draw;
  draw.rod = "rod";
  draw.drive = Table{{0.05, 0.25}, {0.0, pull}};
  scene.actuators.emplace_back("draw", draw);
  RodLoad weight;
  weight.rod = "rod";
  weight.force = Vec3(-kWeight, 0, 0);
  weight.factor = Table{{0.0, 0.05}, {0.0, 1.0}};
  scene.loads.emplace_back("weight", weight);
  return scene;
}

double force_at(const test::Trace& trace, double time) {
  for (const State& state : trace.states) {
    if (state.time > time - 1e-6) return state.actuators[0];
  }
  return NAN;
}

solid::Mesh block(const std::filesystem::path&) { return test::block_mesh(12, 12, 2, Vec3(60 * mm, 60 * mm, 10 * mm)); }

TEST(ChannelFriction, FollowsTheCapstanLaw) {
  for (const double mu : {0.0, 0.1, 0.3, 0.6}) {
    for (const double pull : {4 * mm, -4 * mm}) {
      const Model model = build(half_turn(mu, pull), block);
      const test::Trace trace = test::run_all(model);
      ASSERT_EQ(trace.end, RunEnd::done) << to_string(trace.failure.status);
      const double expected = kWeight * std::exp(std::copysign(mu * std::numbers::pi, pull));
      EXPECT_NEAR(force_at(trace, 0.24), expected, 0.02 * expected) << "mu " << mu << ", drawn by " << pull;
    }
  }
}

TEST(ChannelFriction, IsBoundedAndOpposesSliding) {
  const Model model = build(half_turn(0.3, 4 * mm), block);
  const test::Trace trace = test::run_all(model);
  ASSERT_EQ(trace.end, RunEnd::done);
  int slid = 0;
  for (std::size_t i = 1; i < trace.states.size(); ++i) {
    const State &before = trace.states[i - 1], &state = trace.states[i];
    for (const int k : model.rubbing) {
      const PointState& point = state.points[k];
      const Vec3 force = state.lambda.segment<3>(model.points[k].row);
      const double pressed = std::sqrt(std::max(0.0, force.squaredNorm() - point.friction * point.friction));
      // Newton's tolerance is one of slip: a millionth of the model, over what a newton moves the rod.
      EXPECT_LE(std::abs(point.friction), 0.3 * pressed * (1.0 + 1e-4));
      const double slip = point.s - before.points[k].s;
      if (std::abs(slip) < 1e-7) continue;
      ++slid;
      EXPECT_NEAR(point.friction, -std::copysign(0.3 * pressed, slip), 1e-4 * kWeight);
    }
  }
  EXPECT_GT(slid, 100);
}

TEST(ChannelFriction, HoldsWhatRests) {
  // Drawn in and held: the weight is carried by less than it weighs, and nothing creeps.
  const Model model = build(half_turn(0.3, 4 * mm), block);
  const test::Trace trace = test::run_all(model);
  ASSERT_EQ(trace.end, RunEnd::done);
  const State &last = trace.states.back(), &before = trace.states[trace.states.size() - 2];
  for (const int k : model.rubbing) EXPECT_NEAR(last.points[k].s, before.points[k].s, 1e-7);
  EXPECT_GT(last.actuators[0], kWeight * std::exp(-0.3 * std::numbers::pi));
}

}  // namespace
}  // namespace sinew
