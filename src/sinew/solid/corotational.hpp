// The corotational law: linear elasticity in a frame that turns with the material. With the polar decomposition F = R S
//     w = mu |F - R|^2,   v = tr(R^T F) - 3,   U = lambda / 2 v^2.
// Derivation in README.md of this folder. Forces and the definite tangent of linear tetrahedra of this law come from
// tet_batch_lanes.cpp, which says the same for eight at a time: change both (tests/solid/tet_batch_test compares them).
#pragma once

#include "sinew/solid/law.hpp"
#include "sinew/solid/moduli.hpp"

namespace sinew::solid {

/// The rotation nearest to F: a proper one, also where det F <= 0 (there the smallest stretch is turned).
Mat3 polar_rotation(const Mat3& F);

/// R and how it follows F.
struct Turning {
  Mat3 R;
  Mat9 slope;           ///< dR/dF, symmetric
  bool frozen = false;  ///< R held: the slope is that at F = R, v is linear
};
/// Frozen where two stretches add up to zero: there R jumps (an inverted element on the edge of another rotation).
Turning exact_turning(const Mat3& F, Derivatives wanted);
Turning frozen_turning(const Mat3& F, Derivatives wanted);

struct Corotational {
  static constexpr bool kInvertible = true;
  double young = 0.0;    ///< [Pa]
  double poisson = 0.0;  ///< [-]
  Lame moduli;

  Part shape(const Mat3& F, Derivatives wanted) const { return shape(F, exact_turning(F, wanted), wanted); }
  Part dilatation(const Mat3& F, Derivatives wanted) const { return dilatation(F, exact_turning(F, wanted), wanted); }
  Volumetric volumetric(double v) const { return quadratic(moduli.lambda, v); }
  Lame lame() const { return moduli; }

  /// Both at the cost of one.
  Parts parts(const Mat3& F, Derivatives wanted) const { return parts(F, exact_turning(F, wanted), wanted); }
  /// The same with R frozen in the second derivatives: linear elasticity in the frame R (R K R^T of the paper),
  /// positive semi-definite, exact at rest.
  Parts definite(const Mat3& F, Derivatives wanted) const { return parts(F, frozen_turning(F, wanted), wanted); }

  Part shape(const Mat3& F, const Turning& turning, Derivatives wanted) const;
  Part dilatation(const Mat3& F, const Turning& turning, Derivatives wanted) const;
  Parts parts(const Mat3& F, const Turning& turning, Derivatives wanted) const {
    return {shape(F, turning, wanted), dilatation(F, turning, wanted)};
  }
};

inline Corotational corotational(double young, double poisson) { return {young, poisson, lame(young, poisson)}; }

inline Part Corotational::shape(const Mat3& F, const Turning& turning, Derivatives wanted) const {
  Part w(wanted);
  const Mat3 strain = F - turning.R;
  w.value = moduli.mu * strain.squaredNorm();
  if (wanted != Derivatives::none)
    w.first = 2.0 * moduli.mu * strain;  // dR does no work: it is [omega]x R, S symmetric
  if (wanted == Derivatives::second) {
    w.second = -2.0 * moduli.mu * turning.slope;
    w.second.diagonal().array() += 2.0 * moduli.mu;
  }
  return w;
}

inline Part Corotational::dilatation(const Mat3& F, const Turning& turning, Derivatives wanted) const {
  Part v(wanted);
  v.value = turning.R.cwiseProduct(F).sum() - 3.0;
  if (wanted != Derivatives::none) v.first = turning.R;
  if (wanted == Derivatives::second && !turning.frozen) v.second = turning.slope;
  return v;
}

}  // namespace sinew::solid
