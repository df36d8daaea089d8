// What a step, or an equilibrium, is first guessed to end as.
#pragma once

#include "sinew/sim/step_context.hpp"

namespace sinew {

/// Puts held coordinates of solids where their frames are at the end of the step.
void place_held(const StepContext& context, State& iterate);

/// First guess of the end of the step: where the start is, carried along by moving frames.
void first_guess(const StepContext& context, State& guess);

/// Moves it on with the velocities of the start for a time [s]; a solid that a moving frame carries stays.
void move_by(const StepContext& context, double time, State& guess);

/// [rad] by which a body may turn in a step and still move on the shortest way from where it starts to where it ends,
/// as the first guess has it.
inline constexpr double kMostTurn = 1.0;

/// Moves it on, as `move_by` does, for a part of the step, or for as long as no body turns by more than kMostTurn.
void move_on(const StepContext& context, double part, State& guess);

}  // namespace sinew
