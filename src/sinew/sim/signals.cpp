#include "sinew/sim/signals.hpp"

#include <algorithm>
#include <cmath>

#include "sinew/constraint/sliding.hpp"
#include "sinew/sim/effectors.hpp"
#include "sinew/sim/internal.hpp"
#include "sinew/sim/places.hpp"
#include "sinew/sim/solid_loads.hpp"

namespace sinew {

namespace {

std::vector<std::string> named(const std::string& name, std::initializer_list<const char*> parts) {
  std::vector<std::string> names;
  for (const char* part : parts) names.push_back(name + "." + part);
  return names;
}

template <class Vector>
std::vector<double> numbers(const Vector& v) {
  return {v.data(), v.data() + v.size()};
}

/// A symmetric tensor as xx yy zz yz xz xy.
std::vector<double> six(const solid::Mat3& t) { return {t(0, 0), t(1, 1), t(2, 2), t(1, 2), t(0, 2), t(0, 1)}; }

/// Sum over the chosen nodes' held coordinates.
Vec3 reaction(const Model& model, const State& state, const OutputModel& output) {
  const solid::Body& body = model.solids[output.solid].body;
  Vec3 sum = Vec3::Zero();
  Eigen::Index held = 0;
  for (int node = 0; node < body.nodes(); ++node) {
    for (int axis = 0; axis < 3; ++axis) {
      if (body.unknown(axis, node) >= 0) continue;
      if (output.nodes[node]) sum[axis] += state.solids[output.solid].reaction[held];
      ++held;
    }
  }
  return sum;
}

SignalGroup position_group(const OutputModel& output) {
  return {named(output.name, {"x", "y", "z"}),
          [=](const Model& model, const State& state) { return numbers(output_position(model, state, output)); }};
}

SignalGroup orientation_group(const OutputModel& output) {
  return {named(output.name, {"x", "y", "z"}),
          [=](const Model& model, const State& state) { return numbers(output_turn(model, state, output)); }};
}

// Without a default, so that the compiler asks where a new quantity belongs.
SignalGroup solid_group(const OutputModel& output) {
  static constexpr std::initializer_list<const char*> kSix = {"xx", "yy", "zz", "yz", "xz", "xy"};
  static constexpr std::initializer_list<const char*> kStress = {
      "xx", "yy", "zz", "yz", "xz", "xy", "von_mises", "principal_1", "principal_2", "principal_3"};
  const int solid = output.solid;
  switch (output.quantity) {
    case Quantity::displacement:
      return {named(output.name, {"x", "y", "z"}), [=](const Model& model, const State& state) {
                const solid::Body& body = model.solids[solid].body;
                return numbers(
                    Vec3(output_position(model, state, output) - solid::position(output.where, body.cells, body.rest)));
              }};
    case Quantity::strain:
      return {named(output.name, kSix), [=](const Model& model, const State& state) {
                return six(solid::green_strain(model.solids[solid].body, output.where, state.solids[solid].x));
              }};
    case Quantity::stress:
      return {named(output.name, kStress), [=](const Model& model, const State& state) {
                const solid::Mat3 stress =
                    solid::cauchy_stress(model.solids[solid].body, output.where, state.solids[solid].x);
                std::vector<double> values = six(stress);
                values.push_back(solid::von_mises(stress));
                const Vec3 principal = solid::principal_values(stress);
                values.insert(values.end(), principal.begin(), principal.end());
                return values;
              }};
    case Quantity::reaction:
      return {named(output.name, {"x", "y", "z"}),
              [=](const Model& model, const State& state) { return numbers(reaction(model, state, output)); }};
    case Quantity::orientation:
      return orientation_group(output);
    case Quantity::position:
    case Quantity::force:
    case Quantity::moment:
      break;
  }
  return position_group(output);
}

/// Force [N] of all that touches a body.
Vec3 touching_force(const Model& model, const State& state, int body) {
  const Collider own{Collider::Kind::body, body};
  Vec3 sum = Vec3::Zero();
  for (const ContactState& contact : state.contacts) {
    const PairModel& pair = model.pairs[contact.pair];
    if (pair.b == own) sum += force_on_second(contact);
    if (pair.a == own) sum -= force_on_second(contact);
  }
  return sum;
}

SignalGroup body_group(const OutputModel& output) {
  const int body = output.body;
  const bool force = output.quantity == Quantity::force;
  if (output.quantity == Quantity::orientation) return orientation_group(output);
  return {named(output.name, {"x", "y", "z"}), [=](const Model& model, const State& state) {
            return numbers(force ? touching_force(model, state, body) : state.bodies[body].p);
          }};
}

SignalGroup pair_group(const OutputModel& output) {
  const int pair = output.pair;
  const double sign = output.turned ? 1.0 : -1.0;
  return {named(output.name, {"x", "y", "z", "normal", "contacts", "sliding", "gap"}),
          [=](const Model& model, const State& state) {
            Vec3 sum = Vec3::Zero();
            double contacts = 0.0, sliding = 0.0;
            for (const ContactState& own : state.contacts) {
              if (own.pair != pair) continue;
              sum += sign * force_on_second(own);
              if (own.force.isZero()) continue;  // only watched
              contacts += 1.0;
              sliding += slides(model, own) ? 1.0 : 0.0;
            }
            const auto [normal, gap] = pressing_of(state, pair);
            return std::vector<double>{
                sum.x(), sum.y(), sum.z(), normal, contacts, sliding, std::isfinite(gap) ? gap : 0.0};
          }};
}

SignalGroup output_group(const OutputModel& output) {
  if (output.solid >= 0) return solid_group(output);
  if (output.body >= 0) return body_group(output);
  if (output.pair >= 0) return pair_group(output);
  const int rod = output.rod;
  const double s = output.abscissa;
  switch (output.quantity) {
    case Quantity::strain:
      return {named(output.name, {"torsion", "bending_y", "bending_z", "elongation", "shear_y", "shear_z"}),
              [=](const Model& model, const State& state) {
                return numbers(rod::strain(model.rods[rod].rod, state.rods[rod].q, s));
              }};
    case Quantity::force:
      return {named(output.name, {"x", "y", "z"}), [=](const Model& model, const State& state) {
                return numbers(Vec3(internal_wrench(model, state, rod, s).tail<3>()));
              }};
    case Quantity::moment:
      return {named(output.name, {"x", "y", "z"}), [=](const Model& model, const State& state) {
                return numbers(Vec3(internal_wrench(model, state, rod, s).head<3>()));
              }};
    case Quantity::stress:
      return {named(output.name, {"axial", "bending", "torsion", "von_mises"}),
              [=](const Model& model, const State& state) {
                const rod::SectionStress stress = section_stress(model, state, rod, s);
                return std::vector<double>{stress.axial, stress.bending, stress.torsion, stress.von_mises};
              }};
    case Quantity::orientation:
      return orientation_group(output);
    case Quantity::position:
    case Quantity::displacement:
    case Quantity::reaction:
      break;
  }
  return position_group(output);
}

SignalGroup motor_group(const Model& all) {
  SignalGroup group;
  for (const ActuatorModel& actuator : all.actuators) {
    const MotorWords words = words_of(actuator);
    group.names.push_back(actuator.name + "." + words.position);
    group.names.push_back(actuator.name + "." + words.force);
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
  const std::string name = all.outputs[effector.output].name + ".target";
  SignalGroup group;
  if (effector.size == 1) {
    group.names = {name};
  } else {
    group.names = named(name, {"x", "y", "z"});
  }
  group.names.push_back(all.outputs[effector.output].name + ".error");
  group.values = [number](const Model& model, const State& state) {
    const EffectorModel& own = model.effectors[number];
    const Goal goal = goal_at(model, state.time);
    Eigen::VectorXd errors;
    effector_errors(model, state, goal, errors);
    std::vector<double> values = numbers(Eigen::VectorXd(goal.at.segment(own.first, own.size)));
    values.push_back(error_of(own, errors));
    return values;
  };
  return group;
}

SignalGroup energy_group() {
  return {named("energy", {"kinetic", "elastic", "weight", "work", "dissipated"}),
          [](const Model& model, const State& state) {
            const EnergyBalance now = energy_balance(model, state);
            return std::vector<double>{now.kinetic, now.elastic, now.weight, state.energies.work,
                                       model.start_energy + state.energies.work - now.total()};
          }};
}

}  // namespace

std::vector<SignalGroup> signal_groups(const Model& model) {
  std::vector<SignalGroup> groups;
  if (model.scene.analysis == Analysis::modal) {
    groups.push_back(
        {{"mode.frequency"}, [](const Model&, const State& state) { return std::vector<double>{state.frequency}; }});
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

std::vector<std::string> signal_names(const Model& model) {
  std::vector<std::string> names;
  for (const SignalGroup& group : signal_groups(model))
    names.insert(names.end(), group.names.begin(), group.names.end());
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

Vec3 output_position(const Model& model, const State& state, const OutputModel& output) {
  if (output.solid >= 0) return solid_point(model, state, output.solid, output.where);
  if (output.body >= 0) return state.bodies[output.body].p;
  return rod::position(rod_shape(model, state, output.rod), output.abscissa);
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
    if (s <= rod.length()) gap = std::max(gap, constraint::violation(rod::curve_point(shape, s), P));
  }
  return gap;
}

EnergyBalance energy_balance(const Model& model, const State& state) {
  EnergyBalance balance;
  const Vec3& g = model.scene.gravity;
  for (std::size_t i = 0; i < model.solids.size(); ++i) {
    const solid::Body& body = model.solids[i].body;
    const SolidState& own = state.solids[i];
    balance.kinetic += 0.5 * own.v.cwiseProduct(own.v * body.mass).sum();
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
    for (int k = 0; k < rod.count(); ++k) {
      const auto q = rod.of_section(own.q, k);
      balance.elastic += 0.5 * q.dot(rod.sections[k].stiffness * q);
    }
    for (std::size_t m = 0; m < rod.masses.size(); ++m) {
      const auto column = static_cast<Eigen::Index>(m);
      balance.kinetic += 0.5 * rod.masses[m].mass * own.velocity.col(column).squaredNorm();
      balance.weight -= rod.masses[m].mass * g.dot(own.masses.col(column) - model.start_masses[i].col(column));
    }
  }
  return balance;
}

}  // namespace sinew
