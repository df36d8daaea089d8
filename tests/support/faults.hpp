// Scenes that were found to end wrong, or not at all (tests/validation/faults).
#pragma once

#include <numeric>

#include "support/recorded_run.hpp"

namespace sinew::test {

inline RecordedRun fault(const std::string& name, const std::vector<std::string>& changes = {}) {
  return run_file(std::filesystem::path(SINEW_SOURCE_DIR) / "tests/validation/faults" / (name + ".yaml"), changes);
}

inline int iterations_of(const RecordedRun& run) {
  return std::accumulate(run.steps.begin(), run.steps.end(), 0,
                         [](int sum, const io::RecordedStep& step) { return sum + step.newton; });
}

}  // namespace sinew::test
