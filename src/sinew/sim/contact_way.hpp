// Two objects on their way through a step: where their parts are in between, and how deep they come into each other.
//
// Parts go from where they are at its start to where they are at its end: nodes and points of rods straight, rigid
// bodies by the screw-free interpolation of place and turn. Conservative advancement finds how deep any two come on
// the way,
//
//     t <- t + gap(t) / (how far the two move towards each other at most).
#pragma once

#include <cmath>

#include "sinew/sim/contact_surfaces.hpp"

namespace sinew {

/// Part of the scene's size by which what is not met may come into something on its way.
inline constexpr double kComesIn = 1e-6;

/// Both ends of a step, or of what one would be.
struct StepMotion {
  const Moment &start, &end;
};

/// Distance of two parts less their thickness [m]; below zero only where they overlap at that time, wherever they came
/// from: past the rim of a triangle it has no inside, and the plane of a face ends with its shape.
double separation(const StepMotion& motion, const ContactState& own, double t);

/// Gap of two rigid shapes on their way [m], if it is less than `alarm`, or else infinite; negative where they overlap.
double gap_of_shapes(const StepMotion& motion, const PairModel& pair, double t, double alarm);

/// How deep two rigid shapes overlap on their way [m]; 0 where they are apart.
double overlap_of_shapes(const StepMotion& motion, const PairModel& pair, double t);

/// The furthest that anything of an object moves [m]; `surfaces` are those of the start.
double farthest(const StepMotion& motion, const Surfaces& surfaces, const Collider& own);

/// The deepest overlap [m] of two parts on their way, beyond the one they start with; 0 where they stay apart. `speed`:
/// how far the two objects move at most, `thin`: the thickness of the thinner [m]. What is deeper than `enough` ends
/// it.
double deepest_of_parts(const StepMotion& motion, const ContactState& own, double speed, double thin,
                        double enough = INFINITY);
/// The same of two rigid shapes.
double deepest_of_shapes(const StepMotion& motion, const PairModel& pair, double speed, double thin,
                         double enough = INFINITY);
/// How deep the point that is the first part of a contact comes into the whole of the other object [m]; 0 where it
/// passes that. `surfaces` are those of the start; where the other one bends it moves as its part does.
double deepest_of_point(const StepMotion& motion, const ContactState& own, const Surfaces& surfaces, double speed,
                        double thin, double enough = INFINITY);

}  // namespace sinew
