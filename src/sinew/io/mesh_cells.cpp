#include "sinew/io/mesh_cells.hpp"

#include <algorithm>
#include <cstddef>
#include <numeric>

namespace sinew::io {
namespace {

/// Per cell, the first one that equals it: itself for most.
std::vector<int> first_equals(const std::vector<solid::Cell>& cells) {
  std::vector<int> sorted(cells.size());
  std::iota(sorted.begin(), sorted.end(), 0);
  std::stable_sort(sorted.begin(), sorted.end(), [&cells](int a, int b) {
    const solid::Cell &left = cells[static_cast<std::size_t>(a)], &right = cells[static_cast<std::size_t>(b)];
    return left.kind != right.kind ? left.kind < right.kind : left.node < right.node;
  });
  std::vector<int> firsts(cells.size());
  int first = 0;
  for (const int i : sorted) {
    if (!(cells[static_cast<std::size_t>(i)] == cells[static_cast<std::size_t>(first)])) first = i;
    firsts[static_cast<std::size_t>(i)] = first;
  }
  return firsts;
}

void join_repeated(solid::Mesh& mesh) {
  std::vector<int> numbers = first_equals(mesh.cells);  // then the numbers of the cells that stay
  int kept = 0;
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    const auto first = static_cast<std::size_t>(numbers[i]);
    if (first == i) {
      mesh.cells[static_cast<std::size_t>(kept)] = mesh.cells[i];
      numbers[i] = kept++;
    } else {
      numbers[i] = numbers[first];
    }
  }
  mesh.cells.resize(static_cast<std::size_t>(kept));
  for (auto& [name, group] : mesh.groups) {
    for (int& cell : group.cells) cell = numbers[static_cast<std::size_t>(cell)];
  }
}

}  // namespace

bool is_used(const FileKind& kind, bool in_groups) {
  return kind.role == Role::cell || (in_groups && kind.role != Role::unused);
}

void add_cell(solid::Mesh& mesh, const FileKind& kind, std::span<const int> nodes,
              std::span<const std::string> groups) {
  if (!is_used(kind, !groups.empty())) {
    ++mesh.ignored[kind.name];
    return;
  }
  const auto number = static_cast<int>(mesh.cells.size());
  const auto copy = [&](auto& to) {
    for (std::size_t i = 0; i < nodes.size(); ++i) to[i] = nodes[kind.order[i]];
  };
  if (kind.role == Role::cell) copy(mesh.cells.emplace_back(solid::Cell{kind.kind, {}}).node);
  for (const std::string& name : groups) {
    solid::Group& group = mesh.groups[name];
    if (kind.role == Role::cell) group.cells.push_back(number);
    if (kind.role == Role::face) copy(group.faces.emplace_back(solid::CellFace{kind.nodes, {}}).node);
    group.nodes.insert(group.nodes.end(), nodes.begin(), nodes.end());
  }
}

void finish_cells(solid::Mesh& mesh) {
  join_repeated(mesh);
  for (auto& [name, group] : mesh.groups) {
    solid::make_ascending(group.cells);
    solid::make_ascending(group.nodes);
  }
}

std::string without_sign(std::int64_t number) {
  const std::string text = std::to_string(number);
  return text.substr(text.front() == '-' ? 1 : 0);
}

}  // namespace sinew::io
