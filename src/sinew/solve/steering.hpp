// What commands do best at one linearisation, (15): effectors brought nearest to their goals within the limits of
// motors, while contacts answer.
#pragma once

#include <Eigen/SVD>
#include <optional>

#include "sinew/solve/coulomb.hpp"
#include "sinew/solve/quadratic.hpp"

namespace sinew::solve {

/// All is linear in increments p of the commands and in forces lambda at contacts, which follow from p:
///     e(p) = e + J p + L (lambda - held)     is to have the least sum of squares
///     lower <= A p + C (lambda - held) <= upper
///     lambda solves the contacts' problem with b + B p for b; it is `held` at p = 0
/// Without contacts this is a convex quadratic problem. With them it is one on every piece, on which contacts stay
/// open, stick or slip as they are, and pieces meet in kinks.
struct SteeringProblem {
  Eigen::VectorXd e;
  Eigen::MatrixXd J, L;
  Eigen::MatrixXd A, C;
  Eigen::VectorXd lower, upper;
  /// Of each limit: where they exclude each other, those of little firmness give way first; infinite: never.
  Eigen::VectorXd firmness;
  Eigen::VectorXd unit;  ///< in what each limit is told: less than 1e-9 of that is rounding
  /// Where J leaves a choice, the first rows of A come nearest to these.
  Eigen::VectorXd wish;
  CoulombProblem contacts;
  Eigen::MatrixXd B;
  Eigen::VectorXd held;
};

/// A limit that is broken, and on which side.
struct Broken {
  int row = 0;
  At at = At::between;
};

/// Goes from piece to piece, the best of each by `Quadratic`, as long as that helps; where no piece next to it does
/// better the solution is a local one. It is looked for from p = 0, there with what is about to slide both sticking and
/// sliding, and from where branch and bound takes up to a dozen contacts without friction: which of them are open and
/// which closed is then decided for the whole, with a lower bound on what any other choice could reach. Keeps its
/// memory.
class Steering {
 public:
  /// False where nothing could be found: numbers that are none.
  bool solve(const SteeringProblem& problem);

  const Eigen::VectorXd& p() const { return here_.p; }
  const Eigen::VectorXd& lambda() const { return here_.lambda; }
  const Eigen::VectorXd& left() const { return here_.e; }     ///< e(p)
  const Eigen::VectorXd& rows() const { return here_.rows; }  ///< what limits are on, at p
  const Eigen::VectorXd& pulls() const { return pulls_; }     ///< as Quadratic's, of the last piece
  const Eigen::VectorXd& strength() const {
    return strength_;
  }  ///< of each limit: a pull that matters is not far below
  const std::vector<Broken>& broken() const { return here_.broken; }
  /// The search ended at its limit of work, with many contacts: p is the best it had come to, no minimum.
  bool cut_short() const { return work_ > kMostWork; }
  /// No other p within the limits does better: without contacts, and without friction where branch and bound has come
  /// to its end.
  bool certain() const { return certain_; }

  /// d lambda / d p as long as contacts stay as they are at p = 0.
  const Eigen::MatrixXd& reaction(const SteeringProblem& problem);

 private:
  static constexpr double kMostWork = 1e9;  ///< multiplications, most of a second: contacts solved anew for each p
  struct Point {
    Eigen::VectorXd p, lambda, e, rows;
    Eigen::VectorXd lower, upper;  ///< of rows, some of them widened
    std::vector<Broken> broken;
    std::vector<CoulombPiece> modes;
  };
  enum class Stay { anywhere, on_piece };
  void place(const SteeringProblem& problem, Point& at);
  double cost(const Point& at) const;
  bool piece(const SteeringProblem& problem, Point& at, Stay stay);
  bool relax(const SteeringProblem& problem, Point& at);
  bool search(const SteeringProblem& problem, Point& at, int halvings);
  bool descend(const SteeringProblem& problem, Point& at);
  bool slide(const SteeringProblem& problem, Point& at);
  std::optional<double> bound(const SteeringProblem& problem, Point& at);
  void prefer(const SteeringProblem& problem);

  Point here_, there_, trial_, best_;
  Quadratic quadratic_;
  Coulomb coulomb_;
  CoulombProblem contacts_;
  Eigen::MatrixXd S_, J_, A_, H_, scaled_, kept_;
  Eigen::VectorXd g_, d_, lower_, upper_, kept_lower_, kept_upper_, pulls_, strength_, penalty_, unit_;
  Eigen::JacobiSVD<Eigen::MatrixXd> svd_;
  double promise_ = 0.0, work_ = 0.0;
  bool certain_ = false;
};

}  // namespace sinew::solve
