// Cells as both VTK formats store them, and the way from there to a mesh.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "sinew/solid/mesh.hpp"

namespace sinew::io {

/// Arrays over the cells whose numbers are groups, by name. Of several in a file the first in this order counts.
enum class GroupArray { gmsh_physical, medit_ref, cell_entity_ids, cell_tags, material, region };

/// The one of this name, in small or capital letters; nothing for other names.
std::optional<GroupArray> group_array(std::string_view name);

struct VtkCells {
  std::vector<std::int64_t> connectivity;  ///< node numbers of all cells, one cell after the other
  std::vector<std::int64_t> ends;          ///< per cell, where its numbers end in `connectivity`
  std::vector<std::int64_t> types;         ///< per cell, VTK's number of its kind
  std::optional<GroupArray> grouped_by;
  std::vector<std::int64_t> groups;  ///< per cell, the number of its group, if grouped
};

/// How a reader turns a fault in a cell into an InputError; it knows where the cell stands. Must throw.
using RejectCell =
    std::function<void(std::size_t cell, const std::string& value, const std::string& rule, const std::string& remedy)>;

/// Adds the cells and their groups to the mesh and counts those that are not used. Node numbers are relative to
/// `first_node` and must be below `node_count` (of this piece of the mesh).
void add_cells(const VtkCells& cells, std::int64_t first_node, std::int64_t node_count, solid::Mesh& mesh,
               const RejectCell& reject);

}  // namespace sinew::io
