// Rods that are squashed or stretched beyond what any real rod bears.
//
// The force along a rod is linear in its elongation, N = E A (lambda - 1), with lambda the ratio of its length to that
// without stress. Nothing in that law keeps lambda from 0, where the rod has no length, and from below, where it is
// inside out: N = -E A is all that it takes.
#pragma once

#include <vector>

#include "sinew/error/warning.hpp"
#include "sinew/sim/model.hpp"
#include "sinew/sim/state.hpp"

namespace sinew {

/// The least and the largest ratio of length to that without stress along a rod: in the middle of sections, and at the
/// ends of those in which it varies.
struct Stretch {
  double least = 1.0, most = 1.0;
};
Stretch stretch_of(const rod::Rod& rod, const Eigen::VectorXd& q);

/// Warnings `rod_crushed` (of less than a fifth of the length) and `rod_overstretched` (of more than six times it).
/// Time and number of steps are left to the caller.
std::vector<Warning> assess_strained_rods(const Model& model, const State& state);

}  // namespace sinew
