// Equilibria, followed from one to another.
//
// All loads, motors and gravity grow with one factor t from 0 to 1, and frames move. Each step goes a certain arc along
// the path of equilibria (u, t),
//     |du|^2 + dt^2 = ds^2,       du in radians and in fractions of the scene's size,
// predicted along the tangent K u' = -dr/dt and corrected by Newton in the plane across it, so the path is followed
// past limit points, where t turns back.
#pragma once

#include <vector>

#include "sinew/sim/step.hpp"
#include "sinew/sim/unresisted.hpp"

namespace sinew {

/// `static`: one accepted step along the path from nothing to all that is prescribed at the scene's end, from `state`,
/// whose time is t times the duration. The last one lands on t = 1 and counts as the one step of the grid. On failure
/// `next` is `state`.
StepResult static_step(const Model& model, Workspace& workspace, const State& state);

/// `quasi_static`: the equilibrium under what is prescribed at `time`, from that of `state` (from no loads at all where
/// the run begins). Newton goes there at once; where it does not get there, or ends at an equilibrium that is unstable
/// or inside out, it follows the path, and where the path turns back or gets unstable, it leaves it for the nearest
/// minimum under all loads: the jump that a real body would make. With contacts, which make kinks in a path, loads are
/// brought on by parts instead. After `most` iterations, in multiples of `newton.limit`, no further part is tried; then
/// the nearest minimum is still looked for, but not where they are fewer than `kMostOfEquilibrium`.
inline constexpr int kMostOfEquilibrium = 64;
StepResult equilibrium_step(const Model& model, Workspace& workspace, const Command& command, const State& state,
                            double time, int most = kMostOfEquilibrium);

/// The first iterations of the first step of an analysis at rest (`quasi_static`, `static`, `modal`), by the code that
/// makes it. Status `singular`: nothing resists a motion there, and `free` has those that are known; any other status
/// says nothing of the step.
struct FirstSolve {
  StepReport report;
  std::vector<Unresisted> free;
};
FirstSolve first_solve(const Model& model, Workspace& workspace);

}  // namespace sinew
