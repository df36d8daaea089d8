// A scene file read and built, with the names and hashes of everything it came from.
#pragma once

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "sinew/io/scene_file.hpp"
#include "sinew/sim/model.hpp"

namespace sinew::app {

struct LoadedScene {
  io::SceneFile file;
  Model model;
  std::vector<std::pair<std::string, std::string>> inputs;  ///< file and content hash, the scene first
  std::string inputs_hash;                                  ///< of all of them together
};

/// Builds what was read. Faults that the engine finds get the file and line of the field they are about.
LoadedScene load(io::SceneFile file);

}  // namespace sinew::app
