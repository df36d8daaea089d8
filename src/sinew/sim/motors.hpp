// Motors, the actuators of a scene: where they are, what they are told and do, and how people speak of it. A motor is
// told a force (or torque), or else a position (a displacement or an angle) and has a row that holds it there.
#pragma once

#include <string>
#include <vector>

#include "sinew/sim/state.hpp"
#include "sinew/sim/step.hpp"
#include "sinew/solve/direct.hpp"

namespace sinew {

/// How far a motor has moved its base, or drawn its tendon [m] or [rad]; and all of them.
double motor_position(const Model& model, const State& state, const ActuatorModel& actuator);
std::vector<double> motor_positions(const Model& model, const State& state);

/// Its force or torque [N] or [N m] in an iterate: told, or the multiplier of its row.
double motor_force(const Model& model, const Command& command, const State& iterate, int actuator);

/// What a motor obeys: its force where that is told, else where it is.
double told_to(const Model& model, const State& state, int actuator);
/// What it can do of that.
const Span& told_span(const ActuatorModel& actuator);

/// How people speak of what a motor does: "pull" has `force` [N] and `displacement` [m], what turns a torque and an
/// angle.
struct MotorWords {
  const char *force, *position, *force_unit, *position_unit;
};
MotorWords words_of(const ActuatorModel& actuator);
/// "pull.force": what it is told, as signals call it.
std::string command_name(const ActuatorModel& actuator);

/// What one more newton, metre or radian of a motor's command adds to a right side: it is told a force or, with a row,
/// a place.
void tell_motor(const Model& model, const State& iterate, int actuator, double more, solve::RightSide& side);
/// How far a solution moves a motor, and how much its force changes while its command stays [SI].
double motor_motion(const Model& model, const State& iterate, int actuator, const solve::CoupledSolution& solution);
double motor_reaction(const Model& model, int actuator, const solve::CoupledSolution& solution);

}  // namespace sinew
