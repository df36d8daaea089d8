#include "sinew/sim/statics.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <cstdio>

#include "sinew/error/digits.hpp"
#include "sinew/sim/contacts.hpp"
#include "sinew/sim/first_guess.hpp"
#include "sinew/sim/iteration_work.hpp"
#include "sinew/sim/load_summary.hpp"
#include "sinew/sim/newton.hpp"
#include "sinew/sim/places.hpp"
#include "sinew/sim/signals.hpp"
#include "sinew/sim/step_ends.hpp"
#include "sinew/sim/unbalanced.hpp"
#include "sinew/sim/unresisted.hpp"
#include "sinew/sim/work.hpp"

namespace sinew {

namespace {

constexpr double kFirstArc = 0.1, kLongestArc = 0.3, kShortestArc = 1e-7;
/// Where stability is lost the path may branch, and a long step can miss the branch that a small load would take.
constexpr double kArcAtBranch = kFirstArc / 64;
/// A path that has come back below no load, or takes more steps than this, does not lead to the full one.
constexpr double kBehindTheStart = -0.05, kMostSteps = 3000;
/// Of a quasi-static step, whose path is short.
constexpr int kMostDetours = 200;
constexpr int kMostIterations = 12, kWantedIterations = 4;
/// Of its load, brought on by parts where contacts make kinks in a path.
constexpr double kSmallestPart = 1.0 / 64.0, kSettledPart = 1.0 / 16.0;

/// What is prescribed along a path: all of it grows linearly from one end to the other.
struct Ramp {
  Command from, to;
  Vec3 gravity_from, gravity_to;
  double time_from = 0.0, time_to = 0.0;

  double time(double t) const { return time_from + t * (time_to - time_from); }
  Vec3 gravity(double t) const { return gravity_from + t * (gravity_to - gravity_from); }
};

Command nothing(const Model& model) {
  return {std::vector<double>(model.actuators.size(), 0.0), std::vector<double>(model.loads.size(), 0.0)};
}

Ramp from_nothing(const Model& model, Command to, double time) {
  return {nothing(model), std::move(to), Vec3::Zero(), model.scene.gravity, 0.0, time};
}

/// Contexts along a path from a state.
ContextAt along(const Ramp& ramp, const State& start) {
  return [&ramp, &start](double t, StepContext& context) {
    context.set(start, between(ramp.from, ramp.to, t), ramp.time(t) - start.time);
    context.gravity = ramp.gravity(t);
  };
}

struct Reached {
  Iterate at;
  StepReport report;
};

/// The equilibrium at the t of a first guess.
Reached land(Memory& memory, const Ramp& ramp, const State& state, Iterate guess, const NewtonRules& rules) {
  guess.state.path = state.path;
  Reached reached{std::move(guess), {}};
  reached.report = newton(along(ramp, state), memory, rules, reached.at);
  return reached;
}

NewtonRules whole_steps(const Model& model) {
  return {model.scene.newton.limit, false, Linearization::Wanted::any, nullptr};
}

/// First guess of the step that Memory::context describes, and the contacts looked for in it.
void begin(Memory& memory, State& guess) {
  first_guess(memory.context, guess);
  follow_points(memory.context, guess, memory.here);
  find_contacts(memory.context, guess, memory.here.contacts(), memory.alarm, memory.looks);
}

/// Takes the motion from a state.
void stop(State& state) {
  for (SolidState& own : state.solids) own.v.setZero();
  for (RodState& own : state.rods) {
    own.velocity.setZero();
    own.q_rate.setZero();
  }
  for (rigid::Motion& own : state.bodies) {
    own.v.setZero();
    own.w.setZero();
  }
}

/// What has moved most from one state to another, and how far [m].
struct Moved {
  std::string name;
  double far = 0.0;
};
Moved moved_most(const Model& model, const State& from, const State& to) {
  Moved most;
  const auto take = [&most](const std::string& name, const auto& a, const auto& b) {
    const double far = a.cols() > 0 ? (b - a).colwise().norm().maxCoeff() : 0.0;
    if (far > most.far) most = {name, far};
  };
  for (std::size_t i = 0; i < to.solids.size(); ++i)
    take("solids." + model.solids[i].name, from.solids[i].x, to.solids[i].x);
  for (std::size_t i = 0; i < to.rods.size(); ++i)
    take("rods." + model.rods[i].name, from.rods[i].masses, to.rods[i].masses);
  for (std::size_t i = 0; i < to.bodies.size(); ++i)
    take("bodies." + model.bodies[i].name, from.bodies[i].p, to.bodies[i].p);
  return most;
}

// Pseudo-transient continuation (C. T. Kelley, D. E. Keyes, SIAM J. Numer. Anal. 35, 1998). Implicit Euler's steps of
// length tau, each from rest,
//     M (x - x_k) / tau^2 + D (x - x_k) / tau + r(x) = 0,
// go down the potential, however far, where Newton's from x_k would go anywhere. tau grows as they go well, until
// Newton's method without M and D converges from where they have come.
/// The equilibrium at t that a state moves to; not accepted where none is found.
Reached settle(Memory& memory, const Ramp& ramp, const State& from, double t, int most_iterations) {
  constexpr double kFirst = 0.1, kLeast = 1e-6;  // of the scene's step
  constexpr double kFarthest = 0.02;             // of the scene's size: a longer step may end in another valley
  constexpr double kRests = 1e-6;                // of the scene's size: what moves less in a step is nearly there
  constexpr int kEasy = 4;
  const Model& model = memory.context.model;
  const double h = model.scene.time.step;
  Reached reached{{from, t}, {}};
  reached.report.status = Status::max_iterations;
  StepReport spent;
  State state = from;
  bool arrived = false;  // frames and loads are there
  const auto make = [&](double rate, double tau, int limit) {
    const ContextAt at = [&](double, StepContext& context) {
      context.set(state, between(ramp.from, ramp.to, t), arrived ? 0.0 : ramp.time(t) - state.time);
      if (arrived) context.h = tau;
      context.rate = rate;
      context.gravity = ramp.gravity(t);
    };
    at(t, memory.context);
    NewtonRules rules{limit, false, Linearization::Wanted::descent};
    rules.settles = rate > 0.0;
    rules.evaluation = rules.settles ? Evaluation::motion : Evaluation::full;
    StepReport report = look_until_found(memory, alarm_distance(memory.context), [&] {
      at(t, memory.context);
      begin(memory, reached.at.state);
      return newton(at, memory, rules, reached.at);
    });
    add_effort(report, spent);
    return report;
  };
  // How far the last step has come, of the scene's size.
  const auto way = [&] { return moved_most(model, state, reached.at.state).far / model.size; };
  double most = INFINITY;  // [s] that has not failed lately
  int made = 0, next_look = 1;
  for (double tau = kFirst * h;
       tau > kLeast * h && spent.newton < most_iterations && !contacts_cost_too_much(spent.contact);) {
    StepReport report = make(1.0 / tau, tau, model.scene.newton.limit);
    const double moved = accepted(report.status) && arrived ? way() : 0.0;
    if (!accepted(report.status) || moved > kFarthest) {
      reached.report = report;
      if (accepted(report.status)) reached.report.status = Status::max_iterations;  // (it is on its way)
      most = 0.5 * tau;
      tau *= 0.25;
      continue;
    }
    const bool rests = arrived && moved < kRests;
    state = reached.at.state;
    state.time = ramp.time(t);
    stop(state);
    arrived = true;
    ++made;
    tau = std::min(tau * std::clamp(2.0 * kEasy / std::max(report.newton, 1), 0.5, 3.0), most);
    most *= 1.2;
    if ((report.newton > kEasy && !rests) || made < next_look) continue;
    next_look = 2 * made;
    reached.report = make(0.0, h, std::min(model.scene.newton.limit, kMostIterations));
    if (accepted(reached.report.status) && way() <= kFarthest) break;
    reached.report.status = Status::max_iterations;
  }
  reached.at.state.time = ramp.time(t);
  reached.report.newton = spent.newton;
  reached.report.times = spent.times;
  reached.report.contact.work = spent.contact.work;
  reached.report.contact.cut = spent.contact.cut;
  return reached;
}

/// What lies between two equilibria of a quasi-static step.
struct Between {
  const Model& model;
  const Ramp& ramp;
  const State& from;
  double t_from = 0.0;
  const State& to;
  double t_to = 0.0;

  /// Part of the scene's gravity at t; all of it grows with t where it is brought on.
  double gravity(double t) const {
    const double whole = model.scene.gravity.norm();
    return whole > 0.0 ? ramp.gravity(t).norm() / whole : 0.0;
  }
};

/// [J] What is set free with the gravity of t, beyond what friction may take at the end, and that; the work done, with
/// that of weights; the elastic energy, and what weights lose under all of gravity.
struct SetFree {
  double free = 0.0, rubbed = 0.0, done = 0.0, elastic = 0.0, fallen = 0.0;
};
SetFree set_free(const Between& own, double t) {
  const EnergyBalance before = energy_balance(own.model, own.from), after = energy_balance(own.model, own.to);
  double rubbed = 0.0;
  for (const ContactState& contact : own.to.contacts)
    rubbed += (contact.force - contact.force.dot(contact.normal) * contact.normal).norm() * contact.slip;
  for (const int point : own.model.rubbing)
    rubbed += std::abs(own.to.points[point].friction * (own.to.points[point].s - own.from.points[point].s));
  const double held = after.elastic + after.kinetic - before.elastic - before.kinetic;
  const double fallen = before.weight - after.weight;
  const double done = own.to.energies.work - own.from.energies.work + own.gravity(t) * fallen;
  return {done - held - rubbed, rubbed, done, std::max(before.elastic, after.elastic), fallen};
}
constexpr double kFree = 1e-3;  ///< of the elastic energy: what steps of a load leave undecided

/// [J] The most that contacts put in as they move apart what overlaps where the scene begins.
double put_in_by_contacts(const Between& own) {
  if (own.from.grid != 0 || own.from.time != 0.0) return 0.0;
  double sum = 0.0;
  for (const ContactState& contact : own.to.contacts)
    sum += std::abs(contact.force.dot(contact.normal)) * own.model.pairs[contact.pair].depth;
  return sum;
}

/// Whether a step between equilibria has gone over to others than those that go on from where it began: down, or up,
/// where nothing brings it.
bool jumped(const Between& own) {
  constexpr double kNear = 0.01;    // of the scene's size
  constexpr double kBeyond = 0.03;  // of the elastic energy: the work of a long, curved way is not known better
  // Of it and of the work: up, nothing takes a body, and shorter parts know their work better.
  constexpr double kUp = 0.003, kUpOfWork = 0.02;
  if (moved_most(own.model, own.from, own.to).far <= kNear * own.model.size) return false;
  const SetFree set = set_free(own, 0.5 * (own.t_from + own.t_to));  // (trapezium, as loads that grow)
  const double from_nowhere = -set.free - put_in_by_contacts(own);
  return std::max(set.free, from_nowhere) > kBeyond * set.elastic ||
         from_nowhere - set.rubbed > std::max(kUp * set.elastic, kUpOfWork * std::abs(set.done));
}

/// Warning `snapped` where a body that was let go has set energy free. It was so with the loads of the end, which do
/// more than loads that grow would: by up to what these differ by on the way, and that is no snap.
std::optional<Warning> snapped(Memory& memory, const Between& own) {
  const SetFree set = set_free(own, own.t_to);
  along(own.ramp, own.from)(own.t_to, memory.context);
  const Work by_loads = work(memory.context, own.to, {});
  const double more = std::max(0.0, by_loads.end - by_loads.start) +
                      std::max(0.0, (own.gravity(own.t_to) - own.gravity(own.t_from)) * set.fallen);
  if (!(set.free - more > kFree * set.elastic)) return {};
  if (!(set.free > 1e-14 * own.model.bearing * own.model.size)) return {};  // (rounding is none)
  const Moved most = moved_most(own.model, own.from, own.to);
  return Warning{.code = "snapped",
                 .where = most.name,
                 .message = "no equilibrium goes on from the one before: it lets go, moves by " +
                            three_digits(1e3 * most.far) + " mm and sets " + three_digits(set.free) + " J free",
                 .remedy = "see how it moves with `analysis: dynamic`",
                 .time = own.to.time,
                 .value = set.free / std::max(set.elastic, 1e-6 * set.free),
                 .limit = kFree,
                 .steps = 1};
}

std::string percent(double part) { return three_digits(100.0 * part) + " %"; }

/// How the equilibrium that Memory::context describes changes along its path, into Memory::change. False where nothing
/// resists a motion.
bool find_tangent(const ContextAt& at, Memory& memory, const Iterate& from, StepReport& report) {
  Linearization& here = memory.here;
  here.forget();
  here.evaluate(memory.context, from.state, report.times);
  if (!here.finite() || !here.factor(solid::Tangent::exact, Linearization::Wanted::any, report.detail)) return false;
  const auto solve = [&] {
    here.solve(memory.increment);
    change_along(at, memory, from, report.times);
    return memory.change.reduced.ok;
  };
  if (solve()) return true;
  here.stiffen();
  return solve();
}

/// What nothing resists at a state under all that is prescribed, which says what is small; or, where weights and pulls
/// alone resist, before it is there.
std::vector<Unresisted> find_unresisted(Memory& memory, const Ramp& ramp, const State& state) {
  Linearization& here = memory.here;
  for (const double t : {1.0, 0.0}) {
    along(ramp, state)(t, memory.context);
    here.forget();
    StageTimes times;
    std::string failed;
    here.evaluate(memory.context, state, times);
    if (!here.finite() || !here.factor(solid::Tangent::exact, Linearization::Wanted::any, failed)) continue;
    here.solve(memory.increment);
    here.unstable();
    if (!here.unresisted().empty()) return unresisted_motions(memory.context.model, here.unresisted());
  }
  return {};
}

/// Names it in the report of a step that failed for it.
void name_unresisted(Memory& memory, const Ramp& ramp, const State& state, StepReport& report) {
  if (report.status != Status::singular) return;
  if (const std::string free = in_words(find_unresisted(memory, ramp, state)); !free.empty())
    report.detail = "nothing resists motions of " + free;
}

/// One step along a path; its arc and what the next one needs are in the state's `path`. On failure `at` is where it
/// started from.
Reached path_step(const Model& model, Memory& memory, const Ramp& ramp, const Iterate& from) {
  const State& state = from.state;
  if (state.path.step == 0.0) {  // before anything: the equilibrium at t = 0
    Reached first = land(memory, ramp, state, {state, 0.0}, whole_steps(model));
    first.at.state.path.step = kFirstArc;
    first.at.state.path.stable = !first.report.unstable;
    return accepted(first.report.status) ? first : Reached{from, first.report};
  }
  StepReport report;
  const bool no_progress = state.path.work - state.path.work_at_farthest > allowed_work(state.path.work);
  if (from.t < kBehindTheStart || state.path.count > kMostSteps || no_progress) {
    const bool turned_back = from.t < kBehindTheStart || no_progress;
    char text[80];
    std::snprintf(text, sizeof text, "it came as far as %.3g %% of the load in %.0f steps", 100.0 * state.path.farthest,
                  state.path.count);
    report.status = turned_back ? Status::path_lost : Status::path_unfinished;
    report.detail = text;
    if (turned_back && from.t < state.path.farthest)
      report.detail += ", a limit point, and is back at " + percent(from.t);
    for (const std::string& reason : {largest_pressure(model), describe_folded(model, state)})
      report.detail += reason.empty() ? "" : "; " + reason;
    return {from, report};
  }
  const ContextAt at = along(ramp, state);
  StepContext& context = memory.context;
  at(from.t, context);

  // Sliding points that the rod's end has passed or reached: the path jumps to where it goes on with them.
  State followed = state;
  follow_points(context, followed, memory.there);
  const bool changed = !std::equal(state.points.begin(), state.points.end(), followed.points.begin(),
                                   [](const PointState& a, const PointState& b) { return a.on == b.on; });
  if (changed) {
    Reached jumped = land(memory, ramp, state, {followed, from.t}, whole_steps(model));
    jumped.at.state.path.count = state.path.count + 1.0;
    return accepted(jumped.report.status) ? jumped : Reached{from, jumped.report};
  }

  // The tangent of the path here, the way the last step went.
  report.status = Status::singular;
  if (!find_tangent(at, memory, from, report)) return {from, report};
  const Increment change = memory.change;
  const Eigen::VectorXd u = measured(model, change);
  const double norm = std::sqrt(u.squaredNorm() + 1.0);
  const double way = state.path.rate == 0.0 || state.path.direction.dot(u) + state.path.rate > 0.0 ? 1.0 : -1.0;
  const AcrossPath across{way / norm * u, way / norm};
  StepReport spent = report;

  for (double arc = std::min(state.path.step, kLongestArc); arc >= kShortestArc; arc *= 0.5) {
    const bool last = from.t + arc * across.rate >= 1.0;  // land on the end
    const double dt = last ? 1.0 - from.t : arc * across.rate;
    Iterate guess{state, from.t + dt};
    advance_by(context, change, dt, guess.state);
    NewtonRules rules = whole_steps(model);
    if (!last) {
      rules.limit = kMostIterations;
      rules.across = &across;
    }
    Reached next = land(memory, ramp, state, std::move(guess), rules);
    add_effort(next.report, spent);
    report = next.report;
    if (!accepted(report.status) || (state.path.stable && report.unstable && arc > kArcAtBranch)) continue;
    PathState& path = next.at.state.path;
    path.count = state.path.count + 1.0;
    path.farthest = std::max(state.path.farthest, next.at.t);
    path.work = state.path.work + spent.newton * iteration_work(model);
    path.work_at_farthest = next.at.t > state.path.farthest ? path.work : state.path.work_at_farthest;
    path.step = std::clamp(arc * std::clamp(static_cast<double>(kWantedIterations) / report.newton, 0.5, 2.0),
                           kShortestArc, kLongestArc);
    path.stable = !report.unstable;
    path.direction = across.direction;
    path.rate = across.rate;
    next.report.newton = spent.newton;
    next.report.times = spent.times;
    return next;
  }
  report.newton = spent.newton;
  report.times = spent.times;
  return {from, report};
}

}  // namespace

StepResult static_step(const Model& model, Workspace& workspace, const State& state) {
  const double duration = model.scene.time.duration;
  const Ramp ramp = from_nothing(model, command_at(model, duration), duration);
  Reached next = path_step(model, workspace.memory(), ramp, {state, state.time / duration});
  if (!accepted(next.report.status)) {
    name_unresisted(workspace.memory(), ramp, state, next.report);
    return {state, next.report};
  }
  next.at.state.time = ramp.time(next.at.t);
  if (next.at.t == 1.0) {
    next.at.state.grid = state.grid + 1;
  }
  return {std::move(next.at.state), next.report};
}

StepResult equilibrium_step(const Model& model, Workspace& workspace, const Command& command, const State& state,
                            double time, int most) {
  const bool begins = state.grid == 0 && state.time == 0.0;
  const Ramp ramp{begins ? nothing(model) : command_of(model, state),
                  command,
                  begins ? Vec3(Vec3::Zero()) : model.scene.gravity,
                  model.scene.gravity,
                  state.time,
                  time};
  const int folded = count_folded(model, state);
  Memory& memory = workspace.memory();
  // Contacts make kinks in a path, and it is not followed. Equilibria that they do not hold are told by a warning.
  const bool touches = !model.pairs.empty();
  const auto sound = [&](const Reached& reached) {
    return accepted(reached.report.status) && (touches || !reached.report.unstable) &&
           count_folded(model, reached.at.state) <= folded;
  };
  const auto guessed = [&](const State& from, double t) {
    along(ramp, from)(t, memory.context);
    Iterate guess;
    guess.t = t;
    begin(memory, guess.state);
    return guess;
  };
  // From `from` to t, contacts found as far away as it takes.
  const auto go = [&](const State& from, double t, const NewtonRules& rules) {
    Reached reached;
    along(ramp, from)(t, memory.context);
    StepReport report = look_until_found(memory, alarm_distance(memory.context), [&] {
      reached = land(memory, ramp, from, guessed(from, t), rules);
      return reached.report;
    });
    reached.report = std::move(report);
    return reached;
  };

  NewtonRules rules = whole_steps(model);
  const int iteration_limit = affordable_iterations(model, most * rules.limit);
  const auto goes_on = [&](const StepReport& spent) {
    return spent.newton < iteration_limit && !contacts_cost_too_much(spent.contact);
  };
  rules.limit = std::min(rules.limit, kMostIterations);
  Reached end = go(state, 1.0, rules);
  StepReport spent = end.report;
  std::vector<Warning> snaps;
  bool stops = false;  // as `snap: stop` asks
  // Warns of what goes over to another equilibrium, or ends there; false where nothing is set free.
  const auto warn_of_snap = [&](const Iterate& from, const State& to, double t) {
    std::optional<Warning> snap = snapped(memory, {model, ramp, from.state, from.t, to, t});
    if (!snap) return false;
    stops = model.scene.snap == Snap::stop;
    if (stops) {
      end.report.status = Status::path_lost;
      end.report.detail = snap->where + ": " + snap->message + "; `snap: stop`";
    } else {
      snaps.push_back(std::move(*snap));
    }
    return true;
  };
  const auto let_go = [&](const Iterate& from, double t) {
    Reached next = settle(memory, ramp, from.state, t, iteration_limit - spent.newton);
    add_effort(next.report, spent);
    if (sound(next)) warn_of_snap(from, next.at.state, t);
    return next;
  };
  const bool elsewhere = accepted(end.report.status) && jumped({model, ramp, state, 0.0, end.at.state, 1.0});
  if (!sound(end) || elsewhere) {
    Iterate on{state, 0.0};
    for (int i = 0; i < kMostDetours && on.t != 1.0 && !touches && goes_on(spent); ++i) {
      Reached next = path_step(model, memory, ramp, on);
      add_effort(next.report, spent);
      const bool back = next.at.t < on.t && next.at.t != 1.0;  // the corrector may have gone a little beyond 1
      if (!sound(next) || back) break;
      // (The last arc lands on the load, wherever Newton's method goes to.)
      if (next.at.t == 1.0 && jumped({model, ramp, on.state, on.t, next.at.state, 1.0})) break;
      on = next.at;
      if (on.t == 1.0) end = std::move(next);
    }
    for (double part = touches ? 0.5 : kSmallestPart; on.t != 1.0 && part >= kSmallestPart && goes_on(spent);) {
      Reached next = go(on.state, std::min(on.t + part, 1.0), rules);
      add_effort(next.report, spent);
      if (!sound(next) || jumped({model, ramp, on.state, on.t, next.at.state, next.at.t})) {
        part *= 0.5;
        if (part >= kSmallestPart) continue;
        part = kSettledPart;
        next = let_go(on, std::min(on.t + part, 1.0));
        if (stops || !sound(next)) break;
      }
      on = next.at;
      part *= 2.0;
      if (on.t == 1.0) end = std::move(next);
    }
    if (on.t != 1.0 && contacts_cost_too_much(spent.contact)) {
      end.report.status = Status::max_iterations;
      end.report.detail = too_many_contacts(model, end.at.state);
    } else if (on.t != 1.0 && spent.newton >= iteration_limit && most < kMostOfEquilibrium) {
      end.report.status = Status::max_iterations;
    } else if (!stops && on.t != 1.0) {
      rules = {model.scene.newton.limit, false, Linearization::Wanted::descent, nullptr};
      Reached minimum = go(on.state, 1.0, rules);
      add_effort(minimum.report, spent);
      if (accepted(minimum.report.status)) {
        end = std::move(minimum);
        warn_of_snap(on, end.at.state, 1.0);
      } else if (!accepted(end.report.status)) {
        end = std::move(minimum);
      } else if (elsewhere) {
        snaps.clear();  // of parts that led nowhere
        if (!warn_of_snap({state, 0.0}, end.at.state, 1.0)) {
          end.report.status = Status::path_lost;
          end.report.detail = moved_most(model, state, end.at.state).name +
                              ": the equilibrium that was found is none that its loads lead to";
        }
      }
      if (end.report.status == Status::max_iterations && end.report.detail.empty()) {
        char text[80];
        std::snprintf(text, sizeof text, "it came as far as %.3g %% of the step in %d iterations", 100.0 * on.t,
                      spent.newton);
        end.report.detail = text;
      }
    }
  }
  end.report.newton = spent.newton;
  end.report.times = spent.times;
  end.report.contact.work = spent.contact.work;
  end.report.contact.cut = spent.contact.cut;
  end.report.warnings.insert(end.report.warnings.end(), snaps.begin(), snaps.end());
  if (!accepted(end.report.status)) {
    name_unresisted(memory, ramp, state, end.report);
    return {state, end.report};
  }
  end.at.state.path = {};
  return {std::move(end.at.state), end.report};
}

namespace {

/// Where loads push along motions that nothing resists at the start of a path, whose tangent is Memory::change.
void leave_start(const Model& model, Memory& memory, const Ramp& ramp, FirstSolve& first) {
  constexpr double kFar = 1e8;  // times the scene's size, which the whole loads would move it by this tangent
  const Eigen::VectorXd moved = measured(model, memory.change).tail(memory.change.reduced.dz.size()).cwiseAbs();
  if (moved.size() == 0 || moved.maxCoeff() < kFar) return;
  Reached way{{initial_state(model), 0.0}, first.report};
  for (int i = 0; i < 3 && way.at.t < 1.0 / kFar && accepted(way.report.status); ++i)
    way = path_step(model, memory, ramp, way.at);
  first.report = way.report;
  std::vector<int> unknowns;
  for (int k = 0; k < moved.size(); ++k)
    if (moved[k] > 1e-3 * moved.maxCoeff()) unknowns.push_back(k);
  if (way.report.status == Status::singular) first.free = unresisted_motions(model, unknowns);
}

}  // namespace

FirstSolve first_solve(const Model& model, Workspace& workspace) {
  Memory& memory = workspace.memory();
  const bool follows_path = model.scene.analysis == Analysis::statics;
  const double time = follows_path                                     ? model.scene.time.duration
                      : model.scene.analysis == Analysis::quasi_static ? model.scene.time.step
                                                                       : 0.0;
  const Ramp ramp = from_nothing(model, command_at(model, time), time);
  const State start = initial_state(model);
  const double t = follows_path ? 0.0 : 1.0;
  const ContextAt at = along(ramp, start);
  at(t, memory.context);
  memory.alarm = alarm_distance(memory.context);
  Iterate guess{start, t};
  NewtonRules rules = whole_steps(model);
  rules.limit = kMostIterations;
  if (!follows_path) begin(memory, guess.state);
  FirstSolve first{land(memory, ramp, start, guess, rules).report, {}};
  if (follows_path && first.report.status != Status::singular) {
    at(t, memory.context);
    if (!find_tangent(at, memory, guess, first.report)) first.report.status = Status::singular;
  }
  if (follows_path && first.report.status != Status::singular) leave_start(model, memory, ramp, first);
  if (first.report.status != Status::singular) return first;
  if (first.free.empty()) first.free = find_unresisted(memory, ramp, start);
  return first;
}

}  // namespace sinew
