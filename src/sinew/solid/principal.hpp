// The principal frame of a deformation gradient, F = U diag(l) V^T, in which isotropic laws split (README).
#pragma once

#include "sinew/solid/law.hpp"

namespace sinew::solid {

/// U and V both proper or both improper where det F > 0; stretches in no order, none of them negative. Columns of U
/// whose stretch is 0 are not numbers.
struct Principal {
  Mat3 U, V;
  Vec3 stretch;
};
Principal principal(const Mat3& F);

/// The nearest positive semi-definite matrix: negative eigenvalues of the symmetric C become 0.
Mat9 positive_semidefinite(const Mat9& C);

/// The same where C = d2psi/dF2 of an isotropic density at F, for a fraction of the work: at F, C couples changes of
/// the three stretches with each other, and those of two axes towards each other in pairs, and nothing else.
Mat9 positive_semidefinite(const Mat9& C, const Mat3& F);

}  // namespace sinew::solid
