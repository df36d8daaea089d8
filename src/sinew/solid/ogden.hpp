// Ogden (Ogden, Non-linear Elastic Deformations, 7.2; Holzapfel, Nonlinear Solid Mechanics, 6.5): in the principal
// stretches l_i of F, made isochoric,
//     psi = sum_p mu_p / alpha_p (sum_i (J^(-1/3) l_i)^alpha_p - 3) + K / 2 (J - 1)^2,
// of which U = lambda / 2 (v - 1)^2, v = J, lambda = K - 2/3 mu, and w is the rest (README).
// Shear modulus at rest: sum mu_p alpha_p / 2. One pair (mu, 2) is neo-Hookean, two (2 c10, 2), (-2 c01, -2) are
// Mooney-Rivlin.
#pragma once

#include <array>
#include <span>

#include "sinew/solid/law.hpp"
#include "sinew/solid/moduli.hpp"

namespace sinew::solid {

struct OgdenTerm {
  double mu = 0.0;     ///< [Pa]
  double alpha = 0.0;  ///< [-], not 0
};

struct Ogden {
  static constexpr bool kInvertible = false;
  static constexpr int kMostTerms = 6;
  std::array<OgdenTerm, kMostTerms> terms{};
  int count = 0;
  Lame moduli;  ///< at rest

  Part shape(const Mat3& F, Derivatives wanted) const;
  Part dilatation(const Mat3& F, Derivatives wanted) const;
  Volumetric volumetric(double v) const { return quadratic(moduli.lambda, v - 1.0); }
  Lame lame() const { return moduli; }

 private:
  Part isochoric(const Mat3& F, Derivatives wanted) const;
};

/// From at most kMostTerms terms.
Ogden ogden(std::span<const OgdenTerm> terms, const Compressibility& given);

}  // namespace sinew::solid
