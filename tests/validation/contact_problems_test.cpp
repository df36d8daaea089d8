// The solver of Signorini's and Coulomb's laws on the problems that steps of many scenes pose.
#include "support/contact_problems.hpp"

#include <gtest/gtest.h>

namespace sinew {
namespace {

// Boxes side by side that overlap by half a millimetre when the run begins: what moves them apart adds energy, and the
// step is not refused for it.
TEST(ContactProblems, OverlapsAtTheStartAreMovedApartInWholeSteps) {
  Scene scene = test::pile(2, 1, 1, 0.5);
  scene.bodies[1].second.pose.translate = scene.bodies[0].second.pose.translate + Vec3(39.5 * test::mm, 0, 0);
  const Model model = build(scene, test::slab_or_cube);
  Workspace workspace(model);
  State state = initial_state(model);
  const StepReport report = advance(model, workspace, state);
  ASSERT_EQ(report.status, Status::converged) << report.detail;
  EXPECT_EQ(report.halvings, 0);
  EXPECT_GT(state.bodies[1].p.x() - state.bodies[0].p.x(), 39.9 * test::mm);
}

TEST(ContactProblems, AreSolvedAndNoneWorseThanBySweeps_slow) {
  const std::vector<test::ContactProblem> all = test::contact_problems();
  EXPECT_GE(all.size(), 200U);
  int solved = 0, largest = 0;
  solve::Coulomb solver;
  for (const test::ContactProblem& own : all) {
    Eigen::VectorXd lambda = Eigen::VectorXd::Zero(own.problem.b.size());
    const solve::CoulombReport report = solver.solve(own.problem, 1e-8, lambda);
    const double left = solve::residual(own.problem, lambda).largest();
    EXPECT_EQ(report.solved, left <= 1e-8) << own.scene;
    EXPECT_EQ(report.residual.largest(), left) << own.scene;
    largest = std::max(largest, own.problem.contacts());
    if (report.solved) {
      ++solved;
      continue;
    }
    Eigen::VectorXd plain;
    test::plain_sweeps(own.problem, 1e-8, 1000, plain);
    EXPECT_LE(left, solve::residual(own.problem, plain).largest()) << own.scene;
  }
  EXPECT_GE(largest, 450);
  EXPECT_GE(solved, 0.95 * static_cast<double>(all.size()));
}

}  // namespace
}  // namespace sinew
