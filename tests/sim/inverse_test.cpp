// The smallest inverse problem: forces of cables that bring a point where it is wanted.
#include "sinew/sim/inverse.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <stdexcept>

#include "sinew/sim/places.hpp"
#include "sinew/sim/run.hpp"
#include "support/meshes.hpp"
#include "support/robots.hpp"

namespace sinew::test {
namespace {

constexpr double kNone = INFINITY;

/// A block with a cable along two of its sides, pulled by forces.
Scene two_cables() {
  Scene scene = block();
  scene.time.step = 0.02;
  scene.actuators[0].second.driven = Driven::force;
  scene.actuators[0].second.drive = Table{{0.0}, {0.5}};
  add_cable(scene, "other", {Vec3(0, 3 * mm, 5 * mm), Vec3(50 * mm, 3 * mm, 5 * mm)}, 10, evenly(50 * mm, 10), 0.5 * mm,
            0.0);
  scene.actuators[1].second.driven = Driven::force;
  scene.actuators[1].second.drive = Table{{0.0}, {0.2}};
  add_effector(scene, Vec3(50 * mm, 5 * mm, 5 * mm));
  return scene;
}

class Inverse : public testing::Test {
 protected:
  Vec3 tip(const State& at) const { return output_position(model, at, model.outputs[0]); }
  /// The same step with forces as they are given.
  State direct(const State& from, const std::vector<double>& forces) {
    State next = from;
    Workspace own = make_workspace(model);
    EXPECT_TRUE(accepted(step(model, own, {forces, {}}, model.scene.time.step, next).status));
    return next;
  }
  Goal goal_at(const Vec3& x, double most = kNone) const { return {{x}, {0.0, 0.0}, {most, most}}; }

  Model model = build(two_cables(), block_of(600));
  Workspace workspace = make_workspace(model);
  State state = initial_state(model);
};

TEST_F(Inverse, ReplayedForcesReproduceTheStep) {
  for (int i = 0; i < 5; ++i) {
    const State before = state;
    const InverseReport report =
        inverse_step(model, workspace, goal_at(tip(before) - 0.1 * mm * Vec3::UnitY()), model.scene.time.step, state);
    ASSERT_TRUE(accepted(report.step.status)) << to_string(report.step.status);
    const State again = direct(before, state.actuators);
    EXPECT_LT((again.solids[0].x - state.solids[0].x).norm(), 1e-9 * 50 * mm) << i;
    EXPECT_LT((again.rods[0].q - state.rods[0].q).norm(), 1e-8 * (1.0 + state.rods[0].q.norm())) << i;
  }
}

TEST_F(Inverse, ReachesWhatADirectStepReached) {
  const State wanted = direct(state, {1.3, 0.4});
  const InverseReport report = inverse_step(model, workspace, goal_at(tip(wanted)), model.scene.time.step, state);
  ASSERT_TRUE(accepted(report.step.status));
  EXPECT_LT(report.distance, 1e-4 * (tip(wanted) - tip(initial_state(model))).norm());
  EXPECT_LT((tip(state) - tip(wanted)).norm(), 1e-3 * (tip(wanted) - tip(initial_state(model))).norm());
}

/// No other forces within the bounds bring the tip nearer.
TEST_F(Inverse, FindsTheNearestWithinItsBounds) {
  const State start = state;
  for (const Vec3& off : {Vec3(0, -3 * mm, 0), Vec3(0, 3 * mm, 0), Vec3(-1 * mm, 0, 0), Vec3(1 * mm, 0, 0)}) {
    const Vec3 goal = tip(start) + off;
    state = start;
    const InverseReport report = inverse_step(model, workspace, goal_at(goal, 2.0), model.scene.time.step, state);
    ASSERT_TRUE(accepted(report.step.status));
    const std::vector<double> best = state.actuators;
    const double distance = (tip(state) - goal).norm();
    EXPECT_NEAR(report.distance, distance, 1e-9);
    for (std::size_t a = 0; a < 2; ++a) {
      EXPECT_GE(best[a], 0.0);
      EXPECT_LE(best[a], 2.0);
      for (const double change : {-0.05, 0.05}) {
        std::vector<double> other = best;
        other[a] += change;
        if (other[a] < 0.0 || other[a] > 2.0) continue;
        EXPECT_GE((tip(direct(start, other)) - goal).norm(), distance * (1.0 - 1e-6)) << a << " " << change;
      }
    }
  }
}

/// What breaks before anything is steered.
TEST_F(Inverse, FailsAsAStepDoes) {
  state.solids[0].v.setConstant(1e200);
  const State before = state;
  const InverseReport report = inverse_step(model, workspace, goal_at(Vec3::Zero()), 0.02, state);
  EXPECT_FALSE(accepted(report.step.status));
  EXPECT_TRUE(std::isnan(report.distance));
  EXPECT_EQ(pack(state), pack(before));
}

TEST_F(Inverse, SinglePrecisionIsSteeredToo) {
  Scene scene = two_cables();
  scene.newton.precision = linalg::Precision::float32;
  const Model single = build(scene, block_of(600));
  Workspace own = make_workspace(single);
  State other = state;
  for (int i = 0; i < 5; ++i) {
    const Goal goal = goal_at(tip(state) - 0.1 * mm * Vec3::UnitY());
    ASSERT_TRUE(accepted(inverse_step(model, workspace, goal, 0.02, state).step.status));
    ASSERT_TRUE(accepted(inverse_step(single, own, goal, 0.02, other).step.status));
  }
  EXPECT_LT((tip(other) - tip(state)).norm(), 1e-4 * (tip(state) - tip(initial_state(model))).norm());
  EXPECT_NEAR(other.actuators[0], state.actuators[0], 1e-3 * std::abs(state.actuators[0]));
}

TEST_F(Inverse, FollowsAPathUntilItIsThere) {
  const State far = [&] {
    State end = state;
    Workspace own = make_workspace(model);
    for (int i = 0; i < 150; ++i) EXPECT_TRUE(accepted(step(model, own, {{2.0, 0.3}, {}}, 0.02, end).status));
    return end;
  }();
  const Vec3 from = tip(state), to = tip(far);
  for (int i = 1; i <= 200; ++i) {
    const Vec3 goal = from + std::min(1.0, i / 100.0) * (to - from);
    ASSERT_TRUE(accepted(inverse_step(model, workspace, goal_at(goal), 0.02, state).step.status)) << i;
  }
  EXPECT_GT((to - from).norm(), 1 * mm);
  EXPECT_LT((tip(state) - to).norm(), 0.02 * (to - from).norm());
}

TEST_F(Inverse, RefusesWhatItDoesNotKnow) {
  const Goal goal = goal_at(Vec3::Zero());
  EXPECT_THROW(inverse_step(model, workspace, {{}, {0.0, 0.0}, {1.0, 1.0}}, 0.02, state), std::invalid_argument);
  EXPECT_THROW(inverse_step(model, workspace, {{Vec3::Zero()}, {0.0}, {1.0, 1.0}}, 0.02, state), std::invalid_argument);
  Scene driven = two_cables();
  driven.actuators[0].second.driven = Driven::displacement;
  const Model other = build(driven, block_of(600));
  Workspace own = make_workspace(other);
  State start = initial_state(other);
  EXPECT_THROW(inverse_step(other, own, goal, 0.02, start), std::invalid_argument);
  const State before = state;
  Goal crossed = goal, nowhere = goal;
  crossed.least[1] = 20.0;
  crossed.most[1] = 10.0;
  nowhere.positions[0].y() = NAN;
  EXPECT_THROW(inverse_step(model, workspace, crossed, 0.02, state), std::invalid_argument);
  EXPECT_THROW(inverse_step(model, workspace, nowhere, 0.02, state), std::invalid_argument);
  EXPECT_EQ(pack(state), pack(before));
  Scene unknown = two_cables();
  unknown.effectors = {"hand"};
  EXPECT_ANY_THROW(build(unknown, block_of(600)));
}

}  // namespace
}  // namespace sinew::test
