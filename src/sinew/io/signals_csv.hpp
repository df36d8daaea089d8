// signals.csv: one row per accepted step, made for spreadsheets and scripts.
#pragma once

#include <filesystem>

#include "sinew/io/recording.hpp"

namespace sinew::io {

/// Columns `time` [s], `status`, `newton`, of a run with targets `targets`, then the signals in SI; 17 significant
/// digits (each double is read back exactly), '.' as decimal mark in every locale, lines end in "\n". A file of that
/// name is replaced. Throws WriteError.
void write_signals_csv(const std::filesystem::path& path, const Recording& recording);

}  // namespace sinew::io
