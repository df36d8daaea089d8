// Orders of elimination that leave a sparse symmetric matrix sparse.
#pragma once

#include <span>
#include <vector>

namespace sinew::linalg {

/// Which unknowns of a symmetric matrix meet, those with the same neighbours taken together: the three coordinates of a
/// node, say.
struct Graph {
  std::vector<int> first, neighbour;   ///< neighbour[first[i]] .. before first[i + 1] meet i, ascending, without i
  std::vector<int> weight;             ///< how many unknowns each one stands for
  std::vector<int> member, of_member;  ///< the unknowns of i: member[of_member[i]] .. before of_member[i + 1]

  int size() const { return static_cast<int>(weight.size()); }
  std::span<const int> neighbours(int i) const {
    return {neighbour.data() + first[i], static_cast<std::size_t>(first[i + 1] - first[i])};
  }
  std::span<const int> members(int i) const {
    return {member.data() + of_member[i], static_cast<std::size_t>(of_member[i + 1] - of_member[i])};
  }
};

/// The graph of a matrix given by the compressed columns of its lower triangle.
Graph graph_of(int size, const int* first, const int* row);

/// Each an order: which one is eliminated first, second, ... Empty where METIS finds none.
std::vector<int> minimum_degree(const Graph& graph);
std::vector<int> nested_dissection(const Graph& graph);

}  // namespace sinew::linalg
