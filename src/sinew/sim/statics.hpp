// Statics: the equilibrium under the loads of the scene's end, followed from none.
//
// All loads, motors and gravity grow with one factor t from 0 to 1 (frames move to where they are at t times the
// duration). Each step goes a certain arc along the path of equilibria (u, t),
//     |du|^2 + dt^2 = ds^2,       du in radians and in fractions of the scene's size,
// predicted along the tangent K u' = -dr/dt and corrected by Newton in the plane across it, so the path is followed
// past limit points, where t turns back.
#pragma once

#include "sinew/sim/step.hpp"

namespace sinew {

/// One accepted step along the path from `state`, whose time is t times the duration. The last one lands on t = 1 and
/// counts as the one step of the grid. On failure `next` is `state`.
StepResult static_step(const Model& model, Workspace& workspace, const State& state);

}  // namespace sinew
