// Tables of numbers in CSV files.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace sinew::io {

/// One vector for each of the columns asked for, by the names in the first row; RFC 4180, '.' as decimal mark, empty
/// lines left out. Other columns may hold anything. Throws InputError with file and line.
std::vector<std::vector<double>> read_csv(const std::filesystem::path& path, const std::vector<std::string>& columns);

/// The names in the first row.
std::vector<std::string> csv_columns(const std::filesystem::path& path);

}  // namespace sinew::io
