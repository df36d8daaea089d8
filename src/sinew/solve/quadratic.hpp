// Least of a convex quadratic function under linear limits: what is left of the inverse problem (15) once all rows are
// eliminated.
#pragma once

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <vector>

namespace sinew::solve {

/// Which of its limits a row ended at.
enum class At { between, lower, upper };

/// Minimises x . H x / 2 + g . x under lower <= A x <= upper by the dual active set of Goldfarb and Idnani (1983): from
/// the unbounded least, limits are added that are not met, the worst first, and dropped where they no longer push. For
/// few unknowns: every change of the set factors what is active again. Keeps its memory.
class Quadratic {
 public:
  enum class Outcome {
    solved,
    infeasible,  ///< no x meets all limits: `conflict` names some that exclude each other
    invalid      ///< H is not positive definite, a limit above the other, or a number is not one
  };

  /// H symmetric positive definite (its lower triangle counts); limits may be infinite, and equal. `x` is the solution;
  /// it means nothing where there is none.
  Outcome minimise(const Eigen::MatrixXd& H, const Eigen::VectorXd& g, const Eigen::MatrixXd& A,
                   const Eigen::VectorXd& lower, const Eigen::VectorXd& upper, Eigen::VectorXd& x);

  const std::vector<At>& at() const { return at_; }               ///< of each row
  const std::vector<int>& conflict() const { return conflict_; }  ///< rows, ascending
  /// How fast the least falls as the limit that a row is at is moved outward: H x + g = A^T y with y its pull inward,
  /// positive at a lower limit, negative at an upper one.
  const Eigen::VectorXd& pulls() const { return pulls_; }
  int iterations() const { return iterations_; }

 private:
  /// A limit, as n . x >= b.
  struct Limit {
    int row = 0;
    double sign = 1.0;  ///< -1: an upper one
    bool equal = false;
    double pull = 0.0;
  };
  Eigen::Index active() const { return static_cast<Eigen::Index>(active_.size()); }
  void span();
  void split(Eigen::VectorXd& v);
  void settle(const Eigen::MatrixXd& H, const Eigen::VectorXd& g, const Eigen::VectorXd& lower,
              const Eigen::VectorXd& upper, Eigen::VectorXd& x);

  std::vector<At> at_;
  std::vector<bool> met_;  ///< by others, to rounding
  std::vector<int> conflict_;
  std::vector<Limit> active_;
  Eigen::LLT<Eigen::MatrixXd> factor_;
  Eigen::MatrixXd rows_, Q_, R_;  ///< A^T; Q R = L^-1 times the normals of active limits
  Eigen::VectorXd scale_, values_, normal_, half_, along_, give_, pulls_;
  int iterations_ = 0;
};

}  // namespace sinew::solve
