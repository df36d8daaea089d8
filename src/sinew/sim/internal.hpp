// Internal forces and stresses of rods.
#pragma once

#include "sinew/sim/state.hpp"

namespace sinew {

/// What the part beyond s exerts on the part before: moments [N m] and forces [N] in the axes of the cross-section. Of
/// free strains by Hooke's law; of the others, which no law knows, what the loads beyond need for balance.
rod::Vec6 internal_wrench(const Model& model, const State& state, int rod, double s);

/// The largest stresses of the cross-section at s.
rod::SectionStress section_stress(const Model& model, const State& state, int rod, double s);

}  // namespace sinew
