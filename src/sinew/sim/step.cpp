#include "sinew/sim/step.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "sinew/constraint/sliding.hpp"
#include "sinew/rod/kinematics.hpp"
#include "sinew/sim/clock.hpp"
#include "sinew/sim/places.hpp"
#include "sinew/sim/reduced.hpp"

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

Workspace make_workspace(const Model& model) {
  Workspace workspace;
  workspace.solids = std::vector<Workspace::Solid>(model.solids.size());
  for (std::size_t i = 0; i < model.solids.size(); ++i) {
    workspace.solids[i].matrix = model.solids[i].matrix;
    workspace.solids[i].cholesky.analyze(model.solids[i].matrix);
  }
  return workspace;
}

namespace {

/// First guess of the end of the step: where the start is, carried along by moving frames.
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

/// Abscissae of sliding points, continued from their last value; rows whose point has left the rod's end go off, those
/// that the end has reached again come on.
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
    const Vec3 P =
        solid::position(point.where, context.model.solids[point.solid].body.tetrahedra, iterate.solids[point.solid].x);
    PointState& state = iterate.points[k];
    state.s = constraint::project(shape, state.s, P);
    state.on = state.s <= rod.length();
    if (!state.on) {
      state.s = rod.length() * (1.0 + 1e-12);
      iterate.lambda.segment<3>(point.row).setZero();
    }
  }
}

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
  for (std::size_t i = 0; i < model.actuators.size(); ++i)
    sum += 0.5 * (context.start.actuators[i] + next.actuators[i]) * (after[i] - before[i]);
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
      sum += 0.5 * (context.start.loads[i] + context.command.loads[i]) * at.weight *
             (load.force.dot(along) + load.moment.dot(about));
    }
  }
  return sum;
}

/// Velocities, mass points and what else belongs to an accepted step.
void finish(const StepContext& context, const Reduced& reduced, State& next) {
  const Model& model = context.model;
  next.time = context.start.time + context.h;
  for (std::size_t i = 0; i < next.solids.size(); ++i)
    next.solids[i].v = (next.solids[i].x - context.start.solids[i].x) * context.rate;
  for (std::size_t i = 0; i < next.rods.size(); ++i) {
    const rod::Rod& rod = model.rods[i].rod;
    const auto shape = rod::configure(rod, base_of(context, next, static_cast<int>(i)), next.rods[i].q);
    rod::Branch at;
    double s = -1.0;
    for (std::size_t m = 0; m < rod.masses.size(); ++m) {
      if (rod.masses[m].s != s) at = rod::branch(shape, s = rod.masses[m].s);
      next.rods[i].masses.col(static_cast<Eigen::Index>(m)) = at.p + at.R * rod.masses[m].offset;
    }
    next.rods[i].velocity = (next.rods[i].masses - context.start.rods[i].masses) * context.rate;
    next.rods[i].internal = reduced.internal[i];
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

bool finite(const solve::CoupledProblem& problem) {
  return problem.r.allFinite() && problem.c.allFinite() &&
         std::all_of(problem.chains.begin(), problem.chains.end(),
                     [](const solve::ChainPart& part) { return part.r.allFinite(); });
}

bool finite(const State& state) {
  for (double number : pack(state)) {
    if (!std::isfinite(number)) return false;
  }
  return true;
}

/// A rod may be drawn past the point it enters by this fraction of its length (the motor's guide holds it straight
/// there).
constexpr double kGuide = 0.01;

}  // namespace

StepResult step(const Model& model, Workspace& workspace, const Command& command, const State& state, double h) {
  const StepContext context = make_context(model, state, command, h);
  State iterate = first_guess(context);
  follow_points(context, iterate);

  StepReport report;
  const Newton& newton = model.scene.newton;
  const bool fixed = newton.iterations > 0;
  const solid::Tangent tangent = fixed ? solid::Tangent::rotated : solid::Tangent::exact;
  double stiffness = 0.0;
  Reduced reduced;
  const auto fail = [&](Status status, std::string detail) -> StepResult {
    report.status = status;
    report.detail = std::move(detail);
    return {state, report};
  };

  for (;; ++report.newton) {
    // Where are we: unbalanced forces of volumes and rods, violation of the rows.
    std::vector<SolidForces> forces;
    double largest = 0.0, scale = 0.0;
    {
      const Clock clock(report.times.forces);
      for (std::size_t i = 0; i < model.solids.size(); ++i) {
        forces.push_back(solid_forces(context, iterate, static_cast<int>(i)));
        largest = std::max(largest, forces.back().largest);
        scale = std::max(scale, forces.back().scale);
      }
    }
    {
      const Clock clock(report.times.rods);
      reduced = linearize(context, iterate);
      largest = std::max(largest, reduced.largest);
      scale = std::max(scale, reduced.scale);
    }
    report.residual = scale > 0.0 ? largest / scale : 0.0;
    report.violation = reduced.violation;
    const bool finite_forces =
        std::all_of(forces.begin(), forces.end(), [](const SolidForces& f) { return f.r.allFinite(); }) &&
        finite(reduced.problem);
    if (!finite_forces || !std::isfinite(largest) || !std::isfinite(reduced.violation))
      return fail(Status::diverged, "forces are not finite");
    const double rounding = 1e-14 * stiffness * model.size;
    const bool met =
        largest <= newton.tolerance * scale + rounding && reduced.violation <= newton.tolerance * model.size;
    if (fixed ? report.newton == newton.iterations : (met && report.newton > 0)) break;
    if (!fixed && report.newton == newton.limit) return fail(Status::max_iterations, "");

    // (10): free motion of the volumes; (11): their compliance; (12): multipliers and rods; then the correction.
    std::vector<FreeMotion> free;
    for (std::size_t i = 0; i < model.solids.size(); ++i) {
      free.push_back(free_motion(context, workspace, iterate, forces[i], static_cast<int>(i), tangent, report.times));
      if (!free.back().ok) return fail(Status::singular, "solids." + model.solids[i].name);
      report.rotated |= free.back().rotated;
      stiffness = std::max(stiffness, free.back().stiffness);
    }
    solve::CoupledSolution solution;
    {
      const Clock clock(report.times.solve);
      add_compliance(context, free, reduced.problem);
      solution = solve::solve_direct(reduced.problem);
    }
    report.redundant |= solution.redundant;
    if (!solution.ok) return fail(Status::singular, "constraint rows and rods");

    std::vector<Eigen::Matrix3Xd> dx;
    double farthest = 0.0;
    for (std::size_t i = 0; i < model.solids.size(); ++i) {
      dx.push_back(corrected_motion(context, workspace, free[i], static_cast<int>(i), solution.dlambda));
      farthest = std::max(farthest, dx.back().cwiseAbs().maxCoeff());
    }
    // A linearisation is worth nothing beyond a good part of a radian or of the body's size.
    const double turn = largest_turn(context, solution);
    double fraction = 1.0;
    if (!fixed && turn > 0.8) fraction = 0.8 / turn;
    if (!fixed && farthest > 0.3 * model.size) fraction = std::min(fraction, 0.3 * model.size / farthest);
    for (std::size_t i = 0; i < model.solids.size(); ++i) iterate.solids[i].x += fraction * dx[i];
    advance_reduced(context, solution, fraction, iterate);
  }

  finish(context, reduced, iterate);
  if (!finite(iterate)) return fail(Status::diverged, "the new state is not finite");
  for (std::size_t k = 0; k < model.points.size(); ++k) {
    const PointModel& point = model.points[k];
    if (point.unknown < 0) continue;
    const RodModel& rod = model.rods[point.line.rod];
    if (iterate.points[k].s < -kGuide * rod.rod.length()) return fail(Status::rod_exhausted, "rods." + rod.name);
  }
  report.status = fixed ? Status::linearized : Status::converged;
  return {std::move(iterate), report};
}

}  // namespace sinew
