#include <fmt/core.h>

#include <algorithm>
#include <atomic>
#include <csignal>
#include <stdexcept>
#include <thread>

#include "sinew/commands.hpp"
#include "sinew/error/input_error.hpp"
#include "sinew/io/csv_table.hpp"
#include "sinew/progress.hpp"
#include "sinew/results.hpp"
#include "sinew/sim/places.hpp"
#include "sinew/sim/run.hpp"
#include "sinew/sim/signals.hpp"
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

std::string end_word(RunEnd end) {
  switch (end) {
    case RunEnd::done:
      return "done";
    case RunEnd::stopped:
      return "numerical_stop";
    case RunEnd::interrupted:
      return "interrupted";
  }
  return "";
}

/// What a person should know about the state a run ended in.
std::vector<std::string> warnings_of(const Model& model, const State& state) {
  std::vector<std::string> warnings;
  for (std::size_t i = 0; i < model.couplings.size(); ++i) {
    bool any = false, on = false;
    for (std::size_t k = 0; k < model.points.size(); ++k) {
      if (model.points[k].coupling != static_cast<int>(i)) continue;
      any = true;
      on |= state.points[k].on;
    }
    if (any && !on)
      warnings.push_back(
          fmt::format("couplings.{}: the rod has left the body, none of its points is on it any more", i));
  }
  for (std::size_t i = 0; i < model.actuators.size(); ++i) {
    if (model.actuators[i].tendon && state.actuators[i] < 0.0)
      warnings.push_back(fmt::format("actuators.{}: the tendon pushes with {:.3g} N; a real one would go slack",
                                     model.actuators[i].name, -state.actuators[i]));
  }
  for (const GeometricCableModel& cable : model.cables) {
    const double tension = state.lambda[cable.length_row];
    if (tension < 0.0) {
      warnings.push_back(fmt::format("rods.{}: the geometric cable pushes with {:.3g} N; a real one would go slack",
                                     cable.name, -tension));
    }
  }
  return warnings;
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

/// Steps from a state to the end, records them, writes the views, tells the user; returns the exit code.
int run_and_record(const LoadedScene& loaded, const State& start, const std::filesystem::path& folder,
                   io::RecordingWriter writer, const RunOptions& options) {
  const Model& model = loaded.model;
  const double duration = run_duration(model.scene);
  Progress progress("sinew " + loaded.file.path.filename().string(), duration, options.quiet);
  RunSummary summary;
  summary.warnings = model.warnings;
  summary.threads =
      options.threads > 0 ? options.threads : std::clamp(static_cast<int>(std::thread::hardware_concurrency()), 1, 2);
  for (const ActuatorModel& actuator : model.actuators) {
    if (std::holds_alternative<External>(actuator.drive)) {
      summary.warnings.push_back("actuators." + actuator.name +
                                 ": driven from outside, which this program cannot; it stays at 0");
    }
  }
  for (const Target& target : model.scene.targets) {
    if (std::holds_alternative<External>(target.at))
      summary.warnings.push_back("targets." + target.output +
                                 ": set from outside, which this program cannot; it stays where it is at the start");
  }
  for (const LoadModel& load : model.loads) {
    if (std::holds_alternative<External>(load.factor))
      summary.warnings.push_back("loads." + load.name + ": set from outside, which this program cannot; it stays at 0");
  }
  for (const std::string& warning : summary.warnings) fmt::print(stderr, "warning: {}\n", warning);
  State last = start;
  bool unstable = false;
  std::signal(SIGINT, on_signal);
  std::signal(SIGTERM, on_signal);
  const RunEnd end = run(
      model, start,
      [&](const State& state, const StepReport& report) {
        writer.append(recorded(model, state, report));
        summary.times.push_back(report.times);
        summary.rotated += report.rotated ? 1 : 0;
        summary.redundant += report.redundant ? 1 : 0;
        summary.halved += report.halvings > 0 ? 1 : 0;
        unstable = report.unstable;
        add(report.contact, summary.contact);
        if (model.scene.analysis != Analysis::modal)  // (what a mode's picture does is no state)
          summary.most_inverted = std::max(summary.most_inverted, count_folded(model, state));
        last = state;
        progress.update(state.time, when(model, state));
        return !interrupted.load();
      },
      &summary.failure, summary.threads);
  summary.end = end_word(end);

  std::vector<std::string> warnings = warnings_of(model, last);
  if (unstable) {
    warnings.push_back(
        "the last equilibrium is unstable, a real body would have buckled; a small side load or shorter steps show "
        "where it goes");
  }
  if (summary.most_inverted > 0) {
    warnings.push_back(fmt::format(
        "up to {} elements were flat or inside out ({} at the end): this is no state of a real body. Look at "
        "volume_ratio in ParaView; load it less or slower, or give a finer mesh or another law",
        summary.most_inverted, count_folded(model, last)));
  }
  for (const std::string& warning : warnings) {
    summary.warnings.push_back(warning);
    fmt::print(stderr, "warning: {}\n", warning);
  }
  const io::Recording recording = io::read_recording(recording_path(folder));
  progress.finish(fmt::format("{}, {} steps", when(model, last), recording.steps.size() - 1));
  if (!options.quiet && !model.effectors.empty()) print_targets(model, last, recording);
  const std::vector<std::string> files = write_views(folder, loaded, recording, summary);
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
  if (options.profile) fmt::print("{}", profile(summary));
  return end == RunEnd::done ? kDone : end == RunEnd::stopped ? kNumericalStop : kInterrupted;
}

/// Changes of a scene that let a table of commands drive it.
void add_commands(const std::filesystem::path& table, const io::SceneFile& file, std::vector<std::string>& overrides) {
  const std::string path = std::filesystem::absolute(table).lexically_normal().string();
  const std::vector<std::string> columns = io::csv_columns(table);
  for (const auto& [name, actuator] : file.scene.actuators) {
    const auto of_it = [&, prefix = name + "."](const std::string& column) { return column.starts_with(prefix); };
    if (std::holds_alternative<Sought>(actuator.drive) && std::none_of(columns.begin(), columns.end(), of_it))
      throw InputError({table.string(), 1, "", "",
                        "has no column for actuators." + name + ", which the scene leaves open",
                        "add a column such as " + name + ".force or " + name + ".displacement"});
  }
  for (const std::string& column : columns) {
    if (column == "time") continue;
    const std::size_t dot = column.rfind('.');
    const std::string name = column.substr(0, dot), kind = dot == std::string::npos ? "" : column.substr(dot + 1);
    if ((kind != "force" && kind != "displacement" && kind != "torque" && kind != "angle") ||
        !file.lines.contains("actuators." + name))
      throw InputError({table.string(), 1, "", column, "is no command of an actuator of this scene",
                        "columns are `time` and commands such as pull.force, pull.displacement, turn.angle"});
    const bool tension = kind == "force" && file.lines.contains("actuators." + name + ".tension");
    const char* const key = tension ? "tension" : kind.c_str();
    overrides.push_back(fmt::format("actuators.{}.{}={{file: \"{}\", column: {}}}", name, key, path, column));
  }
  overrides.emplace_back("targets={}");
}

/// The scene of a recording, as it was when it was recorded.
LoadedScene load_recorded(const io::Recording& recording, const std::filesystem::path& path) {
  const io::RecordingHeader& header = recording.header;
  if (header.state_layout != kStateLayout)
    throw InputError({path.string(), 0, "", "", "holds states of another version of the engine",
                      "run the scene again, or use the version of Sinew that recorded it, " + header.program_version});
  LoadedScene loaded = load(io::parse_scene(header.scene_text, header.scene_name, header.scene_folder));
  if (loaded.inputs_hash != header.inputs_hash)
    throw InputError({path.string(), 0, "", "", "the scene's mesh files are not the ones this run was made with",
                      "restore them in " + header.scene_folder + ", or start a new run"});
  try {
    for (const io::RecordedStep& step : recording.steps) unpack(loaded.model, step.state);
  } catch (const std::invalid_argument&) {
    throw InputError({path.string(), 0, "", "", "holds states of another model of its scene",
                      "run the scene again, or use the version of Sinew that recorded it, " + header.program_version});
  }
  return loaded;
}

int resume(const RunOptions& options) {
  const std::filesystem::path path = recording_path(options.resume);
  const io::Recording recording = io::read_recording(path);
  const LoadedScene loaded = load_recorded(recording, path);
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
  if (!options.commands.empty())
    add_commands(options.commands, io::read_scene(options.scene, options.overrides), overrides);
  LoadedScene loaded = load(io::read_scene(options.scene, overrides));
  const std::filesystem::path path = recording_path(options.output);
  if (std::filesystem::exists(path) && !options.force) {
    throw InputError(
        {options.output.string(), 0, "", "", "already holds the results of a run",
         "give another folder with -o, replace them with --force, or go on with --resume " + options.output.string()});
  }
  std::error_code failed;
  std::filesystem::create_directories(options.output, failed);
  if (failed)
    throw InputError({options.output.string(), 0, "", "", "the folder cannot be made: " + failed.message(),
                      "give another one with -o"});

  const State start = initial_state(loaded.model);
  io::RecordingHeader header;
  header.program_version = SINEW_VERSION;
  header.scene_text = loaded.file.text;
  header.scene_name = loaded.file.path.filename().string();
  header.scene_folder = std::filesystem::absolute(loaded.model.scene.folder).lexically_normal().string();
  header.inputs_hash = loaded.inputs_hash;
  header.state_layout = kStateLayout;
  header.signal_names = signal_names(loaded.model);
  io::RecordingWriter writer = io::RecordingWriter::create(path, header);
  writer.append(recorded(loaded.model, start, StepReport{}));
  return run_and_record(loaded, start, options.output, std::move(writer), options);
}

int export_run(const std::filesystem::path& folder) {
  const io::Recording recording = io::read_recording(recording_path(folder));
  const LoadedScene loaded = load_recorded(recording, recording_path(folder));
  RunSummary summary;
  const bool whole =
      !recording.steps.empty() && recording.steps.back().time >= run_duration(loaded.model.scene) * (1.0 - 1e-9);
  summary.warnings = loaded.model.warnings;
  summary.end = whole ? "done" : "unfinished";
  fmt::print("{}{} steps up to t = {:.6g} s\n", recording.torn ? "The recording breaks off; kept " : "",
             recording.steps.size(), recording.steps.empty() ? 0.0 : recording.steps.back().time);
  for (const std::string& file : write_views(folder, loaded, recording, summary)) fmt::print("  {}\n", file);
  return kDone;
}

}  // namespace sinew::app
