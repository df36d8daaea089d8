#include "sinew/solid/mesh_order.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <map>
#include <span>
#include <unordered_map>
#include <utility>

namespace sinew::solid {
namespace {

/// An edge by the numbers of its ends, the same for all cells that share it.
std::uint64_t key_of(int a, int b) {
  const auto [low, high] = std::minmax(a, b);
  return static_cast<std::uint64_t>(low) << 32 | static_cast<std::uint64_t>(high);
}

/// Calls `see(a, b, middle)` for the ends of every edge of a tetrahedron and the place of its middle node in the cell.
template <class See>
void each_edge(const Cell& cell, const See& see) {
  if (cell.kind == Kind::hex8) return;
  std::size_t middle = 4;
  for (const auto& [a, b] : tetrahedron_edges())
    see(cell.node[static_cast<std::size_t>(a)], cell.node[static_cast<std::size_t>(b)], middle++);
}

bool has(const std::vector<Cell>& cells, Kind kind) {
  return std::any_of(cells.begin(), cells.end(), [kind](const Cell& cell) { return cell.kind == kind; });
}

/// The node in the middle of each edge that has one.
using Middles = std::unordered_map<std::uint64_t, int>;

Middles middles(const std::vector<Cell>& cells) {
  Middles found;
  for (const Cell& cell : cells) {
    if (cell.kind != Kind::tet10) continue;
    each_edge(cell, [&](int a, int b, std::size_t middle) { found.try_emplace(key_of(a, b), cell.node[middle]); });
  }
  return found;
}

/// Middle nodes of a face of three, if all its edges have one.
void raise(CellFace& face, const Middles& middle) {
  if (face.count != 3) return;
  CellFace raised = face;
  for (std::size_t i = 0; i < 3; ++i) {
    const auto at = middle.find(key_of(face.node[i], face.node[(i + 1) % 3]));
    if (at == middle.end()) return;
    raised.node[3 + i] = at->second;
  }
  raised.count = 6;
  face = raised;
}

using Ends = std::pair<int, int>;  // of an edge

/// The nodes of a group after its cells and faces have been raised. `fresh` are the edges with new nodes, from number
/// `first` on.
void raise_nodes(Group& group, const std::vector<Cell>& cells, const std::vector<Ends>& fresh, int first) {
  std::vector<int> own;
  const auto add = [&own](std::span<const int> nodes) { own.insert(own.end(), nodes.begin(), nodes.end()); };
  for (const CellFace& face : group.faces) add(face.nodes());
  for (const int cell : group.cells) add(cells[static_cast<std::size_t>(cell)].nodes());
  make_ascending(own);
  std::vector<int> loose;  // of lines and points
  std::set_difference(group.nodes.begin(), group.nodes.end(), own.begin(), own.end(), std::back_inserter(loose));
  const auto in = [](const std::vector<int>& nodes, int node) {
    return std::binary_search(nodes.begin(), nodes.end(), node);
  };
  if (!loose.empty()) {
    for (std::size_t i = 0; i < fresh.size(); ++i) {
      const auto [a, b] = fresh[i];
      if ((in(loose, a) && in(group.nodes, b)) || (in(loose, b) && in(group.nodes, a)))
        own.push_back(first + static_cast<int>(i));
    }
  }
  add(group.nodes);
  make_ascending(own);
  group.nodes = std::move(own);
}

/// The first cell of an accepted kind that has all these nodes.
template <class Accept>
int cell_with(const std::vector<Cell>& cells, std::span<const int> nodes, const Accept& accept) {
  const auto found = std::find_if(cells.begin(), cells.end(), [&](const Cell& cell) {
    const std::span<const int> own = cell.nodes();
    return accept(cell.kind) && std::all_of(nodes.begin(), nodes.end(), [own](int node) {
             return std::find(own.begin(), own.end(), node) != own.end();
           });
  });
  return static_cast<int>(found - cells.begin());
}

}  // namespace

int meeting_orders(const std::vector<Cell>& cells) {
  if (!has(cells, Kind::tet4)) return 0;
  const Middles middle = middles(cells);
  if (middle.empty()) return 0;
  return static_cast<int>(std::count_if(cells.begin(), cells.end(), [&middle](const Cell& cell) {
    bool meets = false;
    if (cell.kind == Kind::tet4)
      each_edge(cell, [&](int a, int b, std::size_t) { meets = meets || middle.contains(key_of(a, b)); });
    return meets;
  }));
}

std::vector<int> untied_middles(const std::vector<Cell>& cells) {
  std::vector<int> untied;
  if (!has(cells, Kind::tet4)) return untied;
  const Middles middle = middles(cells);
  for (const Cell& cell : cells) {
    if (cell.kind != Kind::tet4) continue;
    each_edge(cell, [&](int a, int b, std::size_t) {
      if (const auto at = middle.find(key_of(a, b)); at != middle.end()) untied.push_back(at->second);
    });
  }
  make_ascending(untied);
  return untied;
}

Mesh quadratic(Mesh mesh) {
  Middles middle = middles(mesh.cells);
  const auto first = static_cast<int>(mesh.nodes.cols());
  std::vector<Ends> fresh;
  for (Cell& cell : mesh.cells) {
    if (cell.kind != Kind::tet4) continue;
    cell.kind = Kind::tet10;
    each_edge(cell, [&](int a, int b, std::size_t place) {
      const auto [at, added] = middle.try_emplace(key_of(a, b), first + static_cast<int>(fresh.size()));
      if (added) fresh.emplace_back(a, b);
      cell.node[place] = at->second;
    });
  }
  mesh.nodes.conservativeResize(3, first + static_cast<Eigen::Index>(fresh.size()));
  for (std::size_t i = 0; i < fresh.size(); ++i) {
    mesh.nodes.col(first + static_cast<Eigen::Index>(i)) =
        0.5 * (mesh.nodes.col(fresh[i].first) + mesh.nodes.col(fresh[i].second));
  }
  for (auto& [name, group] : mesh.groups) {
    for (CellFace& face : group.faces) raise(face, middle);
    raise_nodes(group, mesh.cells, fresh, first);
  }
  return mesh;
}

std::optional<CellPair> mismatched_faces(const std::vector<Cell>& cells) {
  if (!has(cells, Kind::hex8) || !(has(cells, Kind::tet4) || has(cells, Kind::tet10))) return std::nullopt;
  const std::vector<CellFace> outer = boundary(cells);
  const auto sorted = [](std::array<int, 3> corners) {
    std::sort(corners.begin(), corners.end());
    return corners;
  };
  std::map<std::array<int, 3>, const CellFace*> parts;  // three corners of each quadrilateral
  for (const CellFace& face : outer) {
    if (face.count != 4) continue;
    for (std::size_t c = 0; c < 4; ++c)
      parts.emplace(sorted({face.node[c], face.node[(c + 1) % 4], face.node[(c + 2) % 4]}), &face);
  }
  for (const CellFace& face : outer) {
    if (face.count == 4) continue;
    const auto part = parts.find(sorted({face.node[0], face.node[1], face.node[2]}));
    if (part == parts.end()) continue;
    return CellPair{cell_with(cells, part->second->nodes(), [](Kind kind) { return kind == Kind::hex8; }),
                    cell_with(cells, face.nodes(), [](Kind kind) { return kind != Kind::hex8; })};
  }
  return std::nullopt;
}

std::optional<CellPair> mismatched_edges(const std::vector<Cell>& cells) {
  struct Seen {
    int middle, cell;
  };
  std::unordered_map<std::uint64_t, Seen> edges;
  for (std::size_t i = 0; i < cells.size(); ++i) {
    if (cells[i].kind != Kind::tet10) continue;
    std::optional<CellPair> found;
    each_edge(cells[i], [&](int a, int b, std::size_t place) {
      const Seen own = {cells[i].node[place], static_cast<int>(i)};
      const Seen& other = edges.try_emplace(key_of(a, b), own).first->second;
      if (other.middle != own.middle) found = {other.cell, own.cell};
    });
    if (found) return found;
  }
  return std::nullopt;
}

}  // namespace sinew::solid
