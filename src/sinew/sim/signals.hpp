// The numbers of a state that people plot: the columns of signals.csv after time, status and newton.
#pragma once

#include <string>
#include <vector>

#include "sinew/sim/snapshot.hpp"
#include "sinew/sim/state.hpp"

namespace sinew {

/// <output>.x|y|z [m]; <actuator>.displacement [m] and .force [N], or .angle [rad] and .torque [N m].
std::vector<std::string> signal_names(const Model& model);
std::vector<double> signal_values(const Model& model, const State& state);

/// Position [m] of an output.
Vec3 output_position(const Model& model, const State& state, const OutputModel& output);

/// Largest distance [m] between a dropped sliding point and its rod: what the rows that were left out would have said.
/// 0 if none was dropped.
double dropped_gap(const Model& model, const State& state);

/// What can be seen of a state: nodes, stresses, rods sampled at section ends and between, points and outputs.
Snapshot snapshot(const Model& model, const State& state, const std::string& status);

}  // namespace sinew
