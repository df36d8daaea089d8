// From a state to what can be seen of it.
#pragma once

#include <string>

#include "sinew/sim/snapshot.hpp"
#include "sinew/sim/state.hpp"

namespace sinew {

/// What a person calls this moment: the time, the load factor of a static path, the mode and its frequency.
std::string when(const Model& model, const State& state);

/// Nodes, stresses, rods sampled at section ends and between, points and outputs.
Snapshot snapshot(const Model& model, const State& state, const std::string& status);

}  // namespace sinew
