#include "sinew/solid/mesh_summary.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

namespace sinew::solid {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

void add_box(const Mesh& mesh, MeshSummary& summary) {
  std::vector<bool> used(static_cast<std::size_t>(mesh.nodes.cols()), false);
  summary.lower.setConstant(infinity);
  summary.upper.setConstant(-infinity);
  for (const Tetrahedron& tet : mesh.tetrahedra) {
    for (const int node : tet) {
      used[static_cast<std::size_t>(node)] = true;
      summary.lower = summary.lower.cwiseMin(mesh.nodes.col(node));
      summary.upper = summary.upper.cwiseMax(mesh.nodes.col(node));
    }
  }
  summary.diagonal = (summary.upper - summary.lower).norm();
  summary.unused_nodes = static_cast<int>(std::count(used.begin(), used.end(), false));
}

void add_elements(const Mesh& mesh, MeshSummary& summary) {
  summary.smallest = infinity;
  summary.largest = -infinity;
  summary.worst_quality = infinity;
  for (std::size_t i = 0; i < mesh.tetrahedra.size(); ++i) {
    const double size = volume(mesh.nodes, mesh.tetrahedra[i]);
    summary.volume += size;
    summary.smallest = std::min(summary.smallest, size);
    summary.largest = std::max(summary.largest, size);
    const double quality = mean_ratio(mesh.nodes, mesh.tetrahedra[i]);
    if (quality < summary.worst_quality) {
      summary.worst_quality = quality;
      summary.worst_tetrahedron = static_cast<int>(i);
    }
  }
}

}  // namespace

double mean_ratio(const Eigen::Matrix3Xd& nodes, const Tetrahedron& tetrahedron) {
  double edges = 0.0;
  for (std::size_t i = 0; i < 4; ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      edges += (nodes.col(tetrahedron[i]) - nodes.col(tetrahedron[j])).squaredNorm();
    }
  }
  const double size = volume(nodes, tetrahedron);
  if (!(size > 0.0) || !(edges > 0.0)) return 0.0;
  const double root = std::cbrt(3.0 * size);
  return 12.0 * root * root / edges;
}

MeshSummary summarize(const Mesh& mesh) {
  MeshSummary summary;
  summary.nodes = static_cast<int>(mesh.nodes.cols());
  summary.tetrahedra = static_cast<int>(mesh.tetrahedra.size());
  summary.ignored = mesh.ignored;
  summary.unused_nodes = summary.nodes;
  if (mesh.tetrahedra.empty()) return summary;
  add_box(mesh, summary);
  add_elements(mesh, summary);
  return summary;
}

}  // namespace sinew::solid
