// A run whose steps are kept: what comes out of it besides its states.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "sinew/io/recording.hpp"
#include "sinew/runs/loaded_scene.hpp"
#include "sinew/runs/results.hpp"
#include "sinew/sim/run.hpp"
#include "sinew/sim/surface_overlap.hpp"

namespace sinew::runs {

/// Threads that share the work of a step unless somebody asks for another number: two, if the machine has them.
int usual_threads();

/// What a person should know before a run: what `build` found, and what is driven from outside, which a run by itself
/// leaves as it is.
std::vector<Warning> warnings_before(const Model& model);

/// What a recording begins with.
io::RecordingHeader header_of(const LoadedScene& loaded);

/// A new recording in a folder, with the state at t = 0 and the meshes that were handed over; the folder is made.
/// Throws InputError if it cannot be, or if it holds a recording that is not to be replaced.
io::RecordingWriter begin_recording(const LoadedScene& loaded, const State& start, const std::filesystem::path& folder,
                                    bool replace);

/// Watches what takes too long to be looked at in every step: surfaces of solids that pass through themselves or each
/// other, at the rate of the views.
class RunWatch {
 public:
  explicit RunWatch(const Model& model) : model_(&model), surfaces_(model) {}
  /// Adds warnings to the report of the step that ended there.
  void look(const State& state, StepReport& report);

 private:
  const Model* model_;
  SurfaceWatch surfaces_;
};

/// What is known of a run before, in each step that was accepted, and at its end.
RunSummary begin_summary(const Model& model, int threads);
void add(const StepReport& report, RunSummary& summary);
void conclude(const Model& model, const State& last, RunEnd end, RunSummary& summary);

/// How a run ended.
struct Recorded {
  RunEnd end = RunEnd::done;
  State last;
  RunSummary summary;  ///< its warnings are those before the run, then those after
};

/// Steps from a state to the end of the scene. Every accepted step is kept before `on_step` sees it, which may
/// interrupt.
Recorded record(const Model& model, const State& start, const std::function<void(io::RecordedStep)>& keep,
                const OnStep& on_step, int threads);

/// Changes of a scene ("path=value") that let a table of commands (columns such as pull.force) drive its motors instead
/// of targets. Throws InputError where a column is none of a motor's, or a sought motor has none.
std::vector<std::string> driven_by(const std::filesystem::path& table, const io::SceneFile& file);

}  // namespace sinew::runs
