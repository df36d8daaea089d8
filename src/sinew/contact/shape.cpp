#include "sinew/contact/shape.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace sinew::contact {

namespace {

struct NearestPart {
  const Vec3 &p, &outward;

  Simplex operator()(const HalfSpace&) const { return plane_at(Vec3::Zero(), Vec3::UnitZ()); }
  Simplex operator()(const Ball& ball) const { return point_at(Vec3::Zero(), ball.radius); }
  Simplex operator()(const Capsule& capsule) const {
    const Vec3 end(0.0, 0.0, 0.5 * capsule.length);
    return segment_at(-end, end, Vec3::Zero(), capsule.radius);
  }
  Simplex operator()(const Cylinder& cylinder) const {
    const double half = 0.5 * cylinder.length, r = std::hypot(p.x(), p.y());
    const Vec3 top(0.0, 0.0, std::copysign(half, p.z()));
    const double above = std::abs(p.z()) - half, beside = r - cylinder.radius;
    if (above <= 0.0 && beside >= above) return segment_at(-top, top, Vec3::Zero(), cylinder.radius);
    if (beside <= 0.0) return plane_at(top, top.normalized());
    return point_at(top + cylinder.radius / r * Vec3(p.x(), p.y(), 0.0), 0.0);
  }
  Simplex operator()(const Convex& convex) const {
    const Polyhedron& own = convex.surface;
    std::size_t highest = 0;
    double height = -INFINITY;
    for (std::size_t f = 0; f < own.faces.size(); ++f) {
      const double h = own.normals[f].dot(p - own.corners[own.faces[f][0]]);
      if (h <= height) continue;
      height = h;
      highest = f;
    }
    if (const int face = face_of_rim(own, height); face >= 0)
      return plane_at(own.corners[own.faces[face][0]], own.normals[face]);
    if (height <= 0.0) return plane_at(own.corners[own.faces[highest][0]], own.normals[highest]);
    // Outside: the nearest of all triangles of the faces that see p.
    double least = INFINITY;
    Simplex best;
    for (std::size_t f = 0; f < own.faces.size(); ++f) {
      const std::vector<int>& face = own.faces[f];
      const Vec3 &n = own.normals[f], &first = own.corners[face[0]];
      const double h = n.dot(p - first);
      if (h <= 0.0) continue;
      bool above = true;
      for (std::size_t i = 0; i < face.size(); ++i) {
        const Vec3 &from = own.corners[face[i]], &to = own.corners[face[(i + 1) % face.size()]];
        if (n.dot((to - from).cross(p - from)) >= 0.0) continue;
        above = false;
        const auto [s, t] = on_segment(p, from, to);
        const double distance = (s * from + t * to - p).squaredNorm();
        if (distance >= least) continue;
        least = distance;
        best = s == 0.0 || t == 0.0 ? point_at(s * from + t * to, 0.0) : segment_at(from, to, n, 0.0);
      }
      if (above && h * h < least) {
        least = h * h;
        best = plane_at(first, n);
      }
    }
    return best;
  }
  /// Of the faces that are as high below p as any, and on which p is, the one that looks most against `outward`; -1 if
  /// there is none. Where a node lies on a rim, rounding is not to choose.
  int face_of_rim(const Polyhedron& own, double height) const {
    if (outward.isZero()) return -1;
    const double same = 1e-6 * own.corners[0].norm();
    int best = -1;
    double least = INFINITY;
    for (std::size_t f = 0; f < own.faces.size(); ++f) {
      const std::vector<int>& face = own.faces[f];
      const Vec3& n = own.normals[f];
      if (n.dot(p - own.corners[face[0]]) < height - same || n.dot(outward) >= least) continue;
      bool above = true;
      for (std::size_t i = 0; i < face.size() && above; ++i) {
        const Vec3 &from = own.corners[face[i]], along = own.corners[face[(i + 1) % face.size()]] - from;
        above = n.dot(along.cross(p - from)) >= -same * along.norm();
      }
      if (!above) continue;
      least = n.dot(outward);
      best = static_cast<int>(f);
    }
    return best;
  }
  Simplex operator()(const Mesh&) const {
    throw std::invalid_argument("contact::nearest_part: a mesh is met by its triangles");
  }
};

Vec3 farthest(const Eigen::Matrix3d& axes, const Vec3& so_far, const Vec3& p) {
  return so_far.cwiseMax((axes.transpose() * p).cwiseAbs());
}

struct Reach {
  const Eigen::Matrix3d& axes;

  Vec3 operator()(const HalfSpace&) const { return Vec3::Constant(INFINITY); }
  Vec3 operator()(const Ball& ball) const { return Vec3::Constant(ball.radius); }
  Vec3 operator()(const Capsule& capsule) const {
    return (0.5 * capsule.length * axes.row(2).cwiseAbs().transpose()).array() + capsule.radius;
  }
  Vec3 operator()(const Cylinder& cylinder) const {
    Vec3 own;
    for (int i = 0; i < 3; ++i) {
      const double z = axes(2, i);
      own[i] = 0.5 * cylinder.length * std::abs(z) + cylinder.radius * std::sqrt(std::max(0.0, 1.0 - z * z));
    }
    return own;
  }
  Vec3 operator()(const Convex& convex) const {
    Vec3 own = Vec3::Zero();
    for (const Vec3& corner : convex.surface.corners) own = farthest(axes, own, corner);
    return own;
  }
  Vec3 operator()(const Mesh& mesh) const {
    Vec3 own = Vec3::Zero();
    for (const int point : mesh.used) own = farthest(axes, own, mesh.points.col(point));
    return own;
  }
};

Eigen::Matrix3d about_z(double across, double along) { return Vec3(across, across, along).asDiagonal(); }

/// The sum over tetrahedra from the origin to the triangles of a surface.
class Enclosed {
 public:
  void add(const Vec3& a, const Vec3& b, const Vec3& c) {
    const double six = a.dot(b.cross(c));
    const Vec3 sum = a + b + c;
    volume_ += six / 6.0;
    first_ += six / 24.0 * sum;
    second_ += six / 120.0 * (a * a.transpose() + b * b.transpose() + c * c.transpose() + sum * sum.transpose());
  }
  Bulk bulk() const {
    const Vec3 centre = first_ / volume_;
    const Eigen::Matrix3d about = second_ - volume_ * centre * centre.transpose();
    return {volume_, centre, about.trace() * Eigen::Matrix3d::Identity() - about};
  }

 private:
  double volume_ = 0.0;
  Vec3 first_ = Vec3::Zero();                         // int x
  Eigen::Matrix3d second_ = Eigen::Matrix3d::Zero();  // int x x^T
};

struct BulkOf {
  Bulk operator()(const HalfSpace&) const { throw std::invalid_argument("contact::bulk: a half-space has no volume"); }
  Bulk operator()(const Ball& ball) const {
    const double volume = 4.0 / 3.0 * M_PI * std::pow(ball.radius, 3), i = 0.4 * volume * ball.radius * ball.radius;
    return {volume, Vec3::Zero(), about_z(i, i)};
  }
  Bulk operator()(const Cylinder& cylinder) const {
    const double r2 = cylinder.radius * cylinder.radius, volume = M_PI * r2 * cylinder.length;
    return {volume, Vec3::Zero(),
            about_z(volume * (r2 / 4.0 + cylinder.length * cylinder.length / 12.0), volume * r2 / 2.0)};
  }
  /// A cylinder and two halves of a ball, each with its centre 3/8 r beyond the cylinder's end.
  Bulk operator()(const Capsule& capsule) const {
    const double r = capsule.radius, l = capsule.length;
    const Bulk middle = (*this)(Cylinder{r, l}), ends = (*this)(Ball{r});
    const double off = 0.5 * l + 0.375 * r;
    const double across = ends.inertia(0, 0) + ends.volume * (off * off - 9.0 / 64.0 * r * r);
    return {middle.volume + ends.volume, Vec3::Zero(), middle.inertia + about_z(across, ends.inertia(2, 2))};
  }
  Bulk operator()(const Convex& convex) const {
    Enclosed own;
    const Polyhedron& body = convex.surface;
    for (const std::vector<int>& face : body.faces) {
      for (std::size_t i = 1; i + 1 < face.size(); ++i)
        own.add(body.corners[face[0]], body.corners[face[i]], body.corners[face[i + 1]]);
    }
    return own.bulk();
  }
  Bulk operator()(const Mesh& mesh) const {
    Enclosed own;
    for (const std::array<int, 3>& t : mesh.triangles)
      own.add(mesh.points.col(t[0]), mesh.points.col(t[1]), mesh.points.col(t[2]));
    return own.bulk();
  }
};

void add_face(Skin& skin, const std::vector<int>& face) {
  for (std::size_t i = 1; i + 1 < face.size(); ++i) skin.triangles.push_back({face[0], face[i], face[i + 1]});
}

/// Rings around z, given as radius and height, from top to bottom; poles have no radius.
Skin turned(const std::vector<std::array<double, 2>>& profile) {
  constexpr int kSides = 32;
  Skin own;
  for (const auto& [r, z] : profile) {
    for (int k = 0; k < kSides; ++k) {
      const double angle = 2.0 * M_PI * k / kSides;
      own.points.emplace_back(r * std::cos(angle), r * std::sin(angle), z);
    }
  }
  for (int i = 0; i + 1 < static_cast<int>(profile.size()); ++i) {
    for (int k = 0; k < kSides; ++k) {
      const int a = i * kSides + k, b = i * kSides + (k + 1) % kSides;
      if (profile[i][0] > 0.0) own.triangles.push_back({a, b + kSides, b});
      if (profile[i + 1][0] > 0.0) own.triangles.push_back({a, a + kSides, b + kSides});
    }
  }
  return own;
}

/// The corners of a polyhedron, with a direction out of it.
std::vector<Simplex> corners_of(const Polyhedron& own) {
  std::vector<Simplex> all;
  for (const Vec3& corner : own.corners) all.push_back(point_at(corner, 0.0));
  for (std::size_t f = 0; f < own.faces.size(); ++f) {
    for (const int corner : own.faces[f]) all[corner].normal += own.normals[f];
  }
  for (Simplex& corner : all) corner.normal.normalize();
  return all;
}

struct Prongs {
  std::vector<Simplex> operator()(const HalfSpace&) const { return {}; }
  std::vector<Simplex> operator()(const Ball& ball) const { return {point_at(Vec3::Zero(), ball.radius)}; }
  std::vector<Simplex> operator()(const Capsule& capsule) const {
    const Vec3 end(0.0, 0.0, 0.5 * capsule.length);
    return {point_at(-end, capsule.radius), point_at(end, capsule.radius),
            segment_at(-end, end, Vec3::Zero(), capsule.radius)};
  }
  std::vector<Simplex> operator()(const Cylinder& cylinder) const {
    const Vec3 end(0.0, 0.0, 0.5 * cylinder.length);
    const Polyhedron own = prism(cylinder);
    std::vector<Simplex> all = corners_of(own);
    all.push_back(segment_at(-end, end, Vec3::Zero(), cylinder.radius));
    for (std::size_t e = 0; e < own.edges.size(); ++e) {
      if (own.sides[e][0] < 2) all.push_back(edge_of(own, e));  // of an end and a side
    }
    return all;
  }
  std::vector<Simplex> operator()(const Convex& convex) const {
    const Polyhedron& own = convex.surface;
    std::vector<Simplex> all = corners_of(own);
    for (std::size_t e = 0; e < own.edges.size(); ++e) all.push_back(edge_of(own, e));
    return all;
  }
  std::vector<Simplex> operator()(const Mesh&) const { return {}; }
};

/// The two halves of a ball, apart by `length`.
Skin round_skin(double radius, double length) {
  constexpr int kHalf = 8;
  std::vector<std::array<double, 2>> profile;
  for (int i = 0; i <= 2 * kHalf; ++i) {
    const double angle = 0.5 * M_PI * i / kHalf, shift = i <= kHalf ? 0.5 * length : -0.5 * length;
    const bool pole = i == 0 || i == 2 * kHalf;
    profile.push_back({pole ? 0.0 : radius * std::sin(angle), radius * std::cos(angle) + shift});
    if (i == kHalf && length > 0.0) profile.push_back({radius, -0.5 * length});
  }
  return turned(profile);
}

struct SkinOf {
  double size;

  Skin operator()(const HalfSpace&) const {
    const double e = 0.5 * size;
    Skin own{{Vec3(-e, -e, 0), Vec3(e, -e, 0), Vec3(e, e, 0), Vec3(-e, e, 0)}, {}};
    add_face(own, {0, 1, 2, 3});
    return own;
  }
  Skin operator()(const Ball& ball) const { return round_skin(ball.radius, 0.0); }
  Skin operator()(const Capsule& capsule) const { return round_skin(capsule.radius, capsule.length); }
  Skin operator()(const Cylinder& cylinder) const {
    const double h = 0.5 * cylinder.length, r = cylinder.radius;
    return turned({{0.0, h}, {r, h}, {r, -h}, {0.0, -h}});
  }
  Skin operator()(const Convex& convex) const {
    Skin own{convex.surface.corners, {}};
    for (const std::vector<int>& face : convex.surface.faces) add_face(own, face);
    return own;
  }
  Skin operator()(const Mesh& mesh) const {
    Skin own{{}, mesh.triangles};
    for (Eigen::Index i = 0; i < mesh.points.cols(); ++i) own.points.emplace_back(mesh.points.col(i));
    return own;
  }
};

}  // namespace

Simplex edge_of(const Polyhedron& own, std::size_t e) {
  const Vec3 between = own.normals[own.sides[e][0]] + own.normals[own.sides[e][1]];
  return segment_at(own.corners[own.edges[e][0]], own.corners[own.edges[e][1]], between.normalized(), 0.0);
}

Polyhedron prism(const Cylinder& cylinder) { return prism(cylinder.radius, cylinder.length, kPrismSides); }
Skin skin(const Shape& shape, double size) { return std::visit(SkinOf{size}, shape); }
Vec3 grazed_plane(const Shape& shape, const Vec3& p, const Simplex& part, const Vec3& outward) {
  const Nearest found = nearest(point_at(p, 0.0), part);
  const Vec3 foot = p - found.gap * found.normal;
  const auto grazes = [&](const Vec3& n, double height, double same) {
    return found.gap > same && n.dot(outward) < kAgainst && std::abs(n.dot(p) - height) <= same &&
           std::abs(n.dot(foot) - height) <= same;
  };
  if (const Cylinder* const own = std::get_if<Cylinder>(&shape)) {
    const Vec3 up(0.0, 0.0, std::copysign(1.0, p.z()));
    return grazes(up, 0.5 * own->length, kSamePlane * std::max(own->radius, own->length)) ? up : Vec3(Vec3::Zero());
  }
  if (const Convex* const own = std::get_if<Convex>(&shape)) {
    const Polyhedron& surface = own->surface;
    const double same = kSamePlane * surface.corners[0].norm();
    for (std::size_t f = 0; f < surface.faces.size(); ++f) {
      const Vec3& n = surface.normals[f];
      if (grazes(n, n.dot(surface.corners[surface.faces[f][0]]), same)) return n;
    }
  }
  return Vec3::Zero();
}
Simplex nearest_part(const Shape& shape, const Vec3& p, const Vec3& outward) {
  return std::visit(NearestPart{p, outward}, shape);
}
std::vector<Simplex> prongs(const Shape& shape) { return std::visit(Prongs{}, shape); }
Vec3 reach(const Shape& shape, const Eigen::Matrix3d& axes) { return std::visit(Reach{axes}, shape); }
Bulk bulk(const Shape& shape) { return std::visit(BulkOf{}, shape); }

}  // namespace sinew::contact
