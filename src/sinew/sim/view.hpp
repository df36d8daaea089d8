// From a state to what can be seen of it.
#pragma once

#include <string>

#include "sinew/contact/shape.hpp"
#include "sinew/sim/snapshot.hpp"
#include "sinew/sim/state.hpp"

namespace sinew {

/// What a person calls this moment: the time, the load factor of a static path, the mode and its frequency.
std::string when(const Model& model, const State& state);

/// A geometric cable: its base and its points.
RodSnapshot sample_cable(const Model& model, const State& state, int number);

/// The triangles of a shape in its own axes; of a half-space a square as large as the scene, below its middle when it
/// stands at `place`.
contact::Skin sample_shape(const Model& model, const contact::Shape& shape, const Placement& place);

/// Nodes, stresses, rods sampled at section ends and between, points and outputs.
Snapshot snapshot(const Model& model, const State& state, const std::string& status);

}  // namespace sinew
