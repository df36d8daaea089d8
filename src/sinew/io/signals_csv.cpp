#include "sinew/io/signals_csv.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <string>
#include <vector>

#include "sinew/io/append_file.hpp"

namespace sinew::io {
namespace {

/// In quotes if it holds a mark of the format (RFC 4180).
std::string cell(const std::string& text) {
  if (text.find_first_of(",\"\r\n") == std::string::npos) return text;
  std::string quoted = "\"";
  for (const char c : text) quoted += c == '"' ? "\"\"" : std::string(1, c);
  return quoted + "\"";
}

std::string header_row(const std::vector<std::string>& signal_names, bool targets) {
  std::string row = std::string("time,status,newton") + (targets ? ",targets" : "");
  for (const std::string& name : signal_names) row += "," + cell(name);
  return row + "\n";
}

std::string row_of(const RecordedStep& step, bool targets) {
  std::string row = fmt::format("{:.17g},{},{}", step.time, cell(step.status), step.newton);
  if (targets) row += "," + cell(step.targets);
  for (const double value : step.signals) fmt::format_to(std::back_inserter(row), ",{:.17g}", value);
  return row + "\n";
}

}  // namespace

void write_signals_csv(const std::filesystem::path& path, const Recording& recording) {
  const bool targets = std::any_of(recording.steps.begin(), recording.steps.end(),
                                   [](const RecordedStep& step) { return !step.targets.empty(); });
  std::string text = header_row(recording.header.signal_names, targets);
  for (const RecordedStep& step : recording.steps) text += row_of(step, targets);
  AppendFile(path, AppendFile::Start::empty).append(text);
}

void write_columns_csv(const std::filesystem::path& path, const Recording& recording,
                       const std::vector<std::string>& names) {
  const std::vector<std::string>& all = recording.header.signal_names;
  std::vector<std::size_t> columns;
  std::string text = "time";
  for (const std::string& name : names) {
    columns.push_back(static_cast<std::size_t>(std::find(all.begin(), all.end(), name) - all.begin()));
    text += "," + cell(name);
  }
  text += "\n";
  for (const RecordedStep& step : recording.steps) {
    fmt::format_to(std::back_inserter(text), "{:.17g}", step.time);
    for (const std::size_t column : columns)
      fmt::format_to(std::back_inserter(text), ",{:.17g}", step.signals.at(column));
    text += "\n";
  }
  AppendFile(path, AppendFile::Start::empty).append(text);
}

}  // namespace sinew::io
