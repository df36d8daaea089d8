#include "sinew/live/export_page.hpp"

#include <zlib.h>

#include <algorithm>
#include <cstdint>
#include <stdexcept>

#include "sinew/error/input_error.hpp"
#include "sinew/live/page.hpp"

namespace sinew::live {

namespace {

std::string compressed(const std::string& bytes) {
  z_stream stream{};
  constexpr int kGzip = 16 + MAX_WBITS;
  if (deflateInit2(&stream, 6, Z_DEFLATED, kGzip, 8, Z_DEFAULT_STRATEGY) != Z_OK)
    throw std::runtime_error("the run cannot be compressed");
  std::string out;
  std::string room(1 << 16, '\0');
  std::size_t at = 0;
  int status = Z_OK;
  do {  // zlib counts in 32 bits
    const std::size_t part = std::min<std::size_t>(bytes.size() - at, 1U << 30);
    stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(bytes.data() + at));
    stream.avail_in = static_cast<uInt>(part);
    at += part;
    do {
      stream.next_out = reinterpret_cast<Bytef*>(room.data());
      stream.avail_out = static_cast<uInt>(room.size());
      status = deflate(&stream, at == bytes.size() ? Z_FINISH : Z_NO_FLUSH);
      out.append(room, 0, room.size() - stream.avail_out);
    } while (stream.avail_out == 0);
  } while (status != Z_STREAM_END);
  deflateEnd(&stream);
  return out;
}

std::string base64(const std::string& bytes) {
  static const char* const kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    std::uint32_t group = 0;
    for (std::size_t k = 0; k < 3; ++k)
      group = group << 8 | (i + k < bytes.size() ? static_cast<unsigned char>(bytes[i + k]) : 0U);
    for (std::size_t k = 0; k < 4; ++k) text += i + k <= bytes.size() ? kDigits[group >> (18 - 6 * k) & 63U] : '=';
  }
  return text;
}

/// Browsers hold so much of a run, compressed into one text and unpacked again.
constexpr std::size_t kMost = 1U << 30;

void append(std::string& all, const std::string& message) {
  if (all.size() + message.size() > kMost)
    throw InputError({.path = "--frames",
                      .rule = "the run is too large for a page: its frames have more than 1 GiB",
                      .remedy = "ask for fewer of them, as in --frames 100"});
  const auto size = static_cast<std::uint32_t>(message.size());
  all.append(reinterpret_cast<const char*>(&size), 4);
  all += message;
}

}  // namespace

std::string standalone_page(Replay& replay, int frames) {
  std::string all;
  append(all, replay.scene());
  const long last = replay.frames() - 1, count = std::clamp<long>(frames, 1, replay.frames());
  Wishes wishes;
  wishes.show = everything();
  for (long i = 0; i < count; ++i)
    append(all, replay.frame(count == 1 ? last : (i * last + (count - 1) / 2) / (count - 1), wishes));
  const std::string& html = page();
  const std::string place = "<!--run-->";
  const std::size_t at = html.find(place);
  if (at == std::string::npos) throw std::runtime_error("the page has no place for a run");
  return html.substr(0, at) + "<script id=\"run\" type=\"text/plain\">" + base64(compressed(all)) + "</script>" +
         html.substr(at + place.size());
}

}  // namespace sinew::live
