// How far off rolling is in one step.
//
// A contact that sticks keeps the material point that touches at the end of the step from moving along the surface. A
// point of a wheel has come to the contact along a chord, R sin(phi), while a wheel that turns by phi rolls by R phi.
// In general, let R be the turn of an object in the step, Q the one that takes the normal of the start to that of the
// end, and a the arm from the core (a corner, an axis) out to the surface. The core moves as a point of the object;
// beyond it the surface moves past the contact by
//
//     (a - Q^T a) + log(R Q^T) x a      instead of the chord      a - R^T a.
//
// The difference vanishes where the contact turns with the object (R = Q: a jaw that turns about what lies in it) and
// where the object turns about the normal; of a wheel it is R (phi - sin(phi)), R phi^3 / 6.
//
// Rods are braked besides. Backward Euler moves the points of a cross-section along chords: at x_n = r(n phi) of a
// circle the inertia m (x_n+1 - 2 x_n + x_n-1) / h^2 of a steady spin has the moment
//
//     J (2 sin(phi) - sin(2 phi)) / h^2 = 2 J sin(phi) (1 - cos(phi)) / h^2,      nearly J omega^3 h,
//
// about the axis, J the polar moment of inertia. It is told beside the moment of what touches the rod.
#pragma once

#include <vector>

#include "sinew/error/warning.hpp"
#include "sinew/sim/contacts.hpp"

namespace sinew {

/// Warnings `coarse_rolling` of contacts that stick and `spin_damped` of rods that are touched, one of each at most.
/// `room` must hold all contacts of `next`, evaluated.
std::vector<Warning> assess_rolling(const StepContext& context, const State& next, const ContactRoom& room);

}  // namespace sinew
