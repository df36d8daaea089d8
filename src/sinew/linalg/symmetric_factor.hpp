// Factorisation of dense symmetric matrices, A = P S P^T, P triangular and S signs.
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "sinew/linalg/kernels.hpp"

namespace sinew::linalg {

/// Half the work of an LU, and the signs are those of the eigenvalues. Pivots are taken in a given order, which must
/// suit the matrix: a saddle point's definite blocks first, say.
class SymmetricFactor {
 public:
  explicit SymmetricFactor(const Kernels& kernels = linalg::kernels()) : kernels_(&kernels) {}

  /// `order`: a permutation, first pivot first. False where a pivot is zero, not finite, or smaller than `vanished`
  /// times the largest; solves are then meaningless.
  bool factor(const Eigen::MatrixXd& A, std::span<const int> order, double vanished = 1e-14);
  /// A^-1 b.
  Eigen::VectorXd solve(const Eigen::VectorXd& b) const;
  /// How many eigenvalues are negative (Sylvester).
  int negative() const;

 private:
  const Kernels* kernels_;
  std::vector<int> order_;
  std::vector<double> panel_;
  Eigen::VectorXd pivots_, signs_;
  int stride_ = 0;
};

}  // namespace sinew::linalg
