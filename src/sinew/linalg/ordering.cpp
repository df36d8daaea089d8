#include "sinew/linalg/ordering.hpp"

#include <metis.h>

#include <Eigen/OrderingMethods>
#include <Eigen/SparseCore>
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <mutex>
#include <numeric>
#include <unordered_map>

namespace sinew::linalg {

namespace {

/// Both triangles by columns, without the diagonal, ascending.
struct Adjacency {
  std::vector<int> first, row;
  std::span<const int> of(int i) const {
    return {row.data() + first[i], static_cast<std::size_t>(first[i + 1] - first[i])};
  }
};

Adjacency both_triangles(int size, const int* first, const int* row) {
  Adjacency all{std::vector<int>(static_cast<std::size_t>(size) + 1), {}};
  const auto each = [&](const auto& visit) {
    for (int j = 0; j < size; ++j) {
      for (int at = first[j]; at < first[j + 1]; ++at) {
        if (row[at] != j) visit(row[at], j);
      }
    }
  };
  each([&](int i, int j) { ++all.first[i + 1], ++all.first[j + 1]; });
  std::partial_sum(all.first.begin(), all.first.end(), all.first.begin());
  all.row.resize(static_cast<std::size_t>(all.first.back()));
  std::vector<int> end(all.first.begin(), all.first.end() - 1);
  each([&](int i, int j) { all.row[end[i]++] = j; });  // above the diagonal, ascending in j for each i
  each([&](int i, int j) { all.row[end[j]++] = i; });
  return all;
}

/// Per unknown the first one with the same neighbours, which is itself a neighbour.
std::vector<int> representatives(const Adjacency& all) {
  const auto size = static_cast<int>(all.first.size()) - 1;
  const auto mixed = [](int i) {
    std::uint64_t z = (static_cast<std::uint64_t>(i) + 1) * 0x9e3779b97f4a7c15ULL;
    return (z ^ (z >> 29)) * 0xbf58476d1ce4e5b9ULL;
  };
  const auto same = [&all](int i, int j) {  // neighbourhoods, each with its own
    const std::span<const int> a = all.of(i), b = all.of(j);
    if (a.size() != b.size()) return false;
    auto at = b.begin();
    for (const int k : a) {
      if (k == j) continue;
      if (at != b.end() && *at == i) ++at;
      if (at == b.end() || *at++ != k) return false;
    }
    return std::binary_search(a.begin(), a.end(), j);
  };
  std::unordered_map<std::uint64_t, std::vector<int>> found;
  std::vector<int> first(static_cast<std::size_t>(size));
  for (int i = 0; i < size; ++i) {
    std::uint64_t key = mixed(i);
    for (const int k : all.of(i)) key += mixed(k);
    std::vector<int>& alike = found[key];
    const auto twin = std::find_if(alike.begin(), alike.end(), [&](int j) { return same(i, j); });
    first[i] = twin == alike.end() ? i : *twin;
    if (first[i] == i) alike.push_back(i);
  }
  return first;
}

}  // namespace

Graph graph_of(int size, const int* first, const int* row) {
  const Adjacency all = both_triangles(size, first, row);
  const std::vector<int> representative = representatives(all);
  Graph graph;
  std::vector<int> number(static_cast<std::size_t>(size));
  for (int i = 0; i < size; ++i) {
    if (representative[i] == i) {
      number[i] = graph.size();
      graph.weight.push_back(0);
    } else {
      number[i] = number[representative[i]];
    }
    ++graph.weight[number[i]];
  }
  graph.of_member.assign(graph.weight.size() + 1, 0);
  std::partial_sum(graph.weight.begin(), graph.weight.end(), graph.of_member.begin() + 1);
  graph.member.resize(static_cast<std::size_t>(size));
  std::vector<int> end(graph.of_member.begin(), graph.of_member.end() - 1);
  for (int i = 0; i < size; ++i) graph.member[end[number[i]]++] = i;
  graph.first = {0};
  for (int i = 0; i < size; ++i) {
    if (representative[i] != i) continue;
    for (const int k : all.of(i)) {
      if (representative[k] == k && k != i) graph.neighbour.push_back(number[k]);
    }
    graph.first.push_back(static_cast<int>(graph.neighbour.size()));
  }
  return graph;
}

std::vector<int> minimum_degree(const Graph& graph) {
  const int n = graph.size();
  Eigen::SparseMatrix<double> pattern(n, n);
  pattern.reserve(static_cast<Eigen::Index>(graph.neighbour.size()) + n);
  for (int j = 0; j < n; ++j) {
    pattern.startVec(j);
    bool stored = false;
    const auto own = [&] {
      if (!stored) pattern.insertBack(j, j) = 1.0;
      stored = true;
    };
    for (const int i : graph.neighbours(j)) {
      if (i > j) own();
      pattern.insertBack(i, j) = 1.0;
    }
    own();
  }
  pattern.finalize();
  Eigen::PermutationMatrix<Eigen::Dynamic, Eigen::Dynamic, int> inverse;
  if (n > 0) Eigen::AMDOrdering<int>()(pattern, inverse);
  return {inverse.indices().data(), inverse.indices().data() + n};
}

std::vector<int> nested_dissection(const Graph& graph) {
  auto n = static_cast<idx_t>(graph.size());
  std::vector<idx_t> first(graph.first.begin(), graph.first.end());
  std::vector<idx_t> neighbours(graph.neighbour.begin(), graph.neighbour.end());
  std::vector<idx_t> weights(graph.weight.begin(), graph.weight.end());
  std::vector<idx_t> order(graph.weight.size()), place(graph.weight.size());
  if (n == 0 || neighbours.empty()) return {};
  // METIS draws from the C library's random numbers, which all threads share: one at a time, or the order, and with it
  // the last bits of every result, would depend on who else builds a model.
  static std::mutex drawing;
  const std::lock_guard lock(drawing);
  const int status =
      METIS_NodeND(&n, first.data(), neighbours.data(), weights.data(), nullptr, order.data(), place.data());
  if (status != METIS_OK) return {};
  return {order.begin(), order.end()};
}

}  // namespace sinew::linalg
