// A discrete Cosserat rod: N sections, the strain constant along each, some of the six strains free.
//
//     xi = B q + xi_bar      strain(): a section's strain from its coordinates, the one home of this equation
//
//     g' = g hat(xi)         rod/kinematics: integrated exactly over a section, (3) and (4)
//
// The maths is in README.md of this folder.
#pragma once

#include <Eigen/Core>
#include <vector>

namespace sinew::rod {

using Vec3 = Eigen::Vector3d;
using Mat3 = Eigen::Matrix3d;
using Vec6 = Eigen::Matrix<double, 6, 1>;

/// A rigid placement in space.
struct Placement {
  Mat3 R = Mat3::Identity();
  Vec3 p = Vec3::Zero();
};

/// What the base may do beyond its prescribed placement: slide along -x, turn about +x of its rest frame.
enum class BaseAxis { translation, rotation };

/// A material point that carries mass: an abscissa, an offset in the cross-section's plane and kilograms.
struct MassPoint {
  double s = 0.0;              ///< [m]
  Vec3 offset = Vec3::Zero();  ///< [m] in the cross-section's frame, x = 0
  double mass = 0.0;           ///< [kg]
};

/// Geometry, stiffness and mass. Strains are (torsion, bending_y, bending_z [1/m], elongation, shear_y, shear_z [-]).
struct Rod {
  std::vector<double> ends;                        ///< N + 1 abscissae [m], 0 first, the length last
  std::vector<int> basis;                          ///< free strains, ascending numbers 0..5
  Eigen::Matrix<double, 6, Eigen::Dynamic> fixed;  ///< 6 x N strains outside the basis (0 inside it): xi_bar
  Eigen::VectorXd rest;                            ///< N * basis.size() stress-free values of the free strains
  std::vector<Vec6> stiffness;                     ///< N section stiffnesses [N m^2, N]
  std::vector<BaseAxis> base;                      ///< free base coordinates, first in q
  std::vector<MassPoint> masses;                   ///< sorted by s; empty for a massless rod
  double radius = 0.0;                             ///< [m]

  int sections() const { return static_cast<int>(ends.size()) - 1; }
  int strains() const { return static_cast<int>(basis.size()); }
  int base_coordinates() const { return static_cast<int>(base.size()); }
  /// Size of q = (base coordinates, strains of section 0, of section 1, ...).
  int coordinates() const { return base_coordinates() + sections() * strains(); }
  int first_coordinate(int section) const { return base_coordinates() + section * strains(); }
  double length() const { return ends.back(); }
  double section_length(int i) const { return ends[i + 1] - ends[i]; }
  /// The section that holds abscissa s; the first or last one beyond the ends.
  int section_at(double s) const;
};

/// All six strains of a section: xi = B q + xi_bar.
Vec6 strain(const Rod& rod, const Eigen::VectorXd& q, int section);

/// Coordinates of the stress-free rod with its base at rest.
Eigen::VectorXd rest_coordinates(const Rod& rod);

/// Masses of a round rod of the given density: per section three Gauss points, at each four points that share the
/// cross-section's mass and stand off the axis by radius / sqrt(2), which gives the section's own rotary inertia.
/// Exact for the kinetic energy of a section whose points move quadratically along it.
std::vector<MassPoint> round_rod_masses(const std::vector<double>& ends, double radius, double density);

}  // namespace sinew::rod
