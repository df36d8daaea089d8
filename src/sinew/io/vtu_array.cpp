#include "sinew/io/vtu_array.hpp"

#include <fmt/format.h>

#include <array>
#include <utility>

#include "sinew/error/input_error.hpp"
#include "sinew/io/vtu_stream.hpp"

namespace sinew::io {
namespace {

std::optional<NumberType> number_type(std::string_view name) {
  using enum NumberType;
  static constexpr std::array<std::pair<std::string_view, NumberType>, 10> names = {{{"Int8", i8},
                                                                                     {"UInt8", u8},
                                                                                     {"Int16", i16},
                                                                                     {"UInt16", u16},
                                                                                     {"Int32", i32},
                                                                                     {"UInt32", u32},
                                                                                     {"Int64", i64},
                                                                                     {"UInt64", u64},
                                                                                     {"Float32", f32},
                                                                                     {"Float64", f64}}};
  for (const auto& [text, type] : names) {
    if (text == name) return type;
  }
  return std::nullopt;
}

}  // namespace

VtuArray::VtuArray(const pugi::xml_node& element, const VtuCoding& coding, std::string file, int line, int text_line)
    : coding_(coding),
      file_(std::move(file)),
      line_(line),
      text_line_(text_line),
      name_(element.attribute("Name").as_string("DataArray")),
      type_(NumberType::f64),
      data_(element.child_value()) {
  const std::string type = element.attribute("type").as_string();
  const std::optional<NumberType> known = number_type(type);
  if (!known) {
    fail(in_quotes(type), "the type of a DataArray must be Int8, UInt8, ..., Int64, UInt64, Float32 or Float64",
         "write the mesh again as VTU");
  }
  type_ = *known;
  const std::string format = element.attribute("format").as_string("ascii");
  text_ = format == "ascii";
  base64_ = format == "binary" || (format == "appended" && coding.appended_base64);
  if (!text_ && !coding.compressor.empty() && coding.compressor != "vtkZLibDataCompressor") {
    fail(in_quotes(coding.compressor), "the compressor must be vtkZLibDataCompressor or none",
         "write the mesh with zlib compression or without compression");
  }
  if (format != "appended") {
    if (!text_ && !base64_) {
      fail(in_quotes(format), "the format of a DataArray must be ascii, binary or appended",
           "write the mesh again as VTU");
    }
    return;
  }
  const std::string offset_text = element.attribute("offset").as_string();
  const std::int64_t offset =
      ByteCursor(offset_text, file_, line_).integer(NumberType::i64, {}, "the offset of an array");
  if (!coding.appended || offset < 0 || static_cast<std::size_t>(offset) >= coding.appended->size()) {
    fail(fmt::format("offset {}", offset),
         fmt::format("{} must begin within the {} bytes of AppendedData", name_,
                     coding.appended.value_or(std::string_view()).size()),
         "the file is cut short: write the mesh again");
  }
  data_ = coding.appended->substr(static_cast<std::size_t>(offset));
}

void VtuArray::fail(const std::string& value, const std::string& rule, const std::string& remedy) const {
  throw InputError({.file = file_, .line = line_, .path = "", .value = value, .rule = rule, .remedy = remedy});
}

std::string VtuArray::bytes(std::size_t size) const {
  ByteCursor cursor(data_, file_);
  cursor.fix_line(line_);
  VtuStream stream(std::move(cursor), base64_);
  const auto decode = !coding_.compressor.empty() ? read_zlib : read_plain;
  return decode(stream, coding_.header, coding_.order, size);
}

template <class T, class Read>
std::vector<T> VtuArray::read(std::size_t count, Read number) const {
  const std::string decoded = text_ ? std::string() : bytes(count * size_of(type_));
  ByteCursor cursor(text_ ? data_ : std::string_view(decoded), file_, text_line_);
  if (!text_) cursor.fix_line(line_);
  const Encoding encoding = {.text = text_, .order = coding_.order};
  cursor.require(count, type_, encoding, name_);
  std::vector<T> values;
  values.reserve(count);
  for (std::size_t i = 0; i < count; ++i) values.push_back(number(cursor, encoding));
  if (text_ && !cursor.done()) {
    cursor.fail(in_quotes(cursor.word("")), fmt::format("{} must end after {} numbers", name_, count),
                "the counts of the piece do not fit the data: write the mesh again");
  }
  return values;
}

std::vector<double> VtuArray::reals(std::size_t count) const {
  const std::string what = fmt::format("a number of {}", name_);
  return read<double>(count, [&](ByteCursor& cursor, Encoding encoding) { return cursor.real(type_, encoding, what); });
}

std::vector<std::int64_t> VtuArray::integers(std::size_t count) const {
  if (!is_integer(type_)) {
    fail("Float32 or Float64", fmt::format("{} must be of an integer type", name_), "write the mesh again as VTU");
  }
  const std::string what = fmt::format("a number of {}", name_);
  return read<std::int64_t>(
      count, [&](ByteCursor& cursor, Encoding encoding) { return cursor.integer(type_, encoding, what); });
}

}  // namespace sinew::io
