#include "sinew/sim/statics.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "sinew/error/input_error.hpp"
#include "support/scenes.hpp"

namespace sinew {
namespace {

/// A circular arch of radius 100 in the x-y plane, opening 215 degrees, E I = 1e6, clamped at its base, pinned at its
/// tip, with a dead load on the apex.
Scene deep_arch(double load, int sections, int order) {
  Scene scene;
  scene.analysis = Analysis::statics;
  scene.time.duration = 1.0;
  Rod rod;
  constexpr int kPoints = 200;
  for (int i = 0; i <= kPoints; ++i) {
    const double angle = (197.5 - 215.0 * i / kPoints) * std::numbers::pi / 180.0;
    rod.path.push_back(100.0 * Vec3(std::cos(angle), std::sin(angle), 0.0));
  }
  rod.sections = sections;
  rod.strains = {Strain::bending_y};  // y is z of the world
  rod.order[1] = order;
  GivenSection section;
  section.stiffness.diagonal().setConstant(1e6);
  section.radius = 1.0;
  rod.section = section;
  scene.rods.emplace_back("arch", rod);
  Tie pin;
  pin.rod = "arch";
  pin.along = {true, true, false};
  scene.couplings.emplace_back(pin);
  RodLoad down;
  down.rod = "arch";
  down.at = 0.5 * 100.0 * 215.0 * std::numbers::pi / 180.0;
  down.force = Vec3(0, -load, 0);
  scene.loads.emplace_back("down", down);
  return scene;
}

TEST(Statics, DeepArchBucklesAtTheLoadOfDaDeppoAndSchmidt) {
  // P_cr = 897 (DaDeppo and Schmidt 1975); the path goes on past the limit point.
  const Scene scene = deep_arch(1200.0, 40, 0);
  const Model model = build(scene, test::read_block);
  Workspace workspace = make_workspace(model);
  State state = initial_state(model);
  double highest = 0.0;
  bool fell = false;
  int steps = 0;
  while (state.grid == 0 && steps < 400) {
    const StepReport report = advance(model, workspace, state);
    ASSERT_TRUE(accepted(report.status)) << to_string(report.status) << " at " << state.time;
    ++steps;
    highest = std::max(highest, 1200.0 * state.time);
    if (1200.0 * state.time < highest - 50.0) {
      fell = true;
      break;
    }
  }
  EXPECT_TRUE(fell) << "no limit point up to " << highest;
  EXPECT_NEAR(highest, 897.0, 0.01 * 897.0);
  RecordProperty("limit_load", std::to_string(highest));
}

/// A soft cantilever under a large dead tip force, all at once in one quasi-static step.
Scene loaded(double alpha, Analysis analysis) {  // alpha = P L^2 / EI
  Scene scene = test::lone_rod(0.0, 20);
  scene.analysis = analysis;
  scene.time = {1.0, 1.0};
  const double stiffness = 10e6 * std::numbers::pi * std::pow(5e-3, 4) / 4;
  RodLoad tip;
  tip.rod = "rod";
  tip.force = Vec3(0, 0, -alpha * stiffness / 0.25);
  scene.loads.emplace_back("tip", tip);
  return scene;
}

TEST(Statics, OneStepPathAndManyStepsEndInTheSameEquilibrium) {
  for (const double alpha : {0.5, 5.0, 50.0}) {
    const Model at_once = build(loaded(alpha, Analysis::quasi_static), test::read_block);
    const Model along = build(loaded(alpha, Analysis::statics), test::read_block);
    const test::Trace a = test::run_all(at_once), b = test::run_all(along);
    ASSERT_EQ(a.end, RunEnd::done) << to_string(a.failure.status) << " at alpha = " << alpha;
    ASSERT_EQ(b.end, RunEnd::done) << to_string(b.failure.status) << " at alpha = " << alpha;
    EXPECT_GT(b.states.size(), 3u);
    EXPECT_NEAR(b.states.back().time, 1.0, 1e-15);
    EXPECT_LT((test::tip(at_once, a.states.back()) - test::tip(along, b.states.back())).norm(), 1e-8) << alpha;
  }
}

TEST(Statics, MotorsAndTiesAreFollowed) {
  // A rod whose base is pushed 20 mm towards its held tip while a small side load chooses the way: it buckles.
  Scene scene = test::lone_rod(0.0, 20);
  scene.analysis = Analysis::statics;
  scene.rods[0].second.strains = {Strain::torsion, Strain::bending_y, Strain::bending_z, Strain::elongation};
  Tie tip;
  tip.rod = "rod";
  scene.couplings.emplace_back(tip);
  Actuator push;
  push.rod = "rod";
  push.axis = 0;
  push.drive = Table{{0.0}, {0.02}};
  scene.actuators.emplace_back("push", push);
  RodLoad side;
  side.rod = "rod";
  side.at = 0.25;
  side.force = Vec3(0, 0, 0.02);
  const Model perfect = build(scene, test::read_block);
  const test::Trace straight = test::run_all(perfect);
  ASSERT_EQ(straight.end, RunEnd::done) << to_string(straight.failure.status);
  EXPECT_TRUE(straight.reports.back().unstable);  // it stays straight, far beyond the buckling load, and says so
  scene.loads.emplace_back("side", side);
  const Model model = build(scene, test::read_block);
  const test::Trace trace = test::run_all(model);
  EXPECT_FALSE(trace.reports.back().unstable);
  ASSERT_EQ(trace.end, RunEnd::done) << to_string(trace.failure.status);
  // Clamped and pinned: P = 20.19 EI / L^2, and a little more as it bows.
  const double critical = 20.1907 * 10e6 * std::numbers::pi * std::pow(5e-3, 4) / 4 / 0.25;
  EXPECT_NEAR(trace.states.back().actuators[0], critical, 0.08 * critical);
}

TEST(Statics, AStateOfAPathIsACheckpoint) {
  const Model model = build(deep_arch(1200.0, 20, 0), test::read_block);
  Workspace workspace = make_workspace(model);
  State state = initial_state(model);
  for (int i = 0; i < 12; ++i) advance(model, workspace, state);
  State copy = unpack(model, pack(state));
  ASSERT_TRUE(accepted(advance(model, workspace, state).status));
  advance(model, workspace, copy);
  EXPECT_EQ(pack(state), pack(copy));
}

TEST(Statics, APathThatNeverReachesTheLoadEnds) {
  // The tip is held by a frame that goes where an inextensible rod cannot follow.
  Scene scene = test::lone_rod(0.0, 10);
  scene.analysis = Analysis::statics;
  scene.rods[0].second.path = {Vec3::Zero(), Vec3(0.25, 0.15, 0), Vec3(0.5, 0, 0)};
  scene.outputs.clear();
  Frame away;
  away.motion = FrameMotion{{0.0, 0.5}, {}, {Vec3::Zero(), Vec3(0.3, 0, 0)}};
  scene.frames.emplace_back("away", away);
  Tie tip;
  tip.rod = "rod";
  tip.frame = "away";
  scene.couplings.emplace_back(tip);
  const test::Trace trace = test::run_all(build(scene, test::read_block));
  EXPECT_EQ(trace.end, RunEnd::stopped);
  EXPECT_LT(trace.states.size(), 4000u);
}

/// The tip of a rod twisted by 120 degrees in one step: the rows about the axes hold at -60 degrees, too.
Scene twisted_in_one_step() {
  Scene scene = test::lone_rod(0.0, 4);
  scene.time = {1.0, 1.0};
  scene.rods[0].second.strains.push_back(Strain::elongation);
  Frame hand;
  hand.motion = FrameMotion{{0.0, 1.0}, {Vec3::Zero(), Vec3(2.0 * std::numbers::pi / 3.0, 0, 0)}, {}};
  scene.frames.emplace_back("hand", hand);
  Tie grip;
  grip.rod = "rod";
  grip.frame = "hand";
  grip.about = {true, true, true};
  scene.couplings.emplace_back(grip);
  return scene;
}

TEST(Statics, a_tie_turns_the_way_it_is_turned) {
  Scene scene = twisted_in_one_step();
  scene.analysis = Analysis::quasi_static;
  const Model model = build(scene, test::read_block);
  const test::Trace trace = test::run_all(model);
  ASSERT_EQ(trace.end, RunEnd::done) << to_string(trace.failure.status);
  EXPECT_NEAR(rod::strain(model.rods[0].rod, trace.states.back().rods[0].q, 0.25)[0],
              2.0 * std::numbers::pi / 3.0 / 0.5, 1e-6);
}

TEST(Step, a_tie_that_would_turn_over_halves_its_step) {
  const Model model = build(twisted_in_one_step(), test::read_block);
  const test::Trace trace = test::run_all(model);
  ASSERT_EQ(trace.end, RunEnd::done) << to_string(trace.failure.status);
  EXPECT_GT(trace.states.size(), 2u);
}

/// Pulled by its cable the block by itself is unstable long before the end; the whole is not.
TEST(Statics, BlockPulledByItsCableEndsWhereItsDampedMotionDoes) {
  Scene scene = test::cable_block(4 * test::mm);
  scene.time.duration = 0.2;
  scene.analysis = Analysis::statics;
  const Model at_rest = build(scene, test::read_block);
  const test::Trace path = test::run_all(at_rest);
  ASSERT_EQ(path.end, RunEnd::done) << to_string(path.failure.status) << " " << path.failure.detail;
  for (const StepReport& report : path.reports) {
    EXPECT_FALSE(report.rotated);
    EXPECT_FALSE(report.unstable);
  }
  scene.analysis = Analysis::dynamic;
  scene.time = {0.02, 6.0};
  const Model moving = build(scene, test::read_block);
  const test::Trace motion = test::run_all(moving);
  ASSERT_EQ(motion.end, RunEnd::done) << to_string(motion.failure.status);
  EXPECT_LT((test::tip(at_rest, path.states.back()) - test::tip(moving, motion.states.back())).norm(), 1e-6);
  EXPECT_GT((test::tip(at_rest, path.states.back()) - test::tip(at_rest, path.states.front())).norm(), 5e-3);
}

}  // namespace
}  // namespace sinew
