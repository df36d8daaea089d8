#include "sinew/sim/contact_surfaces.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "sinew/sim/surface_overlap.hpp"

namespace sinew {

using Kind = Collider::Kind;

namespace {

void fit_boxes(Surface& own) {
  const contact::Mesh& mesh = *own.mesh;
  const Eigen::Matrix3Xd& x = own.x;
  contact::find_outward(mesh, x, own.outward);
  own.boxes.clear();
  for (const std::array<int, 3>& t : mesh.triangles) {
    contact::Box& box = own.boxes.emplace_back();
    for (const int point : t) box.extend(Vec3(x.col(point)));
  }
  own.faces.fit(own.boxes);
  own.boxes.clear();
  for (const contact::Ridge& ridge : mesh.ridges) {
    contact::Box& box = own.boxes.emplace_back();
    for (const int point : ridge.ends) box.extend(Vec3(x.col(point)));
  }
  own.edges.fit(own.boxes);
}

}  // namespace

void Surfaces::fit(const Collider& own, const Moment& now) {
  if (own.kind == Kind::rod) {
    rods_.resize(now.model.rods.size());
    touching_points(now, own.number, rods_[static_cast<std::size_t>(own.number)]);
    return;
  }
  std::vector<Surface>& all = of_kind_[static_cast<std::size_t>(own.kind)];
  if (static_cast<int>(all.size()) <= own.number) all.resize(static_cast<std::size_t>(own.number) + 1);
  Surface& surface = all[static_cast<std::size_t>(own.number)];
  if (!surface.mesh) {
    const auto mesh = mesh_of(now.model, own);
    if (!mesh) return;
    surface.faces = mesh->faces;
    surface.edges = mesh->edges;
    surface.mesh = mesh;  // last, as the pose below: memory may run out
  }
  if (!is_rigid(own)) {
    surface.x = now.state.solids[own.number].x;
    fit_boxes(surface);
    return;
  }
  const contact::Pose pose = now.pose(own);
  if (surface.pose && surface.pose->R == pose.R && surface.pose->p == pose.p) return;
  surface.pose.reset();
  surface.x = (pose.R * surface.mesh->points).colwise() + pose.p;
  fit_boxes(surface);
  surface.pose = pose;
}

void Surfaces::fit(const Moment& now) {
  std::vector<Collider> fitted;
  for (const PairModel& pair : now.model.pairs) {
    for (const Collider& own : {pair.a, pair.b}) {
      if (std::find(fitted.begin(), fitted.end(), own) != fitted.end()) continue;
      fitted.push_back(own);
      fit(own, now);
    }
  }
}

const Surface* Surfaces::of(const Collider& own) const {
  if (own.kind == Kind::rod) return nullptr;
  const std::vector<Surface>& all = of_kind_[static_cast<std::size_t>(own.kind)];
  if (static_cast<int>(all.size()) <= own.number) return nullptr;
  const Surface& surface = all[static_cast<std::size_t>(own.number)];
  return surface.mesh ? &surface : nullptr;
}

double distance_to_triangles(const Surface& surface, const Vec3& point, double far) {
  double least = INFINITY;
  const contact::Box near(Vec3(point.array() - far), Vec3(point.array() + far));
  surface.faces.each_near(near, [&](int number) {
    const std::array<int, 3>& t = surface.mesh->triangles[number];
    const std::array<Vec3, 3> x = {surface.x.col(t[0]), surface.x.col(t[1]), surface.x.col(t[2])};
    const std::array<double, 3> weights = contact::on_triangle(point, x[0], x[1], x[2]);
    least = std::min(least, (point - weights[0] * x[0] - weights[1] * x[1] - weights[2] * x[2]).norm());
  });
  return least;
}

double depth_in(const Surface& surface, const contact::Simplex& point, double near) {
  const bool in = contact::inside(*surface.mesh, surface.x, surface.faces, point.x[0]);
  if (!in && point.radius == 0.0) return 0.0;
  // From inside something is near, somewhere.
  const double all = surface.faces.whole().sizes().norm();
  double least = INFINITY;
  for (double far = in ? 0.01 * all : near + point.radius; least == INFINITY; far *= 4.0) {
    least = distance_to_triangles(surface, point.x[0], far);
    if (!in || far > all) break;
    if (least > far) least = INFINITY;  // (beyond the box something may be nearer)
  }
  return std::max(0.0, point.radius + (in ? least : -least));
}

double depth_of_line(const Surface& surface, const contact::Simplex& line, double near) {
  const Vec3 &from = line.x[0], &to = line.x[1];
  contact::Box where;
  for (const Vec3& end : {from, to}) {
    where.extend(Vec3(end.array() - line.radius));
    where.extend(Vec3(end.array() + line.radius));
  }
  std::vector<double> passes;
  if (line.radius == 0.0) passes = {0.0, 1.0};  // (the axis of a cylinder has ends that are not round)
  surface.faces.each_near(where, [&](int number) {
    const std::array<int, 3>& t = surface.mesh->triangles[number];
    if (const auto at = pierced_at(from, to, {surface.x.col(t[0]), surface.x.col(t[1]), surface.x.col(t[2])}))
      passes.push_back(*at);
  });
  std::sort(passes.begin(), passes.end());
  double deepest = 0.0;
  for (std::size_t i = 0; i + 1 < passes.size(); ++i) {
    const double part = 0.5 * (passes[i] + passes[i + 1]);
    deepest =
        std::max(deepest, depth_in(surface, contact::point_at((1.0 - part) * from + part * to, line.radius), near));
  }
  return deepest;
}

// An end over the face, or an edge, is nearest where it does not pass through.
double distance_to_line(const Vec3& from, const Vec3& to, const std::array<Vec3, 3>& triangle) {
  if (pierced_at(from, to, triangle)) return 0.0;
  double least = INFINITY;
  for (const Vec3& end : {from, to}) {
    const std::array<double, 3> w = contact::on_triangle(end, triangle[0], triangle[1], triangle[2]);
    least = std::min(least, (w[0] * triangle[0] + w[1] * triangle[1] + w[2] * triangle[2] - end).norm());
  }
  const contact::Simplex line = contact::segment_at(from, to, Vec3::Zero(), 0.0);
  for (std::size_t i = 0; i < 3; ++i) {
    const contact::Simplex edge = contact::segment_at(triangle[i], triangle[(i + 1) % 3], Vec3::Zero(), 0.0);
    least = std::min(least, contact::nearest(line, edge).gap);
  }
  return least;
}

double longest_edge(const contact::Simplex& face) {
  const auto& x = face.x;
  return std::max({(x[0] - x[1]).norm(), (x[1] - x[2]).norm(), (x[2] - x[0]).norm()});
}

bool near_at_rest(const contact::Mesh& mesh, int node, const std::array<int, 3>& face) {
  const auto at = [&](int n) { return Vec3(mesh.points.col(n)); };
  const contact::Simplex rest{
      contact::Simplex::Kind::triangle, {at(face[0]), at(face[1]), at(face[2])}, Vec3::Zero(), 0.0};
  return std::abs(contact::nearest(contact::point_at(at(node), 0.0), rest).gap) < 0.5 * longest_edge(rest);
}

double steepest_edge(const Surface& surface, int point, const Vec3& d) {
  const Vec3 x = surface.x.col(point);
  double most = -1.0;
  surface.faces.each_near(contact::Box(x), [&](int number) {
    const std::array<int, 3>& corners = surface.mesh->triangles[number];
    if (std::find(corners.begin(), corners.end(), point) == corners.end()) return;
    for (const int other : corners) {
      if (other != point) most = std::max(most, d.dot((surface.x.col(other) - x).normalized()));
    }
  });
  return most;
}

Vec3 grazed_plane(const Surface& surface, int triangle, const Vec3& p, const Vec3& outward) {
  const auto number = static_cast<std::size_t>(triangle);
  const std::array<int, 3>& corners = surface.mesh->triangles[number];
  const Vec3 front = surface.outward.faces.col(triangle);
  for (std::size_t i = 0; i < 3; ++i) {
    const int other = surface.mesh->beside[number][i];
    if (other < 0) continue;
    Vec3 n = surface.outward.faces.col(other);
    const Vec3 from = surface.x.col(corners[i]), to = surface.x.col(corners[(i + 1) % 3]),
               opposite = surface.x.col(corners[(i + 2) % 3]);
    const double same = contact::kSamePlane * (to - from).norm(), before = front.dot(p - from);
    if (std::abs(n.dot(p - from)) > same || n.dot(outward) >= contact::kAgainst || before <= same) continue;
    // (Where the point is nearest to the triangle is in that plane, too.)
    if (n.dot(opposite - from) < -same && std::abs(n.dot(p - before * front - from)) <= same) return n;
  }
  return Vec3::Zero();
}

std::optional<Vec3> outward_of_ridge(const Surface& surface, const contact::Ridge& ridge) {
  constexpr double kFlat = 0.985;  // cosine of 10 degrees
  const auto at = [&surface](int point) { return Vec3(surface.x.col(point)); };
  if (ridge.sides[0] == ridge.sides[1])  // the rim of an open surface
    return (surface.outward.points.col(ridge.ends[0]) + surface.outward.points.col(ridge.ends[1])).normalized();
  const Vec3 from = at(ridge.ends[0]), along = at(ridge.ends[1]) - from, first = at(ridge.sides[0]) - from,
             second = at(ridge.sides[1]) - from;
  const Vec3 n = along.cross(first).normalized(), m = second.cross(along).normalized();
  if (n.dot(m) > kFlat || second.dot(n) > 0.0) return std::nullopt;
  return (n + m).normalized();
}

}  // namespace sinew
