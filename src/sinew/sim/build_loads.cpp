#include <algorithm>
#include <cmath>
#include <set>

#include "sinew/sim/building.hpp"
#include "sinew/solid/pressure.hpp"

namespace sinew::building {

void check_drive(const Drive& drive, const std::string& path) {
  const Table* table = std::get_if<Table>(&drive);
  if (table && (table->times.empty() || table->times.size() != table->values.size()))
    reject(path, std::to_string(table->times.size()) + " times",
           "a table needs as many times as values, and at least one", "give a constant or a table");
}

namespace {

RodLoadModel on_rod(const Model& model, const RodLoad& load, const std::string& path) {
  RodLoadModel own;
  own.rod = find_rod(model, load.rod, path + ".rod");
  own.force = load.force;
  own.moment = load.moment;
  own.follower = load.follower;
  if (load.from.has_value() != load.to.has_value() || (load.from && load.at))
    reject(path, load.rod, "needs `at` for a point load, or `from` and `to` for a distributed one",
           "give one or the other");
  if (!load.from) {
    own.at.push_back({abscissa_on(model, own.rod, load.at, path + ".at"), 1.0});
    return own;
  }
  const auto [from, to] = stretch_on(model, own.rod, load.from, load.to, path, "loads run towards the tip");
  for (const rod::Section& section : model.rods[own.rod].rod.sections) {
    const double begin = std::max(from, section.begin), end = std::min(to, section.end);
    if (!(end > begin)) continue;
    const rod::GaussRule& rule = rod::gauss_rule(4);
    for (std::size_t g = 0; g < rule.node.size(); ++g)
      own.at.push_back({begin + (end - begin) * rule.node[g], (end - begin) * rule.weight[g]});
  }
  return own;
}

/// Unknowns of the rim of faces, where it is not held so that the tangent of a pressure is symmetric all the same
/// (solid/README.md, "Loads on faces").
std::vector<int> free_rim(const Scene& scene, const SolidModel& solid, const std::vector<solid::CellFace>& faces) {
  const auto turns = [&](int frame) {
    const auto& motion = frame < 0 ? std::nullopt : scene.frames[frame].second.motion;
    return motion && !motion->rotate.empty();
  };
  const auto vanishes = [&](const solid::Edge& edge) {
    const std::span<const int> nodes = edge.nodes();
    int held = 0, in_plane = 0;  // axes: that all nodes are held along; that stay across a plane which they stay in
    for (int axis = 0; axis < 3; ++axis) {
      const auto is_held = [&](int node) { return solid.body.unknown(axis, node) < 0; };
      const int carrier = solid.carrier(axis, nodes[0]);
      const auto is_level = [&](int node) {
        return solid.carrier(axis, node) == carrier && !turns(carrier) &&
               std::abs(solid.body.rest(axis, node) - solid.body.rest(axis, nodes[0])) <= 1e-6 * solid.mesh.diagonal;
      };
      if (!std::all_of(nodes.begin(), nodes.end(), is_held)) continue;
      ++held;
      in_plane += std::all_of(nodes.begin(), nodes.end(), is_level) ? 1 : 0;
    }
    return held >= 2 || in_plane > 0;
  };
  std::set<int> unknowns;
  for (const solid::Edge& edge : solid::rim(faces)) {
    if (vanishes(edge)) continue;
    for (const int node : edge.nodes()) {
      for (const int unknown : solid.body.unknown.col(node)) {
        if (unknown >= 0) unknowns.insert(unknown);
      }
    }
  }
  return {unknowns.begin(), unknowns.end()};
}

SolidLoadModel on_solid(const Model& model, const SolidLoad& load, const std::string& path) {
  SolidLoadModel own;
  own.solid = find(model.scene.solids, load.solid, path + ".solid", "solid");
  const SolidModel& solid = model.solids[own.solid];
  const Selection selection = select_loaded(solid, load.region, path);
  if (!load.force.isZero(0.0)) own.force = load.force * shares(solid, selection, Spread::evenly).transpose();
  if (load.pressure == 0.0) return own;
  if (selection.faces.empty())
    reject(path, "", "no face of the surface belongs to this region",
           "enlarge the region: a face belongs to it with all its nodes, or to a group that lists it or its cell");
  own.pressure = load.pressure;
  own.faces = selection.faces;
  own.rim = free_rim(model.scene, solid, own.faces);
  return own;
}

}  // namespace

void build_load(Model& model, const std::string& name, const Load& load) {
  const std::string path = "loads." + name;
  LoadModel own;
  own.name = name;
  own.factor = std::visit([](const auto& one) { return one.factor; }, load);
  check_drive(own.factor, path + ".factor");
  if (const RodLoad* rod = std::get_if<RodLoad>(&load)) own.on = on_rod(model, *rod, path);
  if (const SolidLoad* solid = std::get_if<SolidLoad>(&load)) own.on = on_solid(model, *solid, path);
  model.loads.push_back(std::move(own));
}

}  // namespace sinew::building
