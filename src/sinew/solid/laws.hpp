// Every constitutive law, and what is asked of any of them. A new one is one more type in `Law`.
#pragma once

#include <variant>

#include "sinew/solid/corotational.hpp"
#include "sinew/solid/law.hpp"
#include "sinew/solid/mooney_rivlin.hpp"
#include "sinew/solid/neo_hookean.hpp"
#include "sinew/solid/ogden.hpp"
#include "sinew/solid/saint_venant_kirchhoff.hpp"

namespace sinew::solid {

using Law = std::variant<Corotational, SaintVenantKirchhoff, NeoHookean, MooneyRivlin, Ogden>;

static_assert(ConstitutiveLaw<Corotational> && ConstitutiveLaw<SaintVenantKirchhoff> && ConstitutiveLaw<NeoHookean> &&
              ConstitutiveLaw<MooneyRivlin> && ConstitutiveLaw<Ogden>);

/// psi = w + U(v) and its derivatives from those of its parts.
inline Part density(const Parts& parts, const Volumetric& U, Derivatives wanted) {
  Part psi = parts.shape;
  const Part& v = parts.dilatation;
  psi.value += U.value;
  if (wanted != Derivatives::none) psi.first += U.first * v.first;
  if (wanted == Derivatives::second) {
    const Vec9 d = v.first.reshaped();
    psi.second += U.first * v.second + (U.second * d) * d.transpose();
  }
  return psi;
}

/// For loops over many points: visit once, outside.
template <ConstitutiveLaw L>
Parts parts(const L& law, const Mat3& F, Derivatives wanted) {
  if constexpr (requires { law.parts(F, wanted); }) {
    return law.parts(F, wanted);
  } else {
    return {law.shape(F, wanted), law.dilatation(F, wanted)};
  }
}
template <ConstitutiveLaw L>
Part density(const L& law, const Mat3& F, Derivatives wanted) {
  const Parts both = parts(law, F, wanted);
  return density(both, law.volumetric(both.dilatation.value), wanted);
}

Parts parts(const Law& law, const Mat3& F, Derivatives wanted);
Part density(const Law& law, const Mat3& F, Derivatives wanted);
double dilatation(const Law& law, const Mat3& F);
Volumetric volumetric(const Law& law, double v);
Lame lame(const Law& law);
bool invertible(const Law& law);

/// Cauchy stress P F^T / J of a first Piola-Kirchhoff stress P [Pa].
Mat3 cauchy_stress(const Mat3& P, const Mat3& F);
/// sqrt(3/2) times the norm of the deviator [Pa].
double von_mises(const Mat3& cauchy);

}  // namespace sinew::solid
