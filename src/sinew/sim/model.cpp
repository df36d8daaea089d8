#include "sinew/sim/model.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "sinew/sim/building.hpp"
#include "sinew/sim/contact_places.hpp"
#include "sinew/sim/contacts.hpp"
#include "sinew/sim/places.hpp"
#include "sinew/sim/signals.hpp"
#include "sinew/sim/solid_matrix.hpp"
#include "sinew/sim/targets.hpp"

namespace sinew {

using namespace building;  // the parts

namespace {

/// A geometric cable runs through its points in the order of their abscissae, whatever couplings they belong to. Its
/// length is that of the polyline, which cuts the corners of a curved path.
void number_cable_points(Model& model, int number) {
  GeometricCableModel& cable = model.cables[number];
  std::vector<PointModel*> points;
  for (PointModel& point : model.points) {
    if (point.line.cable == number) points.push_back(&point);
  }
  if (points.empty()) {
    reject("rods." + cable.name + ".cable", "geometric", "a geometric cable needs a coupling that it runs through",
           "add `slide: {rod: " + cable.name + ", ...}` or use `cable: cosserat`");
  }
  const bool held = std::any_of(model.actuators.begin(), model.actuators.end(),
                                [number](const ActuatorModel& actuator) { return actuator.line.cable == number; });
  if (!held) {
    reject("rods." + cable.name + ".cable", "geometric", "a geometric cable needs an actuator that holds its base",
           "add one with `displacement: 0 mm`, or use `cable: cosserat`");
  }
  std::stable_sort(points.begin(), points.end(),
                   [](const PointModel* a, const PointModel* b) { return a->abscissa < b->abscissa; });
  cable.cable.points = static_cast<int>(points.size());
  cable.cable.rounding = 1e-5 * cable.cable.length;
  Eigen::VectorXd z = Eigen::VectorXd::Zero(cable.cable.coordinates());
  for (std::size_t k = 0; k < points.size(); ++k) {
    points[k]->cable_point = static_cast<int>(k);
    const solid::Body& body = model.solids[points[k]->solid].body;
    z.segment<3>(static_cast<Eigen::Index>(1 + 3 * k)) = solid::position(points[k]->where, body.cells, body.rest);
  }
  cable.cable.length = rod::cable_length(cable.cable, cable.base, z).value;
}

/// Rows and unknowns of ties, and the list of all rows of solids: what ties follow first, then sliding points.
void number_ties(Model& model) {
  model.first_followed = model.unknowns;
  std::vector<SolidRow> rows;
  // Those that ties asked for, in their order, then what is glued.
  std::stable_partition(model.solid_rows.begin(), model.solid_rows.end(),
                        [](const SolidRow& row) { return row.body < 0; });
  std::size_t next = 0;
  for (TieModel& tie : model.ties) {
    tie.row = model.rows;
    model.rows += static_cast<int>(tie.along.size() + tie.about.size());
    if (!tie.body()) continue;
    const int groups = tie.directors ? 4 : 1;  // the point, and its axes
    tie.unknown = model.unknowns;
    model.unknowns += 3 * groups;
    tie.body_row = model.rows;
    for (int k = 0; k < groups; ++k, model.rows += 3) {
      if (tie.solid < 0) continue;
      SolidRow row = model.solid_rows[next++];
      row.row = model.rows;
      row.unknown = tie.unknown + 3 * k;
      rows.push_back(row);
    }
  }
  model.followed = model.unknowns - model.first_followed;
  for (; next < model.solid_rows.size(); ++next, model.rows += 3) {
    rows.push_back(model.solid_rows[next]);
    rows.back().row = model.rows;
  }
  model.solid_rows = std::move(rows);
  for (std::size_t k = 0; k < model.points.size(); ++k) {
    SolidRow row;
    row.solid = model.points[k].solid;
    row.where = model.points[k].where;
    row.row = model.points[k].row;
    row.point = static_cast<int>(k);
    model.solid_rows.push_back(row);
  }
}

/// Numbers of all unknowns of the border and of all rows.
void number_unknowns(Model& model) {
  for (RodModel& rod : model.rods) {
    rod.unknown = model.unknowns;
    const int nb = rod.rod.base_coordinates();
    model.unknowns += nb;
    rod.floats = std::count_if(rod.rod.base.begin(), rod.rod.base.end(), [](const auto& b) { return b.turns; }) == 3;
  }
  for (std::size_t i = 0; i < model.cables.size(); ++i) {
    number_cable_points(model, static_cast<int>(i));
    GeometricCableModel& cable = model.cables[i];
    cable.unknown = model.unknowns;
    model.unknowns += cable.cable.coordinates();
    cable.length_row = model.rows++;
  }
  for (BodyModel& body : model.bodies) {
    body.unknown = model.unknowns;
    model.unknowns += 6;
  }
  for (PointModel& point : model.points) {
    point.row = model.rows;
    model.rows += 3;
    if (!point.fixed && point.cable_point < 0) point.unknown = model.unknowns++;
    if (point.unknown >= 0 && point.friction > 0.0)
      model.rubbing.push_back(static_cast<int>(&point - model.points.data()));
  }
  for (ActuatorModel& actuator : model.actuators) {
    const bool turns = actuator.turns();
    if (actuator.line.cable >= 0) {
      actuator.unknown = model.cables[actuator.line.cable].unknown;
    } else if (!actuator.tendon) {
      RodModel& rod = model.rods[actuator.line.rod];
      const auto& base = rod.rod.base;
      const auto at = std::find_if(base.begin(), base.end(), [&](const rod::BaseMotion& b) {
        return b.turns == turns && b.axis == actuator.axis;
      });
      actuator.unknown = rod.unknown + static_cast<int>(at - base.begin());
      if (turns) rod.floats = false;  // what drives it counts from the start
    }
    if (!actuator.told_force()) actuator.row = model.rows++;
  }
  number_ties(model);
  model.arms.setOnes(model.unknowns);
  for (const RodModel& rod : model.rods) {
    for (int i = 0; i < rod.rod.base_coordinates(); ++i) {
      if (rod.rod.base[i].turns) model.arms[rod.unknown + i] = rod.rod.length();
    }
  }
  for (const BodyModel& body : model.bodies)  // radius of gyration
    model.arms.segment<3>(body.unknown + 3).setConstant(std::sqrt(body.body.inertia.trace() / (3.0 * body.body.mass)));
}

/// Constant strain cannot bend without changing volume.
void warn_of_locking(Model& model, const SolidModel& solid) {
  double poisson = 0.0;
  for (int cell = 0; cell < solid.body.elements(); ++cell) {
    if (solid.body.cells[cell].kind != solid::Kind::tet4) continue;
    const solid::Lame moduli = solid::lame(solid.body.of(cell).law);
    poisson = std::max(poisson, 0.5 * moduli.lambda / (moduli.lambda + moduli.mu));
  }
  if (poisson > 0.48) {
    model.warnings.push_back(
        {.code = "elements_lock",
         .where = "solids." + solid.name,
         .message = "4-node tetrahedra lock at Poisson's ratio " + text(poisson) + " and bend too little",
         .remedy = "set `order: 2` (10-node tetrahedra)",
         .value = poisson,
         .limit = 0.48});
  }
}

/// Where the file has elements that are not used, the body has holes.
void warn_of_holes(Model& model, const SolidModel& solid) {
  std::string found;
  for (const auto& [kind, count] : solid.mesh.ignored) {
    const auto is_a = [&kind = kind](const char* volume) { return kind.find(volume) != std::string::npos; };
    if (!is_a("tetrahedron") && !is_a("hexahedron") && !is_a("wedge") && !is_a("pyramid") && !is_a("polyhedron"))
      continue;
    found += (found.empty() ? "" : ", ") + std::to_string(count) + " of kind " + kind;
  }
  if (found.empty()) return;
  model.warnings.push_back({.code = "mesh_holes",
                            .where = "solids." + solid.name + ".mesh",
                            .message = "the body has holes where the file has cells that are not used, " + found,
                            .remedy = "save the mesh with tetrahedra of 4 or 10 nodes or hexahedra of 8"});
}

/// Concentrated loads of each rod: where its internal forces may jump.
void count_jumps(Model& model) {
  const auto at = [&model](int rod, int count) {
    if (rod >= 0) model.rods[rod].jumps += count;
  };
  for (const PointModel& point : model.points) at(point.line.rod, 1);
  for (const TieModel& tie : model.ties) {
    at(tie.rod, 1);
    at(tie.other, 1);
  }
  for (const LoadModel& load : model.loads) {
    const RodLoadModel* own = std::get_if<RodLoadModel>(&load.on);
    if (own && own->concentrated()) at(own->rod, 1);
  }
  for (const ActuatorModel& actuator : model.actuators) at(actuator.line.rod, actuator.tendon ? 2 : 0);
  for (RodModel& rod : model.rods) rod.jumps += 2 * static_cast<int>(rod.touching.size());
}

void measure(Model& model) {
  Vec3 lower = Vec3::Constant(INFINITY), upper = -lower;
  for (const SolidModel& solid : model.solids) {
    lower = lower.cwiseMin(solid.body.rest.rowwise().minCoeff());
    upper = upper.cwiseMax(solid.body.rest.rowwise().maxCoeff());
  }
  for (const RodModel& rod : model.rods) {
    for (const Vec3& p : start_shape(rod).p) {
      lower = lower.cwiseMin(p);
      upper = upper.cwiseMax(p);
    }
    model.size = std::max(model.size, rod.rod.length());  // a ring is small for its length
  }
  for (const BodyModel& body : model.bodies) {
    const Vec3 half = contact::reach(body.shape, body.start.R.transpose());
    lower = lower.cwiseMin(body.start.p - half);
    upper = upper.cwiseMax(body.start.p + half);
  }
  model.size = std::max(model.size, (upper - lower).norm());
  model.middle = 0.5 * (lower + upper);
}

/// Contact takes cross-sections as round, of the radius of the circle about them.
void warn_of_flat_rods(Model& model) {
  constexpr double kRound = 0.05;
  for (std::size_t i = 0; i < model.rods.size(); ++i) {
    const RodModel& rod = model.rods[i];
    if (!in_a_pair(model, {Collider::Kind::rod, static_cast<int>(i)})) continue;
    double most = 0.0, radius = 0.0;
    for (const double s : rod.touching) {
      const double outer = rod::radius_at(rod.rod.profile, s), more = outer - rod::inner_radius_at(rod.rod.profile, s);
      if (more > kRound * outer && more > most) {
        most = more;
        radius = outer;
      }
    }
    if (most > 0.0)
      model.warnings.push_back({.code = "round_in_contact",
                                .where = "rods." + rod.name,
                                .message = "its cross-section is not round, but contact takes it for a circle of " +
                                           text(1e3 * radius) + " mm radius, up to " + text(1e3 * most) +
                                           " mm outside the true one",
                                .remedy = "move what it meets away by that much, or make it a solid",
                                .value = most,
                                .limit = kRound * radius,
                                .unit = "m"});
  }
}

/// Steps converge to a part of the largest force anywhere: beside what is heavy, what is light may not be balanced.
void warn_of_light_objects(Model& model) {
  constexpr double kLost = 0.01;   // of a weight: what it costs in the deflection
  constexpr double kHeavy = 1000;  // times as heavy; else it is the step that is short
  struct Weight {
    std::string name;
    double mass = 0.0;
  };
  std::vector<Weight> all;
  for (const SolidModel& own : model.solids) all.push_back({"solids." + own.name, own.body.masses.sum()});
  for (const RodModel& own : model.rods) {
    double mass = 0.0;
    for (const rod::MassPoint& point : own.rod.masses) mass += point.mass;
    all.push_back({"rods." + own.name, mass});
  }
  for (const BodyModel& own : model.bodies) all.push_back({"bodies." + own.name, own.body.mass});
  std::erase_if(all, [](const Weight& own) { return own.mass <= 0.0; });
  const double g = model.scene.gravity.norm(), tolerance = model.scene.newton.tolerance;
  if (all.empty() || g == 0.0 || model.scene.newton.iterations > 0) return;
  const auto [light, heavy] =
      std::minmax_element(all.begin(), all.end(), [](const Weight& a, const Weight& b) { return a.mass < b.mass; });
  // In motion the rounding of its place leaves forces, too (`convergence_of`).
  const double step = model.scene.analysis == Analysis::dynamic ? model.scene.time.step : INFINITY;
  const double by_weight = heavy->mass / light->mass, rounded = 1e-14 * by_weight * model.size / (step * step * g),
               left = tolerance * by_weight + rounded;
  if (left <= kLost || by_weight < kHeavy) return;
  const double enough = std::pow(10.0, std::floor(std::log10(0.5 * kLost / by_weight)));
  model.warnings.push_back({.code = "light_beside_heavy",
                            .where = light->name,
                            .message = "forces are balanced to " + text(tolerance) + " of the largest, the weight of " +
                                       heavy->name + " of " + text(heavy->mass * g) + " N, and " + light->name +
                                       " weighs " + text(light->mass * g) + " N",
                            .remedy = "make " + heavy->name + " an obstacle, or check its density and its units" +
                                      (rounded < 0.5 * kLost ? ", or take newton.tolerance = " + text(enough) : ""),
                            .value = left,
                            .limit = kLost});
}

}  // namespace

Model build(const Scene& scene, const MeshReader& read_mesh) {
  Model model;
  model.scene = scene;
  require_positive(scene.time.step, "time.step", "10 ms is a good start");
  if (!(scene.time.duration >= 0.0))
    reject("time.duration", text(scene.time.duration), "must not be negative",
           "give the length of the run, for example 2 s");
  if (scene.time.duration / scene.time.step > 1e9) {
    const bool step = scene.time.step < 1e-9;
    reject(step ? "time.step" : "time.duration", text(step ? scene.time.step : scene.time.duration) + " s",
           "makes more than 1e9 steps of " + text(scene.time.step) + " s", "shorten the run or lengthen time.step");
  }
  if (scene.time.smallest > scene.time.step ||
      (scene.time.smallest > 0.0 && scene.time.smallest < 1e-6 * scene.time.step))
    reject("time.smallest", text(scene.time.smallest) + " s", "must be between a millionth of the step and the step",
           "leave it out for 1e-4 of the step");
  const double steps = scene.time.duration / scene.time.step;
  const bool grid = scene.analysis == Analysis::dynamic || scene.analysis == Analysis::quasi_static;
  if (grid && steps > 0.0 && steps < 1.0 - 1e-6) {
    model.warnings.push_back(
        {.code = "unit_of_time",
         .where = "time.step",
         .message = text(scene.time.step) + " s is longer than the run of " + text(scene.time.duration) + " s",
         .remedy = "numbers without a unit are seconds",
         .value = scene.time.step,
         .limit = scene.time.duration,
         .unit = "s"});
  } else if (grid && std::abs(steps - std::round(steps)) > 1e-6) {
    model.warnings.push_back({.code = "duration_rounded",
                              .where = "time.duration",
                              .message = "it is no whole number of steps, so the run goes on to " +
                                         text(std::ceil(steps) * scene.time.step) + " s",
                              .remedy = "give a multiple of time.step"});
  }
  if (scene.solids.empty() && scene.rods.empty() && scene.bodies.empty()) {
    reject("", "", "the scene has neither solids nor rods nor bodies",
           "add a `solids:`, `rods:` or `bodies:` section; `sinew schema` lists all keys");
  }
  if (scene.analysis == Analysis::statics && !(scene.time.duration > 0.0))
    reject("time.duration", text(scene.time.duration) + " s", "must be greater than 0 for `analysis: static`",
           "loads and motors are taken from the tables at the end of the duration");
  for (const auto& [name, solid] : scene.solids) {
    model.solids.push_back(build_solid(scene, name, solid, read_mesh, model.warnings));
    warn_of_locking(model, model.solids.back());
    warn_of_holes(model, model.solids.back());
  }
  for (const auto& [name, rod] : scene.rods) {
    if (rod.cable == Cable::geometric) {
      model.cables.push_back(build_cable(scene, name, rod));
    } else {
      model.rods.push_back(build_rod(scene, name, rod));
      check_path(scene, name, rod, model.rods.back(), model.warnings);
    }
  }
  for (const auto& [name, body] : scene.bodies) build_body(model, name, body, read_mesh);
  for (const auto& [name, obstacle] : scene.obstacles) build_obstacle(model, name, obstacle, read_mesh);
  build_pairs(model);
  for (const auto& [name, actuator] : scene.actuators) build_actuator(model, name, actuator);
  for (const auto& [name, load] : scene.loads) build_load(model, name, load);
  for (std::size_t i = 0; i < scene.couplings.size(); ++i) {
    const auto number = static_cast<int>(i);
    std::visit([&](const auto& own) { build_coupling(model, number, own); }, scene.couplings[i]);
  }
  arrange_slides(model);
  number_unknowns(model);
  for (const auto& [name, output] : scene.outputs) build_output(model, name, output);
  for (std::size_t i = 0; i < scene.targets.size(); ++i) build_target(model, static_cast<int>(i));
  for (std::size_t i = 0; i < model.actuators.size(); ++i) {
    if (model.actuators[i].sought()) model.sought.push_back(static_cast<int>(i));
  }
  check_targets(model);
  for (std::size_t i = 0; i < model.solids.size(); ++i) check_held(model, static_cast<int>(i));
  count_jumps(model);
  plan_factors(model);
  measure(model);
  const State start = initial_state(model);
  for (OutputModel& output : model.outputs) {
    if (output.quantity == Quantity::orientation) output.upright = output_axes(model, start, output);
  }
  for (EffectorModel& effector : model.effectors) effector.start = effector_value(model, start, effector);
  warn_of_units(model);
  warn_of_flat_rods(model);
  warn_of_light_objects(model);
  warn_of_tables(model);
  for (const RodState& rod : start.rods) model.start_masses.push_back(rod.masses);
  model.start_energy = energy_balance(model, start).total();
  measure_bearing(model);
  look_for_redundant_rows(model, start);
  for (const Overlap& own : overlaps(model, start)) {
    PairModel& pair = model.pairs[own.pair];
    pair.depth = 1.2 * own.depth;
    model.warnings.push_back({.code = "overlap_at_start",
                              .where = "contact",
                              .message = name_of_pair(model, own.pair) + " overlap by " + text(1e3 * own.depth) +
                                         " mm at the start and are moved apart slowly",
                              .remedy = "move one of them, or write `off: true` for the pair",
                              .value = own.depth,
                              .limit = 1e-6 * model.size,
                              .unit = "m"});
  }
  return model;
}

}  // namespace sinew
