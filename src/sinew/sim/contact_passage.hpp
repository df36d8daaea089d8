// The second look at contacts, once a step has been made: whether something met, or went through, what it was not
// looked for beforehand.
//
// Candidates are found before a step, within an alarm distance that follows from velocities. Forces, actuators and
// frames may move things further. So the step is looked at again along the motion that it made (sim/contact_way).
//
// A pair that meets and was no candidate makes the step be done again with a longer alarm distance. Contacts keep the
// two parts that they were found with, and the plane of a face has no end: where one presses though the two objects are
// apart, the step is done again without it. Where something was taken to fly past and does not, it is done again with
// all contacts of that pair. A pair that was a candidate and still comes deeper than a quarter of the thinner of the
// two makes it be refused. So does a rod whose curve lies that deep in a rigid shape between the places where it
// touches: it folds within a section; and an edge that lies that deep between the nodes of a surface.
#pragma once

#include "sinew/sim/contacts.hpp"

namespace sinew {

/// What the second look found.
struct Passage {
  enum class Kind { none, missed, met, left_behind, passed, folded, cut };
  Kind kind = Kind::none;
  int pair = -1;               ///< of the model's, the deepest
  double depth = 0.0;          ///< [m] of its overlap on the way
  double overlap = 0.0;        ///< [m] in which two end that touch, whatever parts of them: rigid shapes, rods in these
  int overlapping = -1;        ///< of the model's pairs, the one with that
  bool between_nodes = false;  ///< there: what overlaps is an edge between the nodes of a surface
  double alarm = 0.0;          ///< [m] within which contacts are to be looked for to find all that may meet
  std::vector<int> met;        ///< pairs of which something was taken to fly past and has not stayed clear
  std::vector<ContactKey> left_behind;  ///< contacts that press where the two are apart
};

/// Looks along the motion from the start of a step to `next`, at which `room` is `evaluated`, or not yet. `alarm` is
/// that within which it was filled. Of what moved by less than that, and than the thickness of what may meet, only rods
/// are looked at, and pairs of which contacts were left out.
Passage look_again(const StepContext& context, const State& next, const ContactRoom& room, bool evaluated,
                   double alarm);

}  // namespace sinew
