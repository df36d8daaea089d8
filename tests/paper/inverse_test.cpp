// The inverse problem on the public robots: Figs. 9 and 10 of the paper.
#include "sinew/sim/inverse.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "sinew/io/mesh_file.hpp"
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

}  // namespace
}  // namespace sinew::test
