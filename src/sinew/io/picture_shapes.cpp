#include "sinew/io/picture_shapes.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <utility>

namespace sinew::io {
namespace {

using Vec3 = Eigen::Vector3d;

constexpr int kSides = 20;  ///< of a rod's cross section

/// Distance of each point from where it was; NaN where that is not known.
Eigen::VectorXd displacement(const Eigen::Matrix3Xd& before, const Eigen::Matrix3Xd& now) {
  if (before.cols() != now.cols()) return Eigen::VectorXd::Constant(now.cols(), NAN);
  return (now - before).colwise().norm();
}

/// The triangles that solid::surface makes of a face.
std::vector<solid::Triangle> triangles_of(const solid::Cell& cell, const solid::Face& face) {
  solid::CellFace nodes{face.nodes, {}};
  for (int i = 0; i < face.nodes; ++i) nodes.node[i] = cell.node[face.node[i]];
  return solid::triangles({nodes});
}

using Edge = std::pair<int, int>;  ///< nodes, ascending
Edge edge_between(int a, int b) { return std::minmax(a, b); }

/// Edges of triangles that are none of the mesh, because they cut a face in pieces; ascending.
std::vector<Edge> cuts_through_faces(const std::vector<solid::Cell>& cells) {
  std::vector<Edge> cuts, edges;
  for (const solid::Cell& cell : cells) {
    if (cell.kind == solid::Kind::tet4) continue;
    for (const solid::Face& face : solid::faces(cell.kind)) {
      edges.clear();
      for (const solid::Triangle& triangle : triangles_of(cell, face))
        for (int i = 0; i < 3; ++i) edges.push_back(edge_between(triangle[i], triangle[(i + 1) % 3]));
      std::sort(edges.begin(), edges.end());
      for (std::size_t i = 0; i + 1 < edges.size(); ++i)
        if (edges[i] == edges[i + 1]) cuts.push_back(edges[i]);
    }
  }
  std::sort(cuts.begin(), cuts.end());
  return cuts;
}

/// Of a face with this unit normal in view axes (x right, y down, z to the viewer), lit from the upper left.
double light(const Vec3& normal) {
  static const Vec3 from = Vec3(-0.40, -0.60, 0.70).normalized();
  return 0.52 + 0.54 * std::max(0.0, (normal.z() < 0.0 ? -1.0 : 1.0) * normal.dot(from));
}

/// `value` of each corner, counted over all triangles; `rim` of the edge between two nodes.
template <class Value, class Rim>
void add_triangles(Raster& raster, const Eigen::Matrix3Xd& nodes, const std::vector<solid::Triangle>& surface,
                   const PictureView& view, const Value& value, const Rim& rim) {
  for (std::size_t s = 0; s < surface.size(); ++s) {
    const solid::Triangle& face = surface[s];
    if (!drawable(nodes, face[0]) || !drawable(nodes, face[1]) || !drawable(nodes, face[2])) continue;
    std::array<Corner, 3> corners;
    for (int i = 0; i < 3; ++i) {
      corners[i].place = view.project(nodes.col(face[i]));
      corners[i].value = value(3 * s + static_cast<std::size_t>(i));
    }
    const Vec3 normal = (corners[1].place - corners[0].place).cross(corners[2].place - corners[0].place);
    if (!(normal.norm() > 0.0)) continue;
    for (Corner& corner : corners) corner.light = light(normal.normalized());
    std::array<double, 3> rims{};
    for (int i = 0; i < 3; ++i) rims[i] = rim(face[(i + 1) % 3], face[(i + 2) % 3]);
    raster.add(corners, rims);
  }
}

}  // namespace

bool drawable(const Eigen::Matrix3Xd& points, int i) { return i >= 0 && i < points.cols() && drawable(points.col(i)); }

std::vector<double> surface_values(const SolidSnapshot& solid, PictureColor color) {
  std::vector<double> values(3 * solid.surface.size(), NAN);
  if (color == PictureColor::displacement) {
    const Eigen::VectorXd moved = displacement(solid.rest, solid.nodes);
    for (std::size_t i = 0; i < values.size(); ++i) {
      const int node = solid.surface[i / 3][i % 3];
      if (node >= 0 && node < moved.size()) values[i] = moved(node);
    }
  } else if (solid.von_mises.size() == static_cast<Eigen::Index>(solid.cells.size())) {
    std::map<solid::Triangle, double> of_face;  // by sorted nodes
    for (std::size_t c = 0; c < solid.cells.size(); ++c) {
      for (const solid::Face& face : solid::faces(solid.cells[c].kind)) {
        for (solid::Triangle triangle : triangles_of(solid.cells[c], face)) {
          std::sort(triangle.begin(), triangle.end());
          of_face[triangle] = solid.von_mises(static_cast<Eigen::Index>(c));
        }
      }
    }
    for (std::size_t s = 0; s < solid.surface.size(); ++s) {
      solid::Triangle face = solid.surface[s];
      std::sort(face.begin(), face.end());
      const auto found = of_face.find(face);
      if (found != of_face.end()) std::fill_n(values.begin() + 3 * static_cast<std::ptrdiff_t>(s), 3, found->second);
    }
  }
  return values;
}

Eigen::VectorXd rod_values(const RodSnapshot& rod, const RodSnapshot* before, PictureColor color) {
  if (color == PictureColor::von_mises && rod.von_mises.size() == rod.points.cols()) return rod.von_mises;
  if (color == PictureColor::von_mises || before == nullptr) return Eigen::VectorXd::Constant(rod.points.cols(), NAN);
  return displacement(before->points, rod.points);
}

Scale scale_of(std::vector<double> values, PictureColor color, double roundoff) {
  std::erase_if(values, [](double value) { return !std::isfinite(value); });
  if (values.empty()) return {};
  std::sort(values.begin(), values.end());
  if (color == PictureColor::displacement) return {values.back() > roundoff ? values.back() : 0.0, false};
  const double most = values[(values.size() - 1) * 98 / 100];
  return most > 0.0 && most < values.back() ? Scale{most, true} : Scale{values.back(), false};
}

void add_surface(Raster& raster, const Eigen::Matrix3Xd& nodes, const SolidSnapshot& solid,
                 const std::vector<double>& values, const Scale& scale, const PictureView& view, double edge) {
  const std::vector<Edge> cuts = edge > 0.0 ? cuts_through_faces(solid.cells) : std::vector<Edge>();
  add_triangles(
      raster, nodes, solid.surface, view,
      [&](std::size_t corner) { return values.empty() ? 0.0 : scale.of(values[corner]); },
      [&](int a, int b) { return std::binary_search(cuts.begin(), cuts.end(), edge_between(a, b)) ? 0.0 : edge; });
}

void add_body(Raster& raster, const BodySnapshot& body, const PictureView& view) {
  add_triangles(
      raster, body.points, body.surface, view, [](std::size_t) { return NAN; }, [](int, int) { return 0.0; });
}

double edge_strength(const std::vector<SolidSnapshot>& solids, const PictureView& view) {
  double sum = 0.0;
  int count = 0;
  for (const SolidSnapshot& solid : solids) {
    for (const solid::Triangle& face : solid.surface) {
      if (!drawable(solid.nodes, face[0]) || !drawable(solid.nodes, face[1])) continue;
      sum += (view.project(solid.nodes.col(face[0])) - view.project(solid.nodes.col(face[1]))).head<2>().norm();
      ++count;
    }
  }
  return count == 0 ? 0.0 : 0.22 * std::clamp((sum / count - 4.0) / 20.0, 0.0, 1.0);
}

void add_tube(Raster& raster, const RodSnapshot& rod, const Eigen::VectorXd& values, const Scale& scale,
              const PictureView& view) {
  std::vector<Vec3> path;             // in view axes [px], y down
  std::vector<double> value, radius;  // [px]
  for (Eigen::Index i = 0; i < rod.points.cols(); ++i) {
    if (!drawable(rod.points.col(i))) continue;
    const Vec3 place = view.project(rod.points.col(i));
    if (!path.empty() && (place - path.back()).norm() < 1e-3) continue;
    path.push_back(place);
    value.push_back(i < values.size() ? scale.of(values(i)) : NAN);
    const double own = i < rod.radius.size() ? rod.radius(i) * view.scale : 0.0;
    radius.push_back(own > kThinnestRod ? own : kThinnestRod);  // (also of NaN)
  }
  if (path.size() < 2) return;
  Vec3 across = Vec3::Zero();
  std::array<Corner, kSides> last{};
  for (std::size_t i = 0; i < path.size(); ++i) {
    const Vec3 chord = path[std::min(i + 1, path.size() - 1)] - path[i == 0 ? 0 : i - 1];
    const Vec3 tangent = chord.norm() > 0.0 ? Vec3(chord.normalized()) : Vec3(Vec3::UnitX());
    across -= across.dot(tangent) * tangent;  // carried along
    if (across.norm() < 1e-6) across = tangent.unitOrthogonal();
    across.normalize();
    const Vec3 other = tangent.cross(across);
    std::array<Corner, kSides> ring;
    for (int k = 0; k < kSides; ++k) {
      const double angle = 2 * std::numbers::pi * k / kSides;
      const Vec3 normal = std::cos(angle) * across + std::sin(angle) * other;
      ring[k] = {path[i] + radius[i] * normal, value[i], 0.72 + 0.4 * std::max(0.0, normal.z())};
    }
    const bool end = i == 0 || i + 1 == path.size();
    for (int k = 0; k < kSides; ++k) {
      const int next = (k + 1) % kSides;
      if (end) raster.add({Corner{path[i], value[i], 0.9}, ring[k], ring[next]}, {});
      if (i == 0) continue;
      raster.add({last[k], last[next], ring[k]}, {});
      raster.add({ring[k], last[next], ring[next]}, {});
    }
    last = ring;
  }
}

}  // namespace sinew::io
