#include "sinew/solid/mesh_summary.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

namespace sinew::solid {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

/// The three neighbours of each corner of a hexahedron, right-handed.
constexpr std::array<std::array<int, 3>, 8> kNeighbours = {
    {{1, 3, 4}, {2, 0, 5}, {3, 1, 6}, {0, 2, 7}, {7, 5, 0}, {4, 6, 1}, {5, 7, 2}, {6, 4, 3}}};

void add_box(const Mesh& mesh, MeshSummary& summary) {
  std::vector<bool> used(static_cast<std::size_t>(mesh.nodes.cols()), false);
  summary.lower.setConstant(infinity);
  summary.upper.setConstant(-infinity);
  for (const Cell& cell : mesh.cells) {
    for (const int node : cell.nodes()) {
      used[static_cast<std::size_t>(node)] = true;
      summary.lower = summary.lower.cwiseMin(mesh.nodes.col(node));
      summary.upper = summary.upper.cwiseMax(mesh.nodes.col(node));
    }
  }
  summary.diagonal = (summary.upper - summary.lower).norm();
  summary.unused_nodes = static_cast<int>(std::count(used.begin(), used.end(), false));
}

Vec3 centre_of(const Mesh& mesh, const Cell& cell) {
  return cell_nodes(mesh.nodes, cell).leftCols(corner_count(cell.kind)).rowwise().mean();
}

void add_cells(const Mesh& mesh, MeshSummary& summary) {
  summary.smallest = infinity;
  summary.largest = -infinity;
  summary.worst_quality = infinity;
  for (std::size_t i = 0; i < mesh.cells.size(); ++i) {
    ++summary.kinds[mesh.cells[i].kind];
    const double size = volume(mesh.nodes, mesh.cells[i]);
    summary.volume += size;
    summary.smallest = std::min(summary.smallest, size);
    summary.largest = std::max(summary.largest, size);
    const double quality = mean_ratio(mesh.nodes, mesh.cells[i]);
    if (quality < summary.worst_quality) {
      summary.worst_quality = quality;
      summary.worst_cell = static_cast<int>(i);
    }
  }
  summary.worst_centre = centre_of(mesh, mesh.cells[static_cast<std::size_t>(summary.worst_cell)]);
}

/// factor d^(2/3) / (sum of squares), 0 where that means nothing.
double ratio(double factor, double determinant, double squares) {
  if (!(determinant > 0.0) || !(squares > 0.0)) return 0.0;
  const double root = std::cbrt(determinant), value = factor * root * root / squares;
  return std::isfinite(value) ? value : 0.0;
}

double corner_ratio(const NodeVectors& X, int corner, const std::array<int, 3>& to) {
  const Vec3 a = X.col(to[0]) - X.col(corner), b = X.col(to[1]) - X.col(corner), c = X.col(to[2]) - X.col(corner);
  return ratio(3.0, a.cross(b).dot(c), a.squaredNorm() + b.squaredNorm() + c.squaredNorm());
}

}  // namespace

double mean_ratio(const Eigen::Matrix3Xd& nodes, const Cell& cell) {
  const NodeVectors X = cell_nodes(nodes, cell);
  if (cell.kind == Kind::hex8) {
    double worst = 1.0;
    for (int c = 0; c < 8; ++c) worst = std::min(worst, corner_ratio(X, c, kNeighbours[c]));
    return worst;
  }
  double edges = 0.0;
  for (int i = 0; i < 4; ++i) {
    for (int j = 0; j < i; ++j) edges += (X.col(i) - X.col(j)).squaredNorm();
  }
  const Vec3 a = X.col(1) - X.col(0), b = X.col(2) - X.col(0), c = X.col(3) - X.col(0);
  return ratio(12.0, 0.5 * a.cross(b).dot(c), edges);
}

MeshSummary summarize(const Mesh& mesh) {
  MeshSummary summary;
  summary.nodes = static_cast<int>(mesh.nodes.cols());
  summary.cells = static_cast<int>(mesh.cells.size());
  summary.ignored = mesh.ignored;
  summary.unused_nodes = summary.nodes;
  if (mesh.cells.empty()) return summary;
  add_box(mesh, summary);
  add_cells(mesh, summary);
  return summary;
}

}  // namespace sinew::solid
