// What an iteration of Newton's method costs, from a model's sizes alone: limits in this unit end a failing analysis
// after about the same time whatever its size, and at the same step on every machine.
#pragma once

#include "sinew/sim/model.hpp"

namespace sinew {

/// Multiplications of one iteration, about: forces and tangents of elements, their factorisation, sections of rods.
double iteration_work(const Model& model);

/// An analysis that fails is given up after this much more work without progress; about ten seconds of a processor.
inline constexpr double kPatience = 4e10;

/// How much work may follow the last progress, of all that was spent: a tenth, but not less than `kPatience`.
inline double allowed_work(double spent) { return spent > 10.0 * kPatience ? 0.1 * spent : kPatience; }

/// `wanted` iterations, or as many as `kPatience` allows, but not less than twice what one run of Newton's iteration
/// may take.
int affordable_iterations(const Model& model, int wanted);

}  // namespace sinew
