#include "sinew/sim/step_ends.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <cstdio>

#include "sinew/constraint/sliding.hpp"
#include "sinew/sim/internal.hpp"
#include "sinew/sim/motors.hpp"
#include "sinew/sim/places.hpp"
#include "sinew/sim/rod_rows.hpp"
#include "sinew/sim/work.hpp"

namespace sinew {

void follow_points(const StepContext& context, State& iterate, Linearization& here, Rows rows) {
  int configured = -1;  // points of one rod stand together
  for (std::size_t k = 0; k < context.model.points.size(); ++k) {
    const PointModel& point = context.model.points[k];
    if (point.unknown < 0) continue;
    const int number = point.line.rod;
    const rod::Rod& rod = context.model.rods[number].rod;
    rod::Configuration& shape = here.shape(number);
    if (number != configured) {
      rod::reconfigure(rod, base_of(context, iterate, number), iterate.rods[number].q, shape);
      configured = number;
    }
    const Vec3 P = solid_point(context.model, iterate, point.solid, point.where);
    PointState& state = iterate.points[k];
    if (rows == Rows::stay && !state.on) continue;
    state.s = constraint::project(shape, state.s, P);
    if (rows == Rows::stay) continue;
    state.on = state.s <= rod.length();
    if (!state.on) {
      state.s = rod.length() * (1.0 + 1e-12);
      iterate.lambda.segment<3>(point.row).setZero();
      state.friction = 0.0;
    }
  }
}

namespace {

/// A base that turns freely in all three directions counts its turns from where it is now, so they never come near the
/// axes' gimbal lock.
void rebase(const rod::Rod& rod, RodState& state) {
  for (int i = 0; i < rod.base_coordinates(); ++i) {
    if (!rod.base[i].turns) continue;
    state.turned = state.turned * lie::exp(state.q[i] * rod.base[i].sign * Vec3::Unit(rod.base[i].axis));
    state.q[i] = 0.0;
  }
}

}  // namespace

void write_forces(const Linearization& here, State& next) {
  for (std::size_t i = 0; i < next.solids.size(); ++i) next.solids[i].reaction = here.forces()[i].reaction;
  for (std::size_t i = 0; i < next.rods.size(); ++i) write_internal(here.reduced().internal[i], next.rods[i]);
}

void finish(const StepContext& context, State& next, Linearization& here) {
  const Model& model = context.model;
  next.time = context.start.time + context.h;
  for (std::size_t i = 0; i < next.solids.size(); ++i)
    next.solids[i].v = (next.solids[i].x - context.start.solids[i].x) * context.rate;
  for (std::size_t i = 0; i < next.rods.size(); ++i) {
    RodState& own = next.rods[i];
    rod::Configuration& shape = here.shape(static_cast<int>(i));
    rod::reconfigure(model.rods[i].rod, base_of(context, next, static_cast<int>(i)), own.q, shape);
    rod::mass_positions(shape, own.masses);
    own.velocity = (own.masses - context.start.rods[i].masses) * context.rate;
    own.q_rate = (own.q - context.start.rods[i].q) * context.rate;
  }
  for (std::size_t i = 0; i < next.bodies.size(); ++i)
    rigid::set_velocities(context.start.bodies[i], context.rate, next.bodies[i]);
  for (std::size_t i = 0; i < next.actuators.size(); ++i)
    next.actuators[i] = motor_force(model, context.command, next, static_cast<int>(i));
  next.loads = context.command.loads;
  Work done = work(context, next, here.contacts().touches);
  if (context.rate > 0.0) done += work_of_lifting(model, next, here.contacts());
  next.energies.work += done.mean();
  next.energies.work_bound += done.bound();
  for (std::size_t i = 0; i < next.rods.size(); ++i) {
    if (model.rods[i].floats) rebase(model.rods[i].rod, next.rods[i]);
  }
}

namespace {

/// A rod may be pushed in past the point it enters by this fraction of its length (the motor's guide holds it straight
/// there).
constexpr double kGuide = 0.01;

}  // namespace

bool turned_over(const StepContext& context, const State& state) {
  for (const TieModel& tie : context.model.ties) {
    if (tie.about.size() < 2) continue;
    const auto shape =
        rod::configure(context.model.rods[tie.rod].rod, base_of(context, state, tie.rod), state.rods[tie.rod].q);
    const rod::Mat3 axes = holder_axes(context, state, tie);
    const rod::Mat3 own = rod::branch(shape, tie.s).R * tie.own_axes;
    for (const int a : tie.about) {
      const int k = held_turn(tie, a).carried;
      if (!(axes.col(k).dot(own.col(k)) > 0.0)) return true;
    }
  }
  return false;
}

const RodModel* spun_round(const StepContext& context, const State& next) {
  if (context.rate == 0.0) return nullptr;
  for (std::size_t i = 0; i < next.rods.size(); ++i) {
    const RodModel& model = context.model.rods[i];
    const RodState &start = context.start.rods[i], &end = next.rods[i];
    if (end.masses.cols() == 0) continue;
    // What drives a turn says how far it goes.
    const auto driven = [&](int unknown) {
      const auto& actuators = context.model.actuators;
      return std::any_of(actuators.begin(), actuators.end(),
                         [&](const ActuatorModel& own) { return own.unknown == unknown && !own.told_force(); });
    };
    bool beyond = model.floats && (start.turned.transpose() * end.turned).trace() < 1.0;  // 1 + 2 cos of the angle
    for (int k = 0; k < model.rod.base_coordinates() && !model.floats; ++k)
      beyond |= model.rod.base[k].turns && std::abs(end.q[k] - start.q[k]) > 0.5 * M_PI && !driven(model.unknown + k);
    if (beyond) return &model;
  }
  return nullptr;
}

const RodModel* exhausted(const Model& model, const State& state) {
  for (std::size_t k = 0; k < model.points.size(); ++k) {
    if (model.points[k].unknown < 0) continue;
    const RodModel& rod = model.rods[model.points[k].line.rod];
    if (state.points[k].s < -kGuide * rod.rod.length()) return &rod;
  }
  return nullptr;
}

std::string broken_cell(const Model& model, const State& state) {
  for (std::size_t i = 0; i < model.solids.size(); ++i) {
    const solid::Body& body = model.solids[i].body;
    if (!state.solids[i].x.allFinite()) continue;
    for (const int cell : solid::ended_cells(body, state.solids[i].x)) {
      const Vec3 rest = body.at_nodes(cell, body.rest).rowwise().mean();
      char text[160];
      std::snprintf(text, sizeof text, "cell %d, at rest near (%.4g, %.4g, %.4g) m", cell, rest.x(), rest.y(),
                    rest.z());
      return "solids." + model.solids[i].name + ": " + text;
    }
  }
  return "";
}

double inertia_of(const StepContext& context) {
  double mass = 0.0;
  for (const RodModel& rod : context.model.rods) {
    for (const rod::MassPoint& point : rod.rod.masses) mass += point.mass;
  }
  for (const BodyModel& body : context.model.bodies) mass += body.body.mass;
  return mass * context.rate * context.rate;
}

Convergence convergence_of(const Model& model, const Linearization& here, double stiffness) {
  const double tolerance = model.scene.newton.tolerance;
  constexpr double kNothing = 1e-20;  // of what bodies bear: where no force acts, what is left is no force either
  const double floor = 1e-14 * stiffness * model.size + kNothing * model.bearing,
               allowed = tolerance * here.scale() + floor;
  const bool forces = here.largest() <= allowed;
  return {forces && here.violation() <= tolerance * model.size, forces && here.largest() > tolerance * here.scale(),
          allowed};
}

}  // namespace sinew
