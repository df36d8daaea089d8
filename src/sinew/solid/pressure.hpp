// Loads on the faces of a volume: shares of a force spread evenly, and a pressure that follows the surface,
//     f_a = -p int N_a n dA = -p int N_a (x_xi x x_eta) d xi d eta.
#pragma once

#include "sinew/solid/mesh.hpp"

namespace sinew::solid {

/// int N_a dA at each of the face's nodes [m^2].
FaceValues face_shares(const CellFace& face, const Eigen::Matrix3Xd& x);

/// f_a, 3 x nodes of the face [N]. p [Pa] pushes against the outward normal.
Eigen::Matrix3Xd pressure_force(const CellFace& face, double p, const Eigen::Matrix3Xd& x);

/// -df/dx, 3n x 3n [N/m], with its sign on the left of the equation of motion; not symmetric by itself.
Eigen::MatrixXd pressure_tangent(const CellFace& face, double p, const Eigen::Matrix3Xd& x);

}  // namespace sinew::solid
