#include "sinew/solid/ogden.hpp"

#include <cassert>
#include <cmath>
#include <limits>

#include "sinew/solid/invariants.hpp"
#include "sinew/solid/principal.hpp"

namespace sinew::solid {

Ogden ogden(std::span<const OgdenTerm> terms, const Compressibility& given) {
  assert(terms.size() <= static_cast<std::size_t>(Ogden::kMostTerms));
  Ogden law;
  double shear = 0.0;
  for (const OgdenTerm& term : terms) {
    law.terms[law.count++] = term;
    shear += 0.5 * term.mu * term.alpha;
  }
  law.moduli = lame_from_bulk(shear, bulk_modulus(shear, given));
  return law;
}

Part Ogden::dilatation(const Mat3& F, Derivatives wanted) const { return determinant(F, wanted); }

Part Ogden::shape(const Mat3& F, Derivatives wanted) const {
  Part w = isochoric(F, wanted);
  if (std::isfinite(w.value)) add_dilatation(F, 0.0, 2.0 / 3.0 * moduli.mu, wanted, w);
  return w;
}

// With x_i = log l_i and b_i = exp(alpha (x_i - mean x)): f_i = dw/dl_i = s_i / l_i, s_i = sum mu (b_i - mean b).
// In the principal frame the second derivative is d f_i / d l_j on the diagonal strains and, for each pair of axes,
//     (f_i - f_j) / (l_i - l_j) on (u_i v_j^T + u_j v_i^T) / sqrt 2,
//     (f_i + f_j) / (l_i + l_j) on (u_i v_j^T - u_j v_i^T) / sqrt 2.
// The first without a difference of near numbers:
//     (b_i - b_j) / (l_i - l_j) = sqrt(b_i b_j / (l_i l_j)) sinh(alpha h) / sinh h,   h = (x_i - x_j) / 2.
Part Ogden::isochoric(const Mat3& F, Derivatives wanted) const {
  Part w(wanted);
  if (!(F.determinant() > 0.0)) {
    w.value = std::numeric_limits<double>::infinity();
    return w;
  }
  const Principal frame = principal(F);
  const auto& [U, V, l] = frame;
  const Vec3 x = l.array().log();
  const Vec3 y = x.array() - x.mean();
  const bool second = wanted == Derivatives::second;

  Vec3 s = Vec3::Zero();       // d w / d x_i
  Mat3 ds = Mat3::Zero();      // d s_i / d x_j
  Vec3 slopes = Vec3::Zero();  // k: (s_i - s_j) / (l_i - l_j) of the other two
  for (int p = 0; p < count; ++p) {
    const auto [mu, alpha] = terms[p];
    const Vec3 less = (alpha * y).unaryExpr([](double e) { return std::expm1(e); });  // b - 1
    w.value += mu / alpha * less.sum();
    s += mu * (less.array() - less.mean()).matrix();
    if (!second) continue;
    const Vec3 b = less.array() + 1.0;
    ds.diagonal() += mu * alpha * b;
    for (int i = 0; i < 3; ++i) {
      for (int j = 0; j < 3; ++j) ds(i, j) += mu * alpha * (b.mean() - b[i] - b[j]) / 3.0;
    }
    for (int k = 0; k < 3; ++k) {
      const int i = (k + 1) % 3, j = (k + 2) % 3;
      const double h = 0.5 * (x[i] - x[j]), ratio = h == 0.0 ? alpha : std::sinh(alpha * h) / std::sinh(h);
      slopes[k] += mu * ratio * std::sqrt(b[i] * b[j] / (l[i] * l[j]));
    }
  }
  if (wanted == Derivatives::none) return w;
  const Vec3 f = s.cwiseQuotient(l);
  w.first = U * f.asDiagonal() * V.transpose();
  if (!second) return w;

  const Mat9 changes = unit_changes(frame);
  Mat9 bent;  // what each does to the stress
  Mat3 H = ds;
  H.diagonal() -= s;
  H = l.cwiseInverse().asDiagonal() * H * l.cwiseInverse().asDiagonal();
  bent.leftCols<3>() = changes.leftCols<3>() * H;
  for (int k = 0; k < 3; ++k) {
    const int i = (k + 1) % 3, j = (k + 2) % 3;
    // (f_i - f_j) / (l_i - l_j), f = s / l
    const double stretching = 0.5 * (slopes[k] * (l[i] + l[j]) - (s[i] + s[j])) / (l[i] * l[j]);
    bent.col(3 + k) = stretching * changes.col(3 + k);
    bent.col(6 + k) = (f[i] + f[j]) / (l[i] + l[j]) * changes.col(6 + k);
  }
  w.second.noalias() = bent * changes.transpose();
  return w;
}

}  // namespace sinew::solid
