// What a constitutive law tells: an energy density in two parts,
//     psi(F) = w(F) + U(v(F)),
// w against changes of shape, U against changes of the dilatation v (J of most laws, tr(S - I) or tr E of others). They
// are kept apart because an element may take v as its mean: that is what frees it from volumetric locking (README).
// A law is a value type that meets the concept below, in a file of its own; `laws.hpp` lists them all.
#pragma once

#include <Eigen/Core>
#include <concepts>

#include "sinew/solid/element.hpp"

namespace sinew::solid {

using Vec9 = Eigen::Matrix<double, 9, 1>;
using Mat9 = Eigen::Matrix<double, 9, 9>;

/// Which derivatives are wanted. First ones not asked for are 0, second ones not set.
enum class Derivatives { none, first, second };

/// A function of the deformation gradient F. Second derivatives over vec(F), its columns one below another.
struct Part {
  double value = 0.0;         ///< [J/m^3], or [-] of a dilatation
  Mat3 first = Mat3::Zero();  ///< d/dF
  Mat9 second;

  Part() = default;
  /// Second derivatives 0 where they are wanted only: clearing them takes as long as finding a force.
  explicit Part(Derivatives wanted) {
    if (wanted == Derivatives::second) second.setZero();
  }
};

/// U and its derivatives at a dilatation.
struct Volumetric {
  double value = 0.0, first = 0.0, second = 0.0;
};

/// stiffness / 2 e^2 of a distance e from rest.
constexpr Volumetric quadratic(double stiffness, double e) {
  return {0.5 * stiffness * e * e, stiffness * e, stiffness};
}

/// w and v of one F.
struct Parts {
  Part shape, dilatation;
};

struct Lame {
  double mu = 0.0;      ///< [Pa]
  double lambda = 0.0;  ///< [Pa]
};

/// Without directions: w and v are functions of F's stretches and of the sign of det F (`principal` relies on it).
/// kInvertible: defined for det F <= 0, too; else w is infinite there and its derivatives are 0.
template <class L>
concept ConstitutiveLaw = requires(const L& law, const Mat3& F, double v, Derivatives wanted) {
  { law.shape(F, wanted) } -> std::same_as<Part>;       ///< w
  { law.dilatation(F, wanted) } -> std::same_as<Part>;  ///< v
  { law.volumetric(v) } -> std::same_as<Volumetric>;    ///< U
  { law.lame() } -> std::same_as<Lame>;                 ///< the moduli of its linearisation at rest
  { L::kInvertible } -> std::convertible_to<bool>;
};

}  // namespace sinew::solid
