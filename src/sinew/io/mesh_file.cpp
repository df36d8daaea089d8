#include "sinew/io/mesh_file.hpp"

#include <fmt/format.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <fstream>
#include <iterator>
#include <system_error>

#include "sinew/error/input_error.hpp"
#include "sinew/io/byte_cursor.hpp"
#include "sinew/io/mesh_formats.hpp"

namespace sinew::io {
namespace {

[[noreturn]] void fail(const std::string& file, const std::string& value, const std::string& rule,
                       const std::string& remedy) {
  throw InputError({.file = file, .line = 0, .path = "", .value = value, .rule = rule, .remedy = remedy});
}

/// Faults of the path itself: what is wrong stands in whatever named the file, so that is for the caller to say.
[[noreturn]] void fail_path(const std::string& file, const std::string& rule, const std::string& remedy) {
  throw InputError({.file = "", .line = 0, .path = "", .value = file, .rule = rule, .remedy = remedy});
}

std::string read_bytes(const std::filesystem::path& path) {
  const std::string file = path.string();
  std::error_code error;
  const std::filesystem::file_status status = std::filesystem::status(path, error);
  if (!std::filesystem::exists(status)) {
    fail_path(file, "the mesh file does not exist", "check the path; in a scene it is relative to the scene file");
  }
  if (!std::filesystem::is_regular_file(status)) {
    fail_path(file, std::filesystem::is_directory(status) ? "is a folder, not a mesh file" : "is not a regular file",
              "give the path of a .vtk, .vtu or .msh file");
  }
  std::ifstream stream(path, std::ios::binary);
  std::string bytes((std::istreambuf_iterator<char>(stream)), std::istreambuf_iterator<char>());
  if (!stream.is_open() || stream.bad()) fail_path(file, "the mesh file cannot be read", "check who may read it");
  return bytes;
}

std::string list(const std::map<std::string, int>& kinds) {
  std::string text;
  for (const auto& [kind, count] : kinds) text += fmt::format("{}{} {}", text.empty() ? "" : ", ", count, kind);
  return text.empty() ? "no cells" : text;
}

double longest_edge(const Eigen::Matrix3Xd& nodes, const solid::Tetrahedron& tet) {
  double longest = 0.0;
  for (std::size_t i = 0; i < 4; ++i) {
    for (std::size_t j = 0; j < i; ++j) longest = std::max(longest, (nodes.col(tet[i]) - nodes.col(tet[j])).norm());
  }
  return longest;
}

void check_nodes(const solid::Mesh& mesh, const std::string& file) {
  for (Eigen::Index i = 0; i < mesh.nodes.cols(); ++i) {
    if (mesh.nodes.col(i).allFinite()) continue;
    fail(file,
         fmt::format("node {} (0-based) at ({}, {}, {})", i, mesh.nodes(0, i), mesh.nodes(1, i), mesh.nodes(2, i)),
         "coordinates must be finite", "find out in the program that wrote the mesh where it comes from");
  }
  for (std::size_t i = 0; i < mesh.tetrahedra.size(); ++i) {
    for (const int node : mesh.tetrahedra[i]) {
      if (node >= 0 && node < mesh.nodes.cols()) continue;
      fail(file, std::to_string(node),
           fmt::format("node number in tetrahedron {} (0-based, counting tetrahedra only) must be from 0 to {}", i,
                       mesh.nodes.cols() - 1),
           "nodes are numbered from 0; check the numbers or the count of the points");
    }
  }
}

void check_volumes(const solid::Mesh& mesh, const std::string& file) {
  std::size_t bad = 0, first = 0;
  for (std::size_t i = 0; i < mesh.tetrahedra.size(); ++i) {
    const double edge = longest_edge(mesh.nodes, mesh.tetrahedra[i]);
    const double smallest = 1e-12 * edge * edge * edge;
    const double size = solid::volume(mesh.nodes, mesh.tetrahedra[i]);
    if (size > smallest && std::isfinite(size)) continue;  // also false for NaN
    if (bad++ == 0) first = i;
  }
  if (bad == 0) return;
  const bool all = bad == mesh.tetrahedra.size();
  const double size = solid::volume(mesh.nodes, mesh.tetrahedra[first]);
  fail(file, fmt::format("volume {:.6g} of tetrahedron {} (0-based, counting tetrahedra only)", size, first),
       fmt::format("every tetrahedron (a, b, c, d) must have a positive volume, (b-a)x(c-a).(d-a) / 6, above 1e-12 of "
                   "its longest edge cubed; {} of {} do not",
                   bad, mesh.tetrahedra.size()),
       all && size < 0.0
           ? "all are the wrong way round: swap two nodes of every tetrahedron in the program that writes "
             "the mesh"
           : "reorder the nodes of tetrahedra of negative volume, remove or remesh those of zero volume");
}

}  // namespace

solid::Mesh read_mesh(const std::filesystem::path& path) { return parse_mesh(read_bytes(path), path.string()); }

solid::Mesh parse_mesh(std::string_view bytes, const std::string& name) {
  constexpr const char* formats = "Sinew reads legacy VTK (.vtk), VTU (.vtu) and Gmsh MSH 2.2 and 4.1 (.msh)";
  if (bytes.empty()) fail(name, "", "the mesh file is empty", formats);
  constexpr std::string_view byte_order_mark = "\xEF\xBB\xBF";
  const std::string_view text = bytes.substr(bytes.starts_with(byte_order_mark) ? byte_order_mark.size() : 0);
  const std::string_view first = ByteCursor(text, name).peek();
  solid::Mesh mesh;
  if (text.starts_with("# vtk")) {
    mesh = parse_legacy_vtk(text, name);
  } else if (first.starts_with("<")) {
    mesh = parse_vtu(bytes, name);
  } else if (first.starts_with("$")) {
    mesh = parse_gmsh(text, name);
  } else {
    fail(name, quoted(first), "must begin with \"# vtk DataFile Version\", \"<VTKFile\" or \"$MeshFormat\"", formats);
  }
  check_mesh(mesh, name);
  return mesh;
}

void check_mesh(const solid::Mesh& mesh, const std::string& file) {
  if (mesh.tetrahedra.empty()) {
    fail(file, list(mesh.ignored), "the mesh must have at least one linear tetrahedron with 4 nodes",
         "mesh the volume, not only its surface, with first-order tetrahedra (in Gmsh: Mesh 3D, order 1)");
  }
  check_nodes(mesh, file);
  check_volumes(mesh, file);
}

}  // namespace sinew::io
