#include "sinew/loaded_scene.hpp"

#include <fstream>
#include <sstream>

#include "sinew/error/input_error.hpp"
#include "sinew/io/content_hash.hpp"
#include "sinew/io/mesh_file.hpp"

namespace sinew::app {

LoadedScene load(io::SceneFile file) {
  LoadedScene loaded;
  loaded.inputs.emplace_back(file.path.filename().string(), io::content_hash(file.text));
  const auto note = [&loaded](const std::filesystem::path& path) {
    std::ifstream stream(path, std::ios::binary);
    std::ostringstream bytes;
    bytes << stream.rdbuf();
    loaded.inputs.emplace_back(path.filename().string(), io::content_hash(bytes.str()));
  };
  for (const std::filesystem::path& table : file.tables) note(table);
  try {
    loaded.model = build(file.scene, [&note](const std::filesystem::path& path) {
      solid::Mesh mesh = io::read_mesh(path);
      note(path);
      return mesh;
    });
  } catch (const InputError& error) {
    InputFault fault = error.fault();
    if (!fault.file.empty()) throw;
    fault.file = file.path.string();
    fault.line = io::line_of(file, fault.path);
    throw InputError(fault);
  }
  std::string all;
  for (const auto& [name, hash] : loaded.inputs) all += hash;
  loaded.inputs_hash = io::content_hash(all);
  loaded.file = std::move(file);
  return loaded;
}

}  // namespace sinew::app
