// Volume meshes from files: legacy VTK (2.0 to 5.x, ASCII and binary), VTU (ASCII, base64 and raw, with or without
// zlib), Gmsh MSH (2.2 and 4.1, ASCII and binary) and Abaqus or CalculiX input (.inp). Tetrahedra with 4 or 10 nodes
// and hexahedra with 8 are used, faces, lines and points only as parts of groups; all other cells are counted by kind.
// Surfaces also from STL (ASCII and binary) and OBJ.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "sinew/solid/mesh.hpp"

namespace sinew::io {

/// Reads and checks the mesh, which has cells or, of a surface, faces alone. Its format is told from its content, not
/// from its name. Throws InputError.
solid::Mesh read_mesh(const std::filesystem::path& path);

/// The same for a file that is in memory; `name` stands for it in messages.
solid::Mesh parse_mesh(std::string_view bytes, const std::string& name);

/// Throws InputError unless the mesh has a cell, its coordinates are finite, the node numbers of its cells in range and
/// different within a cell; every 4-node tetrahedron's volume is above 1e-12 of its longest edge cubed, and every other
/// cell's volume above 0 and its smallest Jacobian above 1e-12. Nothing is repaired: elements keep their order.
void check_mesh(const solid::Mesh& mesh, const std::string& file);

}  // namespace sinew::io
