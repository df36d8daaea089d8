#include "sinew/solid/mooney_rivlin.hpp"

#include <cmath>
#include <limits>

#include "sinew/solid/invariants.hpp"

namespace sinew::solid {

Part MooneyRivlin::shape(const Mat3& F, Derivatives wanted) const {
  Part w = isochoric(F, wanted);
  if (std::isfinite(w.value)) add_dilatation(F, 0.0, 2.0 / 3.0 * moduli.mu, wanted, w);
  return w;
}

Part MooneyRivlin::isochoric(const Mat3& F, Derivatives wanted) const {
  Part w(wanted);
  const Mat3 cof = cofactor(F);
  const double J = F.col(0).dot(cof.col(0));
  if (!(J > 0.0)) {
    w.value = std::numeric_limits<double>::infinity();
    return w;
  }
  // By the strain E: I1 - 3 and J^(-2/3) - 1 have their own digits near rest.
  const Mat3 E = green_strain(F);
  const double e1 = 2.0 * E.trace(), e2 = 2.0 * e1 + 0.5 * e1 * e1 - 2.0 * E.squaredNorm();  // I1 - 3, I2 - 3
  const double less1 = std::expm1(-2.0 / 3.0 * log_determinant(E, J)), less2 = less1 * (2.0 + less1);
  const double g1 = c10 * (1.0 + less1), g2 = c01 * (1.0 + less2);  // c10 J^(-2/3), c01 J^(-4/3)
  w.value = 3.0 * c10 * less1 + g1 * e1 + 3.0 * c01 * less2 + g2 * e2;
  if (wanted == Derivatives::none) return w;

  // d(J^p I) = J^p (dI + p I F^-T : dF)
  constexpr double p1 = -2.0 / 3.0, p2 = -4.0 / 3.0;
  const double I1 = 3.0 + e1, I2 = 3.0 + e2;
  const Mat3 C = F.transpose() * F, G = cof / J;  // F^-T
  const Mat3 dI1 = 2.0 * F, dI2 = 2.0 * (I1 * F - F * C);
  w.first = g1 * dI1 + g2 * dI2 + (g1 * p1 * I1 + g2 * p2 * I2) * G;
  if (wanted == Derivatives::first) return w;

  // d2(J^p I) = J^p (d2I + p (G dI + dI G) + p (p - 1) I G G + p I / J d2J),  d2I1 = 2 dF:dF
  const Mat3 left = 2.0 * g2 * F * F.transpose();
  const Vec9 g = G.reshaped(), mixed = (p1 * g1 * dI1 + p2 * g2 * dI2).reshaped();
  const Vec9 half = mixed + 0.5 * (p1 * (p1 - 1.0) * g1 * I1 + p2 * (p2 - 1.0) * g2 * I2) * g;
  w.second = g * half.transpose() + half * g.transpose();
  for (int j = 0; j < 3; ++j) {
    for (int k = 0; k < 3; ++k) {
      auto block = w.second.block<3, 3>(3 * j, 3 * k);
      block += 2.0 * g2 * (2.0 * F.col(j) * F.col(k).transpose() - F.col(k) * F.col(j).transpose());
      if (j == k) block -= left;
      block.diagonal().array() += (j == k ? 2.0 * (g1 + g2 * I1) : 0.0) - 2.0 * g2 * C(k, j);
    }
  }
  add_determinant_second(F, (p1 * g1 * I1 + p2 * g2 * I2) / J, w.second);
  return w;
}

Part MooneyRivlin::dilatation(const Mat3& F, Derivatives wanted) const { return determinant(F, wanted); }

}  // namespace sinew::solid
