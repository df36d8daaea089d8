// How commands and loads move what is wanted, against differences.
#include <gtest/gtest.h>

#include <Eigen/Dense>

#include "sim/inverse_robots.hpp"
#include "sinew/sim/motors.hpp"

namespace sinew::test {
namespace {

using Jacobian = Inverse;

/// The tangent of equilibria against differences of equilibria, for all kinds of targets and both kinds of commands.
TEST_F(Jacobian, EquilibriumJacobianIsTheDifferenceOfEquilibria) {
  for (const bool displacement : {false, true}) {
    Scene scene = hinged();
    scene.targets = {wish("tip"), wish("turn"), wish("bend"), wish("middle")};
    scene.analysis = Analysis::quasi_static;
    scene.newton.iterations = 0;
    scene.newton.tolerance = 1e-12;
    if (displacement) drive_by_displacement(scene);
    Robot robot(scene);
    const std::vector<double> at = displacement ? std::vector{0.3 * mm, 0.8 * mm} : std::vector{1.0, 3.0};
    const State rest = robot.at_rest(at);
    const ActuatorJacobian found =
        actuator_jacobian(robot.model, robot.workspace, rest, JacobianOf::equilibrium, robot.model.scene.time.step);
    Eigen::VectorXd where(10);
    for (const EffectorModel& own : robot.model.effectors)
      where.segment(own.first, own.size) = effector_value(robot.model, rest, own);
    ASSERT_EQ(found.effectors.rows(), 10);
    EXPECT_EQ(found.rows[0], "tip.x [rad]");
    EXPECT_EQ(found.rows[6], "bend.bending_z [1/m]");
    EXPECT_EQ(found.columns[1], displacement ? "other.displacement [m]" : "other.force [N]");
    for (int a = 0; a < 2; ++a) {
      const double e = displacement ? 1e-3 * mm : 2e-3;
      std::vector<double> more = at, less = at;
      more[static_cast<std::size_t>(a)] += e;
      less[static_cast<std::size_t>(a)] -= e;
      const State high = robot.at_rest(more), low = robot.at_rest(less);
      // Of turns, that from where it is.
      Eigen::VectorXd ahead, behind;
      effector_errors(robot.model, high, {where}, ahead);
      effector_errors(robot.model, low, {where}, behind);
      for (const EffectorModel& own : robot.model.effectors) {
        const Eigen::VectorXd slope = ((ahead - behind) / (2.0 * e)).segment(own.first, own.size);
        const Eigen::VectorXd column = found.effectors.col(a).segment(own.first, own.size);
        EXPECT_LT((column - slope).norm(), 1e-5 * slope.norm())
            << displacement << " " << a << " " << robot.model.outputs[own.output].name;
      }
      for (int b = 0; b < 2; ++b) {
        const auto k = static_cast<std::size_t>(b);
        EXPECT_NEAR(found.forces(b, a), (high.actuators[k] - low.actuators[k]) / (2.0 * e),
                    1e-5 * found.forces.col(a).norm());
        EXPECT_NEAR(found.positions(b, a),
                    (motor_positions(robot.model, high)[k] - motor_positions(robot.model, low)[k]) / (2.0 * e),
                    1e-5 * found.positions.col(a).norm());
      }
    }
  }
}

/// Follower pressure on a face with a free rim: what a force at one point does to another is not what one at the other
/// does to the first.
TEST_F(Jacobian, EquilibriumJacobianHoldsUnderFollowerPressure) {
  Scene scene = two_cables();
  scene.analysis = Analysis::quasi_static;
  scene.newton.iterations = 0;
  scene.newton.tolerance = 1e-12;
  scene.loads.emplace_back("pressure", SolidLoad{"body", Plane{Vec3(0, 0, 10 * mm), Vec3::UnitZ()}, Vec3::Zero(), 3e3});
  Robot robot(scene);
  ASSERT_FALSE(std::get<SolidLoadModel>(robot.model.loads[0].on).conservative());
  const std::vector<double> at = {1.0, 3.0};
  const auto rest = [&](const std::vector<double>& forces) {
    Workspace own = make_workspace(robot.model);
    const StepResult result = equilibrium_step(robot.model, own, {forces, {1.0}}, initial_state(robot.model), 0.02);
    EXPECT_TRUE(accepted(result.report.status));
    return result.next;
  };
  const ActuatorJacobian found =
      actuator_jacobian(robot.model, robot.workspace, rest(at), JacobianOf::equilibrium, 0.02);
  ASSERT_EQ(found.effectors.rows(), 3);
  for (int a = 0; a < 2; ++a) {
    const double e = 2e-3;
    std::vector<double> more = at, less = at;
    more[static_cast<std::size_t>(a)] += e;
    less[static_cast<std::size_t>(a)] -= e;
    const Vec3 slope = (robot.tip(rest(more)) - robot.tip(rest(less))) / (2.0 * e);
    EXPECT_LT((found.effectors.col(a) - slope).norm(), 1e-6 * slope.norm()) << a;
  }
}

/// (14): the linear step is exactly linear in its commands.
TEST_F(Jacobian, StepJacobianIsTheDifferenceOfLinearSteps) {
  for (const bool displacement : {false, true}) {
    Scene scene = hinged();
    scene.targets = {wish("middle"), wish("bend")};
    if (displacement) drive_by_displacement(scene);
    Robot robot(scene);
    const std::vector<double> at = displacement ? std::vector{0.1 * mm, 0.4 * mm} : std::vector{1.0, 2.0};
    for (int i = 0; i < 400; ++i)
      robot.state = robot.direct(robot.state, at);  // to rest: a rod's point moves on a curve
    const ActuatorJacobian found =
        actuator_jacobian(robot.model, robot.workspace, robot.state, JacobianOf::step, robot.model.scene.time.step);
    for (int a = 0; a < 2; ++a) {
      const double e = displacement ? 1e-2 * mm : 1e-2;
      std::vector<double> more = at, less = at;
      more[static_cast<std::size_t>(a)] += e;
      less[static_cast<std::size_t>(a)] -= e;
      const State high = robot.direct(robot.state, more), low = robot.direct(robot.state, less);
      for (const EffectorModel& own : robot.model.effectors) {
        const Eigen::VectorXd slope =
            (effector_value(robot.model, high, own) - effector_value(robot.model, low, own)) / (2.0 * e);
        EXPECT_LT((found.effectors.col(a).segment(own.first, own.size) - slope).norm(), 1e-5 * slope.norm())
            << displacement << " " << a << " " << robot.model.outputs[own.output].name;
      }
    }
  }
}

/// How outputs give way to forces and moments on them, motors held as they are told, against loads in the scene.
TEST_F(Jacobian, ComplianceIsTheDifferenceOfEquilibriaUnderLoads) {
  for (const bool displacement : {false, true}) {
    Scene scene = hinged();
    scene.targets = {wish("middle"), wish("turn"), wish("corner")};
    Output corner;
    corner.solid = "body";
    corner.point.x = Vec3(50 * mm, 10 * mm, 10 * mm);
    scene.outputs.emplace_back("corner", corner);
    scene.analysis = Analysis::quasi_static;
    scene.newton.iterations = 0;
    scene.newton.tolerance = 1e-12;
    if (displacement) drive_by_displacement(scene);
    // The loads are off at first.
    for (int i = 0; i < 6; ++i) {  // forces along the axes, then moments about them
      RodLoad load;
      load.rod = "other";
      load.at = 25 * mm;
      (i < 3 ? load.force : load.moment) = Vec3::Unit(i % 3);
      load.factor = External{};
      scene.loads.emplace_back("load" + std::to_string(i), load);
    }
    Robot robot(scene);
    const std::vector<double> at = displacement ? std::vector{0.3 * mm, 0.8 * mm} : std::vector{1.0, 3.0};
    const auto rest = [&](const std::vector<double>& loads) {
      Workspace own = make_workspace(robot.model);
      const StepResult result = equilibrium_step(robot.model, own, {at, loads}, initial_state(robot.model), 0.02);
      EXPECT_TRUE(accepted(result.report.status));
      return result.next;
    };
    const std::vector<double> none(6, 0.0);
    const State start = rest(none);
    const ActuatorJacobian found =
        actuator_jacobian(robot.model, robot.workspace, start, JacobianOf::equilibrium, 0.02);
    ASSERT_EQ(found.compliance.rows(), 9);
    EXPECT_LT((found.compliance - found.compliance.transpose()).norm(), 1e-9 * found.compliance.norm());
    Eigen::VectorXd where(9);
    for (const EffectorModel& own : robot.model.effectors)
      where.segment(own.first, own.size) = effector_value(robot.model, start, own);
    for (std::size_t load = 0; load < 6; ++load) {
      const double e = load < 3 ? 1e-4 : 1e-6;
      std::vector<double> more = none, less = none;
      more[load] = e;
      less[load] = -e;
      Eigen::VectorXd ahead, behind;
      effector_errors(robot.model, rest(more), {where}, ahead);
      effector_errors(robot.model, rest(less), {where}, behind);
      const Eigen::VectorXd slope = (ahead - behind) / (2.0 * e),
                            column = found.compliance.col(static_cast<Eigen::Index>(load));
      for (const EffectorModel& own : robot.model.effectors)
        EXPECT_LT((column - slope).segment(own.first, own.size).norm(),
                  1e-4 * slope.segment(own.first, own.size).norm())
            << displacement << " " << load << " " << robot.model.outputs[own.output].name;
    }
  }
}

TEST(Manipulability, IsTheEllipsoidOfAJacobian) {
  Eigen::MatrixXd J(3, 2);
  J << 2, 0, 0, 0.5, 0, 0;
  const Manipulability own = manipulability(J);
  EXPECT_NEAR(own.gains[0], 2.0, 1e-14);
  EXPECT_NEAR(own.gains[1], 0.5, 1e-14);
  EXPECT_NEAR(own.measure, 1.0, 1e-14);
  EXPECT_LT((J * own.commands - own.directions * own.gains.asDiagonal()).norm(), 1e-14);
  J.col(1) = 3.0 * J.col(0);
  EXPECT_NEAR(manipulability(J).measure, 0.0, 1e-14);
}

}  // namespace
}  // namespace sinew::test
