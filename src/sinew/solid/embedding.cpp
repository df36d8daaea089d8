#include "sinew/solid/embedding.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <limits>

namespace sinew::solid {

namespace {

using Vec3 = Eigen::Vector3d;

/// Barycentric coordinates of x.
Eigen::Vector4d barycentric(const Eigen::Matrix3Xd& nodes, const Tetrahedron& t, const Vec3& x) {
  Eigen::Matrix3d edges;
  for (int i = 0; i < 3; ++i) edges.col(i) = nodes.col(t[i + 1]) - nodes.col(t[0]);
  const Vec3 w = edges.partialPivLu().solve(x - nodes.col(t[0]));
  return {1.0 - w.sum(), w[0], w[1], w[2]};
}

double squared_distance_to_segment(const Vec3& x, const Vec3& a, const Vec3& b) {
  const Vec3 ab = b - a;
  const double t = std::clamp((x - a).dot(ab) / ab.squaredNorm(), 0.0, 1.0);
  return (x - a - t * ab).squaredNorm();
}

double squared_distance_to_triangle(const Vec3& x, const Vec3& a, const Vec3& b, const Vec3& c) {
  const Vec3 normal = (b - a).cross(c - a);
  const double area2 = normal.squaredNorm();
  const double u = (c - b).cross(x - b).dot(normal), v = (a - c).cross(x - c).dot(normal),
               w = (b - a).cross(x - a).dot(normal);
  if (u >= 0.0 && v >= 0.0 && w >= 0.0) {
    const double height = (x - a).dot(normal);
    return height * height / area2;
  }
  return std::min({squared_distance_to_segment(x, a, b), squared_distance_to_segment(x, b, c),
                   squared_distance_to_segment(x, c, a)});
}

}  // namespace

EmbeddedPoint embed(const Eigen::Matrix3Xd& nodes, const std::vector<Tetrahedron>& tetrahedra, const Vec3& x) {
  EmbeddedPoint best;
  double best_distance = std::numeric_limits<double>::infinity(),
         best_weight = -std::numeric_limits<double>::infinity();
  for (std::size_t e = 0; e < tetrahedra.size(); ++e) {
    const Tetrahedron& t = tetrahedra[e];
    const Eigen::Vector4d w = barycentric(nodes, t, x);
    double distance = 0.0;
    if (w.minCoeff() < 0.0) {
      const auto face = [&](int i, int j, int k) {
        return squared_distance_to_triangle(x, nodes.col(t[i]), nodes.col(t[j]), nodes.col(t[k]));
      };
      distance = std::min({face(0, 1, 2), face(0, 1, 3), face(0, 2, 3), face(1, 2, 3)});
    }
    // Among elements at equal distance (a shared face or edge) the one that extrapolates least.
    if (distance < best_distance * (1.0 - 1e-9) ||
        (distance <= best_distance * (1.0 + 1e-9) && w.minCoeff() > best_weight)) {
      best_distance = std::min(distance, best_distance);
      best_weight = w.minCoeff();
      best.element = static_cast<int>(e);
      best.weights = w;
    }
  }
  best.distance = std::sqrt(best_distance);
  return best;
}

Vec3 position(const EmbeddedPoint& point, const std::vector<Tetrahedron>& tetrahedra, const Eigen::Matrix3Xd& x) {
  const Tetrahedron& t = tetrahedra[point.element];
  Vec3 p = Vec3::Zero();
  for (int i = 0; i < 4; ++i) p += point.weights[i] * x.col(t[i]);
  return p;
}

}  // namespace sinew::solid
