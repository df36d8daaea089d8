#include "sinew/sim/building.hpp"

namespace sinew::building {

namespace {

bool of_solids(Quantity quantity) { return quantity == Quantity::displacement || quantity == Quantity::reaction; }
bool of_rods(Quantity quantity) { return quantity == Quantity::force || quantity == Quantity::moment; }

void on_solid(Model& model, const Output& output, const std::string& path, OutputModel& own) {
  if (of_rods(output.quantity))
    reject(path + ".quantity", "", "is known of rods only", "write `quantity: stress` or `reaction`, or name a rod");
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
  if (own.where.distance > 0.0) {
    model.warnings.push_back(path + ": the point lies " + text(own.where.distance) +
                             " m outside the mesh and is extrapolated");
  }
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
    if (output.quantity != Quantity::position && output.quantity != Quantity::force)
      reject(path + ".quantity", "", "is not known of rigid bodies", "write `position` or `force`");
    own.body = find(model.scene.bodies, *output.body, path + ".body", "rigid body");
  } else if (!output.between.empty()) {
    of_a_pair(model, output, path, own);
  } else {
    if (of_solids(output.quantity))
      reject(path + ".quantity", "", "is known of solids only", "write `position` or `force`, or name a solid");
    own.rod = find_rod(model, *output.rod, path + ".rod");
    own.abscissa = abscissa_on(model, own.rod, output.at, path + ".at");
  }
  model.outputs.push_back(own);
}

void build_effector(Model& model, const std::string& name, int number) {
  const std::string path = "effectors." + std::to_string(number);
  const OutputModel& output = model.outputs[find(model.scene.outputs, name, path, "output")];
  if (output.solid < 0 || output.quantity != Quantity::position)
    reject(path, name, "is no position of a point of a solid", "name an output of `{solid: NAME, point: [x, y, z]}`");
  model.effectors.push_back({output.solid, output.where});
}

}  // namespace sinew::building
