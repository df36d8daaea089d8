// VTU, VTK's XML file of an unstructured grid, https://docs.vtk.org/en/latest/vtk_file_formats/vtkxml_file_format.html.
// Raw appended data is not XML; so what follows the tag AppendedData is cut off before the rest is parsed.
#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <optional>
#include <pugixml.hpp>
#include <string_view>

#include "sinew/error/input_error.hpp"
#include "sinew/io/byte_cursor.hpp"
#include "sinew/io/mesh_cells.hpp"
#include "sinew/io/mesh_formats.hpp"
#include "sinew/io/vtk_cells.hpp"
#include "sinew/io/vtu_array.hpp"

namespace sinew::io {
namespace {

constexpr const char* write_as_vtu = "write the mesh again as VTU";

class Vtu {
 public:
  Vtu(std::string_view bytes, const std::string& file) : bytes_(bytes), file_(file) {}

  solid::Mesh read() {
    split();
    parse();
    const pugi::xml_node root = document_.child("VTKFile");
    read_coding(root);
    const pugi::xml_node grid = child(root, "UnstructuredGrid");
    solid::Mesh mesh;
    for (const pugi::xml_node piece : grid.children("Piece")) read_piece(piece, mesh);
    mesh.nodes = Eigen::Map<const Eigen::Matrix3Xd>(coordinates_.data(), 3, std::ssize(coordinates_) / 3);
    finish_cells(mesh);
    return mesh;
  }

 private:
  /// Cuts off the appended data.
  void split() {
    const std::size_t tag = bytes_.find("<AppendedData");
    xml_ = std::string(bytes_.substr(0, tag));
    if (tag == std::string_view::npos) return;
    const std::size_t close = bytes_.find('>', tag);
    const std::string_view attributes = bytes_.substr(tag, close == std::string_view::npos ? close : close - tag);
    const std::size_t start = close == std::string_view::npos ? close : bytes_.find('_', close);
    if (start == std::string_view::npos) {
      fail(line_at(tag), "", "AppendedData must have a start tag and an underscore before its bytes", write_as_vtu);
    }
    coding_.appended = bytes_.substr(start + 1);
    const bool raw = attributes.find("\"raw\"") != std::string_view::npos;
    coding_.appended_base64 = attributes.find("\"base64\"") != std::string_view::npos;
    if (!raw && !coding_.appended_base64) {
      fail(line_at(tag), in_quotes(attributes), "the encoding of AppendedData must be \"raw\" or \"base64\"",
           write_as_vtu);
    }
    xml_ += "</VTKFile>";
  }

  void parse() {
    const pugi::xml_parse_result result =
        document_.load_buffer(xml_.data(), xml_.size(), pugi::parse_default, pugi::encoding_utf8);
    if (!result) {
      const std::size_t end =
          std::min(static_cast<std::size_t>(std::max<std::ptrdiff_t>(result.offset, 0)), xml_.size());
      fail(line_at(end), result.description(), "the file must be well-formed XML", write_as_vtu);
    }
  }

  void read_coding(const pugi::xml_node& root) {
    const auto attribute = [&root](const char* name, const char* otherwise) {
      return std::string(root.attribute(name).as_string(otherwise));
    };
    const auto refuse = [&](const char* name, const std::string& value, const char* rule, const char* remedy) {
      fail(line_of(root), fmt::format("{}={}", name, in_quotes(value)), rule, remedy);
    };
    const std::string type = attribute("type", "");
    if (type != "UnstructuredGrid") {
      refuse("type", type, "VTKFile must be of type UnstructuredGrid",
             "a surface or an image has no volume: mesh it first, for example with Gmsh");
    }
    const std::string order = attribute("byte_order", "LittleEndian");
    if (order != "LittleEndian" && order != "BigEndian") {
      refuse("byte_order", order, "byte_order must be LittleEndian or BigEndian", write_as_vtu);
    }
    coding_.order = order == "BigEndian" ? std::endian::big : std::endian::little;
    const std::string header = attribute("header_type", "UInt32");
    if (header != "UInt32" && header != "UInt64") {
      refuse("header_type", header, "header_type must be UInt32 or UInt64", write_as_vtu);
    }
    coding_.header = header == "UInt64" ? NumberType::u64 : NumberType::u32;
    coding_.compressor = attribute("compressor", "");
  }

  void read_piece(const pugi::xml_node& piece, solid::Mesh& mesh) {
    const std::size_t points = count(piece, "NumberOfPoints");
    const std::size_t cells = count(piece, "NumberOfCells");
    const auto first_node = static_cast<std::int64_t>(coordinates_.size() / 3);
    if (points > 0) {
      const pugi::xml_node element = child(child(piece, "Points"), "DataArray");
      if (element.attribute("NumberOfComponents").as_int(0) != 3) {
        fail(line_of(element), in_quotes(element.attribute("NumberOfComponents").as_string()),
             "NumberOfComponents of Points must be 3", write_as_vtu);
      }
      const std::vector<double> read = array(element).reals(3 * points);
      coordinates_.insert(coordinates_.end(), read.begin(), read.end());
    }
    if (cells == 0) return;
    const pugi::xml_node parent = child(piece, "Cells");
    const VtuArray ends = named(parent, "offsets");
    VtkCells list;
    list.ends = ends.integers(cells);
    list.types = named(parent, "types").integers(cells);
    const std::int64_t entries = list.ends.back();
    if (entries < 0 || entries > std::numeric_limits<int>::max()) {
      ends.fail(std::to_string(entries), "the last offset is the number of node numbers, from 0 to 2147483647",
                write_as_vtu);
    }
    const VtuArray connectivity = named(parent, "connectivity");
    list.connectivity = connectivity.integers(static_cast<std::size_t>(entries));
    read_groups(piece, cells, list);
    add_cells(list, first_node, static_cast<std::int64_t>(points), mesh,
              [&](std::size_t, const std::string& value, const std::string& rule, const std::string& remedy) {
                connectivity.fail(value, rule, remedy);
              });
  }

  /// Keeps the array that groups the cells, if there is one.
  void read_groups(const pugi::xml_node& piece, std::size_t cells, VtkCells& list) {
    pugi::xml_node groups;
    for (const pugi::xml_node element : piece.child("CellData").children("DataArray")) {
      const std::string_view type = element.attribute("type").as_string();
      const std::optional<GroupArray> found = group_array(element.attribute("Name").as_string());
      if (!found || (list.grouped_by && *list.grouped_by <= *found)) continue;
      if (!(type.starts_with("Int") || type.starts_with("UInt"))) continue;
      if (element.attribute("NumberOfComponents").as_int(1) != 1) continue;
      list.grouped_by = found;
      groups = element;
    }
    if (groups) list.groups = array(groups).integers(cells);
  }

  std::size_t count(const pugi::xml_node& piece, const char* name) {
    const std::string text = piece.attribute(name).as_string();
    ByteCursor cursor(text, file_);
    cursor.fix_line(line_of(piece));
    const std::size_t value = cursor.count(name);
    // The real check is against the bytes of the array; this one keeps products of the count in range.
    if (value > static_cast<std::size_t>(std::numeric_limits<int>::max())) {
      cursor.fail(text, fmt::format("{} must be at most 2147483647", name), "the count is wrong: write the mesh again");
    }
    return value;
  }

  pugi::xml_node child(const pugi::xml_node& parent, const char* name) {
    const pugi::xml_node found = parent.child(name);
    if (!found) {
      fail(line_of(parent), "", fmt::format("{} must have an element {}", parent.name(), name), write_as_vtu);
    }
    return found;
  }

  VtuArray named(const pugi::xml_node& parent, const char* name) {
    const pugi::xml_node found = parent.find_child_by_attribute("DataArray", "Name", name);
    if (!found) {
      fail(line_of(parent), "", fmt::format("{} must have a DataArray named {}", parent.name(), name), write_as_vtu);
    }
    return array(found);
  }

  VtuArray array(const pugi::xml_node& element) {
    return VtuArray(element, coding_, file_, line_of(element), line_of(element.first_child()));
  }

  int line_at(std::size_t offset) const {
    const std::string_view before = bytes_.substr(0, offset);
    return 1 + static_cast<int>(std::count(before.begin(), before.end(), '\n'));
  }

  int line_of(const pugi::xml_node& node) const {
    const std::ptrdiff_t offset = node.offset_debug();
    return offset < 0 ? 0 : line_at(static_cast<std::size_t>(offset));
  }

  [[noreturn]] void fail(int line, const std::string& value, const std::string& rule, const std::string& remedy) const {
    throw InputError({.file = file_, .line = line, .path = "", .value = value, .rule = rule, .remedy = remedy});
  }

  std::string_view bytes_;
  const std::string& file_;
  std::string xml_;  ///< the file without its appended data
  pugi::xml_document document_;
  VtuCoding coding_;
  std::vector<double> coordinates_;
};

}  // namespace

solid::Mesh parse_vtu(std::string_view bytes, const std::string& file) { return Vtu(bytes, file).read(); }

}  // namespace sinew::io
