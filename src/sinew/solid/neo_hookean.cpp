#include "sinew/solid/neo_hookean.hpp"

#include <cmath>

#include "sinew/solid/invariants.hpp"

namespace sinew::solid {

namespace {

/// w, in a Part that is 0, with J = det F and its first derivative.
void set_shape(const Lame& moduli, const Mat3& F, const Part& J, Derivatives wanted, Part& w) {
  const double mu = 4.0 / 3.0 * moduli.mu;
  const double I = F.squaredNorm(), part = 1.0 / (I + 1.0);
  w.value = 0.5 * mu * (I - 3.0 - std::log1p(0.25 * (I - 3.0)));
  if (wanted != Derivatives::none) w.first = mu * (1.0 - part) * F;
  if (wanted == Derivatives::second) {
    const Vec9 f = F.reshaped();
    w.second = (2.0 * mu * part * part * f) * f.transpose();
    w.second.diagonal().array() += mu * (1.0 - part);
  }
  add_dilatation(F, J, -0.75 * mu, 5.0 / 6.0 * moduli.mu, wanted, w);
}

}  // namespace

Part NeoHookean::shape(const Mat3& F, Derivatives wanted) const { return parts(F, wanted).shape; }

Part NeoHookean::dilatation(const Mat3& F, Derivatives wanted) const { return determinant(F, wanted); }

Parts NeoHookean::parts(const Mat3& F, Derivatives wanted) const {
  Parts both{Part(wanted), determinant(F, wanted)};
  set_shape(moduli, F, both.dilatation, wanted, both.shape);
  return both;
}

}  // namespace sinew::solid
