#include "sinew/contact/tree.hpp"

#include <algorithm>
#include <numeric>

namespace sinew::contact {

Tree::Tree(const std::vector<Box>& boxes) {
  if (boxes.empty()) return;
  std::vector<int> order(boxes.size());
  std::iota(order.begin(), order.end(), 0);
  nodes_.reserve(2 * boxes.size() - 1);
  add(boxes, order, 0, order.size());
  fit(boxes);
}

void Tree::add(const std::vector<Box>& boxes, std::vector<int>& order, std::size_t from, std::size_t to) {
  const std::size_t at = nodes_.size();
  nodes_.emplace_back();
  if (to - from == 1) {
    nodes_[at].leaf = order[from];
    return;
  }
  Box centres;
  for (std::size_t i = from; i < to; ++i) centres.extend(boxes[static_cast<std::size_t>(order[i])].center());
  Eigen::Index axis = 0;
  centres.sizes().maxCoeff(&axis);
  const std::size_t middle = (from + to) / 2;
  const auto place = [&](int i) { return boxes[static_cast<std::size_t>(i)].center()[axis]; };
  std::nth_element(order.begin() + static_cast<std::ptrdiff_t>(from),
                   order.begin() + static_cast<std::ptrdiff_t>(middle), order.begin() + static_cast<std::ptrdiff_t>(to),
                   [&](int i, int j) { return place(i) < place(j) || (place(i) == place(j) && i < j); });
  add(boxes, order, from, middle);
  nodes_[at].second = static_cast<int>(nodes_.size());
  add(boxes, order, middle, to);
}

void Tree::fit(const std::vector<Box>& boxes) {
  for (std::size_t i = nodes_.size(); i-- > 0;) {
    Node& node = nodes_[i];
    node.box = node.leaf >= 0 ? boxes[static_cast<std::size_t>(node.leaf)]
                              : nodes_[i + 1].box.merged(nodes_[static_cast<std::size_t>(node.second)].box);
  }
}

}  // namespace sinew::contact
