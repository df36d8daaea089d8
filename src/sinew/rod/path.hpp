// Laying a rod along a path in space: the smooth curve through given points, and the strains that follow it.
#pragma once

#include "sinew/rod/rod.hpp"

namespace sinew::rod {

/// A smooth curve through points, straight between collinear ones (cubic Hermite pieces, Catmull-Rom tangents on chord
/// lengths), measured by arc length.
class Path {
 public:
  /// At least two points [m], neighbours distinct.
  explicit Path(const std::vector<Vec3>& points);
  double length() const { return arc_.back(); }
  Vec3 position(double s) const;
  Vec3 tangent(double s) const;

 private:
  std::vector<double> arc_;  ///< arc length at the samples
  std::vector<Vec3> x_, t_;  ///< positions and unit tangents at the samples
};

/// Where a rod laid along a path starts, and its strains.
struct Layout {
  Placement base;                     ///< x along the path, y from `up`, z = x cross y
  std::vector<Coefficients> strains;  ///< of each section: bending only
  double deviation = 0.0;  ///< [m] largest distance between the path and the rod at the points that were fitted
};

/// Frame with x along the tangent and y along the part of `up` across it; where `up` is parallel, along that of (0, 1,
/// 0), and of (0, 0, 1) if that is parallel too.
Mat3 frame_along(const Vec3& tangent, const Vec3& up);

/// The bending strains, polynomials of the given degree in each section, that follow the path: from the mean curvature
/// of each section in a frame carried along by parallel transport, corrected so that the section ends (and degree
/// points between them) lie on the path as closely as so many strains can. `ends` run from 0 to the path's length.
Layout lay_along(const Path& path, const std::vector<double>& ends, const Vec3& up, int degree = 0);

}  // namespace sinew::rod
