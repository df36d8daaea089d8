// Rigid bodies, obstacles, and which of all objects stop each other.
#include <algorithm>
#include <cmath>
#include <map>
#include <stdexcept>
#include <utility>

#include "sinew/contact/hull.hpp"
#include "sinew/contact/sheet.hpp"
#include "sinew/sim/building.hpp"
#include "sinew/sim/contacts.hpp"

namespace sinew::building {

namespace {

using Kind = Collider::Kind;

constexpr double kThinnest = 1e-4;  ///< of a sheet's size

/// The triangles of a mesh in its own axes [m].
struct Triangles {
  Eigen::Matrix3Xd points;
  std::vector<solid::Triangle> triangles;
};
Triangles read_triangles(const Scene& scene, const MeshReader& read_mesh, const MeshShape& shape,
                         const std::string& path) {
  require_positive(shape.scale, path + ".scale", "0.001 if the mesh is in millimetres");
  solid::Mesh mesh = read_named(scene, read_mesh, shape.file, path + ".file");
  Triangles own{{}, mesh.cells.empty() ? std::move(mesh.faces) : solid::surface(mesh.cells)};
  if (own.triangles.empty())
    reject(path + ".file", shape.file.string(), "has no triangles", "give the surface of a body");
  // Points of no triangle, as the inner ones of a volume, are left out.
  std::map<int, int> number;
  std::vector<Vec3> points;
  for (solid::Triangle& triangle : own.triangles) {
    for (int& corner : triangle) {
      const auto [entry, fresh] = number.try_emplace(corner, static_cast<int>(points.size()));
      if (fresh) points.emplace_back(shape.scale * mesh.nodes.col(corner));
      corner = entry->second;
    }
  }
  own.points.resize(3, std::ssize(points));
  for (std::size_t i = 0; i < points.size(); ++i) own.points.col(static_cast<Eigen::Index>(i)) = points[i];
  return own;
}

/// Whether the triangles of a part of a surface look inward though it is no cavity of another part.
bool has_part_inside_out(const contact::Mesh& mesh) {
  std::vector<int> part(mesh.triangles.size(), -1);  // by its first triangle
  for (std::size_t first = 0; first < part.size(); ++first) {
    if (part[first] >= 0) continue;
    std::vector<int> waiting{static_cast<int>(first)};
    while (!waiting.empty()) {
      const int at = waiting.back();
      waiting.pop_back();
      if (part[at] >= 0) continue;
      part[at] = static_cast<int>(first);
      for (const int other : mesh.beside[at]) {
        if (other >= 0) waiting.push_back(other);
      }
    }
    std::vector<solid::Triangle> own, others;
    for (std::size_t t = 0; t < part.size(); ++t)
      (part[t] == static_cast<int>(first) ? own : others).push_back(mesh.triangles[t]);
    if (contact::bulk(contact::make_mesh(mesh.points, own)).volume > 0.0) continue;
    // A cavity's points are in what the other parts enclose.
    const contact::Mesh rest = contact::make_mesh(mesh.points, others);
    if (!contact::inside(rest, rest.points, rest.faces, mesh.points.col(own[0][0]))) return true;
  }
  return false;
}

void make_sheet(Triangles& own, const MeshShape& mesh, double extent, const std::string& path) {
  if (mesh.hull)
    reject(path + ".hull", "true", "is the body around it, which has no thickness", "leave out one of the two");
  if (!(mesh.thickness > kThinnest * extent && mesh.thickness < extent))
    reject(path + ".thickness", text(mesh.thickness), "must be between a ten-thousandth of its size and its size",
           "give the thickness of the sheet in metres, or with a unit, as in `thickness: 1 mm`");
  try {
    contact::Sheet sheet = contact::thicken(own.points, std::move(own.triangles), mesh.thickness);
    own = {std::move(sheet.points), std::move(sheet.triangles)};
  } catch (const contact::NoSheet& wrong) {
    reject(path + ".file", mesh.file.string(), wrong.what() + (wrong.at ? " at " + text(*wrong.at) + " m" : ""),
           "mend the surface there, or give a smaller `thickness`");
  }
}

contact::Shape shape_of(const Triangles& own, bool hull) {
  if (!hull) return contact::make_mesh(own.points, own.triangles);
  return contact::Convex{contact::hull({own.points.colwise().begin(), own.points.colwise().end()})};
}

/// A shape in axes at its centre of mass, and where these are in those of the scene.
struct MadeShape {
  contact::Shape shape;
  Vec3 middle = Vec3::Zero();  ///< [m]
};

struct MakeShape {
  const Scene& scene;
  const std::string& path;
  const MeshReader& read_mesh;

  MadeShape operator()(const BoxShape& box) const {
    for (int i = 0; i < 3; ++i) require_size(box.size[i], path + ".box.size");
    return {contact::Convex{contact::box(box.size)}};
  }
  MadeShape operator()(const SphereShape& sphere) const {
    require_size(sphere.radius, path + ".sphere.radius");
    return {contact::Ball{sphere.radius}};
  }
  MadeShape operator()(const CylinderShape& cylinder) const {
    require_size(cylinder.radius, path + ".cylinder.radius");
    require_size(cylinder.length, path + ".cylinder.length");
    return {contact::Cylinder{cylinder.radius, cylinder.length}};
  }
  MadeShape operator()(const CapsuleShape& capsule) const {
    require_size(capsule.radius, path + ".capsule.radius");
    require_size(capsule.length, path + ".capsule.length");
    return {contact::Capsule{capsule.radius, capsule.length}};
  }
  MadeShape operator()(const PlaneShape& plane) const {
    if (!(plane.normal.norm() > 0.0) || !plane.normal.allFinite())
      reject(path + ".plane.normal", text(plane.normal), "must not be zero", "give the direction out of the ground");
    return {contact::HalfSpace{}};
  }
  MadeShape operator()(const MeshShape& mesh) const {
    const std::string own_path = path + ".mesh", file = mesh.file.string();
    Triangles own = read_triangles(scene, read_mesh, mesh, own_path);
    const Vec3 lower = own.points.rowwise().minCoeff(), upper = own.points.rowwise().maxCoeff();
    const double extent = (upper - lower).maxCoeff();
    if (!(extent > kSmallest && extent < kLargest))
      reject(own_path + ".scale", text(mesh.scale), "makes the body " + text(extent) + " m large",
             "give the scale that turns mesh coordinates into metres, 0.001 for millimetres");
    if (mesh.thickness != 0.0) make_sheet(own, mesh, extent, own_path);
    if (const int open = mesh.hull ? 0 : contact::open_edges(own.triangles); open > 0)
      reject(
          own_path + ".file", file,
          "has " + std::to_string(open) + " edges where not exactly two triangles meet, turned the same way",
          "close the surface and turn all its triangles outward, write `hull: true` for the convex body around it, or "
          "give its `thickness` if it is a sheet");
    try {
      const Vec3 middle = 0.5 * (lower + upper);
      own.points.colwise() -= middle;  // for the sake of its inertia's digits
      const contact::Shape made = shape_of(own, mesh.hull);
      const contact::Bulk bulk = contact::bulk(made);
      const contact::Mesh* surface = std::get_if<contact::Mesh>(&made);
      if (!(std::abs(bulk.volume) > 1e-12 * std::pow(extent, 3)))
        reject(own_path + ".file", file, "encloses no volume", "give a body that has a volume");
      if (bulk.volume < 0.0 || (surface && has_part_inside_out(*surface)))
        reject(own_path + ".file", file, bulk.volume < 0.0 ? "is inside out" : "has a part that is inside out",
               "turn its triangles outward: counter-clockwise where one looks at them from outside");
      own.points.colwise() -= bulk.centre;
      return {shape_of(own, mesh.hull), middle + bulk.centre};
    } catch (const std::invalid_argument&) {
      reject(own_path + ".file", file, "its points lie in one plane, or are too few", "give a body that has a volume");
    }
  }
};

/// Gives a body or an obstacle its shape; returns where the shape's axes are in those of the scene [m].
template <class Given, class Made>
Vec3 make_shape(Model& model, const Given& given, const std::string& path, const MeshReader& read_mesh, Made& own) {
  MadeShape made = std::visit(MakeShape{model.scene, path, read_mesh}, given);
  own.shape = std::move(made.shape);
  own.prongs = contact::prongs(own.shape);
  if (const MeshShape* mesh = std::get_if<MeshShape>(&given))
    warn_of_scale(2.0 * contact::reach(own.shape, rod::Mat3::Identity()).norm(), mesh->scale, path + ".mesh.scale",
                  model.warnings);
  return made.middle;
}

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

void build_body(Model& model, const std::string& name, const RigidBody& body, const MeshReader& read_mesh) {
  const std::string path = "bodies." + name;
  BodyModel own;
  own.name = name;
  const Vec3 middle = make_shape(model, body.shape, path, read_mesh, own);
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
  own.start = {apply(at, middle), at.R, body.velocity, at.R.transpose() * body.spin};
  model.bodies.push_back(own);
}

void build_obstacle(Model& model, const std::string& name, const Obstacle& obstacle, const MeshReader& read_mesh) {
  const std::string path = "obstacles." + name;
  ObstacleModel own;
  own.name = name;
  const Vec3 middle = make_shape(model, obstacle.shape, path, read_mesh, own);
  own.frame = find_frame(model.scene, obstacle.frame, path);
  own.pose = compose(stand(model.scene, own.frame, obstacle.pose), {rod::Mat3::Identity(), middle});
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
  const bool still = model.scene.analysis == Analysis::quasi_static;
  const bool loose = std::any_of(model.pairs.begin(), model.pairs.end(), [](const PairModel& pair) {
    return pair.a.kind == Kind::body || pair.b.kind == Kind::body;
  });
  if (model.scene.analysis != Analysis::dynamic && (!still || loose))
    reject("analysis", "",
           loose ? "loose bodies that touch are computed in dynamic scenes alone"
                 : "contact is computed in dynamic and quasi-static scenes alone",
           "write `analysis: dynamic`, and damping that brings it to rest; or `off: true` for pairs that never meet");
  for (RodModel& rod : model.rods) rod.touching = points_along(rod);
  for (SolidModel& solid : model.solids) solid.skin = contact::make_mesh(solid.body.rest, solid.surface);
}

}  // namespace sinew::building
