#include "sinew/sim/touched_rods.hpp"

#include <algorithm>
#include <cmath>

#include "sinew/error/digits.hpp"
#include "sinew/sim/places.hpp"
#include "sinew/sim/stresses_along.hpp"

namespace sinew {

namespace {

constexpr double kOff = 0.1;  ///< part of the force at the rod's base

/// Integrals between two neighbouring places at which the stresses are known, and between which they are linear, of
/// what strains miss.
struct Missed {
  rod::Vec6 sum = rod::Vec6::Zero();  ///< [of strains, m] by each strain along the rod
  double work = 0.0;                  ///< [N] along the stresses
};
Missed missed_between(const rod::Rod& rod, const RodState& state, const rod::Section& section, Eigen::Index column) {
  const Eigen::MatrixXd& internal = state.internal;
  const double begin = internal(0, column), end = internal(0, column + 1);
  const rod::Vec6 from = stress_between(internal, column, 0.0), to = stress_between(internal, column, 1.0);
  Missed missed;
  for (const GaussPoint& point : kGaussOfThree) {
    const double s = begin + point.t * (end - begin);
    const rod::Vec6 stress = stress_between(internal, column, point.t), strain = rod::deviation(rod, state.q, s);
    const rod::Mat6 stiffness = rod::stiffness_at(rod.profile, s);
    for (const rod::Mode& mode : section.modes) {
      if (mode.degree > 0) continue;  // each strain once
      const int i = mode.strain;
      const double own = point.weight * (stress[i] / stiffness(i, i) - strain[i]);
      missed.sum[i] += own * (end - begin);
      missed.work += own * (to[i] - from[i]);
    }
  }
  return missed;
}

/// Whether a contact presses on the rod in a section, or next to it: contacts follow a rod beyond their pieces.
bool is_pressed_in(const State& state, int rod, const rod::Section& section) {
  const auto presses_there = [&](const ContactSide& side) {
    if (side.on != Collider{Collider::Kind::rod, rod}) return false;
    const double last = side.local.corners() == 2 ? side.abscissae[1] : side.abscissae[0],
                 margin = 0.5 * (last - side.abscissae[0]);
    return side.abscissae[0] - margin <= section.end && last + margin >= section.begin;
  };
  return std::any_of(state.contacts.begin(), state.contacts.end(), [&](const ContactState& contact) {
    return !contact.force.isZero(0.0) && (presses_there(contact.a) || presses_there(contact.b));
  });
}

}  // namespace

double configurational_error(const Model& model, const State& state, int number) {
  const rod::Rod& rod = model.rods[number].rod;
  const Eigen::MatrixXd& internal = state.rods[number].internal;
  double error = 0.0, largest = 0.0;
  Eigen::Index column = 0;
  for (const rod::Section& section : rod.sections) {
    const bool pressed = is_pressed_in(state, number, section);
    Missed all;
    rod::Vec6 change = rod::Vec6::Zero();
    for (; column + 1 < internal.cols() && internal(0, column + 1) <= section.end; ++column) {
      const double begin = internal(0, column), end = internal(0, column + 1);
      if (!pressed || begin < section.begin || end <= begin) continue;
      const Missed own = missed_between(rod, state.rods[number], section, column);
      all.sum += own.sum;
      all.work += own.work;
      change += internal.block<6, 1>(1, column + 1) - internal.block<6, 1>(7, column);
    }
    error += all.work - all.sum.dot(change) / section.length();
    largest = std::max(largest, std::abs(error));
  }
  return largest;
}

std::vector<Warning> assess_touched_rods(const Model& model, const State& state) {
  std::vector<Warning> warnings;
  for (int i = 0; i < static_cast<int>(model.rods.size()); ++i) {
    if (!is_pressed(state, {Collider::Kind::rod, i})) continue;
    const rod::Rod& rod = model.rods[i].rod;
    // (An impact bends a rod by its inertia, and what its base feels at that moment is not quoted.)
    if (!almost_rests(rod, state.rods[i])) continue;
    const double base = internal_wrench(model, state, i, 0.0).tail<3>().norm(),
                 negligible = kNegligibleForce * buckling_load(rod);
    if (base < negligible) continue;
    const double error = configurational_error(model, state, i);
    if (!(error > kOff * base) || error < negligible) continue;
    warnings.push_back({.code = "touched_force_off",
                        .where = "rods." + model.rods[i].name,
                        .message = "the rod bends where it is touched, within a section that is too long to follow it: "
                                   "the force along the rod is off by up to " +
                                   three_digits(error) + " N",
                        .remedy = "let a section end where it is touched, as at the mouth of a channel, or give the "
                                  "rod more sections or a higher `order`",
                        .value = error / base,
                        .limit = kOff});
  }
  return warnings;
}

}  // namespace sinew
