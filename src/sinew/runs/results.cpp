#include "sinew/runs/results.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>

#include "sinew/io/picture.hpp"
#include "sinew/io/signals_csv.hpp"
#include "sinew/io/vtu.hpp"
#include "sinew/sim/inverse.hpp"
#include "sinew/sim/motors.hpp"
#include "sinew/sim/places.hpp"
#include "sinew/sim/run.hpp"
#include "sinew/sim/signals.hpp"
#include "sinew/sim/view.hpp"

namespace sinew::runs {

using Json = nlohmann::ordered_json;

std::filesystem::path recording_path(const std::filesystem::path& folder) { return folder / "run.sinew"; }

io::RecordedStep recorded(const Model& model, const State& state, const StepReport& report) {
  return {state.time,
          std::string(to_string(report.status)),
          describe(model, report.aim),
          static_cast<std::uint32_t>(report.newton),
          report.residual,
          report.violation,
          signal_values(model, state),
          pack(state),
          report.warnings};
}

void add(const ContactReport& step, ContactReport& all) {
  all.contacts = std::max(all.contacts, step.contacts);
  all.penetration = std::max(all.penetration, step.penetration);
  all.sweeps += step.sweeps;
  all.newton += step.newton;
  all.unsolved += step.unsolved;
  all.left.complementarity = std::max(all.left.complementarity, step.left.complementarity);
  all.left.cone = std::max(all.left.cone, step.left.cone);
  all.left.dissipation = std::max(all.left.dissipation, step.left.dissipation);
}

namespace {

Json contact_json(const ContactReport& contact) {
  return {{"most_contacts", contact.contacts},
          {"deepest_penetration_m", contact.penetration},
          {"sweeps", contact.sweeps},
          {"newton", contact.newton},
          {"unsolved_problems", contact.unsolved},
          {"largest_residual",
           {{"complementarity", contact.left.complementarity},
            {"cone", contact.left.cone},
            {"dissipation", contact.left.dissipation}}}};
}

Json warnings_json(const std::vector<Warning>& warnings) {
  Json all = Json::array();
  for (const Warning& own : warnings) {
    Json& one = all.emplace_back(
        Json{{"code", own.code}, {"where", own.where}, {"message", own.message}, {"remedy", own.remedy}});
    if (std::isfinite(own.time)) one["first_time_s"] = own.time;
    if (own.steps > 0) one["steps"] = own.steps;
    if (std::isfinite(own.value)) one["worst"] = own.value;
    if (std::isfinite(own.limit)) one["limit"] = own.limit;
    if (!own.unit.empty()) one["unit"] = own.unit;
  }
  return all;
}

/// Median and maximum of one stage over all steps [ms].
Json stage_json(const std::vector<StageTimes>& times, double StageTimes::*stage) {
  std::vector<double> values;
  for (const StageTimes& time : times) values.push_back(1e3 * time.*stage);
  std::sort(values.begin(), values.end());
  return {{"median_ms", values[values.size() / 2]}, {"max_ms", values.back()}};
}

/// How many steps ended how, and the last one.
Json targets_json(const io::Recording& recording) {
  std::map<std::string, int> counts;
  for (const io::RecordedStep& step : recording.steps) {
    if (!step.targets.empty()) ++counts[step.targets];
  }
  return {{"steps", counts}, {"end", recording.steps.empty() ? "" : recording.steps.back().targets}};
}

Json sizes_json(const Model& model) {
  Json solids = Json::object(), rods = Json::object();
  for (const SolidModel& solid : model.solids) {
    solids[solid.name] = {
        {"nodes", solid.body.nodes()}, {"cells", solid.body.elements()}, {"unknowns", solid.body.unknowns}};
  }
  int unknowns = model.unknowns;
  for (const RodModel& rod : model.rods) {
    rods[rod.name] = {
        {"length_m", rod.rod.length()}, {"sections", rod.rod.count()}, {"coordinates", rod.rod.coordinates()}};
    unknowns += rod.rod.strain_coordinates();
  }
  for (const GeometricCableModel& cable : model.cables)
    rods[cable.name] = {{"length_m", cable.cable.length}, {"sections", 0}, {"coordinates", cable.cable.coordinates()}};
  return {{"solids", solids},
          {"rods", rods},
          {"sliding_points", model.points.size()},
          {"rows", model.rows},
          {"reduced_unknowns", unknowns}};
}

/// Load factors at which a static path turned back.
std::vector<double> limit_points(const io::Recording& recording, double duration) {
  std::vector<double> factors;
  for (std::size_t i = 1; i + 1 < recording.steps.size(); ++i) {
    const double before = recording.steps[i - 1].time, at = recording.steps[i].time,
                 after = recording.steps[i + 1].time;
    if ((at - before) * (after - at) < 0.0) factors.push_back(at / duration);
  }
  return factors;
}

/// Views made again from a recording: how the run stopped and what its steps cost stand only in the report of the run
/// itself.
void keep_what_no_recording_holds(const std::filesystem::path& path, Json& report) {
  std::ifstream stream(path);
  const Json earlier = Json::parse(stream, nullptr, false);
  if (!earlier.is_object() || earlier.value("inputs_hash", "") != report["inputs_hash"] || !earlier.contains("end"))
    return;
  if (earlier["end"].value("time_s", -1.0) != report["end"]["time_s"]) return;  // the recording went on since
  for (const char* key : {"end", "time_per_step", "warnings", "summary"}) {
    if (earlier.contains(key)) report[key] = earlier[key];
  }
}

void write_report(const std::filesystem::path& path, const LoadedScene& loaded, const io::Recording& recording,
                  const RunSummary& summary) {
  Json report;
  report["program"] = "sinew " + recording.header.program_version;
  report["scene"] = recording.header.scene_name;
  report["inputs_hash"] = recording.header.inputs_hash;
  for (const auto& [name, hash] : loaded.inputs) report["inputs"].push_back({{"file", name}, {"xxh3_128", hash}});
  report["sizes"] = sizes_json(loaded.model);
  for (const Column& column : signal_columns(loaded.model)) report["units"][column.name] = column.unit;
  report["warnings"] = warnings_json(all_warnings(loaded.model, summary, recording.steps));
  report["end"] = {{"how", summary.end}, {"time_s", recording.steps.empty() ? 0.0 : recording.steps.back().time}};
  if (summary.end == "numerical_stop") {
    report["end"]["status"] = to_string(summary.failure.status);
    report["end"]["where"] = summary.failure.detail;
    report["end"]["newton"] = summary.failure.newton;
    if (std::isfinite(summary.failure.residual)) report["end"]["residual"] = summary.failure.residual;
    if (std::isfinite(summary.failure.violation)) report["end"]["violation_m"] = summary.failure.violation;
    report["end"]["meaning"] = explain(summary.failure.status);
  }
  std::map<std::string, int> counts;
  double residual = 0.0, violation = 0.0;
  std::uint32_t newton = 0;
  for (const io::RecordedStep& step : recording.steps) {
    ++counts[step.status];
    residual = std::max(residual, step.residual);
    violation = std::max(violation, step.violation);
    newton = std::max(newton, step.newton);
  }
  const double gap =
      recording.steps.empty() ? 0.0 : dropped_gap(loaded.model, unpack(loaded.model, recording.steps.back().state));
  report["summary"] = {{"steps", counts},
                       {"largest_newton", newton},
                       {"largest_residual", residual},
                       {"largest_violation_m", violation},
                       {"gap_at_dropped_points_m", gap}};
  if (loaded.model.scene.analysis == Analysis::statics)
    report["summary"]["limit_points"] = limit_points(recording, loaded.model.scene.time.duration);
  if (!summary.times.empty()) {
    report["summary"]["steps_with_rotated_tangent"] = summary.rotated;
    report["summary"]["most_inverted_elements"] = summary.most_inverted;
    report["summary"]["steps_with_repeated_rows"] = summary.redundant;
    report["summary"]["parts_of_halved_steps"] = summary.halved;
    report["summary"]["steps_balanced_to_rounding"] = summary.floors;
    const Analysis analysis = loaded.model.scene.analysis;
    if (analysis == Analysis::quasi_static || analysis == Analysis::statics)
      report["summary"]["equilibria"] = {
          {"stable", summary.stable}, {"unstable", summary.unstable}, {"not_known", summary.not_known}};
    if (!loaded.model.pairs.empty() || !loaded.model.rubbing.empty())
      report["summary"]["contact"] = contact_json(summary.contact);
    report["time_per_step"]["threads"] = summary.threads;
    for (const Stage& stage : kStages) report["time_per_step"][stage.name] = stage_json(summary.times, stage.seconds);
  }
  if (!loaded.model.effectors.empty()) report["summary"]["targets"] = targets_json(recording);
  if (summary.end == "unfinished" || summary.times.empty()) keep_what_no_recording_holds(path, report);
  report["steps"] = Json::array();
  for (const io::RecordedStep& step : recording.steps) {
    report["steps"].push_back({{"time_s", step.time},
                               {"status", step.status},
                               {"newton", step.newton},
                               {"residual", step.residual},
                               {"violation_m", step.violation}});
  }
  std::ofstream(path) << report.dump(1) << "\n";
}

/// `rows` columns of the signals from the one of this name on, one column a step; nothing if there is none.
Eigen::MatrixXd signals_from(const io::Recording& recording, const std::string& name, Eigen::Index rows) {
  const std::vector<std::string>& names = recording.header.signal_names;
  const auto found = std::find(names.begin(), names.end(), name);
  if (found == names.end()) return {};
  const auto first = static_cast<std::size_t>(found - names.begin());
  Eigen::MatrixXd values(rows, std::ssize(recording.steps));
  for (std::size_t i = 0; i < recording.steps.size(); ++i)
    values.col(static_cast<Eigen::Index>(i)) =
        Eigen::Map<const Eigen::VectorXd>(&recording.steps[i].signals[first], rows);
  return values;
}

/// Of outputs of position. Where a target does not care, it is where its output is.
std::vector<io::Course> courses(const Model& model, const io::Recording& recording) {
  std::vector<io::Course> found;
  if (model.scene.analysis == Analysis::modal) return found;  // (modes do not follow each other)
  for (int i = 0; i < static_cast<int>(model.outputs.size()); ++i) {
    const OutputModel& output = model.outputs[i];
    if (output.quantity != Quantity::position) continue;
    io::Course course{output.name, signals_from(recording, output.name + ".x", 3), Eigen::Matrix3Xd(3, 0), 0.0};
    const auto aims = [i](const EffectorModel& own) { return own.output == i; };
    const auto effector = std::find_if(model.effectors.begin(), model.effectors.end(), aims);
    const Eigen::MatrixXd wanted = signals_from(recording, output.name + ".target.x", 3);
    if (effector != model.effectors.end() && wanted.cols() > 0) {
      course.wanted = wanted;
      for (int axis = 0; axis < 3; ++axis)
        if (effector->weights[axis] == 0.0) course.wanted.row(axis) = course.way.row(axis);
      course.off = signals_from(recording, output.name + ".error", 1).rightCols<1>()(0);
    }
    found.push_back(std::move(course));
  }
  return found;
}

}  // namespace

std::vector<std::string> write_views(const std::filesystem::path& folder, const LoadedScene& loaded,
                                     const io::Recording& recording, const RunSummary& summary) {
  const Model& model = loaded.model;
  io::write_signals_csv(folder / "signals.csv", recording);
  write_report(folder / "report.json", loaded, recording, summary);
  std::vector<std::string> commands;
  for (const int sought : model.sought) commands.push_back(command_name(model.actuators[sought]));
  if (!commands.empty()) io::write_columns_csv(folder / "commands.csv", recording, commands);

  // About 100 frames a run, or one per `view.interval`; the last state always.
  const std::size_t count = recording.steps.size();
  const bool dynamic = model.scene.analysis == Analysis::dynamic || model.scene.analysis == Analysis::quasi_static;
  const double duration = run_duration(model.scene), interval = view_interval(model.scene);
  if (std::filesystem::exists(folder / "paraview" / "run.pvd"))
    std::filesystem::remove_all(folder / "paraview");  // of an earlier run
  io::SeriesWriter series(folder / "paraview");
  double next = 0.0;
  for (std::size_t i = 0; i < count; ++i) {
    const double time = recording.steps[i].time;
    if (dynamic && time < next - 1e-9 * duration && i + 1 != count) continue;
    while (next <= time + 1e-9 * duration) next += interval;
    Snapshot frame = snapshot(model, unpack(model, recording.steps[i].state), recording.steps[i].status);
    if (!dynamic) frame.time = static_cast<double>(i);  // a static path may turn back in time
    series.add(frame);
  }
  series.finish();

  if (count > 0) {
    io::PictureOptions options;
    options.title = model.scene.title.empty() ? std::filesystem::path(recording.header.scene_name).stem().string()
                                              : model.scene.title;
    options.up = -model.scene.gravity;
    options.courses = courses(model, recording);
    options.outcome = recording.steps.back().targets;
    options.warnings = static_cast<int>(all_warnings(model, summary, recording.steps).size());
    const io::RecordedStep &first = recording.steps.front(), &last = recording.steps.back();
    const std::string status = summary.end == "done" ? last.status
                               : summary.end == "numerical_stop"
                                   ? "stopped: " + std::string(to_string(summary.failure.status))
                                   : summary.end;
    io::draw_picture(folder / "picture.png", snapshot(model, unpack(model, first.state), first.status),
                     snapshot(model, unpack(model, last.state), status), options);
  }
  std::vector<std::string> files = {
      "picture.png        the end state", "signals.csv        outputs and motors over time",
      "paraview/run.pvd   the motion, for ParaView", "report.json        sizes, status of every step, times",
      "run.sinew          the recording, for --resume and export"};
  if (!commands.empty())
    files.insert(files.begin() + 2, "commands.csv       what the motors are to do, for sinew run --commands");
  return files;
}

double view_interval(const Scene& scene) {
  return scene.view.interval > 0.0 ? scene.view.interval : std::max(scene.time.step, run_duration(scene) / 100.0);
}

namespace {

/// Energy that comes from nowhere: kinetic, elastic and weight less the most that work may have been rises above what
/// it was (sim/work.hpp). It does not in short steps; in long ones rods that snap or buckle gain energy, bodies that
/// turn while they touch, and all that is linearised.
void add_energy_gain(const Model& model, const std::vector<io::RecordedStep>& steps, std::vector<Warning>& warnings) {
  constexpr double kGain = 1e-3;  // of the largest kinetic and elastic energy so far
  // What overlaps at the start is lifted apart, slowly, and warned of already.
  const double kSmall = find_warning(warnings, "overlap_at_start") ? 1e-6 : 1e-14;
  if (model.scene.analysis != Analysis::dynamic) return;
  const std::vector<std::string> names = signal_names(model);
  const auto column = [&names](const char* name) {
    return static_cast<std::size_t>(std::find(names.begin(), names.end(), name) - names.begin());
  };
  const std::size_t kinetic = column("energy.kinetic"), elastic = column("energy.elastic"),
                    weight = column("energy.weight"), work = column("energy.work_bound");
  double largest = 0.0, least = model.start_energy;
  for (const io::RecordedStep& step : steps) {
    if (work >= step.signals.size()) return;
    const double stored = step.signals[kinetic] + step.signals[elastic],
                 own = stored + step.signals[weight] - step.signals[work];
    largest = std::max(largest, stored);
    least = std::min(least, own);
    const double gain = own - least;
    if (!(gain > kGain * largest) || !(largest > kSmall * model.bearing * model.size)) continue;
    merge({.code = "energy_gain",
           .where = "energy",
           .message = fmt::format("{:.3g} J have come from nowhere, {:.3g} of the largest kinetic and elastic energy",
                                  gain, gain / largest),
           .remedy =
               model.scene.newton.iterations > 0 ? "take shorter steps, or leave `newton` out" : "take shorter steps",
           .time = step.time,
           .value = gain / largest,
           .limit = kGain,
           .steps = 1},
          warnings);
  }
}

}  // namespace

std::vector<Warning> all_warnings(const Model& model, const RunSummary& summary,
                                  const std::vector<io::RecordedStep>& steps) {
  std::vector<Warning> all = summary.warnings;
  for (const io::RecordedStep& step : steps) merge(step.warnings, all);
  add_energy_gain(model, steps, all);
  return all;
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
