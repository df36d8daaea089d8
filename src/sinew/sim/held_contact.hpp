// Held nodes of solids that come to lie in an obstacle: nothing there can give way, so no contact is looked for.
#pragma once

#include "sinew/sim/contacts.hpp"

namespace sinew {

/// The deepest of them.
struct HeldInside {
  int pair = -1;       ///< of the model's; -1: none
  double depth = 0.0;  ///< [m]
};

/// At the end of a step, of nodes and obstacles that a frame moves towards each other: how deep what holds them has
/// carried nodes of a solid, all of whose coordinates are held, into an obstacle of one of the solid's pairs.
HeldInside held_inside(const StepContext& context, const ContactRoom& room, const State& next);

}  // namespace sinew
