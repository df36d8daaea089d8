// Loads on the faces of a volume: shares of a force spread evenly, and a pressure that follows the surface,
//     f_a = -p int N_a n dA = -p int N_a (x_xi x x_eta) d xi d eta.
#pragma once

#include "sinew/solid/mesh.hpp"

namespace sinew::solid {

/// int N_a dA at each of the face's nodes [m^2]; at the corners of a face of 6 nodes 0 if it is flat, else of any sign.
FaceValues face_shares(const CellFace& face, const Eigen::Matrix3Xd& x);
/// The same area lumped, int N_a^2 dA scaled to it: above 0 at every node.
FaceValues lumped_face_shares(const CellFace& face, const Eigen::Matrix3Xd& x);

/// f_a, 3 x nodes of the face [N]. p [Pa] pushes against the outward normal.
Eigen::Matrix3Xd pressure_force(const CellFace& face, double p, const Eigen::Matrix3Xd& x);

/// -df/dx, 3n x 3n [N/m], with its sign on the left of the equation of motion; not symmetric by itself.
Eigen::MatrixXd pressure_tangent(const CellFace& face, double p, const Eigen::Matrix3Xd& x);

/// An edge on the rim of a surface: its ends and, of faces of 6 nodes, its middle.
struct Edge {
  std::array<int, 3> node{};
  int count = 2;
  std::span<const int> nodes() const { return {node.data(), static_cast<std::size_t>(count)}; }
};
/// The rim of faces that all look outward: edges that no other face runs through the other way. None of a closed
/// surface.
std::vector<Edge> rim(const std::vector<CellFace>& faces);

}  // namespace sinew::solid
