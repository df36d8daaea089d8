// The principal frame of a deformation gradient, F = U diag(l) V^T, in which isotropic laws split (README).
#pragma once

#include "sinew/solid/law.hpp"

namespace sinew::solid {

/// Stretches in no order, none of them negative; V is a rotation, U one where det F > 0. Columns of U whose stretch is
/// 0 are no numbers.
struct Principal {
  Mat3 U, V;
  Vec3 stretch;
};
Principal principal(const Mat3& F);
/// Unit changes of F in its frame, as columns: u_i v_i^T of each axis, then (u_i v_j^T + u_j v_i^T) / sqrt 2 of each
/// pair of axes, then (u_i v_j^T - u_j v_i^T) / sqrt 2.
Mat9 unit_changes(const Principal& frame);

/// The nearest positive semi-definite matrix: negative eigenvalues of the symmetric C become 0.
Mat9 positive_semidefinite(const Mat9& C);

/// The same, for a fraction of the work, where C = d2psi/dF2 of a law without directions at F: it splits in the
/// principal frame (README, definite tangent).
Mat9 positive_semidefinite(const Mat9& C, const Mat3& F);

}  // namespace sinew::solid
