#include "sinew/sim/step_ends.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "sinew/constraint/sliding.hpp"
#include "sinew/sim/internal.hpp"
#include "sinew/sim/places.hpp"
#include "sinew/sim/rod_rows.hpp"

namespace sinew {

State first_guess(const StepContext& context) {
  State guess = context.start;
  for (std::size_t i = 0; i < guess.solids.size(); ++i) {
    const int frame = context.model.solids[i].frame;
    if (frame < 0 || !context.model.scene.frames[frame].second.motion) continue;
    const Placement before = frame_displacement(context.model.scene.frames[frame].second, context.start.time);
    const Placement carry = compose(context.moved(frame), inverse(before));
    Eigen::Matrix3Xd& x = guess.solids[i].x;
    x = ((carry.R * x).colwise() + carry.p).eval();
    const solid::Body& body = context.model.solids[i].body;
    for (int node = 0; node < body.nodes(); ++node) {  // clamped nodes exactly where the frame puts them
      if (body.unknown[node] < 0) x.col(node) = apply(context.moved(frame), body.rest.col(node));
    }
  }
  return guess;
}

void follow_points(const StepContext& context, State& iterate) {
  rod::Configuration shape;  // of the rod of the last point: points of one rod stand together
  int configured = -1;
  for (std::size_t k = 0; k < context.model.points.size(); ++k) {
    const PointModel& point = context.model.points[k];
    if (point.unknown < 0) continue;
    const int number = point.line.rod;
    const rod::Rod& rod = context.model.rods[number].rod;
    if (number != configured) {
      shape = rod::configure(rod, base_of(context, iterate, number), iterate.rods[number].q);
      configured = number;
    }
    const Vec3 P = solid_point(context.model, iterate, point.solid, point.where);
    PointState& state = iterate.points[k];
    state.s = constraint::project(shape, state.s, P);
    state.on = state.s <= rod.length();
    if (!state.on) {
      state.s = rod.length() * (1.0 + 1e-12);
      iterate.lambda.segment<3>(point.row).setZero();
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

/// Work of motors and loads over the step, by the mean of their forces at its ends.
double work(const StepContext& context, const State& next) {
  const Model& model = context.model;
  double sum = 0.0;
  const std::vector<double> before = motor_positions(model, context.start), after = motor_positions(model, next);
  // What is applied from the start acts in full over the first step. Parts of a step and static paths begin with
  // nothing.
  const bool whole = model.scene.analysis != Analysis::statics && context.h > 0.999 * model.scene.time.step;
  const bool first = context.start.time == 0.0 && whole;
  const Command at_start = command_at(model, context.start.time);
  for (std::size_t i = 0; i < model.actuators.size(); ++i) {
    const bool driven = model.actuators[i].row < 0;
    const double force = first && driven ? at_start.actuators[i] : context.start.actuators[i];
    sum += 0.5 * (force + next.actuators[i]) * (after[i] - before[i]);
  }
  for (std::size_t i = 0; i < model.loads.size(); ++i) {
    const LoadModel& load = model.loads[i];
    const rod::Rod& rod = model.rods[load.rod].rod;
    const Placement base = rod_base(model, context.start, load.rod);
    const auto start = rod::configure(rod, {base, context.start.rods[load.rod].turned}, context.start.rods[load.rod].q);
    const auto end = rod::configure(rod, base_of(context, next, load.rod), next.rods[load.rod].q);
    for (const LoadModel::At& at : load.at) {
      const rod::Branch a = rod::branch(start, at.s), b = rod::branch(end, at.s);
      const Vec3 turn = lie::log(b.R * a.R.transpose());
      const Vec3 along =
          load.follower ? Vec3(0.5 * (a.R.transpose() + b.R.transpose()) * (b.p - a.p)) : Vec3(b.p - a.p);
      const Vec3 about = load.follower ? Vec3(a.R.transpose() * turn) : turn;
      sum += 0.5 * ((first ? at_start.loads[i] : context.start.loads[i]) + context.command.loads[i]) * at.weight *
             (load.force.dot(along) + load.moment.dot(about));
    }
  }
  return sum;
}

}  // namespace

void finish(const StepContext& context, const Reduced& reduced, State& next) {
  const Model& model = context.model;
  next.time = context.start.time + context.h;
  for (std::size_t i = 0; i < next.solids.size(); ++i)
    next.solids[i].v = (next.solids[i].x - context.start.solids[i].x) * context.rate;
  for (std::size_t i = 0; i < next.rods.size(); ++i) {
    const rod::Rod& rod = model.rods[i].rod;
    const auto shape = rod::configure(rod, base_of(context, next, static_cast<int>(i)), next.rods[i].q);
    next.rods[i].masses = rod::mass_positions(shape);
    next.rods[i].velocity = (next.rods[i].masses - context.start.rods[i].masses) * context.rate;
    write_internal(reduced.internal[i], next.rods[i]);
  }
  for (std::size_t i = 0; i < next.actuators.size(); ++i) {
    const int row = model.actuators[i].row;
    next.actuators[i] = row < 0 ? context.command.actuators[i] : next.lambda[row];
  }
  next.loads = context.command.loads;
  next.energies.work += work(context, next);
  for (std::size_t i = 0; i < next.rods.size(); ++i) {
    if (model.rods[i].floats) rebase(model.rods[i].rod, next.rods[i]);
  }
}

bool finite(const State& state) {
  for (double number : pack(state)) {
    if (!std::isfinite(number)) return false;
  }
  return true;
}

namespace {

/// A rod may be drawn past the point it enters by this fraction of its length (the motor's guide holds it straight
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

double inertia_of(const StepContext& context) {
  double mass = 0.0;
  for (const RodModel& rod : context.model.rods) {
    for (const rod::MassPoint& point : rod.rod.masses) mass += point.mass;
  }
  return mass * context.rate * context.rate;
}

bool balanced(const Model& model, const Linearization& here, double stiffness) {
  const double tolerance = model.scene.newton.tolerance;
  const double rounding = 1e-14 * stiffness * model.size;
  return here.largest() <= tolerance * here.scale() + rounding && here.violation() <= tolerance * model.size;
}

}  // namespace sinew
