#include "sinew/sim/sliding_rods.hpp"

#include <algorithm>
#include <cmath>

#include "sinew/error/digits.hpp"
#include "sinew/sim/internal.hpp"

namespace sinew {

namespace {

constexpr double kRipple = 0.1;  ///< part of the force at the rod's base that may swing
constexpr double kHeldByPairs =
    0.2;                        ///< part of the pressing that may come of neighbours that press against each other
constexpr double kRubs = 0.05;  ///< of the force at the base: less friction does not matter

const rod::Section& section_at(const rod::Rod& rod, double s) {
  return *std::find_if(rod.sections.begin(), rod.sections.end() - 1,
                       [s](const rod::Section& own) { return s <= own.end; });
}

int bending_order(const rod::Section& section) {
  int order = 0;
  for (const rod::Mode& mode : section.modes) {
    if (mode.strain == 1 || mode.strain == 2) order = std::max(order, mode.degree);
  }
  return order;
}

/// Elastic energy of bending per length [N].
double bending_density(const Model& model, const State& state, int number, double s) {
  const rod::Vec6 wrench = internal_wrench(model, state, number, s);
  const rod::Mat6 stiffness = rod::stiffness_at(model.rods[number].rod.profile, s);
  return 0.5 * (wrench[1] * wrench[1] / stiffness(1, 1) + wrench[2] * wrench[2] / stiffness(2, 2));
}

/// [N] How much it changes about a point, over the distance between two: all of it at the end of a channel.
double change_of_density(const Model& model, const State& state, int number, double s, double spacing) {
  const double length = model.rods[number].rod.length();
  const auto beside = [&](double shift) {
    return bending_density(model, state, number, std::clamp(s + shift, 0.0, length));
  };
  return std::abs(beside(0.5 * spacing) - beside(-0.5 * spacing));
}

}  // namespace

double SlideResolution::equivalent() const { return std::ldexp(sections, order); }

SlideResolution slide_resolution(const rod::Rod& rod, const std::vector<double>& abscissae) {
  SlideResolution coarsest{INFINITY, INFINITY, 0};
  double closest = INFINITY;
  for (std::size_t i = 1; i < abscissae.size(); ++i) {
    const double spacing = abscissae[i] - abscissae[i - 1];
    const rod::Section& section = section_at(rod, 0.5 * (abscissae[i] + abscissae[i - 1]));
    const SlideResolution here{spacing, spacing / section.length(), bending_order(section)};
    if (!(spacing > 0.0)) continue;
    closest = std::min(closest, spacing);
    if (here.equivalent() < coarsest.equivalent()) coarsest = here;
  }
  coarsest.spacing = closest;
  return coarsest;
}

double equivalent_sections(const Model& model, int coupling) {
  const CouplingFacts& facts = model.couplings[coupling];
  const SlideResolution coarsest{facts.spacing, facts.sections, facts.order};
  const auto point = std::find_if(model.points.begin(), model.points.end(),
                                  [coupling](const PointModel& own) { return own.coupling == coupling; });
  if (facts.rod < 0 || point == model.points.end() || !std::isfinite(facts.spacing)) return coarsest.equivalent();
  double young = 0.0;
  for (const solid::Material& material : model.solids[point->solid].body.materials)
    young = std::max(young, solid::young(solid::lame(material.law)));
  const rod::Mat6 stiffness = rod::stiffness_at(model.rods[facts.rod].rod.profile, 0.0);
  const double spread = young > 0.0 ? std::pow(4.0 * std::min(stiffness(1, 1), stiffness(2, 2)) / young, 0.25) : 0.0;
  return coarsest.equivalent() * std::max(1.0, spread / facts.spacing);
}

double ripple_of(double equivalent) { return 0.82 * std::pow(equivalent, -3.2); }

double pressed_by_moment(double spacing) { return 2.0 * std::sqrt(3.0) / spacing; }

std::vector<Warning> assess_sliding_rods(const Model& model, const State& state) {
  std::vector<Warning> warnings;
  for (std::size_t i = 0; i < model.couplings.size(); ++i) {
    const CouplingFacts& facts = model.couplings[i];
    if (facts.rod < 0) continue;
    const double equivalent = equivalent_sections(model, static_cast<int>(i));
    if ((!facts.rubs && equivalent >= kFewSections)) continue;
    // (No list is made: most steps have nothing to warn of, and ask for no memory.)
    double change = 0.0, pressed = 0.0, against = 0.0, friction = 0.0;
    Vec3 before = Vec3::Zero();
    for (std::size_t k = 0; k < model.points.size(); ++k) {
      const PointModel& point = model.points[k];
      if (point.coupling != static_cast<int>(i) || point.unknown < 0 || !state.points[k].on) continue;
      change = std::max(change, change_of_density(model, state, facts.rod, state.points[k].s, facts.spacing));
      const Vec3 force = state.lambda.segment<3>(point.row);
      pressed += force.norm();
      friction += point.friction * force.norm();
      if (force.dot(before) < 0.0) against += std::min(before.norm(), force.norm());
      before = force;
    }
    const rod::Rod& rod = model.rods[facts.rod].rod;
    const double base = internal_wrench(model, state, facts.rod, 0.0).tail<3>().norm();
    const double swing = ripple_of(equivalent) * change;
    if (equivalent < kFewSections && swing > kRipple * base && swing > kNegligibleForce * buckling_load(rod)) {
      warnings.push_back(
          {.code = "sliding_force_ripples",
           .where = "rods." + model.rods[facts.rod].name,
           .message = "the rod bends where it slides, and with " + three_digits(facts.sections) +
                      " sections of order " + std::to_string(facts.order) +
                      " between two points the force along it swings by about " + three_digits(swing) + " N",
           .remedy = "take four sections between two points at order 0, two at order 1 or one at order 2",
           .value = swing / base,
           .limit = kRipple});
    }
    if (against > kHeldByPairs * pressed && friction > kRubs * base) {
      warnings.push_back({.code = "friction_of_points",
                          .where = "couplings." + std::to_string(i),
                          .message = "neighbouring points hold the rod's bending stiffness by forces against each "
                                     "other, and the friction of these grows as 1 / spacing (" +
                                     three_digits(1e3 * facts.spacing) + " mm)",
                          .remedy = "give points no closer than the channel's clearance holds the rod, or a rod that "
                                    "bends more easily",
                          .value = against / pressed,
                          .limit = kHeldByPairs});
    }
  }
  return warnings;
}

}  // namespace sinew
