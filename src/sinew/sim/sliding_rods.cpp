#include "sinew/sim/sliding_rods.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

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

/// Order of a bending strain (1, 2) there; -1 where the rod has none.
int bending_order(const rod::Section& section, int strain) {
  int order = -1;
  for (const rod::Mode& mode : section.modes) {
    if (mode.strain == strain) order = std::max(order, mode.degree);
  }
  return order;
}

/// Of the strain that is resolved worse.
int bending_order(const rod::Section& section) {
  const int y = bending_order(section, 1), z = bending_order(section, 2);
  return std::max(0, y < 0 ? z : z < 0 ? y : std::min(y, z));
}

/// Elastic energy of bending per length [N] about one axis (1, 2).
double bending_density(const Model& model, const State& state, int number, int strain, double s) {
  const double moment = internal_wrench(model, state, number, s)[strain];
  return 0.5 * moment * moment / rod::stiffness_at(model.rods[number].rod.profile, s)(strain, strain);
}

/// [N] How much it changes about a point, over the distance between two: all of it at the end of a channel.
double change_of_density(const Model& model, const State& state, int number, int strain, double s, double spacing) {
  const double length = model.rods[number].rod.length();
  const auto beside = [&](double shift) {
    return bending_density(model, state, number, strain, std::clamp(s + shift, 0.0, length));
  };
  return std::abs(beside(0.5 * spacing) - beside(-0.5 * spacing));
}

/// [Pa] Young's modulus of what a point is held by; infinite where its nodes are.
double softness_about(const SolidModel& solid, const solid::EmbeddedPoint& where) {
  const auto nodes = solid.body.cells[where.element].nodes();
  const auto is_held = [&](int node) {
    return solid.body.unknown(0, node) < 0 && solid.body.unknown(1, node) < 0 && solid.body.unknown(2, node) < 0;
  };
  if (std::all_of(nodes.begin(), nodes.end(), is_held)) return INFINITY;
  double young = 0.0;
  for (const solid::Material& material : solid.body.materials)
    young = std::max(young, solid::young(solid::lame(material.law)));
  return young;
}

/// Over how many times the distance of two points a soft solid spreads what they hold of a bending stiffness.
double spread_of(double stiffness, double young, double spacing) {
  return young > 0.0 ? std::max(1.0, std::pow(4.0 * stiffness / young, 0.25) / spacing) : 1.0;
}

/// The interval between two points of a rod where its force swings most.
struct Swing {
  double force = 0.0;  ///< [N]
  double sections = 0.0;
  int order = 0;
};

/// The interval between two points that is pushed beyond what it bears straight and whose sections follow that least.
struct Waves {
  double part = 0.0;    ///< of half a wave that a section is long, two of order 1 for one of order 0
  double half = 0.0;    ///< [m] half a wave
  double push = 0.0;    ///< [N]
  double length = 0.0;  ///< [m] of a section there
};

/// Between two points, pinned, a rod of bending stiffness B bears N = pi^2 B / spacing^2 straight. Beyond that it bends
/// in waves, half of one pi sqrt(B / N) long.
Waves waves_between(const Model& model, const State& state, int number, double middle, double spacing) {
  const rod::Rod& rod = model.rods[number].rod;
  const double push = -internal_wrench(model, state, number, middle)[3];
  if (!(push > 0.0)) return {};
  const rod::Section& section = section_at(rod, middle);
  const rod::Mat6 stiffness = rod::stiffness_at(rod.profile, middle);
  Waves worst;
  for (const int strain : {1, 2}) {
    const int order = bending_order(section, strain);
    const double half = std::numbers::pi * std::sqrt(stiffness(strain, strain) / push),
                 part = std::ldexp(section.length(), -order) / half;
    if (order >= 0 && half < spacing && part > worst.part) worst = {part, half, push, section.length()};
  }
  return worst;
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
  const double young = softness_about(model.solids[point->solid], point->where);
  const rod::Mat6 stiffness = rod::stiffness_at(model.rods[facts.rod].rod.profile, point->abscissa);
  return coarsest.equivalent() * spread_of(std::min(stiffness(1, 1), stiffness(2, 2)), young, facts.spacing);
}

double ripple_of(double equivalent) { return 0.82 * std::pow(equivalent, -3.2); }

double pressed_by_moment(double spacing) { return 2.0 * std::sqrt(3.0) / spacing; }

std::vector<Warning> assess_sliding_rods(const Model& model, const State& state) {
  std::vector<Warning> warnings;
  for (int number = 0; number < static_cast<int>(model.rods.size()); ++number) {
    const rod::Rod& rod = model.rods[number].rod;
    // (No list is made: most steps have nothing to warn of, and ask for no memory.)
    double pressed = 0.0, against = 0.0, friction = 0.0, rubs_most = 0.0, closest = INFINITY;
    int rubbing = -1;
    Swing most;
    Waves coarsest;
    Vec3 before = Vec3::Zero();
    int last = -1;
    for (const int k : model.rods[number].slides) {
      if (!state.points[k].on) continue;
      const PointModel& point = model.points[k];
      const double s = state.points[k].s, spacing = last >= 0 ? s - state.points[last].s : 0.0;
      const Vec3 force = state.lambda.segment<3>(point.row);
      const double rubs = point.friction * force.norm();
      pressed += force.norm();
      friction += rubs;
      if (rubs > rubs_most) {
        rubs_most = rubs;
        rubbing = point.coupling;
      }
      if (force.dot(before) < 0.0) against += std::min(before.norm(), force.norm());
      before = force;
      const int one = std::exchange(last, k);
      if (!(spacing > 0.0)) continue;
      closest = std::min(closest, spacing);
      const double from = std::max(0.0, state.points[one].s), middle = 0.5 * (from + s);
      const rod::Section& section = section_at(rod, middle);
      const double sections = spacing / section.length();
      if (const Waves here = waves_between(model, state, number, middle, spacing); here.part > coarsest.part)
        coarsest = here;
      for (const int strain : {1, 2}) {
        const int order = bending_order(section, strain);
        if (order < 0 || std::ldexp(sections, order) >= kFewSections) continue;
        const double stiffness = rod::stiffness_at(rod.profile, middle)(strain, strain),
                     young = softness_about(model.solids[point.solid], point.where),
                     equivalent = std::ldexp(sections, order) * spread_of(stiffness, young, spacing);
        if (equivalent >= kFewSections) continue;
        const double change = std::max(change_of_density(model, state, number, strain, from, spacing),
                                       change_of_density(model, state, number, strain, s, spacing)),
                     swing = ripple_of(equivalent) * change;
        if (swing > most.force) most = {swing, sections, order};
      }
    }
    if (coarsest.part > kLongInWaves) {
      warnings.push_back(
          {.code = "coarse_under_push",
           .where = "rods." + model.rods[number].name,
           .message = "it is pushed with " + three_digits(coarsest.push) +
                      " N, more than it bears straight between two points, and bends in waves of " +
                      three_digits(2e3 * coarsest.half) + " mm, which sections of " +
                      three_digits(1e3 * coarsest.length) + " mm do not follow: it seems stiffer than it is",
           .remedy = "take sections of " + three_digits(1e3 * coarsest.length * kLongInWaves / coarsest.part) +
                     " mm or shorter, or pull it",
           .value = coarsest.part,
           .limit = kLongInWaves});
    }
    if (last < 0 || (most.force == 0.0 && friction == 0.0)) continue;
    const double base = internal_wrench(model, state, number, 0.0).tail<3>().norm(),
                 negligible = kNegligibleForce * buckling_load(rod);
    if (most.force > kRipple * base && most.force > negligible) {
      warnings.push_back(
          {.code = "sliding_force_ripples",
           .where = "rods." + model.rods[number].name,
           .message = "the rod bends where it slides, and with " + three_digits(most.sections) + " sections of order " +
                      std::to_string(most.order) + " between two points the force along it swings by about " +
                      three_digits(most.force) + " N",
           .remedy = "take four sections between two points at order 0, two at order 1 or one at order 2, wherever the "
                     "rod comes through them",
           .value = most.force / std::max(base, negligible),
           .limit = kRipple});
    }
    if (against > kHeldByPairs * pressed && friction > kRubs * base) {
      warnings.push_back({.code = "friction_of_points",
                          .where = "couplings." + std::to_string(rubbing),
                          .message = "neighbouring points hold the rod's bending stiffness by forces against each "
                                     "other, and the friction of these grows as 1 / spacing (" +
                                     three_digits(1e3 * closest) + " mm)",
                          .remedy = "give points no closer than the channel's clearance holds the rod, or a rod that "
                                    "bends more easily",
                          .value = against / pressed,
                          .limit = kHeldByPairs});
    }
  }
  return warnings;
}

}  // namespace sinew
