// The stable neo-Hookean law of Smith, de Goes, Kim, Stable Neo-Hookean Flesh Simulation, ACM Trans. Graph. 37(2),
// 2018, (14), with mu' = 4/3 mu, lambda' = lambda + 5/6 mu, less its value at rest: with I = |F|^2
//     w = mu' / 2 (I - 3 - log((I + 1) / 4)) - 3/4 mu' (J - 1) + 5/12 mu (J - 1)^2,   v = J,   U = lambda / 2 (v -
//     1)^2.
// Cut so that each part by itself is at rest at rest, and U has all of lambda, the modulus that locks, and no more. It
// stays finite and pushes back when an element is flat or inverted.
#pragma once

#include "sinew/solid/law.hpp"
#include "sinew/solid/moduli.hpp"

namespace sinew::solid {

struct NeoHookean {
  static constexpr bool kInvertible = true;
  double young = 0.0;    ///< [Pa]
  double poisson = 0.0;  ///< [-]
  Lame moduli;

  Part shape(const Mat3& F, Derivatives wanted) const;
  Part dilatation(const Mat3& F, Derivatives wanted) const;
  /// Both, with one determinant.
  Parts parts(const Mat3& F, Derivatives wanted) const;
  Volumetric volumetric(double v) const { return quadratic(moduli.lambda, v - 1.0); }
  Lame lame() const { return moduli; }
};

inline NeoHookean neo_hookean(double young, double poisson) { return {young, poisson, lame(young, poisson)}; }

}  // namespace sinew::solid
