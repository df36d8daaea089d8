#include "sinew/rod/section.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace sinew::rod {

namespace {

using std::numbers::pi;

/// Odd terms of the rectangle's series; the next is below 1e-20 of the first for every ratio of the sides.
constexpr int kLastTerm = 25;

double square(double value) { return value * value; }

/// Round sections differ in the hole only.
Tube round(const Circle& circle) { return {circle.radius, 0.0}; }

SectionProperties properties_of(const Tube& tube, double poisson) {
  const double radii = square(tube.outer) + square(tube.inner);
  const double hole = square(tube.inner / tube.outer);  // m^2
  const double ring = square(1.0 + hole);
  SectionProperties result;
  result.area = pi * (tube.outer - tube.inner) * (tube.outer + tube.inner);
  result.second_y = result.second_z = 0.25 * result.area * radii;
  result.torsion = 0.5 * result.area * radii;
  result.shear_y = result.shear_z =
      6.0 * (1.0 + poisson) * ring / ((7.0 + 6.0 * poisson) * ring + (20.0 + 12.0 * poisson) * hole);
  return result;
}

SectionProperties properties_of(const Circle& circle, double poisson) { return properties_of(round(circle), poisson); }

/// Shear along the half axis `along`.
double ellipse_shear_factor(double along, double across, double poisson) {
  const double a2 = square(along), b2 = square(across);
  return 12.0 * (1.0 + poisson) * a2 * (3.0 * a2 + b2) /
         ((40.0 + 37.0 * poisson) * a2 * a2 + (16.0 + 10.0 * poisson) * a2 * b2 + poisson * b2 * b2);
}

SectionProperties properties_of(const Ellipse& ellipse, double poisson) {
  const double y2 = square(ellipse.y), z2 = square(ellipse.z);
  SectionProperties result;
  result.area = pi * ellipse.y * ellipse.z;
  result.second_y = 0.25 * result.area * z2;
  result.second_z = 0.25 * result.area * y2;
  result.torsion = result.area * y2 * z2 / (y2 + z2);
  result.shear_y = ellipse_shear_factor(ellipse.y, ellipse.z, poisson);
  result.shear_z = ellipse_shear_factor(ellipse.z, ellipse.y, poisson);
  return result;
}

/// Saint-Venant's J. The slow part of the series, tanh = 1, is summed in closed form: 31/32 zeta(5).
double rectangle_torsion(double longer, double shorter) {
  constexpr double kSumOfFifthPowers = 31.0 / 32.0 * 1.0369277551433699263;
  const double step = pi * longer / shorter;
  double sum = kSumOfFifthPowers;
  for (int n = 1; n <= kLastTerm; n += 2) sum -= 2.0 / ((std::exp(n * step) + 1.0) * std::pow(n, 5));  // 1 - tanh
  const double edge = 192.0 / std::pow(pi, 5) * shorter / longer * sum;
  return longer * shorter * square(shorter) / 3.0 * (1.0 - edge);
}

/// Largest shear stress over G times twist, at the middle of the longer side.
double rectangle_shear_per_twist(double longer, double shorter) {
  double sum = 0.0;
  for (int n = 1; n <= kLastTerm; n += 2) sum += 1.0 / (n * n * std::cosh(0.5 * n * pi * longer / shorter));
  return shorter * (1.0 - 8.0 / square(pi) * sum);
}

SectionProperties properties_of(const Rectangle& rectangle, double poisson) {
  const auto [shorter, longer] = std::minmax({rectangle.y, rectangle.z});
  SectionProperties result;
  result.area = rectangle.y * rectangle.z;
  result.second_y = result.area * square(rectangle.z) / 12.0;
  result.second_z = result.area * square(rectangle.y) / 12.0;
  result.torsion = rectangle_torsion(longer, shorter);
  result.shear_y = result.shear_z = 10.0 * (1.0 + poisson) / (12.0 + 11.0 * poisson);
  return result;
}

/// The box around the section, from the axis.
struct HalfExtents {
  double y, z;
};

HalfExtents half_extents(const Circle& circle) { return {circle.radius, circle.radius}; }
HalfExtents half_extents(const Tube& tube) { return {tube.outer, tube.outer}; }
HalfExtents half_extents(const Ellipse& ellipse) { return {ellipse.y, ellipse.z}; }
HalfExtents half_extents(const Rectangle& rectangle) { return {0.5 * rectangle.y, 0.5 * rectangle.z}; }

/// The largest of |y/e_y u + z/e_z v| over the rim, e the half extents: at a corner, or on an ellipse where both peak
/// together, (y/e_y, z/e_z) being a unit vector.
double largest_over_rim(const Rectangle&, double u, double v) { return std::abs(u) + std::abs(v); }
template <class Rounded>
double largest_over_rim(const Rounded&, double u, double v) {
  return std::hypot(u, v);
}

/// Largest Saint-Venant shear stress over G times twist: that of a circle, at the end of an ellipse's minor axis.
double shear_per_twist(const Circle& circle) { return circle.radius; }
double shear_per_twist(const Tube& tube) { return tube.outer; }
double shear_per_twist(const Ellipse& ellipse) {
  const auto [minor, major] = std::minmax({ellipse.y, ellipse.z});
  return 2.0 * square(major) * minor / (square(major) + square(minor));
}
double shear_per_twist(const Rectangle& rectangle) {
  const auto [shorter, longer] = std::minmax({rectangle.y, rectangle.z});
  return rectangle_shear_per_twist(longer, shorter);
}

Circle blend_of(const Circle& a, const Circle& b, double t) { return {std::lerp(a.radius, b.radius, t)}; }
Tube blend_of(const Tube& a, const Tube& b, double t) {
  return {std::lerp(a.outer, b.outer, t), std::lerp(a.inner, b.inner, t)};
}
Ellipse blend_of(const Ellipse& a, const Ellipse& b, double t) {
  return {std::lerp(a.y, b.y, t), std::lerp(a.z, b.z, t)};
}
Rectangle blend_of(const Rectangle& a, const Rectangle& b, double t) {
  return {std::lerp(a.y, b.y, t), std::lerp(a.z, b.z, t)};
}

/// Everything but the shear factors, which alone need Poisson's ratio.
SectionProperties geometry(const Shape& shape) { return properties(shape, 0.0); }

}  // namespace

SectionProperties properties(const Shape& shape, double poisson) {
  return std::visit([&](const auto& one) { return properties_of(one, poisson); }, shape);
}

Vec6 section_stiffness(const Shape& shape, double young, double poisson) {
  const SectionProperties p = properties(shape, poisson);
  const double G = young / (2.0 * (1.0 + poisson));
  Vec6 stiffness;
  stiffness << G * p.torsion, young * p.second_y, young * p.second_z, young * p.area, p.shear_y * G * p.area,
      p.shear_z * G * p.area;
  return stiffness;
}

Vec6 section_viscosity(const Shape& shape, double shear_viscosity) {
  const SectionProperties p = geometry(shape);
  Vec6 viscosity;
  viscosity << p.torsion, 3.0 * p.second_y, 3.0 * p.second_z, 3.0 * p.area, p.area, p.area;
  return shear_viscosity * viscosity;
}

LineInertia line_inertia(const Shape& shape, double density) {
  const SectionProperties p = geometry(shape);
  return {density * p.area, density * p.second_y, density * p.second_z};
}

SectionStress section_stress(const Shape& shape, const Vec6& internal) {
  const SectionProperties p = geometry(shape);
  return std::visit(
      [&](const auto& one) {
        const HalfExtents extents = half_extents(one);
        SectionStress stress;
        stress.axial = internal[3] / p.area;
        stress.bending =
            largest_over_rim(one, internal[2] * extents.y / p.second_z, internal[1] * extents.z / p.second_y);
        stress.torsion = std::abs(internal[0]) / p.torsion * shear_per_twist(one);
        const double normal = std::abs(stress.axial) + stress.bending;
        const double shear = stress.torsion + std::hypot(internal[4], internal[5]) / p.area;
        stress.von_mises = std::sqrt(square(normal) + 3.0 * square(shear));
        return stress;
      },
      shape);
}

double outer_radius(const Shape& shape) {
  const HalfExtents extents = std::visit([](const auto& one) { return half_extents(one); }, shape);
  if (std::holds_alternative<Rectangle>(shape)) return std::hypot(extents.y, extents.z);
  return std::max(extents.y, extents.z);
}

double least_outer_radius(const Shape& shape) {
  const HalfExtents extents = std::visit([](const auto& one) { return half_extents(one); }, shape);
  return std::min(extents.y, extents.z);
}

Shape blend(const Shape& a, const Shape& b, double t) {
  return std::visit([&]<class Kind>(const Kind& from) { return Shape(blend_of(from, std::get<Kind>(b), t)); }, a);
}

}  // namespace sinew::rod
