#include "sinew/sim/model.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <set>
#include <sstream>

#include "sinew/constraint/independent.hpp"
#include "sinew/error/input_error.hpp"
#include "sinew/rod/kinematics.hpp"
#include "sinew/rod/path.hpp"
#include "sinew/rod/section.hpp"

namespace sinew {

namespace {

std::string text(double value) {
  std::ostringstream out;
  out.precision(6);
  out << value;
  return out.str();
}

std::string text(const Vec3& v) { return "[" + text(v.x()) + ", " + text(v.y()) + ", " + text(v.z()) + "]"; }

[[noreturn]] void reject(const std::string& path, const std::string& value, const std::string& rule,
                         const std::string& remedy) {
  throw InputError({"", 0, path, value, rule, remedy});
}

void require_positive(double value, const std::string& path, const std::string& remedy) {
  if (!(value > 0.0) || !std::isfinite(value))
    reject(path, text(value), "must be a finite number greater than 0", remedy);
}

template <class T>
int find(const Named<T>& entries, const std::string& name, const std::string& path, const std::string& kind) {
  for (std::size_t i = 0; i < entries.size(); ++i) {
    if (entries[i].first == name) return static_cast<int>(i);
  }
  std::string known;
  for (const auto& entry : entries) known += (known.empty() ? "" : ", ") + entry.first;
  reject(path, name, "no " + kind + " of this name", known.empty() ? "the scene has no " + kind : "known: " + known);
}

int find_frame(const Scene& scene, const std::optional<std::string>& name, const std::string& path) {
  return name ? find(scene.frames, *name, path + ".frame", "frame") : -1;
}

/// The frame's placement at t = 0, after the object's own pose.
Placement stand(const Scene& scene, int frame, const Pose& pose) {
  const Placement own = placement(pose);
  return frame < 0 ? own : compose(frame_at(scene.frames[frame].second, 0.0), own);
}

/// Nodes in use, renumbered in their order.
void compact(solid::Mesh& mesh) {
  std::vector<int> number(mesh.nodes.cols(), -1);
  for (const auto& t : mesh.tetrahedra) {
    for (int node : t) number[node] = 0;
  }
  int used = 0;
  for (std::size_t i = 0; i < number.size(); ++i) {
    if (number[i] < 0) continue;
    mesh.nodes.col(used) = mesh.nodes.col(static_cast<Eigen::Index>(i)).eval();
    number[i] = used++;
  }
  mesh.nodes.conservativeResize(3, used);
  for (auto& t : mesh.tetrahedra) {
    for (int& node : t) node = number[node];
  }
}

/// Pattern of the lower triangle and where every element's blocks go in it.
void make_pattern(SolidModel& model) {
  const solid::Body& body = model.body;
  std::vector<std::set<int>> below(body.free_nodes);  // per column node, rows >= it
  for (const auto& t : body.tetrahedra) {
    for (int a : t) {
      for (int b : t) {
        if (body.unknown[b] >= 0 && body.unknown[a] >= body.unknown[b]) below[body.unknown[b]].insert(body.unknown[a]);
      }
    }
  }
  std::vector<Eigen::Triplet<double>> entries;
  for (int column = 0; column < body.free_nodes; ++column) {
    for (int row : below[column]) {
      for (int j = 0; j < 3; ++j) {
        for (int i = row == column ? j : 0; i < 3; ++i) entries.emplace_back(3 * row + i, 3 * column + j, 0.0);
      }
    }
  }
  model.matrix.resize(3 * body.free_nodes, 3 * body.free_nodes);
  model.matrix.setFromTriplets(entries.begin(), entries.end());
  model.matrix.makeCompressed();
  const auto position = [&](int row, int column) {
    const int* begin = model.matrix.innerIndexPtr() + model.matrix.outerIndexPtr()[column];
    const int* end = model.matrix.innerIndexPtr() + model.matrix.outerIndexPtr()[column + 1];
    return static_cast<int>(std::lower_bound(begin, end, row) - model.matrix.innerIndexPtr());
  };
  for (int i = 0; i < 3 * body.free_nodes; ++i) model.diagonal.push_back(position(i, i));
  std::array<int, 9> absent;
  absent.fill(-1);
  model.block.assign(16 * body.tetrahedra.size(), absent);
  for (std::size_t e = 0; e < body.tetrahedra.size(); ++e) {
    for (int a = 0; a < 4; ++a) {
      for (int b = 0; b < 4; ++b) {
        const int row = body.unknown[body.tetrahedra[e][a]], column = body.unknown[body.tetrahedra[e][b]];
        if (row < 0 || column < 0 || row < column) continue;
        for (int i = 0; i < 9; ++i) {
          if (row == column && i % 3 < i / 3) continue;
          model.block[16 * e + 4 * a + b][i] = position(3 * row + i % 3, 3 * column + i / 3);
        }
      }
    }
  }
}

/// Reads a mesh. What is wrong inside it carries the mesh's own file and line; a path that leads nowhere is the field's
/// fault.
solid::Mesh read_named(const MeshReader& read_mesh, const std::filesystem::path& file, const std::string& path) {
  try {
    return read_mesh(file);
  } catch (const InputError& error) {
    InputFault fault = error.fault();
    if (fault.file.empty()) fault.path = path;
    throw InputError(fault);
  }
}

/// Lengths beyond these bounds are a slip of units; their squares may not even be numbers.
constexpr double kSmallest = 1e-9, kLargest = 1e6;  // [m]

SolidModel build_solid(const Scene& scene, const std::string& name, const Solid& solid, const MeshReader& read_mesh) {
  const std::string path = "solids." + name;
  SolidModel model;
  model.name = name;
  model.frame = find_frame(scene, solid.frame, path);
  require_positive(solid.material.young, path + ".material.young", "give Young's modulus, for example 600 kPa");
  if (!(solid.material.poisson > -1.0 && solid.material.poisson < 0.5)) {
    reject(path + ".material.poisson", text(solid.material.poisson), "must lie between -1 and 0.5 in a solid",
           "use 0.49 for a nearly incompressible silicone");
  }
  require_positive(solid.scale, path + ".scale", "0.001 if the mesh is in millimetres");

  solid::Mesh mesh =
      read_named(read_mesh, solid.mesh.is_absolute() ? solid.mesh : scene.folder / solid.mesh, path + ".mesh");
  compact(mesh);
  const Eigen::Matrix3Xd scaled = solid.scale * mesh.nodes;
  const Placement pose = stand(scene, model.frame, solid.pose);
  const Eigen::Matrix3Xd world = (pose.R * scaled).colwise() + pose.p;
  const double diagonal = (world.rowwise().maxCoeff() - world.rowwise().minCoeff()).norm();

  if (!(diagonal > kSmallest && diagonal < kLargest && world.allFinite())) {
    reject(path + ".scale", text(solid.scale), "makes the body " + text(diagonal) + " m large",
           "give the scale that turns mesh coordinates into metres, 0.001 for millimetres; check the pose");
  }

  std::vector<bool> clamped(scaled.cols(), false);
  for (std::size_t b = 0; b < solid.fixed.size(); ++b) {
    const Box& box = solid.fixed[b];
    const Eigen::Matrix3Xd& where = box.in == In::world ? world : scaled;
    const double slack = 1e-9 * diagonal;
    int count = 0;
    for (Eigen::Index i = 0; i < where.cols(); ++i) {
      if (((where.col(i) - box.lower).array() < -slack).any() || ((where.col(i) - box.upper).array() > slack).any())
        continue;
      clamped[i] = true;
      ++count;
    }
    if (count == 0) {
      reject(path + ".fixed", text(box.lower) + " .. " + text(box.upper) + " m", "no node of the mesh lies in this box",
             "the nodes span " + text(Vec3(where.rowwise().minCoeff())) + " .. " +
                 text(Vec3(where.rowwise().maxCoeff())) + " m " +
                 (box.in == In::world ? "in the world" : "before the pose") + "; check scale and units");
    }
  }
  const auto held = std::count(clamped.begin(), clamped.end(), true);
  if (held < 3) {
    reject(path + ".fixed", std::to_string(held) + " nodes",
           "at least three nodes must be fixed, or the body falls or turns freely",
           "add `fixed: {box: [[..], [..]]}` around the part that is held");
  }
  if (held == scaled.cols()) reject(path + ".fixed", "all nodes", "some node must be free", "make the box smaller");

  double volume = 0.0;
  for (const auto& t : mesh.tetrahedra) volume += solid::volume(scaled, t);
  if (solid.mass.has_value() == solid.density.has_value()) {
    reject(path, "", "needs exactly one of mass and density", "give `mass: 75 g` or `density: 1070 kg/m^3`");
  }
  const double mass = solid.mass ? *solid.mass : *solid.density * volume;
  require_positive(mass, path + (solid.mass ? ".mass" : ".density"), "give the mass of the body");
  model.surface = solid::surface(mesh.tetrahedra);
  model.body = solid::make_body(world, mesh.tetrahedra, solid::lame(solid.material.young, solid.material.poisson), mass,
                                clamped);
  model.body.damping_mass = solid.rayleigh.mass;
  model.body.damping_stiffness = solid.rayleigh.stiffness;
  make_pattern(model);
  return model;
}

/// Ascending ends from 0 to the length, from a count or a list.
std::vector<double> section_ends(const Rod& rod, double length, const std::string& path) {
  std::vector<double> ends;
  if (const int* count = std::get_if<int>(&rod.sections)) {
    if (*count < 1)
      reject(path, std::to_string(*count), "must be at least 1", "start with one section per 5 mm of cable");
    for (int i = 0; i <= *count; ++i) ends.push_back(length * i / *count);
    return ends;
  }
  ends = std::get<std::vector<double>>(rod.sections);
  if (ends.size() < 2)
    reject(path, "", "needs at least two abscissae", "list the section ends from 0 to the rod's length");
  if (std::abs(ends.front()) > 1e-6 * length || std::abs(ends.back() - length) > 1e-6 * length) {
    reject(path, text(ends.front()) + " .. " + text(ends.back()) + " m",
           "must run from 0 to the rod's length, " + text(length) + " m",
           "list every section end, the first 0 and the last the length");
  }
  ends.front() = 0.0;
  ends.back() = length;
  for (std::size_t i = 1; i < ends.size(); ++i) {
    if (!(ends[i] > ends[i - 1]))
      reject(path, text(ends[i]) + " m", "must be greater than the one before", "sort the list");
  }
  return ends;
}

RodModel build_rod(const Scene& scene, const std::string& name, const Rod& rod) {
  const std::string path = "rods." + name;
  RodModel model;
  model.name = name;
  model.frame = find_frame(scene, rod.frame, path);
  model.geometric = rod.cable == Cable::geometric;
  const Placement pose = stand(scene, model.frame, rod.pose);
  std::vector<Vec3> points;
  for (const Vec3& p : rod.path) points.push_back(rod.path_in == In::world ? p : apply(pose, p));
  if (points.size() < 2)
    reject(path + ".path", std::to_string(points.size()) + " points", "needs at least two points",
           "list them from base to tip");
  for (std::size_t i = 1; i < points.size(); ++i) {
    if ((points[i] - points[i - 1]).norm() < 1e-9) {
      reject(path + ".path", text(rod.path[i]), "two neighbours are the same point", "remove one of them");
    }
  }
  double extent = 0.0;
  for (const Vec3& p : points) extent = std::max(extent, p.cwiseAbs().maxCoeff());
  if (!(extent < kLargest)) {
    reject(path + ".path", text(extent) + " m", "a coordinate is beyond 1e6 m",
           "check the units of the path and the pose");
  }
  const rod::Path curve(points);
  const Vec3 up = rod.up ? Vec3(rod.path_in == In::world ? *rod.up : pose.R * *rod.up) : Vec3(Vec3::UnitZ());
  const std::vector<double> ends = section_ends(rod, curve.length(), path + ".sections");
  const rod::Layout layout = rod::lay_along(curve, ends, up);
  model.base = layout.base;
  model.path_deviation = layout.deviation;
  model.cable.length = curve.length();
  if (model.geometric) return model;

  require_positive(rod.section.radius, path + ".section.circle.radius", "give the radius, for example 0.5 mm");
  require_positive(rod.material.young, path + ".material.young", "give Young's modulus, for example 5 GPa");
  if (!(rod.material.poisson > -1.0 && rod.material.poisson <= 0.5)) {
    reject(path + ".material.poisson", text(rod.material.poisson), "must lie between -1 and 0.5",
           "0.4 for nylon, 0.3 for steel");
  }
  model.rod.ends = ends;
  model.rod.radius = rod.section.radius;
  for (const Strain strain : rod.strains) model.rod.basis.push_back(static_cast<int>(strain));
  std::sort(model.rod.basis.begin(), model.rod.basis.end());
  model.rod.fixed = layout.strains;
  model.rod.rest.resize(static_cast<Eigen::Index>(model.rod.sections()) * model.rod.strains());
  for (int i = 0; i < model.rod.sections(); ++i) {
    for (int c = 0; c < model.rod.strains(); ++c) {
      model.rod.rest[i * model.rod.strains() + c] = layout.strains(model.rod.basis[c], i);
      model.rod.fixed(model.rod.basis[c], i) = 0.0;
    }
    model.rod.stiffness.push_back(
        rod::round_section_stiffness(rod.section.radius, rod.material.young, rod.material.poisson));
  }
  model.rod.masses = rod::round_rod_masses(ends, rod.section.radius, rod.material.density);
  return model;
}

solid::EmbeddedPoint embed_within(const SolidModel& solid, const Vec3& x, const std::optional<double>& reach,
                                  const std::string& path, const std::string& what) {
  const solid::EmbeddedPoint point = solid::embed(solid.body.rest, solid.body.tetrahedra, x);
  const double diagonal = (solid.body.rest.rowwise().maxCoeff() - solid.body.rest.rowwise().minCoeff()).norm();
  const double limit = reach.value_or(0.1 * diagonal);
  if (point.distance > limit) {
    reject(path, text(x) + " m (world)",
           what + " lies " + text(point.distance) + " m outside solids." + solid.name + ", beyond the reach of " +
               text(limit) + " m",
           "check pose, scale and units, or raise `reach`");
  }
  return point;
}

bool all_clamped(const SolidModel& solid, const solid::EmbeddedPoint& point) {
  for (int c = 0; c < 4; ++c) {
    if (std::abs(point.weights[c]) > 1e-9 && solid.body.unknown[solid.body.tetrahedra[point.element][c]] >= 0)
      return false;
  }
  return true;
}

/// A sliding point is dropped when the others already determine all but this part of it. With two points of an element
/// kept and a third between them nothing new is left (0); points of neighbouring elements are at 0.3 and more.
/// docs/points.md has the measurements.
constexpr double kNewPart = 0.2;

/// Keeps the points that say something new: none that touches no free unknown, and of those that a volume's elements
/// carry only as many as are independent (a linear element follows a straight line: two points of it say all).
std::vector<PointModel> independent_points(Model& model, const std::vector<PointModel>& candidates,
                                           CouplingFacts& facts) {
  std::vector<PointModel> free, held, kept;
  for (const PointModel& point : candidates) {
    const bool no_solid = all_clamped(model.solids[point.solid], point.where);
    const RodModel& rod = model.rods[point.rod];
    if (no_solid && !rod.geometric && point.abscissa <= 1e-9 * rod.length()) {
      facts.no_unknown.push_back(point.abscissa);
      continue;
    }
    (no_solid ? held : free).push_back(point);
  }
  const auto keep = [&](const std::vector<PointModel>& points, const Eigen::MatrixXd& gram, double tolerance) {
    const int first = !points.empty() && points.back().anchor ? static_cast<int>(points.size()) - 1 : -1;
    std::vector<int> numbers = constraint::independent_rows(gram, tolerance, first);
    std::sort(numbers.begin(), numbers.end());
    for (int i = 0; i < static_cast<int>(points.size()); ++i) {
      if (std::binary_search(numbers.begin(), numbers.end(), i)) {
        kept.push_back(points[i]);
      } else {
        facts.redundant.push_back(points[i].abscissa);
        model.dropped.push_back(points[i]);
      }
    }
  };
  // Points on free nodes: rows of shape function weights.
  const auto n = static_cast<Eigen::Index>(free.size());
  Eigen::MatrixXd gram = Eigen::MatrixXd::Zero(n, n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const SolidModel& solid = model.solids[free[i].solid];
    for (Eigen::Index j = 0; j <= i; ++j) {
      for (int a = 0; a < 4; ++a) {
        for (int b = 0; b < 4; ++b) {
          const int node = solid.body.tetrahedra[free[i].where.element][a];
          if (node == solid.body.tetrahedra[free[j].where.element][b] && solid.body.unknown[node] >= 0) {
            gram(i, j) += free[i].where.weights[a] * free[j].where.weights[b];
          }
        }
      }
      gram(j, i) = gram(i, j);
    }
  }
  keep(free, gram, kNewPart);
  // Points held still by the body: they can only be met by the rod; what its coordinates can do decides.
  const auto m = static_cast<Eigen::Index>(held.size());
  if (m > 0 && !model.rods[held[0].rod].geometric) {
    const RodModel& rod = model.rods[held[0].rod];
    const auto shape = rod::configure(rod.rod, rod.base, rod::rest_coordinates(rod.rod));
    std::vector<Eigen::MatrixXd> rows;
    for (const PointModel& point : held) {
      const rod::CurvePoint on_curve = rod::curve_point(shape, point.abscissa);
      Eigen::MatrixXd J = rod::position_jacobian(shape, point.abscissa);
      J.leftCols(rod.rod.base_coordinates()).setZero();
      rows.push_back(on_curve.R.rightCols<2>().transpose() * J);
    }
    Eigen::MatrixXd reach = Eigen::MatrixXd::Zero(m, m);
    for (Eigen::Index i = 0; i < m; ++i) {
      for (Eigen::Index j = 0; j < m; ++j) reach(i, j) = (rows[i].array() * rows[j].array()).sum();
    }
    keep(held, reach, kNewPart);
  } else {
    kept.insert(kept.end(), held.begin(), held.end());
  }
  std::sort(kept.begin(), kept.end(), [](const auto& a, const auto& b) { return a.abscissa < b.abscissa; });
  std::sort(facts.redundant.begin(), facts.redundant.end());
  return kept;
}

void build_coupling(Model& model, int number, const Slide& slide) {
  const std::string path = "couplings." + std::to_string(number) + ".slide";
  const int rod = find(model.scene.rods, slide.rod, path + ".rod", "rod");
  const int solid = find(model.scene.solids, slide.solid, path + ".solid", "solid");
  const RodModel& rod_model = model.rods[rod];
  const double length = rod_model.length();
  std::vector<double> abscissae;
  if (const int* count = std::get_if<int>(&slide.points)) {
    if (*count < 1)
      reject(path + ".points", std::to_string(*count), "must be at least 1",
             "one point per 5 mm of cable is a good start");
    for (int i = 0; i < *count; ++i) abscissae.push_back(*count == 1 ? length : length * i / (*count - 1));
  } else {
    abscissae = std::get<std::vector<double>>(slide.points);
  }
  if (abscissae.empty())
    reject(path + ".points", "", "needs at least one point", "give a count or a list of abscissae");
  const bool anchored = slide.anchor_tip == AnchorTip::position;
  if (anchored) {
    if (std::abs(abscissae.back() - length) > 1e-6 * length) {
      reject(path + ".points", text(abscissae.back()) + " m",
             "the last point holds the tip, so it must be the rod's length, " + text(length) + " m",
             "end the list with the length, or write `anchor_tip: none`");
    }
    abscissae.back() = length;
  } else if (rod_model.geometric) {
    reject(path + ".anchor_tip", "none", "a geometric cable must be anchored", "write `anchor_tip: position`");
  }

  CouplingFacts facts;
  facts.asked = static_cast<int>(abscissae.size());
  const rod::Placement base = rod_model.base;
  std::vector<PointModel> candidates;
  std::vector<Vec3> positions;
  if (rod_model.geometric) {  // on the path itself
    const Rod& spec = model.scene.rods[rod].second;
    const Placement pose = stand(model.scene, rod_model.frame, spec.pose);
    std::vector<Vec3> points;
    for (const Vec3& p : spec.path) points.push_back(spec.path_in == In::world ? p : apply(pose, p));
    const rod::Path curve(points);
    for (double s : abscissae) positions.push_back(curve.position(s));
  } else {
    const auto shape = rod::configure(rod_model.rod, base, rod::rest_coordinates(rod_model.rod));
    for (double s : abscissae) positions.push_back(rod::position(shape, s));
  }
  for (std::size_t i = 0; i < abscissae.size(); ++i) {
    if (abscissae[i] < 0.0 || abscissae[i] > length * (1.0 + 1e-12)) {
      reject(path + ".points", text(abscissae[i]) + " m", "must lie on the rod, from 0 to " + text(length) + " m",
             "measure along the rod from its base");
    }
    PointModel& point = candidates.emplace_back();
    point.rod = rod;
    point.solid = solid;
    point.coupling = number;
    point.abscissa = abscissae[i];
    point.anchor = anchored && i + 1 == abscissae.size();
    point.where = embed_within(model.solids[solid], positions[i], slide.reach, path + ".points",
                               "the point at " + text(abscissae[i]) + " m of the rod");
    if (point.where.distance > 0.0) ++facts.outside;
    facts.farthest = std::max(facts.farthest, point.where.distance);
  }
  const std::vector<PointModel> kept = independent_points(model, candidates, facts);
  facts.kept = static_cast<int>(kept.size());
  model.points.insert(model.points.end(), kept.begin(), kept.end());
  model.couplings.push_back(facts);
}

void build_actuator(Model& model, const std::string& name, const Actuator& actuator) {
  const std::string path = "actuators." + name;
  ActuatorModel& own = model.actuators.emplace_back();
  own.name = name;
  own.rod = find(model.scene.rods, actuator.rod, path + ".rod", "rod");
  own.motion = actuator.motion;
  own.driven = actuator.driven;
  own.drive = actuator.drive;
  RodModel& rod = model.rods[own.rod];
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
