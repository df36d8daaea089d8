#include "sinew/linalg/symmetric_factor.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <vector>

namespace sinew::linalg {
namespace {

/// Fills a factor with a matrix and factors it; where its rows begin is found from their zeros.
bool factored(SymmetricFactor& factor, const Eigen::MatrixXd& A, const Eigen::VectorXd& least) {
  const auto n = static_cast<int>(A.rows());
  factor.start(n);
  std::vector<int> begin;
  for (int i = 0; i < n; ++i) {
    int first = 0;
    while (first < i && A(i, first) == 0.0) ++first;
    begin.push_back(first);
    for (int j = first; j <= i; ++j) factor.column(j)[i] = A(i, j);
  }
  return factor.factor(begin, {least.data(), static_cast<std::size_t>(n)});
}

bool factored(SymmetricFactor& factor, const Eigen::MatrixXd& A) {
  return factored(factor, A, Eigen::VectorXd::Zero(A.rows()));
}

Eigen::VectorXd solved(const SymmetricFactor& factor, const Eigen::VectorXd& b) {
  std::vector<double> x(factor.room());
  std::copy(b.begin(), b.end(), x.begin());
  factor.solve(x.data());
  return Eigen::Map<const Eigen::VectorXd>(x.data(), b.size());
}

/// Some rows of unknowns, then rows that hold them.
Eigen::MatrixXd saddle(int n, int rows) {
  const Eigen::MatrixXd B = Eigen::MatrixXd::Random(n, n), G = Eigen::MatrixXd::Random(rows, n);
  Eigen::MatrixXd A = Eigen::MatrixXd::Zero(n + rows, n + rows);
  A.topLeftCorner(n, n) = B * B.transpose() + Eigen::MatrixXd::Identity(n, n);
  A.bottomLeftCorner(rows, n) = G;
  A.topRightCorner(n, rows) = G.transpose();
  return A;
}

TEST(SymmetricFactor, SolvesSaddlePointsWithTheDefiniteBlockFirst) {
  SymmetricFactor factor;  // one for all: nothing of the larger ones is left in the smaller
  for (const int n : {40, 1, 2, 9, 200, 30}) {
    const int rows = n / 3;
    const Eigen::MatrixXd A = saddle(n, rows);
    ASSERT_TRUE(factored(factor, A));
    const Eigen::VectorXd b = Eigen::VectorXd::Random(n + rows);
    EXPECT_LT((A * solved(factor, b) - b).norm(), 1e-11 * b.norm()) << n;
    EXPECT_EQ(factor.negative(), rows);
  }
}

TEST(SymmetricFactor, RowsThatBeginLateCostNothingAndChangeNothing) {
  // Three bodies in a row, each with rows of its own: most of what is below the diagonal is zero.
  for (const int n : {5, 17, 64}) {
    const int rows = n / 2, size = n + rows;
    Eigen::MatrixXd A = Eigen::MatrixXd::Zero(3 * size, 3 * size);
    for (int k = 0; k < 3; ++k) A.block(k * size, k * size, size, size) = saddle(n, rows);
    A(2 * size, size - 1) = A(size - 1, 2 * size) = 0.5;
    for (const char* name : {"portable", "avx2", "avx512"}) {
      if (!kernels(name)) continue;
      SymmetricFactor factor(*kernels(name));
      ASSERT_TRUE(factored(factor, A));
      const Eigen::VectorXd b = Eigen::VectorXd::Random(3 * size);
      EXPECT_LT((A * solved(factor, b) - b).norm(), 1e-11 * b.norm()) << name << " " << n;
    }
  }
}

TEST(SymmetricFactor, RefusesWhatIsSingularInItsOrder) {
  Eigen::Matrix2d A;
  A << 0.0, 1.0, 1.0, 0.0;
  SymmetricFactor factor;
  EXPECT_FALSE(factored(factor, A));
  A(1, 1) = 1.0;
  EXPECT_FALSE(factored(factor, A));
  A << 1.0, 1.0, 1.0, 1.0;
  EXPECT_FALSE(factored(factor, A));
  A(1, 1) = std::nan("");
  EXPECT_FALSE(factored(factor, A));
}

TEST(SymmetricFactor, PivotsThatVanishAreReplacedAndTheSolutionIsClose) {
  // A row that nothing gives way to, and the unknown that it holds.
  Eigen::Matrix3d A;
  A << -2.0, 0.0, 1.0, 0.0, 0.0, 1.0, 1.0, 1.0, 3.0;
  SymmetricFactor factor;
  ASSERT_TRUE(factored(factor, A, Eigen::Vector3d(-1e-8, -1e-8, 0.0)));
  EXPECT_EQ(factor.negative(), 2);
  const Eigen::Vector3d b(1.0, 2.0, 3.0), exact = A.partialPivLu().solve(b);
  EXPECT_LT((solved(factor, b) - exact).norm(), 1e-6 * exact.norm());
  EXPECT_GT((solved(factor, b) - exact).norm(), 0.0);
}

}  // namespace
}  // namespace sinew::linalg
