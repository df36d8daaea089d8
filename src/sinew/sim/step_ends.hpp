// What happens before the first and after the last iteration, in time steps and statics alike; the first guess is in
// sim/first_guess.
//
// `room` is memory to work in.
#pragma once

#include "sinew/sim/linearization.hpp"

namespace sinew {

/// What becomes of the rows of points that a rod's end has left, or reached again.
enum class Rows { stay, switch_over };

/// Abscissae of sliding points, continued from their last value; rows whose point has left the rod's end go off, those
/// that the end has reached again come on, unless they are to stay as they are.
/// The rods' shapes stay with the linearisation, which then finds them.
void follow_points(const StepContext& context, State& iterate, Linearization& here, Rows rows = Rows::switch_over);

/// Velocities, mass points and what else belongs to an accepted step. Shapes of rods as above.
void finish(const StepContext& context, State& next, Linearization& here);
/// Reactions and internal forces, evaluated there.
void write_forces(const Linearization& here, State& next);

/// A tie about two or three axes whose rows hold, but half a turn off: the step was too long for it.
bool turned_over(const StepContext& context, const State& state);

/// A rod whose base has turned by more than a right angle in a dynamic step; null if none has. Velocities are the
/// chords of the step, so a mass point at a distance r from the axis has the angular momentum m r^2 sin(turn) / h:
/// beyond a right angle a second turn, pi less the first, balances as well, with energy that nothing has put in.
const RodModel* spun_round(const StepContext& context, const State& next);

/// The first rod whose base end has been pushed in past a sliding point, if any.
const RodModel* exhausted(const Model& model, const State& state);

/// Names a cell that has turned inside out where its law ends, and where it is; empty if there is none.
std::string broken_cell(const Model& model, const State& state);

/// [N/m] what holds the rods in their place in the step: their masses over h^2.
double inertia_of(const StepContext& context);

/// What `converged` means of forces and rows, here and nowhere else:
///
///     largest unbalanced force <= tolerance x largest force + 1e-14 x stiffness x size + 1e-20 x bearing,
///     violation <= tolerance x size,
///
/// with the scene's `newton.tolerance` (1e-9), the largest force that acts anywhere, `stiffness` [N/m] the largest
/// diagonal entry of the volumes' matrices and of inertia over h^2, the size of the scene, and what its bodies bear
/// (`Model::bearing`). The other terms of forces are their floor: positions are known to 1e-16 of the size, so that
/// forces are not known better than that times a stiffness, whatever they add up to; and where nothing acts, rods that
/// move as they are leave rounding alone, which nothing is large beside. Where the floor decides, the relative residual
/// may be anything (`at_floor`). Contacts come besides (`Linearization::contact_error`).
struct Convergence {
  bool met = false;
  bool at_floor = false;  ///< forces meet their floor, not the tolerance
  double allowed = 0.0;   ///< [N] largest unbalanced force that meets it
};
Convergence convergence_of(const Model& model, const Linearization& here, double stiffness);

}  // namespace sinew
