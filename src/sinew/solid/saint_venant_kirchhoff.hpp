// Saint Venant-Kirchhoff: linear in Green's strain E = (F^T F - I) / 2,
//     w = mu E:E,   v = tr E,   U = lambda / 2 v^2.
// For large rotations and small strains: pressed to l < 1/sqrt(3) of its length it gives way.
#pragma once

#include "sinew/solid/invariants.hpp"
#include "sinew/solid/law.hpp"
#include "sinew/solid/moduli.hpp"

namespace sinew::solid {

struct SaintVenantKirchhoff {
  static constexpr bool kInvertible = true;
  double young = 0.0;    ///< [Pa]
  double poisson = 0.0;  ///< [-]
  Lame moduli;

  Part shape(const Mat3& F, Derivatives wanted) const { return shape(F, green_strain(F), wanted); }
  Part dilatation(const Mat3& F, Derivatives wanted) const { return dilatation(F, green_strain(F), wanted); }

  /// The same where E differs from F's strain by a constant.
  Part shape(const Mat3& F, const Mat3& E, Derivatives wanted) const {
    Part w(wanted);
    w.value = moduli.mu * E.squaredNorm();
    if (wanted == Derivatives::none) return w;
    w.first = 2.0 * moduli.mu * F * E;
    if (wanted == Derivatives::first) return w;
    // d(F E) = dF E + F (dF^T F + F^T dF) / 2
    const Mat3 K = 2.0 * moduli.mu * E, half = moduli.mu * F, left = half * F.transpose();
    for (int j = 0; j < 3; ++j) {
      for (int k = 0; k < 3; ++k) {
        auto block = w.second.block<3, 3>(3 * j, 3 * k);
        block = half.col(k) * F.col(j).transpose();
        if (j == k) block += left;
        block.diagonal().array() += K(k, j);
      }
    }
    return w;
  }

  Part dilatation(const Mat3& F, const Mat3& E, Derivatives wanted) const {
    Part v(wanted);
    v.value = E.trace();
    if (wanted != Derivatives::none) v.first = F;
    if (wanted == Derivatives::second) v.second.setIdentity();
    return v;
  }

  Volumetric volumetric(double v) const { return quadratic(moduli.lambda, v); }
  Lame lame() const { return moduli; }
};

inline SaintVenantKirchhoff saint_venant_kirchhoff(double young, double poisson) {
  return {young, poisson, lame(young, poisson)};
}

}  // namespace sinew::solid
