// A discrete Cosserat rod: sections whose strains vary along them as Legendre polynomials of chosen degree.
//
//     xi(s) = B(s) q + xi_bar(s)      strain(): the strain from the coordinates, the one home of this equation
//
//     g' = g hat(xi)                  rod/kinematics: (3) and (4)
//
// xi_bar is the stress-free strain of all six; q = 0 is the rod at rest. Constant strains (degree 0) are the paper's.
// The maths is in README.md of this folder.
#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "sinew/rod/integration.hpp"
#include "sinew/rod/profile.hpp"

namespace sinew::rod {

using Vec3 = Eigen::Vector3d;
using Mat3 = Eigen::Matrix3d;

/// A rigid placement in space.
struct Placement {
  Mat3 R = Mat3::Identity();
  Vec3 p = Vec3::Zero();
};

/// A motion of the base beyond its prescribed placement: along or about sign times an axis of its rest frame.
struct BaseMotion {
  bool turns = false;
  int axis = 0;  ///< 0, 1, 2
  double sign = 1.0;
  bool operator==(const BaseMotion&) const = default;
};

inline constexpr std::array<const char*, 6> kStrainNames = {"torsion",    "bending_y", "bending_z",
                                                            "elongation", "shear_y",   "shear_z"};

/// A free strain of a section: its number 0..5 in the order (torsion, bending_y, bending_z, elongation, shear_y,
/// shear_z) and the degree of its Legendre polynomial over the section.
struct Mode {
  int strain = 0;
  int degree = 0;
  bool operator==(const Mode&) const = default;
};

struct Section {
  double begin = 0.0, end = 0.0;  ///< [m]
  std::vector<Mode> modes;        ///< its coordinates, in this order
  Coefficients rest;              ///< Legendre coefficients of the stress-free strains [1/m, -]
  Eigen::MatrixXd stiffness;      ///< elastic forces are stiffness * q: int B^T K B ds
  Eigen::MatrixXd damping;        ///< viscous forces are damping * qdot
  std::vector<Step> steps;        ///< of integration
  double length() const { return end - begin; }
  /// Whether it has other coordinates than torsion and bending.
  bool stretches() const;
  /// x in [-1, 1] of the Legendre polynomials at s.
  double local(double s) const { return (2.0 * s - begin - end) / length(); }
};

/// A material point that carries mass: an abscissa, an offset in the cross-section's plane and kilograms.
struct MassPoint {
  double s = 0.0;              ///< [m]
  Vec3 offset = Vec3::Zero();  ///< [m] in the cross-section's frame, x = 0
  double mass = 0.0;           ///< [kg]
};

/// An abscissa with mass points: what is constant of the exponentials from the start of its step to it.
struct Station {
  double s = 0.0;             ///< [m]
  int section = 0, step = 0;  ///< step: of the section
  int first_mass = 0, masses = 0;
  Weights weights;
  Mat3 spread = Mat3::Zero();  ///< [kg, kg m, kg m^2] sum m o o^T, o = (1, y, z) of the points' offsets
};

struct Rod {
  std::vector<Section> sections;
  std::vector<int> first;         ///< first strain coordinate of each section, and the number of all at the end
  std::vector<BaseMotion> base;   ///< first in q; translations before turns
  std::vector<MassPoint> masses;  ///< sorted by s; empty for a massless rod
  std::vector<Station> stations;  ///< of the mass points
  Profile profile;                ///< what it is made of along its length

  int count() const { return static_cast<int>(sections.size()); }
  int base_coordinates() const { return static_cast<int>(base.size()); }
  int strain_coordinates() const { return first.back(); }
  /// Size of q = (base coordinates, coordinates of section 0, of section 1, ...).
  int coordinates() const { return base_coordinates() + strain_coordinates(); }
  double length() const { return sections.back().end; }
  /// The section that holds abscissa s; the first or last one beyond the ends.
  int section_at(double s) const;
  /// Coordinates of section i in q.
  auto of_section(const Eigen::VectorXd& q, int i) const {
    return q.segment(base_coordinates() + first[i], first[i + 1] - first[i]);
  }
};

/// How a rod is cut and what may vary in it.
struct Discretisation {
  std::vector<double> ends;        ///< [m] N + 1 abscissae, 0 first, the length last
  std::vector<Mode> modes;         ///< of every section
  std::vector<Coefficients> rest;  ///< of each section; empty: straight
};

/// Sections, stiffness, damping and masses from the profile; the base is left clamped.
Rod make_rod(const Discretisation& discretisation, const Profile& profile);

/// Modes of the given strains: degrees 0 .. order[strain] of each.
std::vector<Mode> modes_of(const std::vector<int>& strains, const std::array<int, 6>& order = {});

/// Legendre coefficients of all six strains in a section: those of B q + xi_bar.
Coefficients strain_coefficients(const Section& section, const Eigen::Ref<const Eigen::VectorXd>& q);

/// The strains at an abscissa: xi = B q + xi_bar.
Vec6 strain(const Rod& rod, const Eigen::VectorXd& q, double s);

/// Their deviation from the stress-free ones: B q.
Vec6 deviation(const Rod& rod, const Eigen::VectorXd& q, double s);

/// The q for which the strains are, in every section, as near to the given ones as its modes allow: in the mean over
/// the section, weighted with nothing. `strains` holds Legendre coefficients per section.
Eigen::VectorXd coordinates_of(const Rod& rod, const std::vector<Coefficients>& strains);

}  // namespace sinew::rod
