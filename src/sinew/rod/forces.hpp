// Forces on the material points of a rod: generalised forces and their exact tangent, (6) and (9), in one pass from the
// tip to the base. What lies beyond a section acts on it only through six forces and how they change with a twist.
#pragma once

#include <optional>
#include <span>

#include "sinew/rod/kinematics.hpp"

namespace sinew::rod {

/// A force and moment on a material point, and how the force grows as the point moves: a weight (mass / h^2 in a time
/// step, 0 for a plain force), or any symmetric matrix.
struct PointLoad {
  double s = 0.0;
  Vec3 offset = Vec3::Zero();
  Vec3 force = Vec3::Zero();   ///< [N] world axes, constant; of a follower: turning with the cross-section from here on
  double weight = 0.0;         ///< [kg/s^2]
  Vec3 moment = Vec3::Zero();  ///< [N m]
  bool follower = false;
  bool spread = false;  ///< one of many that stand for a load all along the rod: internal forces do not jump there
  int slide = -1;       ///< number among the slides: the abscissa is an unknown, too
  const Mat6* stiffness = nullptr;     ///< by how it turns and moves, world axes, symmetric, beside the weight
  std::optional<CentrePoint> at = {};  ///< the centreline at s, where it is known already
};

/// The mass points of a station in a time step, all at once. With o = (1, y, z) of its offset, Q = [p, R e_y, R e_z] of
/// the station's frame and x = Q o from the origin, a point feels f = w x - b, where w = m / h^2 and b is known.
struct StationInertia {
  Mat3 weight = Mat3::Zero();  ///< sum w o o^T
  Mat3 pull = Mat3::Zero();    ///< sum b o^T
};
/// By backward Euler and with weights: b = m (x_0 / h^2 + v_0 / h + g), of the points' positions (in space) and
/// velocities at the start of the step; `rate` is 1 / h. In the order of the rod's stations.
void station_inertia(const Rod& rod, const Eigen::Matrix3Xd& positions, const Eigen::Matrix3Xd& velocities, double rate,
                     const Vec3& gravity, const Vec3& origin, std::vector<StationInertia>& inertia);

/// Inertia of all of a rod's stations.
struct Inertia {
  std::span<const StationInertia> stations;
  Vec3 gravity = Vec3::Zero();
  bool bends = true;  ///< false: it has no part in the tangent but for its weights (a predictor's)
};

/// What an abscissa s that carries a force f adds to the equations of a rod: f . gamma_qs and f . gamma_ss.
struct Slide {
  linalg::Attachment attachment;  ///< over the strain coordinates
  double second = 0.0;
};

/// The slide of a point whose section has a constant strain and only turns; nothing of any other, which add_loads then
/// makes. As gamma_s is carried by the cross-section, f . gamma_qs is what the turns of the point do to gamma_s x f.
std::optional<Slide> slide_at(const Configuration& shape, const CurvePoint& point, const Vec3& force);

/// Moment [N m] and force [N], in the axes of the cross-section at s, that the loads farther from the base need for
/// balance: on the base's side of s, and on the tip's. They differ by a concentrated load at s.
struct Balance {
  double s = 0.0;
  Vec6 before = Vec6::Zero(), beyond = Vec6::Zero();
};

/// The equations of a rod in its coordinates (base, strains), linearised.
struct Equations {
  Eigen::VectorXd r;     ///< generalised forces
  linalg::Chain chain;   ///< tangent of the strain coordinates
  Eigen::MatrixXd base;  ///< tangent of the base's coordinates among themselves; with the strains: T_b^T V, U^T T_b
  std::vector<Slide> slides;
  std::vector<Balance> internal;  ///< from base to tip, at the sections' ends and every concentrated load
  double acting = 0.0;            ///< [N] inertia of all stations, their weight apart: in free fall the two cancel
};

/// All zeros. Follower forces and moments make the tangent unsymmetric.
Equations make_equations(const Configuration& shape, bool symmetric, int slides = 0);
/// The same in the memory of earlier ones.
void make_equations(const Configuration& shape, bool symmetric, int slides, Equations& equations);
bool conservative(std::span<const PointLoad> loads);

/// With X_i(q) the loaded points and J_i their Jacobians, adds
///     r     += sum J_i^T f_i  (and omega_i^T m_i),
///     chain += sum J_i^T (w_i + S_i) J_i + d(J_i^T f_i)/dq     (exact),
/// and fills slides and internal. `loads` must be sorted by s.
void add_loads(const Configuration& shape, std::span<const PointLoad> loads, Equations& equations);
/// The same with inertia.
void add_loads(const Configuration& shape, std::span<const PointLoad> loads, const Inertia& inertia,
               Equations& equations);

/// Adds elastic forces K q of all sections, and viscous ones C (q - q_start) rate.
void add_elasticity(const Rod& rod, const Eigen::VectorXd& q, const Eigen::VectorXd& start, double rate,
                    Equations& equations);

/// The tangent over all coordinates, written out: for tests and the solver of last resort.
Eigen::MatrixXd dense_tangent(const Configuration& shape, const Equations& equations);

}  // namespace sinew::rod
