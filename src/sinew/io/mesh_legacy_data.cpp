#include "sinew/io/mesh_legacy_data.hpp"

#include <fmt/format.h>

#include <array>
#include <cstddef>
#include <string>
#include <utility>

namespace sinew::io {
namespace {

class LegacyData {
 public:
  LegacyData(ByteCursor& cursor, Encoding encoding, VtkCells& cells)
      : cursor_(cursor), encoding_(encoding), cells_(cells) {}

  void read() {
    while (!cursor_.done() && read_section()) continue;
  }

 private:
  /// False at what it does not know.
  bool read_section() {
    const std::string_view keyword = cursor_.word("a section");
    const auto is = [keyword](std::string_view name) { return equal_ignoring_case(keyword, name); };
    if (is("POINT_DATA") || is("CELL_DATA")) {
      of_cells_ = is("CELL_DATA");
      tuples_ = cursor_.count("the number of values");
      cursor_.require(tuples_, NumberType::u8, encoding_, "values");
      return true;
    }
    if (is("METADATA")) {
      skip_metadata(cursor_);
      return true;
    }
    if (is("SCALARS")) return read_scalars();
    if (is("FIELD")) return read_field();
    if (is("COLOR_SCALARS") || is("LOOKUP_TABLE")) return skip_colors(is("LOOKUP_TABLE"));
    if (is("VECTORS") || is("NORMALS")) return read_named(3);
    if (is("TENSORS")) return read_named(9);
    if (is("TENSORS6")) return read_named(6);
    if (is("GLOBAL_IDS") || is("PEDIGREE_IDS")) return read_named(1);
    if (is("TEXTURE_COORDINATES")) {
      cursor_.word("the name of an array");
      return read_typed("", cursor_.count("the number of components"), tuples_);
    }
    return false;
  }

  bool read_named(std::size_t components) {
    const std::string_view name = cursor_.word("the name of an array");
    return read_typed(name, components, tuples_);
  }

  bool read_typed(std::string_view name, std::size_t components, std::size_t tuples) {
    const std::optional<NumberType> type = read_type();
    cursor_.line();
    if (type) read_array(name, *type, components, tuples);
    return type.has_value();
  }

  std::optional<NumberType> read_type() {
    const std::optional<NumberType> type = legacy_number_type(cursor_.word("the type of the numbers"));
    place_ = cursor_.last();
    return type;
  }

  bool read_scalars() {
    const std::string_view name = cursor_.word("the name of an array");
    const std::optional<NumberType> type = read_type();
    const std::string_view rest = cursor_.line();
    const std::size_t digit = rest.find_first_not_of(" \t");
    const char components = digit == std::string_view::npos ? '1' : rest[digit];
    if (!type || components < '1' || components > '4') return false;
    if (equal_ignoring_case(cursor_.peek(), "LOOKUP_TABLE")) {
      cursor_.line();
    } else if (!encoding_.text) {
      return false;  // bytes that look like blanks may be lost already
    }
    read_array(name, *type, static_cast<std::size_t>(components - '0'), tuples_);
    return true;
  }

  bool read_field() {
    cursor_.word("the name of the field");
    const std::size_t arrays = cursor_.count("the number of arrays");
    for (std::size_t i = 0; i < arrays; ++i) {
      if (equal_ignoring_case(cursor_.peek(), "METADATA")) {
        cursor_.word("METADATA");
        skip_metadata(cursor_);
      }
      const std::string_view name = cursor_.word("the name of an array");
      const std::size_t components = cursor_.count("the number of components");
      if (!read_typed(name, components, cursor_.count("the number of tuples"))) return false;
    }
    return true;
  }

  /// Colours are reals in text, and bytes otherwise.
  bool skip_colors(bool table) {
    cursor_.word("the name of an array");
    const std::size_t count = cursor_.count(table ? "the number of colours" : "the number of components");
    cursor_.line();
    read_array("", NumberType::u8, table ? 4 : count, table ? count : tuples_);
    return true;
  }

  void read_array(std::string_view name, NumberType type, std::size_t components, std::size_t tuples) {
    cursor_.require(components, NumberType::u8, encoding_, "components");  // so that their product does not overflow
    cursor_.require(tuples, NumberType::u8, encoding_, "values");
    const std::optional<GroupArray> found = group_array(name);
    const bool groups = of_cells_ && found && components == 1 && is_integer(type);
    if (!groups || (cells_.grouped_by && *cells_.grouped_by <= *found)) {
      cursor_.skip(components * tuples, type, encoding_, "values");
      return;
    }
    if (tuples != cells_.types.size()) {
      cursor_.fail_at(place_, std::to_string(tuples),
                      fmt::format("{} must have a number for each of the {} cells", name, cells_.types.size()),
                      "the count is wrong: write the mesh again as legacy VTK");
    }
    cells_.grouped_by = found;
    cells_.groups = cursor_.integers(tuples, type, encoding_, "groups of cells");
  }

  ByteCursor& cursor_;
  Encoding encoding_;
  VtkCells& cells_;
  bool of_cells_ = false;
  std::size_t tuples_ = 0;  ///< points or cells
  std::size_t place_ = 0;   ///< of the array that is read
};

}  // namespace

std::optional<NumberType> legacy_number_type(std::string_view name) {
  using enum NumberType;
  static constexpr std::array<std::pair<std::string_view, NumberType>, 20> names = {
      {{"char", i8},           {"signed_char", i8},     {"unsigned_char", u8},
       {"short", i16},         {"unsigned_short", u16}, {"int", i32},
       {"unsigned_int", u32},  {"long", i64},           {"unsigned_long", u64},
       {"float", f32},         {"double", f64},         {"vtkIdType", i32},
       {"vtktypeint8", i8},    {"vtktypeuint8", u8},    {"vtktypeint16", i16},
       {"vtktypeuint16", u16}, {"vtktypeint32", i32},   {"vtktypeuint32", u32},
       {"vtktypeint64", i64},  {"vtktypeuint64", u64}}};
  for (const auto& [text, type] : names) {
    if (equal_ignoring_case(name, text)) return type;
  }
  return std::nullopt;
}

void skip_metadata(ByteCursor& cursor) {
  cursor.line();
  while (cursor.remaining() > 0 && !cursor.line().empty()) continue;
}

void read_groups(ByteCursor& cursor, Encoding encoding, VtkCells& cells) { LegacyData(cursor, encoding, cells).read(); }

}  // namespace sinew::io
