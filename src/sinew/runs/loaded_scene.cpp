#include "sinew/runs/loaded_scene.hpp"

#include <fstream>
#include <sstream>
#include <stdexcept>

#include "sinew/error/input_error.hpp"
#include "sinew/io/content_hash.hpp"
#include "sinew/io/mesh_file.hpp"
#include "sinew/sim/state.hpp"

namespace sinew::runs {

namespace {

std::string bytes_of(const std::filesystem::path& path) {
  std::ifstream stream(path, std::ios::binary);
  std::ostringstream bytes;
  bytes << stream.rdbuf();
  return bytes.str();
}

}  // namespace

std::filesystem::path held_folder(const std::filesystem::path& results) { return results / "meshes"; }

LoadedScene load(io::SceneFile file, HeldFiles held) {
  LoadedScene loaded;
  loaded.held = std::move(held);
  loaded.inputs.emplace_back(file.path.filename().string(), io::content_hash(file.text));
  const auto note = [&loaded](const std::filesystem::path& path, const std::string& bytes) {
    loaded.inputs.emplace_back(path.filename().string(), io::content_hash(bytes));
  };
  for (const std::filesystem::path& table : file.tables) note(table, bytes_of(table));
  try {
    loaded.model = build(file.scene, [&](const std::filesystem::path& path) {
      const auto own = loaded.held.find(path.filename().string());
      solid::Mesh mesh = own == loaded.held.end() ? io::read_mesh(path) : io::parse_mesh(own->second, own->first);
      note(path, own == loaded.held.end() ? bytes_of(path) : own->second);
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
  HeldFiles held;
  const std::filesystem::path beside = held_folder(path.parent_path());
  if (std::filesystem::is_directory(beside)) {
    for (const auto& entry : std::filesystem::directory_iterator(beside)) {
      if (entry.is_regular_file()) held[entry.path().filename().string()] = bytes_of(entry.path());
    }
  }
  LoadedScene loaded =
      load(io::parse_scene(header.scene_text, header.scene_name, header.scene_folder), std::move(held));
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
