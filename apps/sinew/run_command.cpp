#include <fmt/core.h>

#include <algorithm>
#include <atomic>
#include <csignal>

#include "sinew/commands.hpp"
#include "sinew/error/input_error.hpp"
#include "sinew/progress.hpp"
#include "sinew/runs/record.hpp"
#include "sinew/sim/targets.hpp"
#include "sinew/sim/view.hpp"

namespace sinew::app {

namespace {

std::atomic<bool> interrupted = false;

/// The first time the step is finished and all is written; the second time the program ends at once, and what was
/// recorded is there.
void on_signal(int signal) {
  interrupted = true;
  std::signal(signal, SIG_DFL);
}

/// How near targets were come to.
void print_targets(const Model& model, const State& state, const io::Recording& recording) {
  if (recording.steps.size() < 2) return;
  std::size_t reached = 0;
  for (const io::RecordedStep& step : recording.steps) reached += step.targets.starts_with("reached") ? 1 : 0;
  fmt::print("Targets reached in {} of {} steps; at the end {}\n", reached, recording.steps.size() - 1,
             recording.steps.back().targets);
  Eigen::VectorXd errors;
  effector_errors(model, state, goal_at(model, state.time), errors);
  for (const EffectorModel& own : model.effectors) {
    const Measure measure = measure_of(model, own);
    const std::string& name = model.outputs[own.output].name;
    fmt::print("  {}: {:.3g} {} off", name, error_of(own, errors) / measure.shown, measure.name);
    const std::vector<std::string>& columns = recording.header.signal_names;
    const auto column = std::find(columns.begin(), columns.end(), name + ".error");
    if (column != columns.end()) {
      const auto error = [&](const io::RecordedStep& step) {
        return step.signals[static_cast<std::size_t>(column - columns.begin())];
      };
      const auto worst = std::max_element(recording.steps.begin() + 1, recording.steps.end(),
                                          [&](const auto& a, const auto& b) { return error(a) < error(b); });
      fmt::print("; at most {:.3g} {}, at t = {:.4g} s: {}", error(*worst) / measure.shown, measure.name, worst->time,
                 worst->targets);
    }
    fmt::print("\n");
  }
}

void warn(const Warning& warning) { fmt::print(stderr, "warning: {}\n", to_string(warning)); }

/// Steps from a state to the end, records them, writes the views, tells the user; returns the exit code.
int run_and_record(const runs::LoadedScene& loaded, const State& start, const std::filesystem::path& folder,
                   io::RecordingWriter writer, const RunOptions& options) {
  const Model& model = loaded.model;
  Progress progress("sinew " + loaded.file.path.filename().string(), run_duration(model.scene), options.quiet);
  const std::vector<Warning> before = runs::warnings_before(model);
  std::for_each(before.begin(), before.end(), warn);
  std::signal(SIGINT, on_signal);
  std::signal(SIGTERM, on_signal);
  const auto [end, last, summary] = runs::record(
      model, start, [&writer](const io::RecordedStep& step) { writer.append(step); },
      [&](const State& state, const StepReport&) {
        progress.update(state.time, when(model, state));
        return !interrupted.load();
      },
      options.threads > 0 ? options.threads : runs::usual_threads());

  const io::Recording recording = io::read_recording(runs::recording_path(folder));
  const std::vector<Warning> warnings = runs::all_warnings(model, summary, recording.steps);
  std::for_each(warnings.begin() + static_cast<std::ptrdiff_t>(before.size()), warnings.end(), warn);
  progress.finish(fmt::format("{}, {} steps", when(model, last), recording.steps.size() - 1));
  if (!model.effectors.empty()) print_targets(model, last, recording);
  const std::vector<std::string> files = runs::write_views(folder, loaded, recording, summary);
  if (end == RunEnd::stopped) {
    fmt::print(stderr, "Stopped at {}: {}{}\n    {}\n", when(model, last), to_string(summary.failure.status),
               summary.failure.detail.empty() ? "" : " (" + summary.failure.detail + ")",
               explain(summary.failure.status));
  }
  if (end == RunEnd::interrupted)
    fmt::print(stderr, "Interrupted; go on with: sinew run --resume {}\n", folder.string());
  if (!options.quiet) {
    fmt::print("Results in {}/\n", folder.string());
    for (const std::string& file : files) fmt::print("  {}\n", file);
  }
  if (options.profile) fmt::print("{}", runs::profile(summary));
  if (end != RunEnd::done) return end == RunEnd::stopped ? kNumericalStop : kInterrupted;
  return options.strict && !warnings.empty() ? kWarned : kDone;
}

int resume(const RunOptions& options) {
  const std::filesystem::path path = runs::recording_path(options.resume);
  const io::Recording recording = io::read_recording(path);
  const runs::LoadedScene loaded = runs::load_recorded(recording, path);
  if (recording.steps.empty())
    throw InputError({path.string(), 0, "", "", "holds no finished step", "start the run again"});
  const State state = unpack(loaded.model, recording.steps.back().state);
  if (!recording.torn && state.grid >= grid_steps(loaded.model.scene) &&
      std::filesystem::exists(options.resume / "report.json")) {
    fmt::print("The run in {} is complete, up to {}.\n", options.resume.string(), when(loaded.model, state));
    return kDone;
  }
  return run_and_record(loaded, state, options.resume, io::RecordingWriter::append_to(path), options);
}

}  // namespace

int run_scene(const RunOptions& options) {
  if (!options.resume.empty()) return resume(options);
  if (options.scene.empty())
    throw InputError({"", 0, "", "", "no scene was given", "sinew run SCENE -o FOLDER, or sinew run --resume FOLDER"});
  std::vector<std::string> overrides = options.overrides;
  if (!options.commands.empty()) {
    for (std::string& change : runs::driven_by(options.commands, io::read_scene(options.scene, options.overrides)))
      overrides.push_back(std::move(change));
  }
  const runs::LoadedScene loaded = runs::load(io::read_scene(options.scene, overrides));
  const State start = initial_state(loaded.model);
  return run_and_record(loaded, start, options.output,
                        runs::begin_recording(loaded, start, options.output, options.force), options);
}

int export_run(const std::filesystem::path& folder) {
  const io::Recording recording = io::read_recording(runs::recording_path(folder));
  const runs::LoadedScene loaded = runs::load_recorded(recording, runs::recording_path(folder));
  runs::RunSummary summary;
  const bool whole = !recording.steps.empty() && run_whole(loaded.model.scene, recording.steps.back().time);
  summary.warnings = runs::warnings_before(loaded.model);
  summary.end = whole ? "done" : "unfinished";
  fmt::print("{}{} steps up to t = {:.6g} s\n", recording.torn ? "The recording breaks off; kept " : "",
             recording.steps.size(), recording.steps.empty() ? 0.0 : recording.steps.back().time);
  for (const std::string& file : runs::write_views(folder, loaded, recording, summary)) fmt::print("  {}\n", file);
  return kDone;
}

}  // namespace sinew::app
