#include "sinew/contact/simplex.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace sinew::contact {

Simplex point_at(const Vec3& x, double radius) {
  Simplex own;
  own.x[0] = x;
  own.radius = radius;
  return own;
}

Simplex segment_at(const Vec3& from, const Vec3& to, const Vec3& outward, double radius) {
  Simplex own;
  own.kind = Simplex::Kind::segment;
  own.x = {from, to, Vec3::Zero()};
  own.normal = outward;
  own.radius = radius;
  return own;
}

Simplex plane_at(const Vec3& x, const Vec3& normal) {
  Simplex own;
  own.kind = Simplex::Kind::plane;
  own.x[0] = x;
  own.normal = normal;
  return own;
}

Simplex circle_at(const Vec3& middle, const Vec3& axis, double radius, const Vec3& low) {
  Simplex own = point_at(middle, 0.0);
  own.rim = radius * axis;
  own.low = low;
  return own;
}

Vec3 lowest_on_rim(const Simplex& own, const Vec3& normal) {
  const double radius = own.rim.norm();
  if (radius == 0.0) return Vec3::Zero();
  const Vec3 axis = own.rim / radius;
  Vec3 down = axis * axis.dot(normal) - normal;
  if (const double tilt = down.norm(); tilt < kFlatRim) down += (kFlatRim - tilt) * own.low;
  const double length = down.norm();
  return radius * (length > 1e-9 ? Vec3(down / length) : axis.unitOrthogonal());
}

std::array<double, 2> on_segment(const Vec3& p, const Vec3& x, const Vec3& y) {
  const Vec3 d = y - x;
  const double length = d.squaredNorm();
  const double t = length > 0.0 ? std::clamp(d.dot(p - x) / length, 0.0, 1.0) : 0.0;
  return {1.0 - t, t};
}

// Outside an edge's plane the nearest point is on that edge or beyond its ends; inside all three it is above the face.
std::array<double, 3> on_triangle(const Vec3& p, const Vec3& x, const Vec3& y, const Vec3& z) {
  const Vec3 n = (y - x).cross(z - x);
  const double area = n.squaredNorm();
  const double wx = n.dot((y - p).cross(z - p)), wy = n.dot((z - p).cross(x - p)), wz = n.dot((x - p).cross(y - p));
  if (area > 0.0 && wx >= 0.0 && wy >= 0.0 && wz >= 0.0) {
    const double sum = wx + wy + wz;
    return {wx / sum, wy / sum, wz / sum};
  }
  const std::array<const Vec3*, 3> corner = {&x, &y, &z};
  std::array<double, 3> best{};
  double least = INFINITY;
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t j = (i + 1) % 3;
    const auto [s, t] = on_segment(p, *corner[i], *corner[j]);
    const double distance = (s * *corner[i] + t * *corner[j] - p).squaredNorm();
    if (distance >= least) continue;
    least = distance;
    best = {};
    best[i] = s;
    best[j] = t;
  }
  return best;
}

namespace {

Vec3 point_of(const Simplex& simplex, const std::array<double, 3>& weights) {
  Vec3 p = Vec3::Zero();
  for (std::size_t i = 0; i < static_cast<std::size_t>(simplex.corners()); ++i) p += weights[i] * simplex.x[i];
  return p;
}

/// The sine below which two segments are parallel: the direction across both is rounding's.
constexpr double kParallel = 1e-6;

/// Across two segments; zero where they are parallel.
Vec3 across(const Simplex& a, const Simplex& b) {
  const Vec3 d = a.x[1] - a.x[0], e = b.x[1] - b.x[0], n = d.cross(e);
  return n.norm() > kParallel * d.norm() * e.norm() ? n : Vec3(Vec3::Zero());
}

/// The nearest points of two segments. Where they are parallel, the middle of what lies side by side.
void cross_segments(const Simplex& a, const Simplex& b, Nearest& found) {
  const Vec3 d = a.x[1] - a.x[0], e = b.x[1] - b.x[0], r = a.x[0] - b.x[0];
  const double dd = d.squaredNorm(), ee = e.squaredNorm(), de = d.dot(e), dr = d.dot(r), er = e.dot(r);
  const double apart = dd * ee - de * de;
  double s = 0.5;
  if (apart > kParallel * kParallel * dd * ee) {
    s = std::clamp((de * er - ee * dr) / apart, 0.0, 1.0);
  } else if (dd > 0.0) {
    // b's ends along a.
    const double one = std::clamp(-dr / dd, 0.0, 1.0), other = std::clamp((de - dr) / dd, 0.0, 1.0);
    s = 0.5 * (one + other);
  }
  double t = ee > 0.0 ? (de * s + er) / ee : 0.0;
  if (t < 0.0 || t > 1.0) {
    t = std::clamp(t, 0.0, 1.0);
    s = dd > 0.0 ? std::clamp((de * t - dr) / dd, 0.0, 1.0) : 0.0;
  }
  found.a = {1.0 - s, s, 0.0};
  found.b = {1.0 - t, t, 0.0};
}

/// Along the line between the two points; where that has no direction, the one that is told.
void along_distance(const Simplex& a, const Simplex& b, const Vec3& otherwise, Nearest& found) {
  const Vec3 d = point_of(a, found.a) - point_of(b, found.b);
  const double distance = d.norm();
  found.normal = distance > 0.0 ? Vec3(d / distance) : otherwise;
  found.gap = distance;
}

}  // namespace

bool over_face(const Simplex& b, const Vec3& p) {
  const Vec3 n = (b.x[1] - b.x[0]).cross(b.x[2] - b.x[0]);
  const double area = n.squaredNorm();
  if (!(area > 0.0)) return false;
  std::array<double, 3> part{};  // of the point over which p is
  for (std::size_t i = 0; i < 3; ++i) part[i] = n.dot((b.x[(i + 1) % 3] - p).cross(b.x[(i + 2) % 3] - p)) / area;
  constexpr double kMargin = 1e-3;  // a third wall may stand at the edge's end
  const auto first = static_cast<std::size_t>(b.valley), last = (first + 1) % 3;
  if (part[(first + 2) % 3] >= 0.0) return part[first] >= -kMargin && part[last] >= -kMargin;
  const Vec3 edge = b.x[last] - b.x[first];
  const double along = edge.dot(p - b.x[first]) / edge.squaredNorm();
  return along >= -kMargin && along <= 1.0 + kMargin;
}

Nearest nearest(const Simplex& a, const Simplex& b) {
  using enum Simplex::Kind;
  Nearest found;
  if (a.kind == segment && b.kind == segment) {
    cross_segments(a, b, found);
    const double s = found.a[1], t = found.b[1];
    const Vec3 both = across(a, b);
    const bool inside = s > 0.0 && s < 1.0 && t > 0.0 && t < 1.0;
    // Edges of bodies cross on the outside of both, which `normal` of b tells; thick ones are apart.
    if (inside && b.normal.squaredNorm() > 0.0 && !both.isZero(0.0)) {
      found.normal = both.normalized() * (both.dot(b.normal) < 0.0 ? -1.0 : 1.0);
      found.gap = found.normal.dot(point_of(a, found.a) - point_of(b, found.b));
    } else {
      const Vec3 otherwise = b.normal.isZero() && !both.isZero(0.0) ? Vec3(both.normalized()) : b.normal;
      along_distance(a, b, otherwise, found);
    }
  } else if (a.kind == point) {
    found.a[0] = 1.0;
    const Vec3& p = a.x[0];
    switch (b.kind) {
      case point:
        found.b[0] = 1.0;
        along_distance(a, b, Vec3::UnitX(), found);
        break;
      case segment: {
        const auto [s, t] = on_segment(p, b.x[0], b.x[1]);
        found.b = {s, t, 0.0};
        along_distance(a, b, (b.x[1] - b.x[0]).unitOrthogonal(), found);
        break;
      }
      case triangle: {
        found.b = on_triangle(p, b.x[0], b.x[1], b.x[2]);
        const Vec3 n = (b.x[1] - b.x[0]).cross(b.x[2] - b.x[0]).normalized();
        const Vec3 d = p - point_of(b, found.b);
        const bool over = b.valley >= 0 ? over_face(b, p) : found.b[0] > 0.0 && found.b[1] > 0.0 && found.b[2] > 0.0;
        if (over) {
          found.normal = n;
          found.gap = n.dot(d);
        } else {
          along_distance(a, b, n, found);
          if (b.valley < 0 && d.dot(b.normal.isZero() ? n : b.normal) < 0.0) {
            found.normal = -found.normal;
            found.gap = -found.gap;
          }
        }
        break;
      }
      case plane:
        found.b[0] = 1.0;
        found.normal = b.normal;
        found.gap = b.normal.dot(p + lowest_on_rim(a, b.normal) - b.x[0]);
        break;
    }
  } else {
    throw std::invalid_argument("contact::nearest: a point or two segments are needed");
  }
  found.gap -= a.radius + b.radius;
  return found;
}

namespace {

Vec3 face_normal(const Simplex& b) {
  return b.kind == Simplex::Kind::plane ? b.normal : Vec3((b.x[1] - b.x[0]).cross(b.x[2] - b.x[0]).normalized());
}

bool inside(const std::array<double, 3>& weights, int corners) {
  return std::all_of(weights.begin(), weights.begin() + corners, [](double weight) { return weight > 0.0; });
}

}  // namespace

Facing facing(const Simplex& a, const Simplex& b) {
  using enum Simplex::Kind;
  using enum Facing::Kind;
  const Nearest found = nearest(a, b);
  const bool thin = a.radius + b.radius == 0.0;
  if (b.kind == plane) return {face, found.normal};
  if (b.kind == triangle) {
    const double edge = std::max((b.x[1] - b.x[0]).norm(), (b.x[2] - b.x[0]).norm());
    if (thin && (b.valley >= 0 || inside(found.b, 3) || std::abs(found.gap) < 1e-3 * edge)) return {face, found.normal};
  }
  if (a.kind == segment && b.kind == segment && inside(found.a, 2) && inside(found.b, 2) && !b.normal.isZero() &&
      !across(a, b).isZero(0.0))
    return {crossing, found.normal};
  return {thin ? fixed : apart, found.normal, found.gap + a.radius + b.radius >= 0.0};
}

Nearest nearest(const Simplex& a, const Simplex& b, const Facing& kept) {
  Nearest found = nearest(a, b);
  if (kept.kind == Facing::Kind::apart) {
    const double distance = found.gap + a.radius + b.radius;
    if (kept.outside && distance < 0.0 && b.kind == Simplex::Kind::triangle && !inside(found.b, 3)) {
      found.normal = -found.normal;
      found.gap = -distance - a.radius - b.radius;
    }
    return found;
  }
  if (b.valley >= 0 && !over_face(b, a.x[0])) return found;
  found.normal = kept.normal;
  if (kept.kind == Facing::Kind::face) found.normal = face_normal(b);
  if (kept.kind == Facing::Kind::crossing) {
    const Vec3 both = across(a, b).normalized();
    if (!both.isZero(0.0)) found.normal = both.dot(kept.normal) < 0.0 ? Vec3(-both) : both;
  }
  found.gap = found.normal.dot(point_of(a, found.a) + lowest_on_rim(a, found.normal) - point_of(b, found.b)) -
              a.radius - b.radius;
  return found;
}

GapHessian gap_hessian(const Simplex& a, const Simplex& b, const Nearest& found, const Facing& kept) {
  constexpr int kMostParameters = 4;
  const int of_a = a.corners(), corners = of_a + b.corners();
  GapHessian H = GapHessian::Zero(3 * corners, 3 * corners);
  const double d = found.gap + a.radius + b.radius;
  const bool apart = kept.kind == Facing::Kind::apart;
  if (kept.kind == Facing::Kind::fixed || b.kind == Simplex::Kind::plane || !a.rim.isZero() || (apart && d == 0.0))
    return H;
  Eigen::Matrix<double, 3, Eigen::Dynamic, 0, 3, kMostParameters> e(3, 0);
  Eigen::Matrix<double, 6, Eigen::Dynamic, 0, 6, kMostParameters> C(6, 0);
  Eigen::Matrix<double, 6, 1> c = Eigen::Matrix<double, 6, 1>::Zero();
  const auto add_side = [&](const Simplex& own, const std::array<double, 3>& weights, int first_row, double sign) {
    int first = -1;
    for (int i = 0; i < own.corners(); ++i) {
      const auto k = static_cast<std::size_t>(i);
      c[first_row + i] = sign * weights[k];
      if (apart && !(weights[k] > 0.0)) continue;  // it is past that corner
      if (first < 0) {
        first = i;
        continue;
      }
      const Eigen::Index column = e.cols();
      e.conservativeResize(3, column + 1);
      C.conservativeResize(6, column + 1);
      C.col(column).setZero();
      C(first_row + i, column) = sign;
      C(first_row + first, column) = -sign;
      e.col(column) = sign * (own.x[k] - own.x[static_cast<std::size_t>(first)]);
    }
  };
  add_side(a, found.a, 0, 1.0);
  add_side(b, found.b, of_a, -1.0);
  const Vec3& n = found.normal;
  Eigen::Matrix<double, Eigen::Dynamic, 3, 0, kMostParameters, 3> slides;                             // G^-1 e^T
  Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, kMostParameters, 6> follows(e.cols(), 6);  // G^-1 C^T
  slides.resize(e.cols(), 3);
  if (e.cols() > 0) {
    const Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, kMostParameters, kMostParameters> G =
        e.transpose() * e;
    const auto inverse = G.inverse().eval();
    if (!inverse.allFinite()) return H;  // edges side by side
    slides = inverse * e.transpose();
    follows = inverse * C.transpose();
  }
  Eigen::Matrix3d across = Eigen::Matrix3d::Zero();  // two directions to slide in leave none across
  if (e.cols() < 2) across = (Eigen::Matrix3d::Identity() - n * n.transpose() - e * slides) / d;
  for (int i = 0; i < corners; ++i) {
    for (int j = 0; j < corners; ++j) {
      const Vec3 own = e * follows.col(i), other = e * follows.col(j);
      H.block<3, 3>(3 * i, 3 * j) = c[i] * c[j] * across - c[i] * other * n.transpose() - n * own.transpose() * c[j] -
                                    d * C.row(i).dot(follows.col(j)) * n * n.transpose();
    }
  }
  return H;
}

}  // namespace sinew::contact
