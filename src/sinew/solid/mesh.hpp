// A volume mesh as plain data. Readers fill it, `check_mesh` judges it, `surface` is what a picture shows.
#pragma once

#include <Eigen/Core>
#include <array>
#include <map>
#include <string>
#include <vector>

namespace sinew::solid {

using Tetrahedron = std::array<int, 4>;  ///< node numbers, positive volume: (b-a)x(c-a).(d-a) > 0
using Triangle = std::array<int, 3>;     ///< node numbers, counter-clockwise seen from outside

/// Nodes [file units until scaled, then m] and the cells this engine uses. Nodes that no tetrahedron uses are kept here
/// (numbers stay those of the file); `build` rejects or drops them.
struct Mesh {
  Eigen::Matrix3Xd nodes;               ///< 3 x n, one column a node
  std::vector<Tetrahedron> tetrahedra;  ///< cells
  std::map<std::string, int> ignored;   ///< other cells of the file: kind ("triangle", "line", ...) and how many
};

/// Boundary triangles of the tetrahedra, outward.
std::vector<Triangle> surface(const std::vector<Tetrahedron>& tetrahedra);

/// Signed volume of a tetrahedron, in the cube of the nodes' unit.
double volume(const Eigen::Matrix3Xd& nodes, const Tetrahedron& tetrahedron);

}  // namespace sinew::solid
