#include <fmt/core.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <set>

#include "sinew/commands.hpp"
#include "sinew/error/input_error.hpp"
#include "sinew/io/mesh_file.hpp"
#include "sinew/runs/loaded_scene.hpp"
#include "sinew/sim/contacts.hpp"
#include "sinew/sim/first_step.hpp"
#include "sinew/sim/load_summary.hpp"
#include "sinew/sim/motors.hpp"
#include "sinew/sim/run.hpp"
#include "sinew/sim/sliding_rods.hpp"
#include "sinew/solid/mesh_order.hpp"
#include "sinew/solid/mesh_pieces.hpp"
#include "sinew/solid/mesh_summary.hpp"
#include "sinew/terminal.hpp"

namespace sinew::app {

namespace {

std::string list_mm(const std::vector<double>& values) {
  std::string text;
  for (std::size_t i = 0; i < values.size() && i < 12; ++i)
    text += fmt::format("{}{:.4g}", i ? ", " : "", 1e3 * values[i]);
  return text + (values.size() > 12 ? ", ..." : "") + " mm";
}

/// "856 tetrahedra, 120 hexahedra"
std::string list_cells(const std::map<solid::Kind, int>& kinds) {
  std::string text;
  for (const auto& [kind, count] : kinds) text += fmt::format("{}{} {}", text.empty() ? "" : ", ", count, plural(kind));
  return text;
}

void print_solid(const SolidModel& solid) {
  double volume = 0.0;
  for (double v : solid.body.volumes) volume += v;
  const Vec3 size = solid.body.rest.rowwise().maxCoeff() - solid.body.rest.rowwise().minCoeff();
  std::map<solid::Kind, int> kinds;
  for (const solid::Cell& cell : solid.body.cells) ++kinds[cell.kind];
  say("solid {}: {} nodes, {}, {} nodes fixed, {} unknowns\n", solid.name, solid.body.nodes(), list_cells(kinds),
      (solid.body.unknown.colwise().minCoeff().array() < 0).count(), solid.body.unknowns);
  say("  {:.4g} x {:.4g} x {:.4g} mm, {:.4g} cm^3, {:.4g} g ({:.4g} kg/m^3)\n", 1e3 * size.x(), 1e3 * size.y(),
      1e3 * size.z(), 1e6 * volume, 1e3 * solid.body.masses.sum(), solid.body.masses.sum() / volume);
  std::set<std::pair<double, double>> moduli;
  for (int cell = 0; cell < solid.body.elements(); ++cell) {
    const auto [mu, lambda] = solid::lame(solid.body.of(cell).law);
    const double young = mu * (3.0 * lambda + 2.0 * mu) / (lambda + mu), poisson = 0.5 * lambda / (lambda + mu);
    if (moduli.insert({young, poisson}).second)
      say("  Young's modulus {:.4g} kPa, Poisson's ratio {:.4g} at small strains\n", 1e-3 * young, poisson);
  }
}

void print_rod(const RodModel& model) {
  const rod::Rod& rod = model.rod;
  say("rod {}: {:.5g} mm, {} sections, {} coordinates\n", model.name, 1e3 * rod.length(), rod.count(),
      rod.coordinates());
  const rod::Vec6 stiffness = rod::stiffness_at(rod.profile, 0.0).diagonal();
  for (const rod::Mode& mode : rod.sections[0].modes) {
    if (mode.degree > 0) continue;
    say("  {:<10} stiffness {:.4g} {}{}\n", rod::kStrainNames[static_cast<std::size_t>(mode.strain)],
        stiffness[mode.strain], mode.strain < 3 ? "N m^2" : "N",
        stiffness == rod::Vec6(rod::stiffness_at(rod.profile, rod.length()).diagonal()) ? "" : " at the base");
  }
  double mass = 0.0;
  for (const auto& point : rod.masses) mass += point.mass;
  say("  mass {:.4g} g{}\n", 1e3 * mass, mass > 0.0 ? "" : " (density 0: no inertia, no weight)");
  if (model.path_deviation > 1e-9 * rod.length())
    say("  its sections stay within {:.3g} mm of the path\n", 1e3 * model.path_deviation);
}

void print(const Tie& tie, const CouplingFacts& facts) {
  const std::string holder = tie.solid   ? "solid " + *tie.solid
                             : tie.body  ? "body " + *tie.body
                             : tie.other ? "rod " + *tie.other
                             : tie.frame ? "frame " + *tie.frame
                                         : "the ground";
  say("rod {} held by {}\n", tie.rod, holder);
  if (facts.outside > 0)
    say("  the point lies {:.3g} mm outside the mesh and is tied to the nearest element\n", 1e3 * facts.farthest);
}

void print(const Glue& glue, const CouplingFacts& facts) {
  say("{} nodes of solid {} carried by body {}\n", facts.kept, glue.solid, glue.body);
}

/// What hangs on the sections and points of a rod that slides.
void print_sliding(const Model& model, int number, const Slide& slide) {
  const CouplingFacts& facts = model.couplings[number];
  if (const double equivalent = equivalent_sections(model, number); equivalent < kFewSections) {
    say("  {:.2g} sections of order {} between two points: where the rod bends while it slides, its own part of the "
        "force along it (M^2 / 2 B) swings by {:.2g} %\n",
        facts.sections, facts.order, 100.0 * ripple_of(equivalent));
  }
  if (slide.friction > 0.0 && std::isfinite(facts.spacing)) {
    say("  friction {:.3g}: a moment at an end of the channel rubs with {:.3g} N for each N m, in inverse proportion "
        "to the spacing of the points ({:.3g} mm)\n",
        slide.friction, slide.friction * pressed_by_moment(facts.spacing), 1e3 * facts.spacing);
  }
}

void print(const Slide& slide, const CouplingFacts& facts) {
  say("rod {} in solid {}: {} of {} points kept\n", slide.rod, slide.solid, facts.kept, facts.asked);
  if (facts.outside > 0) {
    say("  {} of {} lie outside the mesh, up to {:.3g} mm, and are tied to the nearest element\n", facts.outside,
        facts.asked, 1e3 * facts.farthest);
  }
  if (!facts.no_unknown.empty()) say("  dropped, nothing there can move: s = {}\n", list_mm(facts.no_unknown));
  if (!facts.redundant.empty())
    say("  dropped, the elements there already follow their other points: s = {}\n", list_mm(facts.redundant));
}

void print_coupling(const Model& model, std::size_t number) {
  say("coupling {}: ", number);
  std::visit([&](const auto& own) { print(own, model.couplings[number]); }, model.scene.couplings[number]);
  if (const Slide* const slide = std::get_if<Slide>(&model.scene.couplings[number]))
    print_sliding(model, static_cast<int>(number), *slide);
}

void print_load(const LoadSummary& load) {
  say("load {}: {}\n", load.name.substr(load.name.find('.') + 1), describe(load));
  if (load.faces == 0) return;
  const double rounding = 1e-9 * std::abs(load.pressure) * load.area;  // of a closed surface nothing is left
  const Vec3 sum = load.force.unaryExpr([rounding](double own) { return std::abs(own) > rounding ? own : 0.0; });
  say("  they add up to ({:.3g}, {:.3g}, {:.3g}) N\n", sum.x(), sum.y(), sum.z());
}

void print_contact(const Model& model) {
  for (const BodyModel& body : model.bodies) {
    const Vec3 size = 2e3 * contact::reach(body.shape, Eigen::Matrix3d::Identity());
    say("body {}: {:.4g} x {:.4g} x {:.4g} mm, {:.4g} g\n", body.name, size.x(), size.y(), size.z(),
        1e3 * body.body.mass);
  }
  for (const PairModel& pair : model.pairs) {
    say("contact of {} and {}: friction {:.4g}", name_of(model, pair.a), name_of(model, pair.b), pair.friction);
    say("{}\n", pair.restitution > 0.0 ? fmt::format(", restitution {:.4g}", pair.restitution) : "");
  }
}

}  // namespace

namespace {

/// At rest, the first step of the run must be able to solve its equations.
void check_first_solve(const runs::LoadedScene& loaded) {
  const Model& model = loaded.model;
  Workspace workspace(model);
  const FirstSolve first = begin_run(model, workspace);
  if (first.report.status != Status::singular) return;
  InputFault fault = {
      .file = loaded.file.path.string(),
      .line = 0,
      .path = "analysis",
      .value = loaded.file.scene.analysis == Analysis::modal ? "modal" : "",
      .rule = "cannot begin: " + (first.report.detail.empty() ? "nothing resists a motion" : first.report.detail),
      .remedy = "hold what can move, or see how it moves with `analysis: dynamic`"};
  if (!first.free.empty()) {
    const bool is_rod = first.free.front().object.kind == Collider::Kind::rod;
    fault.path = first.free.front().where + (is_rod ? ".base" : "");
    fault.rule = "at rest nothing resists motions of " + in_words(first.free);
    fault.remedy = is_rod ? "leave them out of `base`, hold them by a tie, or see how it moves with `analysis: dynamic`"
                          : "hold it by a tie or glue, or see how it moves with `analysis: dynamic`";
  }
  fault.line = io::line_of(loaded.file, fault.path);
  throw InputError(fault);
}

}  // namespace

int check_scene(const std::filesystem::path& scene, const std::vector<std::string>& overrides, bool strict) {
  const runs::LoadedScene loaded = runs::load(io::read_scene(scene, overrides));
  check_first_solve(loaded);
  const Model& model = loaded.model;
  switch (model.scene.analysis) {
    case Analysis::dynamic:
    case Analysis::quasi_static:
      say("{}: {} steps of {:.4g} ms{}\n", scene.string(), grid_steps(model.scene), 1e3 * model.scene.time.step,
          model.scene.analysis == Analysis::quasi_static ? ", an equilibrium at each" : "");
      break;
    case Analysis::statics:
      say("{}: the equilibrium under the loads of t = {:.4g} s\n", scene.string(), model.scene.time.duration);
      break;
    case Analysis::modal:
      say("{}: {} modes about the equilibrium of t = 0\n", scene.string(), model.scene.modes);
      break;
  }
  for (const SolidModel& solid : model.solids) print_solid(solid);
  for (const RodModel& rod : model.rods) print_rod(rod);
  for (const GeometricCableModel& cable : model.cables) {
    say("rod {}: a geometric cable of {:.5g} mm, without stiffness or mass\n", cable.name, 1e3 * cable.cable.length);
  }
  for (std::size_t i = 0; i < model.couplings.size(); ++i) print_coupling(model, i);
  for (const ActuatorModel& actuator : model.actuators) {
    const MotorWords words = words_of(actuator);
    say("actuator {}: {} of rod {}, driven by {}{}\n", actuator.name,
        actuator.tendon    ? "tendon"
        : actuator.turns() ? "rotation"
                           : "translation",
        actuator.line.rod >= 0 ? model.rods[actuator.line.rod].name : model.cables[actuator.line.cable].name,
        actuator.told_force() ? words.force : words.position,
        actuator.sought()                                  ? ", which is to be found"
        : std::holds_alternative<External>(actuator.drive) ? " from outside (0 in this program)"
                                                           : "");
  }
  for (const LoadModel& load : model.loads) print_load(summary_of(model, load));
  print_contact(model);
  for (const Warning& warning : model.warnings) say("warning: {}\n", to_string(warning));
  int unknowns = model.unknowns;
  for (const RodModel& rod : model.rods) unknowns += rod.rod.strain_coordinates();
  say("The scene is sound{}: {} unknowns of rods, points and bodies, {} constraint rows. Run it with: sinew run {} -o "
      "out\n",
      model.warnings.empty() ? "" : " but for what is warned of above", unknowns, model.rows, scene.string());
  return strict && !model.warnings.empty() ? kWarned : kDone;
}

namespace {

void suggest_scale(double diagonal) {
  if (diagonal > 10.0) say("  a diagonal above 10 suggests millimetres: use `scale: 0.001` in the scene\n");
}

/// What a scene warns of, or refuses.
void describe_pieces(const solid::Mesh& mesh) {
  const solid::Pieces pieces = solid::find_pieces(mesh.cells, mesh.nodes.cols());
  if (pieces.count > 1) say("  {} pieces that share no nodes\n", pieces.count);
  for (int piece = 0; piece < pieces.count && pieces.count > 1 && piece < 12; ++piece) {
    Eigen::AlignedBox3d box;
    for (Eigen::Index node = 0; node < mesh.nodes.cols(); ++node)
      if (pieces.of_node[static_cast<std::size_t>(node)] == piece) box.extend(mesh.nodes.col(node));
    say("    {} cells from [{:.6g}, {:.6g}, {:.6g}] to [{:.6g}, {:.6g}, {:.6g}]\n",
        std::count(pieces.of_cell.begin(), pieces.of_cell.end(), piece), box.min().x(), box.min().y(), box.min().z(),
        box.max().x(), box.max().y(), box.max().z());
  }
  if (const auto same = solid::coincident_nodes(mesh.nodes, mesh.cells); !same.empty())
    say("  {} nodes are at the place of another and not tied to it, the first {} and {}\n", same.size(),
        same.front()[0], same.front()[1]);
  if (const auto hanging = solid::hanging_nodes(mesh.nodes, mesh.cells, pieces); !hanging.empty())
    say("  {} nodes lie on faces of cells that do not have them, the first {}: a scene refuses this mesh\n",
        hanging.size(), hanging.front());
  for (const auto& [type, count] : mesh.simplified)
    say("  {} elements of type {} are read as plain ones\n", count, type);
  if (mesh.turned > 0) say("  {} elements, all of their kind, were inside out and are turned\n", mesh.turned);
}

int describe_surface(const std::filesystem::path& path, const solid::Mesh& mesh) {
  const contact::Mesh surface = contact::make_mesh(mesh.nodes, mesh.faces);
  const Vec3 lower = mesh.nodes.rowwise().minCoeff(), upper = mesh.nodes.rowwise().maxCoeff();
  say("{}: a surface of {} triangles, {} points\n", path.string(), mesh.faces.size(), surface.used.size());
  for (const auto& [kind, count] : mesh.ignored) say("  {} of kind {} are not used\n", count, kind);
  say("  from [{:.6g}, {:.6g}, {:.6g}] to [{:.6g}, {:.6g}, {:.6g}] (units of the file)\n", lower.x(), lower.y(),
      lower.z(), upper.x(), upper.y(), upper.z());
  if (const int open = contact::open_edges(mesh.faces); open > 0) {
    say("  {} edges where not exactly two triangles meet, turned the same way: bodies take it with "
        "`hull: true`, or as a sheet with its `thickness`\n",
        open);
  } else {
    const double volume = contact::bulk(surface).volume;
    say("  closed, volume {:.6g}{}\n", volume, volume < 0.0 ? ": it is inside out" : "");
  }
  suggest_scale((upper - lower).norm());
  return kDone;
}

}  // namespace

int describe_mesh(const std::filesystem::path& path) {
  const solid::Mesh mesh = io::read_mesh(path);
  if (mesh.cells.empty()) return describe_surface(path, mesh);
  const solid::MeshSummary s = solid::summarize(mesh);
  say("{}: {} nodes, {}\n", path.string(), s.nodes, list_cells(s.kinds));
  for (const auto& [kind, count] : s.ignored) say("  {} cells of kind {} are not used\n", count, kind);
  if (s.unused_nodes > 0) say("  {} nodes belong to no cell\n", s.unused_nodes);
  for (const auto& [name, group] : mesh.groups) {
    say("  group {}: {} cells, {} faces, {} nodes\n", name, group.cells.size(), group.faces.size(), group.nodes.size());
  }
  say("  from [{:.6g}, {:.6g}, {:.6g}] to [{:.6g}, {:.6g}, {:.6g}], diagonal {:.6g} (units of the file)\n", s.lower.x(),
      s.lower.y(), s.lower.z(), s.upper.x(), s.upper.y(), s.upper.z(), s.diagonal);
  say("  volume {:.6g}; cells from {:.3g} to {:.3g}; worst shape {:.3g} of 1 (cell {} near {:.4g}, {:.4g}, {:.4g})\n",
      s.volume, s.smallest, s.largest, s.worst_quality, s.worst_cell, s.worst_centre.x(), s.worst_centre.y(),
      s.worst_centre.z());
  if (const int meeting = solid::meeting_orders(mesh.cells); meeting > 0)
    say("  {} 4-node tetrahedra meet 10-node ones: in a scene all are raised to 10 nodes\n", meeting);
  if (const auto pair = solid::mismatched_faces(mesh.cells))
    say("  cells {} and {} are not tied where a hexahedron's face meets triangles: a scene refuses this mesh\n",
        pair->front(), pair->back());
  if (const auto pair = solid::mismatched_edges(mesh.cells))
    say("  cells {} and {} have different nodes in the middle of an edge: a scene refuses this mesh\n", pair->front(),
        pair->back());
  describe_pieces(mesh);
  suggest_scale(s.diagonal);
  return kDone;
}

int print_schema() {
  say("{}\n", io::scene_schema());
  return kDone;
}

}  // namespace sinew::app
