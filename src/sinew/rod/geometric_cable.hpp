// The paper's baseline: a massless cable without stiffness, straight between the points it runs through.
//
// Coordinates z = (d, z_1 .. z_m): how far its base is pulled out, and the points, which sliding rows hold on the
// solid. Its total length, from the base through the points to the last one, stays what it was: one row, whose
// multiplier is the tension.
#pragma once

#include "sinew/rod/rod.hpp"

namespace sinew::rod {

struct GeometricCable {
  int points = 0;
  double length = 0.0;    ///< [m] kept constant
  double rounding = 0.0;  ///< [m] segments are rounded off below this: a first point may start at the base
  int coordinates() const { return 1 + 3 * points; }
};

/// Length of the polyline from the base, moved out by d along -x of its placement, through the points; its gradient and
/// Hessian with respect to z.
struct CableLength {
  double value = 0.0;
  Eigen::VectorXd gradient;
  Eigen::MatrixXd hessian;  ///< zero beyond `kCableBand` off its diagonal: only neighbours share a segment
};
inline constexpr int kCableBand = 5;
CableLength cable_length(const GeometricCable& cable, const Placement& base, const Eigen::VectorXd& z);
/// The same in the memory of an earlier one.
void cable_length(const GeometricCable& cable, const Placement& base, const Eigen::VectorXd& z, CableLength& length);

}  // namespace sinew::rod
