// signals.csv: one row per accepted step, made for spreadsheets and scripts.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "sinew/io/recording.hpp"

namespace sinew::io {

/// Columns `time` [s], `status`, `newton`, of a run with targets `targets`, then the signals in SI; 17 significant
/// digits (each double is read back exactly), '.' as decimal mark in every locale, lines end in "\n". A file of that
/// name is replaced. Throws WriteError.
void write_signals_csv(const std::filesystem::path& path, const Recording& recording);

/// The time and some of the signals, by their names, in the same way.
void write_columns_csv(const std::filesystem::path& path, const Recording& recording,
                       const std::vector<std::string>& names);

}  // namespace sinew::io
