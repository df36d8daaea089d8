#include <algorithm>
#include <cmath>

#include "sinew/sim/building.hpp"
#include "sinew/sim/quantities.hpp"
#include "sinew/sim/targets.hpp"

namespace sinew::building {

namespace {

std::string word_of(Quantity quantity) {
  for (const auto& [word, own] : quantity_words()) {
    if (own == quantity) return word;
  }
  return "";
}

/// What may be asked of this subject.
void check_known(const Output& output, Subject subject, const char* subjects, const std::string& path) {
  if (find_kind(output.quantity, subject)) return;
  reject(path + ".quantity", word_of(output.quantity), std::string("is not known of ") + subjects,
         "write " + known_of(subject));
}

void on_solid(Model& model, const Output& output, const std::string& path, OutputModel& own) {
  check_known(output, Subject::solid, "solids", path);
  own.solid = find(model.scene.solids, *output.solid, path + ".solid", "solid");
  const SolidModel& solid = model.solids[own.solid];
  if (output.quantity == Quantity::reaction) {
    own.nodes.assign(static_cast<std::size_t>(solid.body.nodes()), !output.region);
    if (output.region) {
      for (const int node : select(solid, *output.region, path + ".region").nodes) own.nodes[node] = true;
    }
    for (int node = 0; node < solid.body.nodes(); ++node) {
      if (own.nodes[node] && solid.body.unknown.col(node).minCoeff() < 0) return;
    }
    reject(path, *output.solid, output.region ? "no node of this region is held" : "no node of this solid is held",
           "a reaction is the force on what is `fixed`: name a region that is");
  }
  if (output.region)
    reject(path + ".region", "", "is for `quantity: reaction`", "name a `point`, or write `quantity: reaction`");
  const Pose& pose = model.scene.solids[own.solid].second.pose;
  const Vec3 x =
      output.point.in == In::world ? output.point.x : apply(stand(model.scene, solid.frame, pose), output.point.x);
  own.where = embed_within(solid, x, output.reach, path + ".point", "the point");
  if (lies_outside(solid, own.where)) {
    model.warnings.push_back(
        {.code = "output_outside",
         .where = path,
         .message = "the point lies " + text(own.where.distance) + " m outside the mesh and is extrapolated",
         .value = own.where.distance,
         .unit = "m"});
  }
  for (int i = 0; i < 3; ++i)
    own.axes[i] = solid::embed_vector(solid.body.rest, solid.body.cells, own.where, Vec3::Unit(i));
}

void of_a_pair(const Model& model, const Output& output, const std::string& path, OutputModel& own) {
  const std::string where = path + ".between";
  if (output.between.size() != 2)
    reject(where, std::to_string(output.between.size()) + " names", "must be two", "name the two that touch");
  const Collider first = find_collider(model, output.between[0], where),
                 second = find_collider(model, output.between[1], where);
  for (std::size_t i = 0; i < model.pairs.size(); ++i) {
    const PairModel& pair = model.pairs[i];
    own.turned = pair.a != first;
    if ((pair.a == first && pair.b == second) || (pair.a == second && pair.b == first)) {
      own.pair = static_cast<int>(i);
      return;
    }
  }
  reject(where, output.between[0] + ", " + output.between[1], "do not stop each other",
         "list the two under `contact: {pairs: ...}`, without `off: true`");
}

}  // namespace

void build_output(Model& model, const std::string& name, const Output& output) {
  const std::string path = "outputs." + name;
  OutputModel own;
  own.name = name;
  own.quantity = output.quantity;
  if (output.solid.has_value() + output.rod.has_value() + output.body.has_value() + !output.between.empty() != 1) {
    reject(
        path, "", "needs exactly one of solid, rod, body and between",
        "write `{solid: NAME, point: [x, y, z]}`, `{rod: NAME, at: s}`, `{body: NAME}` or `{between: [NAME, NAME]}`");
  }
  if (output.solid) {
    on_solid(model, output, path, own);
  } else if (output.body) {
    check_known(output, Subject::body, "rigid bodies", path);
    own.body = find(model.scene.bodies, *output.body, path + ".body", "rigid body");
  } else if (!output.between.empty()) {
    own.quantity = Quantity::touching;
    of_a_pair(model, output, path, own);
  } else {
    check_known(output, Subject::rod, "rods", path);
    own.rod = find_rod(model, *output.rod, path + ".rod");
    own.abscissa = abscissa_on(model, own.rod, output.at, path + ".at");
  }
  model.outputs.push_back(own);
}

void build_target(Model& model, int number) {
  const Target& target = model.scene.targets[number];
  const std::string path = "targets." + target.output;
  EffectorModel own;
  own.output = find(model.scene.outputs, target.output, path, "output");
  const OutputModel& output = model.outputs[own.output];
  switch (output.quantity) {
    case Quantity::position:
    case Quantity::orientation:
      break;
    case Quantity::touching:
      own.size = 1;
      model.pairs[output.pair].sought = true;
      break;
    case Quantity::strain:
      if (output.rod < 0) reject(path, target.output, "is a strain of a solid", "take one of a rod, or a position");
      own.size = 1;
      own.strain = static_cast<int>(target.strain);
      break;
    default:
      reject(path, word_of(output.quantity), "is nothing that motors can be asked for",
             "name an output of `position`, `orientation` or, of a rod, `strain`, or `between` two that touch");
  }
  if (!model.effectors.empty()) own.first = effector_size(model);
  const double unit = measure_of(model, own).unit;
  if (!target.weights.empty() && target.weights.size() != static_cast<std::size_t>(own.size))
    reject(path + ".weights", std::to_string(target.weights.size()) + " numbers",
           "must be " + std::to_string(own.size) + ", one for each component", "0 leaves a component free");
  own.weights.setConstant(own.size, 1.0 / unit);
  for (std::size_t i = 0; i < target.weights.size(); ++i) {
    if (!(target.weights[i] >= 0.0 && std::isfinite(target.weights[i])))
      reject(path + ".weights", text(target.weights[i]), "must not be negative", "0 leaves a component free");
    own.weights[static_cast<Eigen::Index>(i)] *= target.weights[i];
  }
  if (!(own.weights.maxCoeff() > 0.0))
    reject(path + ".weights", "0", "asks for nothing", "give one component a weight above 0");
  own.tolerance = target.tolerance.value_or(0.1 * unit);
  if (!(own.tolerance > 0.0))
    reject(path + ".tolerance", text(own.tolerance), "must be greater than 0", "leave it out, or give 0.1 mm");
  if (const Track* track = std::get_if<Track>(&target.at)) {
    if (track->times.empty() || track->values.size() != track->times.size())
      reject(path + ".at", std::to_string(track->values.size()) + " values", "must be one for each time",
             "give as many values as times");
    for (const Eigen::VectorXd& value : track->values) {
      if (value.size() != own.size || !value.allFinite())
        reject(path + ".at", std::to_string(value.size()) + " numbers",
               "must be " + std::to_string(own.size) + " finite numbers at every time", "give one for each component");
    }
  }
  if (output.solid >= 0) {
    own.watched = static_cast<int>(model.watched.size());
    if (output.quantity == Quantity::orientation) {
      for (const solid::EmbeddedPoint& axis : output.axes) model.watched.push_back({output.solid, axis});
    } else {
      model.watched.push_back({output.solid, output.where});
    }
  }
  model.effectors.push_back(own);
}

void check_targets(const Model& model) {
  const auto first = std::find_if(model.actuators.begin(), model.actuators.end(),
                                  [](const ActuatorModel& actuator) { return actuator.sought(); });
  if (model.effectors.empty()) {
    if (first == model.actuators.end()) return;
    reject("actuators." + first->name, "inverse", "is to be found, but there is nothing that it is to do",
           "add `targets: {OUTPUT: {at: [x, y, z]}}`, or say what drives it");
  }
  if (first == model.actuators.end())
    reject("targets", "", "no actuator is free to bring an output there",
           "write `force: inverse` or `displacement: inverse` for some");
  if (model.scene.analysis != Analysis::dynamic && model.scene.analysis != Analysis::quasi_static)
    reject("analysis", "", "targets are met over time", "write `dynamic` or `quasi_static`");
}

}  // namespace sinew::building
