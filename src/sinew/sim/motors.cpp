#include "sinew/sim/motors.hpp"

namespace sinew {

double motor_position(const Model& model, const State& state, const ActuatorModel& actuator) {
  const Line& line = actuator.line;
  if (actuator.tendon) {
    return actuator.tendon_length -
           rod::tendon_length(model.rods[line.rod].rod, *actuator.tendon, state.rods[line.rod].q).value;
  }
  if (line.rod >= 0) return state.rods[line.rod].q[actuator.unknown - model.rods[line.rod].unknown];
  return state.cables[line.cable].z[actuator.unknown - model.cables[line.cable].unknown];
}

std::vector<double> motor_positions(const Model& model, const State& state) {
  std::vector<double> positions;
  for (const ActuatorModel& actuator : model.actuators) positions.push_back(motor_position(model, state, actuator));
  return positions;
}

double motor_force(const Model& model, const Command& command, const State& iterate, int actuator) {
  const ActuatorModel& own = model.actuators[actuator];
  return own.told_force() ? command.actuators[actuator] : iterate.lambda[own.row];
}

double told_to(const Model& model, const State& state, int actuator) {
  const ActuatorModel& own = model.actuators[actuator];
  return own.told_force() ? state.actuators[actuator] : motor_position(model, state, own);
}

const Span& told_span(const ActuatorModel& actuator) {
  return actuator.told_force() ? actuator.force : actuator.position;
}

MotorWords words_of(const ActuatorModel& actuator) {
  return actuator.turns() ? MotorWords{"torque", "angle", "N m", "rad"} : MotorWords{"force", "displacement", "N", "m"};
}

std::string command_name(const ActuatorModel& actuator) {
  const MotorWords words = words_of(actuator);
  return actuator.name + "." + (actuator.told_force() ? words.force : words.position);
}

namespace {

Eigen::VectorXd tendon_gradient(const Model& model, const State& iterate, const ActuatorModel& actuator) {
  const int rod = actuator.line.rod;
  return rod::tendon_length(model.rods[rod].rod, *actuator.tendon, iterate.rods[rod].q).gradient;
}

}  // namespace

void tell_motor(const Model& model, const State& iterate, int actuator, double more, solve::RightSide& side) {
  const ActuatorModel& own = model.actuators[actuator];
  if (!own.told_force()) {
    side.c[own.row] -= more;  // position - target
  } else if (own.tendon) {
    side.chains[own.line.rod] += more * tendon_gradient(model, iterate, own);
  } else {
    side.r[own.unknown] -= more;
  }
}

double motor_motion(const Model& model, const State& iterate, int actuator, const solve::CoupledSolution& solution) {
  const ActuatorModel& own = model.actuators[actuator];
  if (own.tendon) return -tendon_gradient(model, iterate, own).dot(solution.dq[own.line.rod]);
  return solution.dz[own.unknown];
}

double motor_reaction(const Model& model, int actuator, const solve::CoupledSolution& solution) {
  const ActuatorModel& own = model.actuators[actuator];
  return own.told_force() ? 0.0 : solution.dlambda[own.row];
}

}  // namespace sinew
