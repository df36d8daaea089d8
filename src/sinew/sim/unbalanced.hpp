// What an iteration that did not converge leaves.
#pragma once

#include <string>
#include <vector>

#include "sinew/sim/linearization.hpp"

namespace sinew {

/// Names where an iterate is furthest from what it must meet, in multiples of that, forces of `allowed` [N]: a node of
/// a solid, a section or the base of a rod, or a rigid body by its unbalanced force, a constraint by how far it is
/// missed, a contact by how far its force is from its law; and, of contacts that came and went in the iterations
/// (`turns`, one each), the one that did so most. "contact of ball and beam near (0.1, 0, 0.02) m: its law is missed by
/// 0.012 mm".
std::string most_unbalanced(const StepContext& context, const Linearization& here, const State& iterate, double allowed,
                            const std::vector<int>& turns);

/// "540 contacts are too much work, 300 of them of disc and ring": the pair that has most.
std::string too_many_contacts(const Model& model, const State& state);

/// "ball and beam near (0.1, 0, 0.02) m": the contact of a finished step that presses hardest; empty without any.
std::string hardest_contact(const Model& model, const State& state);

}  // namespace sinew
