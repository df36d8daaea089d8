#include "sinew/sim/step.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "sinew/constraint/sliding.hpp"
#include "sinew/rod/kinematics.hpp"
#include "sinew/sim/clock.hpp"
#include "sinew/sim/reduced.hpp"

namespace sinew {

Command command_at(const Model& model, double time) {
  Command command;
  for (const ActuatorModel& actuator : model.actuators) {
    const Table* table = std::get_if<Table>(&actuator.drive);
    command.push_back(table ? value_at(*table, time) : 0.0);
  }
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
    const RodModel& rod = context.model.rods[point.rod];
    if (point.rod != configured) {
      shape = rod::configure(rod.rod, context.bases[point.rod], iterate.rods[point.rod].q);
      configured = point.rod;
    }
    const Vec3 P =
        solid::position(point.where, context.model.solids[point.solid].body.tetrahedra, iterate.solids[point.solid].x);
    PointState& state = iterate.points[k];
    state.s = constraint::project(shape, state.s, P);
    state.on = state.s <= rod.rod.length();
    if (!state.on) {
      state.s = rod.rod.length() * (1.0 + 1e-12);
      state.lambda.setZero();
    }
  }
}

/// Velocities and mass points at the end of an accepted step.
void finish(const StepContext& context, State& next) {
  next.time = context.start.time + context.h;
  for (std::size_t i = 0; i < next.solids.size(); ++i)
    next.solids[i].v = (next.solids[i].x - context.start.solids[i].x) / context.h;
  for (std::size_t i = 0; i < next.rods.size(); ++i) {
    const RodModel& rod = context.model.rods[i];
    if (rod.geometric) continue;
    const rod::Configuration shape = rod::configure(rod.rod, context.bases[i], next.rods[i].q);
    for (std::size_t m = 0; m < rod.rod.masses.size(); ++m) {
      next.rods[i].masses.col(static_cast<Eigen::Index>(m)) =
          rod::position(shape, rod.rod.masses[m].s, rod.rod.masses[m].offset);
    }
    next.rods[i].velocity = (next.rods[i].masses - context.start.rods[i].masses) / context.h;
  }
  for (std::size_t i = 0; i < next.actuators.size(); ++i) {
    if (context.model.actuators[i].row < 0) next.actuators[i] = context.command[i];
  }
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
  const auto fail = [&](Status status, std::string detail) -> StepResult {
    report.status = status;
    report.detail = std::move(detail);
    return {state, report};
  };

  for (;; ++report.newton) {
    // Where are we: unbalanced forces of volumes and rods, violation of the rows.
    std::vector<SolidForces> forces;
    Reduced reduced;
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
        reduced.problem.r.allFinite() && reduced.problem.c.allFinite();
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
    const double turn = largest_turn(context, solution.dz);
    double fraction = 1.0;
    if (!fixed && turn > 0.8) fraction = 0.8 / turn;
    if (!fixed && farthest > 0.3 * model.size) fraction = std::min(fraction, 0.3 * model.size / farthest);
    for (std::size_t i = 0; i < model.solids.size(); ++i) iterate.solids[i].x += fraction * dx[i];
    advance_reduced(context, solution, fraction, iterate);
  }

  finish(context, iterate);
  if (!finite(iterate)) return fail(Status::diverged, "the new state is not finite");
  for (std::size_t k = 0; k < model.points.size(); ++k) {
    const PointModel& point = model.points[k];
    if (point.unknown >= 0 && iterate.points[k].s < -kGuide * model.rods[point.rod].length()) {
      return fail(Status::rod_exhausted, "rods." + model.rods[point.rod].name);
    }
  }
  report.status = fixed ? Status::linearized : Status::converged;
  return {std::move(iterate), report};
}

}  // namespace sinew
