#include "sinew/sim/model.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "sinew/rod/kinematics.hpp"
#include "sinew/sim/building.hpp"

namespace sinew {

using namespace building;  // the parts

namespace {

void build_actuator(Model& model, const std::string& name, const Actuator& actuator) {
  const std::string path = "actuators." + name;
  ActuatorModel& own = model.actuators.emplace_back();
  own.name = name;
  own.rod = find(model.scene.rods, actuator.rod, path + ".rod", "rod");
  own.motion = actuator.motion;
  own.driven = actuator.driven;
  own.drive = actuator.drive;
  RodModel& rod = model.rods[own.rod];
  const bool turns = actuator.driven == Driven::torque || actuator.driven == Driven::angle;
  if (turns != (actuator.motion == Motion::rotation)) {
    reject(path + ".motion", turns ? "translation" : "rotation", "does not fit what drives it",
           "force and displacement translate, torque and angle rotate");
  }
  if (const Table* table = std::get_if<Table>(&actuator.drive);
      table && (table->times.empty() || table->times.size() != table->values.size())) {
    reject(path, std::to_string(table->times.size()) + " times",
           "a table needs as many times as values, and at least one", "give a constant or a table");
  }
  if (rod.geometric && actuator.motion == Motion::rotation) {
    reject(path + ".motion", "rotation", "a geometric cable cannot be turned", "use `cable: cosserat`");
  }
  const auto axis = actuator.motion == Motion::translation ? rod::BaseAxis::translation : rod::BaseAxis::rotation;
  if (std::find(rod.rod.base.begin(), rod.rod.base.end(), axis) != rod.rod.base.end()) {
    reject(path, name, "the rod already has an actuator of this motion", "drive each motion of a base once");
  }
  rod.rod.base.push_back(axis);
}

/// A geometric cable runs through its points in the order of their abscissae, whatever couplings they belong to. Its
/// length is that of the polyline, which cuts the corners of a curved path.
void number_cable_points(Model& model, int number) {
  RodModel& rod = model.rods[number];
  std::vector<PointModel*> points;
  for (PointModel& point : model.points) {
    if (point.rod == number) points.push_back(&point);
  }
  if (points.empty()) {
    reject("rods." + rod.name + ".cable", "geometric", "a geometric cable needs a coupling that it runs through",
           "add `slide: {rod: " + rod.name + ", ...}` or use `cable: cosserat`");
  }
  if (rod.rod.base.empty()) {
    reject("rods." + rod.name + ".cable", "geometric", "a geometric cable needs an actuator that holds its base",
           "add one with `displacement: 0 mm`, or use `cable: cosserat`");
  }
  std::stable_sort(points.begin(), points.end(),
                   [](const PointModel* a, const PointModel* b) { return a->abscissa < b->abscissa; });
  rod.cable.points = static_cast<int>(points.size());
  rod.cable.rounding = 1e-5 * rod.cable.length;
  Eigen::VectorXd z = Eigen::VectorXd::Zero(rod.cable.coordinates());
  for (std::size_t k = 0; k < points.size(); ++k) {
    points[k]->cable_point = static_cast<int>(k);
    const solid::Body& body = model.solids[points[k]->solid].body;
    z.segment<3>(static_cast<Eigen::Index>(1 + 3 * k)) = solid::position(points[k]->where, body.tetrahedra, body.rest);
  }
  rod.cable.length = rod::cable_length(rod.cable, rod.base, z).value;
}

/// Numbers of all reduced unknowns and rows.
void number_unknowns(Model& model) {
  for (std::size_t i = 0; i < model.rods.size(); ++i) {
    RodModel& rod = model.rods[i];
    rod.offset = model.reduced;
    if (rod.geometric) {
      number_cable_points(model, static_cast<int>(i));
      rod.length_row = model.rows++;
    }
    model.reduced += rod.coordinates();
  }
  for (PointModel& point : model.points) {
    point.row = model.rows;
    model.rows += 3;
    if (!point.anchor && point.cable_point < 0) point.unknown = model.reduced++;
  }
  for (ActuatorModel& actuator : model.actuators) {
    const RodModel& rod = model.rods[actuator.rod];
    const auto axis = actuator.motion == Motion::translation ? rod::BaseAxis::translation : rod::BaseAxis::rotation;
    const auto at = std::find(rod.rod.base.begin(), rod.rod.base.end(), axis) - rod.rod.base.begin();
    actuator.unknown = rod.offset + static_cast<int>(at);
    if (actuator.driven == Driven::displacement || actuator.driven == Driven::angle) actuator.row = model.rows++;
  }
}

void build_output(Model& model, const std::string& name, const Output& output) {
  const std::string path = "outputs." + name;
  OutputModel own;
  own.name = name;
  if (output.solid.has_value() == output.rod.has_value()) {
    reject(path, "", "needs exactly one of solid and rod",
           "write `{solid: NAME, point: [x, y, z]}` or `{rod: NAME, at: s}`");
  }
  if (output.solid) {
    own.solid = find(model.scene.solids, *output.solid, path + ".solid", "solid");
    const SolidModel& solid = model.solids[own.solid];
    const Pose& pose = model.scene.solids[own.solid].second.pose;
    const Vec3 x =
        output.point.in == In::world ? output.point.x : apply(stand(model.scene, solid.frame, pose), output.point.x);
    own.where = embed_within(solid, x, output.reach, path + ".point", "the point");
    if (own.where.distance > 0.0) {
      model.warnings.push_back(path + ": the point lies " + text(own.where.distance) +
                               " m outside the mesh and is extrapolated");
    }
  } else {
    own.rod = find(model.scene.rods, *output.rod, path + ".rod", "rod");
    own.abscissa = output.at.value_or(model.rods[own.rod].length());
    if (own.abscissa < 0.0 || own.abscissa > model.rods[own.rod].length() * (1.0 + 1e-9)) {
      reject(path + ".at", text(own.abscissa) + " m",
             "must lie on the rod, from 0 to " + text(model.rods[own.rod].length()) + " m", "measure from the base");
    }
    if (model.rods[own.rod].geometric)
      reject(path + ".rod", *output.rod, "a geometric cable has no material points", "put the output on the solid");
  }
  model.outputs.push_back(own);
}

void measure(Model& model) {
  Vec3 lower = Vec3::Constant(INFINITY), upper = -lower;
  for (const SolidModel& solid : model.solids) {
    lower = lower.cwiseMin(solid.body.rest.rowwise().minCoeff());
    upper = upper.cwiseMax(solid.body.rest.rowwise().maxCoeff());
  }
  for (const RodModel& rod : model.rods) {
    if (rod.geometric) continue;
    const auto shape = rod::configure(rod.rod, rod.base, rod::rest_coordinates(rod.rod));
    for (const Vec3& p : shape.p) {
      lower = lower.cwiseMin(p);
      upper = upper.cwiseMax(p);
    }
  }
  model.size = (upper - lower).norm();
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
  const double steps = scene.time.duration / scene.time.step;
  if (std::abs(steps - std::round(steps)) > 1e-6) {
    model.warnings.push_back("time.duration is no whole number of steps; the run goes on to the next one, " +
                             text(std::ceil(steps) * scene.time.step) + " s");
  }
  if (scene.solids.empty() && scene.rods.empty()) {
    reject("", "", "the scene has neither solids nor rods",
           "add a `solids:` or `rods:` section; `sinew schema` lists all keys");
  }
  for (const auto& [name, solid] : scene.solids) model.solids.push_back(build_solid(scene, name, solid, read_mesh));
  for (const auto& [name, rod] : scene.rods) model.rods.push_back(build_rod(scene, name, rod));
  for (const auto& [name, actuator] : scene.actuators) build_actuator(model, name, actuator);
  for (std::size_t i = 0; i < scene.couplings.size(); ++i)
    build_coupling(model, static_cast<int>(i), scene.couplings[i]);
  number_unknowns(model);
  for (const auto& [name, output] : scene.outputs) build_output(model, name, output);
  measure(model);
  return model;
}

}  // namespace sinew
