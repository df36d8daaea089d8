// A scene file read and built, with the names and hashes of everything it came from.
#pragma once

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "sinew/io/recording.hpp"
#include "sinew/io/scene_file.hpp"
#include "sinew/sim/model.hpp"

namespace sinew::runs {

struct LoadedScene {
  io::SceneFile file;
  Model model;
  std::vector<std::pair<std::string, std::string>> inputs;  ///< file and content hash, the scene first
  std::string inputs_hash;                                  ///< of all of them together
};

/// Builds what was read. Faults that the engine finds get the file and line of the field they are about.
LoadedScene load(io::SceneFile file);

/// The scene of a recording, as it was when it was recorded. Throws InputError where its files are others by now, or
/// its states are of another version.
LoadedScene load_recorded(const io::Recording& recording, const std::filesystem::path& path);

}  // namespace sinew::runs
