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
#include "sinew/sim/solid_loads.hpp"

namespace sinew {

void place_held(const StepContext& context, State& iterate) {
  for (std::size_t i = 0; i < iterate.solids.size(); ++i) {
    const SolidModel& model = context.model.solids[i];
    for (const int node : model.body.held_nodes) {
      const Vec3 held = apply(context.moved(model.carrier[node]), model.body.rest.col(node));
      for (int axis = 0; axis < 3; ++axis) {
        if (model.body.unknown(axis, node) < 0) iterate.solids[i].x(axis, node) = held[axis];
      }
    }
  }
}

void first_guess(const StepContext& context, State& guess) {
  guess = context.start;
  for (std::size_t i = 0; i < guess.solids.size(); ++i) {
    const int frame = context.model.solids[i].frame;
    if (frame < 0 || !context.model.scene.frames[frame].second.motion) continue;
    const Placement before = frame_displacement(context.model.scene.frames[frame].second, context.start.time);
    const Placement carry = compose(context.moved(frame), inverse(before));
    Eigen::Matrix3Xd& x = guess.solids[i].x;
    for (auto node : x.colwise()) node = (carry.R * node + carry.p).eval();
  }
  place_held(context, guess);
}

void follow_points(const StepContext& context, State& iterate, Linearization& here) {
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
    state.s = constraint::project(shape, state.s, P);
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

/// Work of a load whose factor goes from one value to another.
double work_of(const RodLoadModel& load, const StepContext& context, const State& next, double before, double after) {
  const Model& model = context.model;
  const rod::Rod& rod = model.rods[load.rod].rod;
  const Placement base = rod_base(model, context.start, load.rod);
  const auto start = rod::configure(rod, {base, context.start.rods[load.rod].turned}, context.start.rods[load.rod].q);
  const auto end = rod::configure(rod, base_of(context, next, load.rod), next.rods[load.rod].q);
  double sum = 0.0;
  for (const RodLoadModel::At& at : load.at) {
    const rod::Branch a = rod::branch(start, at.s), b = rod::branch(end, at.s);
    const Vec3 turn = lie::log(b.R * a.R.transpose());
    const Vec3 along = load.follower ? Vec3(0.5 * (a.R.transpose() + b.R.transpose()) * (b.p - a.p)) : Vec3(b.p - a.p);
    const Vec3 about = load.follower ? Vec3(a.R.transpose() * turn) : turn;
    sum += at.weight * (load.force.dot(along) + load.moment.dot(about));
  }
  return 0.5 * (before + after) * sum;
}

double work_of(const SolidLoadModel& load, const StepContext& context, const State& next, double before, double after) {
  const Eigen::Matrix3Xd &from = context.start.solids[load.solid].x, &to = next.solids[load.solid].x;
  const Eigen::Matrix3Xd force = before * load_forces(load, from) + after * load_forces(load, to);
  return 0.5 * force.cwiseProduct(to - from).sum();
}

/// Work of what holds a solid where it is held to move, and of the frame that its springs pull at.
double work_of_supports(const StepContext& context, const State& next, int number) {
  const SolidModel& model = context.model.solids[number];
  const SolidState &from = context.start.solids[number], &to = next.solids[number];
  double sum = 0.0;
  Eigen::Index held = 0;
  solid::each_held(model.body, [&](int axis, int node) {
    sum += 0.5 * (from.reaction[held] + to.reaction[held]) * (to.x(axis, node) - from.x(axis, node));
    ++held;
  });
  if (model.springs.size() == 0) return sum;
  const Placement before = moved(context.model, context.start, model.frame), after = context.moved(model.frame);
  const Eigen::Matrix3Xd drawn = 0.5 * (spring_stretch(model, before, from.x) + spring_stretch(model, after, to.x));
  const Eigen::Matrix3Xd carried = ((after.R - before.R) * model.body.rest).colwise() + Vec3(after.p - before.p);
  return sum - model.springs.cwiseProduct(drawn).cwiseProduct(carried).sum();
}

/// Work of motors, loads, supports and grips over the step, by the mean of their forces at its ends.
double work(const StepContext& context, const State& next) {
  const Model& model = context.model;
  double sum = 0.0;
  // What is applied from the start acts in full over the first step. Parts of a step and static paths begin with
  // nothing.
  const bool whole = model.scene.analysis != Analysis::statics && context.h > 0.999 * model.scene.time.step;
  const bool first = context.start.time == 0.0 && whole;
  for (std::size_t i = 0; i < model.actuators.size(); ++i) {
    const ActuatorModel& actuator = model.actuators[i];
    const double force =
        first && actuator.told_force() ? told_at(actuator.drive, context.start.time) : context.start.actuators[i];
    const double moved = motor_position(model, next, actuator) - motor_position(model, context.start, actuator);
    sum += 0.5 * (force + next.actuators[i]) * moved;
  }
  for (std::size_t i = 0; i < model.loads.size(); ++i) {
    const double before = first ? told_at(model.loads[i].factor, context.start.time) : context.start.loads[i];
    const double after = context.command.loads[i];
    sum += std::visit([&](const auto& load) { return work_of(load, context, next, before, after); }, model.loads[i].on);
  }
  for (std::size_t i = 0; i < model.solids.size(); ++i) sum += work_of_supports(context, next, static_cast<int>(i));
  for (const Grip& grip : context.command.grips) {
    const Vec3 from = context.start.solids[grip.solid].x.col(grip.node), to = next.solids[grip.solid].x.col(grip.node);
    sum += grip.stiffness * (grip.to - 0.5 * (from + to)).dot(to - from);
  }
  return sum;
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
  }
  for (std::size_t i = 0; i < next.bodies.size(); ++i)
    rigid::set_velocities(context.start.bodies[i], context.rate, next.bodies[i]);
  for (std::size_t i = 0; i < next.actuators.size(); ++i)
    next.actuators[i] = motor_force(model, context.command, next, static_cast<int>(i));
  next.loads = context.command.loads;
  next.energies.work += work(context, next);
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
    if (tie.about.empty()) continue;
    const auto shape =
        rod::configure(context.model.rods[tie.rod].rod, base_of(context, state, tie.rod), state.rods[tie.rod].q);
    const rod::Mat3 axes = holder_axes(context, state, tie);
    const rod::Mat3 own = rod::branch(shape, tie.s).R * tie.own_axes;
    for (const int a : tie.about) {
      for (const int k : {(a + 1) % 3, (a + 2) % 3}) {
        if (!(axes.col(k).dot(own.col(k)) > 0.0)) return true;
      }
    }
  }
  return false;
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

bool balanced(const Model& model, const Linearization& here, double stiffness) {
  const double tolerance = model.scene.newton.tolerance;
  const double rounding = 1e-14 * stiffness * model.size;
  return here.largest() <= tolerance * here.scale() + rounding && here.violation() <= tolerance * model.size;
}

}  // namespace sinew
