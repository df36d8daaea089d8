// The numbers of a state that people plot: the columns of signals.csv after time, status and newton.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "sinew/sim/quantities.hpp"

namespace sinew {

/// A group of columns, with their whole names, and what fills them.
struct SignalGroup {
  std::vector<Column> columns;
  std::function<std::vector<double>(const Model&, const State&)> values;
};

/// In the order of the columns:
///   mode.frequency [Hz], of a modal analysis only, negative where the equilibrium is unstable;
///   <output>.<column>, as sim/quantities.hpp lists them;
///   <output>.target.x|y|z or .target, where the target of an output is, and .error, how far off that is, in the
///   components that matter [m], [rad], [1/m], 1 or [N];
///   <actuator>.displacement [m] and .force [N], or .angle [rad] and .torque [N m];
///   energy.kinetic|elastic|weight|work|dissipated [J]: weight is that of the gravitational field, 0 at the start; work
///   is done by motors, loads and moving supports of solids, dissipated is what is missing in the balance: damping of
///   the material and of the time step (and, with a minus, work of frames that move bases and ties of rods).
std::vector<SignalGroup> signal_groups(const Model& model);

/// Name and unit of each column.
std::vector<Column> signal_columns(const Model& model);
std::vector<std::string> signal_names(const Model& model);
std::vector<double> signal_values(const Model& model, const State& state);

/// Largest distance [m] between a dropped sliding point and its rod: what the rows that were left out would have said.
/// 0 if none was dropped.
double dropped_gap(const Model& model, const State& state);

/// Stored in the material and the motion of everything, and its potential in gravity since the start [J].
struct EnergyBalance {
  double kinetic = 0.0, elastic = 0.0, weight = 0.0;
  double total() const { return kinetic + elastic + weight; }
};
EnergyBalance energy_balance(const Model& model, const State& state);

}  // namespace sinew
