// Least of a convex quadratic function between bounds: what is left of the inverse problem (15) once all rows are
// eliminated.
#pragma once

#include <Eigen/Core>
#include <vector>

namespace sinew::solve {

/// Minimises x . H x / 2 + g . x over lower <= x <= upper by an active set; keeps its memory. For few unknowns: every
/// iteration factors H over those that are free.
class Bounded {
 public:
  /// H symmetric positive definite; bounds may be infinite. `x` is where it starts, if between the bounds, and the
  /// solution. False where H is not positive definite, a bound is above the other, or a number is
  /// not one: x means nothing then.
  bool minimise(const Eigen::MatrixXd& H, const Eigen::VectorXd& g, const Eigen::VectorXd& lower,
                const Eigen::VectorXd& upper, Eigen::VectorXd& x);
  /// Which bound each unknown ended at.
  enum class At { between, lower, upper };
  const std::vector<At>& at() const { return at_; }
  int iterations() const { return iterations_; }

 private:
  bool move_free(const Eigen::MatrixXd& H, const Eigen::VectorXd& lower, const Eigen::VectorXd& upper,
                 Eigen::VectorXd& x);

  std::vector<At> at_;
  std::vector<int> free_;
  Eigen::MatrixXd K_;
  Eigen::VectorXd slope_, step_;
  int iterations_ = 0;
};

}  // namespace sinew::solve
