#include "sinew/solid/embedding.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <span>
#include <stdexcept>

namespace sinew::solid {

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
/// Local coordinates out of bounds by less than this are inside, on a face: Newton's rounding.
constexpr double kRounding = 1e-10;

/// A point of a triangle by its barycentric coordinates.
struct Foot {
  Vec3 barycentric = Vec3::Zero();
  double squared_distance = infinity;
};

/// The nearest of points a + t (b - a), 0 <= t <= 1.
double nearest_on_segment(const Vec3& x, const Vec3& a, const Vec3& b) {
  const Vec3 ab = b - a;
  const double length2 = ab.squaredNorm();
  return length2 > 0.0 ? std::clamp((x - a).dot(ab) / length2, 0.0, 1.0) : 0.0;
}

Foot nearest_on_triangle(const Vec3& x, const std::array<Vec3, 3>& corner) {
  const auto& [a, b, c] = corner;
  const Vec3 normal = (b - a).cross(c - a);
  const double area2 = normal.squaredNorm();
  const Vec3 areas((c - b).cross(x - b).dot(normal), (a - c).cross(x - c).dot(normal),
                   (b - a).cross(x - a).dot(normal));
  if (area2 > 0.0 && areas.minCoeff() >= 0.0) {
    const double height = (x - a).dot(normal);
    return {areas / area2, height * height / area2};
  }
  Foot nearest;
  for (int i = 0; i < 3; ++i) {
    const int j = (i + 1) % 3;
    const double t = nearest_on_segment(x, corner[i], corner[j]);
    const double squared = (x - corner[i] - t * (corner[j] - corner[i])).squaredNorm();
    if (squared < nearest.squared_distance) nearest = {(1.0 - t) * Vec3::Unit(i) + t * Vec3::Unit(j), squared};
  }
  return nearest;
}

/// Where a point stands to one element.
struct Place {
  Vec3 local = Vec3::Zero();  ///< its local coordinates; outside, those of the foot
  double squared_distance = infinity;
  bool inside = false;
};

/// The nearest point of the faces as triangles of nodes.
Place nearest_on_faces(Kind kind, const NodeVectors& X, const Vec3& x) {
  const auto reference = reference_nodes(kind);
  Place nearest;
  for (const Face& face : faces(kind)) {
    for (const auto& triangle : face_triangles(face.nodes)) {
      std::array<int, 3> node{};
      for (int i = 0; i < 3; ++i) node[i] = face.node[triangle[i]];
      const Foot foot = nearest_on_triangle(x, {X.col(node[0]), X.col(node[1]), X.col(node[2])});
      if (!(foot.squared_distance < nearest.squared_distance)) continue;
      nearest.squared_distance = foot.squared_distance;
      nearest.local.setZero();
      for (int i = 0; i < 3; ++i) nearest.local += foot.barycentric[i] * reference[node[i]];
    }
  }
  return nearest;
}

/// The nearest point of the reference element, or about it.
Vec3 clamped(Kind kind, const Vec3& xi) {
  if (kind == Kind::hex8) return xi.cwiseMax(-1.0).cwiseMin(1.0);
  const Vec3 positive = xi.cwiseMax(0.0);
  return positive / std::max(1.0, positive.sum());
}

Place place_in(Kind kind, const NodeVectors& X, const Vec3& x) {
  const std::optional<Vec3> xi = local_coordinates(kind, X, x);
  if (xi && outside(kind, *xi) <= kRounding) return {*xi, 0.0, true};
  Place place = nearest_on_faces(kind, X, x);
  if (!xi) return place;
  // Of a curved face the triangles are only near, so that close to it this foot is the nearer one: none but it keeps
  // positions continuous across the face.
  const auto squared_gap = [&](const Vec3& foot) {
    return (x - X.lazyProduct(shape_functions(kind, foot))).squaredNorm();
  };
  const Vec3 foot = clamped(kind, *xi);
  const double gap = squared_gap(foot);
  if (gap < squared_gap(place.local)) place.local = foot;
  place.squared_distance = std::min(place.squared_distance, gap);
  return place;
}

Mat3 slope(Kind kind, const NodeVectors& X, const Vec3& local) {
  return X.lazyProduct(shape_slopes(kind, local).transpose());
}

/// How far x lies from the foot in local coordinates.
Vec3 local_step(Kind kind, const NodeVectors& X, const Vec3& local, const Vec3& x) {
  const Vec3 gap = x - X.lazyProduct(shape_functions(kind, local));
  return slope(kind, X, local).partialPivLu().solve(gap);
}

/// How much continuing the field from its place to x extrapolates, in sizes of the element.
double extrapolation(Kind kind, const NodeVectors& X, const Place& place, const Vec3& x) {
  if (place.inside) return 0.0;
  const double violation = outside(kind, place.local + local_step(kind, X, place.local, x));
  return kind == Kind::hex8 ? 0.5 * violation : violation;
}

double squared_distance_to_nodes(const Eigen::Matrix3Xd& nodes, const std::vector<Cell>& cells, const Vec3& x) {
  double least = infinity;
  for (const Cell& cell : cells) {
    for (const int node : cell.nodes()) least = std::min(least, (nodes.col(node) - x).squaredNorm());
  }
  return least;
}

/// From a box that holds the element: it cannot be nearer.
double squared_distance_to_box(const Eigen::Matrix3Xd& nodes, const Cell& cell, const Vec3& x) {
  Vec3 lower = Vec3::Constant(infinity), upper = -lower;
  for (const int node : cell.nodes()) {
    lower = lower.cwiseMin(nodes.col(node));
    upper = upper.cwiseMax(nodes.col(node));
  }
  // The negative shape functions of a 10-node tetrahedron sum to no less than -1/2 anywhere in it.
  if (cell.kind == Kind::tet10) {
    const Vec3 bulge = 0.5 * (upper - lower);
    lower -= bulge;
    upper += bulge;
  }
  return (x - x.cwiseMax(lower).cwiseMin(upper)).squaredNorm();
}

}  // namespace

EmbeddedPoint at_node(const Eigen::Matrix3Xd& nodes, const std::vector<Cell>& cells, int node) {
  EmbeddedPoint point;
  for (std::size_t e = 0; e < cells.size(); ++e) {
    const std::span<const int> own = cells[e].nodes();
    const auto found = std::find(own.begin(), own.end(), node);
    if (found == own.end()) continue;
    point.element = static_cast<int>(e);
    point.local = local_coordinates(cells[e].kind, cell_nodes(nodes, cells[e]), nodes.col(node)).value_or(Vec3::Zero());
    point.weights = NodeValues::Unit(static_cast<Eigen::Index>(own.size()), found - own.begin());
    return point;
  }
  throw std::invalid_argument("at_node: no element has it");
}

EmbeddedPoint embed(const Eigen::Matrix3Xd& nodes, const std::vector<Cell>& cells, const Vec3& x) {
  EmbeddedPoint best;
  const double bound = squared_distance_to_nodes(nodes, cells, x);  // so that few elements are looked at closely
  double nearest = infinity, least = infinity;
  for (std::size_t e = 0; e < cells.size() && !(nearest == 0.0 && least == 0.0); ++e) {
    if (squared_distance_to_box(nodes, cells[e], x) > std::min(bound, nearest) * (1.0 + 1e-9)) continue;
    const NodeVectors X = cell_nodes(nodes, cells[e]);
    const Place place = place_in(cells[e].kind, X, x);
    if (place.squared_distance > nearest * (1.0 + 1e-9)) continue;
    const double own = extrapolation(cells[e].kind, X, place, x);
    if (best.element < 0 || place.squared_distance < nearest * (1.0 - 1e-9) || own < least) {
      least = own;
      best.element = static_cast<int>(e);
      best.local = place.local;
    }
    nearest = std::min(nearest, place.squared_distance);
  }
  if (best.element < 0) return best;
  best.distance = std::sqrt(nearest);
  const Cell& cell = cells[static_cast<std::size_t>(best.element)];
  const NodeVectors X = cell_nodes(nodes, cell);
  best.weights = shape_functions(cell.kind, best.local);
  best.weights += shape_slopes(cell.kind, best.local).transpose() * local_step(cell.kind, X, best.local, x);
  return best;
}

Vec3 position(const EmbeddedPoint& point, const std::vector<Cell>& cells, const Eigen::Matrix3Xd& x) {
  const std::span<const int> numbers = cells[static_cast<std::size_t>(point.element)].nodes();
  Vec3 p = Vec3::Zero();
  for (std::size_t i = 0; i < numbers.size(); ++i) p += point.weights[i] * x.col(numbers[i]);
  return p;
}

NodeVectors gradients(const Eigen::Matrix3Xd& nodes, const Cell& cell, const Vec3& local) {
  const NodeVectors X = cell_nodes(nodes, cell);
  return slope(cell.kind, X, local).transpose().partialPivLu().solve(shape_slopes(cell.kind, local));
}

EmbeddedPoint embed_vector(const Eigen::Matrix3Xd& nodes, const std::vector<Cell>& cells, const EmbeddedPoint& point,
                           const Vec3& e) {
  EmbeddedPoint vector = point;
  vector.weights = gradients(nodes, cells[static_cast<std::size_t>(point.element)], point.local).transpose() * e;
  return vector;
}

}  // namespace sinew::solid
