// The results folder: the recording, and the views that are made from it.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "sinew/io/recording.hpp"
#include "sinew/runs/loaded_scene.hpp"
#include "sinew/sim/step.hpp"

namespace sinew::runs {

/// How a run ended, for report.json and for people.
struct RunSummary {
  std::string end = "done";       ///< done, numerical_stop, interrupted, or unfinished (from a recording alone)
  StepReport failure;             ///< if it stopped
  std::vector<Warning> warnings;  ///< of the scene and of how the run ended; those of steps are recorded
  std::vector<StageTimes> times;  ///< of each step made by this program; none for recorded ones
  int rotated = 0;                ///< of those, steps in which the rotated tangent stood in for the exact one
  int most_inverted = 0;          ///< of those, most elements flat or inside out in one
  int threads = 1;
  int halved = 0;     ///< of those, parts of steps that were too long
  int redundant = 0;  ///< of those, steps whose rows repeated each other
  int floors = 0;     ///< of those, steps whose forces were balanced to their rounding, not to the tolerance
  int stable = 0, unstable = 0, not_known = 0;  ///< of analyses at rest: equilibria told as these
  ContactReport contact;                        ///< of those, as `add` puts them together
};

/// Sums of what was done, the largest of all else.
void add(const ContactReport& step, ContactReport& all);

std::filesystem::path recording_path(const std::filesystem::path& folder);

io::RecordedStep recorded(const Model& model, const State& state, const StepReport& report);

/// What a user should know of a run: of its scene, of all its steps, and of how it ended.
std::vector<Warning> all_warnings(const Model& model, const RunSummary& summary,
                                  const std::vector<io::RecordedStep>& steps);

/// [s] between frames of the views: the scene's, or about 100 a run.
double view_interval(const Scene& scene);

/// Where the time of the steps went, for people.
std::string profile(const RunSummary& summary);

/// Writes signals.csv, the ParaView series, picture.png and report.json from a recording; returns the files' names.
std::vector<std::string> write_views(const std::filesystem::path& folder, const LoadedScene& loaded,
                                     const io::Recording& recording, const RunSummary& summary);

}  // namespace sinew::runs
