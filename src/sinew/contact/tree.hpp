// Which of many boxes are near a place: a binary tree of boxes that follows them as they move.
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <vector>

namespace sinew::contact {

using Box = Eigen::AlignedBox3d;

/// Made once, of boxes that stay near each other, and fitted again whenever they have moved.
class Tree {
 public:
  Tree() = default;
  explicit Tree(const std::vector<Box>& boxes);
  /// As many boxes as it was made of, in the same order.
  void fit(const std::vector<Box>& boxes);
  /// Around all of them; empty where there are none.
  Box whole() const { return nodes_.empty() ? Box() : nodes_[0].box; }
  /// Visits the numbers of all boxes that meet this one, in an order that only depends on how the tree was made.
  template <class Visit>
  void each_near(const Box& box, const Visit& visit) const {
    if (nodes_.empty()) return;
    std::array<int, 64> waiting;  // deeper than halves of any number that fits in memory
    std::size_t count = 0;
    waiting[count++] = 0;
    while (count > 0) {
      const int at = waiting[--count];
      const Node& node = nodes_[static_cast<std::size_t>(at)];
      if (!node.box.intersects(box)) continue;
      if (node.leaf >= 0) {
        visit(node.leaf);
      } else {
        waiting[count++] = node.second;
        waiting[count++] = at + 1;
      }
    }
  }

 private:
  struct Node {
    Box box;
    int leaf = -1;   ///< number of its box, or
    int second = 0;  ///< its second child; the first follows it
  };
  void add(const std::vector<Box>& boxes, std::vector<int>& order, std::size_t from, std::size_t to);
  std::vector<Node> nodes_;  ///< parents before children
};

}  // namespace sinew::contact
