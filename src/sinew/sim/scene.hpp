// The scene: plain data, what the user wrote, in SI. It is read from YAML by io/scene_file or filled in by hand, and is
// judged as a whole only by `build` (sim/model). Defaults stand here.
#pragma once

#include <Eigen/Core>
#include <array>
#include <filesystem>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "sinew/linalg/precision.hpp"
#include "sinew/solid/body.hpp"
#include "sinew/solid/laws.hpp"

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

/// Marks a motor of which the inverse problem is to find the command (`inverse` in a scene file).
struct Sought {};

/// A constant or table over time, set from outside, or sought.
using Drive = std::variant<Table, External, Sought>;

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

struct Sphere {
  Vec3 center = Vec3::Zero();  ///< [m]
  double radius = 0.0;         ///< [m] > 0
  In in = In::object;
};

struct Plane {
  Vec3 point = Vec3::Zero(), normal = Vec3::UnitX();  ///< [m], any length
  std::optional<double> within = {};                  ///< [m] to either side of it; 1e-6 of the body's diagonal
  In in = In::object;
};

/// Nodes by their number in the mesh file, from 0.
struct NodeNumbers {
  std::vector<int> numbers;
};

/// What a mesh file has given this name, or number.
struct GroupName {
  std::string name;
};

/// The whole boundary of a solid.
struct WholeSurface {};

/// Nodes of a solid: those inside, or of that name. A cell or a face belongs to a region with all its nodes, of a group
/// if the group has it.
using Region = std::variant<Box, Sphere, Plane, NodeNumbers, GroupName, WholeSurface>;

/// Nodes held by the solid's own frame (or the ground) or another one, which moves them.
struct Held {
  Region region;
  std::array<bool, 3> axes = {true, true, true};  ///< of the world
  std::optional<std::string> frame = {};          ///< none: the solid's own
};

/// Springs from the nodes of a region to where they are at rest, in the frame of the solid.
struct Spring {
  Region region;
  Vec3 stiffness = Vec3::Zero();  ///< [N/m] along the world's axes, all nodes together, >= 0
};

struct SolidMaterial {
  solid::Law law = solid::Corotational();
  double viscosity = 0.0;         ///< [Pa s] >= 0, of shear; 4/3 (1 + nu)^2 of it in extension
  std::optional<double> density;  ///< [kg/m^3] > 0; none: the solid's
};

/// Cells of another material than the rest.
struct SolidPart {
  Region region;
  SolidMaterial material;
};

/// Damping force = (mass M + stiffness K) v.
struct Rayleigh {
  double mass = 0.0;       ///< [1/s] >= 0
  double stiffness = 0.0;  ///< [s] >= 0
};

struct Solid {
  std::filesystem::path mesh;        ///< relative to the scene file
  double scale = 1.0;                ///< mesh units to m, > 0
  int order = 1;                     ///< 1: elements as the file has them; 2: its 4-node tetrahedra get 10 nodes
  Pose pose;                         ///< after scale
  std::optional<std::string> frame;  ///< attached to this frame
  SolidMaterial material;
  std::vector<SolidPart> parts;   ///< the last one that has a cell decides
  std::optional<double> mass;     ///< [kg] total, exactly one of mass and density
  std::optional<double> density;  ///< [kg/m^3]
  /// None: consistent where there are 10-node tetrahedra, whose weight no lumped matrix spreads right; else lumped.
  std::optional<solid::MassMatrix> mass_matrix = {};
  Rayleigh rayleigh;
  std::vector<Held> fixed;  ///< none needed where springs or couplings hold it
  std::vector<Spring> springs;
};

/// The six strains, in this order everywhere (NOTATION.md).
enum class Strain { torsion, bending_y, bending_z, elongation, shear_y, shear_z };

/// A dimension that may change linearly from the start of a part of a rod to its end.
struct Taper {
  double start = 0.0, end = 0.0;
  Taper() = default;
  Taper(double value) : start(value), end(value) {}  // NOLINT(google-explicit-constructor): a plain number is a Taper
  Taper(double from, double to) : start(from), end(to) {}
};

struct Circle {
  Taper radius;  ///< [m] > 0
};

struct Tube {
  Taper outer, inner;  ///< [m] radii, 0 < inner < outer
};

struct Ellipse {
  Taper y, z;  ///< [m] half axes along y and z of the cross-section, > 0
};

struct Rectangle {
  Taper y, z;  ///< [m] full sides along y and z of the cross-section, > 0
};

/// A section whose stiffness is known, from a measurement or another program.
struct GivenSection {
  Eigen::Matrix<double, 6, 6> stiffness = Eigen::Matrix<double, 6, 6>::Zero();  ///< [N m^2, N m, N], order of Strain
  double line_density = 0.0;                                                    ///< [kg/m] >= 0
  double radius = 0.0;                                                          ///< [m] > 0, drawn and of its inertia
};

using CrossSection = std::variant<Circle, Tube, Ellipse, Rectangle, GivenSection>;

/// Kelvin-Voigt damping may be given either way; both add up.
struct RodMaterial {
  double young = 0.0;      ///< [Pa] > 0
  double poisson = 0.0;    ///< in (-1, 0.5]
  double density = 0.0;    ///< [kg/m^3] >= 0
  double viscosity = 0.0;  ///< [Pa s] >= 0, of shear; three times as much in extension
  double damping = 0.0;    ///< [s] >= 0, damping over stiffness of every strain
};

/// A piece of a rod with its own cross-section and material; parts follow one another from base to tip.
struct RodPart {
  double to = 0.0;  ///< [m] abscissa of its end; the last one's is the rod's length
  CrossSection section = Circle{};
  RodMaterial material;  ///< not used by a given section, apart from damping
};

/// `cosserat`: the rod with its stiffness. `geometric`: a massless cable without stiffness through the sliding points.
enum class Cable { cosserat, geometric };

/// The stress-free shape of a rod: as laid along its path, straight, or given strains over the arc length (piecewise
/// linear between the abscissae, constant outside; one row: constant).
enum class Rest { path, straight };
struct RestStrains {
  std::vector<double> at;                            ///< [m] strictly increasing
  std::vector<Eigen::Matrix<double, 6, 1>> strains;  ///< as many; order of Strain [1/m, -]
};

/// How a rod lies when the run starts.
enum class Start {
  path,  ///< bent to its path, whatever its stress-free shape
  rest   ///< stress-free; of the path only the first point, its direction there and the length count
};

/// A direction of motion of a rod's base: along or about one axis of its rest frame.
enum class BaseAxis { x, y, z, turn_x, turn_y, turn_z };

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
  std::array<int, 6> order = {};  ///< Legendre order in a section of each strain, 0 (constant) to 5
  std::variant<Rest, RestStrains> rest = Rest::path;
  std::optional<Start> start;  ///< none: `rest` if strains are given, else `path`
  std::vector<BaseAxis> base;  ///< free motions of the base besides those its actuators drive; empty: clamped
  CrossSection section = Circle{};
  RodMaterial material;
  std::vector<RodPart> parts;  ///< instead of section and material
};

/// What holds the last point of a slide.
enum class AnchorTip { none, position, pose };

/// Points of the solid that stay on the rod's centreline and slide along it; the last one may hold its tip.
struct Slide {
  std::string rod;
  std::string solid;
  std::variant<int, std::vector<double>> points = 2;  ///< a count (equal arc length from base to tip), or abscissae [m]
  std::vector<Vec3> channel;  ///< instead of `points`: where the points are in the solid at rest [m], in its own frame;
                              ///< those beyond the rod's tip wait for it
  AnchorTip anchor_tip = AnchorTip::position;
  double friction = 0.0;        ///< Coulomb's coefficient between rod and channel, >= 0
  std::optional<double> reach;  ///< [m] how far outside the mesh a point may lie; 10 % of the body's diagonal
};

/// A material point of a rod held, along some axes and about some, by the ground, a frame, a solid, a rigid body or
/// another rod: where it is at the start of the run, relative to what holds it. The axes are those of the holder: the
/// world's (ground, solid, carried along with it), the frame's or the body's, or the other rod's cross-section.
struct Tie {
  std::string rod;
  std::optional<double> at;          ///< [m] abscissa; none: the tip
  std::optional<std::string> frame;  ///< at most one of frame, solid, body and other; none: the ground
  std::optional<std::string> solid;
  std::optional<std::string> body;                    ///< a rigid one
  std::optional<std::string> other;                   ///< another rod
  std::optional<double> other_at;                     ///< [m] abscissa on it; none: its tip
  std::array<bool, 3> along = {true, true, true};     ///< directions held
  std::array<bool, 3> about = {false, false, false};  ///< rotations held
  std::optional<double> reach;                        ///< as for Slide, with `solid`
};

/// Nodes of a solid that a rigid body carries: a plate, an end disc.
struct Glue {
  std::string solid, body;
  Region region;
};

using Coupling = std::variant<Slide, Tie, Glue>;

/// A massless tendon inside a rod, from the abscissa `from` to `to`, where it ends: at a distance from the centreline
/// and at an angle from the cross-section's y axis towards z. Both may change linearly along it: parallel, convergent
/// or helical. Friction-free.
struct Tendon {
  double from = 0.0;         ///< [m]
  std::optional<double> to;  ///< [m] none: the tip
  Taper distance;            ///< [m] >= 0
  Taper angle;               ///< [rad]
};

enum class Motion { translation, rotation };
enum class Driven { force, displacement, torque, angle };

/// Least and most of something.
struct Span {
  double least = -std::numeric_limits<double>::infinity(), most = std::numeric_limits<double>::infinity();
  /// How far a value is outside.
  double beyond(double value) const { return value < least ? least - value : value > most ? value - most : 0.0; }
};

/// What a motor can do, which the inverse problem keeps to. Of a motor that turns: torques, angles.
struct Limits {
  std::optional<Span> force;         ///< [N] or [N m]; none: cables and tendons only pull, others may do anything
  Span displacement;                 ///< [m] or [rad]
  std::optional<double> speed;       ///< [m/s] or [rad/s] > 0
  std::optional<double> force_rate;  ///< [N/s] or [N m/s] > 0
};

/// Moves a rod: its base along an axis (translation) or about one (rotation) of its rest frame, or a tendon in it.
/// Translation is along -x when no axis is given: a positive displacement pulls the rod out, a positive force pulls.
struct Actuator {
  std::string rod;
  Motion motion = Motion::translation;
  std::optional<int> axis;       ///< 0, 1, 2: along or about +x, +y, +z; none: along -x, about +x
  std::optional<Tendon> tendon;  ///< pulled instead of the base: force is its tension, displacement how far it is drawn
  Driven driven = Driven::displacement;
  Drive drive;  ///< [N], [m], [N m] or [rad]
  Limits limits;
  std::optional<double> preferred;  ///< [N] or [N m]: where targets leave a choice; none: as little as possible
};

/// Dead forces and pressure on a region of a solid.
struct SolidLoad {
  std::string solid;
  Region region;
  Vec3 force = Vec3::Zero();  ///< [N] in all, spread evenly over the region's part of the surface, or its nodes
  double pressure = 0.0;      ///< [Pa] against the region's part of the surface as it moves; negative: suction
  Drive factor = Table{{0.0}, {1.0}};
};

/// A dead or follower load on a rod.
struct RodLoad {
  std::string rod;
  std::optional<double> at;            ///< [m] abscissa of a point load; none: the tip
  std::optional<double> from, to;      ///< [m] both: a distributed load between these abscissae
  Vec3 force = Vec3::Zero();           ///< [N], distributed [N/m]
  Vec3 moment = Vec3::Zero();          ///< [N m], distributed [N]
  bool follower = false;               ///< in the axes of the cross-section (true) or of the world
  Drive factor = Table{{0.0}, {1.0}};  ///< both are multiplied by it [-]
};

using Load = std::variant<RodLoad, SolidLoad>;

/// What is recorded of a material point, of a solid (`point`) or a rod (`at`); `reaction`: the force with which a
/// solid's held nodes in `region` are held; `orientation`: how far it has turned since the start. Of a rigid body where
/// its centre of mass is, how it has turned, or the force of all that touches it. Of two objects (`between`) how they
/// touch (`touching`). sim/quantities.hpp lists what is known of what.
enum class Quantity { position, displacement, orientation, strain, force, moment, stress, reaction, touching };
struct Output {
  std::optional<std::string> solid;
  std::optional<std::string> rod;
  std::optional<std::string> body;
  std::vector<std::string> between;        ///< two names
  Point point;                             ///< on a solid
  std::optional<double> at;                ///< [m] abscissa on a rod
  std::optional<double> reach;             ///< as for Slide
  std::optional<Region> region;            ///< of a reaction; none: all
  Quantity quantity = Quantity::position;  ///< `between`: without meaning, it is `touching`
};

/// Numbers over time, piecewise linear, first and last held outside. What stands still has one time.
struct Track {
  std::vector<double> times;            ///< [s], strictly increasing
  std::vector<Eigen::VectorXd> values;  ///< at each time, one of each component
};

/// Where an output is to be. Motors that are `Sought` bring it there, or as near as they can.
struct Target {
  std::string output;                 ///< of `position`, `orientation` or `strain`, or between two
  std::variant<Track, External> at;   ///< [m], [rad], [1/m] or 1, normal force [N]
  Strain strain = Strain::bending_y;  ///< of an output of strain: which one
  std::vector<double> weights;        ///< of each component [-] >= 0; empty: 1. With 0 it may be anything
  std::optional<double> tolerance;    ///< reached if no further off; none: see sim/targets.hpp
};

/// Shapes of rigid bodies and obstacles, in their own axes with the middle at the origin.
struct BoxShape {
  Vec3 size = Vec3::Zero();  ///< [m] > 0, edges
};

struct SphereShape {
  double radius = 0.0;  ///< [m] > 0
};

/// About z.
struct CylinderShape {
  double radius = 0.0, length = 0.0;  ///< [m] > 0
};

/// All within `radius` of a segment along z.
struct CapsuleShape {
  double radius = 0.0;  ///< [m] > 0
  double length = 0.0;  ///< [m] > 0, of the segment, without the round ends
};

/// A closed surface of triangles, from a file. Its axes are the file's.
struct MeshShape {
  std::filesystem::path file;  ///< .stl or .obj, or a volume mesh, whose boundary is meant
  double scale = 1.0;          ///< what its coordinates are multiplied by to be in m
  bool hull = false;           ///< the smallest convex body around it instead
  double thickness = 0.0;      ///< [m] above 0: a sheet, met from both sides, with the surface in its middle
};

using BodyShape = std::variant<BoxShape, SphereShape, CylinderShape, CapsuleShape, MeshShape>;

/// A half-space, whose surface goes through a point. Of obstacles only.
struct PlaneShape {
  Vec3 point = Vec3::Zero(), normal = Vec3::UnitZ();  ///< [m]; outward, any length
};

/// A rigid body that moves freely but for what it touches.
struct RigidBody {
  BodyShape shape;
  Pose pose;
  std::optional<double> mass, density;  ///< [kg] or [kg/m^3] > 0, exactly one
  Vec3 velocity = Vec3::Zero();         ///< [m/s] at the start
  Vec3 spin = Vec3::Zero();             ///< [rad/s] at the start, axes of the world
};

/// Something rigid that stands still, or is carried by a frame.
struct Obstacle {
  std::variant<PlaneShape, BoxShape, SphereShape, CylinderShape, CapsuleShape, MeshShape> shape;
  Pose pose;
  std::optional<std::string> frame;
};

/// What holds for one pair of objects, by their names, instead of the rules of all. Solids and rods meet each other
/// only where a pair says so; a solid named twice meets itself.
struct ContactPair {
  std::string first, second;
  std::optional<double> friction, restitution;
  bool off = false;  ///< they pass through each other
};

/// Rigid bodies and obstacles stop each other, solids and rods.
struct Contact {
  double friction = 0.5;     ///< Coulomb's coefficient, >= 0
  double restitution = 0.0;  ///< Newton's, 0 to 1: how much of the speed of approach a hit gives back
  std::vector<ContactPair> pairs;
};

/// What is computed. `dynamic`: the motion; `quasi_static`: equilibrium at every time of the grid, without inertia and
/// damping; `static`: equilibrium at the end of the duration, followed from its start by as many load steps as needed,
/// past limit points too; `modal`: natural frequencies and modes about the equilibrium at the start.
enum class Analysis { dynamic, quasi_static, statics, modal };

/// What an equilibrium with contacts does where none goes on from it: `follow` what lets go to the next one, with a
/// warning; `stop`.
enum class Snap { follow, stop };

struct Time {
  double step = 0.01;     ///< [s] > 0
  double duration = 1.0;  ///< [s] >= 0
  double smallest = 0.0;  ///< [s] part of a step below which none is tried; 0: 1e-4 of it, a 64th of `newton: n`
};

/// How a step is solved.
struct Newton {
  int iterations = 0;       ///< 0: until the tolerance is met; n: exactly n linearisations (1 is the paper's step)
  int limit = 25;           ///< with iterations = 0: not converged beyond this, and the step is halved
  double tolerance = 1e-9;  ///< relative to the force and to the size of the scene (sim/step_ends `convergence_of`)
  /// In which the matrices of volumes are factored; solutions are refined to double precision.
  linalg::Precision precision = linalg::Precision::float64;
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
  Analysis analysis = Analysis::dynamic;
  Snap snap = Snap::follow;
  int modes = 6;  ///< of a modal analysis
  Newton newton;
  View view;
  Named<Frame> frames;
  Named<Solid> solids;
  Named<Rod> rods;
  Named<RigidBody> bodies;
  Named<Obstacle> obstacles;
  Contact contact;
  std::vector<Coupling> couplings;
  Named<Actuator> actuators;
  Named<Load> loads;
  Named<Output> outputs;
  std::vector<Target> targets;
};

}  // namespace sinew
