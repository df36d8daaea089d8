// What can be seen of a state: positions, deformation and stress in the world, ready for a file or a picture.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "sinew/solid/mesh.hpp"

namespace sinew {

struct SolidSnapshot {
  std::string name;
  Eigen::Matrix3Xd rest;   ///< [m] node positions at t = 0
  Eigen::Matrix3Xd nodes;  ///< [m] node positions now
  std::vector<solid::Tetrahedron> tetrahedra;
  std::vector<solid::Triangle> surface;
  Eigen::VectorXd von_mises;  ///< [Pa] per tetrahedron
};

/// A rod sampled along its length; per-point values belong to the section that starts at or holds the point.
struct RodSnapshot {
  std::string name;
  double radius = 0.0;        ///< [m]; 0 for a geometric cable
  Eigen::VectorXd abscissa;   ///< [m] m samples, from base to tip
  Eigen::Matrix3Xd points;    ///< [m] 3 x m centreline
  Eigen::Matrix3Xd tangents;  ///< 3 x m unit tangents
  Eigen::Matrix<double, 6, Eigen::Dynamic>
      strains;  ///< 6 x m, order of NOTATION.md [1/m and -]; empty for a geometric cable
  Eigen::Matrix<double, 6, Eigen::Dynamic>
      stresses;               ///< 6 x m internal moments [N m] and forces [N] of the same strains
  Eigen::VectorXd von_mises;  ///< [Pa] largest of the cross section, m values
};

struct MarkSnapshot {
  std::string name;
  Eigen::Vector3d position;  ///< [m]
};

struct Snapshot {
  double time = 0.0;   ///< [s]
  std::string status;  ///< of the step that led here
  std::vector<SolidSnapshot> solids;
  std::vector<RodSnapshot> rods;
  std::vector<MarkSnapshot> sliding_points;  ///< points that are on a rod
  std::vector<MarkSnapshot> outputs;
};

}  // namespace sinew
