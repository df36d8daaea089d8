// Reads scene files (YAML). The keys stand in scene_fields.cpp and scene_objects.hpp.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "sinew/io/document.hpp"
#include "sinew/sim/scene.hpp"

namespace sinew::io {

struct SceneFile {
  Scene scene;
  std::string text;                  ///< YAML of this very scene: the file's bytes, rewritten if there were overrides
  std::map<std::string, int> lines;  ///< field path ("solids.finger.mesh", "couplings.0") to line; 0 if overridden
  std::filesystem::path path;        ///< as it was given, for messages
  std::vector<std::filesystem::path> tables;  ///< files with numbers over time that have been read for it
};

/// Each override is "path=value", as "solids.finger.material.young=500 kPa" or "couplings.0.slide.points=31"; the value
/// is YAML. Meshes are looked up from the folder of the file. Throws InputError at the first fault.
SceneFile read_scene(const std::filesystem::path& file, const std::vector<std::string>& overrides = {});

/// The same for text: `name` stands in messages, meshes are looked up from `folder`.
SceneFile parse_scene(const std::string& text, const std::filesystem::path& name, const std::filesystem::path& folder,
                      const std::vector<std::string>& overrides = {});

/// The same for a tree without lines, put together by a program: messages name the field alone.
SceneFile scene_of(const Node& tree, const std::filesystem::path& folder,
                   const std::vector<std::string>& overrides = {});

/// Line of the field, or of the nearest object around it that the file has; 0 if there is none or it was overridden.
int line_of(const SceneFile& file, const std::string& field_path);

/// JSON Schema (draft 2020-12) of a scene file, pretty printed.
std::string scene_schema();

}  // namespace sinew::io
