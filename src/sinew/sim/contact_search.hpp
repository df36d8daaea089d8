// The search for contacts: which parts of a pair of bodies, solids or rods are near each other at the start of a step.
#pragma once

#include <vector>

#include "sinew/sim/contact_way.hpp"

namespace sinew {

/// Adds the pairs of parts of pair `number` that are nearer than `alarm` [m] at `start`, with surfaces fitted there.
/// Surfaces meet as points of one and faces of the other, and as edges of both.
///
/// What overlaps is met up to a depth of `depth` [m], or of the pair's own: the far sides of thin things, and edges
/// that have passed each other long ago, are no contacts.
void search(const Moment& start, double alarm, double depth, const Surfaces& surfaces, int number,
            std::vector<ContactState>& found);

/// The same, with all pieces of rods, however deep their chords lie in what the rod bends round and its curve only
/// touches: what goes through must not be overlooked.
void search_whole(const Moment& start, double alarm, double depth, const Surfaces& surfaces, int number,
                  std::vector<ContactState>& found);

/// Whether the edges by which one object of a pair presses into others stay clear of those of the other one on their
/// way, by more than `margin` [m]; `speed`: how far the two move at most [m].
bool edges_stay_clear(const StepMotion& motion, const Surfaces& surfaces, int number, double speed, double margin);

/// How deep [m] edges, axes and pieces of one object of a pair are in the other in the middle between the triangles
/// that they pass through and, where they are thin, their ends; 0 where they stay outside. Flat parts of a mesh are met
/// by points alone, and bend round an edge.
double depth_between_triangles(const Moment& now, const Surfaces& surfaces, int number);

/// How deep [m] points of one object of a pair are inside the other or, where none are, edges; 0 where none is.
double overlap(const Moment& now, const Surfaces& surfaces, int number);

}  // namespace sinew
