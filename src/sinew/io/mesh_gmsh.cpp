#include "sinew/io/mesh_gmsh.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "sinew/io/mesh_formats.hpp"

namespace sinew::io {
namespace {

class Gmsh {
 public:
  Gmsh(std::string_view bytes, const std::string& file) : cursor_(bytes, file) {}

  solid::Mesh read() {
    read_sections();
    solid::Mesh mesh;
    mesh.nodes = Eigen::Map<const Eigen::Matrix3Xd>(content_.coordinates.data(), 3, std::ssize(content_.tags));
    mesh.ignored = std::move(content_.ignored);
    add_elements(mesh);
    finish_cells(mesh);
    return mesh;
  }

 private:
  void read_sections() {
    bool format = false, nodes = false, elements = false;
    while (!(nodes && elements) && !cursor_.done()) {
      const std::string_view name = cursor_.word("a section");
      if (!name.starts_with("$")) {
        cursor_.fail(in_quotes(name), "a section must begin with its name, as $Nodes",
                     "a count before this place is wrong, or the file is damaged: write the mesh again with Gmsh");
      }
      if (name == "$MeshFormat") {
        read_format();
        format = true;
      } else if (name == "$Nodes" || name == "$Elements") {
        bool& seen = name == "$Nodes" ? nodes : elements;
        if (!format || seen) {
          cursor_.fail(in_quotes(name), "must come once, after $MeshFormat", "write the mesh again with Gmsh");
        }
        seen = true;
        cursor_.line();
        read_content(name == "$Nodes");
      } else if (name == "$PhysicalNames" || (name == "$Entities" && version_4_)) {
        if (elements) cursor_.fail(in_quotes(name), "must come before $Elements", "write the mesh again with Gmsh");
        cursor_.line();
        name == "$Entities" ? read_entities_4(cursor_, encoding_, content_) : read_names(cursor_, content_);
      } else {
        skip(name);
        continue;
      }
      expect_end(name);
    }
    if (!nodes || !elements) {
      cursor_.fail("end of file", fmt::format("the file must have a section {}", nodes ? "$Elements" : "$Nodes"),
                   "the file is cut short or has parametric coordinates: write it again with Mesh.SaveParametric = 0");
    }
  }

  void read_content(bool nodes) {
    if (version_4_) {
      nodes ? read_nodes_4(cursor_, encoding_, content_) : read_elements_4(cursor_, encoding_, content_);
    } else {
      nodes ? read_nodes_2(cursor_, encoding_, content_) : read_elements_2(cursor_, encoding_, content_);
    }
  }

  void read_format() {
    const std::string_view version = cursor_.word("the version");
    version_4_ = version == "4.1";
    if (!version_4_ && version != "2.2" && version != "2.1" && version != "2" && version != "2.0") {
      cursor_.fail(in_quotes(version), "the version of a Gmsh file must be 2.2 or 4.1",
                   "save it again: `gmsh -save -format msh41 in.msh -o out.msh`");
    }
    const std::int64_t binary = cursor_.integer(NumberType::i32, {}, "0 (text) or 1 (binary)");
    if (binary != 0 && binary != 1) {
      cursor_.fail(std::to_string(binary), "must be 0 (text) or 1 (binary)", "write the mesh again with Gmsh");
    }
    const std::int64_t size = cursor_.integer(NumberType::i32, {}, "the size of a number");
    if (size != 8) cursor_.fail(std::to_string(size), "the size of a number must be 8", "save with double precision");
    encoding_.text = binary == 0;
    if (!encoding_.text) read_order();
  }

  /// The number 1 tells the order of the bytes.
  void read_order() {
    cursor_.line();
    const std::string_view one = cursor_.take(4, "the number 1");
    encoding_.order = one[0] == 1 ? std::endian::little : std::endian::big;
    if (ByteCursor(one, "").integer(NumberType::i32, encoding_, "one") != 1) {
      cursor_.fail("another number", "four bytes with the number 1 must follow the format of a binary file",
                   "write the mesh again with Gmsh");
    }
    cursor_.fix_line(0);
  }

  void expect_end(std::string_view section) {
    const std::string end = "$End" + std::string(section.substr(1));
    const std::string_view word = cursor_.word(end);
    if (word != end) {
      cursor_.fail(in_quotes(word), fmt::format("{} must stand here", end),
                   "a count in the section is wrong: write the mesh again with Gmsh");
    }
  }

  void skip(std::string_view section) {
    const std::string end = "$End" + std::string(section.substr(1));
    if (!cursor_.skip_past(end)) {
      cursor_.fail(in_quotes(section), fmt::format("the section must end with {}", end),
                   "the file is cut short: write the mesh again with Gmsh");
    }
  }

  /// From node tags to node numbers.
  void add_elements(solid::Mesh& mesh) {
    std::vector<std::pair<std::int64_t, int>> numbers;
    numbers.reserve(content_.tags.size());
    for (const std::int64_t tag : content_.tags) numbers.emplace_back(tag, static_cast<int>(numbers.size()));
    std::sort(numbers.begin(), numbers.end());
    const auto same = [](const auto& a, const auto& b) { return a.first == b.first; };
    const auto twice = std::adjacent_find(numbers.begin(), numbers.end(), same);
    if (twice != numbers.end()) {
      cursor_.fail_at(content_.tag_places[static_cast<std::size_t>((twice + 1)->second)],
                      fmt::format("node tag {}", twice->first), "a node tag must stand for one node only",
                      "renumber the nodes in Gmsh and save again");
    }
    auto tag = content_.element_tags.begin();
    std::vector<int> nodes;
    for (std::size_t i = 0; i < content_.elements.size(); ++i) {
      const GmshElement& element = content_.elements[i];
      nodes.clear();
      for (int k = 0; k < element.kind->nodes; ++k, ++tag) {
        const auto found = std::lower_bound(numbers.begin(), numbers.end(), std::pair(*tag, 0));
        if (found == numbers.end() || found->first != *tag) {
          cursor_.fail_at(element.place, fmt::format("node tag {}", *tag),
                          fmt::format("the nodes of element {} (0-based, counting used elements only), a {}, must be "
                                      "in $Nodes",
                                      i, element.kind->name),
                          "the file is incomplete: write the mesh again with Gmsh");
        }
        nodes.push_back(found->second);
      }
      add_cell(mesh, *element.kind, nodes, *element.groups);
    }
  }

  ByteCursor cursor_;
  Encoding encoding_;
  bool version_4_ = false;
  GmshContent content_;
};

}  // namespace

solid::Mesh parse_gmsh(std::string_view bytes, const std::string& file) { return Gmsh(bytes, file).read(); }

}  // namespace sinew::io
