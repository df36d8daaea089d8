// Factorisation of the sparse, symmetric positive definite matrices of volumes, A = P^T L L^T P.
#pragma once

#include <Eigen/SparseCholesky>
#include <Eigen/SparseCore>

namespace sinew::linalg {

/// The pattern is analysed once (fill-reducing ordering), values are factored every time.
class SparseCholesky {
 public:
  using Matrix = Eigen::SparseMatrix<double>;  ///< lower triangle, compressed columns

  void analyze(const Matrix& pattern) { llt_.analyzePattern(pattern); }
  /// False if the matrix is not positive definite (or not finite); solves are then meaningless.
  bool factor(const Matrix& A);
  /// L^-1 P B: with X = half_solve(B), B^T A^-1 B = X^T X, symmetric to the last bit.
  Eigen::MatrixXd half_solve(const Eigen::MatrixXd& B) const;
  /// P^T L^-T y: the second half, A^-1 b = back_solve(half_solve(b)).
  Eigen::VectorXd back_solve(const Eigen::VectorXd& y) const;

 private:
  Eigen::SimplicialLLT<Matrix, Eigen::Lower, Eigen::AMDOrdering<int>> llt_;
};

}  // namespace sinew::linalg
