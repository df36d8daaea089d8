#include "sinew/sim/touched_rods.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "sinew/error/digits.hpp"
#include "sinew/rod/integration.hpp"
#include "sinew/sim/internal.hpp"

namespace sinew {

namespace {

constexpr double kOff = 0.1;       ///< part of the force at the rod's base
constexpr double kNothing = 1e-4;  ///< of the rod's buckling load: nothing to speak of
constexpr double kAtRest = 1e-2;   ///< of its elastic energy: less kinetic energy than that

/// Where stresses are known and between two neighbours of which they are linear: the columns of RodState::internal.
struct Stretch {
  double begin = 0.0, end = 0.0;
  rod::Vec6 from = rod::Vec6::Zero(), to = rod::Vec6::Zero();
  rod::Vec6 at(double t) const { return (1.0 - t) * from + t * to; }
  double place(double t) const { return (1.0 - t) * begin + t * end; }
};

/// Gauss points of [0, 1]: exact for the product of a line and the polynomials of any section.
struct GaussPoint {
  double t, weight;
};
constexpr std::array<GaussPoint, 4> kGauss = {{{0.0694318442029737, 0.1739274225687269},
                                               {0.3300094782075719, 0.3260725774312731},
                                               {0.6699905217924281, 0.3260725774312731},
                                               {0.9305681557970263, 0.1739274225687269}}};

/// What C gains over one section.
double gain_over(const rod::Rod& rod, const rod::Section& section, const std::vector<Stretch>& stretches) {
  std::array<int, 6> degrees;
  degrees.fill(-1);
  for (const rod::Mode& mode : section.modes) degrees[mode.strain] = std::max(degrees[mode.strain], mode.degree);
  Eigen::Matrix<double, 6, rod::kHighestDegree + 1> projected;  // Legendre coefficients of the stresses
  projected.setZero();
  for (const Stretch& own : stretches) {
    for (const GaussPoint& point : kGauss) {
      const rod::LegendreValues P = rod::legendre(section.local(own.place(point.t)));
      const rod::Vec6 stress = point.weight * (own.end - own.begin) / section.length() * own.at(point.t);
      for (int d = 0; d <= rod::kHighestDegree; ++d) projected.col(d) += (2 * d + 1) * P[d] * stress;
    }
  }
  double gain = 0.0;
  for (const Stretch& own : stretches) {
    for (const GaussPoint& point : kGauss) {
      const double s = own.place(point.t);
      const rod::LegendreValues P = rod::legendre(section.local(s));
      const rod::Vec6 stress = own.at(point.t), change = own.to - own.from;
      const rod::Mat6 stiffness = rod::stiffness_at(rod.profile, s);
      for (int i = 0; i < 6; ++i) {
        if (degrees[i] < 0) continue;
        const double followed = projected.row(i).head(degrees[i] + 1) * P.head(degrees[i] + 1);
        gain += point.weight * (stress[i] - followed) / stiffness(i, i) * change[i];
      }
    }
  }
  return gain;
}

/// An impact bends a rod by its inertia, and what its base feels at that moment is not quoted.
bool almost_rests(const rod::Rod& rod, const RodState& state) {
  double kinetic = 0.0, elastic = 0.0;
  for (std::size_t m = 0; m < rod.masses.size(); ++m)
    kinetic += 0.5 * rod.masses[m].mass * state.velocity.col(static_cast<Eigen::Index>(m)).squaredNorm();
  for (int k = 0; k < rod.count(); ++k) {
    const auto q = rod.of_section(state.q, k);
    elastic += 0.5 * q.dot(rod.sections[k].stiffness * q);
  }
  return kinetic <= kAtRest * elastic;
}

}  // namespace

double configurational_error(const Model& model, const State& state, int number) {
  const rod::Rod& rod = model.rods[number].rod;
  const Eigen::MatrixXd& internal = state.rods[number].internal;
  double gained = 0.0, most = 0.0;
  Eigen::Index column = 0;
  std::vector<Stretch> stretches;
  for (const rod::Section& section : rod.sections) {
    stretches.clear();
    for (; column + 1 < internal.cols() && internal(0, column + 1) <= section.end; ++column) {
      const double begin = internal(0, column), end = internal(0, column + 1);
      if (begin < section.begin || !(end > begin)) continue;
      stretches.push_back({begin, end, internal.block<6, 1>(7, column), internal.block<6, 1>(1, column + 1)});
    }
    if (stretches.size() < 2) continue;
    gained += gain_over(rod, section, stretches);
    most = std::max(most, std::abs(gained));
  }
  return most;
}

std::vector<Warning> assess_touched_rods(const Model& model, const State& state) {
  std::vector<Warning> warnings;
  for (int i = 0; i < static_cast<int>(model.rods.size()); ++i) {
    const auto is_it = [i](const ContactSide& side) {
      return side.on.kind == Collider::Kind::rod && side.on.number == i;
    };
    const bool touched = std::any_of(state.contacts.begin(), state.contacts.end(), [&](const ContactState& own) {
      return !own.force.isZero(0.0) && (is_it(own.a) || is_it(own.b));
    });
    const rod::Rod& rod = model.rods[i].rod;
    if (!touched || !almost_rests(rod, state.rods[i])) continue;
    const double base = internal_wrench(model, state, i, 0.0).tail<3>().norm(), little = kNothing * buckling_load(rod);
    if (base < little) continue;
    const double off = configurational_error(model, state, i);
    if (!(off > kOff * base) || off < little) continue;
    warnings.push_back({.code = "touched_force_off",
                        .where = "rods." + model.rods[i].name,
                        .message = "the rod bends where it is touched within a section, which is too long to follow "
                                   "it: the force along the rod is off by up to " +
                                   three_digits(off) + " N",
                        .remedy = "let a section end where it is touched, as at the mouth of a channel, or give the "
                                  "rod more sections or a higher `order`",
                        .value = off / base,
                        .limit = kOff});
  }
  return warnings;
}

}  // namespace sinew
