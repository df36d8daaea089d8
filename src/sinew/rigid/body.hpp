// One rigid body over a step: backward Euler of Newton's and Euler's equations.
#pragma once

#include <Eigen/Core>

namespace sinew::rigid {

using Vec3 = Eigen::Vector3d;
using Mat3 = Eigen::Matrix3d;
using Vec6 = Eigen::Matrix<double, 6, 1>;
using Mat6 = Eigen::Matrix<double, 6, 6>;

struct Body {
  double mass = 0.0;                ///< [kg] > 0
  Mat3 inertia = Mat3::Identity();  ///< [kg m^2] about the centre of mass, in the body's axes
};

/// Where a body is and how it moves.
struct Motion {
  Vec3 p = Vec3::Zero();      ///< [m] centre of mass
  Mat3 R = Mat3::Identity();  ///< its axes, as columns
  Vec3 v = Vec3::Zero();      ///< [m/s]
  Vec3 w = Vec3::Zero();      ///< [rad/s] in its own axes
};

/// Velocities at the end of a step that a body ends at (p, R): v = (p - p_0) rate, R = R_0 exp(w / rate).
void set_velocities(const Motion& start, double rate, Motion& end);

/// Where it comes to in a time [s] with the velocities that it has: p + t v, R exp(t w).
void move_on(const Motion& start, double time, Motion& end);

/// Left minus right side of
///     m (v - v_0) rate = m g,      I (w - w_0) rate + w x I w = 0   (in the body's axes),
/// turned into the world's, and the symmetric part of its derivative by a displacement and a small rotation, both in
/// the world. Without a rate (statics) only the weight is left.
struct Equations {
  Vec6 r;        ///< [N], [N m]
  Mat6 tangent;  ///< [N/m], [N m]
};
Equations equations(const Body& body, const Motion& start, const Motion& end, double rate, const Vec3& gravity);

/// [J]
double kinetic_energy(const Body& body, const Motion& motion);

}  // namespace sinew::rigid
