#include "sinew/sim/statics.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "sinew/sim/run.hpp"
#include "sinew/sim/step_ends.hpp"

namespace sinew {

namespace {

constexpr double kFirstArc = 0.1, kLongestArc = 0.3, kShortestArc = 1e-7;
/// Where stability is lost the path may branch, and a long step can miss the branch that a small load would take.
constexpr double kArcAtBranch = kFirstArc / 64;
constexpr double kStiffer = 1e-6;
/// A path that has come back below no load, or takes more steps than this, does not lead to the full one.
constexpr double kBehindTheStart = -0.05, kMostSteps = 3000;
constexpr int kMostIterations = 12, kWantedIterations = 4;

/// Everything prescribed at the load factor t.
StepContext context_at(const Model& model, const State& start, double t) {
  const double duration = model.scene.time.duration;
  Command command = command_at(model, duration);
  for (double& value : command.actuators) value *= t;
  for (double& value : command.loads) value *= t;
  StepContext context = make_context(model, start, command, t * duration - start.time);
  context.gravity = t * model.scene.gravity;
  return context;
}

/// An increment as one vector: what each number turns [rad], or moves in units of the scene's size.
Eigen::VectorXd measured(const Model& model, const Increment& increment) {
  Eigen::Index size = increment.reduced.dz.size();
  for (const auto& dx : increment.dx) size += dx.size();
  for (const auto& dq : increment.reduced.dq) size += dq.size();
  Eigen::VectorXd u(size);
  Eigen::Index at = 0;
  for (const auto& dx : increment.dx) {
    u.segment(at, dx.size()) = dx.reshaped() / (model.size * std::sqrt(static_cast<double>(dx.cols())));
    at += dx.size();
  }
  for (std::size_t n = 0; n < model.rods.size(); ++n) {
    const rod::Rod& rod = model.rods[n].rod;
    for (int i = 0; i < rod.count(); ++i) {
      // A section's turn counts by its share of the rod, so that the measure does not depend on their number.
      const double weight = std::sqrt(rod.sections[i].length() * rod.length());
      for (int c = rod.first[i]; c < rod.first[i + 1]; ++c) u[at + c] = weight * increment.reduced.dq[n][c];
    }
    at += rod.strain_coordinates();
  }
  u.tail(increment.reduced.dz.size()) = increment.reduced.dz / model.size;
  for (const RodModel& rod : model.rods) {
    for (int i = 0; i < rod.rod.base_coordinates(); ++i) {
      if (rod.rod.base[i].turns) u[at + rod.unknown + i] *= model.size;
    }
  }
  return u;
}

/// Newton across (u', t'), or at a fixed t if that is empty. Reports what became of it.
struct Corrector {
  const Model& model;
  Workspace& workspace;
  const State& start;
  Eigen::VectorXd direction;
  double rate = 0.0;

  /// dr/dt by a difference in t, exact where all loads are linear in it.
  Increment rate_of_change(Linearization& here, const State& iterate, double t, StageTimes& times) const {
    const double e = 1e-6;
    const StepContext ahead = context_at(model, start, t + e);
    State carried = iterate;
    place_held(ahead, carried);
    const Linearization there(ahead, workspace, carried, times);
    Increment both = here.solve(there);
    const Increment own = here.solve();
    if (!own.reduced.ok) both.reduced.ok = false;
    if (!both.reduced.ok) return both;
    scale(both, own, 1.0 / e);
    return both;
  }

  /// a <- (a - b) factor.
  static void scale(Increment& a, const Increment& b, double factor) {
    for (std::size_t i = 0; i < a.dx.size(); ++i) a.dx[i] = (a.dx[i] - b.dx[i]) * factor;
    a.reduced.dz = (a.reduced.dz - b.reduced.dz) * factor;
    a.reduced.dlambda = (a.reduced.dlambda - b.reduced.dlambda) * factor;
    for (std::size_t i = 0; i < a.reduced.dq.size(); ++i)
      a.reduced.dq[i] = (a.reduced.dq[i] - b.reduced.dq[i]) * factor;
  }

  StepReport correct(State& iterate, double& t) const {
    StepReport report;
    double stiffness = 0.0;
    for (;; ++report.newton) {
      const StepContext context = context_at(model, start, t);
      place_held(context, iterate);
      Linearization here(context, workspace, iterate, report.times);
      report.residual = here.scale() > 0.0 ? here.largest() / here.scale() : 0.0;
      report.violation = here.violation();
      report.status = Status::diverged;
      if (!here.finite() || !std::isfinite(t)) return report;
      if (report.newton > 0 && balanced(model, here, stiffness)) {
        finish(context, here, iterate);
        report.status = !finite(iterate)                ? Status::diverged
                        : turned_over(context, iterate) ? Status::max_iterations
                                                        : Status::converged;
        if (const RodModel* rod = exhausted(model, iterate); rod && accepted(report.status)) {
          report.status = Status::rod_exhausted;
          report.detail = "rods." + rod->name;
        }
        return report;
      }
      report.status = Status::max_iterations;
      // The rotated tangent of a volume makes Newton linear: more iterations, not shorter steps.
      const int most = direction.size() > 0 && !report.rotated ? kMostIterations : model.scene.newton.limit;
      if (report.newton == most) return report;
      report.status = Status::singular;
      if (!here.factor(solid::Tangent::exact, Linearization::Wanted::any, report.detail)) return report;
      report.rotated |= here.rotated();
      report.unstable = here.unstable();
      stiffness = std::max(stiffness, here.stiffness());
      report.detail = "constraint rows and rods";
      Increment increment = here.solve();
      if (!increment.reduced.ok) {
        here.stiffen(kStiffer);
        increment = here.solve();
      }
      if (!increment.reduced.ok) return report;
      double dt = 0.0;
      if (direction.size() > 0) {
        const Increment change = rate_of_change(here, iterate, t, report.times);
        if (!change.reduced.ok) return report;
        dt = -direction.dot(measured(model, increment)) / (direction.dot(measured(model, change)) + rate);
        advance_by(context, change, dt, iterate);
      }
      const double fraction = direction.size() > 0 ? 1.0 : trusted_fraction(context, increment);
      advance_by(context, increment, fraction, iterate);
      t += dt;
    }
  }
};

/// The equilibrium at a fixed t nearest to an iterate.
StepResult land(const Model& model, Workspace& workspace, const State& state, State iterate, double t) {
  const Corrector corrector{model, workspace, state, {}, 0.0};
  const StepReport report = corrector.correct(iterate, t);
  if (!accepted(report.status)) return {state, report};
  iterate.path = state.path;
  return {std::move(iterate), report};
}

}  // namespace

StepResult static_step(const Model& model, Workspace& workspace, const State& state) {
  const double duration = model.scene.time.duration;
  const double t0 = state.time / duration;
  if (state.path.step == 0.0) {  // before anything: the equilibrium without loads
    StepResult result = land(model, workspace, state, state, 0.0);
    result.next.path.step = kFirstArc;
    result.next.path.stable = !result.report.unstable;
    result.next.time = 0.0;
    return result;
  }

  StepReport report;
  const StepContext context = context_at(model, state, t0);
  if (t0 < kBehindTheStart || state.path.count > kMostSteps) {
    report.status = Status::path_lost;
    return {state, report};
  }

  // Sliding points that the rod's end has passed or reached: the path jumps to where it goes on with them.
  State followed = state;
  follow_points(context, followed);
  const bool changed = !std::equal(state.points.begin(), state.points.end(), followed.points.begin(),
                                   [](const PointState& a, const PointState& b) { return a.on == b.on; });
  if (changed) {
    StepResult result = land(model, workspace, state, followed, t0);
    result.next.time = state.time;
    if (accepted(result.report.status)) result.next.path.count = state.path.count + 1.0;
    return result;
  }

  // The tangent of the path here, the way the last step went.
  Linearization here(context, workspace, state, report.times);
  const Corrector tangent{model, workspace, state, {}, 0.0};
  report.status = Status::singular;
  if (!here.finite() || !here.factor(solid::Tangent::exact, Linearization::Wanted::any, report.detail))
    return {state, report};
  Increment change = tangent.rate_of_change(here, state, t0, report.times);
  if (!change.reduced.ok) {
    here.stiffen(kStiffer);
    change = tangent.rate_of_change(here, state, t0, report.times);
  }
  if (!change.reduced.ok) return {state, report};
  const Eigen::VectorXd u = measured(model, change);
  const double norm = std::sqrt(u.squaredNorm() + 1.0);
  const double way = state.path.rate == 0.0 || state.path.direction.dot(u) + state.path.rate > 0.0 ? 1.0 : -1.0;
  const Corrector corrector{model, workspace, state, way / norm * u, way / norm};

  const auto missed = [&state](const StepReport& made, double arc) {
    return state.path.stable && made.unstable && arc > kArcAtBranch;
  };
  for (double arc = std::min(state.path.step, kLongestArc); arc >= kShortestArc; arc *= 0.5) {
    double t = t0 + arc * corrector.rate;
    State iterate = state;
    if (t >= 1.0) {  // land on the end
      advance_by(context, change, 1.0 - t0, iterate);
      StepResult last = land(model, workspace, state, iterate, 1.0);
      report = last.report;
      if (accepted(last.report.status) && !missed(last.report, arc)) {
        last.next.time = duration;
        last.next.grid = state.grid + 1;
        return last;
      }
      continue;
    }
    advance_by(context, change, arc * corrector.rate, iterate);
    report = corrector.correct(iterate, t);
    if (!accepted(report.status) || missed(report, arc)) continue;
    iterate.time = t * duration;
    iterate.path.step = std::min(
        arc *
            std::clamp(static_cast<double>(report.rotated ? 3 * kWantedIterations : kWantedIterations) / report.newton,
                       0.5, 2.0),
        kLongestArc);
    iterate.path.count = state.path.count + 1.0;
    iterate.path.stable = !report.unstable;
    iterate.path.direction = corrector.direction;
    iterate.path.rate = corrector.rate;
    return {std::move(iterate), report};
  }
  return {state, report};
}

}  // namespace sinew
