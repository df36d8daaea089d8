// What a Gmsh file says of nodes and elements, before its node tags become node numbers.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "sinew/io/byte_cursor.hpp"

namespace sinew::io {

struct GmshContent {
  std::vector<std::int64_t> tags;        ///< of the nodes, in the order of the file; any distinct numbers
  std::vector<std::size_t> tag_places;   ///< where each stands in the file
  std::vector<double> coordinates;       ///< three per node
  std::vector<std::int64_t> tetrahedra;  ///< four node tags each
  std::vector<std::size_t> places;       ///< per tetrahedron, where it stands in the file
  std::map<std::string, int> ignored;    ///< other elements, by kind
};

/// The sections Nodes and Elements; the cursor stands at their first number and ends after their last.
void read_nodes_2(ByteCursor& cursor, Encoding encoding, GmshContent& content);
void read_elements_2(ByteCursor& cursor, Encoding encoding, GmshContent& content);
void read_nodes_4(ByteCursor& cursor, Encoding encoding, GmshContent& content);
void read_elements_4(ByteCursor& cursor, Encoding encoding, GmshContent& content);

}  // namespace sinew::io
