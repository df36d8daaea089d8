#include "sinew/rod/profile.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace sinew::rod {

namespace {

/// Nodes and weights by Newton's method on the Legendre polynomial.
GaussRule make_rule(int n) {
  GaussRule rule;
  for (int i = n - 1; i >= 0; --i) {
    double x = std::cos(std::numbers::pi * (i + 0.75) / (n + 0.5)), slope = 1.0;
    for (int iteration = 0; iteration < 100; ++iteration) {
      double before = 1.0, now = x;
      for (int k = 2; k <= n; ++k) {
        const double next = ((2.0 * k - 1.0) * x * now - (k - 1.0) * before) / k;
        before = now;
        now = next;
      }
      slope = n * (x * now - before) / (x * x - 1.0);
      const double dx = now / slope;
      x -= dx;
      if (std::abs(dx) < 1e-16) break;
    }
    rule.node.push_back(0.5 * (1.0 + x));
    rule.weight.push_back(1.0 / ((1.0 - x * x) * slope * slope));
  }
  return rule;
}

Shape shape_at(const Part& part, const SolidPart& solid, double s) {
  return blend(solid.start, solid.end, std::clamp((s - part.begin) / (part.end - part.begin), 0.0, 1.0));
}

}  // namespace

const GaussRule& gauss_rule(int points) {
  static const std::array<GaussRule, 11> rules = [] {
    std::array<GaussRule, 11> all;
    for (int n = 1; n <= 10; ++n) all[static_cast<std::size_t>(n)] = make_rule(n);
    return all;
  }();
  return rules.at(static_cast<std::size_t>(points));
}

const Part& part_at(const Profile& profile, double s) {
  for (const Part& part : profile) {
    if (s < part.end) return part;
  }
  return profile.back();
}

Mat6 stiffness_at(const Profile& profile, double s) {
  const Part& part = part_at(profile, s);
  if (const auto* solid = std::get_if<SolidPart>(&part.made))
    return section_stiffness(shape_at(part, *solid, s), solid->young, solid->poisson).asDiagonal();
  return std::get<GivenPart>(part.made).stiffness;
}

Mat6 damping_at(const Profile& profile, double s) {
  const Part& part = part_at(profile, s);
  Mat6 damping = part.damping * stiffness_at(profile, s);
  if (const auto* solid = std::get_if<SolidPart>(&part.made); solid && solid->viscosity > 0.0)
    damping.diagonal() += section_viscosity(shape_at(part, *solid, s), solid->viscosity);
  return damping;
}

LineInertia inertia_at(const Profile& profile, double s) {
  const Part& part = part_at(profile, s);
  if (const auto* solid = std::get_if<SolidPart>(&part.made))
    return line_inertia(shape_at(part, *solid, s), solid->density);
  const auto& given = std::get<GivenPart>(part.made);
  const double about = 0.25 * given.line_density * given.radius * given.radius;
  return {given.line_density, about, about};
}

double radius_at(const Profile& profile, double s) {
  const Part& part = part_at(profile, s);
  if (const auto* solid = std::get_if<SolidPart>(&part.made)) return outer_radius(shape_at(part, *solid, s));
  return std::get<GivenPart>(part.made).radius;
}

double inner_radius_at(const Profile& profile, double s) {
  const Part& part = part_at(profile, s);
  if (const auto* solid = std::get_if<SolidPart>(&part.made)) return least_outer_radius(shape_at(part, *solid, s));
  return std::get<GivenPart>(part.made).radius;
}

SectionStress stress_at(const Profile& profile, double s, const Vec6& internal) {
  const Part& part = part_at(profile, s);
  if (const auto* solid = std::get_if<SolidPart>(&part.made))
    return section_stress(shape_at(part, *solid, s), internal);
  return section_stress(Circle{std::get<GivenPart>(part.made).radius}, internal);
}

}  // namespace sinew::rod
