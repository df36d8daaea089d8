// A scene file read and built, with the names and hashes of everything it came from.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "sinew/io/recording.hpp"
#include "sinew/io/scene_file.hpp"
#include "sinew/sim/model.hpp"

namespace sinew::runs {

/// Files that a scene names and that are not on the disk: content by name, as the scene has it.
using HeldFiles = std::map<std::string, std::string>;

struct LoadedScene {
  io::SceneFile file;
  Model model;
  std::vector<std::pair<std::string, std::string>> inputs;  ///< file and content hash, the scene first
  std::string inputs_hash;                                  ///< of all of them together
  HeldFiles held;                                           ///< meshes that were handed over
};

/// Builds what was read. Faults that the engine finds get the file and line of the field they are about.
LoadedScene load(io::SceneFile file, HeldFiles held = {});

/// Where a results folder keeps the meshes that were handed over.
std::filesystem::path held_folder(const std::filesystem::path& results);

/// The scene of a recording, as it was when it was recorded. Throws InputError where its files are others by now, or
/// its states are of another version.
LoadedScene load_recorded(const io::Recording& recording, const std::filesystem::path& path);

}  // namespace sinew::runs
