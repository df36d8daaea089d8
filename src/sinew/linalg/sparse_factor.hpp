// Factorisation of the sparse symmetric matrices of volumes, P A P^T = L D L^T, D a diagonal of either sign.
#pragma once

#include <Eigen/Core>
#include <Eigen/SparseCore>
#include <memory>
#include <span>
#include <variant>
#include <vector>

#include "sinew/linalg/front_panels.hpp"
#include "sinew/linalg/fronts.hpp"
#include "sinew/linalg/kernels.hpp"
#include "sinew/threads/crew.hpp"

namespace sinew::linalg {

/// A plan is made once for a pattern (order of elimination, fronts, all memory), values are factored every time. Pivots
/// are taken in the order of the pattern, also of indefinite matrices: good as long as none comes near zero, which
/// `factor` judges.
///
/// With R = |D|^(-1/2) L^-1 P and S the signs of D, A^-1 = R^T S R. Vectors R b are in the order of elimination.
/// Border rows H beside A, few and sparse, are eliminated with it: their columns R H^T are nonzero only on the way from
/// their unknowns to the root of the elimination tree, and only there they cost anything.
///
/// In single precision the factor takes half the room and about half the time; what is solved with it, and W, is then
/// good to some 1e-7 of A's condition, and wants refinement: `subtract_product` is exact.
class SparseFactor {
 public:
  using Matrix = Eigen::SparseMatrix<double>;  ///< lower triangle, compressed columns
  using Rows = Eigen::SparseMatrix<double, Eigen::RowMajor>;

  /// Of compressed matrices. The unknowns of a border row must all meet each other in A; throws std::invalid_argument
  /// where they do not.
  static std::shared_ptr<const Fronts> make_plan(const Matrix& pattern, const Rows& border = {},
                                                 std::span<const int> slots = {},
                                                 Precision precision = Precision::float64);

  /// With the fastest kernels of the precision that the plan was made for.
  explicit SparseFactor(std::shared_ptr<const Fronts> plan);
  SparseFactor(std::shared_ptr<const Fronts> plan, const Kernels& kernels);
  SparseFactor(std::shared_ptr<const Fronts> plan, const KernelsOf<float>& kernels);

  /// The numbers of A are added between `clear` and `factor`, each at its Fronts::entry; those of H are set, row by
  /// row.
  const Fronts& plan() const { return *plan_; }
  void clear();
  double* values() { return values_.data(); }
  double* border_values() { return border_values_.data(); }
  /// A as it has been put together.
  Matrix assembled() const;
  /// False if rounding is all that is left of a pivot, or it is not finite; solves are then meaningless.
  /// The result is the same to the last bit, whatever the crew. What stands on the `right` is half solved on the way,
  /// as one more row.
  bool factor(threads::Crew& crew = threads::Crew::none(), const HalfSolve* right = nullptr);
  /// All of it, for matrices of the plan's patterns.
  bool factor(const Matrix& A, const Rows& border = {}, threads::Crew& crew = threads::Crew::none());

  int size() const { return static_cast<int>(plan_->place.size()); }
  int borders() const { return static_cast<int>(plan_->border.size()); }
  /// Largest entry of A's diagonal, its size.
  double largest_diagonal() const { return largest_diagonal_; }
  /// How many eigenvalues are negative (Sylvester).
  int negative() const { return negative_; }
  /// Numbers kept of L below its diagonal, zeros between merged columns included.
  std::size_t entries() const { return plan_->entries(); }
  /// S, as a vector.
  Eigen::VectorXd signs() const;
  /// r <- r - A x, with A as it has been put together.
  void subtract_product(const Eigen::Ref<const Eigen::VectorXd>& x, Eigen::Ref<Eigen::VectorXd> r) const;
  /// y = R b: with X made of such columns, B^T A^-1 B = X^T S X. Of a sparse b, costs little beside the fronts from its
  /// unknowns to the root.
  void half_solve(const Eigen::VectorXd& b, Eigen::VectorXd& y) const;
  /// And u = H A^-1 b.
  void half_solve(const Eigen::VectorXd& b, Eigen::VectorXd& y, Eigen::VectorXd& u) const;
  /// Where such y can differ from zero: places in the order of elimination, ascending, on the way from these unknowns
  /// to the root.
  std::vector<int> reach(std::span<const int> unknowns) const;
  /// x = R^T S y: the second half of A^-1 b.
  void back_solve(const Eigen::VectorXd& y, Eigen::VectorXd& x) const;
  /// That of A^-1 (b + H^T u).
  void back_solve(const Eigen::VectorXd& y, const Eigen::VectorXd& u, Eigen::VectorXd& x) const;
  /// x = A^-1 b.
  Eigen::VectorXd solve(const Eigen::VectorXd& b) const;

  /// W = H A^-1 H^T, in the order of the rows.
  Eigen::MatrixXd compliance() const;
  /// Some of its rows and columns: these runs of the order in which they are kept, Fronts::border, none twice, one
  /// after the other. Above the diagonal stands anything. And one column, whole, in the order in which they are kept.
  void kept_compliance(std::span<const Run> rows, Eigen::MatrixXd& W) const;
  void kept_column(int place, Eigen::VectorXd& column) const;
  /// u = H R^T S y: H A^-1 b for y = R b.
  void border_times(const Eigen::VectorXd& y, Eigen::VectorXd& u) const;
  /// y += R H^T u.
  void add_border_transposed(const Eigen::VectorXd& u, Eigen::VectorXd& y) const;

 private:
  using Panels = std::variant<FrontPanels<double>, FrontPanels<float>>;
  SparseFactor(std::shared_ptr<const Fronts> plan, Panels panels);
  /// Visits the entries of A on and below its diagonal, in the order of elimination, by their unknowns.
  template <class Visit>
  void each_entry(const Visit& visit) const;
  const Eigen::VectorXd& diagonal() const;
  double scaled_condition() const;

  std::shared_ptr<const Fronts> plan_;
  std::vector<int> unknown_;  ///< at each place
  AlignedVector<double> values_;
  std::vector<double> border_values_;
  Panels panels_;
  double largest_diagonal_ = 0.0;  ///< and the next, of the last matrix that could be factored
  int negative_ = 0;
};

}  // namespace sinew::linalg
