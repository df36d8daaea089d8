// A run: steps along the scene's time grid, halved where they do not converge.
#pragma once

#include <functional>

#include "sinew/sim/step.hpp"
#include "sinew/sim/targets.hpp"

namespace sinew {

/// A step that does not converge is tried again with half the time, this many times at most: down to `Time::smallest`.
/// Parts of a step begin at multiples of themselves. The next one is as long as the last that went (`State::halvings`),
/// or twice as long after one that was easy.
int most_halvings(const Scene& scene);

/// What a controller says instead of the scene, for the next point of the time grid; null: the scene's own, and what
/// is driven from outside stays as it is.
struct Told {
  const Command* command = nullptr;
  const Goal* goal = nullptr;
  bool forward = false;  ///< sought motors obey the command like all others; targets are not looked at
};

/// One accepted step towards the next point of the time grid, halved as often as needed: the only thing that decides
/// how far is the state, so a run continued from a recorded state makes the same steps. On failure the state stays.
StepReport advance(const Model& model, Workspace& workspace, State& state, Effort effort = {}, const Told& told = {});

/// Steps of the whole grid: duration / step, rounded up to a whole number; of statics one, to the end of the path (of
/// as many accepted steps as it takes); of a modal analysis the number of modes.
long grid_steps(const Scene& scene);

/// The time at which a run ends [s]; of a modal analysis the number of modes.
double run_duration(const Scene& scene);
/// Whether a run that has come to this time is through.
bool run_whole(const Scene& scene, double time);

enum class RunEnd { done, stopped, interrupted };

/// Takes every accepted state; returns false to interrupt the run.
using OnStep = std::function<bool(const State&, const StepReport&)>;

/// Steps from `state` to the end of the scene's duration. `failure` receives the report of the step that stopped it. A
/// `threads::Interruption` of the calling thread ends it within a step, which is lost.
RunEnd run(const Model& model, State state, const OnStep& on_step, StepReport* failure = nullptr, int threads = 1);

}  // namespace sinew
