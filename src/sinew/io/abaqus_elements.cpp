#include "sinew/io/abaqus_elements.hpp"

#include <algorithm>
#include <array>
#include <cstddef>

#include "sinew/io/byte_cursor.hpp"

namespace sinew::io {
namespace {

using enum Role;
using solid::Kind;

struct NamedKind {
  std::string_view name;
  FileKind kind;
};

constexpr FileKind kTetrahedron4 = {0, "tetrahedron", 4, cell, Kind::tet4},
                   kTetrahedron10 = {0, "quadratic tetrahedron", 10, cell, Kind::tet10},
                   kHexahedron8 = {0, "hexahedron", 8, cell, Kind::hex8}, kTriangle3 = {0, "triangle", 3, face},
                   kTriangle6 = {0, "quadratic triangle", 6, face}, kQuadrilateral4 = {0, "quadrilateral", 4, face},
                   kLine2 = {0, "line", 2, points}, kLine3 = {0, "quadratic line", 3, points};

// clang-format off
/// Plane and axisymmetric elements are here because mesh converters write faces as such.
constexpr std::array kKinds = {
    NamedKind{"C3D4", kTetrahedron4}, NamedKind{"DC3D4", kTetrahedron4},
    NamedKind{"C3D10", kTetrahedron10}, NamedKind{"DC3D10", kTetrahedron10},
    NamedKind{"C3D8", kHexahedron8}, NamedKind{"DC3D8", kHexahedron8},
    NamedKind{"C3D5", {0, "pyramid", 5}}, NamedKind{"C3D6", {0, "wedge", 6}}, NamedKind{"SC6", {0, "shell wedge", 6}},
    NamedKind{"COH3D6", {0, "cohesive wedge", 6}}, NamedKind{"C3D15", {0, "quadratic wedge", 15}},
    NamedKind{"SC8", {0, "shell hexahedron", 8}}, NamedKind{"COH3D8", {0, "cohesive hexahedron", 8}},
    NamedKind{"C3D20", {0, "quadratic hexahedron", 20}}, NamedKind{"C3D27", {0, "quadratic hexahedron", 0}},
    NamedKind{"S3", kTriangle3}, NamedKind{"R3D3", kTriangle3}, NamedKind{"M3D3", kTriangle3},
    NamedKind{"SFM3D3", kTriangle3}, NamedKind{"STRI3", kTriangle3}, NamedKind{"CPS3", kTriangle3},
    NamedKind{"CPE3", kTriangle3}, NamedKind{"CAX3", kTriangle3},
    NamedKind{"S6", kTriangle6}, NamedKind{"STRI65", kTriangle6}, NamedKind{"M3D6", kTriangle6},
    NamedKind{"SFM3D6", kTriangle6}, NamedKind{"CPS6", kTriangle6}, NamedKind{"CPE6", kTriangle6},
    NamedKind{"CAX6", kTriangle6},
    NamedKind{"S4", kQuadrilateral4}, NamedKind{"R3D4", kQuadrilateral4}, NamedKind{"M3D4", kQuadrilateral4},
    NamedKind{"SFM3D4", kQuadrilateral4}, NamedKind{"CPS4", kQuadrilateral4}, NamedKind{"CPE4", kQuadrilateral4},
    NamedKind{"CAX4", kQuadrilateral4},
    NamedKind{"T3D2", kLine2}, NamedKind{"B31", kLine2}, NamedKind{"B33", kLine2},
    NamedKind{"T3D3", kLine3}, NamedKind{"B32", kLine3}};
// clang-format on

/// Faces S1, S2, ... by the places of their corners in the element, turned outward.
constexpr std::array<std::array<std::size_t, 3>, 4> kFacesOfTetrahedron = {
    {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}}};
constexpr std::array<std::array<std::size_t, 4>, 6> kFacesOfHexahedron = {
    {{0, 3, 2, 1}, {4, 5, 6, 7}, {0, 1, 5, 4}, {1, 2, 6, 5}, {2, 3, 7, 6}, {3, 0, 4, 7}}};

/// The node in the middle of an edge of a quadratic tetrahedron.
int node_between(std::span<const int> nodes, std::size_t a, std::size_t b) {
  const auto& edges = solid::tetrahedron_edges();
  const auto edge = std::find_if(edges.begin(), edges.end(), [a, b](const auto& ends) {
    const auto from = static_cast<std::size_t>(ends[0]), to = static_cast<std::size_t>(ends[1]);
    return (from == a && to == b) || (from == b && to == a);
  });
  return nodes[4 + static_cast<std::size_t>(edge - edges.begin())];
}

}  // namespace

const FileKind* abaqus_kind(std::string_view type) {
  const auto is_of = [type](const NamedKind& known) {
    const std::string_view start = type.substr(0, known.name.size());
    const std::string_view rest = type.substr(start.size());
    return equal_ignoring_case(start, known.name) && (rest.empty() || rest[0] < '0' || rest[0] > '9');
  };
  const auto found = std::find_if(kKinds.begin(), kKinds.end(), is_of);
  return found == kKinds.end() ? nullptr : &found->kind;
}

bool is_simplified(const FileKind& kind, std::string_view type) {
  if (kind.role != cell) return false;
  const std::string_view plain = kind.kind == Kind::tet4 ? "C3D4" : kind.kind == Kind::tet10 ? "C3D10" : "C3D8";
  return !equal_ignoring_case(type, plain);
}

std::optional<solid::CellFace> abaqus_face(const FileKind& kind, std::span<const int> nodes, std::string_view name) {
  solid::CellFace found;
  if (kind.role == face) {
    if (!name.empty() && name != "SPOS" && name != "SNEG") return std::nullopt;
    found.count = kind.nodes;
    std::copy(nodes.begin(), nodes.end(), found.node.begin());
    return found;
  }
  if (kind.role != cell || name.size() != 2 || name[0] != 'S' || name[1] < '1') return std::nullopt;
  const auto number = static_cast<std::size_t>(name[1] - '1');
  if (kind.kind == Kind::hex8) {
    if (number >= kFacesOfHexahedron.size()) return std::nullopt;
    found.count = 4;
    for (std::size_t i = 0; i < 4; ++i) found.node[i] = nodes[kFacesOfHexahedron[number][i]];
    return found;
  }
  if (number >= kFacesOfTetrahedron.size()) return std::nullopt;
  const auto& corners = kFacesOfTetrahedron[number];
  found.count = kind.kind == Kind::tet10 ? 6 : 3;
  for (std::size_t i = 0; i < 3; ++i) {
    found.node[i] = nodes[corners[i]];
    if (found.count == 6) found.node[3 + i] = node_between(nodes, corners[i], corners[(i + 1) % 3]);
  }
  return found;
}

}  // namespace sinew::io
