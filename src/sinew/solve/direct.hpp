// Solves the coupled linear problem of a step.
#pragma once

#include <Eigen/Core>
#include <Eigen/LU>
#include <Eigen/QR>
#include <memory>
#include <vector>

#include "sinew/linalg/symmetric_factor.hpp"
#include "sinew/solve/border_order.hpp"
#include "sinew/solve/coupled_problem.hpp"

namespace sinew::solve {

/// The whole matrix over (z, lambda, strains of all chains): for checks, and the solver of last resort.
Eigen::MatrixXd written_out(const CoupledProblem& problem);

/// What changes from one solve to the next with the same matrix.
struct RightSide {
  Eigen::VectorXd r, c;
  std::vector<Eigen::VectorXd> chains;
};
void right_side(const CoupledProblem& problem, RightSide& right);

struct CoupledSolution {
  Eigen::VectorXd dz, dlambda;
  std::vector<Eigen::VectorXd> dq;  ///< strains of each chain
  bool ok = false;                  ///< finite, and the equations hold to rounding
  bool redundant = false;           ///< rows depended on each other; the multipliers returned are the smallest that do
  double residual = 0.0;  ///< largest relative residual of the scaled equations, or what a small correction leaves

  /// Adds the unknowns of another solution.
  CoupledSolution& operator+=(const CoupledSolution& other);
};

/// Signs of the eigenvalues of a symmetric matrix (Sylvester).
struct MatrixInertia {
  int negative = 0;                ///< how many are negative
  std::vector<int> null_unknowns;  ///< unknowns z with a `reference` that take part in motions which nothing resists
};

/// Factors once, solves often, and keeps its memory for the next problem. Chains are eliminated in time proportional to
/// their length. The border is dense; solutions are refined. A symmetric one is factored as such, the rows that feel a
/// compliance first, then z; a compliance that vanishes in some direction (a point of which all nodes are held) is
/// given a ten-billionth of the others' and refined away. Where that is not good enough, an LU serves. Where a
/// chain has no good pivots (strains that nothing but the constraints hold), it joins the border; where the border is
/// singular, a complete orthogonal decomposition takes over.
class CoupledFactor {
 public:
  /// First what needs no volumes. The problem must outlive its solutions.
  void eliminate_chains(const CoupledProblem& problem);
  /// And the border.
  void factor();
  void solve(const RightSide& right, CoupledSolution& solution);
  /// How much of a solution is wanted; strains that are not are zero.
  enum class Part { all, without_strains };
  /// One of several solutions that are put together, and then polished as one: what is left of its equations is neither
  /// looked at, nor told in `residual`.
  void answer(const RightSide& right, CoupledSolution& solution, Part part = Part::all);
  /// Finds the strains of a solution that is near, and refines it; where that does not help, solves again. False where
  /// it was not that near: what has been made of its parts is not good for much either.
  bool polish(const RightSide& right, CoupledSolution& solution);

  /// Negative eigenvalues of the whole matrix (Sylvester), if it is symmetric, and what nothing resists. An equilibrium
  /// is stable where there are no more of them than rows. Costs an eigenvalue problem of the border where that has no
  /// symmetric factor, or one with pivots that vanished and were replaced: what is left of others beside them may be
  /// rounding, whose sign says nothing.
  MatrixInertia inertia() const;

 private:
  enum class Kind { symmetric, general, singular };

  bool factor_symmetric();
  void factor_general(bool join_chains);
  template <class Border>
  void fill(Border& border) const;
  MatrixInertia inertia_of(Eigen::MatrixXd K) const;
  void weigh();
  void solve_once(const RightSide& right, CoupledSolution& solution, Part wanted = Part::all);
  void find_strains(const RightSide& right, CoupledSolution& solution);
  double refine(const RightSide& right, CoupledSolution& solution);
  /// What a residual is measured against.
  double size_of(const RightSide& right, const CoupledSolution& solution) const;
  /// Right side minus matrix times solution, and its largest entry beside the right side's and the solution's, as the
  /// border weighs them.
  double residual(const RightSide& right, const CoupledSolution& solution, RightSide& rest);

  const CoupledProblem* problem_ = nullptr;
  Kind kind_ = Kind::general;
  bool chains_ = false;    ///< all of them have pivots
  bool joined_ = false;    ///< chains are written out in the border
  bool replaced_ = false;  ///< pivots of the symmetric factor vanished
  std::vector<linalg::ChainFactor> factors_;
  std::vector<linalg::ChainFactor::Condensed> condensed_;

  // Of a symmetric border.
  BorderOrder order_;
  std::vector<double> least_;
  linalg::SymmetricFactor symmetric_;
  // Of any other, chains perhaps included.
  Eigen::MatrixXd K_;
  std::unique_ptr<Eigen::PartialPivLU<Eigen::MatrixXd>> lu_;
  /// Of one that is singular; made when it is first solved.
  using Orthogonal = Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd>;
  std::unique_ptr<Orthogonal> orthogonal_;

  Eigen::VectorXd scale_;  ///< D: D K D has entries near one
  Eigen::VectorXd diagonal_, largest_, y_, left_, forces_, moved_;
  std::vector<int> places_;
  struct ChainRoom {
    Eigen::VectorXd attached, answer;
  };
  std::vector<ChainRoom> rooms_;
  std::vector<double> ordered_;
  RightSide rest_;
  CoupledSolution correction_;
};

CoupledSolution solve_direct(const CoupledProblem& problem);

}  // namespace sinew::solve
