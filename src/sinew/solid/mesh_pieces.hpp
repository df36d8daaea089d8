// Whether a mesh hangs together: its pieces, nodes at the same place that are not one, and nodes on faces of cells that
// do not have them. None of it can be seen in a picture, and a body comes apart there.
#pragma once

#include <array>
#include <vector>

#include "sinew/solid/mesh.hpp"

namespace sinew::solid {

/// Cells that share nodes, directly or through others, are one piece. Pieces are numbered in the order of their first
/// cells.
struct Pieces {
  int count = 0;
  std::vector<int> of_cell;
  std::vector<int> of_node;  ///< -1: no cell uses it
};
Pieces find_pieces(const std::vector<Cell>& cells, Eigen::Index nodes);

/// Nodes in use that are nearer to another than a millionth of the mesh's diagonal: the first one there, and each
/// other.
std::vector<std::array<int, 2>> coincident_nodes(const Eigen::Matrix3Xd& nodes, const std::vector<Cell>& cells);

/// Nodes of the boundary that lie on a boundary face of their own piece, to a millionth of the diagonal of the box
/// around it, and are not one of its nodes: the cells on both sides do not share them, so a gap opens there. Ascending.
/// (Nodes in the middle of edges that 4-node tetrahedra share are left out: mesh_order.hpp has the remedy.)
std::vector<int> hanging_nodes(const Eigen::Matrix3Xd& nodes, const std::vector<Cell>& cells, const Pieces& pieces);

}  // namespace sinew::solid
