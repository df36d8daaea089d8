// Cross-sections: from shape and material to stiffness, viscosity and inertia per metre, and back from internal moments
// and forces to stresses. x is along the rod; y and z are principal axes of the section, its centroid the origin.
//
//     six-vectors in the order of the strains: (torsion, bending_y, bending_z, elongation, shear_y, shear_z)
//
// Formulas and sources are in README.md of this folder.
#pragma once

#include <Eigen/Core>
#include <variant>

namespace sinew::rod {

using Vec6 = Eigen::Matrix<double, 6, 1>;
using Mat6 = Eigen::Matrix<double, 6, 6>;

struct Circle {
  double radius = 0.0;  ///< [m] > 0
};

struct Tube {
  double outer = 0.0, inner = 0.0;  ///< [m] radii, 0 <= inner < outer
};

struct Ellipse {
  double y = 0.0, z = 0.0;  ///< [m] half axes, > 0
};

struct Rectangle {
  double y = 0.0, z = 0.0;  ///< [m] full sides, > 0
};

using Shape = std::variant<Circle, Tube, Ellipse, Rectangle>;

struct SectionProperties {
  double area = 0.0;                    ///< [m^2]
  double torsion = 0.0;                 ///< J [m^4], Saint-Venant's; the polar moment for round sections only
  double second_y = 0.0;                ///< I_y = int z^2 dA [m^4], about y
  double second_z = 0.0;                ///< I_z = int y^2 dA [m^4], about z
  double shear_y = 0.0, shear_z = 0.0;  ///< k [-], Cowper's factors for shear along y and z
};

/// Poisson's ratio in (-1, 0.5] enters the shear factors alone. For an ellipse with nu < 0 Cowper's formula has a pole,
/// negative beyond, where the axis across the shear is 2.9 (nu = -0.9) to 12.3 (nu = -0.1) times the one along.
SectionProperties properties(const Shape& shape, double poisson);

/// (G J, E I_y, E I_z, E A, k_y G A, k_z G A) [N m^2, N] from Young's modulus [Pa] and Poisson's ratio.
Vec6 section_stiffness(const Shape& shape, double young, double poisson);

/// eta (J, 3 I_y, 3 I_z, 3 A, A, A) [N m^2 s, N s] from the shear viscosity eta [Pa s]: Kelvin-Voigt material that
/// resists extension with Trouton's 3 eta.
Vec6 section_viscosity(const Shape& shape, double shear_viscosity);

/// Mass and rotary inertia per metre of rod; about x it is the sum of the two.
struct LineInertia {
  double mass = 0.0;                    ///< [kg/m]
  double about_y = 0.0, about_z = 0.0;  ///< [kg m]
};

LineInertia line_inertia(const Shape& shape, double density);

/// Largest stresses over a section [Pa].
struct SectionStress {
  double axial = 0.0;      ///< signed, tension > 0
  double bending = 0.0;    ///< largest magnitude, at the rim
  double torsion = 0.0;    ///< largest magnitude, at the rim
  double von_mises = 0.0;  ///< see section_stress
};

/// Stresses under internal moments [N m] and forces [N]. von_mises puts |axial| + bending and torsion + shear force
/// over area into one point. For circle and tube that point exists: the maximum over the rim, exact without shear
/// force. For ellipse and rectangle bending and torsion peak at different points, and it is a bound.
SectionStress section_stress(const Shape& shape, const Vec6& internal);

/// Largest and least distance of the outer rim from the axis [m].
double outer_radius(const Shape& shape);
double least_outer_radius(const Shape& shape);

/// The shape at t in [0, 1] of a linear taper: a at 0, b at 1. Two different kinds: std::bad_variant_access.
Shape blend(const Shape& a, const Shape& b, double t);

}  // namespace sinew::rod
