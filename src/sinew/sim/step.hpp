// One time step: backward Euler of (6) and (7) with their couplings.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "sinew/sim/state.hpp"
#include "sinew/sim/status.hpp"

namespace sinew {

/// What motors and loads are told for the end of a step.
struct Command {
  std::vector<double> actuators;  ///< one each, in the unit of what drives it (N, m, N m, rad)
  std::vector<double> loads;      ///< factor of each [-]
};

/// The values of all tables at a time; what is driven from outside gets 0.
Command command_at(const Model& model, double time);
/// What a state obeys: the forces and factors it was told, and where its motors are.
Command command_of(const Model& model, const State& state);
/// The command that is a part of the way from one to another.
Command between(Command from, const Command& to, double part);

/// Seconds spent, summed over the iterations of a step.
struct StageTimes {
  double forces = 0.0, assembly = 0.0, factor = 0.0, compliance = 0.0, rods = 0.0, solve = 0.0;
};

struct StepReport {
  Status status = Status::rest;
  int newton = 0;          ///< linearisations made
  double residual = 0.0;   ///< largest unbalanced force over the largest force that acts anywhere
  double violation = 0.0;  ///< [m] largest distance of a sliding point from its rod, or of a tip from its anchor
  bool rotated = false;    ///< a definite tangent stood in for the exact one somewhere
  bool unstable = false;   ///< of statics: the equilibrium is one that a real rod would leave (it has buckled)
  bool redundant = false;  ///< constraint rows depended on each other
  std::string detail;      ///< names what failed, for people
  StageTimes times;
};

struct Modes;

/// Memory that steps of one model reuse; holds nothing between them that they would not find again. One per thread.
struct Workspace {
  struct Solid {
    linalg::SparseFactor factor;
  };
  std::vector<Solid> solids;
  std::shared_ptr<const Modes> modes;  ///< of a modal analysis, once they are known
};
Workspace make_workspace(const Model& model);

/// Advances by h [s]. On failure `next` is the state it started from.
struct StepResult {
  State next;
  StepReport report;
};
StepResult step(const Model& model, Workspace& workspace, const Command& command, const State& state, double h);

}  // namespace sinew
