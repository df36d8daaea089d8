// Mass matrix and Coriolis forces of (6), M(q) q'' + C(q, q') q' + ... , by recursion along the rod.
//
// Time steps do not call these: they put the inertia of mass points at their positions in space, which holds M and C
// together (README.md). Modal analysis takes M, and whoever wants equations in the coordinates has them here.
#pragma once

#include "sinew/rod/forces.hpp"

namespace sinew::rod {

/// M(q) = sum m J^T J as the tangent of `equations.chain` and `equations.base`; r stays zero.
Equations mass_matrix(const Configuration& shape);

/// C(q, q') q' = sum m J^T (dJ/dt q'): what the mass points feel when q'' = 0.
Eigen::VectorXd coriolis_forces(const Configuration& shape, const Eigen::VectorXd& velocity);

/// C(q, q') = sum m J^T dJ/dt, for which dM/dt - 2 C is skew. Dense, O(n^2) a mass point: for checks and control
/// design.
Eigen::MatrixXd coriolis_matrix(const Configuration& shape, const Eigen::VectorXd& velocity);

/// 1/2 q'^T M q'.
double kinetic_energy(const Configuration& shape, const Eigen::VectorXd& velocity);

}  // namespace sinew::rod
