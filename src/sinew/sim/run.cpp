#include "sinew/sim/run.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

#include "sinew/sim/clock.hpp"
#include "sinew/sim/inverse.hpp"
#include "sinew/sim/modal.hpp"
#include "sinew/sim/motors.hpp"
#include "sinew/sim/newton.hpp"
#include "sinew/sim/statics.hpp"

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

/// Where a state is within its step of the grid, which has kParts parts.
constexpr int kParts = 1 << kHalvings;
struct PlaceInStep {
  int parts = 0;     ///< that it has behind it
  double off = 0.0;  ///< [s] beyond that; rounding of the time is none
  int halvings() const { return parts == 0 ? 0 : kHalvings - std::countr_zero(static_cast<unsigned>(parts)); }
};

PlaceInStep place_in_step(double h, double done) {
  const double part = std::ldexp(h, -kHalvings);
  const int parts = static_cast<int>(std::clamp(std::round(done / part), 0.0, kParts - 1.0));
  const double off = done - parts * part;
  return {parts, std::abs(off) < 1e-3 * part ? 0.0 : off};
}

StepReport try_to_advance(const Model& model, Workspace& workspace, State& state, Effort effort, const Told& told) {
  if (model.scene.analysis == Analysis::statics) return taken(static_step(model, workspace, state), state);
  if (model.scene.analysis == Analysis::modal) return taken(modal_step(model, workspace, state), state);
  const bool equilibrium = model.scene.analysis == Analysis::quasi_static && !step_rules(model, effort).fixed;
  const double h = model.scene.time.step;
  const double from = static_cast<double>(state.grid) * h, to = static_cast<double>(state.grid + 1) * h;
  const PlaceInStep place = place_in_step(h, state.time - from);
  const double left = std::ldexp(h * (kParts - place.parts), -kHalvings) - place.off;
  Command& command = workspace.memory().command;
  const bool inverse = !model.effectors.empty() && !told.forward;
  // With contacts an equilibrium has been looked for along parts of the step already.
  const int last = equilibrium && !inverse && !model.pairs.empty() ? place.halvings() : kHalvings;
  Goal goal;
  StepReport earlier;
  for (int halvings = place.halvings(); halvings <= last; ++halvings) {
    StepReport report;
    const int end = place.parts + (kParts >> halvings);
    const bool lands = end == kParts;
    const double time = lands ? to : from + std::ldexp(h * end, -kHalvings);
    const double part = lands ? left : std::ldexp(h, -halvings) - place.off;
    // A jump of the command (a constant from the start, say) is spread over the parts of a halved step.
    if (told.command)
      command = *told.command;
    else
      scene_command(model, state, to, command);
    if (!lands) command = between(command_of(model, state), command, part / left);
    if (inverse) {
      if (told.goal)
        goal = *told.goal;
      else
        goal_at(model, time, goal);
      report = equilibrium ? inverse_equilibrium(model, workspace, goal, command, time, state)
                           : inverse_step(model, workspace, goal, command, part, state, effort);
    } else {
      report = equilibrium ? taken(equilibrium_step(model, workspace, command, state, time), state)
                           : step(model, workspace, command, part, state, effort);
    }
    report.halvings = halvings;
    // What earlier attempts cost is part of what the step did.
    report.times += earlier.times;
    report.contact.sweeps += earlier.contact.sweeps;
    report.contact.newton += earlier.contact.newton;
    if (accepted(report.status)) {
      state.time = time;
      if (lands) ++state.grid;
      return report;
    }
    earlier = std::move(report);
  }
  return earlier;
}

}  // namespace

StepReport advance(const Model& model, Workspace& workspace, State& state, Effort effort, const Told& told) {
  double seconds = 0.0;
  StepReport report;
  {
    const Clock clock(seconds);
    report = try_to_advance(model, workspace, state, effort, told);
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
  while (state.grid < steps) {
    const StepReport report = advance(model, workspace, state, {.compared = true});
    if (!accepted(report.status)) {
      if (failure) *failure = report;
      return RunEnd::stopped;
    }
    if (!on_step(state, report)) return RunEnd::interrupted;
  }
  return RunEnd::done;
}

}  // namespace sinew
