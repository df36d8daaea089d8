// A massless tendon without friction inside a rod, at an offset from its centreline: its length and derivatives.
//
// The tendon follows x(s) = gamma(s) + R(s) d(s), so its length depends on the strains alone,
//     l(q) = int |u + k x d + d'| ds,      (k, u) the strains of the cross-section, 1 added to the elongation,
// and a tension T adds T dl/dq to the generalised forces. The force on the anchor at its end is part of it.
#pragma once

#include "sinew/rod/rod.hpp"

namespace sinew::rod {

/// Where the tendon runs: at `distance` from the centreline, `angle` from the y axis towards z, both linear from start
/// to end.
struct Tendon {
  double from = 0.0, to = 0.0;                      ///< [m]
  double start_distance = 0.0, end_distance = 0.0;  ///< [m]
  double start_angle = 0.0, end_angle = 0.0;        ///< [rad]

  Vec3 offset(double s) const;
  Vec3 slope(double s) const;  ///< d offset / ds
};

/// Length [m], its gradient over the strain coordinates, and its Hessian: one block a section, laid out as Chain::D.
struct TendonLength {
  double value = 0.0;
  Eigen::VectorXd gradient;
  Eigen::MatrixXd hessian;
};
TendonLength tendon_length(const Rod& rod, const Tendon& tendon, const Eigen::VectorXd& q);

/// Moment and force, in the axes of the cross-section at s, with which a tension of 1 N loads the rod there: (d x t, t)
/// with t the tendon's direction. Zero where it does not run.
Vec6 tendon_wrench(const Rod& rod, const Tendon& tendon, const Eigen::VectorXd& q, int number, double s);

}  // namespace sinew::rod
