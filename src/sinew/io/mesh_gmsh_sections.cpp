// Nodes, elements and groups as MSH 2.2 and MSH 4.1 lay them out,
// https://gmsh.info/doc/texinfo/gmsh.html#Gmsh-file-formats.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string_view>
#include <utility>

#include "sinew/io/mesh_gmsh.hpp"

namespace sinew::io {
namespace {

using enum NumberType;

using enum Role;
using solid::Kind;

constexpr const char* write_again = "the file is damaged: write the mesh again with Gmsh";
constexpr std::size_t most_groups = 100;  // of an entity: more, and a short file could ask for much memory

constexpr std::array kinds = {
    FileKind{1, "line", 2, points},
    FileKind{2, "triangle", 3, face},
    FileKind{3, "quadrilateral", 4, face},
    FileKind{4, "tetrahedron", 4, cell, Kind::tet4},
    FileKind{5, "hexahedron", 8, cell, Kind::hex8},
    FileKind{6, "wedge", 6},
    FileKind{7, "pyramid", 5},
    FileKind{8, "quadratic line", 3, points},
    FileKind{9, "quadratic triangle", 6, face},
    FileKind{10, "quadratic quadrilateral", 9},
    FileKind{11, "quadratic tetrahedron", 10, cell, Kind::tet10, {0, 1, 2, 3, 4, 5, 6, 7, 9, 8}},
    FileKind{12, "quadratic hexahedron", 27},
    FileKind{13, "quadratic wedge", 18},
    FileKind{14, "quadratic pyramid", 14},
    FileKind{15, "vertex", 1, points},
    FileKind{16, "quadratic quadrilateral", 8},
    FileKind{17, "quadratic hexahedron", 20},
    FileKind{18, "quadratic wedge", 15},
    FileKind{19, "quadratic pyramid", 13},
    FileKind{20, "higher-order triangle", 9},
    FileKind{21, "higher-order triangle", 10},
    FileKind{22, "higher-order triangle", 12},
    FileKind{23, "higher-order triangle", 15},
    FileKind{24, "higher-order triangle", 15},
    FileKind{25, "higher-order triangle", 21},
    FileKind{26, "higher-order line", 4},
    FileKind{27, "higher-order line", 5},
    FileKind{28, "higher-order line", 6},
    FileKind{29, "higher-order tetrahedron", 20},
    FileKind{30, "higher-order tetrahedron", 35},
    FileKind{31, "higher-order tetrahedron", 56},
    FileKind{92, "higher-order hexahedron", 64},
    FileKind{93, "higher-order hexahedron", 125}};

const FileKind& read_kind(ByteCursor& cursor, Encoding encoding) {
  const std::int64_t type = cursor.integer(i32, encoding, "an element type");
  const auto found =
      std::find_if(kinds.begin(), kinds.end(), [type](const FileKind& kind) { return kind.type == type; });
  if (found == kinds.end()) {
    cursor.fail(std::to_string(type), "the element type must be one that Gmsh's manual numbers, from 1 to 31, 92 or 93",
                "save the mesh with elements of first or second order");
  }
  return *found;
}

/// Of the kinds that can be in a group.
int dimension_of(const FileKind& kind) {
  if (kind.role == cell) return 3;
  if (kind.role == face) return 2;
  return kind.nodes == 1 ? 0 : 1;
}

int read_dimension(ByteCursor& cursor, Encoding encoding) {
  const std::int64_t dimension = cursor.integer(i32, encoding, "the dimension of an entity");
  if (dimension < 0 || dimension > 3) {
    cursor.fail(std::to_string(dimension), "the dimension of an entity must be from 0 to 3", write_again);
  }
  return static_cast<int>(dimension);
}

/// Its name, or its number as text. A minus sign only tells that its faces look the other way.
std::string group_name(const GmshContent& content, int dimension, std::int64_t number) {
  const auto named = content.names.find({dimension, without_sign(number)});
  return named == content.names.end() ? without_sign(number) : named->second;
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
void read_element(ByteCursor& cursor, Encoding encoding, const FileKind& kind, NumberType tag,
                  const std::vector<std::string>& groups, GmshContent& content) {
  const auto count = static_cast<std::size_t>(kind.nodes);
  if (!is_used(kind, !groups.empty())) {
    cursor.skip(count, tag, encoding, "node tags");
    ++content.ignored[kind.name];
    return;
  }
  content.elements.push_back({&kind, cursor.last(), &groups});
  for (std::size_t k = 0; k < count; ++k) content.element_tags.push_back(cursor.integer(tag, encoding, "a node tag"));
}

/// The first of an element's tags is its physical group, 0 for none.
const std::vector<std::string>& read_group_2(ByteCursor& cursor, Encoding encoding, std::size_t tags,
                                             const FileKind& kind, GmshContent& content) {
  static const std::vector<std::string> none;
  if (tags == 0) return none;
  const std::int64_t number = cursor.integer(i32, encoding, "the number of a physical group");
  cursor.skip(tags - 1, i32, encoding, "tags of an element");
  if (number == 0 || !is_used(kind, true)) return none;
  std::vector<std::string>& names = content.groups[{dimension_of(kind), number}];
  if (names.empty()) names.push_back(group_name(content, dimension_of(kind), number));
  return names;
}

/// `place` is where the section says how many.
void require_total(const ByteCursor& cursor, std::size_t place, std::size_t found, std::size_t said, const char* what) {
  if (found == said) return;
  cursor.fail_at(place, std::to_string(said),
                 fmt::format("the number of {} must be {}, as its blocks say", what, found), write_again);
}

}  // namespace

void read_names(ByteCursor& cursor, GmshContent& content) {
  const std::size_t count = cursor.count("the number of names");
  for (std::size_t i = 0; i < count; ++i) {  // text in binary files, too
    const int dimension = read_dimension(cursor, {});
    const std::int64_t number = cursor.integer(i32, {}, "the number of a physical group");
    const std::string_view rest = cursor.line();
    const std::size_t open = rest.find('"'), close = rest.rfind('"');
    if (open == close) {
      cursor.fail(in_quotes(rest), "the name of a physical group must stand in quotation marks behind its number",
                  "write it as in: 2 7 \"wall\"");
    }
    const std::string_view name = rest.substr(open + 1, close - open - 1);
    if (!name.empty()) content.names.emplace(std::pair(dimension, without_sign(number)), name);
  }
}

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
    const FileKind& kind = read_kind(cursor, encoding);
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
      const std::vector<std::string>& groups =
          read_group_2(cursor, encoding, static_cast<std::size_t>(tags), kind, content);
      read_element(cursor, encoding, kind, i32, groups, content);
    }
    read += static_cast<std::size_t>(followers);
  }
}

void read_entities_4(ByteCursor& cursor, Encoding encoding, GmshContent& content) {
  std::array<std::size_t, 4> counts{};  // of points, curves, surfaces, volumes
  for (std::size_t& count : counts) count = read_size(cursor, encoding, "the number of entities");
  for (int dimension = 0; dimension < 4; ++dimension) {
    for (std::size_t i = 0; i < counts[static_cast<std::size_t>(dimension)]; ++i) {
      const std::int64_t entity = cursor.integer(i32, encoding, "the tag of an entity");
      cursor.skip(dimension == 0 ? 3 : 6, f64, encoding, "the box of an entity");
      const std::size_t count = read_size(cursor, encoding, "the number of physical groups of an entity");
      std::vector<std::string>& names = content.groups[{dimension, entity}];
      for (std::size_t k = 0; k < count; ++k) {
        std::string name = group_name(content, dimension, cursor.integer(i32, encoding, "a physical group"));
        if (std::find(names.begin(), names.end(), name) == names.end()) names.push_back(std::move(name));
        if (names.size() <= most_groups) continue;
        cursor.fail(std::to_string(count), fmt::format("an entity may be in at most {} physical groups", most_groups),
                    "the file is damaged, or has too many groups: write it with fewer");
      }
      if (dimension == 0) continue;
      cursor.skip(read_size(cursor, encoding, "the number of an entity's bounds"), i32, encoding, "bounds");
    }
  }
}

void read_nodes_4(ByteCursor& cursor, Encoding encoding, GmshContent& content) {
  const std::size_t blocks = read_size(cursor, encoding, "the number of node blocks");
  const std::size_t count = read_size(cursor, encoding, "the number of nodes");
  const std::size_t place = cursor.last();
  cursor.skip(2, u64, encoding, "the smallest and largest node tag");
  cursor.require(count, u64, encoding, "node tags");
  for (std::size_t block = 0; block < blocks; ++block) {
    const int dimension = read_dimension(cursor, encoding);
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
    const int dimension = read_dimension(cursor, encoding);
    const std::int64_t entity = cursor.integer(i32, encoding, "the tag of an entity");
    const std::vector<std::string>& groups = content.groups[{dimension, entity}];
    const FileKind& kind = read_kind(cursor, encoding);
    const std::size_t here = read_size(cursor, encoding, "the number of elements in a block");
    cursor.require(here, u64, encoding, "element tags");
    for (std::size_t i = 0; i < here; ++i) {
      cursor.integer(u64, encoding, "an element tag");
      read_element(cursor, encoding, kind, u64, groups, content);
    }
    total += here;
  }
  require_total(cursor, place, total, count, "elements");
}

}  // namespace sinew::io
