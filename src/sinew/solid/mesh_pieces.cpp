#include "sinew/solid/mesh_pieces.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cstddef>
#include <numeric>
#include <span>
#include <utility>

#include "sinew/solid/mesh_order.hpp"

namespace sinew::solid {
namespace {

constexpr double kSamePlace = 1e-6;

int root_of(std::vector<int>& parent, int node) {
  while (parent[static_cast<std::size_t>(node)] != node) {
    int& up = parent[static_cast<std::size_t>(node)];
    up = parent[static_cast<std::size_t>(up)];
    node = up;
  }
  return node;
}

std::vector<int> used_nodes(const std::vector<Cell>& cells) {
  std::vector<int> used;
  for (const Cell& cell : cells) used.insert(used.end(), cell.nodes().begin(), cell.nodes().end());
  make_ascending(used);
  return used;
}

Eigen::AlignedBox3d box_of(const Eigen::Matrix3Xd& nodes, std::span<const int> numbers) {
  Eigen::AlignedBox3d box;
  for (const int node : numbers) box.extend(nodes.col(node));
  return box;
}

/// Nodes in the order of a coordinate along a direction, for those between two values of it.
class Along {
 public:
  Along(const Eigen::Matrix3Xd& nodes, const std::vector<int>& numbers, const Vec3& direction) {
    for (const int node : numbers) sorted_.push_back({direction.dot(nodes.col(node)), node});
    std::sort(sorted_.begin(), sorted_.end());
  }
  /// Calls `see(node)` for those from `least` to `most`.
  template <class See>
  void between(double least, double most, const See& see) const {
    for (auto at = std::lower_bound(sorted_.begin(), sorted_.end(), std::pair(least, -1));
         at != sorted_.end() && at->first <= most; ++at)
      see(at->second);
  }

 private:
  std::vector<std::pair<double, int>> sorted_;
};

/// The distance of x from a triangle, by the nearest of its points.
double distance(const Vec3& x, const Vec3& a, const Vec3& b, const Vec3& c) {
  const Vec3 normal = (b - a).cross(c - a);
  const auto beside = [&](const Vec3& from, const Vec3& to) { return normal.dot((to - from).cross(x - from)) < 0.0; };
  if (!beside(a, b) && !beside(b, c) && !beside(c, a) && normal.norm() > 0.0)
    return std::abs(normal.normalized().dot(x - a));
  const auto to_edge = [&x](const Vec3& from, const Vec3& to) {
    const double along = std::clamp((x - from).dot(to - from) / (to - from).squaredNorm(), 0.0, 1.0);
    return (x - from - along * (to - from)).norm();
  };
  return std::min({to_edge(a, b), to_edge(b, c), to_edge(c, a)});
}

}  // namespace

Pieces find_pieces(const std::vector<Cell>& cells, Eigen::Index nodes) {
  std::vector<int> parent(static_cast<std::size_t>(nodes));
  std::iota(parent.begin(), parent.end(), 0);
  for (const Cell& cell : cells) {
    const int first = root_of(parent, cell.node[0]);
    for (const int node : cell.nodes()) parent[static_cast<std::size_t>(root_of(parent, node))] = first;
  }
  Pieces pieces;
  pieces.of_node.assign(static_cast<std::size_t>(nodes), -1);
  std::vector<int> number(static_cast<std::size_t>(nodes), -1);  // of the piece of each root
  for (const Cell& cell : cells) {
    int& piece = number[static_cast<std::size_t>(root_of(parent, cell.node[0]))];
    if (piece < 0) piece = pieces.count++;
    pieces.of_cell.push_back(piece);
    for (const int node : cell.nodes()) pieces.of_node[static_cast<std::size_t>(node)] = piece;
  }
  return pieces;
}

std::vector<std::array<int, 2>> coincident_nodes(const Eigen::Matrix3Xd& nodes, const std::vector<Cell>& cells) {
  const std::vector<int> used = used_nodes(cells);
  const double within = kSamePlace * box_of(nodes, used).diagonal().norm();
  const Vec3 direction = Vec3(0.6180339887, 0.5257311121, 0.5844).normalized();  // no grid has two nodes across it
  const Along along(nodes, used, direction);
  std::vector<std::array<int, 2>> pairs;
  std::vector<bool> taken(static_cast<std::size_t>(nodes.cols()), false);
  for (const int node : used) {
    if (taken[static_cast<std::size_t>(node)]) continue;
    const double at = direction.dot(nodes.col(node));
    along.between(at - within, at + within, [&](int other) {
      if (other <= node || !((nodes.col(other) - nodes.col(node)).norm() < within)) return;
      pairs.push_back({node, other});
      taken[static_cast<std::size_t>(other)] = true;
    });
  }
  return pairs;
}

std::vector<int> hanging_nodes(const Eigen::Matrix3Xd& nodes, const std::vector<Cell>& cells, const Pieces& pieces) {
  const std::vector<CellFace> faces = boundary(cells);
  std::vector<int> outer;
  for (const CellFace& face : faces) outer.insert(outer.end(), face.nodes().begin(), face.nodes().end());
  make_ascending(outer);
  const std::vector<int> untied = untied_middles(cells);
  std::erase_if(outer, [&untied](int node) { return std::binary_search(untied.begin(), untied.end(), node); });
  Eigen::Index longest = 0;
  box_of(nodes, outer).diagonal().maxCoeff(&longest);
  const Along along(nodes, outer, Vec3::Unit(longest));
  std::vector<int> hanging;
  for (const CellFace& face : faces) {
    Eigen::AlignedBox3d box = box_of(nodes, face.nodes());
    const double within = kSamePlace * box.diagonal().norm();
    box.extend(box.min() - Vec3::Constant(within));
    box.extend(box.max() + Vec3::Constant(within));
    const std::vector<Triangle> parts = triangles({face});
    const int piece = pieces.of_node[static_cast<std::size_t>(face.node[0])];
    along.between(box.min()[longest], box.max()[longest], [&](int node) {
      const Vec3 x = nodes.col(node);
      if (!box.contains(x) || pieces.of_node[static_cast<std::size_t>(node)] != piece) return;
      const auto same = [&](int own) { return own == node || (nodes.col(own) - x).norm() < within; };
      if (std::any_of(face.nodes().begin(), face.nodes().end(), same)) return;
      const auto touches = [&](const Triangle& t) {
        return distance(x, nodes.col(t[0]), nodes.col(t[1]), nodes.col(t[2])) < within;
      };
      if (std::any_of(parts.begin(), parts.end(), touches)) hanging.push_back(node);
    });
  }
  make_ascending(hanging);
  return hanging;
}

}  // namespace sinew::solid
