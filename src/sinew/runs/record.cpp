#include "sinew/runs/record.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
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

/// How taut rods may be, T l^2 / (E I) over a section: of converged steps as far as tests/paper/taut_test.cpp goes; of
/// linearised ones 400 and 485 are seen to go there, and 470 to fail (the example's finger, sections shorter than the
/// ways from point to point).
constexpr double kTautConverged = 4000.0, kTautLinearised = 300.0;

/// Rods so taut that this may be why a run stopped.
void warn_of_taut_rods(const Model& model, const State& state, const StepReport& failure,
                       std::vector<Warning>& warnings) {
  const Analysis analysis = model.scene.analysis;
  if (analysis == Analysis::modal) return;  // (what a mode's picture does is no state)
  if (failure.status != Status::diverged && failure.status != Status::max_iterations) return;
  const bool once = model.scene.newton.iterations > 0 && analysis != Analysis::statics;
  const double most = once ? kTautLinearised : kTautConverged;
  for (std::size_t n = 0; n < model.rods.size(); ++n) {
    const double taut = tautness(model, state, static_cast<int>(n));
    if (!(taut > most)) continue;
    Warning own{.code = "rod_too_taut", .where = "rods." + model.rods[n].name};
    own.message = fmt::format(
        "its tension outweighs its bending stiffness, T l^2 / (E I) = {:.0f} of a section of length l; {} may fail "
        "above "
        "{:.0f}",
        taut, once ? "steps that are linearised (`newton: n`)" : "steps", most);
    own.remedy =
        fmt::format("give it fewer sections than intervals between its points{}, or make it a `cable: geometric`",
                    once ? ", leave `newton` out" : "");
    own.time = state.time;
    own.value = taut;
    own.limit = most;
    warnings.push_back(std::move(own));
  }
}

}  // namespace

int usual_threads() { return std::clamp(static_cast<int>(std::thread::hardware_concurrency()), 1, 2); }

std::vector<Warning> warnings_before(const Model& model) {
  std::vector<Warning> warnings = model.warnings;
  const auto add = [&](const auto& drive, const std::string& where) {
    if (!std::holds_alternative<External>(drive)) return;
    warnings.push_back({.code = "driven_from_outside",
                        .where = where,
                        .message = "it is driven from outside, which a run by itself does not; it stays where it is at "
                                   "the start",
                        .remedy = "give a value or a table, or step the scene from a program"});
  };
  for (const ActuatorModel& own : model.actuators) add(own.drive, "actuators." + own.name);
  for (const Target& own : model.scene.targets) add(own.at, "targets." + own.output);
  for (const LoadModel& own : model.loads) add(own.factor, "loads." + own.name);
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
  remove_views(folder);
  writer.append(recorded(loaded.model, start, StepReport{}));
  return writer;
}

void RunWatch::look(const State& state, StepReport& report) {
  const Analysis analysis = model_->scene.analysis;
  if (surfaces_.idle() || analysis == Analysis::modal) return;
  if (analysis != Analysis::statics) {  // the first state of each of the views' intervals, and the last
    const double interval = view_interval(model_->scene), h = model_->scene.time.step;
    const auto frame = [interval](double time) { return std::floor(time / interval + 1e-6); };
    if (frame(state.time) == frame(std::max(0.0, state.time - h)) && !run_whole(model_->scene, state.time)) return;
  }
  for (const SurfaceOverlap& own : surfaces_.look(state)) {
    const std::string &name = model_->solids[own.solid].name, &other = model_->solids[own.other].name;
    Warning warning{.code = own.solid == own.other ? "solid_crosses_itself" : "solids_cross",
                    .where = "solids." + name};
    warning.message =
        fmt::format("its surface passes through {} ({} pairs of triangles, near ({:.3g}, {:.3g}, {:.3g}) m)",
                    own.solid == own.other ? "itself" : "that of solids." + other, own.crossings, own.where.x(),
                    own.where.y(), own.where.z());
    warning.remedy = fmt::format(
        "stop it by a contact pair, `contact: {{pairs: [{{between: [{}, {}]}}]}}`, or move it less", name, other);
    warning.time = state.time;
    warning.value = own.crossings;
    warning.limit = 0.0;
    warning.steps = 1;
    report.warnings.push_back(std::move(warning));
  }
}

RunSummary begin_summary(const Model& model, int threads) {
  RunSummary summary;
  summary.warnings = warnings_before(model);
  summary.threads = threads;
  return summary;
}

void add(const StepReport& report, RunSummary& summary) { summary.times.push_back(report.times); }

void conclude(const Model& model, const State& last, RunEnd end, RunSummary& summary) {
  summary.end = end_word(end);
  if (end == RunEnd::stopped) warn_of_taut_rods(model, last, summary.failure, summary.warnings);
}

Recorded record(const Model& model, const State& start, const std::function<void(io::RecordedStep)>& keep,
                const OnStep& on_step, int threads) {
  Recorded all;
  RunWatch watch(model);
  all.last = start;
  RunSummary& summary = all.summary;
  summary = begin_summary(model, threads);
  all.end = run(
      model, start,
      [&](const State& state, const StepReport& report) {
        StepReport own = report;
        watch.look(state, own);
        keep(recorded(model, state, own));
        add(own, summary);
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
