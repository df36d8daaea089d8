#include "sinew/io/mesh_file.hpp"

#include <fmt/format.h>

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <optional>
#include <span>
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
    const bool unknown = status.type() == std::filesystem::file_type::none;  // a name that is too long, say
    fail_path(file, unknown ? "the mesh file cannot be looked for: " + error.message() : "the mesh file does not exist",
              "check the path; in a scene it is relative to the scene file");
  }
  if (!std::filesystem::is_regular_file(status)) {
    fail_path(file, std::filesystem::is_directory(status) ? "is a folder, not a mesh file" : "is not a regular file",
              "give the path of a .vtk, .vtu, .msh or .inp file, or of an .stl or .obj file for a surface");
  }
  std::ifstream stream(path, std::ios::binary);
  std::string bytes;
  std::array<char, 1 << 16> part{};
  do {
    stream.read(part.data(), part.size());
    bytes.append(part.data(), static_cast<std::size_t>(stream.gcount()));
  } while (stream);
  if (!stream.is_open() || stream.bad()) fail_path(file, "the mesh file cannot be read", "check who may read it");
  return bytes;
}

/// What the file has besides elements.
std::string list(const solid::Mesh& mesh) {
  std::string text;
  for (const auto& [kind, count] : mesh.ignored) text += fmt::format("{}{} {}", text.empty() ? "" : ", ", count, kind);
  std::size_t faces = 0;
  for (const auto& [name, group] : mesh.groups) faces += group.faces.size();
  if (faces > 0) text += fmt::format("{}{} faces in groups", text.empty() ? "" : ", ", faces);
  if (text.empty()) text = mesh.groups.empty() ? "no cells" : "lines or points only";
  return text;
}

/// "cell 7 (0-based, counting used cells only), an 8-node hexahedron".
std::string title(const solid::Mesh& mesh, std::size_t cell) {
  const solid::Kind kind = mesh.cells[cell].kind;
  return fmt::format("cell {} (0-based, counting used cells only), {} {}", cell, kind == solid::Kind::hex8 ? "an" : "a",
                     solid::name(kind));
}

double longest_edge(const Eigen::Matrix3Xd& nodes, const solid::Cell& tet) {
  double longest = 0.0;
  for (std::size_t i = 0; i < 4; ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      longest = std::max(longest, (nodes.col(tet.node[i]) - nodes.col(tet.node[j])).norm());
    }
  }
  return longest;
}

void check_coordinates(const solid::Mesh& mesh, const std::string& file) {
  for (Eigen::Index i = 0; i < mesh.nodes.cols(); ++i) {
    if (mesh.nodes.col(i).allFinite()) continue;
    fail(file,
         fmt::format("node {} (0-based) at ({}, {}, {})", i, mesh.nodes(0, i), mesh.nodes(1, i), mesh.nodes(2, i)),
         "coordinates must be finite", "find out in the program that wrote the mesh where it comes from");
  }
}

void check_nodes(const solid::Mesh& mesh, const std::string& file) {
  for (std::size_t i = 0; i < mesh.cells.size(); ++i) {
    const std::span<const int> nodes = mesh.cells[i].nodes();
    for (std::size_t k = 0; k < nodes.size(); ++k) {
      if (nodes[k] < 0 || nodes[k] >= mesh.nodes.cols()) {
        fail(file, std::to_string(nodes[k]),
             fmt::format("node number in {}, must be from 0 to {}", title(mesh, i), mesh.nodes.cols() - 1),
             "nodes are numbered from 0; check the numbers or the count of the points");
      }
      const std::span<const int> before = nodes.first(k);
      if (std::find(before.begin(), before.end(), nodes[k]) != before.end()) {
        fail(file, fmt::format("node {} twice", nodes[k]),
             fmt::format("the nodes of {}, must all be different", title(mesh, i)),
             "remove the cell if it is flat, else remesh it or split it into tetrahedra");
      }
    }
  }
}

/// The same cell turned inside out.
solid::Cell mirrored(const solid::Cell& cell) {
  static constexpr std::array<int, solid::kMostNodes> tetrahedron = {0, 2, 1, 3, 6, 5, 4, 7, 9, 8};
  static constexpr std::array<int, solid::kMostNodes> hexahedron = {4, 5, 6, 7, 0, 1, 2, 3, 8, 9};
  solid::Cell other = cell;
  for (std::size_t i = 0; i < cell.nodes().size(); ++i) {
    const int from = cell.kind == solid::Kind::hex8 ? hexahedron[i] : tetrahedron[i];
    other.node[i] = cell.node[static_cast<std::size_t>(from)];
  }
  return other;
}

/// The cells of a kind whose shape is refused.
struct Refused {
  std::size_t of = 0;        ///< all cells of the kind
  std::size_t count = 0;     ///< those refused
  std::size_t inverted = 0;  ///< those of them that are good when mirrored
  std::size_t first = 0;     ///< among all cells
};

constexpr double smallest_part = 1e-12;

/// Linear tetrahedra: their volume says it all. Curved and twisted elements can have a positive volume and yet be
/// folded in a corner. False for NaN.
bool is_sound(const solid::Mesh& mesh, const solid::Cell& cell) {
  const double volume = solid::volume(mesh.nodes, cell);
  if (!std::isfinite(volume)) return false;
  if (cell.kind != solid::Kind::tet4) return volume > 0.0 && solid::smallest_jacobian(mesh.nodes, cell) > smallest_part;
  const double edge = longest_edge(mesh.nodes, cell);
  return volume > smallest_part * edge * edge * edge;
}

Refused refused(const solid::Mesh& mesh, solid::Kind kind) {
  Refused found;
  for (std::size_t i = 0; i < mesh.cells.size(); ++i) {
    const solid::Cell& cell = mesh.cells[i];
    if (cell.kind != kind) continue;
    ++found.of;
    if (is_sound(mesh, cell)) continue;
    if (found.count++ == 0) found.first = i;
    if (is_sound(mesh, mirrored(cell))) ++found.inverted;
  }
  return found;
}

void check_volumes(const solid::Mesh& mesh, const std::string& file) {
  const Refused bad = refused(mesh, solid::Kind::tet4);
  if (bad.count == 0) return;
  fail(file,
       fmt::format("volume {:.6g} of tetrahedron {} (0-based, counting used cells only)",
                   solid::volume(mesh.nodes, mesh.cells[bad.first]), bad.first),
       fmt::format("every tetrahedron (a, b, c, d) must have a positive volume, (b-a)x(c-a).(d-a) / 6, above 1e-12 of "
                   "its longest edge cubed; {} of {} do not",
                   bad.count, bad.of),
       bad.inverted == bad.of
           ? "all are the wrong way round: swap two nodes of every tetrahedron in the program that writes "
             "the mesh"
           : "reorder the nodes of tetrahedra of negative volume, remove or remesh those of zero volume");
}

void check_folds(const solid::Mesh& mesh, solid::Kind kind, const std::string& file) {
  const Refused bad = refused(mesh, kind);
  if (bad.count == 0) return;
  const char* remedy =
      kind == solid::Kind::hex8
          ? "remesh it with less twist; if many are folded, their nodes stand in another order than that of the file's "
            "format"
          : "straighten its edges (in Gmsh: Mesh.HighOrderOptimize = 2) or remesh it finer; if many are folded, their "
            "nodes stand in another order than that of the file's format";
  fail(file,
       fmt::format("relative Jacobian {:.6g} of {}", solid::smallest_jacobian(mesh.nodes, mesh.cells[bad.first]),
                   title(mesh, bad.first)),
       fmt::format("a curved or twisted element must not be folded: the determinant of dX/dxi, relative to its size, "
                   "must be above 1e-12 at its nodes and quadrature points; {} of {} are folded",
                   bad.count, bad.of),
       bad.inverted == bad.of ? "all are the wrong way round: mirror the order of the nodes of every such cell in the "
                                "program that writes the mesh"
                              : remedy);
}

/// Cells of a kind that are all the wrong way round, and would be sound if mirrored, are.
void turn_inverted(solid::Mesh& mesh) {
  for (const solid::Kind kind : {solid::Kind::tet4, solid::Kind::tet10, solid::Kind::hex8}) {
    const auto first = std::find_if(mesh.cells.begin(), mesh.cells.end(),
                                    [kind](const solid::Cell& cell) { return cell.kind == kind; });
    if (first == mesh.cells.end() || is_sound(mesh, *first)) continue;
    const Refused bad = refused(mesh, kind);
    if (bad.inverted < bad.of) continue;
    for (solid::Cell& cell : mesh.cells)
      if (cell.kind == kind) cell = mirrored(cell);
    mesh.turned += static_cast<int>(bad.of);
  }
}

void check_content(const solid::Mesh& mesh, const std::string& file) {
  if (mesh.cells.empty()) {
    fail(file, list(mesh), "the mesh must have at least one tetrahedron with 4 or 10 nodes or hexahedron with 8 nodes",
         "mesh the volume, not only its surface (in Gmsh: Mesh 3D), with tetrahedra of order 1 or 2, or hexahedra of "
         "order 1");
  }
  check_coordinates(mesh, file);
  check_nodes(mesh, file);
}

bool has_extension(const std::string& name, std::string_view extension) {
  return equal_ignoring_case(std::filesystem::path(name).extension().string(), extension);
}

/// Nothing if it is no surface.
std::optional<solid::Mesh> parse_surface(std::string_view text, std::string_view first, const std::string& name) {
  const std::size_t size = binary_stl_size(text);
  if (size > 0 && (size == text.size() || has_extension(name, ".stl")))
    return parse_binary_stl(text.substr(0, size), name);
  if (equal_ignoring_case(first, "solid")) return parse_text_stl(text, name);
  if (is_obj(first) && !text.starts_with("# vtk")) return parse_obj(text, name);
  return std::nullopt;
}

}  // namespace

solid::Mesh read_mesh(const std::filesystem::path& path) { return parse_mesh(read_bytes(path), path.string()); }

solid::Mesh parse_mesh(std::string_view bytes, const std::string& name) {
  constexpr const char* formats =
      "Sinew reads legacy VTK (.vtk), VTU (.vtu), Gmsh MSH 2.2 and 4.1 (.msh) and Abaqus input (.inp), and surfaces as "
      "STL and OBJ";
  if (bytes.empty()) fail(name, "", "the mesh file is empty", formats);
  constexpr std::string_view byte_order_mark = "\xEF\xBB\xBF";
  const std::string_view text = bytes.substr(bytes.starts_with(byte_order_mark) ? byte_order_mark.size() : 0);
  const std::string_view first = ByteCursor(text, name).peek();
  if (std::optional<solid::Mesh> surface = parse_surface(text, first, name)) {
    if (surface->faces.empty()) fail(name, "", "the surface has no triangles", "export the part again");
    return *std::move(surface);
  }
  solid::Mesh mesh;
  if (text.starts_with("# vtk")) {
    mesh = parse_legacy_vtk(text, name);
  } else if (first.starts_with("<")) {
    mesh = parse_vtu(bytes, name);
  } else if (first == "$NOD") {
    fail(name, in_quotes(first), "is the start of a Gmsh file of version 1, which is not read",
         "save it again: `gmsh -save -format msh41 in.msh -o out.msh`");
  } else if (first.starts_with("$")) {
    mesh = parse_gmsh(text, name);
  } else if (first.starts_with("*")) {
    mesh = parse_abaqus(text, name);
  } else if (first.starts_with("(")) {
    fail(name, in_quotes(first), "is the start of a mesh of ANSYS Fluent, which is not read",
         "export it as Abaqus input (.inp) or VTK, or convert it, for example with meshio");
  } else if (has_extension(name, ".stl")) {
    fail(name, fmt::format("{} bytes", bytes.size()),
         "is neither a text STL file nor as long as a binary one is, 84 bytes and 50 for each triangle",
         "the file is cut short: export the part again");
  } else {
    fail(name, in_quotes(first),
         "must begin with \"# vtk DataFile Version\", \"<VTKFile\", \"$MeshFormat\" or a keyword of Abaqus as "
         "\"*NODE\", or be an STL or OBJ file",
         formats);
  }
  check_content(mesh, name);
  turn_inverted(mesh);
  check_mesh(mesh, name);
  return mesh;
}

void check_mesh(const solid::Mesh& mesh, const std::string& file) {
  check_content(mesh, file);
  check_volumes(mesh, file);
  check_folds(mesh, solid::Kind::tet10, file);
  check_folds(mesh, solid::Kind::hex8, file);
}

}  // namespace sinew::io
