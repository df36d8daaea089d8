#include "sinew/sim/signals.hpp"

#include <algorithm>
#include <cmath>

#include "sinew/constraint/sliding.hpp"
#include "sinew/rod/kinematics.hpp"
#include "sinew/rod/section.hpp"

namespace sinew {

namespace {

Placement base_now(const Model& model, const State& state, const RodModel& rod) {
  if (rod.frame < 0) return rod.base;
  return compose(frame_displacement(model.scene.frames[rod.frame].second, state.time), rod.base);
}

RodSnapshot sample_cable(const Model& model, const State& state, std::size_t number) {
  const RodModel& rod = model.rods[number];
  const Eigen::VectorXd& z = state.rods[number].q;
  const Placement base = base_now(model, state, rod);
  const int m = rod.cable.points + 1;
  RodSnapshot sample;
  sample.name = rod.name;
  sample.abscissa.resize(m);
  sample.points.resize(3, m);
  sample.tangents.resize(3, m);
  sample.points.col(0) = base.p - z[0] * base.R.col(0);
  for (int i = 0; i + 1 < m; ++i) sample.points.col(i + 1) = z.segment<3>(1 + 3 * i);
  sample.abscissa[0] = 0.0;
  for (int i = 1; i < m; ++i) {
    const Vec3 d = sample.points.col(i) - sample.points.col(i - 1);
    sample.abscissa[i] = sample.abscissa[i - 1] + d.norm();
    sample.tangents.col(i) = d.norm() > 0.0 ? d.normalized() : Vec3(base.R.col(0));
  }
  sample.tangents.col(0) = m > 1 ? Vec3(sample.tangents.col(1)) : Vec3(base.R.col(0));
  return sample;
}

RodSnapshot sample_rod(const Model& model, const State& state, std::size_t number) {
  const RodModel& rod = model.rods[number];
  if (rod.geometric) return sample_cable(model, state, number);
  constexpr int kPerSection = 4;
  const Eigen::VectorXd& q = state.rods[number].q;
  const rod::Configuration shape = rod::configure(rod.rod, base_now(model, state, rod), q);
  const int m = rod.rod.sections() * kPerSection + 1;
  RodSnapshot sample;
  sample.name = rod.name;
  sample.radius = rod.rod.radius;
  sample.abscissa.resize(m);
  sample.points.resize(3, m);
  sample.tangents.resize(3, m);
  sample.strains.resize(6, m);
  sample.stresses.resize(6, m);
  sample.von_mises.resize(m);
  for (int j = 0; j < m; ++j) {
    const int section = std::min(j / kPerSection, rod.rod.sections() - 1);
    const double s =
        rod.rod.ends[section] + rod.rod.section_length(section) * (j - section * kPerSection) / kPerSection;
    const rod::CurvePoint point = rod::curve_point(shape, s);
    sample.abscissa[j] = s;
    sample.points.col(j) = point.position;
    sample.tangents.col(j) = point.derivative.normalized();
    sample.strains.col(j) = rod::strain(rod.rod, q, section);
    // Strains outside the basis are constraints: their stress is a reaction that Hooke's law does not know, shown as 0.
    rod::Vec6 stress = rod::Vec6::Zero();
    for (int c = 0; c < rod.rod.strains(); ++c) {
      const int k = rod.rod.basis[c], i = section * rod.rod.strains() + c;
      stress[k] = rod.rod.stiffness[section][k] * (q[rod.rod.base_coordinates() + i] - rod.rod.rest[i]);
    }
    sample.stresses.col(j) = stress;
    sample.von_mises[j] = rod::round_section_von_mises(rod.rod.radius, stress);
  }
  return sample;
}

}  // namespace

Vec3 output_position(const Model& model, const State& state, const OutputModel& output) {
  if (output.solid >= 0)
    return solid::position(output.where, model.solids[output.solid].body.tetrahedra, state.solids[output.solid].x);
  const RodModel& rod = model.rods[output.rod];
  return rod::position(rod::configure(rod.rod, base_now(model, state, rod), state.rods[output.rod].q), output.abscissa);
}

std::vector<std::string> signal_names(const Model& model) {
  std::vector<std::string> names;
  for (const OutputModel& output : model.outputs) {
    for (const char* axis : {".x", ".y", ".z"}) names.push_back(output.name + axis);
  }
  for (const ActuatorModel& actuator : model.actuators) {
    const bool turns = actuator.motion == Motion::rotation;
    names.push_back(actuator.name + (turns ? ".angle" : ".displacement"));
    names.push_back(actuator.name + (turns ? ".torque" : ".force"));
  }
  return names;
}

std::vector<double> signal_values(const Model& model, const State& state) {
  std::vector<double> values;
  for (const OutputModel& output : model.outputs) {
    const Vec3 x = output_position(model, state, output);
    values.insert(values.end(), x.begin(), x.end());
  }
  for (std::size_t i = 0; i < model.actuators.size(); ++i) {
    const ActuatorModel& actuator = model.actuators[i];
    values.push_back(state.rods[actuator.rod].q[actuator.unknown - model.rods[actuator.rod].offset]);
    values.push_back(state.actuators[i]);
  }
  return values;
}

double dropped_gap(const Model& model, const State& state) {
  double gap = 0.0;
  for (const PointModel& point : model.dropped) {
    const RodModel& rod = model.rods[point.rod];
    if (rod.geometric) continue;
    const rod::Configuration shape = rod::configure(rod.rod, base_now(model, state, rod), state.rods[point.rod].q);
    // The abscissa moved about as far as that of the nearest kept point.
    double s = point.abscissa, nearest = INFINITY;
    for (std::size_t k = 0; k < model.points.size(); ++k) {
      const double apart = std::abs(model.points[k].abscissa - point.abscissa);
      if (model.points[k].rod != point.rod || model.points[k].solid != point.solid || !state.points[k].on ||
          apart >= nearest)
        continue;
      nearest = apart;
      s = point.abscissa + state.points[k].s - model.points[k].abscissa;
    }
    const Vec3 P = solid::position(point.where, model.solids[point.solid].body.tetrahedra, state.solids[point.solid].x);
    s = constraint::project(shape, s, P);
    if (s <= rod.rod.length()) gap = std::max(gap, constraint::violation(shape, s, P));
  }
  return gap;
}

Snapshot snapshot(const Model& model, const State& state, const std::string& status) {
  Snapshot view;
  view.time = state.time;
  view.status = status;
  for (std::size_t i = 0; i < model.solids.size(); ++i) {
    const SolidModel& solid = model.solids[i];
    view.solids.push_back({solid.name, solid.body.rest, state.solids[i].x, solid.body.tetrahedra, solid.surface,
                           solid::von_mises(solid.body, state.solids[i].x)});
  }
  for (std::size_t i = 0; i < model.rods.size(); ++i) view.rods.push_back(sample_rod(model, state, i));
  for (std::size_t k = 0; k < model.points.size(); ++k) {
    if (!state.points[k].on) continue;
    const PointModel& point = model.points[k];
    view.sliding_points.push_back(
        {"", solid::position(point.where, model.solids[point.solid].body.tetrahedra, state.solids[point.solid].x)});
  }
  for (const OutputModel& output : model.outputs)
    view.outputs.push_back({output.name, output_position(model, state, output)});
  return view;
}

}  // namespace sinew
