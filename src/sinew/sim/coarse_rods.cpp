#include "sinew/sim/coarse_rods.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "sinew/error/digits.hpp"
#include "sinew/rod/integration.hpp"
#include "sinew/sim/internal.hpp"
#include "sinew/sim/stresses_along.hpp"

namespace sinew {

namespace {

constexpr double kMissed = 0.05;
constexpr double kStored = 1e-8;  ///< of E I / L: as much as a bend by a ten thousandth of a radian

/// [J] Twice the energy that a section stores, and twice that which it misses.
struct Followed {
  double stored = 0.0, missed = 0.0;
};
Followed energies_of(const rod::Rod& rod, const RodState& state, const rod::Section& section, Eigen::Index& column) {
  std::array<int, 6> degree;  // -1 of strains that are not free
  degree.fill(-1);
  for (const rod::Mode& mode : section.modes)
    degree[static_cast<std::size_t>(mode.strain)] =
        std::max(degree[static_cast<std::size_t>(mode.strain)], mode.degree);
  Followed sum;
  Eigen::Matrix<double, 6, 6> followed = Eigen::Matrix<double, 6, 6>::Zero();  // of each strain, by degree
  const Eigen::MatrixXd& internal = state.internal;
  for (; column + 1 < internal.cols() && internal(0, column + 1) <= section.end; ++column) {
    const double begin = internal(0, column), length = internal(0, column + 1) - begin;
    if (begin < section.begin || length <= 0.0) continue;
    for (const GaussPoint& point : kGaussOfThree) {
      const double s = begin + point.t * length, weight = point.weight * length;
      const rod::Vec6 stress = stress_between(internal, column, point.t), strain = rod::deviation(rod, state.q, s);
      const rod::Mat6 stiffness = rod::stiffness_at(rod.profile, s);
      const auto P = rod::legendre(section.local(s));
      for (int i = 0; i < 6; ++i) {
        const int most = degree[static_cast<std::size_t>(i)];
        if (most < 0) continue;
        const double K = stiffness(i, i), d = stress[i] / K - strain[i];
        sum.stored += weight * K * strain[i] * strain[i];
        sum.missed += weight * K * d * d;
        for (int k = 0; k <= most; ++k) followed(i, k) += weight * std::sqrt(K) * d * P[k];
      }
    }
  }
  // int P_k^2 ds = l / (2 k + 1)
  for (int i = 0; i < 6; ++i)
    for (int k = 0; k < 6; ++k) sum.missed -= (2 * k + 1) / section.length() * followed(i, k) * followed(i, k);
  return sum;
}

}  // namespace

double missed_energy(const Model& model, const State& state, int number) {
  const rod::Rod& rod = model.rods[number].rod;
  Followed sum;
  Eigen::Index column = 0;
  for (const rod::Section& section : rod.sections) {
    const Followed own = energies_of(rod, state.rods[number], section, column);
    sum.stored += own.stored;
    sum.missed += std::max(0.0, own.missed);
  }
  if (sum.stored + sum.missed < kStored * buckling_load(rod) * rod.length()) return 0.0;
  return sum.missed / (sum.stored + sum.missed);
}

std::vector<Warning> assess_coarse_rods(const Model& model, const State& state) {
  std::vector<Warning> warnings;
  for (int i = 0; i < static_cast<int>(model.rods.size()); ++i) {
    if (!model.rods[i].slides.empty() || !almost_rests(model.rods[i].rod, state.rods[i])) continue;
    const double missed = missed_energy(model, state, i);
    if (!(missed > kMissed)) continue;
    warnings.push_back(
        {.code = "coarse_rod",
         .where = "rods." + model.rods[i].name,
         .message = "its sections are too long to follow what bends it: " + three_digits(100.0 * missed) +
                    " % of its elastic energy is missed, so it gives way too little",
         .remedy = "give it more `sections` or a higher `order`",
         .value = missed,
         .limit = kMissed});
  }
  return warnings;
}

}  // namespace sinew
