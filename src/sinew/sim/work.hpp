// The work that is put into rods, solids and bodies over a step.
#pragma once

#include <vector>

#include "sinew/sim/contacts.hpp"

namespace sinew {

/// [J] Work of actuators, loads, supports, mouse springs, and frames that move bases of rods, attachments and
/// obstacles, over the step, by the mean of their forces at its ends times what they move:
///
///     W = sum 1/2 (f_start + f_end) . (x_end - x_start),      of turns 1/2 (m_start + m_end) . log(R_end R_start^T).
///
/// `touches` are the contacts of the end. With it `energy_balance` is whole: what is missing has been dissipated.
double work(const StepContext& context, const State& next, const std::vector<Touch>& touches);

/// [J] By how much the work of actuators, loads, supports and frames that counts with the mean may be beside that of a
/// force that jumps within the step: the sum of 1/2 |f_end - f_start| |x_end - x_start|.
double work_uncertainty(const StepContext& context, const State& next);

}  // namespace sinew
