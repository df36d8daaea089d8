// Factorisation of the sparse symmetric matrices of volumes, P A P^T = L D L^T, D a diagonal of either sign.
#pragma once

#include <Eigen/SparseCholesky>
#include <Eigen/SparseCore>

namespace sinew::linalg {

/// Orders the unknowns so that little fills in: by approximate minimum degree or by nested dissection (METIS),
/// whichever leaves fewer entries in L. An ordering as Eigen's factorisations want it.
struct LeastFill {
  using PermutationType = Eigen::PermutationMatrix<Eigen::Dynamic, Eigen::Dynamic, int>;
  /// `full`: both triangles. P^-1.
  void operator()(const Eigen::SparseMatrix<double>& full, PermutationType& inverse) const;
};

/// The pattern is analysed once (fill-reducing ordering), values are factored every time. Pivots are taken in the order
/// of the pattern, also of indefinite matrices: good as long as none comes near zero, which `factor` judges.
///
/// With R = |D|^(-1/2) L^-1 P and S the signs of D, A^-1 = R^T S R.
class SparseFactor {
 public:
  using Matrix = Eigen::SparseMatrix<double>;  ///< lower triangle, compressed columns

  void analyze(const Matrix& pattern) { ldlt_.analyzePattern(pattern); }
  /// False if rounding is all that is left of a pivot, or it is not finite; solves are then meaningless.
  bool factor(const Matrix& A);
  /// How many eigenvalues are negative (Sylvester).
  int negative() const { return negative_; }
  /// Entries of L below its diagonal, after `factor`.
  Eigen::Index entries() const { return ldlt_.matrixL().nestedExpression().nonZeros(); }
  /// S, as a vector.
  const Eigen::VectorXd& signs() const { return signs_; }
  /// R B: with X = half_solve(B), B^T A^-1 B = X^T S X.
  Eigen::MatrixXd half_solve(const Eigen::MatrixXd& B) const;
  /// R^T S y: the second half, A^-1 b = back_solve(half_solve(b)).
  Eigen::VectorXd back_solve(const Eigen::VectorXd& y) const;

 private:
  double scaled_condition(const Eigen::VectorXd& diagonal) const;

  Eigen::SimplicialLDLT<Matrix, Eigen::Lower, LeastFill> ldlt_;
  Eigen::VectorXd signs_, root_;  ///< root_ = |D|^(-1/2)
  int negative_ = 0;
};

}  // namespace sinew::linalg
