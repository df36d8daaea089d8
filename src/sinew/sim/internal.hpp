// Internal forces and stresses of rods.
#pragma once

#include "sinew/rod/forces.hpp"
#include "sinew/sim/state.hpp"

namespace sinew {

/// Internal forces as they stand in RodState::internal, with room for every jump the model allows: columns (s, before,
/// beyond) of rod::Balance, from base to tip; those without use come first, at s = -1.
Eigen::MatrixXd no_internal(const RodModel& rod);
void write_internal(const std::vector<rod::Balance>& along, RodState& state);

/// What the part beyond s exerts on the part before: moments [N m] and forces [N] in the axes of the cross-section. Of
/// free strains by Hooke's law; of the others, which no law knows, what the loads beyond need for balance. Where a load
/// is concentrated, its side towards the tip; at the tip itself, the base's.
rod::Vec6 internal_wrench(const Model& model, const State& state, int number, double s);

/// By how much the tension of a rod outweighs its bending stiffness: T l^2 / (E I) of the section of length l where
/// that is largest, at its middle, with the smallest E I of the axes it can bend about; 0 under pressure, or if it
/// cannot bend.
double tautness(const Model& model, const State& state, int number);

/// [J] Of a rod alone: what its strains store, and its motion.
double elastic_energy(const rod::Rod& rod, const RodState& state);
double kinetic_energy(const rod::Rod& rod, const RodState& state);

/// [N] under which it buckles as a column with both ends hinged, about the axis that bends more easily.
double buckling_load(const rod::Rod& rod);
/// Part of it: less force than that is nothing to speak of.
inline constexpr double kNegligibleForce = 1e-4;

/// The largest stresses of the cross-section at s.
rod::SectionStress section_stress(const Model& model, const State& state, int number, double s);

}  // namespace sinew
