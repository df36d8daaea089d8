// What the laws share: Green's strain, J = det F with its derivatives, log J to full accuracy near rest.
#pragma once

#include <Eigen/Dense>
#include <cmath>

#include "sinew/lie/rotation.hpp"
#include "sinew/solid/law.hpp"

namespace sinew::solid {

inline Mat3 green_strain(const Mat3& F) { return 0.5 * (F.transpose() * F - Mat3::Identity()); }

/// dJ/dF = J F^-T, also where J = 0.
inline Mat3 cofactor(const Mat3& F) {
  Mat3 C;
  C.col(0) = F.col(1).cross(F.col(2));
  C.col(1) = F.col(2).cross(F.col(0));
  C.col(2) = F.col(0).cross(F.col(1));
  return C;
}

/// out += factor d2J/dF2: the cofactor's columns are cross products of F's, so the blocks are +-[F_k]x.
inline void add_determinant_second(const Mat3& F, double factor, Mat9& out) {
  for (int k = 0; k < 3; ++k) {
    const int i = (k + 1) % 3, j = (k + 2) % 3;
    const Mat3 H = lie::hat(factor * F.col(k));
    out.block<3, 3>(3 * j, 3 * i) += H;  // C_j = F_k x F_i
    out.block<3, 3>(3 * i, 3 * j) -= H;  // C_i = F_j x F_k
  }
}

/// J as the dilatation of a law.
inline Part determinant(const Mat3& F, Derivatives wanted) {
  Part J(wanted);
  const Mat3 C = cofactor(F);
  J.value = F.col(0).dot(C.col(0));
  if (wanted == Derivatives::none) return J;
  J.first = C;
  if (wanted == Derivatives::second) add_determinant_second(F, 1.0, J.second);
  return J;
}

/// w += first (J - 1) + second / 2 (J - 1)^2, with J and its first derivative.
inline void add_dilatation(const Mat3& F, const Part& J, double first, double second, Derivatives wanted, Part& w) {
  const double e = J.value - 1.0;
  w.value += (first + 0.5 * second * e) * e;
  if (wanted == Derivatives::none) return;
  const double slope = first + second * e;
  w.first += slope * J.first;
  if (wanted == Derivatives::first) return;
  const Vec9 cof = J.first.reshaped();
  w.second += (second * cof) * cof.transpose();
  add_determinant_second(F, slope, w.second);
}
inline void add_dilatation(const Mat3& F, double first, double second, Derivatives wanted, Part& w) {
  const Part J = determinant(F, wanted == Derivatives::none ? wanted : Derivatives::first);
  add_dilatation(F, J, first, second, wanted, w);
}

/// log J for J > 0. Near rest from the strain, J^2 = det(I + 2 E): its error is a fraction of the strain, not of 1.
inline double log_determinant(const Mat3& E, double J) {
  const double e1 = E.trace(), e2 = 0.5 * (e1 * e1 - E.squaredNorm());
  const double excess = 2.0 * e1 + 4.0 * e2 + 8.0 * E.determinant();  // J^2 - 1
  return std::abs(excess) < 0.5 ? 0.5 * std::log1p(excess) : std::log(J);
}

}  // namespace sinew::solid
