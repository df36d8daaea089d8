// Element types of Abaqus and CalculiX, and their faces.
#pragma once

#include <optional>
#include <span>
#include <string_view>

#include "sinew/io/mesh_cells.hpp"

namespace sinew::io {

/// The kind of an element type: the longest known name that the type begins with, no digit following, decides. C3D8R
/// and C3D8H are C3D8, C3D20R is C3D20. Null for types that are not known.
const FileKind* abaqus_kind(std::string_view type);

/// Whether a type of this kind has more in it than the plain element: it is hybrid, reduced, modified or of heat.
bool is_simplified(const FileKind& kind, std::string_view type);

/// A face of an element by its name: S1 to S6 of a cell; SPOS, SNEG or nothing of a shell. `nodes` are those of the
/// element, in the order of the file. Nothing for other names and elements.
std::optional<solid::CellFace> abaqus_face(const FileKind& kind, std::span<const int> nodes, std::string_view name);

}  // namespace sinew::io
