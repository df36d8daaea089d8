// The coupled linear problem of a step, (11) and (12): volumes seen through their compliance, rods through their
// coordinates.
#pragma once

#include <Eigen/Core>

namespace sinew::solve {

/// Unknowns dz (coordinates of rods, abscissae of sliding points) and dlambda (multipliers, forces):
///     B dz + G^T dlambda = -r           equilibrium of the rods
///     G dz - W dlambda   =  c           constraints: c + H dx = G dz, volumes moving by dx = dx_free + A^-1 H^T
///     dlambda
/// so W = H A_x^-1 H^T and c is the violation after the free motion. Eliminating dz with an invertible B gives the
/// paper's (11), (12):  (W + G B^-1 G^T) dlambda = -(c + G B^-1 r); the form here needs no inverse of B, which is
/// singular for a straight cable whose abscissae are unknown, and indefinite under tension.
struct CoupledProblem {
  Eigen::MatrixXd B, G, W;
  Eigen::VectorXd r, c;
};

struct CoupledSolution {
  Eigen::VectorXd dz, dlambda;
  bool ok = false;         ///< finite, and the equations hold to rounding
  bool redundant = false;  ///< rows depended on each other; the multipliers returned are the smallest that do
  double residual = 0.0;   ///< largest relative residual of the scaled equations
};

/// Dense factorisation of the whole, scaled so that rows of different units weigh alike, with one refinement. Where
/// that is singular, a complete orthogonal decomposition takes over.
CoupledSolution solve_direct(const CoupledProblem& problem);

}  // namespace sinew::solve
