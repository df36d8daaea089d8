#include "sinew/runs/loaded_scene.hpp"

#include <fstream>
#include <sstream>
#include <stdexcept>

#include "sinew/error/input_error.hpp"
#include "sinew/io/content_hash.hpp"
#include "sinew/io/mesh_file.hpp"
#include "sinew/sim/state.hpp"

namespace sinew::runs {

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

LoadedScene load_recorded(const io::Recording& recording, const std::filesystem::path& path) {
  const io::RecordingHeader& header = recording.header;
  if (header.state_layout != kStateLayout)
    throw InputError({path.string(), 0, "", "", "holds states of another version of the engine",
                      "run the scene again, or use the version of Sinew that recorded it, " + header.program_version});
  LoadedScene loaded = load(io::parse_scene(header.scene_text, header.scene_name, header.scene_folder));
  if (loaded.inputs_hash != header.inputs_hash)
    throw InputError({path.string(), 0, "", "", "the scene's mesh files are not the ones this run was made with",
                      "restore them in " + header.scene_folder + ", or start a new run"});
  try {
    for (const io::RecordedStep& step : recording.steps) unpack(loaded.model, step.state);
  } catch (const std::invalid_argument&) {
    throw InputError({path.string(), 0, "", "", "holds states of another model of its scene",
                      "run the scene again, or use the version of Sinew that recorded it, " + header.program_version});
  }
  return loaded;
}

}  // namespace sinew::runs
