// A volume mesh as plain data. Readers fill it, `check_mesh` judges it, `surface` is what a picture shows.
#pragma once

#include <Eigen/Core>
#include <array>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "sinew/solid/element.hpp"

namespace sinew::solid {

/// An element: its kind and as many node numbers as that has, in VTK's order, positive volume.
struct Cell {
  Kind kind = Kind::tet4;
  std::array<int, kMostNodes> node{};
  std::span<const int> nodes() const { return {node.data(), static_cast<std::size_t>(node_count(kind))}; }
  bool operator==(const Cell&) const = default;
};

/// A triangle (3 or 6 nodes) or quadrilateral (4) of a file's surface mesh, or of an element.
struct CellFace {
  int count = 3;
  std::array<int, 6> node{};
  std::span<const int> nodes() const { return {node.data(), static_cast<std::size_t>(count)}; }
  std::span<const int> corners() const { return {node.data(), count == 4 ? 4U : 3U}; }
  bool operator==(const CellFace&) const = default;
};

/// Sorts numbers and drops those that are there already.
void make_ascending(std::vector<int>& numbers);

/// Cells, faces and nodes that a file has given a common name: a physical group of Gmsh, or the number in an integer
/// array over a VTK file's cells.
struct Group {
  std::vector<int> cells;  ///< numbers among Mesh::cells
  std::vector<CellFace> faces;
  std::vector<int> nodes;  ///< of its points, faces and cells, ascending, without repetition
};

using Triangle = std::array<int, 3>;  ///< node numbers, counter-clockwise seen from outside

/// Nodes [file units until scaled, then m] and the cells this engine uses. Nodes that no cell uses are kept here
/// (numbers stay those of the file); `build` drops them.
struct Mesh {
  Eigen::Matrix3Xd nodes;  ///< 3 x n, one column a node
  std::vector<Cell> cells;
  std::vector<Triangle> faces;  ///< of a file that is a surface and has no cells
  std::map<std::string, Group> groups;
  std::map<std::string, int> ignored;  ///< other cells of the file: kind ("wedge", "line", ...) and how many
  /// Cells read as the plain element of their shape, though the file's type says more: the type, "C3D8R", and how many.
  std::map<std::string, int> simplified = {};
  int turned = 0;  ///< cells that were all inside out, and have been mirrored
};

/// Boundary faces of the cells, outward, each with all its nodes; in the order of the cells: those whose corners are
/// not the corners of another cell's face. True of meshes that hold together (mesh_order.hpp); elsewhere a triangle on
/// a quadrilateral is taken for boundary, and so are both.
std::vector<CellFace> boundary(const std::vector<Cell>& cells);
/// The same as triangles of all its nodes: a face of 6 nodes becomes four, of 4 nodes two.
std::vector<Triangle> surface(const std::vector<Cell>& cells);
std::vector<Triangle> triangles(const std::vector<CellFace>& faces);

/// The positions of a cell's nodes, in its order.
NodeVectors cell_nodes(const Eigen::Matrix3Xd& nodes, const Cell& cell);

/// Volume of a cell by its mass quadrature, in the cube of the nodes' unit: exact, negative if inverted.
double volume(const Eigen::Matrix3Xd& nodes, const Cell& cell);
/// The smallest determinant of dX/dxi at its quadrature points and nodes, over the mean of their sizes: 1 for affine
/// cells, not positive if the cell is inverted, without volume, or folded at one of them. Folds between them it does
/// not see.
double smallest_jacobian(const Eigen::Matrix3Xd& nodes, const Cell& cell);

}  // namespace sinew::solid
