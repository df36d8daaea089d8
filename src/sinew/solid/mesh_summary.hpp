// What one wants to know of a mesh before using it: counts, size, volume, and its worst cell.
#pragma once

#include <Eigen/Core>
#include <map>
#include <string>

#include "sinew/solid/mesh.hpp"

namespace sinew::solid {

/// Lengths in the unit of the mesh's nodes, volumes in its cube. The box is that of the nodes which cells use.
/// Of a mesh without cells only the counts are set.
struct MeshSummary {
  int nodes = 0;                         ///< all nodes of the file
  int cells = 0;                         ///< cells used
  std::map<Kind, int> kinds;             ///< of them, those of each kind there is
  std::map<std::string, int> ignored;    ///< cells not used, by kind
  int unused_nodes = 0;                  ///< nodes that no cell uses
  Vec3 lower = {0, 0, 0};                ///< corner of the bounding box
  Vec3 upper = {0, 0, 0};                ///< opposite corner
  double diagonal = 0.0;                 ///< of the bounding box
  double volume = 0.0;                   ///< of all cells
  double smallest = 0.0, largest = 0.0;  ///< volumes of the smallest and the largest cell
  double worst_quality = 0.0;            ///< smallest `mean_ratio`
  int worst_cell = -1;                   ///< its cell, 0-based
  Vec3 worst_centre = {0, 0, 0};         ///< mean of that cell's corners
};

/// Shape of a cell by its corners, 1 if ideal, 0 if flat or inverted; curved edges do not count.
/// Tetrahedron: 12 (3 V)^(2/3) / (sum of the six squared edges), 1 if regular. Hexahedron: the smallest of
/// 3 d^(2/3) / (sum of the three squared edges) over its corners, d the determinant of the edges there; 1 if a cube.
double mean_ratio(const Eigen::Matrix3Xd& nodes, const Cell& cell);

/// Precondition: node numbers in range (io::check_mesh).
MeshSummary summarize(const Mesh& mesh);

}  // namespace sinew::solid
