// The finite elements: shape functions, quadrature, faces. Nodes are numbered as VTK does (cell types 10, 24, 12).
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <optional>
#include <span>

namespace sinew::solid {

using Vec3 = Eigen::Vector3d;
using Mat3 = Eigen::Matrix3d;

enum class Kind : std::uint8_t { tet4, tet10, hex8 };
inline constexpr int kMostNodes = 10, kMostPoints = 8;  ///< of an element, and of its quadrature

constexpr int node_count(Kind kind) { return kind == Kind::tet4 ? 4 : kind == Kind::tet10 ? 10 : 8; }
constexpr int corner_count(Kind kind) { return kind == Kind::hex8 ? 8 : 4; }
const char* plural(Kind kind);  ///< "tetrahedra", "10-node tetrahedra", "hexahedra"
const char* name(Kind kind);    ///< "4-node tetrahedron", "10-node tetrahedron", "8-node hexahedron"

/// Values at an element's nodes: of shape functions, and their gradients as columns.
using NodeValues = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, kMostNodes, 1>;
using NodeVectors = Eigen::Matrix<double, 3, Eigen::Dynamic, 0, 3, kMostNodes>;

/// Local coordinates of the nodes. Tetrahedra: the unit simplex; hexahedra: [-1, 1]^3.
std::span<const Vec3> reference_nodes(Kind kind);
/// N_i(xi): sums to 1, inside and outside.
NodeValues shape_functions(Kind kind, const Vec3& xi);
/// dN_i / dxi, one column a node. With the nodes' positions X, dX/dxi = X slopes^T.
NodeVectors shape_slopes(Kind kind, const Vec3& xi);

/// A point of a quadrature rule over the reference element; weights sum to its volume (1/6 or 8).
struct GaussPoint {
  Vec3 xi;
  double weight;
};
/// Exact for the stiffness of a tetrahedron with straight edges and of a parallelepiped: 1, 4 and 8 points (degree 0
/// and 2; 3 per direction).
std::span<const GaussPoint> quadrature(Kind kind);
/// Exact for the mass of a tetrahedron with straight edges and of any hexahedron, and for the volume of both and of
/// curved tetrahedra: 4, 14 and 27 points, all weights positive (degree 2 and 5; 5 per direction).
std::span<const GaussPoint> mass_quadrature(Kind kind);

/// Local coordinates of x, x = sum N_i(xi) nodes_i, by Newton from the centre; of a 4-node tetrahedron in one step.
/// Outside, too, where the map is continued. Nothing where it folds on the way there: far outside a curved or twisted
/// element, or for elements without volume.
std::optional<Vec3> local_coordinates(Kind kind, const NodeVectors& nodes, const Vec3& x);
/// How far xi lies outside the reference element, 0 inside: the largest violation of its bounds.
double outside(Kind kind, const Vec3& xi);

/// Between which corners of a 10-node tetrahedron its nodes 4 to 9 lie.
std::span<const std::array<int, 2>, 6> tetrahedron_edges();

/// A face: its nodes counter-clockwise seen from outside, corners first (3, then 3 mid-edge nodes; or 4).
struct Face {
  int corners = 3;
  int nodes = 3;
  std::array<int, 6> node{};  ///< local numbers
};
std::span<const Face> faces(Kind kind);
/// A face of 3, 4 or 6 nodes as 1, 2 or 4 triangles of its nodes, turning as it does: positions in Face::node.
std::span<const std::array<int, 3>> face_triangles(int nodes);

/// Shape functions and slopes of a face over its reference triangle (0,0) (1,0) (0,1) or square [-1, 1]^2, in the order
/// of Face::node; 2 x n slopes. With the nodes' positions x, x slopes^T are the tangents, whose cross product is the
/// outward normal times the area.
using FaceValues = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, 6, 1>;
using FaceSlopes = Eigen::Matrix<double, 2, Eigen::Dynamic, 0, 2, 6>;
FaceValues face_functions(const Face& face, const Eigen::Vector2d& xi);
FaceSlopes face_slopes(const Face& face, const Eigen::Vector2d& xi);
struct FacePoint {
  Eigen::Vector2d xi;
  double weight;
};
/// Exact for a constant pressure on any deformed face of this kind: 1, 4 and 6 points on faces of 3, 4 and 6 nodes
/// (degree 1; 3 per direction; 4). Weights sum to the area of the reference face (1/2 or 4).
std::span<const FacePoint> face_quadrature(const Face& face);

}  // namespace sinew::solid
