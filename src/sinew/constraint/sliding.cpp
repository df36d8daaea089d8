#include "sinew/constraint/sliding.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

namespace sinew::constraint {

double project(const rod::Configuration& shape, double s, const Vec3& P) {
  const double length = shape.rod->length();
  const auto beyond_tip = [&] {  // the rod goes on straight
    const rod::CentrePoint tip = rod::centre_point(shape, length);
    return length + (P - tip.position).dot(tip.derivative) / tip.derivative.squaredNorm();
  };
  if (s > length) {
    const double ahead = beyond_tip();
    if (ahead >= length) return ahead;
    s = length;
  }
  for (int iteration = 0; iteration < 50; ++iteration) {
    const rod::CentrePoint point = rod::centre_point(shape, s);
    const Vec3 gap = P - point.position;
    const double slope = gap.dot(point.derivative);
    const double speed2 = point.derivative.squaredNorm();
    // Newton's curvature |gamma_s|^2 - gap . gamma_ss, kept away from zero near a centre of curvature.
    const double curvature = std::max(speed2 - gap.dot(point.second), 0.5 * speed2);
    const double reach = 0.5 * shape.rod->sections[point.section].length();
    const double ds = std::clamp(slope / curvature, -reach, reach);
    if (s == length && ds > 0.0) return beyond_tip();
    s = std::min(s + ds, length);
    if (std::abs(ds) <= 1e-15 * length) break;
  }
  return s;
}

SlidingRows sliding_rows(const rod::Configuration& shape, double s, const Vec3& P) {
  const rod::CurvePoint point = rod::curve_point(shape, s);
  const Vec3 t = point.derivative.normalized();
  SlidingRows rows;
  // The section's own y and z, made normal to the curve (they are already so without shear).
  rows.N.col(0) = (point.R.col(1) - t.dot(point.R.col(1)) * t).normalized();
  rows.N.col(1) = t.cross(rows.N.col(0));
  rows.delta = rows.N.transpose() * (P - point.position);
  rows.J = -rows.N.transpose() * rod::position_jacobian(shape, s);
  return rows;
}

double violation(const rod::CurvePoint& point, const Vec3& P) {
  const Vec3 gap = P - point.position, t = point.derivative.normalized();
  return (gap - t.dot(gap) * t).norm();
}

}  // namespace sinew::constraint
