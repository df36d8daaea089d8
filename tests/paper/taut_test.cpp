// Cables so thin that their tension outweighs their bending stiffness, T l^2 / (E I) large (T: tension, l: way from one
// point to the next): the finger pulled by 20 mm and held with cables of any stiffness, the trunk with its own.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <numbers>

#include "sinew/io/mesh_file.hpp"
#include "sinew/runs/record.hpp"
#include "sinew/sim/internal.hpp"
#include "support/robots.hpp"

namespace sinew::test {
namespace {

constexpr double kPull = 20 * mm, kRadius = 0.5 * mm, kSpan = 81 * mm / 8;

Scene taut_finger(double EI) {
  Scene scene = comparison_finger(std::filesystem::path(SINEW_SHARED_MESHES) / "finger.vtk", kPull);
  const double I = std::numbers::pi / 4 * std::pow(kRadius, 4);
  scene.rods[0].second.material.young = EI / I;
  scene.actuators[0].second.drive = Table{{0.0, 2.0, 2.5}, {0.0, kPull, kPull}};
  scene.time = {0.01, 2.5};
  return scene;
}

struct Taut {
  Trace trace;
  Vec3 tip;
  double tension = 0.0;
  int most = 0;  ///< iterations of any step
};

Taut pulled(const Scene& scene) {
  const Model model = build(scene, io::read_mesh);
  Taut taut;
  taut.trace = run_all(model);
  EXPECT_EQ(taut.trace.end, RunEnd::done) << to_string(taut.trace.failure.status);
  taut.tip = tip(model, taut.trace.states.back());
  taut.tension = std::abs(taut.trace.states.back().actuators[0]);
  for (const StepReport& report : taut.trace.reports) taut.most = std::max(taut.most, report.newton);
  return taut;
}

class TautCable : public testing::TestWithParam<double> {};

TEST_P(TautCable, NewtonConverges) {
  const double wanted = GetParam(), tension = pulled(taut_finger(1e-3)).tension;
  double EI = tension * kSpan * kSpan / wanted;
  Taut converged = pulled(taut_finger(EI));
  EI *= converged.tension / tension;  // a stiff cable takes its own part of the pull
  converged = pulled(taut_finger(EI));
  EXPECT_NEAR(converged.tension * kSpan * kSpan / EI, wanted, 0.1 * wanted);
  EXPECT_NEAR(tautness(build(taut_finger(EI), io::read_mesh), converged.trace.states.back(), 0), wanted,
              0.3 * wanted);  // (sections are not quite as long as the ways between points)
  EXPECT_LE(converged.most, 15);
  for (const StepReport& report : converged.trace.reports) {
    EXPECT_EQ(report.status, Status::converged);
    EXPECT_LT(report.violation, 1e-9);
  }
  RecordProperty("newton", converged.most);
  if (wanted > 1000.0) return;  // beyond, one linearisation a step may run away
  Scene once = taut_finger(EI);
  once.newton.iterations = 1;
  const Taut single = pulled(once);
  EXPECT_LT((single.tip - converged.tip).norm(), 0.05 * mm);
  RecordProperty("single_off_um", std::to_string((single.tip - converged.tip).norm() * 1e6));
}

INSTANTIATE_TEST_SUITE_P(TensionOverBending, TautCable, testing::Values(1.0, 40.0, 400.0, 4000.0),
                         [](const auto& one) { return std::to_string(static_cast<int>(one.param)); });

TEST(TautCable, OneLinearisationThatRunsAwayIsRefused) {
  Scene scene = taut_finger(2e-8);
  scene.newton.iterations = 1;
  const Model model = build(scene, io::read_mesh);
  const Trace trace = run_all(model);
  ASSERT_EQ(trace.end, RunEnd::stopped);
  EXPECT_EQ(trace.failure.status, Status::diverged);
  EXPECT_EQ(trace.failure.detail.substr(0, 10), "rods.cable") << trace.failure.detail;
  EXPECT_EQ(trace.failure.halvings, most_halvings(scene));
  for (const State& state : trace.states) {  // what is kept is no nonsense
    EXPECT_LT((tip(model, state) - tip(model, trace.states[0])).norm(), 80 * mm);
    EXPECT_LT(std::abs(state.actuators[0]), 20.0);
  }
  EXPECT_GT(tautness(model, trace.states.back(), 0), 300.0);
  const auto warnings = [](Scene own) {
    const Model stops = build(own, io::read_mesh);
    const auto run = runs::record(
        stops, initial_state(stops), [](const io::RecordedStep&) {},
        [](const State&, const StepReport&) { return true; }, 1);
    EXPECT_EQ(run.end, RunEnd::stopped);
    return to_strings(run.summary.warnings);
  };
  EXPECT_THAT(warnings(scene),
              testing::Contains(testing::AllOf(testing::StartsWith("rods.cable: its tension outweighs"),
                                               testing::HasSubstr("may fail above 300 (from t"),
                                               testing::HasSubstr("leave `newton` out"))));
  Scene stiff = taut_finger(1e-4);
  stiff.newton.limit = 1;  // it stops, but not for its tension
  EXPECT_THAT(warnings(stiff), testing::Not(testing::Contains(testing::HasSubstr("outweighs"))));
}

/// The authors' trunk with 10 N on one cable or on all four: T l^2 / (E I) = 485 from one point to the next. Its own
/// 450 kPa cannot carry that (one cable curls it up at 2 N, four buckle it below 1 N each), so the body is stiffer.
class TautTrunk : public testing::TestWithParam<std::pair<double, double>> {};

TEST_P(TautTrunk, SingleStepsFollowTheConvergedOnes) {
  const auto [young, others] = GetParam();
  const auto at_10_newton = [&, modulus = young, rest = others](int iterations) {
    Scene scene = trunk(SINEW_SHARED_MESHES, 10);
    scene.solids[0].second.material.law = solid::corotational(modulus, 0.45);
    for (std::size_t i = 0; i < 4; ++i) {
      Actuator& actuator = scene.actuators[i].second;
      actuator.driven = Driven::force;
      actuator.drive = Table{{0.0, 4.0}, {0.0, i == 0 ? 10.0 : rest}};
    }
    scene.time = {0.01, 4.5};
    scene.newton.iterations = iterations;
    Output tip;
    tip.solid = "body";
    tip.point.x = Vec3(0, 0, 195 * mm);
    scene.outputs.emplace_back("tip", tip);
    return pulled(scene);
  };
  const Taut single = at_10_newton(1), converged = at_10_newton(0);
  EXPECT_LE(converged.most, 15);
  EXPECT_NEAR(single.tension, 10.0, 1e-9);
  ASSERT_EQ(single.trace.states.size(), converged.trace.states.size());
  double farthest = 0.0;
  for (std::size_t i = 0; i < single.trace.states.size(); ++i) {
    const auto apart = single.trace.states[i].solids[0].x - converged.trace.states[i].solids[0].x;
    farthest = std::max(farthest, apart.colwise().norm().maxCoeff());
  }
  EXPECT_LT(farthest, 1 * mm);  // of 42 mm: what one linearisation a step is behind
  RecordProperty("farthest_um", std::to_string(farthest * 1e6));
}

INSTANTIATE_TEST_SUITE_P(YoungAndOtherCables, TautTrunk, testing::Values(std::pair{45e6, 0.0}, std::pair{45e6, 10.0}));

}  // namespace
}  // namespace sinew::test
