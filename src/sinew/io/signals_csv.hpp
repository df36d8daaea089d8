// signals.csv: one row per accepted step, made for spreadsheets and scripts.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "sinew/io/append_file.hpp"
#include "sinew/io/recording.hpp"

namespace sinew::io {

/// Writes the table while a run goes on. Columns `time` [s], `status`, `newton`, then the signals in SI; 17 significant
/// digits (each double is read back exactly), '.' as decimal mark in every locale, lines end in "\n". To go on after a
/// resume, write the rows of the recording again: the file is a view of it.
class SignalsCsvWriter {
 public:
  /// Starts the file with its header row; a file of that name is replaced. WriteError if that fails.
  SignalsCsvWriter(const std::filesystem::path& path, const std::vector<std::string>& signal_names);

  /// Adds a row, which has reached the operating system when this returns. As many signals as names.
  void append(const RecordedStep& step);

 private:
  AppendFile file_;
  std::size_t signals_;
};

/// The whole table of a recording.
void write_signals_csv(const std::filesystem::path& path, const Recording& recording);

}  // namespace sinew::io
