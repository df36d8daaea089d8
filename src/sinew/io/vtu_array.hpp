// The arrays of a VTU file: numbers as text, or bytes that are raw or base64, plain or zlib-compressed in blocks.
#pragma once

#include <cstddef>
#include <optional>
#include <pugixml.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "sinew/io/byte_cursor.hpp"

namespace sinew::io {

/// What the file says once for all of its arrays.
struct VtuCoding {
  std::endian order = std::endian::little;
  NumberType header = NumberType::u32;       ///< of the byte counts that stand before each array
  std::string compressor;                    ///< of arrays that are not text; empty: none
  std::optional<std::string_view> appended;  ///< what follows the underscore in AppendedData
  bool appended_base64 = false;
};

/// One DataArray element.
class VtuArray {
 public:
  /// `line` is where the element stands, `text_line` where its text begins.
  VtuArray(const pugi::xml_node& element, const VtuCoding& coding, std::string file, int line, int text_line);

  /// Its numbers; it must hold exactly `count`, which is checked before memory is taken.
  std::vector<double> reals(std::size_t count) const;
  std::vector<std::int64_t> integers(std::size_t count) const;

  /// A fault of this array.
  [[noreturn]] void fail(const std::string& value, const std::string& rule, const std::string& remedy) const;

 private:
  template <class T, class Read>
  std::vector<T> read(std::size_t count, Read number) const;

  /// The decoded bytes of an array that is not text; `size` is what they must come to.
  std::string bytes(std::size_t size) const;

  const VtuCoding& coding_;
  std::string file_;
  int line_, text_line_;
  std::string name_;
  NumberType type_;
  bool text_ = false;  ///< ascii
  bool base64_ = false;
  std::string_view data_;  ///< text, base64 or raw bytes; may go on beyond the array if it is appended
};

}  // namespace sinew::io
