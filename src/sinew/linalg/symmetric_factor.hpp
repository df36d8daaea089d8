// Factorisation of dense symmetric matrices, A = P S P^T, P triangular and S signs.
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "sinew/linalg/aligned.hpp"
#include "sinew/linalg/kernels.hpp"

namespace sinew::linalg {

/// Half the work of an LU, and the signs are those of the eigenvalues. Pivots are taken as they come, so their order
/// must suit the matrix: of a saddle point its definite block first, say. Memory is kept from one matrix to the next.
class SymmetricFactor {
 public:
  explicit SymmetricFactor(const Kernels& kernels = linalg::kernels()) : kernels_(&kernels) {}

  /// Begins a matrix of n unknowns, all zero.
  void start(int n);
  /// Its column j, to be filled from the diagonal down.
  double* column(int j) { return panel_.data() + static_cast<std::ptrdiff_t>(j) * stride_; }
  int size() const { return size_; }

  /// `begin`: per row its first column that is not zero; what stands before it costs nothing. `least`: a pivot smaller
  /// than the size of this number is replaced by it; A is then another matrix, close by, and solutions want refinement.
  /// False where a pivot is zero or not finite; solves are then meaningless.
  bool factor(std::span<const int> begin, std::span<const double> least);
  /// b <- A^-1 b. Takes room for whole lanes of the size and one more (kernels.hpp).
  void solve(double* b) const;
  std::size_t room() const { return static_cast<std::size_t>(stride_) + kLanes; }
  double pivot(int j) const { return pivots_[static_cast<std::size_t>(j)]; }
  /// How many eigenvalues are negative (Sylvester).
  int negative() const;

 private:
  const Kernels* kernels_;
  AlignedVector<double> panel_;
  std::vector<int> begin_;
  std::vector<double> pivots_, signs_;
  int size_ = 0, stride_ = 0;
};

}  // namespace sinew::linalg
