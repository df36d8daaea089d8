// The work that is put into rods, solids and bodies over a step.
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "sinew/sim/contacts.hpp"

namespace sinew {

/// [J] Work over a step, with forces as they are at its start, and at its end.
struct Work {
  double start = 0.0, end = 0.0;

  /// Second order in the step: what energies are balanced with.
  double mean() const { return 0.5 * (start + end); }
  /// The most that energy may rise by. Where potentials are convex along the step, that is the work with the forces at
  /// its end, however large it is and however forces f jump in it: backward Euler's step
  ///
  ///     M (v' - v)/h = f' - dU/dx(x'),      x' - x = h v',
  ///
  /// times x' - x is
  ///
  ///     T' - T + 1/2 |v' - v|^2_M  =  f'.(x' - x) - dU/dx(x').(x' - x)  <=  f'.(x' - x) - (U' - U).
  ///
  /// Where one is concave (a column that buckles as it is pushed, and pushes back less and less), the work of a smooth
  /// motion lies between those with both; what a step adds beyond is not there in shorter ones. A force that turns by
  /// theta against its way, or a moment whose lever does, is largest within the step, if that passes its maximum, and
  /// does up to theta^2 / 12 more work than with its values at both ends.
  double bound() const {
    constexpr double kTurns = 5e-3;  // theta^2 / 12 of a quarter of a radian
    return std::max(start, end) + kTurns * std::max(std::abs(start), std::abs(end));
  }

  Work& operator+=(const Work& other) {
    start += other.start;
    end += other.end;
    return *this;
  }
};

/// Work of actuators, loads, supports, mouse springs, and frames that move bases of rods, attachments and obstacles,
/// over the step: forces times what they move,
///
///     f . (x_end - x_start),      of turns m . log(R_end R_start^T).
///
/// `touches` are the contacts of the end. With its mean `energy_balance` is whole: what is missing has been dissipated.
Work work(const StepContext& context, const State& next, const std::vector<Touch>& touches);

/// Whether a contact that has this gap [m] at the start of a step is of what has overlapped since the scene began.
inline bool overlaps_since_the_start(const Model& model, const ContactState& contact, double gap) {
  return gap < -1e-6 * model.size && gap >= -model.pairs[contact.pair].depth;
}

/// Work of contacts, as they are at the end of a step in time, that move apart what has overlapped since the scene
/// began.
Work work_of_lifting(const Model& model, const State& next, const ContactRoom& room);

}  // namespace sinew
