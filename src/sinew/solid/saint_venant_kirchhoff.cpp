#include "sinew/solid/saint_venant_kirchhoff.hpp"

#include "sinew/solid/invariants.hpp"

namespace sinew::solid {

Part SaintVenantKirchhoff::shape(const Mat3& F, Derivatives wanted) const { return shape(F, green_strain(F), wanted); }

Part SaintVenantKirchhoff::dilatation(const Mat3& F, Derivatives wanted) const {
  return dilatation(F, green_strain(F), wanted);
}

Part SaintVenantKirchhoff::shape(const Mat3& F, const Mat3& E, Derivatives wanted) const {
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

Part SaintVenantKirchhoff::dilatation(const Mat3& F, const Mat3& E, Derivatives wanted) const {
  Part v(wanted);
  v.value = E.trace();
  if (wanted != Derivatives::none) v.first = F;
  if (wanted == Derivatives::second) v.second.setIdentity();
  return v;
}

}  // namespace sinew::solid
