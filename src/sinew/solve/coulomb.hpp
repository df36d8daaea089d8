// Signorini's and Coulomb's laws at many contacts at once: what is left of a step once bodies and bilateral rows are
// eliminated.
#pragma once

#include <Eigen/Core>
#include <Eigen/LU>
#include <vector>

namespace sinew::solve {

/// Contacts i = 0 .. n - 1 with three rows each: along the normal, and two tangents. With forces lambda, u = D lambda +
/// b is how the bodies move relative to each other by the end of the step [m]: u_n what is left of the gap, u_t the
/// slip. Wanted is
///     0 <= lambda_n,  0 <= u_n,  lambda_n u_n = 0                                    (Signorini)
///     |lambda_t| <= mu lambda_n,  lambda_t = -mu lambda_n u_t / |u_t| where u_t != 0   (Coulomb)
struct CoulombProblem {
  Eigen::MatrixXd D;   ///< [m/N] 3n x 3n, symmetric; positive semidefinite but where contacts hold what would buckle
  Eigen::VectorXd b;   ///< [m] 3n: u without forces at the contacts
  Eigen::VectorXd mu;  ///< n, >= 0
  int contacts() const { return static_cast<int>(mu.size()); }
};

/// What a contact yields to its own forces, along the normal and the tangents: the size of D's own entries. Where what
/// touches would buckle but for its contacts, D is indefinite, and they may be negative.
struct OwnCompliance {
  double normal = 0.0, tangent = 0.0;  ///< [m/N] >= 0
};
OwnCompliance own_compliance(const CoulombProblem& problem, int contact);

/// How far forces are from solving a problem. Displacements u are told as the forces that would take them away at their
/// own contact, u / D_ii, and all three are relative to the largest force there is, b / D_ii included.
struct CoulombResidual {
  double complementarity = 0.0;  ///< of lambda_n and u_n: |min(lambda_n, u_n)|
  double cone = 0.0;             ///< |lambda_t| beyond mu lambda_n
  double dissipation = 0.0;      ///< of maximum dissipation: lambda_t off its place on the disk of radius mu lambda_n
  double largest() const;
};
CoulombResidual residual(const CoulombProblem& problem, const Eigen::VectorXd& lambda);

/// The force at a single contact, with D (3 x 3) and b: open, stick or slip, exactly. False where none of them is
/// (friction so high that it jams); lambda is then unchanged.
bool solve_one(const Eigen::Matrix3d& D, const Eigen::Vector3d& b, double mu, Eigen::Ref<Eigen::Vector3d> lambda);

/// One sweep of block Gauss-Seidel: `solve_one` at each contact in turn, with the forces there are at the others.
void sweep(const CoulombProblem& problem, Eigen::VectorXd& lambda);

struct CoulombReport {
  bool solved = false;  ///< to the tolerance
  bool cut = false;     ///< it is not, and has taken kMostWork
  int sweeps = 0;       ///< of block Gauss-Seidel
  int newton = 0;       ///< factorisations of semi-smooth Newton
  double work = 0.0;    ///< multiplications, about
  CoulombResidual residual;
};

/// What a contact does, and how far it is from doing something else, in forces relative to the largest there is.
struct CoulombPiece {
  enum class Mode { open, sticks, slips };
  Mode mode = Mode::open;
  double normal = 0.0;   ///< 0 where it is about to open or to close
  double tangent = 0.0;  ///< of a closed one: 0 where it is about to stick or to slip
};

/// Sweeps of block Gauss-Seidel find out what is open, sticks or slips, semi-smooth Newton on all contacts at once
/// makes it exact; by turns until the tolerance is met. Keeps its memory.
class Coulomb {
 public:
  /// `lambda` is where it starts (3n, the forces of the last step or zero) and the solution, or the best that was
  /// found. What is solved to `nearly`, and what two turns do not improve by half, is left there; so is what has
  /// taken kMostWork.
  CoulombReport solve(const CoulombProblem& problem, double tolerance, Eigen::VectorXd& lambda, double nearly = 0.0);
  /// Problems from now on have another D. (Those with the same one share factors.)
  void begin() { factored_.clear(); }

  /// What each contact does at a solution.
  void modes(const CoulombProblem& problem, const Eigen::VectorXd& lambda, std::vector<CoulombPiece>& modes);
  /// d lambda / dp where b changes by B dp and contacts go on doing what `modes` says: the tangent of the laws, forces
  /// that are not decided as small as they can be. False where it has none.
  bool follow(const CoulombProblem& problem, const Eigen::VectorXd& lambda, const std::vector<CoulombPiece>& modes,
              const Eigen::MatrixXd& B, Eigen::MatrixXd& S);

  static constexpr double kMostWork = 2e11;  ///< multiplications, a minute of a processor

 private:
  void measure(const CoulombProblem& problem);
  Eigen::Vector2d aim(const Eigen::VectorXd& lambda, int contact) const;
  double evaluate(const CoulombProblem& problem, const Eigen::VectorXd& lambda);
  void derive(const CoulombProblem& problem, const Eigen::VectorXd& lambda, int contact, bool sticks,
              Eigen::Matrix3d& A, Eigen::Matrix3d& B) const;
  double radius(const CoulombProblem& problem, const Eigen::VectorXd& lambda, int contact) const;
  /// A step of Newton; `chord`: with the last factorisation. False where that is of other closed contacts.
  bool step(const CoulombProblem& problem, const Eigen::VectorXd& lambda, bool chord);
  bool newton(const CoulombProblem& problem, double tolerance, Eigen::VectorXd& lambda, int& steps);

  double yield_ = 0.0, work_ = 0.0;
  Eigen::VectorXd u_, F_, step_, trial_, best_, held_, lost_, right_, scale_n_, scale_t_;
  Eigen::MatrixXd J_, sides_;
  std::vector<int> active_, factored_;
  Eigen::PartialPivLU<Eigen::MatrixXd> factor_;
};

}  // namespace sinew::solve
