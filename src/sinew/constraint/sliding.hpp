// A point of a solid that stays on a rod's centreline and slides along it (II-C.2).
//
// With P(x) the point and gamma(q, s) the curve, the engine keeps the abscissa s as an unknown:
//     c = P(x) - gamma(q, s) = 0          three rows,         lambda . gamma_s = 0       no friction,
// which is the paper's pair of rows  delta = N^T (P - gamma)  with s eliminated. The engine's rows are put together in
// sim/reduced (`add_points`); here are the projection, and the paper's rows, which tests compare with them.
#pragma once

#include "sinew/rod/kinematics.hpp"

namespace sinew::constraint {

using Vec3 = Eigen::Vector3d;

/// The abscissa of the point of the curve nearest to P on the branch that `s` is on: from s, Newton steps on
/// (P - gamma) . gamma_s = 0, each held within half a section's length, so it never jumps to another branch. The result
/// may lie beyond the ends: the first section is continued, beyond the tip the rod goes on straight.
double project(const rod::Configuration& shape, double s, const Vec3& P);

/// delta = N^T (P - gamma(s)) [m] and its derivatives at the projected abscissa; N spans the normal plane of the curve
/// at s. The derivative of s drops out because N^T gamma_s = 0 and the gap itself is small.
struct SlidingRows {
  Eigen::Matrix<double, 3, 2> N;
  Eigen::Vector2d delta;
  Eigen::Matrix<double, 2, Eigen::Dynamic> J;  ///< d delta / dq = -N^T gamma_q; with respect to P it is N^T
};
SlidingRows sliding_rows(const rod::Configuration& shape, double s, const Vec3& P);

/// Distance between P and the rod in the normal plane at a point of it [m]: what the convergence of a step is judged
/// by.
double violation(const rod::CurvePoint& point, const Vec3& P);

}  // namespace sinew::constraint
