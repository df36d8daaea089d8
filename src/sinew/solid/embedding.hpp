// Material points of a volume: which element carries them and how its nodes move them, p = sum_i w_i x_i.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "sinew/solid/mesh.hpp"

namespace sinew::solid {

struct EmbeddedPoint {
  int element = -1;
  Vec3 local = Vec3::Zero();  ///< coordinates in the element; of a point outside, where its field is continued from
  NodeValues weights;         ///< of its nodes; sum to 1, of a vector carried with the point to 0
  double distance = 0.0;      ///< [m] from the element; 0 inside the mesh
};

/// A node, as a point of the first element that has it.
EmbeddedPoint at_node(const Eigen::Matrix3Xd& nodes, const std::vector<Cell>& cells, int node);

/// The element that holds x, or the nearest one by distance: of those at equal distance the one that extrapolates
/// least. Outside, its field is continued linearly from about the nearest point of its faces. The distance is that from
/// its faces as triangles of their nodes: exact where they are flat, else good to their bulge.
EmbeddedPoint embed(const Eigen::Matrix3Xd& nodes, const std::vector<Cell>& cells, const Vec3& x);

/// p = sum_i w_i x_i.
Vec3 position(const EmbeddedPoint& point, const std::vector<Cell>& cells, const Eigen::Matrix3Xd& x);

/// dN_i/dX at a local point, one column a node; `nodes` are the rest positions.
NodeVectors gradients(const Eigen::Matrix3Xd& nodes, const Cell& cell, const Vec3& local);

/// A vector e of the rest shape carried with the point: `position` of it is F e = sum_i x_i (dN_i/dX . e).
EmbeddedPoint embed_vector(const Eigen::Matrix3Xd& nodes, const std::vector<Cell>& cells, const EmbeddedPoint& point,
                           const Vec3& e);

}  // namespace sinew::solid
