// A rod that folds within a section around a rigid shape.
//
// A rod touches by points of its axis and by the pieces, straight, between them. Where it bends by much within a piece
// its axis may lie in the shape while both of these stay out; so the axis itself is looked at. Shapes are convex: along
// a straight line the depth f in one is concave, and at a distance h of a place s
//
//     f(s + h) <= f(s) + h max(0, f(s) - f(s - e), f(s) - f(s + e)) / e + (h^2 + h e) / 2 max |x''|,
//
// x the axis. Pieces are halved until that says enough of them.
#pragma once

#include "sinew/sim/contact_way.hpp"

namespace sinew {

/// How deep the axis of a rod lies in a rigid shape [m], to a fiftieth of the thickness of the thinner of the two
/// where it is more than a twentieth: where a step ends, and on the way to there, its places and the shape going as
/// `StepMotion` has them. 0 for other pairs, and on the way if nothing moves by more than half of that thickness.
struct FoldDepth {
  double end = 0.0, way = 0.0;
};

/// `speed`: how far points and pieces move at most, `thin`: the thickness of the thinner [m], of which a quarter is the
/// longest stretch that is not looked at.
FoldDepth depth_of_fold(const StepMotion& motion, const PairModel& pair, double speed, double thin);

}  // namespace sinew
