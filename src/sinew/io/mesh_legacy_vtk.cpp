// Legacy VTK, https://docs.vtk.org/en/latest/vtk_file_formats/vtk_legacy_file_format.html. Cells come in two layouts:
// up to version 4 "n a b c ..." per cell, from 5 on two arrays, OFFSETS and CONNECTIVITY. Binary numbers are
// big-endian.
#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <utility>

#include "sinew/io/byte_cursor.hpp"
#include "sinew/io/mesh_cells.hpp"
#include "sinew/io/mesh_formats.hpp"
#include "sinew/io/mesh_legacy_data.hpp"
#include "sinew/io/vtk_cells.hpp"

namespace sinew::io {
namespace {

class LegacyVtk {
 public:
  LegacyVtk(std::string_view bytes, const std::string& file) : cursor_(bytes, file) {}

  solid::Mesh read() {
    read_header();
    while (!complete() && !cursor_.done()) {
      if (!read_section()) break;
    }
    require_complete();
    read_groups(cursor_, encoding_, cells_);
    solid::Mesh mesh;
    mesh.nodes = std::move(*nodes_);
    add_cells(cells_, 0, mesh.nodes.cols(), mesh,
              [this](std::size_t cell, const std::string& value, const std::string& rule, const std::string& remedy) {
                cursor_.fail_at(where_.empty() ? 0 : where_[cell], value, rule, remedy);
              });
    finish_cells(mesh);
    return mesh;
  }

 private:
  void read_header() {
    const std::string_view first = cursor_.line();
    constexpr std::string_view start = "# vtk DataFile Version ";
    const std::string_view version = first.substr(std::min(start.size(), first.size()));
    if (!first.starts_with(start) || version.empty() || version[0] < '2' || version[0] > '5') {
      cursor_.fail(in_quotes(first), "the first line must be \"# vtk DataFile Version x.y\" with x from 2 to 5",
                   "write the mesh as legacy VTK of such a version, for example 4.2");
    }
    major_ = version[0] - '0';
    cursor_.line();  // title
    const std::string_view coding = cursor_.word("ASCII or BINARY");
    encoding_ = {.text = equal_ignoring_case(coding, "ASCII"), .order = std::endian::big};
    if (!encoding_.text && !equal_ignoring_case(coding, "BINARY")) {
      cursor_.fail(in_quotes(coding), "the third line must be ASCII or BINARY", "write the mesh again as legacy VTK");
    }
    expect("DATASET");
    const std::string_view dataset = cursor_.word("the kind of the dataset");
    if (!equal_ignoring_case(dataset, "UNSTRUCTURED_GRID")) {
      cursor_.fail(in_quotes(dataset), "the dataset must be an UNSTRUCTURED_GRID",
                   "a surface or an image has no volume: mesh its volume first, for example with Gmsh");
    }
    if (!encoding_.text) cursor_.fix_line(0);
  }

  void expect(std::string_view keyword) {
    const std::string_view word = cursor_.word(keyword);
    if (!equal_ignoring_case(word, keyword)) {
      cursor_.fail(in_quotes(word), fmt::format("{} must stand here", keyword), "write the mesh again as legacy VTK");
    }
  }

  bool complete() const { return nodes_ && have_cells_ && have_types_; }

  void require_complete() {
    const char* missing = !nodes_ ? "POINTS" : !have_cells_ ? "CELLS" : !have_types_ ? "CELL_TYPES" : nullptr;
    if (missing != nullptr) {
      cursor_.fail("", fmt::format("the file must have a section {}", missing),
                   "the file is cut short: write the mesh again");
    }
    if (cells_.types.size() != cells_.ends.size()) {
      cursor_.fail(fmt::format("{} types of {} cells", cells_.types.size(), cells_.ends.size()),
                   "CELL_TYPES must have as many entries as CELLS", "write the mesh again as legacy VTK");
    }
  }

  /// One section; false at the data of points and cells, which come last.
  bool read_section() {
    const std::string_view keyword = cursor_.word("a section");
    const auto is = [keyword](std::string_view name) { return equal_ignoring_case(keyword, name); };
    if (is("POINT_DATA") || is("CELL_DATA")) return false;
    if (is("POINTS")) {
      read_points();
    } else if (is("CELLS")) {
      major_ < 5 ? read_counted_cells() : read_offset_cells();
    } else if (is("CELL_TYPES")) {
      read_types();
    } else if (is("METADATA")) {
      skip_metadata(cursor_);
    } else if (is("FIELD")) {
      skip_field();
    } else {
      cursor_.fail(in_quotes(keyword), "a section must begin with POINTS, CELLS, CELL_TYPES, FIELD or METADATA",
                   "a count before this place is wrong, or the file is damaged: write the mesh again");
    }
    return true;
  }

  NumberType number_type() {
    const std::string_view word = cursor_.word("the type of the numbers");
    const std::optional<NumberType> type = legacy_number_type(word);
    if (!type) {
      cursor_.fail(in_quotes(word),
                   "the type of the numbers must be one of float, double, int, long, vtktypeint64, ...",
                   "write the mesh again as legacy VTK");
    }
    return *type;
  }

  NumberType integer_type() {
    const NumberType type = number_type();
    if (!is_integer(type)) {
      cursor_.fail("float or double", "node numbers must be of an integer type", "write the mesh again as legacy VTK");
    }
    return type;
  }

  void read_points() {
    const std::size_t count = cursor_.count("the number of points");
    cursor_.require(count, NumberType::u8, encoding_, "points");  // so that 3 * count does not overflow
    const NumberType type = number_type();
    cursor_.line();
    cursor_.require(3 * count, type, encoding_, "coordinates");
    nodes_.emplace(3, static_cast<Eigen::Index>(count));
    for (double& x : nodes_->reshaped()) x = cursor_.real(type, encoding_, "a coordinate");
  }

  void read_counted_cells() {
    const std::size_t count = cursor_.count("the number of cells");
    const std::size_t size = cursor_.count("the size of the list of cells");
    const std::size_t place = cursor_.last();
    cursor_.line();
    cursor_.require(size, NumberType::i32, encoding_, "node numbers of cells");
    if (size < count) {
      cursor_.fail(std::to_string(size), fmt::format("the list of {} cells must have at least as many entries", count),
                   "write the mesh again as legacy VTK");
    }
    cells_ = {};
    where_.clear();
    cells_.ends.reserve(count);
    cells_.connectivity.reserve(size - count);
    std::size_t left = size;
    for (std::size_t cell = 0; cell < count; ++cell) left -= read_counted_cell(cell, left);
    if (left != 0) {
      cursor_.fail_at(place, std::to_string(size),
                      fmt::format("the list of cells must have {} entries, as its cells say", size - left),
                      "write the mesh again as legacy VTK");
    }
    have_cells_ = true;
  }

  /// Entries it took, at most `left`.
  std::size_t read_counted_cell(std::size_t cell, std::size_t left) {
    const std::int64_t nodes =
        left == 0 ? -1 : cursor_.integer(NumberType::i32, encoding_, "the number of nodes of a cell");
    if (nodes < 0 || static_cast<std::size_t>(nodes) >= left) {
      cursor_.fail(left == 0 ? "none left" : std::to_string(nodes),
                   fmt::format("the nodes of cell {} (0-based) must fit into the {} entries left of CELLS", cell, left),
                   "the counts after CELLS are wrong: write the mesh again");
    }
    if (encoding_.text) where_.push_back(cursor_.last());
    for (std::int64_t k = 0; k < nodes; ++k) {
      cells_.connectivity.push_back(cursor_.integer(NumberType::i32, encoding_, "a node number"));
    }
    cells_.ends.push_back(std::ssize(cells_.connectivity));
    return static_cast<std::size_t>(nodes) + 1;
  }

  void read_offset_cells() {
    const std::size_t offsets = cursor_.count("the number of offsets");
    const std::size_t size = cursor_.count("the number of node numbers");
    cells_ = {};
    where_.clear();
    have_cells_ = true;
    if (offsets == 0) return;
    expect("OFFSETS");
    const NumberType offset_type = integer_type();
    cursor_.line();
    cells_.ends = cursor_.integers(offsets, offset_type, encoding_, "offsets of cells");
    if (cells_.ends.front() != 0 || cells_.ends.back() != static_cast<std::int64_t>(size)) {
      cursor_.fail(fmt::format("{} to {}", cells_.ends.front(), cells_.ends.back()),
                   fmt::format("OFFSETS must go from 0 to {}, the number of node numbers", size),
                   "write the mesh again as legacy VTK");
    }
    cells_.ends.erase(cells_.ends.begin());
    expect("CONNECTIVITY");
    const NumberType type = integer_type();
    cursor_.line();
    cursor_.require(size, type, encoding_, "node numbers of cells");
    cells_.connectivity.reserve(size);
    std::vector<std::size_t> places;
    for (std::size_t i = 0; i < size; ++i) {
      cells_.connectivity.push_back(cursor_.integer(type, encoding_, "a node number"));
      places.push_back(cursor_.last());
    }
    if (!encoding_.text) return;
    std::size_t begin = 0;
    for (const std::int64_t end : cells_.ends) {
      where_.push_back(begin < size ? places[begin] : cursor_.last());
      begin = static_cast<std::size_t>(end);  // a wrong one may be huge, which is caught in add_cells
    }
  }

  void read_types() {
    const std::size_t count = cursor_.count("the number of cell types");
    cursor_.line();
    cells_.types = cursor_.integers(count, NumberType::i32, encoding_, "cell types");
    have_types_ = true;
  }

  void skip_field() {
    cursor_.word("the name of the field");
    const std::size_t arrays = cursor_.count("the number of arrays");
    for (std::size_t i = 0; i < arrays; ++i) {
      cursor_.word("the name of an array");
      const std::size_t components = cursor_.count("the number of components");
      const std::size_t tuples = cursor_.count("the number of tuples");
      cursor_.require(components, NumberType::u8, encoding_, "components");
      cursor_.require(tuples, NumberType::u8, encoding_, "tuples");
      const NumberType type = number_type();
      cursor_.line();
      cursor_.skip(components * tuples, type, encoding_, "field values");
    }
  }

  ByteCursor cursor_;
  Encoding encoding_;
  int major_ = 0;
  std::optional<Eigen::Matrix3Xd> nodes_;
  VtkCells cells_;
  std::vector<std::size_t> where_;  ///< per cell, its place in an ASCII file
  bool have_cells_ = false, have_types_ = false;
};

}  // namespace

solid::Mesh parse_legacy_vtk(std::string_view bytes, const std::string& file) { return LegacyVtk(bytes, file).read(); }

}  // namespace sinew::io
