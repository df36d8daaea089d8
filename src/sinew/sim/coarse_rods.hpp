// Whether the sections of a rod follow the forces that bend, twist and stretch it.
//
// The strains of a section are polynomials of degree p, and in the mean over the section, weighted with these, they
// meet the stresses w that loads need for balance. What is left of w / K once its part of degree p is taken out,
//
//     d = w / K - P_p(w / K),
//
// no coordinate follows. The elastic energy of the rod that does follow them is larger by int d^T K d / 2 ds, and where
// one load works on it what this moves gives way more by the same share (Clapeyron): a rod of one section of constant
// curvature is too stiff by 1/4 under a load at its tip, of n by 1 / (4 n^2).
#pragma once

#include <vector>

#include "sinew/error/warning.hpp"
#include "sinew/sim/model.hpp"
#include "sinew/sim/state.hpp"

namespace sinew {

/// The share of its elastic energy that the strains of a rod cannot follow, from 0 to 1, with stresses that are linear
/// between the places where they are known; 0 of a rod that stores none to speak of.
double missed_energy(const Model& model, const State& state, int number);

/// Warnings `coarse_rod` of rods that almost rest and slide in nothing (of those that do, sim/sliding_rods says more).
/// Time and number of steps are left to the caller.
std::vector<Warning> assess_coarse_rods(const Model& model, const State& state);

}  // namespace sinew
