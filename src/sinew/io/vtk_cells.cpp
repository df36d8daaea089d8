#include "sinew/io/vtk_cells.hpp"

#include <fmt/format.h>

#include <utility>

namespace sinew::io {
namespace {

constexpr std::int64_t tetra = 10;  // VTK_TETRA

std::string kind(std::int64_t type) {
  static const std::map<std::int64_t, std::string> names = {
      {0, "empty cell"},
      {1, "vertex"},
      {2, "poly-vertex"},
      {3, "line"},
      {4, "poly-line"},
      {5, "triangle"},
      {6, "triangle strip"},
      {7, "polygon"},
      {8, "pixel"},
      {9, "quadrilateral"},
      {11, "voxel"},
      {12, "hexahedron"},
      {13, "wedge"},
      {14, "pyramid"},
      {21, "quadratic line"},
      {22, "quadratic triangle"},
      {23, "quadratic quadrilateral"},
      {24, "quadratic tetrahedron"},
      {25, "quadratic hexahedron"},
      {26, "quadratic wedge"},
      {27, "quadratic pyramid"},
      {29, "quadratic hexahedron"},
      {42, "polyhedron"},
      {71, "higher-order tetrahedron"},
  };
  const auto found = names.find(type);
  return found == names.end() ? fmt::format("VTK cell type {}", type) : found->second;
}

}  // namespace

void add_cells(const VtkCells& cells, std::int64_t first_node, std::int64_t node_count, solid::Mesh& mesh,
               const RejectCell& reject) {
  std::int64_t begin = 0;
  for (std::size_t i = 0; i < cells.types.size(); ++i) {
    const std::int64_t end = cells.ends[i];
    if (end < begin || end > std::ssize(cells.connectivity)) {
      reject(i, std::to_string(end),
             fmt::format("the end of cell {} (0-based) must lie between {} and {}, the number of node numbers", i,
                         begin, cells.connectivity.size()),
             "the offsets of the cells are wrong: write the mesh again");
    }
    if (cells.types[i] != tetra) {
      ++mesh.ignored[kind(cells.types[i])];
      begin = end;
      continue;
    }
    if (end - begin != 4) {
      reject(i, fmt::format("{} nodes", end - begin),
             fmt::format("tetrahedron in cell {} (0-based) must have 4 nodes", i),
             "a linear tetrahedron is cell type 10, a quadratic one with 10 nodes is cell type 24");
    }
    solid::Tetrahedron tet{};
    for (std::size_t k = 0; k < 4; ++k) {
      const std::int64_t node = cells.connectivity[static_cast<std::size_t>(begin) + k];
      if (node < 0 || node >= node_count) {
        reject(i, std::to_string(node),
               fmt::format("node number in cell {} (0-based) must be from 0 to {}", i, node_count - 1),
               "nodes are numbered from 0; check the numbers or the count of the points");
      }
      tet[k] = static_cast<int>(first_node + node);
    }
    mesh.tetrahedra.push_back(tet);
    begin = end;
  }
}

}  // namespace sinew::io
