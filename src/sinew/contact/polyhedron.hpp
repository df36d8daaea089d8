// Convex polyhedra: corners, faces, edges.
#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

namespace sinew::contact {

using Vec3 = Eigen::Vector3d;

struct Polyhedron {
  std::vector<Vec3> corners;              ///< [m]
  std::vector<std::vector<int>> faces;    ///< corners of each, counter-clockwise seen from outside
  std::vector<Vec3> normals;              ///< of each face, outward
  std::vector<std::array<int, 2>> edges;  ///< corners of each
  std::vector<std::array<int, 2>> sides;  ///< the faces that meet in each
};

/// Normals and edges from corners and faces. Throws std::invalid_argument where two faces do not meet in every edge.
Polyhedron make_polyhedron(std::vector<Vec3> corners, std::vector<std::vector<int>> faces);

Polyhedron box(const Vec3& size);
/// A right prism about z on a regular polygon around the circle of this radius, with about the same volume as the
/// cylinder.
Polyhedron prism(double radius, double length, int sides);

}  // namespace sinew::contact
