// Newton's iteration on a whole scene, of time steps and statics alike.
#pragma once

#include <functional>

#include "sinew/sim/linearization.hpp"

namespace sinew {

/// Where Newton starts, and ends: a state and how far what is prescribed has come (1: all of it).
struct Iterate {
  State state;
  double t = 1.0;
};

/// The plane across a path of equilibria that an arc length step stays in: direction . du + rate dt = 0, du `measured`.
struct AcrossPath {
  Eigen::VectorXd direction;
  double rate = 0.0;
};

/// How Newton is to go.
struct NewtonRules {
  int limit = 0;       ///< most rounds
  bool fixed = false;  ///< so many rounds with definite tangents, whatever is left (`newton: 1` of the paper)
  /// Which equilibrium is looked for: the nearest minimum, by steps that are shortened where they lead away from it, or
  /// any at all, by steps that are only limited to what a linearisation can be trusted for.
  Linearization::Wanted wanted = Linearization::Wanted::descent;
  const AcrossPath* across = nullptr;  ///< t is looked for, too
};

/// What is prescribed at t.
using ContextAt = std::function<StepContext(double t)>;

/// Iterates until forces and rows are balanced and completes the state (`finish`). On failure the report names it and
/// the iterate is where it ended.
StepReport newton(const ContextAt& at, Workspace& workspace, const NewtonRules& rules, Iterate& iterate);

/// What changes of an equilibrium as t grows: the tangent K u' = -dr/dt of the path. `own` is the increment `here`
/// gives.
Increment change_along(const ContextAt& at, Workspace& workspace, const Iterate& iterate, Linearization& here,
                       const Increment& own, StageTimes& times);

/// An increment as one vector: what each number turns [rad], or moves in units of the scene's size.
Eigen::VectorXd measured(const Model& model, const Increment& increment);

}  // namespace sinew
