// Saint Venant-Kirchhoff: linear in Green's strain E = (F^T F - I) / 2,
//     w = mu E:E,   v = tr E,   U = lambda / 2 v^2.
// For large rotations and small strains: pressed to l < 1/sqrt(3) of its length it gives way.
#pragma once

#include "sinew/solid/law.hpp"
#include "sinew/solid/moduli.hpp"

namespace sinew::solid {

struct SaintVenantKirchhoff {
  static constexpr bool kInvertible = true;
  double young = 0.0;    ///< [Pa]
  double poisson = 0.0;  ///< [-]
  Lame moduli;

  Part shape(const Mat3& F, Derivatives wanted) const;
  Part dilatation(const Mat3& F, Derivatives wanted) const;

  /// The same where E differs from F's strain by a constant.
  Part shape(const Mat3& F, const Mat3& E, Derivatives wanted) const;
  Part dilatation(const Mat3& F, const Mat3& E, Derivatives wanted) const;

  Volumetric volumetric(double v) const { return quadratic(moduli.lambda, v); }
  Lame lame() const { return moduli; }
};

inline SaintVenantKirchhoff saint_venant_kirchhoff(double young, double poisson) {
  return {young, poisson, lame(young, poisson)};
}

}  // namespace sinew::solid
