// Nodes and elements as MSH 2.2 and MSH 4.1 lay them out, https://gmsh.info/doc/texinfo/gmsh.html#Gmsh-file-formats.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string_view>

#include "sinew/io/mesh_gmsh.hpp"

namespace sinew::io {
namespace {

using enum NumberType;

struct Kind {
  std::int64_t type;  ///< Gmsh's number
  const char* name;
  std::size_t nodes;
};

constexpr std::int64_t tetra = 4;
constexpr const char* write_again = "the file is damaged: write the mesh again with Gmsh";

constexpr std::array<Kind, 33> kinds = {{{1, "line", 2},
                                         {2, "triangle", 3},
                                         {3, "quadrilateral", 4},
                                         {tetra, "tetrahedron", 4},
                                         {5, "hexahedron", 8},
                                         {6, "wedge", 6},
                                         {7, "pyramid", 5},
                                         {8, "quadratic line", 3},
                                         {9, "quadratic triangle", 6},
                                         {10, "quadratic quadrilateral", 9},
                                         {11, "quadratic tetrahedron", 10},
                                         {12, "quadratic hexahedron", 27},
                                         {13, "quadratic wedge", 18},
                                         {14, "quadratic pyramid", 14},
                                         {15, "vertex", 1},
                                         {16, "quadratic quadrilateral", 8},
                                         {17, "quadratic hexahedron", 20},
                                         {18, "quadratic wedge", 15},
                                         {19, "quadratic pyramid", 13},
                                         {20, "higher-order triangle", 9},
                                         {21, "higher-order triangle", 10},
                                         {22, "higher-order triangle", 12},
                                         {23, "higher-order triangle", 15},
                                         {24, "higher-order triangle", 15},
                                         {25, "higher-order triangle", 21},
                                         {26, "higher-order line", 4},
                                         {27, "higher-order line", 5},
                                         {28, "higher-order line", 6},
                                         {29, "higher-order tetrahedron", 20},
                                         {30, "higher-order tetrahedron", 35},
                                         {31, "higher-order tetrahedron", 56},
                                         {92, "higher-order hexahedron", 64},
                                         {93, "higher-order hexahedron", 125}}};

const Kind& read_kind(ByteCursor& cursor, Encoding encoding) {
  const std::int64_t type = cursor.integer(i32, encoding, "an element type");
  const auto found = std::find_if(kinds.begin(), kinds.end(), [type](const Kind& kind) { return kind.type == type; });
  if (found == kinds.end()) {
    cursor.fail(std::to_string(type), "the element type must be one that Gmsh's manual numbers, from 1 to 31, 92 or 93",
                "save the mesh with first-order elements");
  }
  return *found;
}

/// A count as 4.1 writes it: a word, or 8 bytes. Whether it fits the file is checked where it is used.
std::size_t read_size(ByteCursor& cursor, Encoding encoding, std::string_view what) {
  const std::int64_t value = cursor.integer(u64, encoding, what);
  if (value < 0) cursor.fail(std::to_string(value), fmt::format("{} must be 0 or more", what), write_again);
  return static_cast<std::size_t>(value);
}

void read_tag(ByteCursor& cursor, Encoding encoding, NumberType type, GmshContent& content) {
  content.tags.push_back(cursor.integer(type, encoding, "a node tag"));
  content.tag_places.push_back(cursor.last());
}

void read_coordinates(ByteCursor& cursor, Encoding encoding, GmshContent& content) {
  for (int k = 0; k < 3; ++k) content.coordinates.push_back(cursor.real(f64, encoding, "a coordinate"));
}

/// The node tags of one element.
void read_element(ByteCursor& cursor, Encoding encoding, const Kind& kind, NumberType tag, GmshContent& content) {
  if (kind.type != tetra) {
    cursor.skip(kind.nodes, tag, encoding, "node tags");
    ++content.ignored[kind.name];
    return;
  }
  content.places.push_back(cursor.last());
  for (std::size_t k = 0; k < kind.nodes; ++k) {
    content.tetrahedra.push_back(cursor.integer(tag, encoding, "a node tag"));
  }
}

/// `place` is where the section says how many.
void require_total(const ByteCursor& cursor, std::size_t place, std::size_t found, std::size_t said, const char* what) {
  if (found == said) return;
  cursor.fail_at(place, std::to_string(said),
                 fmt::format("the number of {} must be {}, as its blocks say", what, found), write_again);
}

}  // namespace

void read_nodes_2(ByteCursor& cursor, Encoding encoding, GmshContent& content) {
  const std::size_t count = cursor.count("the number of nodes");
  cursor.line();
  cursor.require(count, i32, encoding, "node tags");
  for (std::size_t i = 0; i < count; ++i) {
    read_tag(cursor, encoding, i32, content);
    read_coordinates(cursor, encoding, content);
  }
}

void read_elements_2(ByteCursor& cursor, Encoding encoding, GmshContent& content) {
  const std::size_t count = cursor.count("the number of elements");
  cursor.line();
  cursor.require(count, i32, encoding, "element tags");
  for (std::size_t read = 0; read < count;) {
    // In text every element stands for itself: tag, type, number of tags. In binary such a head is for many of them:
    // type, number of elements, number of tags.
    if (encoding.text) cursor.integer(i32, encoding, "an element tag");
    const Kind& kind = read_kind(cursor, encoding);
    const std::int64_t followers =
        encoding.text ? 1 : cursor.integer(i32, encoding, "the number of elements in a block");
    if (followers < 0 || static_cast<std::size_t>(followers) > count - read) {
      cursor.fail(std::to_string(followers),
                  fmt::format("a block must hold at most the {} elements left", count - read), write_again);
    }
    const std::int64_t tags = cursor.integer(i32, encoding, "the number of tags of an element");
    if (tags < 0) cursor.fail(std::to_string(tags), "the number of tags must be 0 or more", write_again);
    for (std::int64_t i = 0; i < followers; ++i) {
      if (!encoding.text) cursor.integer(i32, encoding, "an element tag");
      cursor.skip(static_cast<std::size_t>(tags), i32, encoding, "tags of an element");
      read_element(cursor, encoding, kind, i32, content);
    }
    read += static_cast<std::size_t>(followers);
  }
}

void read_nodes_4(ByteCursor& cursor, Encoding encoding, GmshContent& content) {
  const std::size_t blocks = read_size(cursor, encoding, "the number of node blocks");
  const std::size_t count = read_size(cursor, encoding, "the number of nodes");
  const std::size_t place = cursor.last();
  cursor.skip(2, u64, encoding, "the smallest and largest node tag");
  cursor.require(count, u64, encoding, "node tags");
  for (std::size_t block = 0; block < blocks; ++block) {
    const std::int64_t dimension = cursor.integer(i32, encoding, "the dimension of an entity");
    if (dimension < 0 || dimension > 3) {
      cursor.fail(std::to_string(dimension), "the dimension of an entity must be from 0 to 3", write_again);
    }
    cursor.integer(i32, encoding, "the tag of an entity");
    const bool parametric = cursor.integer(i32, encoding, "parametric (0 or 1)") != 0;
    const std::size_t here = read_size(cursor, encoding, "the number of nodes in a block");
    cursor.require(here, u64, encoding, "node tags");
    for (std::size_t i = 0; i < here; ++i) read_tag(cursor, encoding, u64, content);
    for (std::size_t i = 0; i < here; ++i) {
      read_coordinates(cursor, encoding, content);
      if (parametric) cursor.skip(static_cast<std::size_t>(dimension), f64, encoding, "parameters of a node");
    }
  }
  require_total(cursor, place, content.tags.size(), count, "nodes");
}

void read_elements_4(ByteCursor& cursor, Encoding encoding, GmshContent& content) {
  const std::size_t blocks = read_size(cursor, encoding, "the number of element blocks");
  const std::size_t count = read_size(cursor, encoding, "the number of elements");
  const std::size_t place = cursor.last();
  cursor.skip(2, u64, encoding, "the smallest and largest element tag");
  cursor.require(count, u64, encoding, "element tags");
  std::size_t total = 0;
  for (std::size_t block = 0; block < blocks; ++block) {
    cursor.integer(i32, encoding, "the dimension of an entity");
    cursor.integer(i32, encoding, "the tag of an entity");
    const Kind& kind = read_kind(cursor, encoding);
    const std::size_t here = read_size(cursor, encoding, "the number of elements in a block");
    cursor.require(here, u64, encoding, "element tags");
    for (std::size_t i = 0; i < here; ++i) {
      cursor.integer(u64, encoding, "an element tag");
      read_element(cursor, encoding, kind, u64, content);
    }
    total += here;
  }
  require_total(cursor, place, total, count, "elements");
}

}  // namespace sinew::io
