#include "sinew/contact/mesh.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>
#include <span>
#include <utility>

namespace sinew::contact {

Mesh make_mesh(Eigen::Matrix3Xd points, std::vector<std::array<int, 3>> triangles) {
  Mesh made{std::move(points), std::move(triangles), {}, {}, {}, {}, {}};
  made.beside.assign(made.triangles.size(), {-1, -1, -1});
  struct Edge {
    Ridge ridge;
    int triangle;
    std::size_t side;
  };
  std::map<std::array<int, 2>, Edge> ridges;
  std::vector<Box> faces, edges;
  const auto around = [&made](std::span<const int> corners) {
    Box box;
    for (const int corner : corners) box.extend(Eigen::Vector3d(made.points.col(corner)));
    return box;
  };
  for (std::size_t number = 0; number < made.triangles.size(); ++number) {
    const std::array<int, 3>& triangle = made.triangles[number];
    made.used.insert(made.used.end(), triangle.begin(), triangle.end());
    faces.push_back(around(triangle));
    for (std::size_t i = 0; i < 3; ++i) {
      const int from = triangle[i], to = triangle[(i + 1) % 3], third = triangle[(i + 2) % 3];
      const std::array<int, 2> ends{std::min(from, to), std::max(from, to)};
      // (As the first triangle runs round it, so that its outside is known.)
      const Edge own{Ridge{{from, to}, {third, third}}, static_cast<int>(number), i};
      const auto [entry, fresh] = ridges.try_emplace(ends, own);
      if (fresh) continue;
      Edge& other = entry->second;
      other.ridge.sides[1] = third;
      made.beside[number][i] = other.triangle;
      made.beside[static_cast<std::size_t>(other.triangle)][other.side] = own.triangle;
    }
  }
  std::sort(made.used.begin(), made.used.end());
  made.used.erase(std::unique(made.used.begin(), made.used.end()), made.used.end());
  for (const auto& [ends, edge] : ridges) {
    made.ridges.push_back(edge.ridge);
    edges.push_back(around(ends));
  }
  made.faces = Tree(faces);
  made.edges = Tree(edges);
  return made;
}

void find_outward(const Mesh& mesh, const Eigen::Matrix3Xd& x, Outward& own) {
  using Vec3 = Eigen::Vector3d;
  own.faces.resize(3, static_cast<Eigen::Index>(mesh.triangles.size()));
  own.points.setZero(3, x.cols());
  for (std::size_t f = 0; f < mesh.triangles.size(); ++f) {
    const std::array<int, 3>& t = mesh.triangles[f];
    std::array<Vec3, 3> along;
    for (std::size_t i = 0; i < 3; ++i) along[i] = (x.col(t[(i + 1) % 3]) - x.col(t[i])).normalized();
    const Vec3 n = along[0].cross(along[1]).normalized();
    own.faces.col(static_cast<Eigen::Index>(f)) = n;
    for (std::size_t i = 0; i < 3; ++i)
      own.points.col(t[i]) += std::acos(std::clamp(-along[i].dot(along[(i + 2) % 3]), -1.0, 1.0)) * n;
  }
  own.points.colwise().normalize();
}

Eigen::Vector3d outward_at(const Mesh& mesh, const Outward& outward, int triangle,
                           const std::array<double, 3>& weights) {
  const auto number = static_cast<std::size_t>(triangle);
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t next = (i + 1) % 3, third = (i + 2) % 3;
    if (weights[next] == 0.0 && weights[third] == 0.0) return outward.points.col(mesh.triangles[number][i]);
  }
  Eigen::Vector3d n = outward.faces.col(triangle);
  for (std::size_t i = 0; i < 3; ++i) {
    const int other = mesh.beside[number][(i + 1) % 3];  // across the edge that corner i is not on
    if (weights[i] == 0.0 && other >= 0) n = (n + outward.faces.col(other)).normalized();
  }
  return n;
}

bool inside(const Mesh& mesh, const Eigen::Matrix3Xd& x, const Tree& faces, const Eigen::Vector3d& p) {
  const Box whole = faces.whole();
  if (whole.isEmpty() || !whole.contains(p)) return false;
  // A little beside p, so that the line does not pass through edges that lie as simply as it does.
  const Eigen::Vector2d at = p.head<2>() + 1e-7 * whole.sizes().norm() * Eigen::Vector2d(0.6180339, 0.4142135);
  Box line(Eigen::Vector3d(at.x(), at.y(), p.z()), Eigen::Vector3d(at.x(), at.y(), whole.max().z()));
  bool odd = false;
  faces.each_near(line, [&](int number) {
    const std::array<int, 3>& t = mesh.triangles[static_cast<std::size_t>(number)];
    std::array<double, 3> part{};
    for (std::size_t i = 0; i < 3; ++i) {
      const Eigen::Vector2d a = x.col(t[(i + 1) % 3]).head<2>() - at, b = x.col(t[(i + 2) % 3]).head<2>() - at;
      part[i] = a.x() * b.y() - a.y() * b.x();
    }
    const auto [least, most] = std::minmax({part[0], part[1], part[2]});
    if (least < 0.0 && most > 0.0) return;  // passes beside it
    const double sum = part[0] + part[1] + part[2];
    const double height = (part[0] * x(2, t[0]) + part[1] * x(2, t[1]) + part[2] * x(2, t[2])) / sum;
    if (height > p.z()) odd = !odd;
  });
  return odd;
}

int open_edges(const std::vector<std::array<int, 3>>& triangles) {
  std::map<std::array<int, 2>, std::array<int, 2>> passed;  // how often each way
  for (const std::array<int, 3>& triangle : triangles) {
    for (std::size_t i = 0; i < 3; ++i) {
      const int from = triangle[i], to = triangle[(i + 1) % 3];
      ++passed[{std::min(from, to), std::max(from, to)}][from < to ? 0 : 1];
    }
  }
  return static_cast<int>(std::count_if(passed.begin(), passed.end(), [](const auto& edge) {
    return edge.second != std::array<int, 2>{1, 1};
  }));
}

}  // namespace sinew::contact
