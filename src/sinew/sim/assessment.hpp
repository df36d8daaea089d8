// What a user should know of an accepted step, and of constraint forces that no step may end with.
//
// Each step is judged as it is accepted, so that nothing is missed that has passed by the end of a run. The kinds of
// warnings are listed in docs/warnings.md.
#pragma once

#include <string>

#include "sinew/sim/linearization.hpp"

namespace sinew {

/// Adds the warnings of a step to its report: cables and tendons that push, rods that have left their body, elements
/// inside out, equilibria that are unstable, contacts that overlap or were not solved, linearisations that were not
/// enough, constraints that have become redundant.
void assess(const StepContext& context, const Linearization& here, const State& next, StepReport& report);

/// Whether a step of `newton: n` leaves more of its forces or constraints than it is warned of.
bool leaves_much(const Model& model, const StepReport& step);

/// Adds to a report how far such a step is off (`StepReport::off`), if that is more than a twentieth of its motion.
void warn_of_linearisation(const Model& model, double time, StepReport& report);

/// Names constraints or contacts whose forces are beyond what bodies can bear (a million times Model::bearing): what
/// they hold, nothing answers. Empty if there are none.
std::string beyond_bearing(const Model& model, const State& state);

/// Whether a step moves bodies apart that overlapped when the run began and still did at its start. `iterate` has all
/// its contacts yet.
bool lifts_apart(const Model& model, const State& iterate, const ContactRoom& room);

/// Names a step whose contacts have added energy: kinetic, elastic and that of weight have grown by more than what was
/// put in and a thousandth of what there is. Impacts take energy; a step that is too long may find another solution, as
/// a thin rod that friction has spun round. Empty of all other steps. (One that moves bodies apart adds what it has
/// to.)
std::string contact_adds_energy(const StepContext& context, const State& next);

/// "actuators.a, actuators.b: what they are told contradicts ...": what is known of commands that contradict each other
/// (`contradicting_commands`). Empty if there are none.
std::string known_contradiction(const Model& model);

/// "actuators.a, actuators.b contradict each other by 2 mm; drive one of them by force ...".
std::string describe_contradiction(const Model& model, const RedundantRows& rows, const Eigen::VectorXd& c);

}  // namespace sinew
