// Whether the cells of a mesh are tied wherever they meet, and the remedy where only some have nodes in the middle of
// their edges: all get them.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "sinew/solid/mesh.hpp"

namespace sinew::solid {

/// How many 4-node tetrahedra share an edge in whose middle another cell has a node, which nothing ties to them.
int meeting_orders(const std::vector<Cell>& cells);

/// Those nodes, ascending.
std::vector<int> untied_middles(const std::vector<Cell>& cells);

/// The same mesh with 10-node tetrahedra in place of those of 4 nodes; other cells stay. New nodes are in the middle of
/// straight edges and follow the old ones; on an edge that has a middle node that one is taken. Faces of groups get the
/// nodes of their edges. Groups get those of their cells and faces, and where they also have other nodes (of lines and
/// points) new ones between two of theirs.
Mesh quadratic(Mesh mesh);

/// Numbers of two cells that touch along more than a point and yet are not tied there; none in a mesh that holds
/// together. Pieces that share no nodes are not looked at.
using CellPair = std::array<int, 2>;
/// A hexahedron and a tetrahedron: a triangle of the boundary whose corners all lie in one of its quadrilaterals.
std::optional<CellPair> mismatched_faces(const std::vector<Cell>& cells);
/// Two 10-node tetrahedra with different nodes in the middle of one edge.
std::optional<CellPair> mismatched_edges(const std::vector<Cell>& cells);

}  // namespace sinew::solid
