// Cross-sections: from shape and material to the six stiffnesses of Hooke's law, sigma = K (xi - xi_rest).
#pragma once

#include "sinew/rod/rod.hpp"

namespace sinew::rod {

/// Round section of radius r [m], Young's modulus [Pa] and Poisson's ratio:
/// (G J, E I, E I, E A, k G A, k G A) with A = pi r^2, I = pi r^4 / 4, J = pi r^4 / 2 and Cowper's shear factor
/// k = 6 (1 + nu) / (7 + 6 nu) (Cowper 1966, J. Appl. Mech. 33). Units N m^2 and N.
Vec6 round_section_stiffness(double radius, double young, double poisson);

/// Largest von Mises stress [Pa] in a round section under internal moments and forces (order of the strains): axial and
/// bending stress at the rim with the torsion's shear there; shear forces as their mean over the area.
double round_section_von_mises(double radius, const Vec6& stress);

}  // namespace sinew::rod
