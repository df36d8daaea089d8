#include "sinew/solid/mesh.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>

namespace sinew::solid {
namespace {

/// The corners of a face in ascending order, the fourth of a triangle -1: the same for both cells that share it.
std::array<int, 4> key_of(const CellFace& face) {
  std::array<int, 4> key = {-1, -1, -1, -1};
  std::copy(face.corners().begin(), face.corners().end(), key.begin());
  std::sort(key.begin(), key.end());
  return key;
}

Mat3 jacobian(const NodeVectors& nodes, Kind kind, const Vec3& xi) {
  return nodes.lazyProduct(shape_slopes(kind, xi).transpose());
}

}  // namespace

void make_ascending(std::vector<int>& numbers) {
  std::sort(numbers.begin(), numbers.end());
  numbers.erase(std::unique(numbers.begin(), numbers.end()), numbers.end());
}

std::vector<CellFace> boundary(const std::vector<Cell>& cells) {
  std::vector<CellFace> all;
  all.reserve(4 * cells.size());
  for (const Cell& cell : cells) {
    for (const Face& face : faces(cell.kind)) {
      CellFace& own = all.emplace_back();
      own.count = face.nodes;
      for (int i = 0; i < face.nodes; ++i) own.node[i] = cell.node[face.node[i]];
    }
  }
  // Sorted, faces that cells share stand side by side.
  std::vector<std::pair<std::array<int, 4>, std::size_t>> sorted;
  sorted.reserve(all.size());
  for (std::size_t i = 0; i < all.size(); ++i) sorted.emplace_back(key_of(all[i]), i);
  std::sort(sorted.begin(), sorted.end());

  std::vector<std::size_t> lonely;
  for (std::size_t begin = 0; begin < sorted.size();) {
    std::size_t end = begin + 1;
    while (end < sorted.size() && sorted[end].first == sorted[begin].first) ++end;
    if (end == begin + 1) lonely.push_back(sorted[begin].second);
    begin = end;
  }
  std::sort(lonely.begin(), lonely.end());  // back to the order of the cells

  std::vector<CellFace> outer;
  outer.reserve(lonely.size());
  for (const std::size_t i : lonely) outer.push_back(all[i]);
  return outer;
}

std::vector<Triangle> surface(const std::vector<Cell>& cells) { return triangles(boundary(cells)); }

std::vector<Triangle> triangles(const std::vector<CellFace>& faces) {
  std::vector<Triangle> all;
  all.reserve(4 * faces.size());
  for (const CellFace& face : faces) {
    for (const auto& [a, b, c] : face_triangles(face.count)) all.push_back({face.node[a], face.node[b], face.node[c]});
  }
  return all;
}

NodeVectors cell_nodes(const Eigen::Matrix3Xd& nodes, const Cell& cell) {
  const std::span<const int> numbers = cell.nodes();
  NodeVectors own(3, static_cast<Eigen::Index>(numbers.size()));
  for (std::size_t i = 0; i < numbers.size(); ++i) own.col(i) = nodes.col(numbers[i]);
  return own;
}

double volume(const Eigen::Matrix3Xd& nodes, const Cell& cell) {
  const NodeVectors own = cell_nodes(nodes, cell);
  double sum = 0.0;
  for (const GaussPoint& point : mass_quadrature(cell.kind)) {
    sum += point.weight * jacobian(own, cell.kind, point.xi).determinant();
  }
  return sum;
}

double smallest_jacobian(const Eigen::Matrix3Xd& nodes, const Cell& cell) {
  const NodeVectors own = cell_nodes(nodes, cell);
  double smallest = std::numeric_limits<double>::infinity(), sum = 0.0;
  int count = 0;
  const auto look = [&](const Vec3& xi) {
    const double determinant = jacobian(own, cell.kind, xi).determinant();
    smallest = std::min(smallest, determinant);
    sum += std::abs(determinant);
    ++count;
  };
  for (const GaussPoint& point : quadrature(cell.kind)) look(point.xi);
  for (const GaussPoint& point : mass_quadrature(cell.kind)) look(point.xi);
  for (const Vec3& xi : reference_nodes(cell.kind)) look(xi);
  return sum == 0.0 ? 0.0 : smallest / (sum / count);
}

}  // namespace sinew::solid
