// How a step ended. Failure is data: a step never throws on numbers and never returns a state with NaN.
#pragma once

#include <string_view>

namespace sinew {

enum class Status {
  rest,             ///< the initial state
  converged,        ///< Newton met its tolerance
  linearized,       ///< the asked number of linearisations was made (newton: n)
  max_iterations,   ///< Newton did not meet its tolerance within the limit
  singular,         ///< a matrix could not be factored
  diverged,         ///< numbers grew without bound, or a linearisation beyond trust
  inverted,         ///< an element turned inside out, where its law ends
  path_lost,        ///< statics: the path of equilibria does not lead to the full load
  path_unfinished,  ///< statics: the path of equilibria took all the steps there are, and goes on
  rod_exhausted,    ///< the base end of a rod was pushed in past a sliding point
  inconsistent,     ///< constraints contradict each other, or ask for forces that nothing could bear
  passed_through,   ///< something got to the other side of what stops it, or deep into it
};

constexpr bool accepted(Status status) {
  return status == Status::rest || status == Status::converged || status == Status::linearized;
}

std::string_view to_string(Status status);
/// The same of its name.
bool accepted(std::string_view status);

/// What the status means and what to try, one sentence each, for people.
std::string_view explain(Status status);

}  // namespace sinew
