// Rigid bodies, obstacles, and which of all objects stop each other.
#include <algorithm>
#include <cmath>
#include <map>
#include <span>

#include "sinew/sim/building.hpp"
#include "sinew/sim/contacts.hpp"

namespace sinew::building {

namespace {

using Kind = Collider::Kind;

void require_size(double value, const std::string& path) {
  require_positive(value, path, "give it in metres, or with a unit: 20 mm");
  if (!(value > kSmallest && value < kLargest))
    reject(path, text(value) + " m", "must be between 1e-9 m and 1e6 m", "check its unit");
}

struct MakeShape {
  const std::string& path;

  contact::Shape operator()(const BoxShape& box) const {
    for (int i = 0; i < 3; ++i) require_size(box.size[i], path + ".box.size");
    return contact::Convex{contact::box(box.size)};
  }
  contact::Shape operator()(const SphereShape& sphere) const {
    require_size(sphere.radius, path + ".sphere.radius");
    return contact::Ball{sphere.radius};
  }
  contact::Shape operator()(const CylinderShape& cylinder) const {
    require_size(cylinder.radius, path + ".cylinder.radius");
    require_size(cylinder.length, path + ".cylinder.length");
    return contact::Cylinder{cylinder.radius, cylinder.length};
  }
  contact::Shape operator()(const CapsuleShape& capsule) const {
    require_size(capsule.radius, path + ".capsule.radius");
    require_size(capsule.length, path + ".capsule.length");
    return contact::Capsule{capsule.radius, capsule.length};
  }
  contact::Shape operator()(const PlaneShape& plane) const {
    if (!(plane.normal.norm() > 0.0) || !plane.normal.allFinite())
      reject(path + ".plane.normal", text(plane.normal), "must not be zero", "give the direction out of the ground");
    return contact::HalfSpace{};
  }
};

std::vector<Collider> colliders(const Model& model) {
  std::vector<Collider> all;
  const auto add = [&all](Kind kind, std::size_t count) {
    for (std::size_t i = 0; i < count; ++i) all.push_back({kind, static_cast<int>(i)});
  };
  add(Kind::obstacle, model.obstacles.size());
  add(Kind::body, model.bodies.size());
  add(Kind::solid, model.solids.size());
  add(Kind::rod, model.rods.size());
  return all;
}

/// Points of a rod that are looked at: the ends of its sections, and between them as many as these have degrees of
/// bending. More would ask of the rod what it cannot do. Ten at least.
std::vector<double> points_along(const RodModel& rod) {
  std::vector<double> at{0.0};
  const int least = (9 + rod.rod.count()) / rod.rod.count();
  for (const rod::Section& section : rod.rod.sections) {
    int count = least;
    for (const rod::Mode& mode : section.modes) count = std::max(count, mode.degree + 1);
    for (int i = 1; i <= count; ++i)
      at.push_back(std::lerp(section.begin, section.end, i / static_cast<double>(count)));
  }
  return at;
}

/// What of a solid's surface may touch something.
void prepare_surface(SolidModel& solid) {
  std::map<std::array<int, 2>, Ridge> ridges;
  std::vector<contact::Box> faces, edges;
  const auto around = [&solid](std::span<const int> nodes) {
    contact::Box box;
    for (const int node : nodes) box.extend(Vec3(solid.body.rest.col(node)));
    return box;
  };
  for (const solid::Triangle& triangle : solid.surface) {
    solid.surface_nodes.insert(solid.surface_nodes.end(), triangle.begin(), triangle.end());
    faces.push_back(around(triangle));
    for (std::size_t i = 0; i < 3; ++i) {
      const int from = triangle[i], to = triangle[(i + 1) % 3], third = triangle[(i + 2) % 3];
      const std::array<int, 2> ends{std::min(from, to), std::max(from, to)};
      ridges.try_emplace(ends, Ridge{ends, {third, third}}).first->second.sides[1] = third;
    }
  }
  solid::make_ascending(solid.surface_nodes);
  for (const auto& [ends, ridge] : ridges) {
    solid.ridges.push_back(ridge);
    edges.push_back(around(ends));
  }
  solid.faces = contact::Tree(faces);
  solid.edges = contact::Tree(edges);
}

}  // namespace

Collider find_collider(const Model& model, const std::string& name, const std::string& path) {
  std::string known;
  for (const Collider& own : colliders(model)) {
    const std::string other = name_of(model, own);
    if (other == name) return own;
    known += (known.empty() ? "" : ", ") + other;
  }
  reject(path, name, "nothing of this name can be touched", "known: " + known);
}

void build_body(Model& model, const std::string& name, const RigidBody& body) {
  const std::string path = "bodies." + name;
  BodyModel own;
  own.name = name;
  own.shape = std::visit(MakeShape{path}, body.shape);
  const contact::Bulk bulk = contact::bulk(own.shape);
  if (body.mass.has_value() == body.density.has_value())
    reject(path, "", "needs exactly one of mass and density", "give `mass: 30 g` or `density: 1200 kg/m^3`");
  if (body.mass) require_positive(*body.mass, path + ".mass", "give the mass of the body");
  if (body.density) require_positive(*body.density, path + ".density", "give the density of the body");
  const double density = body.mass ? *body.mass / bulk.volume : *body.density;
  own.body = {density * bulk.volume, density * bulk.inertia};
  const Placement at = placement(body.pose);
  if (!at.p.allFinite() || !body.velocity.allFinite() || !body.spin.allFinite())
    reject(path, "", "pose, velocity and spin must be finite", "check its numbers");
  own.start = {at.p, at.R, body.velocity, at.R.transpose() * body.spin};
  model.bodies.push_back(own);
}

void build_obstacle(Model& model, const std::string& name, const Obstacle& obstacle) {
  const std::string path = "obstacles." + name;
  ObstacleModel own;
  own.name = name;
  own.shape = std::visit([&](const auto& shape) { return MakeShape{path}(shape); }, obstacle.shape);
  own.frame = find_frame(model.scene, obstacle.frame, path);
  own.pose = stand(model.scene, own.frame, obstacle.pose);
  if (const PlaneShape* plane = std::get_if<PlaneShape>(&obstacle.shape)) {
    const Vec3 up = plane->normal.normalized();
    own.pose = compose(own.pose, {lie::exp(lie::shortest_rotation(Vec3::UnitZ(), up)), plane->point});
  }
  model.obstacles.push_back(own);
}

namespace {

/// Whether a coupling holds one to the other: they do not touch unless a pair says so.
bool joined(const Model& model, const Collider& a, const Collider& b) {
  const std::string one = name_of(model, a), other = name_of(model, b);
  const auto are = [&](const std::string& first, const std::string& second) {
    return (one == first && other == second) || (one == second && other == first);
  };
  return std::any_of(model.scene.couplings.begin(), model.scene.couplings.end(), [&](const Coupling& coupling) {
    if (const Glue* glue = std::get_if<Glue>(&coupling)) return are(glue->solid, glue->body);
    const Tie* tie = std::get_if<Tie>(&coupling);
    return tie && tie->body && are(tie->rod, *tie->body);
  });
}

}  // namespace

void build_pairs(Model& model) {
  const Contact& contact = model.scene.contact;
  require_not_negative(contact.friction, "contact.friction", "0 for none, 0.5 for rubber on plastic");
  const auto check_restitution = [](double value, const std::string& path) {
    if (!(value >= 0.0 && value <= 1.0)) reject(path, text(value), "must be between 0 and 1", "0: nothing bounces");
  };
  check_restitution(contact.restitution, "contact.restitution");
  struct Chosen {
    Collider a, b;
    const ContactPair* own;
  };
  std::vector<Chosen> chosen;
  for (std::size_t i = 0; i < contact.pairs.size(); ++i) {
    const ContactPair& own = contact.pairs[i];
    const std::string path = "contact.pairs." + std::to_string(i);
    const Collider a = find_collider(model, own.first, path + ".between"),
                   b = find_collider(model, own.second, path + ".between");
    if (own.friction) require_not_negative(*own.friction, path + ".friction", "0 for none");
    if (own.restitution) check_restitution(*own.restitution, path + ".restitution");
    if (a.kind == Kind::obstacle && b.kind == Kind::obstacle)
      reject(path, own.first + ", " + own.second, "two obstacles cannot meet", "name something that moves");
    if (a == b && a.kind != Kind::solid) reject(path, own.first, "only a solid can meet itself", "name two objects");
    for (const Chosen& earlier : chosen) {
      if ((earlier.a == a && earlier.b == b) || (earlier.a == b && earlier.b == a))
        reject(path, own.first + ", " + own.second, "is there already", "write one entry for each pair");
    }
    chosen.push_back({a, b, &own});
  }
  const std::vector<Collider> all = colliders(model);
  for (std::size_t i = 0; i < all.size(); ++i) {
    for (std::size_t j = i; j < all.size(); ++j) {
      const Collider &a = all[i], &b = all[j];
      if (a.kind == Kind::obstacle && b.kind == Kind::obstacle) continue;
      const bool one_rigid = a.kind == Kind::obstacle || a.kind == Kind::body;
      const auto own = std::find_if(chosen.begin(), chosen.end(),
                                    [&](const Chosen& c) { return (c.a == a && c.b == b) || (c.a == b && c.b == a); });
      const ContactPair* said = own == chosen.end() ? nullptr : own->own;
      if ((said && said->off) || (!said && (!one_rigid || i == j || joined(model, a, b)))) continue;
      PairModel pair{a, b, contact.friction, contact.restitution};
      if (said) {
        pair.friction = said->friction.value_or(pair.friction);
        pair.restitution = said->restitution.value_or(pair.restitution);
      }
      model.pairs.push_back(pair);
    }
  }
  if (model.pairs.empty()) return;
  if (model.scene.newton.precision == linalg::Precision::float32)
    reject("newton.precision", "single", "contact needs double precision", "leave `precision` out");
  if (model.scene.analysis != Analysis::dynamic)
    reject("analysis", "", "contact is computed in dynamic scenes alone",
           "write `analysis: dynamic`, and damping that brings it to rest; or `off: true` for pairs that never meet");
  for (RodModel& rod : model.rods) rod.touching = points_along(rod);
  for (SolidModel& solid : model.solids) prepare_surface(solid);
}

}  // namespace sinew::building
