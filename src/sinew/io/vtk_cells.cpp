#include "sinew/io/vtk_cells.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <span>

#include "sinew/io/byte_cursor.hpp"
#include "sinew/io/mesh_cells.hpp"

namespace sinew::io {
namespace {

using enum Role;
using solid::Kind;

constexpr std::array kinds = {FileKind{0, "empty cell"},
                              FileKind{1, "vertex", 1, points},
                              FileKind{2, "poly-vertex", 0, points},
                              FileKind{3, "line", 2, points},
                              FileKind{4, "poly-line", 0, points},
                              FileKind{5, "triangle", 3, face},
                              FileKind{6, "triangle strip"},
                              FileKind{7, "polygon"},
                              FileKind{8, "pixel", 4, face, {}, {0, 1, 3, 2}},
                              FileKind{9, "quadrilateral", 4, face},
                              FileKind{10, "tetrahedron", 4, cell, Kind::tet4},
                              FileKind{11, "voxel", 8, cell, Kind::hex8, {0, 1, 3, 2, 4, 5, 7, 6}},
                              FileKind{12, "hexahedron", 8, cell, Kind::hex8},
                              FileKind{13, "wedge"},
                              FileKind{14, "pyramid"},
                              FileKind{21, "quadratic line", 3, points},
                              FileKind{22, "quadratic triangle", 6, face},
                              FileKind{23, "quadratic quadrilateral"},
                              FileKind{24, "quadratic tetrahedron", 10, cell, Kind::tet10},
                              FileKind{25, "quadratic hexahedron"},
                              FileKind{26, "quadratic wedge"},
                              FileKind{27, "quadratic pyramid"},
                              FileKind{28, "quadratic quadrilateral"},
                              FileKind{29, "quadratic hexahedron"},
                              FileKind{42, "polyhedron"},
                              FileKind{68, "higher-order line"},
                              FileKind{69, "higher-order triangle"},
                              FileKind{70, "higher-order quadrilateral"},
                              FileKind{71, "higher-order tetrahedron"},
                              FileKind{72, "higher-order hexahedron"},
                              FileKind{73, "higher-order wedge"},
                              FileKind{74, "higher-order pyramid"}};

constexpr std::array<std::string_view, 6> array_names = {"gmsh:physical", "medit:ref", "CellEntityIds",
                                                         "cell_tags",     "material",  "region"};

const FileKind* find_kind(std::int64_t type) {
  const auto found =
      std::find_if(kinds.begin(), kinds.end(), [type](const FileKind& kind) { return kind.type == type; });
  return found == kinds.end() ? nullptr : &*found;
}

/// Of the group with this number; empty if it stands for none.
std::string group_name(GroupArray array, std::int64_t number) {
  using enum GroupArray;
  if (number == 0 && (array == gmsh_physical || array == medit_ref)) return "";
  return array == gmsh_physical || array == cell_entity_ids ? without_sign(number) : std::to_string(number);
}

/// The node numbers of a cell, in the whole mesh.
void read_nodes(std::size_t index, std::span<const std::int64_t> numbers, const FileKind& kind, std::int64_t first_node,
                std::int64_t node_count, const RejectCell& reject, std::vector<int>& nodes) {
  if (kind.nodes != 0 && std::ssize(numbers) != kind.nodes) {
    reject(index, fmt::format("{} nodes", numbers.size()),
           fmt::format("{} in cell {} (0-based) must have {} nodes", kind.name, index, kind.nodes),
           "a tetrahedron is cell type 10 with 4 nodes, 24 with 10 nodes; a triangle 5 with 3, 22 with 6; a "
           "hexahedron 12 with 8; a quadrilateral 9 with 4");
  }
  nodes.clear();
  for (const std::int64_t node : numbers) {
    if (node < 0 || node >= node_count) {
      reject(index, std::to_string(node),
             fmt::format("node number in cell {} (0-based) must be from 0 to {}", index, node_count - 1),
             "nodes are numbered from 0; check the numbers or the count of the points");
    }
    nodes.push_back(static_cast<int>(first_node + node));
  }
}

}  // namespace

std::optional<GroupArray> group_array(std::string_view name) {
  for (std::size_t i = 0; i < array_names.size(); ++i) {
    if (equal_ignoring_case(name, array_names[i])) return static_cast<GroupArray>(i);
  }
  return std::nullopt;
}

void add_cells(const VtkCells& cells, std::int64_t first_node, std::int64_t node_count, solid::Mesh& mesh,
               const RejectCell& reject) {
  std::vector<int> nodes;
  std::int64_t begin = 0;
  for (std::size_t i = 0; i < cells.types.size(); ++i) {
    const std::int64_t end = cells.ends[i];
    if (end < begin || end > std::ssize(cells.connectivity)) {
      reject(i, std::to_string(end),
             fmt::format("the end of cell {} (0-based) must lie between {} and {}, the number of node numbers", i,
                         begin, cells.connectivity.size()),
             "the offsets of the cells are wrong: write the mesh again");
    }
    const std::span numbers =
        std::span(cells.connectivity).subspan(static_cast<std::size_t>(begin), static_cast<std::size_t>(end - begin));
    const std::string group = cells.grouped_by ? group_name(*cells.grouped_by, cells.groups[i]) : "";
    const std::span groups(&group, group.empty() ? 0 : 1);
    begin = end;
    const FileKind* kind = find_kind(cells.types[i]);
    if (kind == nullptr) {
      ++mesh.ignored[fmt::format("VTK cell type {}", cells.types[i])];
      continue;
    }
    if (is_used(*kind, !groups.empty())) read_nodes(i, numbers, *kind, first_node, node_count, reject, nodes);
    add_cell(mesh, *kind, nodes, groups);
  }
}

}  // namespace sinew::io
