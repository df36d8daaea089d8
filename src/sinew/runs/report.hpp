// report.json: what was run, how it ended, and what every step came to.
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>

#include "sinew/runs/results.hpp"

namespace sinew::runs {

/// The report that a results folder has, if it can be read.
std::optional<nlohmann::ordered_json> earlier_report(const std::filesystem::path& folder);

/// `earlier` is the report that the folder had: what no recording holds is kept of it. `files` are the names and bytes
/// of the other views. Throws io::WriteError, and threads::Interrupted.
void write_report(const std::filesystem::path& path, const RecordedRun& run,
                  const std::optional<nlohmann::ordered_json>& earlier, const nlohmann::ordered_json& files);

}  // namespace sinew::runs
