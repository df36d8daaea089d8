// signals.csv: one row per accepted step, made for spreadsheets and scripts.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "sinew/io/atomic_file.hpp"
#include "sinew/io/recording.hpp"

namespace sinew::io {

/// Writes a table row by row. Columns `time` [s], `status`, `newton`, of a run with targets `targets`, then the signals
/// in SI; 17 significant digits (each double is read back exactly), '.' as decimal mark in every locale, lines end in
/// "\n". A file of that name is replaced once all is written. Throws WriteError.
class SignalsTable {
 public:
  SignalsTable(const std::filesystem::path& path, const RecordingHeader& header, bool targets);
  void add(const RecordedStep& step);
  void finish() { file_.commit(); }

 private:
  AtomicFile file_;
  bool targets_;
};

/// The time and some of the signals, by their names, in the same way.
class ColumnsTable {
 public:
  ColumnsTable(const std::filesystem::path& path, const RecordingHeader& header, const std::vector<std::string>& names);
  void add(const RecordedStep& step);
  void finish() { file_.commit(); }

 private:
  AtomicFile file_;
  std::vector<std::size_t> columns_;
};

}  // namespace sinew::io
