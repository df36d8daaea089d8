#include "sinew/linalg/symmetric_factor.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <numeric>
#include <vector>

namespace sinew::linalg {
namespace {

std::vector<int> backwards(int n) {
  std::vector<int> order(static_cast<std::size_t>(n));
  std::iota(order.rbegin(), order.rend(), 0);
  return order;
}

TEST(SymmetricFactor, SolvesSaddlePointsWithTheDefiniteBlockFirst) {
  for (const int n : {1, 2, 9, 40}) {  // rows on top of the unknowns they hold: their pivots come last
    const int rows = n / 3;
    const Eigen::MatrixXd B = Eigen::MatrixXd::Random(n, n), G = Eigen::MatrixXd::Random(rows, n);
    Eigen::MatrixXd A = Eigen::MatrixXd::Zero(n + rows, n + rows);
    A.bottomRightCorner(n, n) = B * B.transpose() + Eigen::MatrixXd::Identity(n, n);
    A.topRightCorner(rows, n) = G;
    A.bottomLeftCorner(n, rows) = G.transpose();
    SymmetricFactor factor;
    ASSERT_TRUE(factor.factor(A, backwards(n + rows)));
    const Eigen::VectorXd b = Eigen::VectorXd::Random(n + rows);
    EXPECT_LT((A * factor.solve(b) - b).norm(), 1e-11 * b.norm()) << n;
    EXPECT_EQ(factor.negative(), rows);
  }
}

TEST(SymmetricFactor, RefusesWhatIsSingularInItsOrder) {
  Eigen::Matrix2d A;
  A << 0.0, 1.0, 1.0, 0.0;
  SymmetricFactor factor;
  EXPECT_FALSE(factor.factor(A, std::vector<int>{0, 1}));
  A(1, 1) = 1.0;
  EXPECT_FALSE(factor.factor(A, std::vector<int>{0, 1}));
  EXPECT_TRUE(factor.factor(A, std::vector<int>{1, 0}));
  A << 1.0, 1.0, 1.0, 1.0 + 1e-15;
  EXPECT_FALSE(factor.factor(A, std::vector<int>{0, 1}));
}

}  // namespace
}  // namespace sinew::linalg
