#include "sinew/runs/record.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <thread>

#include "sinew/error/input_error.hpp"
#include "sinew/io/csv_table.hpp"
#include "sinew/sim/internal.hpp"
#include "sinew/sim/places.hpp"
#include "sinew/sim/signals.hpp"

namespace sinew::runs {

namespace {

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
void add_warnings(const Model& model, const State& state, std::vector<std::string>& warnings) {
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
}

/// How taut rods may be, T l^2 / (E I) over a section: of converged steps as far as tests/paper/taut_test.cpp goes; of
/// linearised ones 400 and 485 are seen to go there, and 470 to fail (the example's finger, sections shorter than the
/// ways from point to point).
constexpr double kTautConverged = 4000.0, kTautLinearised = 300.0;

/// Rods so taut that this may be why a run stopped.
void warn_of_taut_rods(const Model& model, const State& state, const StepReport& failure,
                       std::vector<std::string>& warnings) {
  const Analysis analysis = model.scene.analysis;
  if (analysis == Analysis::modal) return;  // (what a mode's picture does is no state)
  if (failure.status != Status::diverged && failure.status != Status::max_iterations) return;
  const bool once = model.scene.newton.iterations > 0 && analysis != Analysis::statics;
  const double most = once ? kTautLinearised : kTautConverged;
  for (std::size_t n = 0; n < model.rods.size(); ++n) {
    const double taut = tautness(model, state, static_cast<int>(n));
    if (!(taut > most)) continue;
    warnings.push_back(fmt::format(
        "rods.{}: its tension outweighs its bending stiffness, T l^2 / (E I) = {:.0f} of a section of length l; {} may "
        "fail above {:.0f}. Give it fewer sections than intervals between its points{}, or make it a `cable: "
        "geometric`",
        model.rods[n].name, taut, once ? "steps that are linearised (`newton: n`)" : "steps", most,
        once ? ", leave `newton` out" : ""));
  }
}

}  // namespace

int usual_threads() { return std::clamp(static_cast<int>(std::thread::hardware_concurrency()), 1, 2); }

std::vector<std::string> warnings_before(const Model& model) {
  std::vector<std::string> warnings = model.warnings;
  const auto add = [&](const Drive& drive, const std::string& what) {
    if (std::holds_alternative<External>(drive)) warnings.push_back(what);
  };
  for (const ActuatorModel& own : model.actuators)
    add(own.drive, "actuators." + own.name +
                       ": driven from outside, which a run by itself does not; it stays where it is at the start");
  for (const Target& own : model.scene.targets) {
    if (std::holds_alternative<External>(own.at))
      warnings.push_back("targets." + own.output +
                         ": set from outside, which a run by itself does not; it stays where it is at the start");
  }
  for (const LoadModel& own : model.loads)
    add(own.factor,
        "loads." + own.name + ": set from outside, which a run by itself does not; it stays where it is at the start");
  return warnings;
}

io::RecordingHeader header_of(const LoadedScene& loaded) {
  io::RecordingHeader header;
  header.program_version = SINEW_VERSION;
  header.scene_text = loaded.file.text;
  header.scene_name = loaded.file.path.filename().string();
  header.scene_folder = std::filesystem::absolute(loaded.model.scene.folder).lexically_normal().string();
  header.inputs_hash = loaded.inputs_hash;
  header.state_layout = kStateLayout;
  header.signal_names = signal_names(loaded.model);
  return header;
}

io::RecordingWriter begin_recording(const LoadedScene& loaded, const State& start, const std::filesystem::path& folder,
                                    bool replace) {
  const std::filesystem::path path = recording_path(folder);
  if (std::filesystem::exists(path) && !replace) {
    throw InputError(
        {folder.string(), 0, "", "", "already holds the results of a run",
         "give another folder with -o, replace them with --force, or go on with --resume " + folder.string()});
  }
  std::error_code failed;
  std::filesystem::create_directories(folder, failed);
  if (failed)
    throw InputError(
        {folder.string(), 0, "", "", "the folder cannot be made: " + failed.message(), "give another one with -o"});
  if (!loaded.held.empty()) std::filesystem::create_directories(held_folder(folder), failed);
  for (const auto& [name, bytes] : loaded.held) {
    io::AppendFile file(held_folder(folder) / name, io::AppendFile::Start::empty);
    file.append(bytes);
  }
  io::RecordingWriter writer = io::RecordingWriter::create(path, header_of(loaded));
  writer.append(recorded(loaded.model, start, StepReport{}));
  return writer;
}

RunSummary begin_summary(const Model& model, int threads) {
  RunSummary summary;
  summary.warnings = warnings_before(model);
  summary.threads = threads;
  return summary;
}

void add(const Model& model, const State& state, const StepReport& report, RunSummary& summary) {
  summary.times.push_back(report.times);
  summary.rotated += report.rotated ? 1 : 0;
  summary.redundant += report.redundant ? 1 : 0;
  summary.halved += report.halvings > 0 ? 1 : 0;
  summary.unstable = report.unstable;
  add(report.contact, summary.contact);
  if (model.scene.analysis != Analysis::modal)  // (what a mode's picture does is no state)
    summary.most_inverted = std::max(summary.most_inverted, count_folded(model, state));
}

void conclude(const Model& model, const State& last, RunEnd end, RunSummary& summary) {
  summary.end = end_word(end);
  add_warnings(model, last, summary.warnings);
  if (end == RunEnd::stopped) warn_of_taut_rods(model, last, summary.failure, summary.warnings);
  if (summary.unstable) {
    summary.warnings.push_back(
        "the last equilibrium is unstable, a real body would have buckled; a small side load or shorter steps show "
        "where it goes");
  }
  if (summary.most_inverted > 0) {
    summary.warnings.push_back(fmt::format(
        "up to {} elements were flat or inside out ({} at the end): this is no state of a real body. Look at "
        "volume_ratio in ParaView; load it less or slower, or give a finer mesh or another law",
        summary.most_inverted, count_folded(model, last)));
  }
}

Recorded record(const Model& model, const State& start, const std::function<void(io::RecordedStep)>& keep,
                const OnStep& on_step, int threads) {
  Recorded all;
  all.last = start;
  RunSummary& summary = all.summary;
  summary = begin_summary(model, threads);
  all.end = run(
      model, start,
      [&](const State& state, const StepReport& report) {
        keep(recorded(model, state, report));
        add(model, state, report, summary);
        all.last = state;
        return on_step(state, report);
      },
      &summary.failure, threads);
  conclude(model, all.last, all.end, summary);
  return all;
}

std::vector<std::string> driven_by(const std::filesystem::path& table, const io::SceneFile& file) {
  std::vector<std::string> overrides;
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
  return overrides;
}

}  // namespace sinew::runs
