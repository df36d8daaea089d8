// The solver of Signorini's and Coulomb's laws on the problems that steps of many scenes pose.
#include "support/contact_problems.hpp"

#include <gtest/gtest.h>

namespace sinew {
namespace {

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
