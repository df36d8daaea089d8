// Surfaces of triangles, of solids and of rigid bodies: their edges, and boxes around all parts at rest.
#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "sinew/contact/tree.hpp"

namespace sinew::contact {

/// Two points of a surface's edge, as the first triangle runs round it, and the third one of each of the triangles that
/// meet in it (the same one where there is only one).
struct Ridge {
  std::array<int, 2> ends, sides;
};

struct Mesh {
  Eigen::Matrix3Xd points;                    ///< [m] at rest
  std::vector<std::array<int, 3>> triangles;  ///< counter-clockwise seen from outside
  std::vector<int> used;                      ///< points of triangles, ascending
  std::vector<std::array<int, 3>> beside;     ///< of each triangle, those across its edges i to i + 1; -1: none
  std::vector<Ridge> ridges;                  ///< by their ends
  Tree faces, edges;                          ///< around the triangles and the ridges
};
Mesh make_mesh(Eigen::Matrix3Xd points, std::vector<std::array<int, 3>> triangles);

/// Directions out of a surface with its points at x: of each triangle, and of each point the mean by the triangles'
/// angles there, which tells inside and outside apart wherever the point is what is nearest (Baerentzen, Aanaes 2005).
struct Outward {
  Eigen::Matrix3Xd faces, points;
};
void find_outward(const Mesh& mesh, const Eigen::Matrix3Xd& x, Outward& own);

/// Out of the surface where a triangle's point with these weights of its corners is: of the triangle, of an edge that
/// two share, of a point.
Eigen::Vector3d outward_at(const Mesh& mesh, const Outward& outward, int triangle,
                           const std::array<double, 3>& weights);

/// Whether p is in a closed surface with its points at x and `faces` fitted there: a line up from it passes an odd
/// number of triangles.
bool inside(const Mesh& mesh, const Eigen::Matrix3Xd& x, const Tree& faces, const Eigen::Vector3d& p);

/// How many edges are not those of exactly two triangles that are turned the same way: none of what encloses a volume.
int open_edges(const std::vector<std::array<int, 3>>& triangles);

}  // namespace sinew::contact
