// From a state to what can be seen of it.
#pragma once

#include "sinew/sim/snapshot.hpp"
#include "sinew/sim/state.hpp"

namespace sinew {

/// Nodes, stresses, rods sampled at section ends and between, points and outputs.
Snapshot snapshot(const Model& model, const State& state, const std::string& status);

}  // namespace sinew
