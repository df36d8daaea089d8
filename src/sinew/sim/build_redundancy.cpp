#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "sinew/sim/building.hpp"
#include "sinew/sim/reduced.hpp"
#include "sinew/sim/step.hpp"

namespace sinew::building {

namespace {

/// The largest command of a drive.
double largest_value(const Drive& drive) {
  double most = 0.0;
  if (const Table* table = std::get_if<Table>(&drive)) {
    for (const double value : table->values) most = std::max(most, std::abs(value));
  }
  return most;
}

/// What is told to actuators whose rows depend on each other, at all times of their tables.
void warn_of_contradictions(Model& model, const RedundantRows& redundant) {
  if (is_chosen(model, redundant.rows) || is_carried(model, redundant.rows)) return;
  std::vector<double> times = {0.0};
  for (const ActuatorModel& actuator : model.actuators) {
    if (!std::binary_search(redundant.rows.begin(), redundant.rows.end(), actuator.row)) continue;
    if (const Table* table = std::get_if<Table>(&actuator.drive))
      times.insert(times.end(), table->times.begin(), table->times.end());
  }
  double worst = 0.0, when = 0.0;
  for (const double time : times) {
    Eigen::VectorXd c = Eigen::VectorXd::Zero(model.rows);
    for (const ActuatorModel& actuator : model.actuators) {
      if (actuator.row >= 0) c[actuator.row] = -told_at(actuator.drive, time);
    }
    const double own = redundant.contradiction(c);
    if (own > worst) {
      worst = own;
      when = time;
    }
  }
  if (!(worst > kContradiction * model.size)) return;
  model.warnings.push_back({.code = "contradicting_commands",
                            .where = name_of_rows(model, redundant.rows),
                            .message = "what they are told contradicts each other by " + text(1e3 * worst) +
                                       " mm at t = " + text(when) +
                                       " s: no shape of the robot does both, or only one far from that at the start",
                            .remedy = remedy_of_rows(model, redundant.rows),
                            .value = worst,
                            .limit = kContradiction * model.size,
                            .unit = "m"});
}

}  // namespace

void measure_bearing(Model& model) {
  double mass = 0.0, most = 0.0;
  for (const SolidModel& solid : model.solids) {
    mass += solid.body.masses.sum();
    for (const solid::Material& material : solid.body.materials)
      most = std::max(most, solid::young(solid::lame(material.law)) * solid.mesh.diagonal * solid.mesh.diagonal);
  }
  for (const RodModel& rod : model.rods) {
    for (const rod::MassPoint& point : rod.rod.masses) mass += point.mass;
    const double length = rod.rod.length();
    for (const double s : {0.0, 0.5 * length, length}) {
      const rod::Mat6 stiffness = rod::stiffness_at(rod.rod.profile, s);
      most =
          std::max({most, stiffness(3, 3), stiffness(1, 1) / (length * length), stiffness(2, 2) / (length * length)});
    }
  }
  for (const BodyModel& body : model.bodies) mass += body.body.mass;
  for (const LoadModel& load : model.loads) {
    double acting = 0.0;
    if (const RodLoadModel* on_rod = std::get_if<RodLoadModel>(&load.on)) {
      for (const RodLoadModel::At& at : on_rod->at)
        acting += at.weight * (on_rod->force.norm() + on_rod->moment.norm() / model.size);
    } else {
      const SolidLoadModel& on_solid = std::get<SolidLoadModel>(load.on);
      acting = on_solid.force.size() > 0 ? on_solid.force.colwise().norm().sum() : 0.0;
      acting += std::abs(on_solid.pressure) * model.size * model.size;
    }
    most = std::max(most, acting * std::max(1.0, largest_value(load.factor)));
  }
  for (const ActuatorModel& actuator : model.actuators) {
    if (!actuator.told_force()) continue;
    const double most_told = std::isfinite(actuator.force.most) ? std::abs(actuator.force.most) : 0.0;
    most = std::max(most, std::max(largest_value(actuator.drive), most_told) / (actuator.turns() ? model.size : 1.0));
  }
  most = std::max(most, mass * model.scene.gravity.norm());
  const double step = model.scene.time.step;
  if (model.scene.analysis == Analysis::dynamic) most = std::max(most, mass * model.size / (step * step));
  model.bearing = most > 0.0 ? most : 1.0;
}

void look_for_redundant_rows(Model& model, const State& start) {
  if (model.rows == 0) return;
  const StepContext context = make_context(model, start, command_at(model, 0.0), model.scene.time.step);
  Reduced reduced;
  linearize(context, start, {}, reduced);
  const std::vector<std::vector<int>> groups = find_redundant_rows(model, start, reduced.problem);
  for (const std::vector<int>& rows : join_by_rods(model, groups))
    model.redundant.push_back(redundant_group(model, start, reduced.problem, rows));
  for (const std::vector<int>& rows : groups) {
    const RedundantRows own = redundant_rows(model, start, reduced.problem, rows);
    if (rows.size() == 1) continue;  // of a row that nothing answers (`warn_of_idle_rows`)
    const auto count = own.null.cols();
    Warning warning{.code = "redundant_constraints",
                    .where = name_of_rows(model, rows),
                    .message = std::to_string(rows.size()) +
                               " constraint rows depend on each other: the strains can answer only " +
                               std::to_string(static_cast<long>(rows.size()) - static_cast<long>(count)) +
                               " of them; of the forces that do the same, the smallest are taken",
                    .remedy = remedy_of_rows(model, rows),
                    .value = static_cast<double>(count)};
    // (Rows of the same couplings along another axis read the same.)
    const bool stands = std::any_of(model.warnings.begin(), model.warnings.end(), [&](const Warning& other) {
      return other.where == warning.where && other.message == warning.message;
    });
    if (!stands) model.warnings.push_back(std::move(warning));
    warn_of_contradictions(model, own);
  }
}

}  // namespace sinew::building
