#include "sinew/io/signals_csv.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <string>
#include <vector>

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

SignalsTable::SignalsTable(const std::filesystem::path& path, const RecordingHeader& header, bool targets)
    : file_(path), targets_(targets) {
  file_.append(header_row(header.signal_names, targets));
}

void SignalsTable::add(const RecordedStep& step) { file_.append(row_of(step, targets_)); }

ColumnsTable::ColumnsTable(const std::filesystem::path& path, const RecordingHeader& header,
                           const std::vector<std::string>& names)
    : file_(path) {
  const std::vector<std::string>& all = header.signal_names;
  std::string row = "time";
  for (const std::string& name : names) {
    columns_.push_back(static_cast<std::size_t>(std::find(all.begin(), all.end(), name) - all.begin()));
    row += "," + cell(name);
  }
  file_.append(row + "\n");
}

void ColumnsTable::add(const RecordedStep& step) {
  std::string row = fmt::format("{:.17g}", step.time);
  for (const std::size_t column : columns_)
    fmt::format_to(std::back_inserter(row), ",{:.17g}", step.signals.at(column));
  file_.append(row + "\n");
}

}  // namespace sinew::io
