// The scene: plain data, what the user wrote, in SI. It is read from YAML by io/scene_file or filled in by hand, and is
// judged as a whole only by `build` (sim/model). Defaults stand here.
#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <variant>
#include <vector>

namespace sinew {

using Vec3 = Eigen::Vector3d;

/// R = Rz(c) Ry(b) Rx(a) with rotate = (a, b, c) [rad], then translate [m].
struct Pose {
  Vec3 rotate = Vec3::Zero();
  Vec3 translate = Vec3::Zero();
};

/// Piecewise linear in time, first and last value held outside. A constant is one row.
struct Table {
  std::vector<double> times;   ///< [s], strictly increasing, as many as values
  std::vector<double> values;  ///< [unit of what it drives]
};

/// Marks a quantity that the caller sets at every step (`external` in a scene file).
struct External {};

/// A constant or table over time, or set from outside.
using Drive = std::variant<Table, External>;

/// Moves a frame: piecewise linear in `rotate` and `translate`, applied in the world after `Frame::pose`.
struct FrameMotion {
  std::vector<double> times;    ///< [s], strictly increasing
  std::vector<Vec3> rotate;     ///< [rad], empty (none turned) or one per time
  std::vector<Vec3> translate;  ///< [m], empty (none moved) or one per time
};

/// A named frame that solids and rods can be attached to; it moves them with it.
struct Frame {
  Pose pose;                          ///< at rest
  std::optional<FrameMotion> motion;  ///< none: it stands still
};

/// Where coordinates are given: in the object's own frame before its pose, or in the world.
enum class In { object, world };

struct Point {
  Vec3 x = Vec3::Zero();  ///< [m]
  In in = In::object;
};

struct Box {
  Vec3 lower = Vec3::Zero(), upper = Vec3::Zero();  ///< [m], lower <= upper
  In in = In::object;
};

enum class Law { corotational };

struct SolidMaterial {
  Law law = Law::corotational;
  double young = 0.0;    ///< [Pa] > 0
  double poisson = 0.0;  ///< in (-1, 0.5)
};

/// Damping force = (mass M + stiffness K) v.
struct Rayleigh {
  double mass = 0.0;       ///< [1/s] >= 0
  double stiffness = 0.0;  ///< [s] >= 0
};

struct Solid {
  std::filesystem::path mesh;        ///< relative to the scene file
  double scale = 1.0;                ///< mesh units to m, > 0
  Pose pose;                         ///< after scale
  std::optional<std::string> frame;  ///< attached to this frame
  SolidMaterial material;
  std::optional<double> mass;     ///< [kg] total, exactly one of mass and density
  std::optional<double> density;  ///< [kg/m^3]
  Rayleigh rayleigh;
  std::vector<Box> fixed;  ///< nodes inside any of these are clamped to the frame (or the ground)
};

/// The six strains, in this order everywhere (NOTATION.md).
enum class Strain { torsion, bending_y, bending_z, elongation, shear_y, shear_z };

struct Circle {
  double radius = 0.0;  ///< [m] > 0
};

struct RodMaterial {
  double young = 0.0;    ///< [Pa] > 0
  double poisson = 0.0;  ///< in (-1, 0.5]
  double density = 0.0;  ///< [kg/m^3] >= 0
};

/// `cosserat`: the rod with its stiffness. `geometric`: a massless cable without stiffness through the sliding points.
enum class Cable { cosserat, geometric };

struct Rod {
  std::vector<Vec3> path;   ///< [m], from base to tip, at least two points
  In path_in = In::object;  ///< where `path` is given
  std::optional<Vec3> up;   ///< direction of the y axis of the base; world z, or y if the path starts along z
  Pose pose;
  std::optional<std::string> frame;  ///< its base is attached to this frame
  Cable cable = Cable::cosserat;
  std::variant<int, std::vector<double>> sections =
      1;  ///< a count (equal lengths), or ascending ends [m] from 0 to the length
  std::vector<Strain> strains = {Strain::torsion, Strain::bending_y, Strain::bending_z};
  Circle section;
  RodMaterial material;
};

enum class AnchorTip { none, position };

/// Points of the solid that stay on the rod's centreline and slide along it; the last one may hold its tip.
struct Slide {
  std::string rod;
  std::string solid;
  std::variant<int, std::vector<double>> points = 2;  ///< a count (equal arc length from base to tip), or abscissae [m]
  AnchorTip anchor_tip = AnchorTip::position;
  std::optional<double> reach;  ///< [m] how far outside the mesh a point may lie; 10 % of the body's diagonal
};

enum class Motion { translation, rotation };
enum class Driven { force, displacement, torque, angle };

/// Moves the base of a rod along -x (translation, > 0 pulls rod out) or about +x (rotation) of its rest frame.
struct Actuator {
  std::string rod;
  Motion motion = Motion::translation;
  Driven driven = Driven::displacement;
  Drive drive;  ///< [N], [m], [N m] or [rad]
};

/// A material point whose position is recorded: of a solid (`point`) or a rod (`at`).
struct Output {
  std::optional<std::string> solid;
  std::optional<std::string> rod;
  Point point;                  ///< on a solid
  std::optional<double> at;     ///< [m] abscissa on a rod
  std::optional<double> reach;  ///< as for Slide
};

struct Time {
  double step = 0.01;     ///< [s] > 0
  double duration = 1.0;  ///< [s] >= 0
};

/// How a step is solved.
struct Newton {
  int iterations = 0;       ///< 0: until the tolerance is met; n: exactly n linearisations (1 is the paper's step)
  int limit = 25;           ///< with iterations = 0: not converged beyond this, and the step is halved
  double tolerance = 1e-9;  ///< relative to the force and to the size of the scene (sim/step.hpp)
};

/// How often views are written.
struct View {
  double interval = 0.0;  ///< [s] between frames of the ParaView series; 0: at most about 100 frames a run
};

template <class T>
using Named = std::vector<std::pair<std::string, T>>;  ///< in the order of the file

struct Scene {
  std::string title;
  std::filesystem::path folder;  ///< meshes are looked up from here
  Time time;
  Vec3 gravity = Vec3::Zero();  ///< [m/s^2]
  Newton newton;
  View view;
  Named<Frame> frames;
  Named<Solid> solids;
  Named<Rod> rods;
  std::vector<Slide> couplings;
  Named<Actuator> actuators;
  Named<Output> outputs;
};

}  // namespace sinew
