// Volume meshes from files: legacy VTK (2.0 to 5.x, ASCII and binary), VTU (ASCII, base64 and raw, with or without
// zlib) and Gmsh MSH (2.2 and 4.1, ASCII and binary). Linear tetrahedra are used; all other cells are counted by kind.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "sinew/solid/mesh.hpp"

namespace sinew::io {

/// Reads and checks the mesh. Its format is told from its content, not from its name. Throws InputError.
solid::Mesh read_mesh(const std::filesystem::path& path);

/// The same for a file that is in memory; `name` stands for it in messages.
solid::Mesh parse_mesh(std::string_view bytes, const std::string& name);

/// Throws InputError unless the mesh has a tetrahedron, its coordinates are finite, its node numbers in range, and
/// every tetrahedron's volume is above 1e-12 of its longest edge cubed. Nothing is repaired: elements keep their order.
void check_mesh(const solid::Mesh& mesh, const std::string& file);

}  // namespace sinew::io
