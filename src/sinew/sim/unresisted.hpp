// Motions that nothing resists at an equilibrium: of bases of rods and of rigid bodies, which then rest where chance
// leaves them, or nowhere if something pushes.
#pragma once

#include <string>
#include <vector>

#include "sinew/sim/model.hpp"

namespace sinew {

struct Unresisted {
  Collider object;      ///< a rod or a body
  std::string where;    ///< "rods.arm"
  std::string motions;  ///< "x, turn_z": of a base in its axes, of a body in the world's
};

/// By the numbers of unknowns z that nothing resists (Linearization::unresisted).
std::vector<Unresisted> unresisted_motions(const Model& model, const std::vector<int>& unknowns);

/// "rods.arm (x, turn_z) and bodies.ball (z)"; empty if there are none.
std::string in_words(const std::vector<Unresisted>& motions);

}  // namespace sinew
