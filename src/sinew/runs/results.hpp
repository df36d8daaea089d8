// The results folder: the recording, and the views that are made from it.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "sinew/io/recording.hpp"
#include "sinew/runs/digest.hpp"
#include "sinew/runs/loaded_scene.hpp"
#include "sinew/sim/step.hpp"

namespace sinew::runs {

/// How a run ended, for report.json and for people.
struct RunSummary {
  std::string end = "done";       ///< done, numerical_stop, interrupted, or unfinished (from a recording alone)
  StepReport failure;             ///< if it stopped
  std::vector<Warning> warnings;  ///< of the scene and of how the run ended; those of steps are recorded
  std::vector<StageTimes> times;  ///< of each step made by this program; none for recorded ones
  int threads = 1;
};

std::filesystem::path recording_path(const std::filesystem::path& folder);

io::RecordedStep recorded(const Model& model, const State& state, const StepReport& report);

/// What a user should know of a run: of its scene, of all its steps, and of how it ended.
std::vector<Warning> all_warnings(const Model& model, const RunSummary& summary,
                                  const std::vector<io::RecordedStep>& steps);

/// [s] between frames of the views: the scene's, or about 100 a run.
double view_interval(const Scene& scene);

/// Where the time of the steps went, for people.
std::string profile(const RunSummary& summary);

/// A run whose views are written.
struct RecordedRun {
  const LoadedScene& loaded;
  const io::RecordingHeader& header;
  const StepSource& steps;
  const RunSummary& summary;
  const Digest& digest;  ///< of these steps
};

enum class Views {
  all,
  tables  ///< neither picture nor ParaView files, which take longest
};

/// Writes the views of a run: signals.csv, the ParaView series, picture.png, and report.json as the last, which has the
/// sizes of all others. Each is written aside and renamed. Returns the files' names, for people. Throws io::WriteError,
/// and threads::Interrupted where the calling thread is interrupted; what was written until then is whole.
std::vector<std::string> write_views(const std::filesystem::path& folder, const RecordedRun& run,
                                     Views views = Views::all);

/// Removes the views that a folder has, which are those of an earlier run, or of a part of this one.
void remove_views(const std::filesystem::path& folder);

/// Whether the views of a folder are all there and were not changed in size since report.json was written.
bool views_complete(const std::filesystem::path& folder);

}  // namespace sinew::runs
