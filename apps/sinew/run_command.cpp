#include <fmt/core.h>

#include <algorithm>
#include <chrono>

#include "sinew/commands.hpp"
#include "sinew/error/input_error.hpp"
#include "sinew/progress.hpp"
#include "sinew/runs/record.hpp"
#include "sinew/signals.hpp"
#include "sinew/sim/targets.hpp"
#include "sinew/sim/view.hpp"
#include "sinew/terminal.hpp"
#include "sinew/threads/interruption.hpp"

namespace sinew::app {

namespace {

/// How near targets were come to.
void print_targets(const Model& model, const State& state, const runs::Digest& digest) {
  if (digest.rows.size() < 2) return;
  std::size_t reached = 0;
  for (const auto& [targets, steps] : digest.targets)
    reached += targets.starts_with("reached") ? static_cast<std::size_t>(steps) : 0;
  say("Targets reached in {} of {} steps; at the end {}\n", reached, digest.rows.size() - 1, digest.last.targets);
  Eigen::VectorXd errors;
  effector_errors(model, state, goal_at(model, state.time), errors);
  for (std::size_t i = 0; i < model.effectors.size(); ++i) {
    const EffectorModel& effector = model.effectors[i];
    const Measure measure = measure_of(model, effector);
    say("  {}: {:.3g} {} off", model.outputs[effector.output].name, error_of(effector, errors) / measure.shown,
        measure.name);
    const runs::WorstError& worst = digest.worst[i];
    if (!worst.targets.empty())
      say("; at most {:.3g} {}, at t = {:.4g} s: {}", worst.error / measure.shown, measure.name, worst.time,
          worst.targets);
    say("\n");
  }
}

void warn(const Warning& warning) { complain("warning: {}\n", to_string(warning)); }

/// After an interruption tables are written as far as this allows.
constexpr std::chrono::milliseconds kTimeForTables{150};

/// What became of the views of a run.
struct WrittenViews {
  bool whole = true;  ///< or the program was interrupted
  std::size_t warnings = 0;
  std::vector<std::string> files;
};

/// Tells how a run went and writes its views, all of them or, where it was interrupted, the tables.
WrittenViews write_views(const std::filesystem::path& folder, const runs::LoadedScene& loaded, const State& last,
                         const runs::RunSummary& summary, std::size_t warnings_before, Progress& progress) {
  const Model& model = loaded.model;
  const std::filesystem::path path = runs::recording_path(folder);
  const runs::StepSource steps = runs::steps_of(path);
  const bool stopped_early = signalled();
  const auto end = std::chrono::steady_clock::now() + kTimeForTables;
  const threads::Interruption interruption(
      [&] { return stopped_early ? std::chrono::steady_clock::now() > end : signalled(); });
  WrittenViews written;
  try {
    const io::RecordingHeader header = io::RecordingReader(path).header();
    const runs::Digest digest = runs::digest(model, summary, header.signal_names, steps);
    written.warnings = digest.warnings.size();
    std::for_each(digest.warnings.begin() + static_cast<std::ptrdiff_t>(warnings_before), digest.warnings.end(), warn);
    progress.finish(fmt::format("{}, {} steps", when(model, last), digest.rows.size() - 1));
    if (!model.effectors.empty()) print_targets(model, last, digest);
    written.files = runs::write_views(folder, {loaded, header, steps, summary, digest},
                                      stopped_early ? runs::Views::tables : runs::Views::all);
    written.whole = !stopped_early;
  } catch (const threads::Interrupted&) {
    written.whole = false;
  }
  return written;
}

/// Steps from a state to the end, records them, writes the views, tells the user; returns the exit code.
int run_and_record(const runs::LoadedScene& loaded, const State& start, const std::filesystem::path& folder,
                   io::RecordingWriter writer, const RunOptions& options) {
  const Model& model = loaded.model;
  Progress progress("sinew " + loaded.file.path.filename().string(), run_duration(model.scene), options.quiet);
  const std::vector<Warning> before = runs::warnings_before(model);
  std::for_each(before.begin(), before.end(), warn);
  note_signals();
  const auto [end, last, summary] = [&] {
    const threads::Interruption interruption(signalled);
    return runs::record(
        model, start, [&writer](const io::RecordedStep& step) { writer.append(step); },
        [&](const State& state, const StepReport&) {
          progress.update(state.time, when(model, state));
          return !signalled();
        },
        options.threads > 0 ? options.threads : runs::usual_threads());
  }();

  const WrittenViews written = write_views(folder, loaded, last, summary, before.size(), progress);
  if (end == RunEnd::stopped) {
    complain("Stopped at {}: {}{}\n    {}\n", when(model, last), to_string(summary.failure.status),
             summary.failure.detail.empty() ? "" : " (" + summary.failure.detail + ")",
             explain(summary.failure.status));
  }
  if (!written.whole) {
    complain(
        "Interrupted at {}: the recording is whole, pictures and ParaView files were left out.\n    Go on with: "
        "sinew run --resume {}\n    Or look at what there is: sinew export {}\n",
        when(model, last), folder.string(), folder.string());
  }
  if (!options.quiet && !written.files.empty()) {
    say("Results in {}/\n", folder.string());
    for (const std::string& file : written.files) say("  {}\n", file);
  }
  if (options.profile) say("{}", runs::profile(summary));
  if (end == RunEnd::stopped) return kNumericalStop;
  if (!written.whole) return kInterrupted;
  return options.strict && written.warnings > 0 ? kWarned : kDone;
}

int resume(const RunOptions& options) {
  const std::filesystem::path path = runs::recording_path(options.resume);
  const auto [recording, count] = io::read_ends(path);
  const runs::LoadedScene loaded = runs::load_recorded(recording, path);
  const Model& model = loaded.model;
  const bool empty = recording.steps.empty();  // killed before the state at t = 0 was written
  const State state = empty ? initial_state(model) : unpack(model, recording.steps.back().state);
  const bool stepped = state.grid >= grid_steps(model.scene) && !recording.torn;
  if (stepped && runs::views_complete(options.resume)) {
    say("The run in {} is complete, up to {}.\n", options.resume.string(), when(model, state));
    return kDone;
  }
  if (!options.quiet)
    say("{} steps are recorded in {}, up to {}; {}.\n", empty ? 0 : count - 1, options.resume.string(),
        when(model, state), stepped ? "tables and pictures are written" : "the run goes on from there");
  io::RecordingWriter writer = io::RecordingWriter::append_to(path);
  if (empty) writer.append(runs::recorded(model, state, StepReport{}));
  if (!stepped) runs::remove_views(options.resume);
  return run_and_record(loaded, state, options.resume, std::move(writer), options);
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
  const std::filesystem::path path = runs::recording_path(folder);
  const auto [recording, count] = io::read_ends(path);
  const runs::LoadedScene loaded = runs::load_recorded(recording, path);
  runs::RunSummary summary;
  const bool whole = !recording.steps.empty() && run_whole(loaded.model.scene, recording.steps.back().time);
  summary.warnings = runs::warnings_before(loaded.model);
  summary.end = whole ? "done" : "unfinished";
  say("{}{} steps up to t = {:.6g} s\n", recording.torn ? "The recording breaks off; kept " : "", count,
      count == 0 ? 0.0 : recording.steps.back().time);
  note_signals();
  const threads::Interruption interruption(signalled);
  try {
    const runs::StepSource steps = runs::steps_of(path);
    const runs::Digest digest = runs::digest(loaded.model, summary, recording.header.signal_names, steps);
    const std::vector<std::string> files =
        runs::write_views(folder, {loaded, recording.header, steps, summary, digest});
    for (const std::string& file : files) say("  {}\n", file);
  } catch (const threads::Interrupted&) {
    complain("Interrupted: not all was written. Do it again with: sinew export {}\n", folder.string());
    return kInterrupted;
  }
  return kDone;
}

}  // namespace sinew::app
