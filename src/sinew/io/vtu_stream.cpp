#include "sinew/io/vtu_stream.hpp"

#include <fmt/format.h>
#include <zlib.h>

#include <array>
#include <utility>
#include <vector>

namespace sinew::io {
namespace {

constexpr const char* write_again = "the file is damaged: write the mesh again";

bool is_space(char c) { return c == ' ' || c == '\n' || c == '\r' || c == '\t'; }

/// Value of a base64 digit, -1 if it is none.
int digit(char c) {
  if (c >= 'A' && c <= 'Z') return c - 'A';
  if (c >= 'a' && c <= 'z') return c - 'a' + 26;
  if (c >= '0' && c <= '9') return c - '0' + 52;
  return c == '+' ? 62 : c == '/' ? 63 : -1;
}

std::vector<std::int64_t> header_words(VtuStream& stream, std::size_t count, NumberType type, std::endian order) {
  const std::string bytes = stream.take(count * size_of(type), "the header of an array");
  return ByteCursor(bytes, "").integers(count, type, {.text = false, .order = order}, "header");
}

void inflate_block(VtuStream& stream, std::size_t packed, std::size_t full, std::string& result) {
  const std::string block = stream.take(packed, "a compressed block");
  const std::size_t begin = result.size();
  result.resize(begin + full);
  uLongf length = full;
  auto* target = reinterpret_cast<Bytef*>(result.data() + begin);
  const auto* source = reinterpret_cast<const Bytef*>(block.data());
  if (uncompress(target, &length, source, packed) != Z_OK || length != full) {
    stream.cursor().fail(fmt::format("block of {} bytes", packed),
                         fmt::format("a compressed block must inflate by zlib to {} bytes", full), write_again);
  }
}

}  // namespace

std::string VtuStream::take(std::size_t count, std::string_view what) {
  if (!base64_) return std::string(cursor_.take(count, what));
  if (count > remaining()) {
    cursor_.fail(fmt::format("at most {} bytes left", remaining()),
                 fmt::format("{} bytes of {} must follow", count, what), write_again);
  }
  std::string result = std::exchange(decoded_, {});
  result.reserve(count + 2);
  while (result.size() < count) {
    decode_four(what);
    result += decoded_;
  }
  decoded_ = result.substr(count);
  result.resize(count);
  return result;
}

std::size_t VtuStream::remaining() const {
  return base64_ ? decoded_.size() + cursor_.remaining() / 4 * 3 : cursor_.remaining();
}

void VtuStream::decode_four(std::string_view what) {
  std::array<int, 4> digits{};
  int padding = 0;
  for (int& value : digits) {
    char c = ' ';
    while (is_space(c)) c = cursor_.take(1, what)[0];
    value = digit(c);
    if (c == '=') {
      ++padding;
      value = 0;
    }
    if (value < 0 || (c != '=' && padding > 0) || padding > 2) {
      cursor_.fail(in_quotes(std::string_view(&c, 1)), "must be a digit of base64 (A-Z a-z 0-9 + / and = at the end)",
                   write_again);
    }
  }
  const int bits = digits[0] << 18 | digits[1] << 12 | digits[2] << 6 | digits[3];
  const std::array<char, 3> bytes = {static_cast<char>(bits >> 16 & 255), static_cast<char>(bits >> 8 & 255),
                                     static_cast<char>(bits & 255)};
  decoded_.assign(bytes.data(), static_cast<std::size_t>(3 - padding));
}

std::string read_plain(VtuStream& stream, NumberType header, std::endian order, std::size_t size) {
  const std::int64_t bytes = header_words(stream, 1, header, order)[0];
  if (bytes != static_cast<std::int64_t>(size)) {
    stream.cursor().fail(fmt::format("{} bytes", bytes), fmt::format("the array must have {} bytes", size),
                         "the counts of the piece do not fit the data (or byte_order or header_type is wrong): write "
                         "the mesh again");
  }
  return stream.take(size, "an array");
}

std::string read_zlib(VtuStream& stream, NumberType header, std::endian order, std::size_t size) {
  const std::int64_t blocks = header_words(stream, 1, header, order)[0];
  if (blocks < 0 || static_cast<std::size_t>(blocks) > stream.remaining() / size_of(header)) {
    stream.cursor().fail(fmt::format("{} blocks", blocks), "the compressed blocks must fit into the file", write_again);
  }
  const auto count = static_cast<std::size_t>(blocks);
  const std::vector<std::int64_t> sizes = header_words(stream, count + 2, header, order);
  const std::int64_t last = sizes[1] == 0 ? sizes[0] : sizes[1];
  std::string result;
  for (std::size_t i = 0; i < count; ++i) {
    const auto full = static_cast<std::size_t>(i + 1 < count ? sizes[0] : last);
    const auto packed = static_cast<std::size_t>(sizes[i + 2]);  // negative is huge, which no file holds
    constexpr std::size_t best = 1032;                           // zlib packs no more than that many bytes into one
    if (full > size - result.size() || packed > stream.remaining() || full / best > packed) {
      stream.cursor().fail(fmt::format("block of {} bytes from {}", full, packed),
                           fmt::format("the compressed blocks must come to {} bytes", size),
                           "the counts of the piece do not fit the data (or byte_order or header_type is wrong): write "
                           "the mesh again");
    }
    inflate_block(stream, packed, full, result);
  }
  if (result.size() != size) {
    stream.cursor().fail(fmt::format("{} bytes", result.size()), fmt::format("the array must have {} bytes", size),
                         "the counts of the piece do not fit the data: write the mesh again");
  }
  return result;
}

}  // namespace sinew::io
