#include "sinew/runs/results.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>

#include "sinew/io/atomic_file.hpp"
#include "sinew/io/signals_csv.hpp"
#include "sinew/io/vtu.hpp"
#include "sinew/runs/report.hpp"
#include "sinew/sim/inverse.hpp"
#include "sinew/sim/motors.hpp"
#include "sinew/sim/run.hpp"
#include "sinew/sim/signals.hpp"
#include "sinew/sim/view.hpp"
#include "sinew/threads/interruption.hpp"

namespace sinew::runs {

std::filesystem::path recording_path(const std::filesystem::path& folder) { return folder / "run.sinew"; }

namespace {

io::StepCounts counts_of(const StepReport& report) {
  const auto count = [](int number) { return static_cast<std::uint32_t>(number); };
  const ContactReport& contact = report.contact;
  return {.halvings = count(report.halvings),
          .rotated = report.rotated,
          .redundant = report.redundant,
          .at_floor = report.at_floor,
          .unstable = report.unstable,
          .stability_known = report.stability_known,
          .contacts = count(contact.contacts),
          .penetration = contact.penetration,
          .sweeps = count(contact.sweeps),
          .contact_newton = count(contact.newton),
          .unsolved = count(contact.unsolved),
          .complementarity = contact.left.complementarity,
          .cone = contact.left.cone,
          .dissipation = contact.left.dissipation};
}

}  // namespace

io::RecordedStep recorded(const Model& model, const State& state, const StepReport& report) {
  return {state.time,
          std::string(to_string(report.status)),
          describe(model, report.aim),
          static_cast<std::uint32_t>(report.newton),
          report.residual,
          report.violation,
          signal_values(model, state),
          pack(state),
          counts_of(report),
          report.warnings};
}

std::vector<Warning> all_warnings(const Model& model, const RunSummary& summary,
                                  const std::vector<io::RecordedStep>& steps) {
  return digest(model, summary, signal_names(model), steps_of(steps)).warnings;
}

double view_interval(const Scene& scene) {
  return scene.view.interval > 0.0 ? scene.view.interval : std::max(scene.time.step, run_duration(scene) / 100.0);
}

namespace {

/// Writes the ParaView series: about 100 frames a run, or one per `view.interval`; the last state always.
class Frames {
 public:
  Frames(const Model& model, const std::filesystem::path& folder) : model_(model), series_(folder) {
    in_time_ = model.scene.analysis == Analysis::dynamic || model.scene.analysis == Analysis::quasi_static;
  }

  void add(const io::RecordedStep& step, bool last) {
    const double time = step.time, slack = 1e-9 * run_duration(model_.scene);
    const auto number = static_cast<double>(number_++);
    if (in_time_ && time < next_ - slack && !last) return;
    while (next_ <= time + slack) next_ += view_interval(model_.scene);
    threads::Interruption::check();
    Snapshot frame = snapshot(model_, unpack(model_, step.state), step.status);
    if (!in_time_) frame.time = number;  // a static path may turn back in time
    series_.add(frame);
  }

  void finish() { series_.finish(); }

 private:
  const Model& model_;
  io::SeriesWriter series_;
  bool in_time_ = true;
  double next_ = 0.0;
  long number_ = 0;
};

void draw(const std::filesystem::path& path, const RecordedRun& run) {
  const Model& model = run.loaded.model;
  const Digest& digest = run.digest;
  io::PictureOptions options;
  options.title =
      model.scene.title.empty() ? std::filesystem::path(run.header.scene_name).stem().string() : model.scene.title;
  options.up = -model.scene.gravity;
  options.courses = digest.courses;
  options.outcome = digest.last.targets;
  options.warnings = static_cast<int>(digest.warnings.size());
  const std::string& end = run.summary.end;
  const std::string status = end == "done" ? digest.last.status
                             : end == "numerical_stop"
                                 ? "stopped: " + std::string(to_string(run.summary.failure.status))
                                 : end;
  io::draw_picture(path, snapshot(model, unpack(model, digest.first.state), digest.first.status),
                   snapshot(model, unpack(model, digest.last.state), status), options);
}

/// Bytes of a file, or of all files of a folder; -1 if there is none.
std::int64_t size_on_disk(const std::filesystem::path& path) {
  std::error_code error;
  if (!std::filesystem::is_directory(path, error)) {
    const std::uintmax_t size = std::filesystem::file_size(path, error);
    return error ? -1 : static_cast<std::int64_t>(size);
  }
  std::int64_t sum = 0;
  for (const auto& entry : std::filesystem::directory_iterator(path, error))
    sum += static_cast<std::int64_t>(entry.file_size(error));
  return error ? -1 : sum;
}

}  // namespace

std::vector<std::string> write_views(const std::filesystem::path& folder, const RecordedRun& run, Views views) {
  const Model& model = run.loaded.model;
  const std::size_t count = run.digest.rows.size();
  std::vector<std::string> commands;
  for (const int sought : model.sought) commands.push_back(command_name(model.actuators[sought]));
  const std::optional<nlohmann::ordered_json> earlier = earlier_report(folder);
  io::remove_earlier(folder / "report.json");  // (it says that all others are there)
  {
    io::SignalsTable signals(folder / "signals.csv", run.header, run.digest.has_targets());
    std::optional<io::ColumnsTable> columns;
    if (!commands.empty()) columns.emplace(folder / "commands.csv", run.header, commands);
    std::optional<Frames> frames;
    if (views == Views::all) frames.emplace(model, folder / "paraview");
    std::size_t number = 0;
    run.steps([&](const io::RecordedStep& step) {
      signals.add(step);
      if (columns) columns->add(step);
      if (frames) frames->add(step, ++number == count);
    });
    signals.finish();
    if (columns) columns->finish();
    if (frames) frames->finish();
  }
  threads::Interruption::check();
  if (views == Views::all && count > 0) draw(folder / "picture.png", run);
  std::vector<std::string> names = {"signals.csv"};
  if (!commands.empty()) names.emplace_back("commands.csv");
  if (views == Views::all) names.insert(names.end(), {"paraview", "picture.png"});
  nlohmann::ordered_json files = nlohmann::ordered_json::object();
  for (const std::string& name : names) files[name] = size_on_disk(folder / name);
  write_report(folder / "report.json", run, earlier, files);

  std::vector<std::string> list = {"signals.csv        outputs and motors over time"};
  if (!commands.empty()) list.emplace_back("commands.csv       what the motors are to do, for sinew run --commands");
  if (views == Views::all) {
    list.insert(list.begin(), "picture.png        the end state");
    list.emplace_back("paraview/run.pvd   the motion, for ParaView");
  }
  list.emplace_back("report.json        sizes, status of every step, times");
  list.emplace_back("run.sinew          the recording, for --resume and export");
  return list;
}

void remove_views(const std::filesystem::path& folder) {
  for (const char* name : {"report.json", "picture.png", "signals.csv", "commands.csv", "paraview"})
    io::remove_earlier(folder / name);
}

bool views_complete(const std::filesystem::path& folder) {
  const std::optional<nlohmann::ordered_json> report = earlier_report(folder);
  if (!report || !report->contains("files") || !(*report)["files"].is_object()) return false;
  const nlohmann::ordered_json& files = (*report)["files"];
  return files.contains("picture.png") &&
         std::all_of(files.items().begin(), files.items().end(), [&](const auto& file) {
           return file.value().is_number_integer() && file.value() == size_on_disk(folder / file.key());
         });
}

std::string profile(const RunSummary& summary) {
  if (summary.times.empty()) return "No step was made.\n";
  StageTimes sum;
  for (const StageTimes& own : summary.times) sum += own;
  const auto steps = static_cast<double>(summary.times.size());
  std::string text =
      fmt::format("Time of {} steps, {} thread{}\n  {:<11} {:>10} {:>10} {:>8}  {}\n", summary.times.size(),
                  summary.threads, summary.threads == 1 ? "" : "s", "stage", "mean [ms]", "all [s]", "share", "what");
  for (const Stage& stage : kStages) {
    const double own = sum.*stage.seconds;
    text += fmt::format("  {:<11} {:>10.4f} {:>10.3f} {:>7.1f}%  {}\n", stage.name, 1e3 * own / steps, own,
                        100.0 * own / sum.step, stage.what);
  }
  text += "A step is its stages and what lies between them. Writing results is not part of it.\n";
  if (summary.threads > 1) text += "Stages of several threads run beside each other; their times are added.\n";
  return text;
}

}  // namespace sinew::runs
