// From the cells of a file, whatever its format, to the cells and groups of a mesh.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "sinew/solid/mesh.hpp"

namespace sinew::io {

/// What becomes of a cell of a file: an element; or, if it is in a group, a face of that or only its nodes.
enum class Role { cell, face, points, unused };

/// A kind of cell as a format has it.
struct FileKind {
  std::int64_t type;  ///< the format's number
  const char* name;   ///< for people, and in Mesh::ignored
  int nodes = 0;      ///< how many it has; 0: any number
  Role role = Role::unused;
  solid::Kind kind = solid::Kind::tet4;  ///< of a cell
  /// Where the nodes of Cell::node or CellFace::node stand in the file.
  std::array<std::uint8_t, solid::kMostNodes> order = {0, 1, 2, 3, 4, 5, 6, 7, 8, 9};
};

/// Whether the mesh keeps anything of such a cell.
bool is_used(const FileKind& kind, bool in_groups);

/// Adds a cell to the mesh and to these groups, or counts it as ignored if nothing is kept of it. `nodes` are numbers
/// of Mesh::nodes in the order of the file, as many as the kind has; those of an ignored one are not looked at.
void add_cell(solid::Mesh& mesh, const FileKind& kind, std::span<const int> nodes, std::span<const std::string> groups);

/// After the last cell: cells of the same kind and nodes become one, in the groups of all (Gmsh 2.2 repeats an element
/// for each of its groups), and the numbers in groups ascend without repetition.
void finish_cells(solid::Mesh& mesh);

/// The number as text, without its sign: by it Gmsh tells that the faces of a group look the other way.
std::string without_sign(std::int64_t number);

}  // namespace sinew::io
