#include "sinew/runs/report.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <fstream>

#include "sinew/io/atomic_file.hpp"
#include "sinew/sim/places.hpp"
#include "sinew/sim/run.hpp"
#include "sinew/sim/signals.hpp"
#include "sinew/threads/interruption.hpp"

namespace sinew::runs {

using Json = nlohmann::ordered_json;

namespace {

constexpr std::size_t kMostListed = 1000;  ///< elements in a report

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
std::vector<double> limit_points(const std::vector<StepRow>& rows, double duration) {
  std::vector<double> factors;
  for (std::size_t i = 1; i + 1 < rows.size(); ++i) {
    const double before = rows[i - 1].time, at = rows[i].time, after = rows[i + 1].time;
    if ((at - before) * (after - at) < 0.0) factors.push_back(at / duration);
  }
  return factors;
}

/// Views made again from a recording: how the run stopped and what its steps cost stand only in the report of the run
/// itself.
void keep_what_no_recording_holds(const Json& earlier, Json& report) {
  if (!earlier.is_object() || earlier.value("inputs_hash", "") != report["inputs_hash"] || !earlier.contains("end"))
    return;
  if (earlier["end"].value("time_s", -1.0) != report["end"]["time_s"]) return;  // the recording went on since
  for (const char* key : {"end", "time_per_step", "warnings"}) {
    if (earlier.contains(key)) report[key] = earlier[key];
  }
}

Json end_json(const RecordedRun& run) {
  Json end = {{"how", run.summary.end}, {"time_s", run.digest.last.time}};
  if (run.summary.end != "numerical_stop") return end;
  const StepReport& failure = run.summary.failure;
  end["status"] = to_string(failure.status);
  end["where"] = failure.detail;
  end["newton"] = failure.newton;
  if (std::isfinite(failure.residual)) end["residual"] = failure.residual;
  if (std::isfinite(failure.violation)) end["violation_m"] = failure.violation;
  end["meaning"] = explain(failure.status);
  return end;
}

/// Of each solid in a state the least det F of all quadrature points, its cell, and the cells that are flat or inside
/// out.
Json volumes_json(const Model& model, const State& state) {
  Json all = Json::object();
  for (std::size_t i = 0; i < model.solids.size(); ++i) {
    const solid::Body& body = model.solids[i].body;
    double least = INFINITY;
    int where = 0;
    Json inverted = Json::array();
    for (int cell = 0; cell < body.elements(); ++cell) {
      const double ratio = solid::cell_means(body, cell, state.solids[i].x).least_volume_ratio;
      if (!(ratio > 0.0) && inverted.size() < kMostListed) inverted.push_back(cell);
      if (ratio < least) {
        least = ratio;
        where = cell;
      }
    }
    all[model.solids[i].name] = {{"least_volume_ratio", least}, {"in_cell", where}, {"inverted_elements", inverted}};
  }
  return all;
}

Json summary_json(const RecordedRun& run) {
  const Model& model = run.loaded.model;
  const Digest& all = run.digest;
  std::map<std::string, int> counts;
  double residual = 0.0, violation = 0.0;
  std::uint32_t newton = 0;
  for (const StepRow& row : all.rows) {
    ++counts[all.statuses[row.status]];
    residual = std::max(residual, row.residual);
    violation = std::max(violation, row.violation);
    newton = std::max(newton, row.newton);
  }
  const State end = all.rows.empty() ? initial_state(model) : unpack(model, all.last.state);
  Json summary = {{"steps", counts},
                  {"largest_newton", newton},
                  {"largest_residual", residual},
                  {"largest_violation_m", violation},
                  {"gap_at_dropped_points_m", dropped_gap(model, end)}};
  const Analysis analysis = model.scene.analysis;
  if (analysis == Analysis::statics) summary["limit_points"] = limit_points(all.rows, model.scene.time.duration);
  summary["steps_with_rotated_tangent"] = all.rotated;
  summary["most_inverted_elements"] = all.most_inverted;
  if (!model.solids.empty() && analysis != Analysis::modal) summary["solids_at_end"] = volumes_json(model, end);
  summary["steps_with_repeated_rows"] = all.redundant;
  summary["parts_of_halved_steps"] = all.halved;
  summary["steps_balanced_to_rounding"] = all.floors;
  if (analysis == Analysis::quasi_static || analysis == Analysis::statics)
    summary["equilibria"] = {{"stable", all.stable}, {"unstable", all.unstable}, {"not_known", all.not_known}};
  if (!model.pairs.empty() || !model.rubbing.empty()) summary["contact"] = contact_json(all.contact);
  if (!model.effectors.empty()) summary["targets"] = {{"steps", all.targets}, {"end", all.last.targets}};
  return summary;
}

}  // namespace

std::optional<Json> earlier_report(const std::filesystem::path& folder) {
  std::ifstream stream(folder / "report.json");
  if (!stream) return std::nullopt;
  Json report = Json::parse(stream, nullptr, false);
  if (!report.is_object()) return std::nullopt;
  return report;
}

void write_report(const std::filesystem::path& path, const RecordedRun& run, const std::optional<Json>& earlier,
                  const Json& files) {
  const Model& model = run.loaded.model;
  const Digest& all = run.digest;
  Json report;
  report["program"] = "sinew " + run.header.program_version;
  report["scene"] = run.header.scene_name;
  report["inputs_hash"] = run.header.inputs_hash;
  for (const auto& [name, hash] : run.loaded.inputs) report["inputs"].push_back({{"file", name}, {"xxh3_128", hash}});
  report["sizes"] = sizes_json(model);
  for (const Column& column : signal_columns(model)) report["units"][column.name] = column.unit;
  report["warnings"] = warnings_json(all.warnings);
  report["end"] = end_json(run);
  report["summary"] = summary_json(run);
  if (!run.summary.times.empty()) {
    report["time_per_step"]["threads"] = run.summary.threads;
    report["time_per_step"]["steps"] = run.summary.times.size();
    for (const Stage& stage : kStages)
      report["time_per_step"][stage.name] = stage_json(run.summary.times, stage.seconds);
  }
  if (earlier && (run.summary.end == "unfinished" || run.summary.times.empty()))
    keep_what_no_recording_holds(*earlier, report);
  report["files"] = files;
  // The steps are written one by one: of long runs they are most of the file.
  io::AtomicFile file(path);
  const std::string text = report.dump(1);
  file.append(text.substr(0, text.rfind('\n')));
  file.append(",\n \"steps\": [");
  for (std::size_t i = 0; i < all.rows.size(); ++i) {
    if (i % 1024 == 0) threads::Interruption::check();
    const StepRow& row = all.rows[i];
    const Json step = {{"time_s", row.time},
                       {"status", all.statuses[row.status]},
                       {"newton", row.newton},
                       {"residual", row.residual},
                       {"violation_m", row.violation}};
    file.append(fmt::format("{}\n  {}", i == 0 ? "" : ",", step.dump()));
  }
  file.append("\n ]\n}\n");
  file.commit();
}

}  // namespace sinew::runs
