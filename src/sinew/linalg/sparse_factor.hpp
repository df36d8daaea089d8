// Factorisation of the sparse symmetric matrices of volumes, P A P^T = L D L^T, D a diagonal of either sign.
#pragma once

#include <Eigen/Core>
#include <Eigen/SparseCore>
#include <memory>
#include <vector>

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
class SparseFactor {
 public:
  using Matrix = Eigen::SparseMatrix<double>;  ///< lower triangle, compressed columns
  using Rows = Eigen::SparseMatrix<double, Eigen::RowMajor>;

  /// The unknowns of a border row must all meet each other in A; throws std::invalid_argument where they do not.
  static std::shared_ptr<const Fronts> make_plan(const Matrix& pattern, const Rows& border = {},
                                                 std::span<const int> slots = {});

  explicit SparseFactor(std::shared_ptr<const Fronts> plan, const Kernels& kernels = linalg::kernels());

  /// The numbers of A are added between `clear` and `factor`, each at its Fronts::entry; those of H are set, row by
  /// row.
  const Fronts& plan() const { return *plan_; }
  void clear();
  double* values() { return values_.data(); }
  double* border_values() { return border_values_.data(); }
  /// A as it has been put together.
  Matrix assembled() const;
  /// False if rounding is all that is left of a pivot, or it is not finite; solves are then meaningless.
  /// The result is the same to the last bit, whatever the crew.
  bool factor(threads::Crew& crew = threads::Crew::none());
  /// All of it, for matrices of the plan's patterns.
  bool factor(const Matrix& A, const Rows& border = {}, threads::Crew& crew = threads::Crew::none());

  int size() const { return static_cast<int>(plan_->place.size()); }
  int borders() const { return static_cast<int>(plan_->border.size()); }
  /// Largest entry of A's diagonal, its size.
  double largest_diagonal() const { return diagonal_.size() > 0 ? diagonal_.maxCoeff() : 0.0; }
  /// How many eigenvalues are negative (Sylvester).
  int negative() const { return negative_; }
  /// Numbers kept of L below its diagonal, zeros between merged columns included.
  std::size_t entries() const { return plan_->entries(); }
  /// S, as a vector.
  const Eigen::VectorXd& signs() const { return signs_; }
  /// y = R b: with X made of such columns, B^T A^-1 B = X^T S X.
  void half_solve(const Eigen::Ref<const Eigen::VectorXd>& b, Eigen::Ref<Eigen::VectorXd> y) const;
  /// x = R^T S y: the second half of A^-1 b.
  void back_solve(const Eigen::Ref<const Eigen::VectorXd>& y, Eigen::Ref<Eigen::VectorXd> x) const;
  /// x = A^-1 b.
  Eigen::VectorXd solve(const Eigen::Ref<const Eigen::VectorXd>& b) const;

  /// W = H A^-1 H^T, in the order of the rows.
  void compliance(Eigen::MatrixXd& W) const;
  /// u = H R^T S y: H A^-1 b for y = R b.
  void border_times(const Eigen::Ref<const Eigen::VectorXd>& y, Eigen::Ref<Eigen::VectorXd> u) const;
  /// y += R H^T u.
  void add_border_transposed(const Eigen::Ref<const Eigen::VectorXd>& u, Eigen::Ref<Eigen::VectorXd> y) const;

 private:
  bool factor_fronts(threads::Crew& crew);
  void start_panel(const Front& front);
  bool factor_front(const Front& front, double* room, threads::Crew& crew);
  double* update_of(const Front& front, double* room) {
    return (front.in_part ? room : updates_.data()) + front.update;
  }
  void add_children(const Front& front, double* room, bool to_panel, threads::Crew& crew);
  void update(threads::Crew& crew, double* C, int C_stride, const double* A, int A_stride, int height, int columns,
              int depth, const double* signs, bool fresh);
  double scaled_condition() const;

  std::shared_ptr<const Fronts> plan_;
  const Kernels* kernels_;
  std::vector<double> values_, border_values_, panels_, updates_;
  std::vector<std::vector<double>> rooms_;  ///< of parts that are done at one time
  Eigen::VectorXd diagonal_;                ///< of A, its size
  Eigen::VectorXd pivots_, signs_;
  Eigen::MatrixXd minus_W_;  ///< -H A^-1 H^T below its diagonal, in the order of the plan
  std::size_t largest_ = 0;  ///< [doubles] that hold any front's unknowns
  int negative_ = 0;
  mutable Eigen::VectorXd own_, below_, whole_, bordering_;  ///< room for solves: one thread at a time
};

}  // namespace sinew::linalg
