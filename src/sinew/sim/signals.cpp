#include "sinew/sim/signals.hpp"

#include <algorithm>
#include <cmath>

#include "sinew/constraint/sliding.hpp"
#include "sinew/sim/internal.hpp"
#include "sinew/sim/motors.hpp"
#include "sinew/sim/places.hpp"
#include "sinew/sim/solid_loads.hpp"
#include "sinew/sim/targets.hpp"

namespace sinew {

namespace {

SignalGroup output_group(const OutputModel& output) {
  const OutputKind& kind = kind_of(output);
  SignalGroup group;
  for (const Column& own : kind.columns) group.columns.push_back({output.name + "." + own.name, own.unit});
  group.values = [=](const Model& model, const State& state) { return kind.values(model, state, output); };
  return group;
}

SignalGroup motor_group(const Model& all) {
  SignalGroup group;
  for (const ActuatorModel& actuator : all.actuators) {
    const MotorWords words = words_of(actuator);
    group.columns.push_back({actuator.name + "." + words.position, words.position_unit});
    group.columns.push_back({actuator.name + "." + words.force, words.force_unit});
  }
  group.values = [](const Model& model, const State& state) {
    std::vector<double> values;
    const std::vector<double> positions = motor_positions(model, state);
    for (std::size_t i = 0; i < positions.size(); ++i) {
      values.push_back(positions[i]);
      values.push_back(state.actuators[i]);
    }
    return values;
  };
  return group;
}

/// Where a target is, and how far off its output.
SignalGroup target_group(const Model& all, std::size_t number) {
  const EffectorModel& effector = all.effectors[number];
  const std::string name = all.outputs[effector.output].name, unit = measure_of(all, effector).si;
  SignalGroup group;
  if (effector.size == 1) {
    group.columns = {{name + ".target", unit}};
  } else {
    for (const char* const axis : {".x", ".y", ".z"}) group.columns.push_back({name + ".target" + axis, unit});
  }
  group.columns.push_back({name + ".error", unit});
  group.values = [number](const Model& model, const State& state) {
    const EffectorModel& own = model.effectors[number];
    const Goal goal = goal_at(model, state.time);
    Eigen::VectorXd errors;
    effector_errors(model, state, goal, errors);
    const auto at = goal.at.segment(own.first, own.size);
    std::vector<double> values(at.begin(), at.end());
    values.push_back(error_of(own, errors));
    return values;
  };
  return group;
}

SignalGroup energy_group() {
  SignalGroup group;
  for (const char* const part : {"kinetic", "elastic", "weight", "work", "dissipated", "work_bound"})
    group.columns.push_back({std::string("energy.") + part, "J"});
  group.values = [](const Model& model, const State& state) {
    const EnergyBalance now = energy_balance(model, state);
    return std::vector<double>{now.kinetic,
                               now.elastic,
                               now.weight,
                               state.energies.work,
                               model.start_energy + state.energies.work - now.total(),
                               state.energies.work_bound};
  };
  return group;
}

}  // namespace

std::vector<SignalGroup> signal_groups(const Model& model) {
  std::vector<SignalGroup> groups;
  if (model.scene.analysis == Analysis::modal) {
    groups.push_back({{{"mode.frequency", "Hz"}},
                      [](const Model&, const State& state) { return std::vector<double>{state.frequency}; }});
  }
  for (const OutputModel& output : model.outputs) groups.push_back(output_group(output));
  for (std::size_t i = 0; i < model.effectors.size(); ++i) {
    if (std::holds_alternative<Track>(model.scene.targets[i].at)) groups.push_back(target_group(model, i));
  }
  groups.push_back(motor_group(model));
  // A static path has its own gravity at every point, a mode none: no balance to draw up.
  if (model.scene.analysis == Analysis::dynamic || model.scene.analysis == Analysis::quasi_static)
    groups.push_back(energy_group());
  return groups;
}

std::vector<Column> signal_columns(const Model& model) {
  std::vector<Column> columns;
  for (const SignalGroup& group : signal_groups(model))
    columns.insert(columns.end(), group.columns.begin(), group.columns.end());
  return columns;
}

std::vector<std::string> signal_names(const Model& model) {
  std::vector<std::string> names;
  for (Column& own : signal_columns(model)) names.push_back(std::move(own.name));
  return names;
}

std::vector<double> signal_values(const Model& model, const State& state) {
  std::vector<double> values;
  for (const SignalGroup& group : signal_groups(model)) {
    const std::vector<double> own = group.values(model, state);
    values.insert(values.end(), own.begin(), own.end());
  }
  return values;
}

double dropped_gap(const Model& model, const State& state) {
  double gap = 0.0;
  for (const PointModel& point : model.dropped) {
    if (point.line.rod < 0) continue;
    const rod::Rod& rod = model.rods[point.line.rod].rod;
    const rod::Configuration shape = rod_shape(model, state, point.line.rod);
    // The abscissa moved about as far as that of the nearest kept point.
    double s = point.abscissa, nearest = INFINITY;
    for (std::size_t k = 0; k < model.points.size(); ++k) {
      const double apart = std::abs(model.points[k].abscissa - point.abscissa);
      if (model.points[k].unknown < 0 || model.points[k].line != point.line || model.points[k].solid != point.solid ||
          !state.points[k].on || apart >= nearest)
        continue;
      nearest = apart;
      s = point.abscissa + state.points[k].s - model.points[k].abscissa;
    }
    const Vec3 P = solid_point(model, state, point.solid, point.where);
    s = constraint::project(shape, s, P);
    if (s >= 0.0 && s <= rod.length()) gap = std::max(gap, constraint::violation(rod::curve_point(shape, s), P));
  }
  return gap;
}

EnergyBalance energy_balance(const Model& model, const State& state) {
  EnergyBalance balance;
  const Vec3& g = model.scene.gravity;
  for (std::size_t i = 0; i < model.solids.size(); ++i) {
    const solid::Body& body = model.solids[i].body;
    const SolidState& own = state.solids[i];
    balance.kinetic += solid::kinetic_energy(body, own.v);
    balance.elastic += solid::elastic_energy(body, own.x);
    balance.weight -= g.dot((own.x - body.rest) * body.masses);
    const Eigen::Matrix3Xd& springs = model.solids[i].springs;
    if (springs.size() == 0) continue;
    const Eigen::Matrix3Xd drawn = spring_stretch(model.solids[i], moved(model, state, model.solids[i].frame), own.x);
    balance.elastic += 0.5 * springs.cwiseProduct(drawn.cwiseAbs2()).sum();
  }
  for (std::size_t i = 0; i < model.bodies.size(); ++i) {
    const BodyModel& body = model.bodies[i];
    balance.kinetic += rigid::kinetic_energy(body.body, state.bodies[i]);
    balance.weight -= body.body.mass * g.dot(state.bodies[i].p - body.start.p);
  }
  for (std::size_t i = 0; i < model.rods.size(); ++i) {
    const rod::Rod& rod = model.rods[i].rod;
    const RodState& own = state.rods[i];
    balance.elastic += elastic_energy(rod, own);
    balance.kinetic += kinetic_energy(rod, own);
    for (std::size_t m = 0; m < rod.masses.size(); ++m) {
      const auto column = static_cast<Eigen::Index>(m);
      balance.weight -= rod.masses[m].mass * g.dot(own.masses.col(column) - model.start_masses[i].col(column));
    }
  }
  return balance;
}

}  // namespace sinew
