// The coupled linear problem of a step, (11) and (12): volumes seen through their compliance, rods through their
// chains.
#pragma once

#include <Eigen/Core>
#include <Eigen/LU>
#include <memory>
#include <vector>

#include "sinew/linalg/chain.hpp"
#include "sinew/linalg/symmetric_factor.hpp"

namespace sinew::solve {

/// The strains of one rod: A x + U^T T y_b + R^T y = -r, where y_b are its base's coordinates, y all border unknowns.
struct ChainPart {
  linalg::Chain chain;    ///< A
  linalg::Matrix6X base;  ///< T: twists of the base's coordinates
  int first_base = 0;     ///< their place in z
  Eigen::VectorXd r;
  std::vector<linalg::Attachment> attachments;  ///< rows of R, sorted by link ...
  std::vector<int> at;                          ///< ... and what each belongs to: z's number, or z's size + row
  Eigen::MatrixXd whole;                        ///< rows of R that reach along the whole chain, as columns
  std::vector<int> whole_at;
};

/// Unknowns: z (coordinates of bases and cables, abscissae), multipliers lambda (forces) and the strains of all chains.
///     B dz + G^T dlambda + (chains) = -r        equilibrium
///     G dz - W dlambda   + (chains) =  c        constraints: c + H dx = G dz + ..., with volumes moving by
///                                               dx = dx_free + A_x^-1 H^T dlambda
/// so W = H A_x^-1 H^T and c is the violation after the free motion. Eliminating the chains adds the rods' share to W:
/// the paper's (11), (12). What remains, the border, needs no inverse of B, which is singular for a straight cable
/// whose abscissae are unknown, and indefinite under tension.
struct CoupledProblem {
  Eigen::MatrixXd B, G, W;
  Eigen::VectorXd r, c;
  std::vector<ChainPart> chains;
};

/// The whole matrix over (z, lambda, strains of all chains): for checks, and the solver of last resort.
Eigen::MatrixXd written_out(const CoupledProblem& problem);

/// What changes from one solve to the next with the same matrix.
struct RightSide {
  Eigen::VectorXd r, c;
  std::vector<Eigen::VectorXd> chains;
};
RightSide right_side(const CoupledProblem& problem);

struct CoupledSolution {
  Eigen::VectorXd dz, dlambda;
  std::vector<Eigen::VectorXd> dq;  ///< strains of each chain
  bool ok = false;                  ///< finite, and the equations hold to rounding
  bool redundant = false;           ///< rows depended on each other; the multipliers returned are the smallest that do
  double residual = 0.0;            ///< largest relative residual of the scaled equations
};

/// Factors once, solves often. Chains are eliminated in time proportional to their length; the border is dense, scaled
/// so that rows of different units weigh alike, and its solutions are refined once. A symmetric border is factored as
/// such, the rows that feel a compliance first; where that is not good enough, by an LU. Where a chain has no good
/// pivots (strains that nothing but the constraints hold), it joins the border; where the border is singular, a
/// complete orthogonal decomposition takes over.
class CoupledFactor {
 public:
  explicit CoupledFactor(const CoupledProblem& problem);
  CoupledSolution solve(const RightSide& right);

  /// Negative eigenvalues of the whole matrix (Sylvester), if it is symmetric. An equilibrium is stable where there are
  /// no more of them than rows. Costs an eigenvalue problem of the border where that has no symmetric factor.
  int negative() const;

 private:
  void eliminate_chains();
  void join_chains();
  void factor_symmetric();
  CoupledSolution solve_once(const RightSide& right) const;
  /// Right side minus matrix times solution, and the largest relative entry.
  RightSide residual(const RightSide& right, const CoupledSolution& solution, double& relative) const;

  const CoupledProblem& problem_;
  std::vector<linalg::ChainFactor> factors_;  ///< empty when the chains are written out
  Eigen::MatrixXd K_;                         ///< scaled border
  Eigen::VectorXd scale_;
  std::unique_ptr<linalg::SymmetricFactor> symmetric_;        ///< the border's, where it serves
  std::unique_ptr<Eigen::PartialPivLU<Eigen::MatrixXd>> lu_;  ///< or else this
  bool singular_ = false;
};

CoupledSolution solve_direct(const CoupledProblem& problem);

}  // namespace sinew::solve
