#include "sinew/solid/mesh.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cstddef>
#include <utility>

namespace sinew::solid {
namespace {

/// Corners of the four faces of a tetrahedron of positive volume, each counter-clockwise seen from outside.
constexpr std::array<std::array<int, 3>, 4> faces = {{{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}}};

}  // namespace

std::vector<Triangle> surface(const std::vector<Tetrahedron>& tetrahedra) {
  std::vector<Triangle> all;
  all.reserve(4 * tetrahedra.size());
  for (const Tetrahedron& tet : tetrahedra) {
    for (const auto& face : faces) all.push_back({tet[face[0]], tet[face[1]], tet[face[2]]});
  }
  // A face that two tetrahedra share has the same three nodes in both: sorted, such faces stand side by side.
  std::vector<std::pair<Triangle, std::size_t>> sorted;
  sorted.reserve(all.size());
  for (std::size_t i = 0; i < all.size(); ++i) {
    Triangle key = all[i];
    std::sort(key.begin(), key.end());
    sorted.emplace_back(key, i);
  }
  std::sort(sorted.begin(), sorted.end());

  std::vector<std::size_t> lonely;
  for (std::size_t begin = 0; begin < sorted.size();) {
    std::size_t end = begin + 1;
    while (end < sorted.size() && sorted[end].first == sorted[begin].first) ++end;
    if (end == begin + 1) lonely.push_back(sorted[begin].second);
    begin = end;
  }
  std::sort(lonely.begin(), lonely.end());  // back to the order of the tetrahedra

  std::vector<Triangle> boundary;
  boundary.reserve(lonely.size());
  for (const std::size_t i : lonely) boundary.push_back(all[i]);
  return boundary;
}

double volume(const Eigen::Matrix3Xd& nodes, const Tetrahedron& tetrahedron) {
  const Eigen::Vector3d a = nodes.col(tetrahedron[0]);
  const Eigen::Vector3d b = nodes.col(tetrahedron[1]) - a;
  const Eigen::Vector3d c = nodes.col(tetrahedron[2]) - a;
  const Eigen::Vector3d d = nodes.col(tetrahedron[3]) - a;
  return b.cross(c).dot(d) / 6.0;
}

}  // namespace sinew::solid
