// What happens before the first and after the last iteration, in time steps and statics alike.
//
// `room` is memory to work in.
#pragma once

#include "sinew/sim/linearization.hpp"

namespace sinew {

/// Puts held coordinates of solids where their frames are at the end of the step.
void place_held(const StepContext& context, State& iterate);

/// First guess of the end of the step: where the start is, carried along by moving frames.
void first_guess(const StepContext& context, State& guess);

/// Abscissae of sliding points, continued from their last value; rows whose point has left the rod's end go off, those
/// that the end has reached again come on.
/// The rods' shapes stay with the linearisation, which then finds them.
void follow_points(const StepContext& context, State& iterate, Linearization& here);

/// Velocities, mass points and what else belongs to an accepted step. Shapes of rods as above.
void finish(const StepContext& context, State& next, Linearization& here);
/// Reactions and internal forces, evaluated there.
void write_forces(const Linearization& here, State& next);

/// A tie about an axis whose rows hold, but half a turn off: the step was too long for it.
bool turned_over(const StepContext& context, const State& state);

/// The first rod whose base end has been pushed in past a sliding point, if any.
const RodModel* exhausted(const Model& model, const State& state);

/// Names a cell that has turned inside out where its law ends, and where it is; empty if there is none.
std::string broken_cell(const Model& model, const State& state);

/// [N/m] what holds the rods in their place in the step: their masses over h^2.
double inertia_of(const StepContext& context);

/// Forces and rows meet the scene's tolerance. Forces are known to the rounding of positions times `stiffness` [N/m]
/// only, whatever they add up to.
bool balanced(const Model& model, const Linearization& here, double stiffness);

}  // namespace sinew
