// Poses, frames and tables over time: from what the scene says to positions in the world.
#pragma once

#include <string>

#include "sinew/rod/rod.hpp"
#include "sinew/sim/scene.hpp"

namespace sinew {

using rod::Placement;

/// x -> R x + p with R = Rz(c) Ry(b) Rx(a).
Placement placement(const Pose& pose);

/// first after second: x -> a(b(x)).
Placement compose(const Placement& a, const Placement& b);
Placement inverse(const Placement& a);
inline Vec3 apply(const Placement& a, const Vec3& x) { return a.R * x + a.p; }

/// Piecewise linear, first and last value held.
double value_at(const Table& table, double time);
Eigen::VectorXd value_at(const Track& track, double time);

/// Where a frame stands at a time: its motion there (the identity without one) after its pose.
Placement frame_at(const Frame& frame, double time);

/// How far a frame has moved from where it stood at t = 0: x(t) = D(t) x(0) for everything attached to it.
Placement frame_displacement(const Frame& frame, double time);

}  // namespace sinew
