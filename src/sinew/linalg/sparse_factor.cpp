#include "sinew/linalg/sparse_factor.hpp"

#include <metis.h>

#include <Eigen/OrderingMethods>
#include <cmath>
#include <vector>

namespace sinew::linalg {

namespace {

/// Below this part of what is rounded nothing is left but rounding.
constexpr double kVanished = 1e-13;

/// Of size zero where METIS finds none.
LeastFill::PermutationType nested_dissection(const Eigen::SparseMatrix<double>& full) {
  std::vector<idx_t> first = {0}, neighbours;  // in the graph of the pattern, without the diagonal
  for (Eigen::Index j = 0; j < full.cols(); ++j) {
    for (Eigen::SparseMatrix<double>::InnerIterator at(full, j); at; ++at) {
      if (at.row() != j) neighbours.push_back(static_cast<idx_t>(at.row()));
    }
    first.push_back(static_cast<idx_t>(neighbours.size()));
  }
  auto n = static_cast<idx_t>(full.cols());
  LeastFill::PermutationType inverse(n);
  std::vector<idx_t> place(full.cols());
  const int status =
      METIS_NodeND(&n, first.data(), neighbours.data(), nullptr, nullptr, inverse.indices().data(), place.data());
  return status == METIS_OK ? inverse : LeastFill::PermutationType(0);
}

/// Entries of L after an ordering, by the symbolic half of a factorisation.
Eigen::Index fill(const Eigen::SparseMatrix<double>& full, const LeastFill::PermutationType& inverse) {
  struct : Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>, Eigen::Lower, Eigen::NaturalOrdering<int>> {
    Eigen::Index entries() const { return m_matrix.nonZeros(); }
  } symbolic;
  Eigen::SparseMatrix<double> ordered;
  ordered.selfadjointView<Eigen::Lower>() = full.selfadjointView<Eigen::Lower>().twistedBy(inverse.inverse());
  symbolic.analyzePattern(ordered);
  return symbolic.entries();
}

}  // namespace

void LeastFill::operator()(const Eigen::SparseMatrix<double>& full, PermutationType& inverse) const {
  Eigen::AMDOrdering<int>()(full, inverse);
  const PermutationType dissected = nested_dissection(full);
  if (dissected.size() > 0 && fill(full, dissected) < fill(full, inverse)) inverse = dissected;
}

bool SparseFactor::factor(const Matrix& A) {
  if (A.rows() == 0) return true;
  if (!Eigen::Map<const Eigen::VectorXd>(A.valuePtr(), A.nonZeros()).allFinite()) return false;
  ldlt_.factorize(A);
  if (ldlt_.info() != Eigen::Success) return false;
  const Eigen::VectorXd D = ldlt_.vectorD();
  const double smallest = D.cwiseAbs().minCoeff();
  if (!D.allFinite() || !(smallest > 0.0)) return false;
  signs_ = D.cwiseSign();
  root_ = D.cwiseAbs().cwiseSqrt().cwiseInverse();
  negative_ = static_cast<int>((D.array() < 0.0).count());
  const Eigen::VectorXd diagonal = A.diagonal().cwiseAbs();
  return smallest > kVanished * diagonal.maxCoeff() || scaled_condition(diagonal) * kVanished < 1.0;
}

/// Largest eigenvalue of Delta^(1/2) A^-1 Delta^(1/2), Delta the diagonal: how much of a solution is rounding, which
/// goes with Delta. A slender body beside a stiff spring has pivots that are small beside the spring, and is well;
/// where a stiff and a soft part float together, what is left of the soft pivots is the rounding of the stiff ones.
double SparseFactor::scaled_condition(const Eigen::VectorXd& diagonal) const {
  const Eigen::VectorXd scale = diagonal.cwiseSqrt();
  Eigen::VectorXd y = Eigen::VectorXd::NullaryExpr(
      diagonal.size(), [](Eigen::Index i) { return std::sin(1.0 + 0.7 * static_cast<double>(i)); });
  double growth = 1.0;
  for (int i = 0; i < 3; ++i) {  // inverse iteration: the first turn finds the direction but for the square root of n
    y = scale.cwiseProduct(back_solve(half_solve(scale.cwiseProduct(y / y.norm()))));
    growth = y.norm();
  }
  return growth;
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
