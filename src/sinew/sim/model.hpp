// The model: a scene that has been judged, turned into bodies, rows and numbers. Immutable; a step only reads it.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "sinew/linalg/sparse_cholesky.hpp"
#include "sinew/rod/geometric_cable.hpp"
#include "sinew/rod/rod.hpp"
#include "sinew/sim/placement.hpp"
#include "sinew/sim/scene.hpp"
#include "sinew/solid/body.hpp"
#include "sinew/solid/embedding.hpp"

namespace sinew {

/// A volume, where it is attached, and the pattern of its matrix.
struct SolidModel {
  std::string name;
  solid::Body body;
  std::vector<solid::Triangle> surface;
  int frame = -1;                         ///< number of its frame, -1: the ground
  linalg::SparseCholesky::Matrix matrix;  ///< lower triangle over free unknowns, values zero
  std::vector<int> diagonal;              ///< position of each diagonal entry in the values
  std::vector<std::array<int, 9>>
      block;  ///< per element and corner pair 4 a + b: positions of the 3 x 3 block, -1: absent
};

/// A rod (or, with `geometric`, the massless cable in its place): its coordinates are part of the reduced unknowns z.
struct RodModel {
  std::string name;
  bool geometric = false;
  rod::Rod rod;
  rod::GeometricCable cable;  ///< if geometric
  Placement base;             ///< in the world at t = 0
  int frame = -1;
  int offset = 0;             ///< first of its coordinates in z
  int length_row = -1;        ///< row of a geometric cable's constant length
  double path_deviation = 0;  ///< [m] how far the rod's sections stay off the path they were laid along
  int coordinates() const { return geometric ? cable.coordinates() : rod.coordinates(); }
  double length() const { return geometric ? cable.length : rod.length(); }
};

/// A point of a solid on a rod: three rows, and its abscissa as an unknown unless it holds the tip.
struct PointModel {
  int rod = 0, solid = 0, coupling = 0;
  solid::EmbeddedPoint where;
  double abscissa = 0.0;  ///< [m] at t = 0
  bool anchor = false;    ///< holds the rod's tip: abscissa fixed
  int unknown = -1;       ///< of its abscissa in z; -1 for an anchor or a geometric cable
  int cable_point = -1;   ///< number on a geometric cable
  int row = 0;            ///< first of its three rows
};

struct ActuatorModel {
  std::string name;
  int rod = 0;
  Motion motion = Motion::translation;
  Driven driven = Driven::displacement;
  Drive drive;
  int unknown = 0;  ///< of its base coordinate in z
  int row = -1;     ///< if driven by displacement or angle
};

struct OutputModel {
  std::string name;
  int solid = -1, rod = -1;
  solid::EmbeddedPoint where;  ///< on the solid
  double abscissa = 0.0;       ///< on the rod
};

/// What `check` tells a person about one coupling.
struct CouplingFacts {
  int asked = 0, kept = 0, outside = 0;
  double farthest = 0.0;           ///< [m] largest distance of a point from the mesh
  std::vector<double> no_unknown;  ///< abscissae of points that touch no free unknown
  std::vector<double> redundant;   ///< abscissae of points that the kept ones of the same element already determine
};

struct Model {
  Scene scene;
  std::vector<SolidModel> solids;
  std::vector<RodModel> rods;
  std::vector<PointModel> points;
  std::vector<PointModel> dropped;  ///< asked for, but determined by others: no rows, only watched
  std::vector<ActuatorModel> actuators;
  std::vector<OutputModel> outputs;
  std::vector<CouplingFacts> couplings;
  std::vector<std::string> warnings;
  int reduced = 0;    ///< size of z: coordinates of all rods, then abscissae
  int rows = 0;       ///< multipliers
  double size = 0.0;  ///< [m] diagonal of everything at rest: the yardstick of lengths
};

using MeshReader = std::function<solid::Mesh(const std::filesystem::path&)>;

/// The only place that rejects a scene as a whole: throws InputError with the field's path, the value, the rule and the
/// remedy.
Model build(const Scene& scene, const MeshReader& read_mesh);

}  // namespace sinew
