// Elastic moduli of isotropic linear elasticity, from what a user knows.
#pragma once

#include <variant>

#include "sinew/solid/law.hpp"

namespace sinew::solid {

/// From Young's modulus [Pa] and Poisson's ratio in (-1, 0.5).
constexpr Lame lame(double young, double poisson) {
  return {young / (2.0 * (1.0 + poisson)), young * poisson / ((1.0 + poisson) * (1.0 - 2.0 * poisson))};
}

struct Bulk {
  double modulus = 0.0;  ///< [Pa]
};
struct Poisson {
  double ratio = 0.0;  ///< in (-1, 0.5), of small strains
};
/// How a law that is known by its shear response resists a change of volume.
using Compressibility = std::variant<Bulk, Poisson>;

/// Bulk modulus [Pa] beside the shear modulus at rest [Pa].
constexpr double bulk_modulus(double shear, const Compressibility& given) {
  if (const Bulk* bulk = std::get_if<Bulk>(&given)) return bulk->modulus;
  const double poisson = std::get<Poisson>(given).ratio;
  return 2.0 * shear * (1.0 + poisson) / (3.0 * (1.0 - 2.0 * poisson));
}

constexpr double young(const Lame& moduli) {
  return moduli.mu * (2.0 + moduli.lambda / (moduli.lambda + moduli.mu));  // squares neither overflow nor vanish
}
constexpr double bulk_modulus(const Lame& moduli) { return moduli.lambda + 2.0 / 3.0 * moduli.mu; }
constexpr Lame lame_from_bulk(double shear, double bulk) { return {shear, bulk - 2.0 / 3.0 * shear}; }

}  // namespace sinew::solid
