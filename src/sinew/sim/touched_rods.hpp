// How far the sections of a rod miss the configurational force where it bends and is touched within a section.
//
// With the strains xi of a rod, its stresses w (moments and forces in the axes of the cross-section) and its tangent t,
// balance of forces and moments alone gives for the internal force n, where nothing pulls along the rod,
//
//     d(n . t) = -sum xi_i dw_i.
//
// The strains of a section are polynomials and follow the stresses only in its mean, xi_i = rest + e_i; strains that
// follow them everywhere would be rest + w_i / K_i. So for the same stresses the force along the rod is off by
//
//     integral of sum_i (w_i / K_i - e_i) dw_i
//
// between two places. Viscous stresses (in sections of order 0 all of them) are left out of w_i / K_i - e_i by taking
// out its mean. That is 0 over a section of order 0 and constant stiffness on which the stresses are linear. It
// is not where a contact stands within the section and the stresses have a kink there: at the mouth of a sleeve, where
// the exact force along a straight rod jumps by M^2 / (2 B) (D. Bigoni et al., Mechanics of Materials 80 (2015)
// 368-374).
#pragma once

#include <vector>

#include "sinew/error/warning.hpp"
#include "sinew/sim/model.hpp"
#include "sinew/sim/state.hpp"

namespace sinew {

/// [N] By how much the force along a rod is off, at most, between its base and any other place: over the sections in
/// which contacts press on it.
double configurational_error(const Model& model, const State& state, int number);

/// Warnings `touched_force_off` of rods that almost rest. Time and number of steps are left to the caller.
std::vector<Warning> assess_touched_rods(const Model& model, const State& state);

}  // namespace sinew
