// The model: a scene that has been judged, turned into bodies, rows and numbers. Immutable; a step only reads it.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "sinew/contact/shape.hpp"
#include "sinew/contact/tree.hpp"
#include "sinew/error/warning.hpp"
#include "sinew/linalg/sparse_factor.hpp"
#include "sinew/rigid/body.hpp"
#include "sinew/rod/geometric_cable.hpp"
#include "sinew/rod/rod.hpp"
#include "sinew/rod/tendon.hpp"
#include "sinew/sim/placement.hpp"
#include "sinew/sim/scene.hpp"
#include "sinew/solid/body.hpp"
#include "sinew/solid/embedding.hpp"

namespace sinew {

/// Where regions of a solid are looked up.
struct PlacedMesh {
  Eigen::Matrix3Xd object;                     ///< [m] its nodes before the pose; in the world: Body::rest
  std::vector<int> number;                     ///< of the nodes of the file: ours, or -1 where no cell uses it
  std::vector<solid::CellFace> boundary;       ///< outward
  std::map<std::string, solid::Group> groups;  ///< in our numbers
  std::map<std::string, int> ignored;          ///< cells of the file that are not used, by kind
  double diagonal = 0.0;                       ///< [m]
};

/// Where the 3 x 3 entries of two nodes go among the numbers of a volume's factor (linalg/fronts): entry (i, j) at
/// `at` + i + 4 j, turned at `at` + j + 4 i. What is held goes where nothing is read.
struct BlockPlace {
  std::uint32_t at : 31 = 0;
  std::uint32_t turned : 1 = 0;
};

/// Where an entry of the mass matrix goes: three times onto the diagonal of the block of its nodes.
struct MassPlace {
  std::uint32_t at = 0;  ///< of the block, as BlockPlace
  double mass = 0.0;     ///< [kg] that entry, a copy
};

/// A volume, where it is attached, and how its matrix is factored.
struct SolidModel {
  std::string name;
  solid::Body body;
  PlacedMesh mesh;
  std::vector<solid::Triangle> surface;
  contact::Mesh skin;                 ///< the same, at rest, if something may touch it
  int frame = -1;                     ///< number of its frame, -1: the ground
  Eigen::Array3Xi carrier;            ///< per axis and node, of held coordinates: number of the frame that holds it
  Eigen::Matrix3Xd springs;           ///< [N/m] per node and axis
  std::vector<int> rows;              ///< numbers of the solid rows on it
  std::vector<int> watched;           ///< and of the watched points
  linalg::SparseFactor::Rows border;  ///< H: three rows for each of them, watched points last, over its unknowns
  std::shared_ptr<const linalg::Fronts> fronts;
  std::vector<BlockPlace> places;              ///< of every element's blocks on and below its diagonal, row by row
  std::vector<std::size_t> first_place;        ///< per element
  std::vector<solid::TetPlaces> batch_places;  ///< of every batch's, none of which is turned
  std::vector<MassPlace> mass_places;          ///< of the mass matrix's lower triangle, but for what is held
  std::vector<std::uint32_t> node_places;      ///< of every node's block on the diagonal; 0 where it is held
  int held() const { return 3 * body.nodes() - body.unknowns; }
};

/// A Cosserat rod. Its strains are eliminated in every step; the coordinates of its base are unknowns z.
struct RodModel {
  std::string name;
  rod::Rod rod;
  Placement base;  ///< in the world at t = 0
  int frame = -1;
  bool floats = false;    ///< the base turns freely in all three directions: turns are counted from the last step on
  int unknown = 0;        ///< first of its base's coordinates in z
  int jumps = 0;          ///< places, at most, where its internal forces jump
  Eigen::VectorXd start;  ///< coordinates at t = 0
  std::vector<double> touching;  ///< [m] abscissae that may touch something
  std::vector<int> slides;       ///< points that slide on it, by their abscissae at t = 0
  double path_deviation = 0;     ///< [m] how far the rod's sections stay off the path they were laid along
};

/// The massless cable without stiffness, the paper's baseline: all its coordinates are unknowns z.
struct GeometricCableModel {
  std::string name;
  rod::GeometricCable cable;
  std::vector<Vec3> path;  ///< [m] in the world at t = 0
  Placement base;
  int frame = -1;
  int unknown = 0;      ///< first of its coordinates in z
  int length_row = -1;  ///< row of its constant length
};

/// A rigid body: its place and its turn are unknowns z.
struct BodyModel {
  std::string name;
  rigid::Body body;
  contact::Shape shape;                  ///< in axes at the centre of mass
  std::vector<contact::Simplex> prongs;  ///< of the shape
  rigid::Motion start;
  int unknown = 0;  ///< first of six in z: displacement and turn in the world's axes
};

/// What stands still, or is carried by a frame.
struct ObstacleModel {
  std::string name;
  contact::Shape shape;
  std::vector<contact::Simplex> prongs;  ///< of the shape
  Placement pose;                        ///< in the world at t = 0
  int frame = -1;
};

/// Something that can be touched, by its kind and its number among that.
struct Collider {
  enum class Kind { obstacle, body, solid, rod };
  Kind kind = Kind::obstacle;
  int number = 0;
  bool operator==(const Collider&) const = default;
};

/// Two that stop each other.
struct PairModel {
  Collider a, b;
  double friction = 0.0, restitution = 0.0;
  double depth = 0.0;   ///< [m] up to which they are met where they overlap, if they do at the start; 0: little
  bool sought = false;  ///< a target says how hard they are to press: they are watched from further away
};

/// A rod or a cable by its number among its kind.
struct Line {
  int rod = -1, cable = -1;
  bool operator==(const Line&) const = default;
};

/// A point of a solid on a rod or cable: three rows, and its abscissa as an unknown unless it is fixed there.
struct PointModel {
  Line line;
  int solid = 0, coupling = 0;
  solid::EmbeddedPoint where;
  double abscissa = 0.0;  ///< [m] at t = 0; beyond the tip: it waits for it
  bool fixed = false;     ///< to the rod's material: an anchor
  int unknown = -1;       ///< of its abscissa in z; -1 if fixed or on a cable
  double friction = 0.0;  ///< Coulomb's coefficient of rod and channel
  int cable_point = -1;   ///< number on a cable
  int row = 0;            ///< first of its three rows
};

/// Three rows that a solid takes part in: a material point or, with weights that sum to zero, a vector carried with it.
struct SolidRow {
  int solid = 0;
  solid::EmbeddedPoint where;
  int row = 0;
  int point = -1;           ///< the sliding point or anchor they belong to; they are off while it is
  int unknown = -1;         ///< or the three unknowns z that they hold to it, for a tie
  int body = -1;            ///< or the rigid body that carries it
  Vec3 arm = Vec3::Zero();  ///< [m] from its centre of mass, in its axes
};

/// A material point of a rod held by the ground, a frame, a solid, a rigid body or another rod (sim/ties.cpp).
struct TieModel {
  int rod = 0, coupling = 0;
  double s = 0.0;                                ///< [m]
  Placement holder;                              ///< axes of the holder and the point held, at t = 0 in the world
  int frame = -1;                                ///< of a holder that is no body
  int solid = -1, rigid = -1, other = -1;        ///< or a body
  double other_s = 0.0;                          ///< [m] abscissa on the other rod
  Vec3 other_offset = Vec3::Zero();              ///< [m] of the point held, in the other rod's cross-section or the
                                                 ///< rigid body's axes, from its centre of mass
  rod::Mat3 other_axes = rod::Mat3::Identity();  ///< the holder's axes there
  rod::Mat3 own_axes = rod::Mat3::Identity();    ///< the holder's axes in this rod's cross-section, at t = 0
  std::vector<int> along, about;
  double length = 0.0;  ///< [m] of the directors, so that all rows are lengths
  int row = 0;          ///< first of its rows: along, then about
  int unknown = -1;     ///< of a body: place of the point held (3) and, with `directors`, of its axes (9)
  bool directors = false;
  int body_row = -1;  ///< first of the rows that hold these unknowns to it
  bool body() const { return solid >= 0 || rigid >= 0 || other >= 0; }
};

struct ActuatorModel {
  std::string name;
  Line line;
  Driven driven = Driven::displacement;
  Drive drive;
  std::optional<rod::Tendon> tendon;     ///< pulled instead of the base
  double tendon_length = 0.0;            ///< [m] at t = 0
  int axis = -1;                         ///< of its base's motion
  int unknown = -1;                      ///< of its base coordinate in z
  int row = -1;                          ///< if told a position: holds it there
  Span force, position;                  ///< [N], [m], [N m], [rad] what it can do
  double speed = 0.0, force_rate = 0.0;  ///< how fast, each may be infinite
  double preferred = 0.0;                ///< [N] or [N m] where targets leave a choice
  bool sought() const { return std::holds_alternative<Sought>(drive); }
  bool turns() const { return driven == Driven::torque || driven == Driven::angle; }
  bool told_force() const { return driven == Driven::force || driven == Driven::torque; }  ///< or a position
};

/// Forces on material points of a rod.
struct RodLoadModel {
  struct At {
    double s = 0.0;       ///< [m]
    double weight = 1.0;  ///< [m] of a distributed load
  };
  int rod = 0;
  std::vector<At> at;
  Vec3 force = Vec3::Zero(), moment = Vec3::Zero();  ///< [N], [N m], or per metre
  bool follower = false;
  bool concentrated() const { return at.size() == 1; }
};

/// Forces on the nodes of a solid, dead or by pressure on faces of its boundary.
struct SolidLoadModel {
  int solid = 0;
  Eigen::Matrix3Xd force;                            ///< [N] per node; empty: none
  double pressure = 0.0;                             ///< [Pa]
  std::vector<solid::CellFace> faces;                ///< under it
  std::vector<BlockPlace> places;                    ///< of the faces' tangents in the solid's factor, face by face
  std::vector<int> rim;                              ///< unknowns of the faces' rim where that is free, ascending
  bool conservative() const { return rim.empty(); }  ///< it has a potential, its tangent is symmetric
};

struct LoadModel {
  std::string name;
  Drive factor;  ///< of all its forces
  std::variant<RodLoadModel, SolidLoadModel> on;
};

/// A point of a solid, or a vector carried with it, whose motion a step tells besides its solution: three rows beside
/// those of couplings, without multipliers.
struct WatchedPoint {
  int solid = 0;
  solid::EmbeddedPoint where;
};

struct OutputModel {
  std::string name;
  int solid = -1, rod = -1, body = -1, pair = -1;
  bool turned = false;         ///< of a pair: its second is the one whose force is told
  solid::EmbeddedPoint where;  ///< on the solid
  double abscissa = 0.0;       ///< on the rod
  std::vector<bool> nodes;     ///< of the solid, that a reaction is summed over
  Quantity quantity = Quantity::position;
  std::array<solid::EmbeddedPoint, 3> axes;   ///< of an orientation on a solid: columns of F
  rod::Mat3 upright = rod::Mat3::Identity();  ///< and of any: how it is turned at the start
};

/// What is to be brought somewhere: an output, its components and what counts as there.
struct EffectorModel {
  int output = 0;
  int first = 0, size = 3;  ///< its components among those of all effectors
  int strain = 0;           ///< of an output of strain: which of the six
  Eigen::VectorXd weights;  ///< per component: errors are weighed in units of 1 mm, 1 deg, 1/m, 1 % [1/SI]
  double tolerance = 0.0;   ///< [SI] of the length of what is off, where weights are not 0
  int watched = -1;         ///< first of its watched points, on a solid
  Eigen::VectorXd start;    ///< [SI] where it is at t = 0
};

/// Rows that depend on each other at the start of a run (sim/redundancy).
struct RedundantGroup {
  std::vector<int> rows;  ///< of lambda, ascending
  Eigen::VectorXd norms;  ///< of the rows there, 1 of those that nothing answers
  Eigen::MatrixXd null;   ///< combinations that nothing answers there, of rows over these: orthonormal columns
  double give = 0.0;      ///< [m/N] compliance of what would answer them, if the rods could stretch
  /// Where commands alone say what the rows ask for (no motor chooses): the same combinations of the
  /// rows as they are, with norm 1. What contradicts them is no matter of posture, and nothing gives way.
  Eigen::MatrixXd told;
};

/// What `check` tells a person about one coupling.
struct CouplingFacts {
  int rod = -1;  ///< or a cable:
  int cable = -1;
  int asked = 0, kept = 0, outside = 0;
  double farthest = 0.0;           ///< [m] largest distance of a point from the mesh
  double spacing = INFINITY;       ///< [m] between neighbouring sliding points, the smallest
  double sections = INFINITY;      ///< of the rod between two of them, where these are the fewest
  int order = 0;                   ///< of the bending strains there
  std::vector<double> no_unknown;  ///< abscissae of points that touch no free unknown
  std::vector<double> redundant;   ///< abscissae of points that the kept ones of the same element already determine
};

struct Model {
  Scene scene;
  std::vector<SolidModel> solids;
  std::vector<RodModel> rods;
  std::vector<GeometricCableModel> cables;
  std::vector<BodyModel> bodies;
  std::vector<ObstacleModel> obstacles;
  std::vector<PairModel> pairs;
  std::vector<int> rubbing;  ///< points with friction
  std::vector<PointModel> points;
  std::vector<PointModel> dropped;  ///< asked for, but determined by others or by what is held: no rows, only watched
  std::vector<TieModel> ties;
  std::vector<SolidRow> solid_rows;
  std::vector<EffectorModel> effectors;
  std::vector<WatchedPoint> watched;
  std::vector<int> sought;  ///< actuators that bring effectors to their targets
  std::vector<ActuatorModel> actuators;
  std::vector<LoadModel> loads;
  std::vector<OutputModel> outputs;
  std::vector<CouplingFacts> couplings;
  std::vector<Warning> warnings;          ///< of the scene
  std::vector<RedundantGroup> redundant;  ///< rows that depend on each other at the start
  int unknowns = 0;  ///< size of z: coordinates of bases, cables and rigid bodies, abscissae, what ties follow
  int first_followed = 0, followed = 0;  ///< of the latter among them
  Eigen::VectorXd arms;                  ///< per unknown z: [m] by which a moment is compared with forces, 1 of forces
  int rows = 0;                          ///< multipliers
  double start_energy = 0.0;             ///< [J] stored at t = 0, in rods that do not lie at rest
  std::vector<Eigen::Matrix3Xd> start_masses;  ///< [m] mass points of each rod at t = 0
  double size = 0.0;                           ///< [m] diagonal of everything at rest: the yardstick of lengths
  Vec3 middle = Vec3::Zero();                  ///< [m] of it
  double bearing =
      0.0;  ///< [N] what its bodies may bear at most: stiffness times size, loads, what stops them in a step
};

using MeshReader = std::function<solid::Mesh(const std::filesystem::path&)>;

/// The only place that rejects a scene as a whole: throws InputError with the field's path, the value, the rule and the
/// remedy.
Model build(const Scene& scene, const MeshReader& read_mesh);

}  // namespace sinew
