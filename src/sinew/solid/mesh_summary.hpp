// What one wants to know of a mesh before using it: counts, size, volume, and its worst element.
#pragma once

#include <Eigen/Core>
#include <map>
#include <string>

#include "sinew/solid/mesh.hpp"

namespace sinew::solid {

/// Lengths in the unit of the mesh's nodes, volumes in its cube. The box is that of the nodes which tetrahedra use.
/// Of a mesh without tetrahedra only the counts are set.
struct MeshSummary {
  int nodes = 0;                         ///< all nodes of the file
  int tetrahedra = 0;                    ///< cells used
  std::map<std::string, int> ignored;    ///< cells not used, by kind
  int unused_nodes = 0;                  ///< nodes that no tetrahedron uses
  Eigen::Vector3d lower = {0, 0, 0};     ///< corner of the bounding box
  Eigen::Vector3d upper = {0, 0, 0};     ///< opposite corner
  double diagonal = 0.0;                 ///< of the bounding box
  double volume = 0.0;                   ///< of all tetrahedra
  double smallest = 0.0, largest = 0.0;  ///< volumes of the smallest and the largest tetrahedron
  double worst_quality = 0.0;            ///< smallest `mean_ratio`
  int worst_tetrahedron = -1;            ///< its tetrahedron, 0-based among the tetrahedra
};

/// Shape of a tetrahedron: 12 (3 V)^(2/3) / (sum of the six squared edges). 1 if regular, 0 if flat or inverted.
double mean_ratio(const Eigen::Matrix3Xd& nodes, const Tetrahedron& tetrahedron);

/// Precondition: node numbers in range (io::check_mesh).
MeshSummary summarize(const Mesh& mesh);

}  // namespace sinew::solid
