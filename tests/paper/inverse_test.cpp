// The inverse problem on the public robots: Figs. 9 and 10 of the paper.
#include "sinew/sim/inverse.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include "sinew/io/mesh_file.hpp"
#include "sinew/sim/motors.hpp"
#include "sinew/sim/places.hpp"
#include "sinew/sim/run.hpp"
#include "sinew/sim/signals.hpp"
#include "sinew/sim/statics.hpp"
#include "support/robots.hpp"

namespace sinew::test {
namespace {

const std::filesystem::path kMeshes = SINEW_SHARED_MESHES;
const Vec3 kTrunkTip(0, 0, 195 * mm);
const Vec3 kFingerTip(-103 * mm, 7 * mm, 7 * mm);  // of the mesh
constexpr double kMost = 10.0;                     // [N], as the paper's

Scene still(Scene scene) {
  scene.analysis = Analysis::quasi_static;
  scene.newton.iterations = 0;
  return scene;
}

Scene told(Scene scene, const Vec3& tip, double most, double preferred = 0.0) {
  add_target(scene, tip, most);
  for (auto& [name, actuator] : scene.actuators) actuator.preferred = preferred;
  return scene;
}

Vec3 tip_of(const Model& model, const State& state) { return output_position(model, state, model.outputs[0]); }

State at_rest(const Model& model, Workspace& workspace, const std::vector<double>& commands, const State& near) {
  const StepResult result = equilibrium_step(model, workspace, {commands, {}}, near, near.time + 0.01);
  EXPECT_TRUE(accepted(result.report.status));
  return result.next;
}

/// Starts and ends at rest.
double smooth(double u) { return u * u * u * (10.0 + u * (6.0 * u - 15.0)); }

/// Curves on the surface that pairs of opposite cables reach: signed pulls of the two pairs, 0 <= u <= 1.
struct Curve {
  const char* name;
  std::array<double, 2> (*pull)(double u);
};
const Curve kCurves[] = {
    {"line",
     [](double u) {
       return std::array{0.07 * std::sin(2.0 * std::numbers::pi * u), 0.035 * std::sin(2.0 * std::numbers::pi * u)};
     }},
    {"circle",
     [](double u) {
       // Out from the middle as cables are tightened, and round.
       const double r = 0.05, a = 2.0 * std::numbers::pi * u;
       return std::array{r * std::cos(a), r * std::sin(a)};
     }},
    {"eight", [](double u) {
       const double a = 2.0 * std::numbers::pi * u;
       return std::array{0.045 * std::sin(a), 0.03 * std::sin(2.0 * a)};
     }}};

/// Pretension [N] that opposite cables share a pull about, once they are tight: where one slackens and another begins
/// to pull, the commands of motion jump as those of rest do not.
constexpr double kTension = 0.08;

std::vector<double> forces_of(const Curve& curve, double u) {
  const auto pull = curve.pull(u);
  const double tight = smooth(std::min(1.0, 2.0 * u)), a = 0.5 * pull[0], b = 0.5 * pull[1];
  return {tight * (kTension + a), tight * (kTension + b), tight * (kTension - a), tight * (kTension - b)};
}

/// Points that direct equilibria reach, `count` of them, over `seconds`.
Track reached_by(const Model& model, const Curve& curve, int count, double seconds) {
  Workspace workspace = make_workspace(model);
  State state = initial_state(model);
  Track track;
  for (int i = 0; i <= count; ++i) {
    const double u = static_cast<double>(i) / count;
    state = at_rest(model, workspace, forces_of(curve, smooth(u)), state);
    track.times.push_back(seconds * u);
    track.values.emplace_back(tip_of(model, state));
  }
  return track;
}

double length_of(const Track& track) {
  double sum = 0.0;
  for (std::size_t i = 1; i < track.values.size(); ++i) sum += (track.values[i] - track.values[i - 1]).norm();
  return sum;
}

struct Followed {
  double worst = 0.0, second_difference = 0.0;
  int unreached = 0;
  std::vector<std::vector<double>> commands;
  std::vector<Vec3> tips;
};

Followed follow(const Model& model) {
  Followed result;
  result.commands.push_back(initial_state(model).actuators);
  const RunEnd end = run(model, initial_state(model), [&](const State& state, const StepReport& report) {
    const Vec3 goal = goal_at(model, state.time).at;
    result.worst = std::max(result.worst, (tip_of(model, state) - goal).norm());
    result.unreached += report.aim.outcome != Aim::Outcome::reached;
    for (const double force : state.actuators) {
      EXPECT_GE(force, 0.0);
      EXPECT_LE(force, kMost);
    }
    result.commands.push_back(state.actuators);
    result.tips.push_back(tip_of(model, state));
    return true;
  });
  EXPECT_EQ(end, RunEnd::done);
  for (std::size_t i = 1; i + 1 < result.commands.size(); ++i) {
    for (std::size_t a = 0; a < result.commands[i].size(); ++a)
      result.second_difference =
          std::max(result.second_difference,
                   std::abs(result.commands[i + 1][a] - 2.0 * result.commands[i][a] + result.commands[i - 1][a]));
  }
  return result;
}

class PaperInverse : public testing::Test {
 protected:
  void SetUp() override {
    if (!std::filesystem::exists(kMeshes / "trunk.vtk")) GTEST_SKIP() << "no trunk.vtk in " << kMeshes;
  }
};

/// A path of 100 mm in 5 s: equilibria within 0.1 mm, one quadratic problem per 10 ms within 1 mm.
TEST_F(PaperInverse, TrunkFollowsALineACircleAndAnEight) {
  const Model direct = build(still(told(trunk(kMeshes, 10), kTrunkTip, kMost, kTension)), io::read_mesh);
  for (const Curve& curve : kCurves) {
    const Track path = reached_by(direct, curve, 500, 5.0);
    RecordProperty(std::string(curve.name) + "_length_mm", std::to_string(length_of(path) / mm));
    EXPECT_GT(length_of(path), 100 * mm) << curve.name;
    Scene scene = told(trunk(kMeshes, 10), kTrunkTip, kMost, kTension);
    scene.targets[0].at = path;
    scene.time = {0.01, 5.0};
    const Followed real_time = follow(build(scene, io::read_mesh));
    const Followed converged = follow(build(still(scene), io::read_mesh));
    EXPECT_LT(real_time.worst, 1 * mm) << curve.name;
    EXPECT_LT(converged.worst, 0.1 * mm) << curve.name;
    EXPECT_EQ(converged.unreached, 0) << curve.name;
    EXPECT_LT(real_time.second_difference, 3.0 * converged.second_difference) << curve.name;
    RecordProperty(std::string(curve.name) + "_second_difference", std::to_string(real_time.second_difference));
    RecordProperty(std::string(curve.name) + "_second_difference_at_rest", std::to_string(converged.second_difference));
    RecordProperty(std::string(curve.name) + "_real_time_mm", std::to_string(real_time.worst / mm));
    RecordProperty(std::string(curve.name) + "_converged_mm", std::to_string(converged.worst / mm));
  }
}

/// One cable: its own curve is reached, and off it the nearest point of the curve, as trying all forces finds it.
TEST_F(PaperInverse, FingerReachesItsCurveAndTheNearestPointOfIt) {
  Scene scene = still(told(finger(kMeshes, 6, 7, Cable::cosserat), kFingerTip, 20.0));
  const Model model = build(scene, io::read_mesh);
  Workspace workspace = make_workspace(model);
  std::vector<Vec3> curve;
  State state = initial_state(model);
  for (int i = 0; i <= 200; ++i) {
    state = at_rest(model, workspace, {0.1 * i}, state);
    curve.push_back(tip_of(model, state));
  }
  const auto brute = [&](const Vec3& goal) {
    double best = INFINITY;
    for (std::size_t i = 0; i + 1 < curve.size(); ++i) {  // nearest point of each chord
      const Vec3 way = curve[i + 1] - curve[i];
      const double t = std::clamp((goal - curve[i]).dot(way) / way.squaredNorm(), 0.0, 1.0);
      best = std::min(best, (curve[i] + t * way - goal).norm());
    }
    return best;
  };
  for (const std::size_t i : {std::size_t{10}, std::size_t{60}, std::size_t{150}}) {
    for (const Vec3& off : {Vec3(0, 0, 0), Vec3(3 * mm, 5 * mm, 0), Vec3(-6 * mm, 10 * mm, 4 * mm)}) {
      const Vec3 goal = curve[i] + off;
      State found = initial_state(model);
      const StepReport report = inverse_equilibrium(model, workspace, {goal}, {{0.0}, {}}, 0.01, found);
      ASSERT_TRUE(accepted(report.status));
      const double distance = (tip_of(model, found) - goal).norm();
      EXPECT_NEAR(distance, brute(goal), 0.1 * mm) << i << " " << off.transpose();
      if (off.isZero(0.0)) EXPECT_EQ(report.aim.outcome, Aim::Outcome::reached);
      EXPECT_GE(found.actuators[0], 0.0);
    }
  }
}

/// Both tangents of both robots, pulled by forces and moved by displacements, against central differences.
TEST_F(PaperInverse, JacobiansAreDifferences) {
  struct Case {
    const char* name;
    Scene scene;
    std::vector<double> force;
    Driven driven;
  };
  const Scene finger_told = told(finger(kMeshes, 6, 7, Cable::cosserat), kFingerTip, 20.0);
  const Scene trunk_told = told(trunk(kMeshes, 10), kTrunkTip, kMost);
  for (const Case& own :
       {Case{"finger", finger_told, {3.0}, Driven::force}, Case{"finger", finger_told, {3.0}, Driven::displacement},
        Case{"trunk", trunk_told, {0.15, 0.05, 0.03, 0.02}, Driven::force},
        Case{"trunk", trunk_told, {0.15, 0.05, 0.03, 0.02}, Driven::displacement}}) {
    for (const bool at_equilibrium : {true, false}) {
      // Where forces hold it at rest; then perhaps driven by the displacements that it has there.
      Scene scene = still(own.scene);
      scene.newton.tolerance = 1e-12;
      const Model pulled = build(scene, io::read_mesh);
      Workspace pulling = make_workspace(pulled);
      const State rest = at_rest(pulled, pulling, own.force, initial_state(pulled));
      for (auto& [name, actuator] : scene.actuators) actuator.driven = own.driven;
      if (!at_equilibrium) {
        scene.analysis = Analysis::dynamic;
        scene.newton.iterations = 1;
      }
      const Model model = build(scene, io::read_mesh);
      Workspace workspace = make_workspace(model);
      std::vector<double> at = own.driven == Driven::force ? own.force : motor_positions(pulled, rest);
      State from = initial_state(model);
      if (at_equilibrium) {
        from = at_rest(model, workspace, at, from);
      } else {
        for (int i = 1; i <= 60; ++i) {
          std::vector<double> part = at;
          for (double& command : part) command *= std::min(1.0, i / 50.0);
          ASSERT_TRUE(accepted(step(model, workspace, {part, {}}, 0.01, from).status)) << own.name;
        }
      }
      const Eigen::MatrixXd J =
          actuator_jacobian(model, workspace, from, at_equilibrium ? JacobianOf::equilibrium : JacobianOf::step, 0.01)
              .effectors;
      const auto tip = [&](std::vector<double> commands, std::size_t a, double more) {
        commands[a] += more;
        if (at_equilibrium) return tip_of(model, at_rest(model, workspace, commands, from));
        State next = from;
        EXPECT_TRUE(accepted(step(model, workspace, {commands, {}}, 0.01, next).status));
        return tip_of(model, next);
      };
      for (std::size_t a = 0; a < at.size(); ++a) {
        const double e = own.driven == Driven::force ? 1e-3 * own.force[0] : 5e-4 * mm;
        const Vec3 slope = (tip(at, a, e) - tip(at, a, -e)) / (2.0 * e);
        EXPECT_LT((J.col(static_cast<Eigen::Index>(a)) - slope).norm(), 1e-5 * slope.norm())
            << own.name << " " << a << " " << at_equilibrium << " " << (own.driven == Driven::force);
      }
    }
  }
}

/// Targets within reach and far from it. The finger's one cable makes its tip go along a curve: what is found is the
/// nearest point of it, and the status says what brute force says.
TEST_F(PaperInverse, ThousandTargetsEndWithTheRightStatus) {
  const double most = 12.0;
  const Model model = build(still(told(finger(kMeshes, 6, 7, Cable::cosserat), kFingerTip, most)), io::read_mesh);
  Workspace workspace = make_workspace(model);
  std::vector<Vec3> curve;
  State state = initial_state(model);
  constexpr int kPoints = 600;
  for (int i = 0; i <= kPoints; ++i) {
    state = at_rest(model, workspace, {most * i / kPoints}, state);
    curve.push_back(tip_of(model, state));
  }
  std::mt19937 engine(7);
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  std::normal_distribution<double> normal;
  int counts[4] = {}, wrong = 0, farther = 0;
  for (int trial = 0; trial < 1000; ++trial) {
    const auto near = static_cast<std::size_t>(uniform(engine) * kPoints);
    const double far = trial % 3 == 0 ? 0.02 * mm : trial % 3 == 1 ? 3 * mm : 30 * mm;
    const Vec3 goal = curve[near] + far * Vec3(normal(engine), normal(engine), normal(engine));
    State found = initial_state(model);
    const StepReport report = inverse_equilibrium(model, workspace, {goal}, {{0.0}, {}}, 0.01, found);
    ASSERT_TRUE(accepted(report.status)) << trial;
    ASSERT_TRUE(finite(found)) << trial;
    const double force = found.actuators[0];
    EXPECT_GE(force, 0.0);
    EXPECT_LE(force, most * (1.0 + 1e-9));
    const double distance = (tip_of(model, found) - goal).norm();
    EXPECT_NEAR(report.aim.farthest, distance / (0.1 * mm), 1e-9 * distance / mm + 1e-12);
    double best = INFINITY;
    for (std::size_t i = 0; i + 1 < curve.size(); ++i) {
      const Vec3 way = curve[i + 1] - curve[i];
      const double t = std::clamp((goal - curve[i]).dot(way) / way.squaredNorm(), 0.0, 1.0);
      best = std::min(best, (curve[i] + t * way - goal).norm());
    }
    farther += distance > best + 0.1 * mm;
    // Where the curve has bent back, another part of it may be nearer; not the next one.
    const auto own = static_cast<std::size_t>(std::lround(force / most * kPoints));
    for (std::size_t i = own > 5 ? own - 5 : 0; i <= std::min<std::size_t>(own + 5, kPoints); ++i)
      EXPECT_GE((curve[i] - goal).norm(), distance - 1e-6) << trial;
    ++counts[static_cast<int>(report.aim.outcome)];
    const bool reached = distance <= 0.1 * mm, at_limit = force < 1e-9 * most || force > most * (1.0 - 1e-9);
    wrong += report.aim.outcome != (reached    ? Aim::Outcome::reached
                                    : at_limit ? Aim::Outcome::limited
                                               : Aim::Outcome::nearest);
    if (best < 0.09 * mm) EXPECT_EQ(report.aim.outcome, Aim::Outcome::reached) << trial;
  }
  EXPECT_EQ(wrong, 0);
  EXPECT_LE(farther, 10);
  RecordProperty("not_the_nearest_of_all", farther);
  RecordProperty("reached", counts[1]);
  RecordProperty("limited", counts[2]);
  RecordProperty("nearest", counts[3]);
  EXPECT_GT(std::min({counts[1], counts[2], counts[3]}), 50);
}

/// The same of the trunk in motion, by forces and by displacements that have limits of force: limits are kept.
TEST_F(PaperInverse, ThousandTargetsInMotionKeepTheLimits) {
  for (const auto& [driven, rounds, trials] :
       {std::tuple{Driven::force, 1, 500}, std::tuple{Driven::displacement, 1, 500}, std::tuple{Driven::force, 40, 100},
        std::tuple{Driven::displacement, 40, 100}}) {
    Scene scene = told(trunk(kMeshes, 10), kTrunkTip, 0.5);
    scene.newton.iterations = rounds;
    for (auto& [name, actuator] : scene.actuators) {
      actuator.driven = driven;
      actuator.limits.speed = 0.2;
      actuator.limits.force_rate = 4.0;
    }
    const Model model = build(scene, io::read_mesh);
    Workspace workspace = make_workspace(model);
    State state = initial_state(model);
    std::mt19937 engine(11);
    std::normal_distribution<double> normal;
    const double h = 0.01;
    int outcomes[4] = {};
    Vec3 goal = kTrunkTip, last = goal;
    const Model slow = build(still(told(trunk(kMeshes, 10), kTrunkTip, 0.5)), io::read_mesh);
    Workspace resting = make_workspace(slow);
    State rest = initial_state(slow);
    std::uniform_real_distribution<double> uniform(0.02, 0.06);
    for (int trial = 0; trial < trials; ++trial) {
      // By turns within reach, and anywhere.
      if (trial % 25 == 0) last = goal;
      if (trial % 50 == 0) {
        rest = at_rest(slow, resting, {uniform(engine), uniform(engine), uniform(engine), uniform(engine)}, rest);
        goal = tip_of(slow, rest);
      }
      if (trial % 50 == 25) goal = kTrunkTip + 8 * mm * Vec3(normal(engine), normal(engine), -std::abs(normal(engine)));
      const std::vector<double> before = motor_positions(model, state);
      const Vec3 now = last + smooth(std::min(1.0, trial % 25 / 20.0)) * (goal - last);
      const StepReport report = inverse_step(model, workspace, {now}, command_of(model, state), h, state);
      ASSERT_TRUE(accepted(report.status)) << trial << " " << to_string(report.status) << " " << report.detail;
      ASSERT_TRUE(finite(state)) << trial;
      ++outcomes[static_cast<int>(report.aim.outcome)];
      const std::vector<double> after = motor_positions(model, state);
      EXPECT_TRUE(report.aim.broken.empty()) << trial;
      if (!report.aim.dropped.empty()) continue;
      for (std::size_t a = 0; a < 4; ++a) {
        // Told or not.
        EXPECT_GE(state.actuators[a], -1e-9 * 0.5) << trial;
        EXPECT_LE(state.actuators[a], 0.5 * (1.0 + 1e-9)) << trial;
        EXPECT_LE(std::abs(after[a] - before[a]), 0.2 * h * (1.0 + 1e-9)) << trial;
      }
    }
    EXPECT_GT(outcomes[1], trials / 25);
    EXPECT_GT(outcomes[2], trials / 25);
  }
}

Obstacle wall_at(const Vec3& point, const Vec3& normal) {
  Obstacle wall;
  wall.shape = PlaneShape{point, normal};
  return wall;
}

void press(Scene& scene, double force) {
  Output touch;
  touch.between = {"body", "wall"};
  scene.outputs.emplace_back("touch", touch);
  Target target;
  target.output = "touch";
  target.at = Track{{0.0}, {Eigen::VectorXd::Constant(1, force)}};
  scene.targets.push_back(target);
}

/// The finger closes on a wall 2 mm from it and presses as hard as it is told, in motion and at rest.
TEST_F(PaperInverse, FingerPressesAWall) {
  for (const bool moves : {false, true}) {
    Scene scene = told(finger(kMeshes, 6, 7, Cable::cosserat), kFingerTip, 20.0);
    scene.targets.clear();
    scene.contact.friction = 0.5;
    const Model free = build(still(told(finger(kMeshes, 6, 7, Cable::cosserat), kFingerTip, 20.0)), io::read_mesh);
    const double side = initial_state(free).solids[0].x.row(1).maxCoeff();
    scene.obstacles.emplace_back("wall", wall_at(Vec3(0, side + 2 * mm, 0), -Vec3::UnitY()));
    press(scene, 0.3);
    scene.actuators[0].second.limits.force_rate = 20.0;
    scene.time = {0.01, 0.4};
    const Model model = build(moves ? scene : still(scene), io::read_mesh);
    double force = 0.0;
    Aim aim;
    const RunEnd end = run(model, initial_state(model), [&](const State& state, const StepReport& report) {
      force = pressing_of(state, 0).force;
      aim = report.aim;
      return true;
    });
    EXPECT_EQ(end, RunEnd::done);
    EXPECT_EQ(aim.outcome, Aim::Outcome::reached) << describe(model, aim);
    EXPECT_NEAR(force, 0.3, 1e-4) << moves;
  }
}

/// The trunk's tip follows a line along a plane at its side while it presses against it.
TEST_F(PaperInverse, TrunkSlidesAlongAPlaneAsItPresses) {
  for (const double friction : {0.0, 0.3}) {
    Scene scene = still(told(trunk(kMeshes, 10), kTrunkTip, kMost, 0.05));
    scene.contact.friction = friction;
    scene.obstacles.emplace_back("wall", wall_at(Vec3(0, 30 * mm, 0), -Vec3::UnitY()));
    scene.targets[0].weights = {1, 0, 0};
    scene.targets[0].at =
        Track{{0.0, 0.5, 1.0, 2.0}, {kTrunkTip, kTrunkTip, Vec3(15 * mm, 0, 0), Vec3(-15 * mm, 0, 0)}};
    press(scene, 0.02);
    scene.time = {0.1, 2.0};
    const Model model = build(scene, io::read_mesh);
    double worst = 0.0, off = 0.0;
    const RunEnd end = run(model, initial_state(model), [&](const State& state, const StepReport& report) {
      if (state.time < 0.49) return true;
      EXPECT_EQ(report.aim.outcome, Aim::Outcome::reached) << state.time << " " << describe(model, report.aim);
      worst = std::max(worst, std::abs(tip_of(model, state).x() - goal_at(model, state.time).at[0]));
      off = std::max(off, std::abs(pressing_of(state, 0).force - 0.02));
      for (const double force : state.actuators) EXPECT_GE(force, 0.0);
      return true;
    });
    EXPECT_EQ(end, RunEnd::done);
    EXPECT_LT(worst, 0.1 * mm) << friction;
    EXPECT_LT(off, 0.01) << friction;
    RecordProperty("tangent_mm_" + std::to_string(friction), std::to_string(worst / mm));
    RecordProperty("force_off_" + std::to_string(friction), std::to_string(off));
  }
}

/// What was found for the motors drives a robot without targets along the same path, by forces and by displacements, in
/// motion and at rest.
TEST_F(PaperInverse, ReplayedCommandsReproduceThePath) {
  const Model direct = build(still(told(trunk(kMeshes, 10), kTrunkTip, kMost, kTension)), io::read_mesh);
  const Track path = reached_by(direct, kCurves[1], 200, 2.0);
  for (const Driven driven : {Driven::force, Driven::displacement}) {
    for (const bool moves : {true, false}) {
      Scene scene = told(trunk(kMeshes, 10), kTrunkTip, kMost, kTension);
      for (auto& [name, actuator] : scene.actuators) actuator.driven = driven;
      scene.time = {0.01, 2.0};
      if (!moves) scene = still(scene);
      scene.targets[0].at = path;
      const Model model = build(scene, io::read_mesh);
      std::vector<Vec3> tips;
      std::vector<Table> tables(4);
      const auto note = [&](const State& state) {
        const Command command = command_of(model, state);
        for (std::size_t a = 0; a < 4; ++a) {
          tables[a].times.push_back(state.time);
          tables[a].values.push_back(command.actuators[a]);
        }
      };
      note(initial_state(model));
      EXPECT_EQ(run(model, initial_state(model),
                    [&](const State& state, const StepReport&) {
                      note(state);
                      tips.push_back(tip_of(model, state));
                      return true;
                    }),
                RunEnd::done);
      for (std::size_t a = 0; a < 4; ++a) scene.actuators[a].second.drive = tables[a];
      scene.targets.clear();
      const Model again = build(scene, io::read_mesh);
      double worst = 0.0;
      std::size_t at = 0;
      EXPECT_EQ(run(again, initial_state(again),
                    [&](const State& state, const StepReport&) {
                      worst = std::max(worst, (tip_of(again, state) - tips.at(at++)).norm());
                      return true;
                    }),
                RunEnd::done);
      EXPECT_EQ(at, tips.size());
      EXPECT_LT(worst, 1e-6) << moves << " " << (driven == Driven::force);
      RecordProperty(std::string(moves ? "moves" : "rests") + (driven == Driven::force ? "_force" : "_displacement"),
                     std::to_string(worst * 1e9) + " nm");
    }
  }
}

}  // namespace
}  // namespace sinew::test
