// Commands of motors that bring points, turns and strains where they are wanted.
#include "sinew/sim/inverse.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <stdexcept>

#include "sim/inverse_robots.hpp"
#include "sinew/lie/rotation.hpp"
#include "sinew/sim/motors.hpp"
#include "sinew/sim/places.hpp"
#include "sinew/sim/run.hpp"
#include "sinew/sim/signals.hpp"

namespace sinew::test {
namespace {

using Outcome = Aim::Outcome;

TEST_F(Inverse, ReplayedCommandsReproduceTheStep) {
  for (const bool displacement : {false, true}) {
    for (const int iterations : {1, 0}) {
      Scene scene = two_cables();
      scene.newton.iterations = iterations;
      if (displacement) drive_by_displacement(scene);
      Robot robot(scene);
      for (int i = 0; i < 5; ++i) {
        const State before = robot.state;
        const StepReport report = robot.seek(robot.tip() - 0.1 * mm * Vec3::UnitY());
        ASSERT_TRUE(accepted(report.status)) << to_string(report.status);
        const State again = robot.direct(before, command_of(robot.model, robot.state).actuators);
        EXPECT_LT((again.solids[0].x - robot.state.solids[0].x).norm(), 1e-9 * 50 * mm) << i;
        EXPECT_LT((again.rods[0].q - robot.state.rods[0].q).norm(), 1e-8 * (1.0 + again.rods[0].q.norm())) << i;
      }
    }
  }
}

TEST_F(Inverse, ReachesWhatADirectStepReached) {
  Robot robot(two_cables());
  const State wanted = robot.direct(robot.state, {1.3, 0.4});
  const double way = (robot.tip(wanted) - robot.tip()).norm();
  ASSERT_TRUE(accepted(robot.seek(robot.tip(wanted)).status));
  EXPECT_LT((robot.tip() - robot.tip(wanted)).norm(), 1e-3 * way);
}

/// With `newton` converged the goal is met to the tolerance of the motion, not of one linearisation.
TEST_F(Inverse, ConvergedStepsMeetTheirGoals) {
  Scene scene = two_cables();
  scene.newton.iterations = 0;
  scene.targets[0].weights = {1, 1, 0};  // two forces, two components
  Robot robot(scene);
  for (int i = 0; i < 10; ++i) {
    const Vec3 goal = robot.tip() + Vec3(-0.05 * mm, -0.05 * mm, 0.0);
    const StepReport report = robot.seek(goal);
    ASSERT_TRUE(accepted(report.status)) << to_string(report.status);
    EXPECT_EQ(report.aim.outcome, Outcome::reached);
    EXPECT_LT((robot.tip() - goal).head<2>().norm(), 1e-9) << i;
  }
}

/// No other forces within the bounds bring the tip nearer, and what is in the way is told.
TEST_F(Inverse, FindsTheNearestWithinItsLimits) {
  Robot robot(two_cables(2.0));
  const State start = robot.state;
  for (const Vec3& off : {Vec3(0, -3 * mm, 0), Vec3(0, 3 * mm, 0), Vec3(-1 * mm, 0, 0), Vec3(1 * mm, 0, 0)}) {
    const Vec3 goal = robot.tip(start) + off;
    robot.state = start;
    const StepReport report = robot.seek(goal);
    ASSERT_TRUE(accepted(report.status));
    const std::vector<double> best = robot.state.actuators;
    const double distance = (robot.tip() - goal).norm();
    const bool pulls_back = off.x() < 0.0;  // which two cables can, though not without moving the tip sideways, too
    EXPECT_EQ(report.aim.outcome, pulls_back ? Outcome::nearest : Outcome::limited);
    EXPECT_NEAR(report.aim.farthest, distance / (0.1 * mm), 1e-6);
    EXPECT_EQ(report.aim.binding.empty(), pulls_back);
    EXPECT_TRUE(report.aim.certain);
    for (const Bound& bound : report.aim.binding) {
      EXPECT_NEAR(best[bound.actuator], bound.limit == Limit::least_force ? 0.0 : 2.0, 1e-9);
      EXPECT_NE(describe(robot.model, bound).find("force at"), std::string::npos);
    }
    for (std::size_t a = 0; a < 2; ++a) {
      EXPECT_GE(best[a], 0.0);
      EXPECT_LE(best[a], 2.0);
      for (const double change : {-0.05, 0.05}) {
        std::vector<double> other = best;
        other[a] += change;
        if (other[a] < 0.0 || other[a] > 2.0) continue;
        EXPECT_GE((robot.tip(robot.direct(start, other)) - goal).norm(), distance * (1.0 - 1e-6)) << a << " " << change;
      }
    }
  }
}

/// A motor that moves may be held by what it must pull, and one that pulls by how far it comes.
TEST_F(Inverse, KeepsLimitsOfWhatIsNotTold) {
  Scene scene = two_cables(1.5);
  drive_by_displacement(scene);
  Robot moved(scene);
  const StepReport report = moved.seek(moved.tip() - 5 * mm * Vec3::UnitY());
  ASSERT_TRUE(accepted(report.status));
  EXPECT_EQ(report.aim.outcome, Outcome::limited);
  EXPECT_NEAR(moved.state.actuators[1], 1.5, 1e-6);  // (the cable below the middle)
  EXPECT_GE(moved.state.actuators[0], -1e-9);

  scene = two_cables();
  scene.actuators[1].second.limits.displacement = {-0.02 * mm, 0.03 * mm};
  Robot pulled(scene);
  ASSERT_TRUE(accepted(pulled.seek(pulled.tip() - 5 * mm * Vec3::UnitY()).status));
  EXPECT_NEAR(motor_positions(pulled.model, pulled.state)[1], 0.03 * mm, 1e-9);
}

TEST_F(Inverse, KeepsRates) {
  Scene scene = two_cables();
  scene.actuators[1].second.limits.force_rate = 10.0;
  Robot robot(scene);
  for (int i = 1; i <= 5; ++i) {
    const StepReport report = robot.seek(robot.tip() - 5 * mm * Vec3::UnitY());
    ASSERT_TRUE(accepted(report.status));
    EXPECT_NEAR(robot.state.actuators[1], 0.2 * i, 1e-9);
    EXPECT_EQ(report.aim.binding.back().limit, Limit::force_rate);
  }
  scene = two_cables();
  scene.actuators[1].second.limits.speed = 1 * mm;
  Robot slow(scene);
  for (int i = 1; i <= 5; ++i) {
    ASSERT_TRUE(accepted(slow.seek(slow.tip() - 5 * mm * Vec3::UnitY()).status));
    EXPECT_NEAR(motor_positions(slow.model, slow.state)[1], 0.02 * mm * i, 1e-9);
  }
}

/// Limits of a force and of its rate that just meet, and a posture at rest that the limits do not allow: both are kept,
/// and nothing is dropped that need not be.
TEST_F(Inverse, KeepsPretensionAtRestAndWhereRatesJustMeetIt) {
  for (const Analysis analysis : {Analysis::dynamic, Analysis::quasi_static}) {
    for (const double rate : {kNone, 2.5, 5.0, 10.0, 12.5, 25.0}) {
      Scene scene = two_cables();
      scene.analysis = analysis;
      for (auto& [name, actuator] : scene.actuators) {
        actuator.limits.force = Span{0.5, kNone};
        if (std::isfinite(rate)) actuator.limits.force_rate = rate;
      }
      Robot robot(scene);
      const Vec3 goal = robot.tip();
      for (int i = 1; i <= 12; ++i) {
        const StepReport report = analysis == Analysis::dynamic ? robot.seek(goal) : robot.settle(goal);
        ASSERT_TRUE(accepted(report.status)) << rate << " " << i << " " << report.detail;
        const double come = std::isfinite(rate) ? rate * 0.02 * i : kNone;
        for (const double force : robot.state.actuators) {
          EXPECT_GE(force, std::min(0.5, come) - 1e-8) << rate << " " << i;
          EXPECT_LE(force, come + 1e-8) << rate << " " << i;
        }
        EXPECT_TRUE(report.aim.broken.empty()) << rate << " " << i;
        EXPECT_EQ(report.aim.dropped.size(), come < 0.5 - 1e-9 ? 2 : 0) << rate << " " << i;
      }
    }
  }
}

/// Who says only the most does not let a cable push.
TEST_F(Inverse, CablesDoNotPushWhereOnlyTheMostIsGiven) {
  for (const Analysis analysis : {Analysis::dynamic, Analysis::quasi_static}) {
    Scene scene = two_cables();
    scene.analysis = analysis;
    for (auto& [name, actuator] : scene.actuators) actuator.limits.force = Span{-kNone, 2.0};
    Robot robot(scene);
    for (const double side : {-5.0, 5.0}) {
      const Vec3 goal = robot.tip() + side * mm * Vec3::UnitY();
      const StepReport report = analysis == Analysis::dynamic ? robot.seek(goal) : robot.settle(goal);
      ASSERT_TRUE(accepted(report.status));
      EXPECT_NE(report.aim.outcome, Outcome::reached);
      for (const double force : robot.state.actuators) EXPECT_GE(force, -1e-9);
    }
  }
}

/// A pretension that the rate does not allow at once comes as fast as the rate does, and is told as dropped till then.
TEST_F(Inverse, DropsWhatOtherLimitsExclude) {
  Scene scene = two_cables();
  for (auto& [name, actuator] : scene.actuators) {
    actuator.limits.force = Span{0.5, 10.0};
    actuator.limits.force_rate = 10.0;
  }
  Robot robot(scene);
  const Vec3 goal = robot.tip();
  for (int i = 1; i <= 5; ++i) {
    const StepReport report = robot.seek(goal);
    ASSERT_TRUE(accepted(report.status));
    EXPECT_EQ(report.aim.dropped.size(), i < 3 ? 2 : 0) << i;
    for (const double force : robot.state.actuators) EXPECT_GE(force, std::min(0.5, 0.2 * i) - 1e-8) << i;
    for (const Bound& bound : report.aim.dropped) EXPECT_EQ(bound.limit, Limit::least_force);
  }
}

/// One component, two cables: what is left open goes to the preferred forces, and the target is met all the same.
TEST_F(Inverse, ChoosesPreferredForcesWhereTargetsLeaveAChoice) {
  Scene scene = two_cables();
  scene.targets[0].weights = {0, 1, 0};
  Robot lazy(scene);
  const Vec3 goal = lazy.tip() - 0.05 * mm * Vec3::UnitY();
  EXPECT_EQ(lazy.seek(goal).aim.outcome, Outcome::reached);
  EXPECT_NEAR(lazy.state.actuators[0], 0.0, 1e-6);
  for (auto& [name, actuator] : scene.actuators) actuator.preferred = 1.0;
  Robot tense(scene);
  EXPECT_EQ(tense.seek(goal).aim.outcome, Outcome::reached);
  EXPECT_NEAR(tense.tip().y(), lazy.tip().y(), 1e-7);
  // Nearest to 1 N each on the line of forces that do it.
  const double a = tense.state.actuators[0] - 1.0, b = tense.state.actuators[1] - 1.0;
  EXPECT_GT(std::abs(a) + std::abs(b), 0.01);
  const Eigen::MatrixXd J = actuator_jacobian(tense.model, tense.workspace, initial_state(tense.model),
                                              JacobianOf::step, tense.model.scene.time.step)
                                .effectors;
  EXPECT_NEAR(a * J(1, 1) - b * J(1, 0), 0.0, 1e-5 * J.row(1).norm());
}

TEST_F(Inverse, SinglePrecisionIsSteeredToo) {
  Scene scene = two_cables();
  Robot robot(scene);
  scene.newton.precision = linalg::Precision::float32;
  Robot single(scene);
  const Vec3 start = robot.tip();
  for (int i = 0; i < 5; ++i) {
    const Vec3 goal = robot.tip() - 0.1 * mm * Vec3::UnitY();
    ASSERT_TRUE(accepted(robot.seek(goal).status));
    ASSERT_TRUE(accepted(single.seek(goal).status));
  }
  EXPECT_LT((single.tip() - robot.tip()).norm(), 1e-4 * (robot.tip() - start).norm());
  EXPECT_NEAR(single.state.actuators[1], robot.state.actuators[1], 1e-3 * robot.state.actuators[1]);
}

TEST_F(Inverse, MeetsTurnsAndStrains) {
  struct Case {
    std::string output;
    Eigen::VectorXd goal;
    std::vector<double> weights;
  };
  for (const Case& own :
       {Case{"tip", Vec3(0, 0, -0.05), {0, 0, 1}}, Case{"turn", Vec3(0, 0, -0.03), {0, 0, 1}},
        Case{"bend", Eigen::VectorXd::Constant(1, -1.5), {}}, Case{"middle", Vec3(0, 2.8 * mm, 0), {0, 1, 0}}}) {
    Scene scene = hinged();
    scene.targets = {wish(own.output, own.weights)};
    scene.analysis = Analysis::quasi_static;
    scene.newton.iterations = 0;
    Robot robot(scene);
    const StepReport report = robot.settle(own.goal);
    ASSERT_TRUE(accepted(report.status)) << own.output;
    EXPECT_EQ(report.aim.outcome, Outcome::reached) << own.output;
    EXPECT_LT(report.aim.farthest, 1e-3) << own.output << " " << report.newton;
    const Eigen::VectorXd value = effector_value(robot.model, robot.state, robot.model.effectors[0]);
    for (Eigen::Index i = 0; i < value.size(); ++i) {
      if (own.weights.empty() || own.weights[static_cast<std::size_t>(i)] > 0.0) {
        EXPECT_NEAR(value[i], own.goal[i], 1e-3 * own.goal.norm()) << own.output;
      }
    }
  }
}

TEST_F(Inverse, EquilibriaAreTheNearestThereAre) {
  Scene scene = two_cables(4.0);
  scene.analysis = Analysis::quasi_static;
  scene.newton.iterations = 0;
  Robot robot(scene);
  const Vec3 start = robot.tip();
  for (const Vec3& off : {Vec3(0, -1.5 * mm, 0), Vec3(0, -20 * mm, 0), Vec3(2 * mm, 1 * mm, 0), Vec3(-3 * mm, 0, 0)}) {
    robot.state = initial_state(robot.model);
    const Vec3 goal = start + off;
    const StepReport report = robot.settle(goal);
    ASSERT_TRUE(accepted(report.status));
    const std::vector<double> best = robot.state.actuators;
    const double distance = (robot.tip() - goal).norm();
    EXPECT_NE(report.aim.outcome, Outcome::none);
    for (std::size_t a = 0; a < 2; ++a) {
      for (const double change : {-0.02, 0.02}) {
        std::vector<double> other = best;
        other[a] += change;
        if (other[a] < 0.0 || other[a] > 4.0) continue;
        EXPECT_GE((robot.tip(robot.at_rest(other)) - goal).norm(), distance - 1e-9) << a << " " << change;
      }
    }
  }
}

TEST_F(Inverse, RunsFollowTheirTargets) {
  for (const Analysis analysis : {Analysis::dynamic, Analysis::quasi_static}) {
    Scene scene = two_cables();
    scene.analysis = analysis;
    scene.time = {0.02, 0.4};
    scene.newton.iterations = analysis == Analysis::dynamic ? 1 : 0;
    const Vec3 tip(50 * mm, 5 * mm, 5 * mm);
    scene.targets[0].at = Track{{0.0, 0.2}, {tip, tip - 1 * mm * Vec3::UnitY()}};
    scene.targets[0].weights = {0, 1, 0};
    Robot robot(scene);
    int steps = 0;
    const RunEnd end = run(robot.model, robot.state, [&](const State& state, const StepReport& report) {
      ++steps;
      robot.state = state;
      EXPECT_NE(report.aim.outcome, Outcome::none);
      return true;
    });
    EXPECT_EQ(end, RunEnd::done);
    EXPECT_EQ(steps, 20);
    EXPECT_NEAR(robot.tip().y(), 4 * mm, analysis == Analysis::dynamic ? 0.01 * mm : 1e-8);
    const std::vector<std::string> names = signal_names(robot.model);
    const auto error = std::find(names.begin(), names.end(), "tip.error");
    ASSERT_NE(error, names.end());
    EXPECT_NEAR(signal_values(robot.model, robot.state)[static_cast<std::size_t>(error - names.begin())],
                std::abs(robot.tip().y() - 4 * mm), 1e-12);
  }
}

/// A target that jumps further than one step can follow: the run goes on, says where steps fell short, and arrives.
TEST_F(Inverse, TargetsThatJumpAreFollowedOverSteps) {
  Scene scene = two_cables();
  scene.newton.iterations = 0;
  scene.time = {0.005, 0.2};
  const Vec3 tip(50 * mm, 5 * mm, 5 * mm);
  scene.targets[0].at = Track{{0.0}, {tip - 15 * mm * Vec3::UnitY()}};
  scene.targets[0].weights = {0, 1, 0};
  Robot robot(scene);
  int short_of = 0;
  StepReport failed;
  const RunEnd end = run(
      robot.model, robot.state,
      [&](const State& state, const StepReport& report) {
        robot.state = state;
        short_of += report.aim.short_of ? 1 : 0;
        if (report.aim.short_of) {
          EXPECT_NE(report.aim.outcome, Outcome::reached);
          EXPECT_NE(describe(robot.model, report.aim).find("goes no further"), std::string::npos);
        }
        return true;
      },
      &failed);
  EXPECT_EQ(end, RunEnd::done) << robot.state.time << " " << to_string(failed.status) << " " << failed.detail;
  EXPECT_GT(short_of, 0);
  EXPECT_NEAR(robot.tip().y(), -10 * mm, 0.5 * mm);
}

/// No force brings a tip 15 mm away within a millisecond, but those that crush the body on the way: it is come to in
/// many steps, by commands of the size that an equilibrium there takes.
TEST_F(Inverse, FarTargetsAreComeToWithoutViolence) {
  Scene scene = two_cables();
  scene.newton.iterations = 0;
  scene.time = {0.001, 0.1};
  const Vec3 tip(50 * mm, 5 * mm, 5 * mm), goal = tip - 15 * mm * Vec3::UnitY();
  scene.targets[0].at = Track{{0.0}, {goal}};
  scene.targets[0].weights = {0, 1, 0};
  Robot robot(scene);
  scene.analysis = Analysis::quasi_static;
  Robot resting(scene);
  ASSERT_TRUE(accepted(resting.settle(goal).status));
  const auto pulls = [](const State& state) { return std::max(state.actuators[0], state.actuators[1]); };
  const double enough = pulls(resting.state);
  double most = 0.0, shortest = INFINITY;
  const RunEnd end = run(robot.model, robot.state, [&](const State& state, const StepReport&) {
    robot.state = state;
    most = std::max(most, pulls(state));
    shortest = std::min(shortest, robot.tip().x());
    return true;
  });
  EXPECT_EQ(end, RunEnd::done) << robot.state.time;
  EXPECT_NEAR(robot.tip().y(), goal.y(), 2 * mm);
  EXPECT_GT(enough, 0.1);
  EXPECT_LT(most, 4.0 * enough);
  EXPECT_GT(shortest, 0.8 * resting.tip().x());
}

/// Parts of a halved step make for places on the way: straight, by an even turn, in proportion.
TEST_F(Inverse, PartsOfAStepGoPartsOfTheWay) {
  Scene scene = hinged();
  scene.targets = {wish("tip", {0, 0, 1}), wish("turn", {0, 0, 1}), wish("bend"), wish("middle", {0, 1, 0})};
  Robot robot(scene);
  const Model& model = robot.model;
  const State from = robot.direct(robot.state, {1.0, 0.2});
  Goal now{Eigen::VectorXd(effector_size(model))};
  for (const EffectorModel& own : model.effectors)
    now.at.segment(own.first, own.size) = effector_value(model, from, own);
  Goal goal = now;
  goal.at.array() += 0.3;
  EXPECT_LT((part_of_goal(model, from, goal, 1.0).at - goal.at).norm(), 1e-12);
  EXPECT_LT((part_of_goal(model, from, goal, 0.0).at - now.at).norm(), 1e-12);
  const Goal third = part_of_goal(model, from, goal, 1.0 / 3.0);
  for (const EffectorModel& own : model.effectors) {
    const auto of = [&own](const Goal& all) { return Eigen::VectorXd(all.at.segment(own.first, own.size)); };
    if (model.outputs[own.output].quantity == Quantity::orientation) {
      const rod::Mat3 start = lie::exp(Vec3(of(now))), turn = lie::exp(Vec3(of(third))) * start.transpose();
      EXPECT_LT((turn * turn * turn * start - lie::exp(Vec3(of(goal)))).norm(), 1e-12);
    } else {
      EXPECT_LT((of(third) - of(now) - (of(goal) - of(now)) / 3.0).norm(), 1e-12);
    }
  }
}

/// A step that only goes in parts ends at the target all the same, and what its parts make for is said.
TEST_F(Inverse, HalvedStepsEndAtTheTarget) {
  Scene scene = two_cables();
  scene.newton.iterations = 0;
  scene.time = {0.02, 0.1};
  const Vec3 tip(50 * mm, 5 * mm, 5 * mm);
  scene.targets[0].at = Track{{0.0, 0.1}, {tip, tip - 1 * mm * Vec3::UnitY()}};
  scene.targets[0].weights = {0, 1, 0};
  Robot robot(scene);
  Workspace workspace = make_workspace(robot.model);
  State state = robot.state;
  int parts = 0;
  while (state.grid < 5) {
    if (state.time == static_cast<double>(state.grid) * 0.02) state.halvings = 2;  // as after a step that was hard
    const StepReport report = advance(robot.model, workspace, state);
    ASSERT_TRUE(accepted(report.status)) << report.detail;
    ++parts;
    const double y = robot.tip(state).y(), wanted = 5 * mm - 1 * mm * state.time / 0.1;
    EXPECT_NEAR(y, wanted, 1e-3 * mm) << state.time;
    EXPECT_NE(report.aim.outcome, Outcome::nearest);
  }
  EXPECT_GT(parts, 10);
}

/// What breaks before anything is steered.
TEST_F(Inverse, FailsAsAStepDoes) {
  Robot robot(two_cables());
  robot.state.solids[0].v.setConstant(1e200);
  const State before = robot.state;
  const StepReport report = robot.seek(Vec3::Zero());
  EXPECT_FALSE(accepted(report.status));
  EXPECT_EQ(report.aim.outcome, Outcome::none);
  EXPECT_EQ(pack(robot.state), pack(before));
}

TEST_F(Inverse, RefusesWhatItDoesNotKnow) {
  Robot robot(two_cables());
  const State before = robot.state;
  EXPECT_THROW(robot.seek(Eigen::Vector2d(1, 2)), std::invalid_argument);
  EXPECT_THROW(robot.seek(Vec3(0, NAN, 0)), std::invalid_argument);
  EXPECT_EQ(pack(robot.state), pack(before));
  const auto built = [](auto change) {
    Scene scene = two_cables();
    change(scene);
    return build(scene, block_of(600));
  };
  EXPECT_NO_THROW(built([](Scene&) {}));
  EXPECT_ANY_THROW(built([](Scene& s) { s.targets[0].output = "hand"; }));
  EXPECT_ANY_THROW(built([](Scene& s) { s.targets[0].weights = {1, 1}; }));
  EXPECT_ANY_THROW(built([](Scene& s) { s.targets[0].weights = {0, 0, 0}; }));
  EXPECT_ANY_THROW(built([](Scene& s) { s.targets[0].weights = {1, -1, 0}; }));
  EXPECT_ANY_THROW(built([](Scene& s) { s.targets[0].tolerance = 0.0; }));
  EXPECT_ANY_THROW(built([](Scene& s) { s.targets[0].at = Track{{0.0}, {Eigen::Vector2d(1, 2)}}; }));
  EXPECT_ANY_THROW(built([](Scene& s) { s.targets[0].at = Track{{0.0, 1.0}, {Vec3(1, 2, 3)}}; }));
  EXPECT_ANY_THROW(built([](Scene& s) { s.targets.clear(); }));
  EXPECT_ANY_THROW(built([](Scene& s) { s.outputs[0].second.quantity = Quantity::stress; }));
  EXPECT_ANY_THROW(built([](Scene& s) { s.analysis = Analysis::statics; }));
  EXPECT_ANY_THROW(built([](Scene& s) { s.actuators[0].second.limits.force = Span{2.0, 1.0}; }));
  EXPECT_ANY_THROW(built([](Scene& s) { s.actuators[0].second.limits.speed = 0.0; }));
  EXPECT_ANY_THROW(built([](Scene& s) {
    for (auto& [name, actuator] : s.actuators) actuator.drive = Table{{0.0}, {1.0}};
  }));
}

}  // namespace
}  // namespace sinew::test
