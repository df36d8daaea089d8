#include "sinew/solid/element.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

namespace sinew::solid {
namespace {

/// Barycentric coordinates of a tetrahedron or a triangle, and their constant slopes.
std::array<double, 4> barycentric(const Vec3& xi) { return {1.0 - xi.sum(), xi[0], xi[1], xi[2]}; }
std::array<double, 3> barycentric(const Eigen::Vector2d& xi) { return {1.0 - xi.sum(), xi[0], xi[1]}; }
constexpr std::array<double, 12> kTetrahedronSlopes = {-1, -1, -1, 1, 0, 0, 0, 1, 0, 0, 0, 1};
constexpr std::array<double, 6> kTriangleSlopes = {-1, -1, 1, 0, 0, 1};
auto tetrahedron_slopes() { return Eigen::Map<const Eigen::Matrix<double, 3, 4>>(kTetrahedronSlopes.data()); }
auto triangle_slopes() { return Eigen::Map<const Eigen::Matrix<double, 2, 3>>(kTriangleSlopes.data()); }

using Ends = std::array<int, 2>;
/// Between which corners the nodes in the middle of the edges lie, those after the corners.
constexpr std::array<Ends, 6> kTetrahedronEdges = {{{0, 1}, {1, 2}, {2, 0}, {0, 3}, {1, 3}, {2, 3}}};
constexpr std::array<Ends, 3> kTriangleEdges = {{{0, 1}, {1, 2}, {2, 0}}};

/// Quadratic functions of barycentric coordinates: L (2 L - 1) at corners, 4 L L' in the middle of edges.
template <class Values, std::size_t Corners, std::size_t Edges>
Values quadratic_functions(const std::array<double, Corners>& L, const std::array<Ends, Edges>& edges) {
  Values N(static_cast<Eigen::Index>(Corners + Edges));
  Eigen::Index node = 0;
  for (const double l : L) N[node++] = l * (2.0 * l - 1.0);
  for (const auto& [a, b] : edges) N[node++] = 4.0 * L[a] * L[b];
  return N;
}

template <class Slopes, std::size_t Corners, std::size_t Edges, class Matrix>
Slopes quadratic_slopes(const std::array<double, Corners>& L, const std::array<Ends, Edges>& edges, const Matrix& dL) {
  Slopes dN(dL.rows(), static_cast<Eigen::Index>(Corners + Edges));
  for (std::size_t c = 0; c < Corners; ++c) dN.col(c) = (4.0 * L[c] - 1.0) * dL.col(c);
  for (std::size_t e = 0; e < Edges; ++e) {
    const auto& [a, b] = edges[e];
    dN.col(Corners + e) = 4.0 * (L[a] * dL.col(b) + L[b] * dL.col(a));
  }
  return dN;
}

/// Signs of the local coordinates at the corners of a hexahedron; its first four, at (xi, eta), those of a square.
constexpr std::array<std::array<int, 3>, 8> kHexahedron = {
    {{-1, -1, -1}, {1, -1, -1}, {1, 1, -1}, {-1, 1, -1}, {-1, -1, 1}, {1, -1, 1}, {1, 1, 1}, {-1, 1, 1}}};

/// The three factors of a hexahedron's shape function, (1 + sign xi) / 2 along each direction.
Vec3 factors(const std::array<int, 3>& sign, const Vec3& xi) {
  return {0.5 * (1.0 + sign[0] * xi[0]), 0.5 * (1.0 + sign[1] * xi[1]), 0.5 * (1.0 + sign[2] * xi[2])};
}

constexpr std::array<Face, 4> kTetrahedronFaces = {
    {{3, 3, {0, 2, 1}}, {3, 3, {0, 1, 3}}, {3, 3, {1, 2, 3}}, {3, 3, {0, 3, 2}}}};
constexpr std::array<Face, 4> kQuadraticFaces = {
    {{3, 6, {0, 2, 1, 6, 5, 4}}, {3, 6, {0, 1, 3, 4, 8, 7}}, {3, 6, {1, 2, 3, 5, 9, 8}}, {3, 6, {0, 3, 2, 7, 9, 6}}}};
constexpr std::array<Face, 6> kHexahedronFaces = {{{4, 4, {0, 3, 2, 1}},
                                                   {4, 4, {4, 5, 6, 7}},
                                                   {4, 4, {0, 1, 5, 4}},
                                                   {4, 4, {1, 2, 6, 5}},
                                                   {4, 4, {2, 3, 7, 6}},
                                                   {4, 4, {3, 0, 4, 7}}}};

constexpr std::array<std::array<int, 3>, 1> kOneTriangle = {{{0, 1, 2}}};
constexpr std::array<std::array<int, 3>, 2> kTwoTriangles = {{{0, 1, 2}, {0, 2, 3}}};
constexpr std::array<std::array<int, 3>, 4> kFourTriangles = {{{0, 3, 5}, {3, 1, 4}, {5, 4, 2}, {3, 4, 5}}};

/// Gauss-Legendre rules on [-1, 1] with n points, exact to degree 2 n - 1.
template <std::size_t N>
struct Line {
  std::array<double, N> x, weight;
};
constexpr double kRootThird = 0.57735026918962576451, kRootThreeFifths = 0.77459666924148337704;
constexpr Line<2> kTwoPoints = {{-kRootThird, kRootThird}, {1.0, 1.0}};
constexpr Line<3> kThreePoints = {{-kRootThreeFifths, 0.0, kRootThreeFifths}, {5.0 / 9.0, 8.0 / 9.0, 5.0 / 9.0}};

template <std::size_t N>
std::array<GaussPoint, N * N * N> cube(const Line<N>& line) {
  std::array<GaussPoint, N * N * N> points;
  std::size_t n = 0;
  for (std::size_t k = 0; k < N; ++k) {
    for (std::size_t j = 0; j < N; ++j) {
      for (std::size_t i = 0; i < N; ++i) {
        points[n++] = {{line.x[i], line.x[j], line.x[k]}, line.weight[i] * line.weight[j] * line.weight[k]};
      }
    }
  }
  return points;
}

template <std::size_t N>
std::array<FacePoint, N * N> square(const Line<N>& line) {
  std::array<FacePoint, N * N> points;
  for (std::size_t n = 0; n < N * N; ++n) {
    points[n] = {{line.x[n % N], line.x[n / N]}, line.weight[n % N] * line.weight[n / N]};
  }
  return points;
}

/// The four points of a tetrahedron with one barycentric coordinate 1 - 3 a and three a.
template <class Iterator>
Iterator add_four(Iterator point, double a, double weight) {
  const double b = 1.0 - 3.0 * a;
  for (const Vec3& xi : {Vec3(a, a, a), Vec3(b, a, a), Vec3(a, b, a), Vec3(a, a, b)}) *point++ = {xi, weight};
  return point;
}

/// Degree 2.
std::array<GaussPoint, 4> four_points() {
  std::array<GaussPoint, 4> points;
  add_four(points.begin(), (5.0 - std::sqrt(5.0)) / 20.0, 1.0 / 24.0);
  return points;
}

/// Degree 5 (Walkington). That of degree 4 with 11 points has a negative weight, which a mass must not have.
std::array<GaussPoint, 14> fourteen_points() {
  std::array<GaussPoint, 14> points;
  auto point = add_four(points.begin(), 0.3108859192633006097973, 0.01878132095300264179986);
  point = add_four(point, 0.09273525031089122640232, 0.01224884051939365825729);
  const double a = 0.04550370412564964949188, b = 0.5 - a;
  for (const Vec3& xi : {Vec3(a, a, b), Vec3(a, b, a), Vec3(b, a, a), Vec3(a, b, b), Vec3(b, a, b), Vec3(b, b, a)}) {
    *point++ = {xi, 0.007091003462846911073012};
  }
  return points;
}

/// Degree 4 on a triangle (Dunavant).
std::array<FacePoint, 6> six_points() {
  std::array<FacePoint, 6> points;
  auto point = points.begin();
  const auto add_three = [&point](double a, double weight) {
    const double b = 1.0 - 2.0 * a;
    for (const Eigen::Vector2d& xi : {Eigen::Vector2d(a, a), Eigen::Vector2d(b, a), Eigen::Vector2d(a, b)}) {
      *point++ = {xi, weight};
    }
  };
  add_three(0.4459484909159648863183, 0.1116907948390057328475);
  add_three(0.09157621350977074345957, 0.05497587182766093381916);
  return points;
}

template <std::size_t N>
std::array<Vec3, N> tetrahedron_nodes() {
  std::array<Vec3, N> nodes;
  for (std::size_t c = 0; c < 4; ++c) nodes[c] = c == 0 ? Vec3(0, 0, 0) : Vec3(Vec3::Unit(c - 1));
  for (std::size_t e = 0; e + 4 < N; ++e) {
    nodes[4 + e] = 0.5 * (nodes[kTetrahedronEdges[e][0]] + nodes[kTetrahedronEdges[e][1]]);
  }
  return nodes;
}

std::array<Vec3, 8> hexahedron_nodes() {
  std::array<Vec3, 8> nodes;
  for (std::size_t c = 0; c < 8; ++c) nodes[c] = Vec3(kHexahedron[c][0], kHexahedron[c][1], kHexahedron[c][2]);
  return nodes;
}

Vec3 centre(Kind kind) { return kind == Kind::hex8 ? Vec3(0, 0, 0) : Vec3(0.25, 0.25, 0.25); }

constexpr int kMostRounds = 50;
/// Newton's last step: the error after it is about its square.
constexpr double kLastStep = 1e-8;
/// A step shortened more than this means that the map folds.
constexpr double kShortestPart = 1.0 / 1024.0;

}  // namespace

const char* plural(Kind kind) {
  return kind == Kind::tet4 ? "tetrahedra" : kind == Kind::tet10 ? "10-node tetrahedra" : "hexahedra";
}

const char* name(Kind kind) {
  if (kind == Kind::tet4) return "4-node tetrahedron";
  if (kind == Kind::tet10) return "10-node tetrahedron";
  return "8-node hexahedron";
}

std::span<const Vec3> reference_nodes(Kind kind) {
  static const auto tet4 = tetrahedron_nodes<4>();
  static const auto tet10 = tetrahedron_nodes<10>();
  static const auto hex8 = hexahedron_nodes();
  if (kind == Kind::tet4) return tet4;
  if (kind == Kind::tet10) return tet10;
  return hex8;
}

NodeValues shape_functions(Kind kind, const Vec3& xi) {
  if (kind == Kind::tet4) return Eigen::Vector4d(1.0 - xi.sum(), xi[0], xi[1], xi[2]);
  if (kind == Kind::tet10) return quadratic_functions<NodeValues>(barycentric(xi), kTetrahedronEdges);
  NodeValues N(8);
  for (std::size_t c = 0; c < 8; ++c) N[c] = factors(kHexahedron[c], xi).prod();
  return N;
}

NodeVectors shape_slopes(Kind kind, const Vec3& xi) {
  if (kind == Kind::tet4) return tetrahedron_slopes();
  if (kind == Kind::tet10) {
    return quadratic_slopes<NodeVectors>(barycentric(xi), kTetrahedronEdges, tetrahedron_slopes());
  }
  NodeVectors dN(3, 8);
  for (std::size_t c = 0; c < 8; ++c) {
    const auto& sign = kHexahedron[c];
    const Vec3 f = factors(sign, xi);
    dN.col(c) = 0.5 * Vec3(sign[0] * f[1] * f[2], sign[1] * f[2] * f[0], sign[2] * f[0] * f[1]);
  }
  return dN;
}

std::span<const GaussPoint> quadrature(Kind kind) {
  static const std::array<GaussPoint, 1> tet4 = {{{{0.25, 0.25, 0.25}, 1.0 / 6.0}}};
  static const auto tet10 = four_points();
  static const auto hex8 = cube(kTwoPoints);
  if (kind == Kind::tet4) return tet4;
  if (kind == Kind::tet10) return tet10;
  return hex8;
}

std::span<const GaussPoint> mass_quadrature(Kind kind) {
  static const auto tet4 = four_points();
  static const auto tet10 = fourteen_points();
  static const auto hex8 = cube(kThreePoints);
  if (kind == Kind::tet4) return tet4;
  if (kind == Kind::tet10) return tet10;
  return hex8;
}

std::optional<Vec3> local_coordinates(Kind kind, const NodeVectors& nodes, const Vec3& x) {
  // From the first node, so that rounding is that of the element's size and not of its place.
  const NodeVectors X = nodes.colwise() - Vec3(nodes.col(0));
  const Vec3 target = x - nodes.col(0);
  const auto slope = [&](const Vec3& xi) -> Mat3 { return X.lazyProduct(shape_slopes(kind, xi).transpose()); };
  const auto miss = [&](const Vec3& xi) -> Vec3 { return target - X.lazyProduct(shape_functions(kind, xi)); };

  Vec3 xi = centre(kind), r = miss(xi);
  Mat3 J = slope(xi);
  const double sign = J.determinant() < 0.0 ? -1.0 : 1.0;
  for (int round = 0; round < kMostRounds; ++round) {
    const Vec3 step = J.partialPivLu().solve(r);
    if (!step.allFinite()) return std::nullopt;
    if (kind == Kind::tet4 || step.norm() <= kLastStep * (1.0 + xi.norm())) return xi + step;
    // Steps that come nearer and stay on the centre's side of the fold, where the determinant changes its sign.
    double part = 1.0;
    for (;; part *= 0.5) {
      if (part < kShortestPart) return std::nullopt;
      const Vec3 next = xi + part * step, left = miss(next);
      const Mat3 slope_there = slope(next);
      if (!(left.norm() < (1.0 - 0.1 * part) * r.norm() && sign * slope_there.determinant() > 0.0)) continue;
      xi = next;
      r = left;
      J = slope_there;
      break;
    }
  }
  return std::nullopt;
}

double outside(Kind kind, const Vec3& xi) {
  if (kind == Kind::hex8) return std::max(0.0, xi.cwiseAbs().maxCoeff() - 1.0);
  return std::max({0.0, -xi.minCoeff(), xi.sum() - 1.0});
}

std::span<const std::array<int, 2>, 6> tetrahedron_edges() { return kTetrahedronEdges; }

std::span<const Face> faces(Kind kind) {
  if (kind == Kind::tet4) return kTetrahedronFaces;
  if (kind == Kind::tet10) return kQuadraticFaces;
  return kHexahedronFaces;
}

std::span<const std::array<int, 3>> face_triangles(int nodes) {
  if (nodes == 3) return kOneTriangle;
  if (nodes == 4) return kTwoTriangles;
  return kFourTriangles;
}

FaceValues face_functions(const Face& face, const Eigen::Vector2d& xi) {
  if (face.nodes == 3) return Vec3(1.0 - xi.sum(), xi[0], xi[1]);
  if (face.nodes == 6) return quadratic_functions<FaceValues>(barycentric(xi), kTriangleEdges);
  FaceValues N(4);
  for (std::size_t c = 0; c < 4; ++c) {
    N[c] = 0.25 * (1.0 + kHexahedron[c][0] * xi[0]) * (1.0 + kHexahedron[c][1] * xi[1]);
  }
  return N;
}

FaceSlopes face_slopes(const Face& face, const Eigen::Vector2d& xi) {
  if (face.nodes == 3) return triangle_slopes();
  if (face.nodes == 6) return quadratic_slopes<FaceSlopes>(barycentric(xi), kTriangleEdges, triangle_slopes());
  FaceSlopes dN(2, 4);
  for (std::size_t c = 0; c < 4; ++c) {
    const double u = kHexahedron[c][0], v = kHexahedron[c][1];
    dN.col(c) = 0.25 * Eigen::Vector2d(u * (1.0 + v * xi[1]), v * (1.0 + u * xi[0]));
  }
  return dN;
}

std::span<const FacePoint> face_quadrature(const Face& face) {
  static const std::array<FacePoint, 1> three = {{{{1.0 / 3.0, 1.0 / 3.0}, 0.5}}};
  static const auto four = square(kTwoPoints);
  static const auto six = six_points();
  if (face.nodes == 3) return three;
  if (face.nodes == 4) return four;
  return six;
}

}  // namespace sinew::solid
