// Material points of a volume: which element carries them and how its nodes move them, p = sum_i w_i x_i.
#pragma once

#include <Eigen/Core>

#include "sinew/solid/mesh.hpp"

namespace sinew::solid {

struct EmbeddedPoint {
  int element = -1;
  Eigen::Vector4d weights = Eigen::Vector4d::Zero();  ///< barycentric; negative ones extrapolate
  double distance = 0.0;                              ///< [m] from the element; 0 inside the mesh
};

/// The element that holds x, or the nearest one by distance, extrapolated.
EmbeddedPoint embed(const Eigen::Matrix3Xd& nodes, const std::vector<Tetrahedron>& tetrahedra,
                    const Eigen::Vector3d& x);

/// p = sum_i w_i x_i.
Eigen::Vector3d position(const EmbeddedPoint& point, const std::vector<Tetrahedron>& tetrahedra,
                         const Eigen::Matrix3Xd& x);

}  // namespace sinew::solid
