// Where the material points of a rod are, and how they move when its coordinates change: (2), (3), (4) and (5).
#pragma once

#include <span>

#include "sinew/lie/rotation.hpp"
#include "sinew/rod/rod.hpp"

namespace sinew::rod {

/// A rod in space: frames at the section ends and what each section's formulas need. Everything below reads it.
struct Configuration {
  const Rod* rod = nullptr;
  std::vector<Mat3> R;  ///< N + 1 frames at the section ends
  std::vector<Vec3> p;  ///< N + 1 positions [m]
  std::vector<Vec3> k;  ///< N curvature vectors (torsion, bending_y, bending_z) [1/m]
  std::vector<Vec3> u;  ///< N tangents in the section's frame: (1 + elongation, shear_y, shear_z)
  /// 3 x n each: turning q_j by dq_j turns and moves everything beyond by the twist (omega, v) dq_j, v taken at
  /// `origin`.
  Eigen::Matrix3Xd omega, v;
  Vec3 origin = Vec3::Zero();  ///< the base's placement; keeps lever arms short wherever the scene stands
};

/// (3), (4): g_{i+1} = g_i exp(l_i hat(xi_i)), from the base's placement and q.
Configuration configure(const Rod& rod, const Placement& base, const Eigen::VectorXd& q);

/// A point on the centreline.
struct CurvePoint {
  int section = 0;
  Vec3 position;    ///< gamma(s)
  Mat3 R;           ///< frame of the cross-section
  Vec3 derivative;  ///< gamma_s = R u
  Vec3 second;      ///< gamma_ss = R (k x u), from the section that holds s
};
CurvePoint curve_point(const Configuration& shape, double s);

/// Position of the material point at abscissa s, offset in the cross-section's frame.
Vec3 position(const Configuration& shape, double s, const Vec3& offset = Vec3::Zero());

/// (5): 3 x n derivative of position() with respect to q.
Eigen::Matrix3Xd position_jacobian(const Configuration& shape, double s, const Vec3& offset = Vec3::Zero());

/// f . gamma_qs, n values: how the component of gamma_s along f changes with q.
Eigen::VectorXd tangent_gradient(const Configuration& shape, double s, const Vec3& f);

/// A force on a material point, and a weight (mass / h^2 in a time step, 0 for a plain force).
struct PointLoad {
  double s = 0.0;
  Vec3 offset = Vec3::Zero();
  Vec3 force = Vec3::Zero();  ///< [N]
  double weight = 0.0;        ///< [kg/s^2]
};

/// With X_i(q) the loaded points and J_i their Jacobians, adds
///     gradient += sum J_i^T f_i,
///     tangent  += sum w_i J_i^T J_i + f_i . d2 X_i / dq2     (exact, symmetric),
/// in one pass from the tip to the base: what lies beyond a section acts on it only through its resultant force,
/// moment, virial and inertia. `loads` must be sorted by s.
void add_loads(const Configuration& shape, std::span<const PointLoad> loads, Eigen::Ref<Eigen::VectorXd> gradient,
               Eigen::Ref<Eigen::MatrixXd> tangent);

}  // namespace sinew::rod
