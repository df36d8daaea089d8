#include "sinew/io/csv_table.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <cmath>

#include "sinew/error/input_error.hpp"
#include "sinew/io/document.hpp"
#include "sinew/io/nearest.hpp"

namespace sinew::io {
namespace {

struct Row {
  int line = 0;
  std::vector<std::string> cells;
};

[[noreturn]] void refuse(const std::filesystem::path& path, int line, std::string value, std::string rule,
                         std::string remedy) {
  throw InputError({path.string(), line, "", std::move(value), std::move(rule), std::move(remedy)});
}

std::vector<Row> rows_of(const std::filesystem::path& path) {
  constexpr std::uintmax_t kMostBytes = 1'000'000'000;
  std::error_code failed;
  if (std::filesystem::exists(path, failed)) {
    if (!std::filesystem::is_regular_file(path, failed)) refuse(path, 0, "", "is no file", "give a CSV file");
    if (std::filesystem::file_size(path, failed) > kMostBytes)
      refuse(path, 0, "", "is larger than 1 GB", "keep only the columns and rows that are needed");
  }
  const std::string text = read_text(path);
  std::vector<Row> rows;
  int line = 1;
  std::size_t at = text.starts_with("\xEF\xBB\xBF") ? 3 : 0;
  while (at < text.size()) {
    Row row;
    row.line = line;
    for (bool more = true; more;) {
      std::string cell;
      if (at < text.size() && text[at] == '"') {
        const int opened = line;
        for (++at;; ++at) {
          if (at >= text.size()) refuse(path, opened, "", "a quoted cell does not end", "close it with \"");
          if (text[at] == '"' && (at + 1 >= text.size() || text[at + 1] != '"')) break;
          if (text[at] == '"') ++at;
          line += text[at] == '\n' ? 1 : 0;
          cell += text[at];
        }
        ++at;
      }
      while (at < text.size() && text[at] != ',' && text[at] != '\n') cell += text[at++];
      more = at < text.size() && text[at] == ',';
      ++at;
      const auto edge = [&cell](char c) { return c == ' ' || c == '\t' || c == '\r'; };
      while (!cell.empty() && edge(cell.back())) cell.pop_back();
      cell.erase(0, static_cast<std::size_t>(std::find_if_not(cell.begin(), cell.end(), edge) - cell.begin()));
      row.cells.push_back(std::move(cell));
    }
    ++line;
    if (row.cells.size() > 1 || !row.cells[0].empty()) rows.push_back(std::move(row));
  }
  if (rows.empty()) refuse(path, 0, "", "is empty", "its first row names the columns, as in time,pull.force");
  return rows;
}

}  // namespace

std::vector<std::string> csv_columns(const std::filesystem::path& path) { return rows_of(path).front().cells; }

std::vector<std::vector<double>> read_csv(const std::filesystem::path& path, const std::vector<std::string>& columns) {
  const std::vector<Row> rows = rows_of(path);
  const std::vector<std::string>& names = rows[0].cells;
  std::vector<std::vector<double>> values;
  for (const std::string& column : columns) {
    const auto found = std::find(names.begin(), names.end(), column);
    if (found == names.end()) {
      const std::string near = nearest(column, names);
      refuse(path, rows[0].line, column, "is not the name of a column",
             (near.empty() ? "" : "did you mean `" + near + "`? ") + fmt::format("it has {}", fmt::join(names, ", ")));
    }
    const auto k = static_cast<std::size_t>(found - names.begin());
    std::vector<double>& own = values.emplace_back();
    for (std::size_t i = 1; i < rows.size(); ++i) {
      if (k >= rows[i].cells.size())
        refuse(path, rows[i].line, "", fmt::format("has {} cells, and no `{}`", rows[i].cells.size(), column),
               fmt::format("give {} in every row", names.size()));
      const std::string& cell = rows[i].cells[k];
      double value = 0.0;
      const char* const end = cell.data() + cell.size();
      const auto [stop, error] = std::from_chars(cell.data(), end, value);
      if (cell.empty() || error != std::errc() || stop != end || !std::isfinite(value))
        refuse(path, rows[i].line, cell, fmt::format("is not a number, in column `{}`", column),
               "numbers as 0.02 or 2e-2, in SI units");
      own.push_back(value);
    }
  }
  return values;
}

}  // namespace sinew::io
