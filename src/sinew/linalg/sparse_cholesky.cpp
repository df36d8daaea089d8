#include "sinew/linalg/sparse_cholesky.hpp"

namespace sinew::linalg {

bool SparseCholesky::factor(const Matrix& A) {
  if (!Eigen::Map<const Eigen::VectorXd>(A.valuePtr(), A.nonZeros()).allFinite()) return false;
  llt_.factorize(A);
  return llt_.info() == Eigen::Success;
}

Eigen::MatrixXd SparseCholesky::half_solve(const Eigen::MatrixXd& B) const {
  Eigen::MatrixXd X = llt_.permutationP() * B;
  llt_.matrixL().solveInPlace(X);
  return X;
}

Eigen::VectorXd SparseCholesky::back_solve(const Eigen::VectorXd& y) const {
  Eigen::VectorXd x = y;
  llt_.matrixU().solveInPlace(x);
  return llt_.permutationPinv() * x;
}

}  // namespace sinew::linalg
