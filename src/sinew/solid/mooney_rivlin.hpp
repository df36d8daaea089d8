// Mooney-Rivlin (Holzapfel, Nonlinear Solid Mechanics, 6.5): with C = F^T F, I1 = tr C, I2 = (I1^2 - tr C^2) / 2
//     psi = c10 (J^(-2/3) I1 - 3) + c01 (J^(-4/3) I2 - 3) + K / 2 (J - 1)^2,
// of which U = lambda / 2 (v - 1)^2, v = J, lambda = K - 2/3 mu, and w is the rest (README).
#pragma once

#include "sinew/solid/law.hpp"
#include "sinew/solid/moduli.hpp"

namespace sinew::solid {

struct MooneyRivlin {
  static constexpr bool kInvertible = false;
  double c10 = 0.0;  ///< [Pa]
  double c01 = 0.0;  ///< [Pa]
  Lame moduli;       ///< at rest

  Part shape(const Mat3& F, Derivatives wanted) const;
  Part dilatation(const Mat3& F, Derivatives wanted) const;
  Volumetric volumetric(double v) const { return quadratic(moduli.lambda, v - 1.0); }
  Lame lame() const { return moduli; }

 private:
  Part isochoric(const Mat3& F, Derivatives wanted) const;
};

inline MooneyRivlin mooney_rivlin(double c10, double c01, const Compressibility& given) {
  const double shear = 2.0 * (c10 + c01);
  return {c10, c01, lame_from_bulk(shear, bulk_modulus(shear, given))};
}

}  // namespace sinew::solid
