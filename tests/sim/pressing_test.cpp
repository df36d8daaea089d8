// The inverse problem with contact: what touches answers the motors.
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>

#include "sinew/sim/inverse.hpp"
#include "sinew/sim/places.hpp"
#include "sinew/sim/run.hpp"
#include "sinew/sim/signals.hpp"
#include "sinew/sim/statics.hpp"
#include "support/meshes.hpp"
#include "support/robots.hpp"

namespace sinew::test {
namespace {

using Outcome = Aim::Outcome;

/// A block between two cables, its upper side 0.3 mm below a wall; what is wished is at the tip or at the wall.
Scene beside_a_wall(double friction) {
  Scene scene = block();
  scene.time.step = 0.02;
  add_cable(scene, "other", {Vec3(0, 3 * mm, 5 * mm), Vec3(50 * mm, 3 * mm, 5 * mm)}, 10, evenly(50 * mm, 10), 0.5 * mm,
            0.0);
  add_target(scene, Vec3(50 * mm, 5 * mm, 5 * mm), 20.0);
  Obstacle wall;
  wall.shape = PlaneShape{Vec3(0, 10.3 * mm, 0), -Vec3::UnitY()};
  scene.obstacles.emplace_back("wall", wall);
  scene.contact.friction = friction;
  Output touch;
  touch.between = {"body", "wall"};
  scene.outputs.emplace_back("touch", touch);
  return scene;
}

void wish_for_force(Scene& scene) {
  Target target;
  target.output = "touch";
  target.at = External{};
  scene.targets.push_back(target);
}

Scene at_rest(Scene scene) {
  scene.analysis = Analysis::quasi_static;
  scene.newton.iterations = 0;
  return scene;
}

struct Robot {
  explicit Robot(const Scene& scene) : model(build(scene, block_of(600))), workspace(make_workspace(model)) {}
  Model model;
  Workspace workspace;
  State state = initial_state(model);

  Vec3 tip() const { return output_position(model, state, model.outputs[0]); }
  double force() const { return pressing_of(state, 0).force; }
  StepReport seek(const Eigen::VectorXd& goal) {
    return inverse_step(model, workspace, {goal}, {{0.0, 0.0}, {}}, model.scene.time.step, state);
  }
  StepReport settle(const Eigen::VectorXd& goal) {
    return inverse_equilibrium(model, workspace, {goal}, {{0.0, 0.0}, {}}, state.time + 0.02, state);
  }
  State direct(const std::vector<double>& commands) const {
    Workspace own = make_workspace(model);
    State next = state;
    EXPECT_TRUE(accepted(step(model, own, {commands, {}}, model.scene.time.step, next).status));
    return next;
  }
  State rest(const std::vector<double>& commands) const {
    Workspace own = make_workspace(model);
    const StepResult result = equilibrium_step(model, own, {commands, {}}, state, state.time + 0.02);
    EXPECT_TRUE(accepted(result.report.status));
    return result.next;
  }
};

/// From where it does not touch: it comes nearer, and presses as hard as it is told, with one problem a step or more.
TEST(Pressing, MeetsAForceOnAWall) {
  for (const int iterations : {1, 0}) {
    for (const double friction : {0.0, 0.5}) {
      Scene scene = beside_a_wall(friction);
      scene.newton.iterations = iterations;
      scene.targets.clear();
      wish_for_force(scene);
      for (auto& [name, actuator] : scene.actuators) actuator.limits.force_rate = 20.0;
      scene.actuators[1].second.drive = Table{{0.0}, {0.0}};
      Robot robot(scene);
      StepReport report;
      for (int i = 0; i < 60; ++i) {
        report = robot.seek(Eigen::VectorXd::Constant(1, 0.2));
        ASSERT_TRUE(accepted(report.status)) << i;
        EXPECT_LT(robot.force(), 0.4) << i;
      }
      EXPECT_EQ(report.aim.outcome, Outcome::reached);
      EXPECT_NEAR(robot.force(), 0.2, 1e-3) << iterations << " " << friction;
      EXPECT_GT(robot.tip().y(), 5 * mm);
      EXPECT_GE(robot.state.actuators[1], 0.0);
    }
  }
}

TEST(Pressing, MeetsAForceAtRest) {
  for (const double friction : {0.0, 0.5}) {
    Scene scene = at_rest(beside_a_wall(friction));
    scene.targets.clear();
    wish_for_force(scene);
    Robot robot(scene);
    const StepReport report = robot.settle(Eigen::VectorXd::Constant(1, 0.2));
    ASSERT_TRUE(accepted(report.status));
    EXPECT_EQ(report.aim.outcome, Outcome::reached);
    EXPECT_NEAR(robot.force(), 0.2, 1e-5) << friction;
    EXPECT_NEAR(pressing_of(robot.rest(robot.state.actuators), 0).force, 0.2, 1e-4);
    ASSERT_TRUE(accepted(robot.settle(Eigen::VectorXd::Constant(1, 0.0)).status));
    EXPECT_NEAR(robot.force(), 0.0, 1e-5) << friction;
  }
}

/// Two cables: one number along the wall and how hard it presses, together.
TEST(Pressing, SlidesAlongTheWallAsItPresses) {
  for (const double friction : {0.0, 0.3}) {
    Scene scene = at_rest(beside_a_wall(friction));
    wish_for_force(scene);
    scene.targets[0].weights = {1, 0, 0};
    Robot robot(scene), told(scene);
    for (int i = 1; i <= 4; ++i) {
      // What other forces have led to.
      told.state = told.rest({1.5 + 0.5 * i, 0.4 * i});
      const Eigen::Vector4d goal(told.tip().x(), 0.0, 0.0, told.force());
      ASSERT_GT(goal[3], 0.01);
      const StepReport report = robot.settle(goal);
      ASSERT_TRUE(accepted(report.status)) << i;
      EXPECT_EQ(report.aim.outcome, Outcome::reached) << i << " " << describe(robot.model, report.aim);
      EXPECT_NEAR(robot.tip().x(), goal[0], 1e-6) << i << " " << friction;
      EXPECT_NEAR(robot.force(), goal[3], 1e-4) << i << " " << friction;
    }
  }
}

/// What is behind the wall is not reached, and nothing does better: with no friction that is known for sure.
TEST(Pressing, NearestIsTheNearestOfAllLinearSteps) {
  for (const double friction : {0.0, 0.4}) {
    Scene scene = beside_a_wall(friction);
    for (auto& [name, actuator] : scene.actuators) actuator.limits.force = Span{0.0, 6.0};
    Robot robot(scene);
    for (int i = 0; i < 5; ++i) robot.state = robot.direct({4.0, 0.5});  // touches
    ASSERT_GT(robot.force(), 0.01);
    const State start = robot.state;
    const Vec3 tip = robot.tip();
    for (const Vec3& off : {Vec3(0, 1 * mm, 0), Vec3(-1 * mm, 0.5 * mm, 0), Vec3(0.2 * mm, -0.3 * mm, 0.1 * mm)}) {
      robot.state = start;
      const Vec3 goal = tip + off;
      const StepReport report = robot.seek(goal);
      ASSERT_TRUE(accepted(report.status));
      EXPECT_EQ(report.aim.certain, friction == 0.0 && report.contact.contacts <= 12) << report.contact.contacts;
      EXPECT_LT(report.contact.left.largest(), 1e-9);
      const double found = (robot.tip() - goal).norm();
      robot.state = start;
      double best = INFINITY;
      for (int a = 0; a <= 12; ++a) {
        for (int b = 0; b <= 12; ++b) {
          const State other = robot.direct({0.5 * a, 0.5 * b});
          best = std::min(best, (output_position(robot.model, other, robot.model.outputs[0]) - goal).norm());
        }
      }
      EXPECT_LE(found, best * (1.0 + 1e-6)) << friction << " " << off.transpose();
    }
  }
}

/// Both Jacobians where contacts stick: differences of equilibria and of linear steps from the same state.
TEST(Pressing, JacobiansOfStuckContactsAreDifferences) {
  for (const bool still : {false, true}) {
    Scene scene = beside_a_wall(5.0);
    if (still) scene = at_rest(scene);
    wish_for_force(scene);
    Robot robot(scene);
    const auto settle = [&](const std::vector<double>& forces) {
      for (int i = 0; i < (still ? 1 : 300); ++i) robot.state = still ? robot.rest(forces) : robot.direct(forces);
    };
    const std::vector<double> at = {3.9, 0.5};
    settle({4.0, 0.5});
    settle(at);  // back into the cone that it has slid along
    ASSERT_GT(robot.force(), 0.01);
    for (const ContactState& own : robot.state.contacts) {
      const double normal = own.force.dot(own.normal);
      ASSERT_LT((own.force - normal * own.normal).norm(), 0.99 * 5.0 * normal);
    }
    const ActuatorJacobian found = actuator_jacobian(
        robot.model, robot.workspace, robot.state, still ? JacobianOf::equilibrium : JacobianOf::step, scene.time.step);
    ASSERT_EQ(found.effectors.rows(), 4);
    EXPECT_EQ(found.rows[3], "touch.normal [N]");
    for (std::size_t a = 0; a < 2; ++a) {
      const double e = still ? 1e-2 : 1e-3;
      std::vector<double> more = at, less = at;
      more[a] += e;
      less[a] -= e;
      const State high = still ? robot.rest(more) : robot.direct(more),
                  low = still ? robot.rest(less) : robot.direct(less);
      Eigen::Vector4d slope;
      slope.head<3>() = (output_position(robot.model, high, robot.model.outputs[0]) -
                         output_position(robot.model, low, robot.model.outputs[0])) /
                        (2.0 * e);
      slope[3] = (pressing_of(high, 0).force - pressing_of(low, 0).force) / (2.0 * e);
      const Eigen::Vector4d column = found.effectors.col(static_cast<Eigen::Index>(a));
      EXPECT_LT((column - slope).head<3>().norm(), 1e-5 * slope.head<3>().norm()) << still << " " << a;
      EXPECT_NEAR(column[3], slope[3], 1e-5 * std::abs(slope[3])) << still << " " << a;
    }
  }
}

/// What a workspace was used for before does not change what a step would do from a state that touches.
TEST(Pressing, JacobiansOfStepsDoNotDependOnWhatWasDoneBefore) {
  Scene scene = beside_a_wall(0.5);
  wish_for_force(scene);
  Robot robot(scene);
  for (int i = 0; i < 100; ++i) robot.state = robot.direct({4.0, 0.5});
  ASSERT_GT(robot.force(), 0.01);
  const auto looked_at_with = [&](Workspace& workspace) {
    return actuator_jacobian(robot.model, workspace, robot.state, JacobianOf::step, scene.time.step).effectors;
  };
  Workspace fresh = make_workspace(robot.model), used = make_workspace(robot.model);
  State elsewhere = robot.state;  // drawn to the wall so fast that contacts are looked for far away
  for (SolidState& own : elsewhere.solids) own.v.row(1).setConstant(-20.0);
  step(robot.model, used, {{4.0, 0.5}, {}}, scene.time.step, elsewhere);
  const Eigen::MatrixXd expected = looked_at_with(fresh);
  EXPECT_GT(expected.row(3).norm(), 0.0);
  EXPECT_EQ(looked_at_with(used), expected);
  EXPECT_EQ(looked_at_with(fresh), expected);
}

/// What cannot be pressed because it is far from it is told, and nothing moves for it.
TEST(Pressing, FarFromTheWallNothingIsKnown) {
  Scene scene = at_rest(beside_a_wall(0.5));
  scene.obstacles[0].second.shape = PlaneShape{Vec3(0, 60 * mm, 0), -Vec3::UnitY()};
  scene.targets.clear();
  wish_for_force(scene);
  Robot robot(scene);
  const StepReport report = robot.settle(Eigen::VectorXd::Constant(1, 0.2));
  ASSERT_TRUE(accepted(report.status));
  EXPECT_EQ(report.aim.outcome, Outcome::nearest);
  EXPECT_EQ(report.aim.apart, 0);
  EXPECT_NE(describe(robot.model, report.aim).find("outputs.touch"), std::string::npos);
}

}  // namespace
}  // namespace sinew::test
