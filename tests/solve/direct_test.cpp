#include "sinew/solve/direct.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>

namespace sinew::solve {
namespace {

Eigen::MatrixXd waves(int rows, int columns, double phase) {
  return Eigen::MatrixXd::NullaryExpr(rows, columns, [phase](Eigen::Index i, Eigen::Index j) {
    return std::sin(phase + 1.7 * static_cast<double>(i * i) + 2.3 * static_cast<double>(j) +
                    static_cast<double>(i * j));
  });
}

CoupledProblem problem(int nz, int rows) {
  const Eigen::MatrixXd b = waves(nz, nz, 0.1), w = waves(rows, rows, 0.7);
  CoupledProblem p;
  p.B = 1e-4 * (b * b.transpose() + Eigen::MatrixXd::Identity(nz, nz));  // as a thin rod: small
  p.W = 1e-3 * (w * w.transpose() + 0.1 * Eigen::MatrixXd::Identity(rows, rows));
  p.G = waves(rows, nz, 0.3);
  p.r = waves(nz, 1, 0.5);
  p.c = 1e-2 * waves(rows, 1, 0.9);
  return p;
}

TEST(Direct, agrees_with_eliminating_the_rods_first_as_the_paper_does) {
  const CoupledProblem p = problem(7, 5);
  const CoupledSolution solution = solve_direct(p);
  ASSERT_TRUE(solution.ok);
  EXPECT_FALSE(solution.redundant);
  const Eigen::MatrixXd Binv = p.B.inverse();
  const Eigen::MatrixXd W = p.W + p.G * Binv * p.G.transpose();              // (11)
  const Eigen::VectorXd lambda = -W.ldlt().solve(p.c + p.G * (Binv * p.r));  // (12)
  EXPECT_LT((solution.dlambda - lambda).norm(), 1e-10 * lambda.norm());
  EXPECT_LT((solution.dz + Binv * (p.r + p.G.transpose() * lambda)).norm(), 1e-9 * solution.dz.norm());
}

TEST(Direct, needs_no_inverse_of_the_rods_matrix) {
  CoupledProblem p = problem(4, 6);
  p.B.row(2).setZero();
  p.B.col(2).setZero();  // the abscissa of a point on a straight cable
  const CoupledSolution solution = solve_direct(p);
  ASSERT_TRUE(solution.ok);
  EXPECT_LT((p.B * solution.dz + p.G.transpose() * solution.dlambda + p.r).norm(), 1e-11);
  EXPECT_LT((p.G * solution.dz - p.W * solution.dlambda - p.c).norm(), 1e-11);
}

TEST(Direct, repeated_rows_that_agree_are_survived) {
  CoupledProblem p = problem(7, 3);
  p.W.setZero();
  p.G.row(2) = p.G.row(1);
  p.c[2] = p.c[1];
  const CoupledSolution solution = solve_direct(p);
  ASSERT_TRUE(solution.ok);
  EXPECT_TRUE(solution.redundant);
  EXPECT_LT((p.G * solution.dz - p.c).norm(), 1e-9);
  EXPECT_NEAR(solution.dlambda[1], solution.dlambda[2], 1e-7 * solution.dlambda.norm());  // the load is shared
}

TEST(Direct, contradicting_rows_are_refused) {
  CoupledProblem p = problem(7, 3);
  p.W.setZero();
  p.G.row(2) = p.G.row(1);
  p.c[2] = p.c[1] + 1.0;
  EXPECT_FALSE(solve_direct(p).ok);
}

TEST(Direct, numbers_that_are_not_finite_are_refused) {
  CoupledProblem p = problem(3, 2);
  p.B(1, 1) = std::nan("");
  EXPECT_FALSE(solve_direct(p).ok);
}

TEST(Direct, nothing_to_solve_is_fine) { EXPECT_TRUE(solve_direct(problem(0, 0)).ok); }

}  // namespace
}  // namespace sinew::solve
