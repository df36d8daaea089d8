#include "sinew/sim/step.hpp"

#include <cmath>

#include "sinew/sim/newton.hpp"
#include "sinew/sim/places.hpp"
#include "sinew/sim/step_ends.hpp"

namespace sinew {

Command command_at(const Model& model, double time) {
  const auto value = [time](const Drive& drive) {
    const Table* table = std::get_if<Table>(&drive);
    return table ? value_at(*table, time) : 0.0;
  };
  Command command;
  for (const ActuatorModel& actuator : model.actuators) command.actuators.push_back(value(actuator.drive));
  for (const LoadModel& load : model.loads) command.loads.push_back(value(load.factor));
  return command;
}

Command command_of(const Model& model, const State& state) {
  Command command{state.actuators, state.loads};
  for (std::size_t i = 0; i < model.actuators.size(); ++i) {
    if (model.actuators[i].row >= 0) command.actuators[i] = motor_position(model, state, model.actuators[i]);
  }
  return command;
}

Command between(Command from, const Command& to, double part) {
  const auto mix = [part](std::vector<double>& a, const std::vector<double>& b) {
    for (std::size_t i = 0; i < a.size(); ++i) a[i] = std::lerp(a[i], b[i], part);
  };
  mix(from.actuators, to.actuators);
  mix(from.loads, to.loads);
  return from;
}

Workspace make_workspace(const Model& model) {
  Workspace workspace;
  for (const SolidModel& solid : model.solids) workspace.solids.push_back({linalg::SparseFactor(solid.fronts)});
  return workspace;
}

StepResult step(const Model& model, Workspace& workspace, const Command& command, const State& state, double h) {
  const StepContext context = make_context(model, state, command, h);
  Iterate iterate{first_guess(context)};
  follow_points(context, iterate.state);
  const Newton& wanted = model.scene.newton;
  const bool fixed = wanted.iterations > 0;
  const NewtonRules rules{fixed ? wanted.iterations : wanted.limit, fixed};
  const StepReport report = newton([&context](double) { return context; }, workspace, rules, iterate);
  return {accepted(report.status) ? std::move(iterate.state) : state, report};
}

}  // namespace sinew
