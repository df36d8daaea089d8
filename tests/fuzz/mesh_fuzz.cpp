// libFuzzer target for the mesh readers: whatever the bytes, a mesh or an InputError. scripts/fuzz runs it.
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "sinew/contact/mesh.hpp"
#include "sinew/error/input_error.hpp"
#include "sinew/io/mesh_file.hpp"
#include "sinew/solid/mesh_summary.hpp"

namespace {

void expect(bool condition) {
  if (!condition) std::abort();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  try {
    const std::string_view bytes(reinterpret_cast<const char*>(data), size);
    const sinew::solid::Mesh mesh = sinew::io::parse_mesh(bytes, "fuzz");
    // A mesh that was accepted is usable: these index it without any check of their own.
    if (mesh.cells.empty()) {
      expect(!mesh.faces.empty());
      const sinew::contact::Mesh surface = sinew::contact::make_mesh(mesh.nodes, mesh.faces);
      expect(!surface.ridges.empty() &&
             sinew::contact::open_edges(mesh.faces) <= static_cast<int>(surface.ridges.size()));
      return 0;
    }
    const sinew::solid::MeshSummary summary = sinew::solid::summarize(mesh);
    expect(summary.smallest > 0.0 && sinew::solid::boundary(mesh.cells).size() <= 6 * mesh.cells.size());
    for (const auto& [name, group] : mesh.groups) {
      expect(!name.empty() && !group.nodes.empty());
      for (const int cell : group.cells) expect(cell >= 0 && static_cast<std::size_t>(cell) < mesh.cells.size());
      for (const int node : group.nodes) expect(node >= 0 && node < mesh.nodes.cols());
    }
  } catch (const sinew::InputError& error) {
    expect(!error.fault().rule.empty() && !error.fault().remedy.empty());
  }
  return 0;
}
