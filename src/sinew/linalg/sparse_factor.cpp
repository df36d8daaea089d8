#include "sinew/linalg/sparse_factor.hpp"

namespace sinew::linalg {

namespace {

/// Pivots below this part of the largest entry of the diagonal: nothing is left of them but rounding.
constexpr double kVanished = 1e-13;

}  // namespace

bool SparseFactor::factor(const Matrix& A) {
  if (A.rows() == 0) return true;
  if (!Eigen::Map<const Eigen::VectorXd>(A.valuePtr(), A.nonZeros()).allFinite()) return false;
  ldlt_.factorize(A);
  if (ldlt_.info() != Eigen::Success) return false;
  const Eigen::VectorXd D = ldlt_.vectorD();
  const double largest = A.diagonal().cwiseAbs().maxCoeff();
  if (!D.allFinite() || !(D.cwiseAbs().minCoeff() > kVanished * largest)) return false;
  signs_ = D.cwiseSign();
  root_ = D.cwiseAbs().cwiseSqrt().cwiseInverse();
  negative_ = static_cast<int>((D.array() < 0.0).count());
  return true;
}

Eigen::MatrixXd SparseFactor::half_solve(const Eigen::MatrixXd& B) const {
  if (B.rows() == 0) return B;
  Eigen::MatrixXd X = ldlt_.permutationP() * B;
  ldlt_.matrixL().solveInPlace(X);
  return root_.asDiagonal() * X;
}

Eigen::VectorXd SparseFactor::back_solve(const Eigen::VectorXd& y) const {
  if (y.size() == 0) return y;
  Eigen::VectorXd x = root_.cwiseProduct(signs_).cwiseProduct(y);
  ldlt_.matrixU().solveInPlace(x);
  return ldlt_.permutationPinv() * x;
}

}  // namespace sinew::linalg
