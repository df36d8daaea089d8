// Runs of scene files in memory, as `sinew run` makes them: signals by name, warnings, how it ended.
#pragma once

#include <algorithm>
#include <stdexcept>
#include <string>
#include <vector>

#include "sinew/runs/record.hpp"
#include "sinew/sim/signals.hpp"

namespace sinew::test {

struct RecordedRun {
  runs::LoadedScene loaded;
  std::vector<io::RecordedStep> steps;
  runs::Recorded recorded;
  std::vector<Warning> warnings;

  bool done() const { return recorded.end == RunEnd::done; }
  const StepReport& failure() const { return recorded.summary.failure; }
  std::string why() const { return std::string(to_string(failure().status)) + ": " + failure().detail; }

  std::vector<double> signal(const std::string& name) const {
    const std::vector<std::string> names = signal_names(loaded.model);
    const auto found = std::find(names.begin(), names.end(), name);
    if (found == names.end()) throw std::invalid_argument("no signal " + name);
    std::vector<double> values;
    for (const io::RecordedStep& step : steps)
      values.push_back(step.signals[static_cast<std::size_t>(found - names.begin())]);
    return values;
  }
  /// Accepted steps that are parts of one that was too long.
  long halved() const {
    return std::count_if(steps.begin(), steps.end(), [](const auto& step) { return step.counts.halvings > 0; });
  }
  double last(const std::string& name) const { return signal(name).back(); }
  double largest(const std::string& name) const {
    const std::vector<double> values = signal(name);
    return *std::max_element(values.begin(), values.end());
  }
  /// Null where nothing of the kind was warned of.
  const Warning* warning(const std::string& code, const std::string& where = "") const {
    return find_warning(warnings, code, where);
  }
};

inline RecordedRun run_recorded(runs::LoadedScene loaded) {
  RecordedRun run{std::move(loaded), {}, {}, {}};
  const Model& model = run.loaded.model;
  const State start = initial_state(model);
  run.steps.push_back(runs::recorded(model, start, StepReport{}));
  run.recorded = runs::record(
      model, start, [&](io::RecordedStep step) { run.steps.push_back(std::move(step)); },
      [](const State&, const StepReport&) { return true; }, 1);
  run.warnings = runs::all_warnings(model, run.recorded.summary, run.steps);
  return run;
}

/// A scene file with some of its values changed: "time.step=1 ms".
inline RecordedRun run_file(const std::filesystem::path& scene, const std::vector<std::string>& changes = {}) {
  return run_recorded(runs::load(io::read_scene(scene, changes)));
}

}  // namespace sinew::test
