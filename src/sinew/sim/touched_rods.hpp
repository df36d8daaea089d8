// How far the sections of a rod miss the configurational force where it bends and is touched within a section.
//
// Along a rod that nothing touches along its tangent, with the strains e, their stresses w (moments and forces in the
// axes of the cross-section) and stiffnesses K,
//
//     C = n . t + sum w_i^2 / (2 K_i)
//
// is constant (J. D. Eshelby's energy-momentum; D. Bigoni et al., Mechanics of Materials 80 (2015) 368-374: at the
// mouth of a sleeve the force along the rod jumps by M^2 / (2 B)). Balance of forces and moments alone gives d(n . t) =
// -sum e_i dw_i, with the strains that the rod has. So where strains follow the stresses only in the mean of a section,
// by polynomials,
//
//     dC = sum_i (w_i / K_i - e_i) dw_i,      e_i: the projection of w_i / K_i on the section's polynomials,
//
// which is 0 for a section of order 0 on which the stresses are linear, and is not where a contact stands within it and
// the stresses have a kink there. What C gains from the base to a place is by how much a force along the rod at the
// base is off.
#pragma once

#include <vector>

#include "sinew/error/warning.hpp"
#include "sinew/sim/model.hpp"
#include "sinew/sim/state.hpp"

namespace sinew {

/// [N] The largest part of the rod, from its base on or up to its tip, by which C is not constant.
double configurational_error(const Model& model, const State& state, int rod);

/// Warnings `touched_force_off` of rods that contacts touch. Time and number of steps are left to the caller.
std::vector<Warning> assess_touched_rods(const Model& model, const State& state);

}  // namespace sinew
