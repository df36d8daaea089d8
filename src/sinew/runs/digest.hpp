// What the steps of a run add up to, in one pass over them and in little memory however many they are.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "sinew/io/picture.hpp"
#include "sinew/io/recording.hpp"
#include "sinew/sim/step.hpp"

namespace sinew::runs {

struct RunSummary;

/// Hands the steps of a run to a visitor, in their order; it can do so again.
using StepVisitor = std::function<void(const io::RecordedStep&)>;
using StepSource = std::function<void(const StepVisitor&)>;

/// Those of a recording, up to the last whole one. Reads them anew each time; can be interrupted
/// (`threads::Interruption`). Throws InputError as `io::RecordingReader`.
StepSource steps_of(const std::filesystem::path& recording);
/// Those in memory, which must outlive it.
StepSource steps_of(const std::vector<io::RecordedStep>& steps);

/// What a report keeps of each step.
struct StepRow {
  double time = 0.0, residual = 0.0, violation = 0.0;  ///< [s], [-], [m]
  std::uint32_t newton = 0, status = 0;                ///< the latter as its place in `Digest::statuses`
};

/// Where a target was missed by most.
struct WorstError {
  double error = 0.0;  ///< as its signal has it
  double time = 0.0;   ///< [s]
  std::string targets;
};

struct Digest {
  std::vector<StepRow> rows;
  std::vector<std::string> statuses;
  io::RecordedStep first, last;
  std::vector<Warning> warnings;       ///< of the scene, of all steps, of their energy and of how the run ended
  std::map<std::string, int> targets;  ///< how many steps ended with which of them
  std::vector<WorstError> worst;       ///< of each effector
  std::vector<io::Course> courses;     ///< of outputs of position
  ContactReport contact;               ///< sums of what was done, the largest of all else
  int rotated = 0;                     ///< steps in which the rotated tangent stood in for the exact one
  int redundant = 0;                   ///< steps whose rows repeated each other
  int halved = 0;                      ///< parts of steps that were too long
  int floors = 0;                      ///< steps whose forces were balanced to their rounding, not to the tolerance
  int most_inverted = 0;               ///< most elements flat or inside out in one step
  int stable = 0, unstable = 0, not_known = 0;  ///< of analyses at rest: equilibria told as these

  bool has_targets() const { return !targets.empty(); }
};

/// `signal_names`: those of the recording's header.
Digest digest(const Model& model, const RunSummary& summary, const std::vector<std::string>& signal_names,
              const StepSource& steps);

}  // namespace sinew::runs
