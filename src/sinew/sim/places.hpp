// Where things are in a state: the one home of what steps, runs and signals ask alike.
#pragma once

#include <cmath>
#include <vector>

#include "sinew/rod/kinematics.hpp"
#include "sinew/sim/state.hpp"

namespace sinew {

/// How far a frame has moved at the state's time; the ground (-1) has not.
Placement moved(const Model& model, const State& state, int frame);

/// What a rod or cable stands on at the state's time.
Placement rod_base(const Model& model, const State& state, int rod);
Placement cable_base(const Model& model, const State& state, int cable);

/// A rod in space.
rod::Configuration rod_shape(const Model& model, const State& state, int rod);

/// A point of a solid.
Vec3 solid_point(const Model& model, const State& state, int solid, const solid::EmbeddedPoint& where);

/// Position [m] of an output, other than of a pair.
Vec3 output_position(const Model& model, const State& state, const OutputModel& output);

/// How a point of an output is turned: the cross-section of a rod, a rigid body, or the rotation of F on a solid.
rod::Mat3 output_axes(const Model& model, const State& state, const OutputModel& output);

/// How it has turned since the start, as a rotation vector [rad] in the axes of the world.
Vec3 output_turn(const Model& model, const State& state, const OutputModel& output);

/// What presses a pair together: the sum of its normal forces [N], and the least gap [m], infinite where they are not
/// near each other.
struct Pressing {
  double force = 0.0, gap = INFINITY;
};
Pressing pressing_of(const State& state, int pair);

/// Whether a contact presses on an object.
bool is_pressed(const State& state, const Collider& object);

/// How many cells of solids are flat or inside out.
int count_folded(const Model& model, const State& state);

/// "28 elements are flat or inside out, one of them cell 12 of solids.bar, at rest near (0.1, 0, 0.02) m"; empty where
/// none is.
std::string describe_folded(const Model& model, const State& state);

}  // namespace sinew
