#include "sinew/sim/status.hpp"

namespace sinew {

std::string_view to_string(Status status) {
  switch (status) {
    case Status::rest:
      return "rest";
    case Status::converged:
      return "converged";
    case Status::linearized:
      return "linearized";
    case Status::max_iterations:
      return "max_iterations";
    case Status::singular:
      return "singular";
    case Status::diverged:
      return "diverged";
    case Status::inverted:
      return "inverted";
    case Status::path_lost:
      return "path_lost";
    case Status::path_unfinished:
      return "path_unfinished";
    case Status::rod_exhausted:
      return "rod_exhausted";
    case Status::inconsistent:
      return "inconsistent";
    case Status::passed_through:
      return "passed_through";
  }
  return "unknown";
}

std::string_view explain(Status status) {
  switch (status) {
    case Status::rest:
      return "This is the initial state.";
    case Status::converged:
      return "The step met its tolerance.";
    case Status::linearized:
      return "The step made the number of linearisations asked for; its residual says how far that is from "
             "equilibrium.";
    case Status::max_iterations:
      return "Newton did not reach its tolerance, nor did it in parts of the step. Try a slower motion or less load, "
             "in "
             "motion more stiffness damping (rayleigh), or a finer mesh or more sections at the place that is named.";
    case Status::singular:
      return "A matrix could not be factored: nothing holds a motion (a part of a mesh that is not connected, a "
             "massless rod that no coupling ties), or the body has collapsed. Look at the last picture; try a smaller "
             "step.";
    case Status::diverged:
      return "Numbers grew without bound, or a linearisation went further than it says anything about. Try "
             "a smaller time step, a slower motion or more damping; with `newton: n`, leave that out.";
    case Status::inverted:
      return "An element turned inside out, beyond where its law is defined. Take shorter steps, a finer mesh there, "
             "or a law that goes on (neo_hookean, corotational).";
    case Status::path_lost:
      return "The path of equilibria turned back for good: there is no equilibrium under the full load, or only one "
             "that a jump leads to. Reduce the load or the motion; the recorded states show how far it went.";
    case Status::path_unfinished:
      return "The path of equilibria was followed for as many steps as there are, and goes on from where it ended: "
             "whether "
             "there is an equilibrium under the full load is not known. Reduce the load, or reach it in parts with "
             "`analysis: quasi_static` and a table over time.";
    case Status::rod_exhausted:
      return "The base end of a rod reached a sliding point. Let the rod start further outside the body, or push it in "
             "less.";
    case Status::inconsistent:
      return "Constraints contradict each other: no strain and no motion can answer all of them. Drive one of them by "
             "a force instead of a position, leave one out, or add the strains that are missing.";
    case Status::passed_through:
      return "Something got to the other side of what stops it, or deep into it. Do what is said above; else take "
             "shorter steps, or move and load it more slowly.";
  }
  return "";
}

bool accepted(std::string_view status) {
  for (const Status own : {Status::rest, Status::converged, Status::linearized}) {
    if (status == to_string(own)) return true;
  }
  return false;
}

}  // namespace sinew
