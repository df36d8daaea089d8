#include "sinew/contact/polyhedron.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>
#include <stdexcept>
#include <utility>

namespace sinew::contact {

Polyhedron make_polyhedron(std::vector<Vec3> corners, std::vector<std::vector<int>> faces) {
  Polyhedron made{std::move(corners), std::move(faces), {}, {}, {}};
  std::map<std::array<int, 2>, std::vector<int>> meeting;
  for (std::size_t f = 0; f < made.faces.size(); ++f) {
    const std::vector<int>& face = made.faces[f];
    Vec3 area = Vec3::Zero();
    for (std::size_t i = 0; i < face.size(); ++i) {
      const int from = face[i], to = face[(i + 1) % face.size()];
      area += made.corners[from].cross(made.corners[to]);
      meeting[{std::min(from, to), std::max(from, to)}].push_back(static_cast<int>(f));
    }
    made.normals.push_back(area.normalized());
  }
  for (const auto& [edge, both] : meeting) {
    if (both.size() != 2) throw std::invalid_argument("contact::make_polyhedron: its faces do not close");
    made.edges.push_back(edge);
    made.sides.push_back({both[0], both[1]});
  }
  return made;
}

Polyhedron box(const Vec3& size) {
  std::vector<Vec3> corners;
  for (int i = 0; i < 8; ++i) {
    const Vec3 sign(i & 1 ? 1.0 : -1.0, i & 2 ? 1.0 : -1.0, i & 4 ? 1.0 : -1.0);
    corners.emplace_back(0.5 * size.cwiseProduct(sign));
  }
  return make_polyhedron(std::move(corners),
                         {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}});
}

Polyhedron prism(double radius, double length, int sides) {
  const double turn = 2.0 * M_PI / sides;
  const double r = radius * std::sqrt(turn / std::sin(turn));  // of a polygon as large as the disk
  std::vector<Vec3> corners;
  std::vector<std::vector<int>> faces(2);
  for (int i = 0; i < sides; ++i) {
    const Vec3 at(r * std::cos(i * turn), r * std::sin(i * turn), 0.5 * length);
    corners.push_back(at);
    corners.emplace_back(at.x(), at.y(), -at.z());
    const int next = (i + 1) % sides;
    faces[0].push_back(2 * i);
    faces[1].push_back(2 * (sides - 1 - i) + 1);
    faces.push_back({2 * i, 2 * i + 1, 2 * next + 1, 2 * next});
  }
  return make_polyhedron(std::move(corners), std::move(faces));
}

}  // namespace sinew::contact
