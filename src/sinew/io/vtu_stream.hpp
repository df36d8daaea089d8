// Bytes of a VTU array as they come out of the file: taken as they are or decoded from base64, then inflated.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

#include "sinew/io/byte_cursor.hpp"

namespace sinew::io {

/// Hands out the bytes behind raw or base64 text, never more than are there. Padding may stand inside the base64 text,
/// since writers encode the header and the data of a compressed array one after the other.
class VtuStream {
 public:
  VtuStream(ByteCursor cursor, bool base64) : cursor_(std::move(cursor)), base64_(base64) {}

  std::string take(std::size_t count, std::string_view what);

  /// An upper bound of the bytes that are left.
  std::size_t remaining() const;

  const ByteCursor& cursor() const { return cursor_; }

 private:
  void decode_four(std::string_view what);

  ByteCursor cursor_;
  bool base64_;
  std::string decoded_;  ///< up to three bytes not handed out yet
};

/// An array without compression: its byte count, then the bytes. They must be `size`.
std::string read_plain(VtuStream& stream, NumberType header, std::endian order, std::size_t size);

/// An array in zlib blocks: their number, their size, the size of the last (0: a full one), the compressed size of
/// each; then the blocks. They must inflate to `size` bytes.
std::string read_zlib(VtuStream& stream, NumberType header, std::endian order, std::size_t size);

}  // namespace sinew::io
