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

/// Part of the thickness of the thinner object by which what flies past another one must stay clear of it.
inline constexpr double kClearance = 1e-3;

/// Both ends of a step, or of what one would be.
struct StepMotion {
  const Moment &start, &end;
};

/// Where something rigid is at a part `t` of its way.
contact::Pose pose_between(const contact::Pose& from, const contact::Pose& to, double t);

/// The longest stretch of a way of two that is not looked at where they may overlap, 0 to 1: a quarter of the thickness
/// of the thinner [m], unless they move, by `speed` [m] at most, by more than a thousand of them.
double shortest_look(double speed, double thin);

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
/// how far the two objects move at most, `thin`: the thickness of the thinner [m], of which a quarter is the longest
/// stretch that is not looked at, unless they move by more than a thousand of them.
double deepest_of_parts(const StepMotion& motion, const ContactState& own, double speed, double thin);
/// The same of two rigid shapes.
double deepest_of_shapes(const StepMotion& motion, const PairModel& pair, double speed, double thin);

// Whether things stay clear of each other on all of their way: by more than `margin` [m] wherever that is looked at, by
// half of it in between; not so where it takes too long to tell. Nothing is stepped over.

/// The thin point that is the first part of a contact, if it is one, and the whole of the other object; edges are left
/// to `edges_stay_clear`. `surfaces` are those of the start.
bool point_stays_clear(const StepMotion& motion, const ContactState& own, const Surfaces& surfaces, double speed,
                       double margin);
/// Two rigid shapes.
bool shapes_stay_clear(const StepMotion& motion, const PairModel& pair, double margin);
/// Two parts, as their `separation` has it, but that ends of cylinders are flat.
bool parts_stay_clear(const StepMotion& motion, const ContactState& own, double speed, double margin);

}  // namespace sinew
