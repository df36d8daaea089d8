#include "sinew/sim/run.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

#include "sinew/error/digits.hpp"
#include "sinew/sim/assessment.hpp"
#include "sinew/sim/clock.hpp"
#include "sinew/sim/inverse.hpp"
#include "sinew/sim/iteration_work.hpp"
#include "sinew/sim/load_summary.hpp"
#include "sinew/sim/modal.hpp"
#include "sinew/sim/motors.hpp"
#include "sinew/sim/newton.hpp"
#include "sinew/sim/redundancy.hpp"
#include "sinew/sim/statics.hpp"
#include "sinew/threads/interruption.hpp"

namespace sinew {

namespace {

/// What the scene says; what it leaves to others goes on as it is.
void scene_command(const Model& model, const State& state, double time, Command& command) {
  command_at(model, time, command);
  const auto left_open = [](const Drive& drive) { return std::holds_alternative<External>(drive); };
  for (std::size_t i = 0; i < model.actuators.size(); ++i) {
    if (left_open(model.actuators[i].drive)) command.actuators[i] = told_to(model, state, static_cast<int>(i));
  }
  for (std::size_t i = 0; i < model.loads.size(); ++i) {
    if (left_open(model.loads[i].factor)) command.loads[i] = state.loads[i];
  }
}

/// Takes what a step by value gives.
StepReport taken(StepResult result, State& state) {
  StepReport report = std::move(result.report);
  if (accepted(report.status)) state = std::move(result.next);
  return report;
}

/// Where a state is within its step of the grid, which has 2^most parts.
struct PlaceInStep {
  int most = 0;
  int parts = 0;     ///< that it has behind it
  double off = 0.0;  ///< [s] beyond that; rounding of the time is none
  int all() const { return 1 << most; }
  /// Fewest of a part that begins here at a multiple of itself.
  int halvings() const { return parts == 0 ? 0 : most - std::countr_zero(static_cast<unsigned>(parts)); }
};

PlaceInStep place_in_step(const Scene& scene, double done) {
  PlaceInStep place{most_halvings(scene)};
  const double part = std::ldexp(scene.time.step, -place.most);
  place.parts = static_cast<int>(std::clamp(std::round(done / part), 0.0, place.all() - 1.0));
  const double off = done - place.parts * part;
  if (!(std::abs(off) < 1e-3 * part)) place.off = off;
  return place;
}

/// Where what is asked for contradicts itself, that is why a step did not converge: parts of it contradict themselves
/// by less than the tolerance, and Newton goes anywhere.
void tell_contradiction(const Model& model, const Command& asked, StepReport& failed) {
  if (accepted(failed.status) || failed.status == Status::inconsistent || failed.status == Status::passed_through)
    return;
  const std::string known = known_contradiction(model);
  if (failed.detail.find(known) == std::string::npos)
    failed.detail = known + (failed.detail.empty() ? "" : "; ") + failed.detail;
  const bool contradicts = std::any_of(model.redundant.begin(), model.redundant.end(), [&](const RedundantGroup& own) {
    return contradiction_of(model, own, asked.actuators) > kContradiction * model.size;
  });
  if (contradicts) failed.status = Status::inconsistent;
}

/// Iterations of Newton, in multiples of `newton.limit`, after which no shorter part of a step is tried, and how many
/// of them each step of the grid pays back: one that is hard may cost much, not all of a run.
constexpr int kMostOfStep = 64, kPaidByStep = 8;

/// Whether a part of a step that was made is no reason against one of twice its length.
bool was_easy(const StepReport& report, bool at_once, int limit) {
  return at_once && report.newton <= std::max(limit / 3, 2);
}

StepReport try_to_advance(const Model& model, Workspace& workspace, State& state, Effort effort, const Told& told) {
  if (model.scene.analysis == Analysis::statics) {
    StepReport report = taken(static_step(model, workspace, state), state);
    tell_contradiction(model, command_at(model, model.scene.time.duration), report);
    return report;
  }
  if (model.scene.analysis == Analysis::modal) return taken(modal_step(model, workspace, state), state);
  const bool equilibrium = model.scene.analysis == Analysis::quasi_static && !step_rules(model, effort).fixed;
  const double h = model.scene.time.step;
  const double from = static_cast<double>(state.grid) * h, to = static_cast<double>(state.grid + 1) * h;
  const PlaceInStep place = place_in_step(model.scene, state.time - from);
  const double left = std::ldexp(h * (place.all() - place.parts), -place.most) - place.off;
  Command& command = workspace.memory().command;
  const bool inverse = !model.effectors.empty() && !told.forward;
  const int first = std::max(place.halvings(), std::min(state.halvings, place.most));
  // With contacts an equilibrium has been looked for along parts of the step already.
  const int last = equilibrium && !inverse && !model.pairs.empty() ? first : place.most;
  Goal goal, on_the_way;
  StepReport earlier;
  // (Who steers may get a step that is stuck going again.)
  int spent = told.command || told.goal ? 0 : state.spent;
  // (Asked of attempts that fail alone: it goes over all fronts of the solids.)
  const auto spent_too_much = [&] {
    return spent > affordable_iterations(model, kMostOfStep * model.scene.newton.limit);
  };
  const auto has_cost = [&](int iterations) {
    return "it came as far as " + three_digits(100.0 * (state.time - from) / h) + " % of the step in " +
           std::to_string(iterations) + " iterations";
  };
  const auto ask = [&] {
    if (told.command)
      command = *told.command;
    else
      scene_command(model, state, to, command);
  };
  const auto give_up = [&] {
    ask();
    const std::string pressure = largest_pressure(model);
    const bool stuck = earlier.status == Status::max_iterations || earlier.status == Status::path_lost;
    if (stuck && !pressure.empty()) earlier.detail += (earlier.detail.empty() ? "" : "; ") + pressure;
    tell_contradiction(model, command, earlier);
    return earlier;
  };
  if (place.parts > 0 && spent_too_much()) {
    earlier.status = Status::max_iterations;
    earlier.detail = has_cost(spent);
    return give_up();
  }
  for (int halvings = first; halvings <= last; ++halvings) {
    StepReport report;
    const int end = place.parts + (place.all() >> halvings);
    const bool lands = end == place.all();
    const double time = lands ? to : from + std::ldexp(h * end, -place.most);
    const double part = lands ? left : std::ldexp(h, -halvings) - place.off;
    // A jump of the command (a constant from the start, say) is spread over the parts of a halved step.
    ask();
    if (!lands) command = between(command_of(model, state), command, part / left);
    if (inverse) {
      if (told.goal)
        goal = *told.goal;
      else
        goal_at(model, time, goal);
      // (So is one of the target.)
      if (!lands && !equilibrium) {
        if (!told.goal) goal_at(model, to, on_the_way);
        on_the_way = part_of_goal(model, state, told.goal ? goal : on_the_way, part / left);
      }
      const PartOfStep made{lands ? nullptr : &on_the_way, place.parts == 0, halvings == first};
      report = equilibrium ? inverse_equilibrium(model, workspace, goal, command, time, state)
                           : inverse_step(model, workspace, goal, command, part, state, effort, made);
    } else {
      report = equilibrium ? taken(equilibrium_step(model, workspace, command, state, time), state)
                           : step(model, workspace, command, part, state, effort);
    }
    report.halvings = halvings;
    // What earlier attempts cost is part of what the step did.
    report.times += earlier.times;
    report.contact.sweeps += earlier.contact.sweeps;
    report.contact.newton += earlier.contact.newton;
    report.contact.work += earlier.contact.work;
    report.contact.cut += earlier.contact.cut;
    spent += report.newton;
    if (accepted(report.status)) {
      state.time = time;
      if (lands) ++state.grid;
      state.spent = lands ? std::max(0, spent - kPaidByStep * model.scene.newton.limit) : spent;
      state.halvings =
          halvings - (halvings > 0 && was_easy(report, halvings == first, model.scene.newton.limit) ? 1 : 0);
      return report;
    }
    earlier = std::move(report);
    if (spent_too_much()) {
      earlier.detail += (earlier.detail.empty() ? "" : "; ") + has_cost(spent);
      break;
    }
    if (contacts_cost_too_much(earlier.contact)) break;
  }
  return give_up();
}

}  // namespace

int most_halvings(const Scene& scene) {
  constexpr double kOfStep = 1e-4, kOfLinearised = 1.0 / 64.0;
  const Time& time = scene.time;
  const double part = time.smallest > 0.0           ? time.smallest / time.step
                      : scene.newton.iterations > 0 ? kOfLinearised
                                                    : kOfStep;
  return std::max(0, static_cast<int>(std::floor(-std::log2(part) + 1e-9)));
}

StepReport advance(const Model& model, Workspace& workspace, State& state, Effort effort, const Told& told) {
  double seconds = 0.0;
  StepReport report;
  {
    const Clock clock(seconds);
    report = try_to_advance(model, workspace, state, effort, told);
    // Where linearisations lead nowhere, not even in parts of the step, one that converges may still go. (Statics and
    // modes converge anyway.)
    const bool steps = model.scene.analysis == Analysis::dynamic || model.scene.analysis == Analysis::quasi_static;
    if (steps && may_converge(step_rules(model, effort), report)) {
      const StepReport linearised = std::move(report);
      effort.converged = true;
      report = try_to_advance(model, workspace, state, effort, told);
      add_linearised(linearised, report);
    }
  }
  report.times.step = seconds;
  return report;
}

long grid_steps(const Scene& scene) {
  if (scene.analysis == Analysis::statics) return 1;
  if (scene.analysis == Analysis::modal) return scene.modes;
  return std::lround(std::ceil(scene.time.duration / scene.time.step - 1e-6));
}

double run_duration(const Scene& scene) {
  if (scene.analysis == Analysis::modal) return scene.modes;
  if (scene.analysis == Analysis::statics) return scene.time.duration;
  return static_cast<double>(grid_steps(scene)) * scene.time.step;
}

bool run_whole(const Scene& scene, double time) { return time >= run_duration(scene) * (1.0 - 1e-9); }

RunEnd run(const Model& model, State state, const OnStep& on_step, StepReport* failure, int threads) {
  Workspace workspace = make_workspace(model, threads);
  const long steps = grid_steps(model.scene);
  try {
    while (state.grid < steps) {
      threads::Interruption::check();
      const StepReport report = advance(model, workspace, state, {.compared = true});
      if (!accepted(report.status)) {
        if (failure) *failure = report;
        return RunEnd::stopped;
      }
      if (!on_step(state, report)) return RunEnd::interrupted;
    }
  } catch (const threads::Interrupted&) {
    return RunEnd::interrupted;
  }
  return RunEnd::done;
}

}  // namespace sinew
