// Rods held by more actuators than their strains can answer: the standard tendon robot whose tendons are told lengths.
#include "sinew/sim/redundancy.hpp"

#include <gmock/gmock.h>

#include "sinew/sim/motors.hpp"
#include "sinew/sim/rod_rows.hpp"
#include "validation/rods.hpp"

namespace sinew::test {
namespace {

/// `count` tendons around an arm of 0.2 m that are told lengths which bend it by 1 rad towards `direction`.
Scene tendon_robot(int count, bool elongation, Analysis analysis, double direction = 0.3) {
  Scene scene = straight_rod(0.2, 4, Circle{0.008}, elongation ? kExtensible : kBending, 1, 20);
  scene.analysis = analysis;
  if (analysis == Analysis::dynamic) scene.time = {0.01, 6.0};
  auto& rod = scene.rods[0].second;
  rod.material = {1e6, 0.5, 1100.0};
  rod.material.damping = 0.1;
  for (int i = 0; i < count; ++i) {
    const double angle = 2.0 * pi * i / count;
    Actuator tendon;
    tendon.rod = "rod";
    tendon.tendon = Tendon{0.0, {}, 0.006, angle};
    const double drawn = 0.006 * std::cos(angle - (count == 2 ? 0.0 : direction));
    tendon.drive = Table{{0.0, 1.0}, {0.0, drawn}};
    scene.actuators.emplace_back("t" + std::to_string(i), tendon);
  }
  return scene;
}

/// The tensions of least sum of squares that hold the rod as it is, by a pseudoinverse of the tendons' gradients.
Eigen::VectorXd smallest_tensions(const Solved& solved) {
  const rod::Rod& rod = solved.model.rods[0].rod;
  const Eigen::VectorXd& q = solved.end().rods[0].q;
  const auto count = static_cast<Eigen::Index>(solved.model.actuators.size());
  Eigen::MatrixXd gradients(rod.strain_coordinates(), count);
  Eigen::VectorXd levers = strain_levers(rod), elastic(rod.strain_coordinates());
  for (Eigen::Index i = 0; i < count; ++i)
    gradients.col(i) = rod::tendon_length(rod, *solved.model.actuators[static_cast<std::size_t>(i)].tendon, q).gradient;
  for (int k = 0; k < rod.count(); ++k)
    elastic.segment(rod.first[k], rod.first[k + 1] - rod.first[k]) = rod.sections[k].stiffness * rod.of_section(q, k);
  Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd> inverse;
  inverse.setThreshold(1e-9);
  inverse.compute(levers.cwiseInverse().asDiagonal() * gradients);
  return inverse.solve(Eigen::VectorXd(-elastic.cwiseQuotient(levers)));
}

/// Tendons that are drawn one way and the other, with and without a strain that lets all of them be drawn at once.
class TendonRobot : public testing::TestWithParam<std::tuple<int, bool>> {};

TEST_P(TendonRobot, forces_are_the_smallest_that_hold_it_in_every_analysis) {
  const auto [count, elongation] = GetParam();
  Eigen::VectorXd first;
  for (const Analysis analysis : {Analysis::statics, Analysis::quasi_static, Analysis::dynamic}) {
    SCOPED_TRACE(static_cast<int>(analysis));
    const Solved solved = solve(tendon_robot(count, elongation, analysis));
    ASSERT_TRUE(solved.done());
    const Eigen::VectorXd tensions =
        Eigen::Map<const Eigen::VectorXd>(solved.end().actuators.data(), static_cast<Eigen::Index>(count));
    const double size = tensions.cwiseAbs().maxCoeff();
    EXPECT_GT(size, 0.1);
    EXPECT_LT(size, 10.0);
    EXPECT_LT((tensions - smallest_tensions(solved)).cwiseAbs().maxCoeff(), 1e-6 * size);
    if (first.size() == 0) first = tensions;
    EXPECT_LT((tensions - first).cwiseAbs().maxCoeff(), 1e-6 * size);
    const bool redundant = !solved.model.redundant.empty();
    EXPECT_EQ(redundant, count > (elongation ? 3 : 2) || (count == 2 && !elongation));
    EXPECT_EQ(find_warning(solved.model.warnings, "redundant_constraints") != nullptr, redundant);
    EXPECT_EQ(find_warning(solved.model.warnings, "contradicting_commands"), nullptr);
  }
}
INSTANTIATE_TEST_SUITE_P(Redundancy, TendonRobot, testing::Combine(testing::Values(2, 3, 4, 6), testing::Bool()));

TEST(Redundancy, lengths_that_contradict_each_other_are_named) {
  for (const Analysis analysis : {Analysis::statics, Analysis::quasi_static, Analysis::dynamic}) {
    SCOPED_TRACE(static_cast<int>(analysis));
    Scene scene = tendon_robot(4, false, analysis);
    std::get<Table>(scene.actuators[2].second.drive).values = {0.0, 0.001};
    const Model model = build(scene, read_block);
    const Warning* told = find_warning(model.warnings, "contradicting_commands");
    ASSERT_NE(told, nullptr);
    EXPECT_EQ(told->where, "actuators.t0, actuators.t2");
    EXPECT_THAT(told->remedy, testing::HasSubstr("add `elongation` to the strains of rods.rod, or drive one of them"));
    EXPECT_NEAR(told->value, (0.006 * std::cos(0.3) + 0.001) / std::sqrt(2.0), 1e-9);
    const Trace trace = run_all(model);
    EXPECT_EQ(trace.end, RunEnd::stopped);
    EXPECT_EQ(trace.failure.status, Status::inconsistent);
    EXPECT_THAT(trace.failure.detail, testing::StartsWith("actuators.t0, actuators.t2 contradict each other by"));
  }
}

/// The same with a weight at its tip, across the plane in which the first two tendons bend it: it twists.
Scene loaded_robot(int count, bool elongation, Analysis analysis) {
  Scene scene = tendon_robot(count, elongation, analysis);
  RodLoad weight;
  weight.rod = "rod";
  weight.at = 0.2;
  weight.force = Vec3(0.0, count == 2 ? 0.05 : 0.02, 0.03);
  weight.factor = Table{{0.0, 1.0}, {0.0, 1.0}};
  scene.loads.emplace_back("weight", weight);
  return scene;
}

// Twisted rods are longer by the tendons' measure (d^2 tau^2 / 2), which rows that depend on each other at the start
// would have to keep out by forces of any size: 1e6 N and more, and no torsion.
TEST_P(TendonRobot, forces_stay_small_where_the_rod_twists) {
  const auto [count, elongation] = GetParam();
  Eigen::VectorXd first, reference;
  for (const Analysis analysis : {Analysis::statics, Analysis::quasi_static, Analysis::dynamic}) {
    SCOPED_TRACE(static_cast<int>(analysis));
    const Solved solved = solve(loaded_robot(count, elongation, analysis));
    ASSERT_TRUE(solved.done());
    const Eigen::VectorXd tensions =
        Eigen::Map<const Eigen::VectorXd>(solved.end().actuators.data(), static_cast<Eigen::Index>(count));
    const Vec3 tip = solved.tip();
    if (first.size() == 0) {
      first = tensions;
      reference = tip;
    }
    EXPECT_LT(tensions.cwiseAbs().maxCoeff(), 20.0);
    EXPECT_LT((tensions - first).cwiseAbs().maxCoeff(), 1e-6 * first.cwiseAbs().maxCoeff());
    EXPECT_LT((tip - reference).norm(), 1e-7);
    EXPECT_EQ(solved.model.redundant.empty(), !(count > (elongation ? 3 : 2) || (count == 2 && !elongation)));
  }
}

// And the shape is that of a rod that can stretch a little, which needs no such care.
TEST(Redundancy, a_rod_that_twists_goes_where_one_that_can_stretch_goes) {
  Vec3 tip[2];
  for (const bool elongation : {false, true}) {
    const Solved solved = solve(loaded_robot(2, elongation, Analysis::quasi_static));
    ASSERT_TRUE(solved.done());
    tip[elongation ? 1 : 0] = solved.tip();
    EXPECT_GT(std::abs(solved.end().rods[0].q[0]), 0.5);  // [1/m] torsion
  }
  EXPECT_LT((tip[0] - tip[1]).norm(), 5e-4);
}

// No strain of a straight rod that cannot stretch answers what holds its far end along it; bent ones do, a little: to
// hold them to the last digit would lock the rod by forces of any size.
TEST(Redundancy, a_rod_held_at_both_ends_bends_as_one_that_can_stretch) {
  for (const bool turns : {false, true}) {
    SCOPED_TRACE(turns);
    double sag[2];
    for (const bool elongation : {false, true}) {
      Scene scene = straight_rod(0.2, 4, Circle{0.005}, elongation ? kExtensible : kBending, 1, 20);
      scene.rods[0].second.material = {1e6, 0.5, 1100.0};
      add_tie(scene, {true, true, true}, {turns, turns, turns});
      add_load(scene, Vec3(0.0, 0.0, 0.05), Vec3::Zero(), 0.1);
      const Solved solved = solve(scene);
      ASSERT_TRUE(solved.done());
      sag[elongation ? 1 : 0] = solved.at(0.1).z();
      const Warning* gave = find_warning(solved.trace.reports.back().warnings, "constraints_give_way");
      ASSERT_EQ(gave != nullptr, !elongation);
      if (gave) EXPECT_NEAR(gave->value, 0.2 - solved.tip().x(), 1e-9);
    }
    EXPECT_GT(sag[1], 3e-3);
    EXPECT_NEAR(sag[0], sag[1], 0.03 * sag[1]);
  }
}

/// Its tip is to go there in a second.
void bring_tip(Scene& scene, const Vec3& there) {
  Output tip;
  tip.rod = "rod";
  tip.at = 0.2;
  scene.outputs.emplace_back("tip", tip);
  Target target;
  target.output = "tip";
  target.at = Track{{0.0, 1.0}, {Vec3(0.2, 0.0, 0.0), there}};
  scene.targets.push_back(target);
}

// One tendon is told its length, the other one's is sought: it must be the opposite one, from the first step on.
TEST(Redundancy, a_sought_length_agrees_with_one_that_is_told) {
  Scene scene = tendon_robot(2, false, Analysis::quasi_static);
  scene.time = {0.05, 1.0};
  Actuator& sought = scene.actuators[0].second;
  sought.drive = Sought{};
  sought.limits.displacement = Span{-0.01, 0.01};
  sought.limits.force = Span{-5.0, 20.0};
  std::get<Table>(scene.actuators[1].second.drive).values = {0.0, -0.004};
  bring_tip(scene, Vec3(0.17, 0.0, 0.08));
  const Solved solved = solve(scene);
  ASSERT_TRUE(solved.done());
  EXPECT_NEAR(motor_positions(solved.model, solved.end())[0], 0.004, 1e-8);
  EXPECT_LT(std::abs(solved.end().actuators[0]), 5.0);
  EXPECT_EQ(find_warning(solved.model.warnings, "contradicting_commands"), nullptr);
}

// A sought tendon at a right angle to a pair that is told has no part in what these agree on, but by rounding.
TEST(Redundancy, a_sought_length_beside_a_pair_that_is_told_is_left_alone) {
  Scene scene = tendon_robot(2, false, Analysis::quasi_static);
  scene.time = {0.05, 1.0};
  std::get<Table>(scene.actuators[0].second.drive).values = {0.0, 0.004};
  std::get<Table>(scene.actuators[1].second.drive).values = {0.0, -0.004};
  Actuator sought;
  sought.rod = "rod";
  sought.tendon = Tendon{0.0, {}, 0.006, 0.5 * pi};
  sought.drive = Sought{};
  sought.limits.displacement = Span{-0.01, 0.01};
  sought.limits.force = Span{-5.0, 20.0};
  scene.actuators.emplace_back("t2", sought);
  bring_tip(scene, Vec3(0.18, 0.04, 0.06));
  const Solved solved = solve(scene);
  ASSERT_TRUE(solved.done());
  EXPECT_LT(std::abs(motor_positions(solved.model, solved.end())[2]), 0.0101);
  EXPECT_LT(std::abs(solved.end().actuators[2]), 5.1);
  EXPECT_LT(std::abs(solved.end().actuators[0] + solved.end().actuators[1]), 0.1);
}

TEST(Redundancy, one_linearisation_a_step_takes_the_smallest_forces_too) {
  Scene scene = tendon_robot(4, false, Analysis::dynamic);
  scene.newton.iterations = 1;
  const Solved solved = solve(scene);
  const Eigen::VectorXd tensions = Eigen::Map<const Eigen::VectorXd>(solved.end().actuators.data(), 4);
  EXPECT_LT((tensions - smallest_tensions(solved)).cwiseAbs().maxCoeff(), 1e-5 * tensions.cwiseAbs().maxCoeff());
  std::get<Table>(scene.actuators[2].second.drive).values = {0.0, 0.001};
  EXPECT_EQ(run_all(build(scene, read_block)).failure.status, Status::inconsistent);
}

TEST(Redundancy, what_is_not_redundant_is_left_alone) {
  for (const Scene& scene : {cable_block(), straight_rod(0.2, 4, given({1, 1, 1, 1, 1, 1}))}) {
    const Model model = build(scene, read_block);
    EXPECT_TRUE(model.redundant.empty());
    EXPECT_EQ(find_warning(model.warnings, "redundant_constraints"), nullptr);
  }
}

}  // namespace
}  // namespace sinew::test
