// The parts of build(): each judges one kind of object of a scene and adds it to the model. Only sim/build_*.cpp,
// sim/model.cpp and sim/solid_matrix.cpp include this.
#pragma once

#include <optional>
#include <string>

#include "sinew/error/input_error.hpp"
#include "sinew/rod/kinematics.hpp"
#include "sinew/sim/state.hpp"

namespace sinew::building {

/// Numbers and vectors as messages show them.
std::string text(double value);
std::string text(const Vec3& v);

/// Throws InputError about a field.
[[noreturn]] void reject(const std::string& path, const std::string& value, const std::string& rule,
                         const std::string& remedy);
void require_positive(double value, const std::string& path, const std::string& remedy);
void require_not_negative(double value, const std::string& path, const std::string& remedy);

/// Number of the entry of this name, or a rejection that lists the known ones.
template <class T>
int find(const Named<T>& entries, const std::string& name, const std::string& path, const std::string& kind) {
  std::string known;
  for (std::size_t i = 0; i < entries.size(); ++i) {
    if (entries[i].first == name) return static_cast<int>(i);
    known += (known.empty() ? "" : ", ") + entries[i].first;
  }
  reject(path, name, "no " + kind + " of this name", known.empty() ? "the scene has no " + kind : "known: " + known);
}

/// Obstacle, body, solid or rod of this name.
Collider find_collider(const Model& model, const std::string& name, const std::string& path);

int find_frame(const Scene& scene, const std::optional<std::string>& name, const std::string& path);

/// The frame's placement at t = 0, after the object's own pose.
Placement stand(const Scene& scene, int frame, const Pose& pose);

/// Lengths beyond these bounds are a slip of units; their squares may not even be numbers.
constexpr double kSmallest = 1e-9, kLargest = 1e6;  // [m]
void require_size(double value, const std::string& path);

/// What a region holds of a solid; rejected if that is no node.
struct Selection {
  std::vector<int> nodes, cells;
  std::vector<solid::CellFace> faces;  ///< of the boundary, outward
};
Selection select(const SolidModel& solid, const Region& region, const std::string& path);
/// The same of what is loaded or sprung: a group of faces none of which is on the boundary is rejected, too.
Selection select_loaded(const SolidModel& solid, const Region& region, const std::string& path);

/// How all nodes of the solid share what acts on a selection: over its faces or, if it has none, equally over its
/// nodes. `evenly`: as a force per area does, at the corners of faces of 6 nodes nothing or less. `lumped`: all above
/// zero.
enum class Spread { evenly, lumped };
/// Adds up to 1.
Eigen::VectorXd shares(const SolidModel& solid, const Selection& selection, Spread spread);

/// Reads a mesh of a scene. What is wrong inside it carries the mesh's own file and line; a path that leads nowhere is
/// the fault of the field `path`.
solid::Mesh read_named(const Scene& scene, const MeshReader& read_mesh, const std::filesystem::path& file,
                       const std::string& path);

/// Warns of a mesh so large [m] that its file is likely to be in millimetres.
void warn_of_scale(double size, double scale, const std::string& path, std::vector<Warning>& warnings);

SolidModel build_solid(const Scene& scene, const std::string& name, const Solid& solid, const MeshReader& read_mesh,
                       std::vector<Warning>& warnings);
RodModel build_rod(const Scene& scene, const std::string& name, const Rod& rod);
GeometricCableModel build_cable(const Scene& scene, const std::string& name, const Rod& rod);

void build_body(Model& model, const std::string& name, const RigidBody& body, const MeshReader& read_mesh);
void build_obstacle(Model& model, const std::string& name, const Obstacle& obstacle, const MeshReader& read_mesh);
/// Which objects stop each other, once all are there.
void build_pairs(Model& model);

/// The points of the path of a rod, judged, in the world.
std::vector<Vec3> path_in_world(const Scene& scene, int frame, const Rod& rod, const std::string& path);

/// Frees a motion of the base; false if it is free already. Translations stand before turns.
bool add_base_motion(RodModel& model, const rod::BaseMotion& motion);

/// Number of a rod or cable by name.
Line find_line(const Model& model, const std::string& name, const std::string& path);
/// The same, but a cable is refused: it has no material points.
int find_rod(const Model& model, const std::string& name, const std::string& path);

double length_of(const Model& model, const Line& line);

/// An abscissa on a rod: given, or the tip; rejected outside.
double abscissa_on(const Model& model, int rod, const std::optional<double>& at, const std::string& path);

/// The abscissae of a piece of a rod, one end given or the rod's own; rejected unless `to` is beyond `from`.
struct Stretch {
  double from = 0.0, to = 0.0;
};
Stretch stretch_on(const Model& model, int rod, const std::optional<double>& from, const std::optional<double>& to,
                   const std::string& path, const std::string& remedy);

/// That its sections and strains can follow its path: warns where it starts beside it, and refuses where it is far off.
void check_path(const Scene& scene, const std::string& name, const Rod& rod, const RodModel& built,
                std::vector<Warning>& warnings);

/// A rod at the start of the run.
rod::Configuration start_shape(const RodModel& rod);

/// The element that carries x, rejected beyond the reach.
solid::EmbeddedPoint embed_within(const SolidModel& solid, const Vec3& x, const std::optional<double>& reach,
                                  const std::string& path, const std::string& what);
/// Whether a point lies outside its mesh by more than the rounding of coordinates, 1e-6 of the mesh's size.
inline bool lies_outside(const SolidModel& solid, const solid::EmbeddedPoint& point) {
  return point.distance > 1e-6 * solid.mesh.diagonal;
}

/// A table must have as many times as values.
void check_drive(const Drive& drive, const std::string& path);

/// Warns of tables that go up and down between two steps, and of frames that turn far in one.
void warn_of_tables(Model& model);

/// Statics needs bodies that something holds; in motion they may fly, which is warned of.
void check_held(Model& model, int number);

/// One for each kind.
void build_coupling(Model& model, int number, const Slide& slide);
void build_coupling(Model& model, int number, const Tie& tie);
void build_coupling(Model& model, int number, const Glue& glue);
/// How the points of all couplings stand along rods.
void arrange_slides(Model& model);
void build_actuator(Model& model, const std::string& name, const Actuator& actuator);
void build_load(Model& model, const std::string& name, const Load& load);
void build_output(Model& model, const std::string& name, const Output& output);
void build_target(Model& model, int number);
/// Targets and sought actuators need each other.
void check_targets(const Model& model);
/// Of numbers that look as if their unit was forgotten, once everything is known.
void warn_of_units(Model& model);

/// Model::bearing: Young's moduli times areas, E A and E I / L^2 of rods, forces of loads and actuators, weights, and
/// masses times the size of the scene over h^2. Forces of constraints far beyond are those of rows that nothing
/// answers.
void measure_bearing(Model& model);
/// Rows that say the same, or contradict each other, where the robot starts; warns of them.
void look_for_redundant_rows(Model& model, const State& start);

/// Ties the axes of a rod's cross-section to the solid that holds it, position left to others.
void tie_axes(Model& model, int coupling, int rod, double s, int solid, const Vec3& point,
              const solid::EmbeddedPoint& where, const std::vector<int>& along, const std::vector<int>& about);

}  // namespace sinew::building
