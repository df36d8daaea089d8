// libFuzzer target for the mesh readers: whatever the bytes, a mesh or an InputError. Not part of the normal build:
//
//   clang++ -std=c++20 -g -O1 -fsanitize=fuzzer,address,undefined -fno-sanitize-recover=all -Isrc -I/usr/include/eigen3
//     tests/fuzz/mesh_fuzz.cpp src/sinew/io/{byte_cursor,mesh_*,vtk_*,vtu_*}.cpp src/sinew/solid/mesh*.cpp
//     src/sinew/error/*.cpp -lfmt -lpugixml -lz -o mesh_fuzz
//   ./mesh_fuzz -rss_limit_mb=512 corpus/        (start the corpus from small files of every format)
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "sinew/error/input_error.hpp"
#include "sinew/io/mesh_file.hpp"
#include "sinew/solid/mesh_summary.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  try {
    const std::string_view bytes(reinterpret_cast<const char*>(data), size);
    const sinew::solid::Mesh mesh = sinew::io::parse_mesh(bytes, "fuzz");
    // A mesh that was accepted is usable: these index it without any check of their own.
    const sinew::solid::MeshSummary summary = sinew::solid::summarize(mesh);
    if (!(summary.smallest > 0.0) || sinew::solid::surface(mesh.tetrahedra).size() > 4 * mesh.tetrahedra.size()) {
      std::abort();
    }
  } catch (const sinew::InputError& error) {
    if (error.fault().rule.empty() || error.fault().remedy.empty()) std::abort();
  }
  return 0;
}
