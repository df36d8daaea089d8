// What can be seen of a state: positions, deformation and stress in the world, ready for a file or a picture.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "sinew/solid/mesh.hpp"

namespace sinew {

/// Values at the points of a rod or in the cells of a solid, by name: what ParaView shows.
struct Field {
  std::string name;
  Eigen::MatrixXd values;  ///< components x points or cells; six are a symmetric tensor, xx yy zz xy yz xz
};

struct SolidSnapshot {
  std::string name;
  Eigen::Matrix3Xd rest;   ///< [m] node positions at t = 0
  Eigen::Matrix3Xd nodes;  ///< [m] node positions now
  std::vector<solid::Cell> cells;
  std::vector<solid::Triangle> surface;
  Eigen::VectorXd von_mises;  ///< [Pa] per cell
  /// Means over cells: Cauchy stress [Pa], Green-Lagrange strain, volume now over volume at rest; the material's
  /// number.
  std::vector<Field> fields;
};

/// A rod sampled along its length. Where a value jumps it belongs to the section that starts at the point.
struct RodSnapshot {
  std::string name;
  Eigen::VectorXd radius;     ///< [m] outer, m values; 0 for a geometric cable
  Eigen::VectorXd abscissa;   ///< [m] m samples, from base to tip
  Eigen::Matrix3Xd points;    ///< [m] 3 x m centreline
  Eigen::Matrix3Xd tangents;  ///< 3 x m unit tangents
  Eigen::VectorXd von_mises;  ///< [Pa] largest of the cross-section; empty for a geometric cable
  /// Strains (NOTATION.md) [1/m and -], internal moments [N m] and forces [N] in the axes of the cross-section,
  /// stresses [Pa] axial, of bending, of torsion; none for a geometric cable.
  std::vector<Field> fields;
};

/// A rigid body or an obstacle as triangles.
struct BodySnapshot {
  std::string name;
  Eigen::Matrix3Xd points;  ///< [m]
  std::vector<solid::Triangle> surface;
  bool ground = false;  ///< a half-space, of which this is a piece
};

/// A force [N] at a point [m] where two objects touch, on the one that `normal` points to: on bodies from obstacles, on
/// solids and rods from both.
struct ForceSnapshot {
  Eigen::Vector3d position, force, normal;
};

struct MarkSnapshot {
  std::string name;
  Eigen::Vector3d position;  ///< [m]
};

struct Snapshot {
  double time = 0.0;   ///< [s]
  std::string when;    ///< for people, if the time alone does not say it: the load factor, the mode
  std::string status;  ///< of the step that led here
  std::vector<SolidSnapshot> solids;
  std::vector<RodSnapshot> rods;
  std::vector<BodySnapshot> bodies;
  std::vector<ForceSnapshot> contacts;
  std::vector<MarkSnapshot> sliding_points;  ///< points that are on a rod
  std::vector<MarkSnapshot> outputs;
};

}  // namespace sinew
