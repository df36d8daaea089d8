// The readers behind parse_mesh, one per format. Each returns what the file says, unchecked beyond its syntax and its
// references; `bytes` begin with the format's own first word.
#pragma once

#include <string>
#include <string_view>

#include "sinew/solid/mesh.hpp"

namespace sinew::io {

solid::Mesh parse_legacy_vtk(std::string_view bytes, const std::string& file);
solid::Mesh parse_vtu(std::string_view bytes, const std::string& file);
solid::Mesh parse_gmsh(std::string_view bytes, const std::string& file);
solid::Mesh parse_abaqus(std::string_view bytes, const std::string& file);

// Surfaces have no word of their own to begin with.
/// How many bytes a binary STL file has by the number of triangles it tells; 0 if these are fewer, so it is none. Some
/// programs write more behind it.
std::size_t binary_stl_size(std::string_view bytes);
bool is_obj(std::string_view first_word);
solid::Mesh parse_binary_stl(std::string_view bytes, const std::string& file);
solid::Mesh parse_text_stl(std::string_view bytes, const std::string& file);
solid::Mesh parse_obj(std::string_view bytes, const std::string& file);

}  // namespace sinew::io
