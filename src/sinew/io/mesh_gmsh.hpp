// What a Gmsh file says of nodes and elements, before its node tags become node numbers.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "sinew/io/byte_cursor.hpp"
#include "sinew/io/mesh_cells.hpp"

namespace sinew::io {

/// Dimension and number of a physical group, or of an entity of the geometry.
using GmshEntity = std::pair<int, std::int64_t>;

/// An element that the mesh uses.
struct GmshElement {
  const FileKind* kind;
  std::size_t place;                       ///< where it stands in the file
  const std::vector<std::string>* groups;  ///< in GmshContent::groups
};

struct GmshContent {
  std::vector<std::int64_t> tags;       ///< of the nodes, in the order of the file; any distinct numbers
  std::vector<std::size_t> tag_places;  ///< where each stands in the file
  std::vector<double> coordinates;      ///< three per node
  std::vector<GmshElement> elements;
  std::vector<std::int64_t> element_tags;                    ///< of the nodes of one element after the other
  std::map<std::string, int> ignored;                        ///< other elements, by kind
  std::map<std::pair<int, std::string>, std::string> names;  ///< of physical groups, by dimension and number
  /// Names of the physical groups that an entity is in (4.1), or the one of a physical group (2.2).
  std::map<GmshEntity, std::vector<std::string>> groups;
};

/// The sections; the cursor stands at their first number and ends after their last. PhysicalNames and Entities come
/// before Elements.
void read_names(ByteCursor& cursor, GmshContent& content);
void read_nodes_2(ByteCursor& cursor, Encoding encoding, GmshContent& content);
void read_elements_2(ByteCursor& cursor, Encoding encoding, GmshContent& content);
void read_entities_4(ByteCursor& cursor, Encoding encoding, GmshContent& content);
void read_nodes_4(ByteCursor& cursor, Encoding encoding, GmshContent& content);
void read_elements_4(ByteCursor& cursor, Encoding encoding, GmshContent& content);

}  // namespace sinew::io
