// The numbers of a factorisation by fronts, in double or in single precision.
#pragma once

#include <Eigen/Core>
#include <limits>
#include <memory>
#include <span>
#include <vector>

#include "sinew/linalg/aligned.hpp"
#include "sinew/linalg/fronts.hpp"
#include "sinew/linalg/kernels.hpp"
#include "sinew/threads/crew.hpp"

namespace sinew::linalg {

/// A right side b on its way through the first half of a solve: y = R b and, if wanted, u = H R^T S y = H A^-1 b.
struct HalfSolve {
  const Eigen::VectorXd& b;
  Eigen::VectorXd& y;
  Eigen::VectorXd* u = nullptr;
};

/// What SparseFactor does with each kind of number (float, double); all that is given and taken is double.
template <class Real>
class FrontPanels {
 public:
  /// Strides of a plan for double precision are too short for floats; throws std::invalid_argument.
  FrontPanels(std::shared_ptr<const Fronts> plan, const KernelsOf<Real>& kernels);

  /// `values`, `border_values`: as Fronts places them. False where a pivot is zero or not finite.
  /// `right` is half solved on the way.
  bool factor(const AlignedVector<double>& values, const std::vector<double>& border_values, threads::Crew& crew,
              const HalfSolve* right);
  static double rounding() { return static_cast<double>(std::numeric_limits<Real>::epsilon()); }
  /// How small they are, and how many are negative.
  struct Pivots {
    double smallest = 0.0;
    int negative = 0;
  };
  Pivots pivots() const;
  const Eigen::VectorXd& diagonal() const { return diagonal_; }  ///< of A, its size, in the order of elimination
  Eigen::VectorXd signs() const { return signs_.template cast<double>(); }

  void half_solve(const HalfSolve& right) const;
  void back_solve(const Eigen::VectorXd& y, const Eigen::VectorXd* u, Eigen::VectorXd& x) const;
  void kept_compliance(std::span<const Run> rows, Eigen::MatrixXd& W) const;
  void kept_column(int place, Eigen::VectorXd& column) const;
  void border_times(const Eigen::VectorXd& y, Eigen::VectorXd& u) const;
  void add_border_transposed(const Eigen::VectorXd& u, Eigen::VectorXd& y) const;

 private:
  using Vector = Eigen::Matrix<Real, Eigen::Dynamic, 1>;
  using Matrix = Eigen::Matrix<Real, Eigen::Dynamic, Eigen::Dynamic>;

  int size() const { return static_cast<int>(plan_->place.size()); }
  int borders() const { return static_cast<int>(plan_->border.size()); }
  bool factor_fronts(threads::Crew& crew, const HalfSolve* right);
  void begin(const HalfSolve& right) const;
  void eliminate(const Front& front, const HalfSolve& right) const;
  void end(const HalfSolve& right) const;
  void start_panel(const Front& front, const HalfSolve* right);
  bool factor_front(const Front& front, Real* room, Vector& spare, threads::Crew& crew, const HalfSolve* right);
  void take_right(const Front& front, Vector& spare, const HalfSolve& right);
  Real* update_of(const Front& front, Real* room) { return (front.in_part ? room : updates_.data()) + front.update; }
  void add_children(const Front& front, Real* room, bool to_panel, threads::Crew& crew);
  void update(threads::Crew& crew, Real* C, int C_stride, const Real* A, int A_stride, int height, int columns,
              int depth, const Real* signs, bool fresh);

  std::shared_ptr<const Fronts> plan_;
  const KernelsOf<Real>* kernels_;
  const double *values_ = nullptr, *border_values_ = nullptr;  ///< while it factors
  AlignedVector<Real> panels_, updates_;
  struct Room {
    AlignedVector<Real> updates;
    Vector spare;
  };
  std::vector<Room> rooms_;  ///< of parts that are done at one time
  Eigen::VectorXd diagonal_;
  Vector pivots_, signs_;
  Matrix minus_W_;  ///< -H A^-1 H^T below its diagonal, in the order of the plan
  /// Room for solves: one thread at a time (`factor` adds to the last by parts). The last holds -u.
  mutable Vector own_, below_, whole_, bordering_;
};

extern template class FrontPanels<float>;
extern template class FrontPanels<double>;

}  // namespace sinew::linalg
