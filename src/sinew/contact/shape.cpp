#include "sinew/contact/shape.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace sinew::contact {

namespace {

struct NearestPart {
  const Vec3& p;

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
};

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
    for (const Vec3& corner : convex.surface.corners) own = own.cwiseMax((axes.transpose() * corner).cwiseAbs());
    return own;
  }
};

Eigen::Matrix3d about_z(double across, double along) { return Vec3(across, across, along).asDiagonal(); }

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
  /// The sum over tetrahedra from the origin to triangles of the faces.
  Bulk operator()(const Convex& convex) const {
    Bulk own{0.0, Vec3::Zero(), Eigen::Matrix3d::Zero()};
    Eigen::Matrix3d second = Eigen::Matrix3d::Zero();  // int x x^T
    const Polyhedron& body = convex.surface;
    for (const std::vector<int>& face : body.faces) {
      for (std::size_t i = 1; i + 1 < face.size(); ++i) {
        const Vec3 &a = body.corners[face[0]], &b = body.corners[face[i]], &c = body.corners[face[i + 1]];
        const double six = a.dot(b.cross(c));
        const Vec3 sum = a + b + c;
        own.volume += six / 6.0;
        own.centre += six / 24.0 * sum;
        second += six / 120.0 * (a * a.transpose() + b * b.transpose() + c * c.transpose() + sum * sum.transpose());
      }
    }
    own.centre /= own.volume;
    second -= own.volume * own.centre * own.centre.transpose();
    own.inertia = second.trace() * Eigen::Matrix3d::Identity() - second;
    return own;
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
    return {segment_at(-end, end, Vec3::Zero(), cylinder.radius)};
  }
  std::vector<Simplex> operator()(const Convex& convex) const {
    const Polyhedron& own = convex.surface;
    std::vector<Simplex> all;
    for (const Vec3& corner : own.corners) all.push_back(point_at(corner, 0.0));
    for (std::size_t e = 0; e < own.edges.size(); ++e) {
      const Vec3 between = own.normals[own.sides[e][0]] + own.normals[own.sides[e][1]];
      all.push_back(segment_at(own.corners[own.edges[e][0]], own.corners[own.edges[e][1]], between.normalized(), 0.0));
    }
    return all;
  }
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
};

}  // namespace

Skin skin(const Shape& shape, double size) { return std::visit(SkinOf{size}, shape); }
Simplex nearest_part(const Shape& shape, const Vec3& p) { return std::visit(NearestPart{p}, shape); }
std::vector<Simplex> prongs(const Shape& shape) { return std::visit(Prongs{}, shape); }
Vec3 reach(const Shape& shape, const Eigen::Matrix3d& axes) { return std::visit(Reach{axes}, shape); }
Bulk bulk(const Shape& shape) { return std::visit(BulkOf{}, shape); }

}  // namespace sinew::contact
