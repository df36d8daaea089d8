// A rod that folds within a section around a rigid shape.
//
// A rod touches by points of its axis and by the pieces, straight, between them. Where it bends by much within a piece
// its axis may lie in the shape while both of these stay out; so that is looked at at places in between as well.
#pragma once

#include "sinew/sim/contact_way.hpp"

namespace sinew {

/// How deep the axis of a rod lies in a rigid shape between the points and pieces by which it touches [m], at the end
/// of a step; 0 for other pairs.
double deepest_between(const StepMotion& motion, const PairModel& pair);

/// The same on the way to there, its points and the shape going as `StepMotion` has them. `speed`: how far the two move
/// at most, `thin`: the thickness of the thinner [m], of which a quarter is the longest stretch that is not looked at.
double deepest_between_on_way(const StepMotion& motion, const PairModel& pair, double speed, double thin);

}  // namespace sinew
