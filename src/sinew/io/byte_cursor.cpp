#include "sinew/io/byte_cursor.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstring>
#include <limits>
#include <system_error>
#include <type_traits>
#include <utility>

#include "sinew/error/input_error.hpp"

namespace sinew::io {
namespace {

bool is_space(char c) { return c == ' ' || c == '\n' || c == '\r' || c == '\t' || c == '\f' || c == '\v'; }

constexpr const char* cut_short = "the file is cut short or a count in it is wrong: write the mesh again";

template <class T>
T decode(std::string_view bytes, std::endian order) {
  std::array<char, sizeof(T)> raw{};
  std::memcpy(raw.data(), bytes.data(), sizeof(T));
  if (order != std::endian::native) std::reverse(raw.begin(), raw.end());
  return std::bit_cast<T>(raw);
}

/// Calls `use` with the number that `bytes` hold, in its own type.
template <class Use>
auto with_number(std::string_view bytes, NumberType type, std::endian order, Use use) {
  switch (type) {
    case NumberType::i8:
      return use(decode<std::int8_t>(bytes, order));
    case NumberType::u8:
      return use(decode<std::uint8_t>(bytes, order));
    case NumberType::i16:
      return use(decode<std::int16_t>(bytes, order));
    case NumberType::u16:
      return use(decode<std::uint16_t>(bytes, order));
    case NumberType::i32:
      return use(decode<std::int32_t>(bytes, order));
    case NumberType::u32:
      return use(decode<std::uint32_t>(bytes, order));
    case NumberType::i64:
      return use(decode<std::int64_t>(bytes, order));
    case NumberType::u64:
      return use(decode<std::uint64_t>(bytes, order));
    case NumberType::f32:
      return use(decode<float>(bytes, order));
    case NumberType::f64:
      break;
  }
  return use(decode<double>(bytes, order));
}

template <class T>
bool parse(std::string_view word, T& value) {
  if (!word.empty() && word.front() == '+') word.remove_prefix(1);
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  return error == std::errc() && end == word.data() + word.size();
}

}  // namespace

std::size_t size_of(NumberType type) {
  constexpr std::array<std::size_t, 10> sizes = {1, 1, 2, 2, 4, 4, 8, 8, 4, 8};
  return sizes[static_cast<std::size_t>(type)];
}

bool is_integer(NumberType type) { return type != NumberType::f32 && type != NumberType::f64; }

ByteCursor::ByteCursor(std::string_view bytes, std::string file, int first_line)
    : bytes_(bytes), file_(std::move(file)), line_(first_line) {}

void ByteCursor::fix_line(int line) {
  line_ = line;
  counting_lines_ = false;
}

bool ByteCursor::done() { return peek().empty(); }

std::string_view ByteCursor::peek() {
  while (position_ < bytes_.size() && is_space(bytes_[position_])) ++position_;
  std::size_t end = position_;
  while (end < bytes_.size() && !is_space(bytes_[end])) ++end;
  return bytes_.substr(position_, end - position_);
}

std::string_view ByteCursor::word(std::string_view what) {
  const std::string_view next = peek();
  mark_ = position_;
  if (next.empty()) fail("end of file", fmt::format("{} must follow", what), cut_short);
  position_ += next.size();
  return next;
}

std::string_view ByteCursor::line() {
  mark_ = position_;
  const std::size_t end = std::min(bytes_.find('\n', position_), bytes_.size());
  std::string_view text = bytes_.substr(position_, end - position_);
  position_ = std::min(end + 1, bytes_.size());
  if (!text.empty() && text.back() == '\r') text.remove_suffix(1);
  return text;
}

std::string_view ByteCursor::take(std::size_t count, std::string_view what) {
  mark_ = position_;
  if (count > remaining()) {
    fail(fmt::format("{} bytes left", remaining()), fmt::format("{} bytes of {} must follow", count, what), cut_short);
  }
  position_ += count;
  return bytes_.substr(mark_, count);
}

bool ByteCursor::skip_past(std::string_view mark) {
  const std::size_t found = bytes_.find(mark, position_);
  if (found == std::string_view::npos) return false;
  position_ = found + mark.size();
  return true;
}

double ByteCursor::real(NumberType type, Encoding encoding, std::string_view what) {
  if (!encoding.text) {
    const auto as_double = [](auto number) { return static_cast<double>(number); };
    return with_number(take(size_of(type), what), type, encoding.order, as_double);
  }
  const std::string_view text = word(what);
  double value = 0.0;
  if (!parse(text, value)) {
    fail(in_quotes(text), fmt::format("{} must be a number in the range of double precision", what),
         "write it in decimal digits, for example 12.5 or 1.25e1");
  }
  if (!std::isfinite(value)) {
    fail(in_quotes(text), fmt::format("{} must be finite", what),
         "find out in the program that wrote the mesh where it "
         "comes from");
  }
  return value;
}

std::int64_t ByteCursor::integer(NumberType type, Encoding encoding, std::string_view what) {
  if (!encoding.text) {
    const auto as_integer = [](auto number) {
      return std::is_integral_v<decltype(number)> ? static_cast<std::int64_t>(number) : std::int64_t{-1};
    };
    return with_number(take(size_of(type), what), type, encoding.order, as_integer);
  }
  const std::string_view text = word(what);
  std::int64_t value = 0;
  if (!parse(text, value)) {
    fail(in_quotes(text), fmt::format("{} must be a whole number", what), "write it in decimal digits, for example 12");
  }
  return value;
}

std::size_t ByteCursor::count(std::string_view what) {
  const std::int64_t value = integer(NumberType::i64, Encoding{}, what);
  if (value < 0) fail(std::to_string(value), fmt::format("{} must be 0 or more", what), cut_short);
  return static_cast<std::size_t>(value);
}

void ByteCursor::require(std::size_t count, NumberType type, Encoding encoding, std::string_view what) const {
  // In text a number takes a digit and a space, the last one only the digit.
  const std::size_t room = encoding.text ? remaining() / 2 + 1 : remaining() / size_of(type);
  if (count > room) {
    fail(std::to_string(count),
         fmt::format("so many numbers ({}) do not fit into the {} bytes left in the file", what, remaining()),
         cut_short);
  }
  if (count > static_cast<std::size_t>(std::numeric_limits<int>::max())) {
    fail(std::to_string(count),
         fmt::format("at most {} numbers ({}) can be read", std::numeric_limits<int>::max(), what),
         "use a coarser mesh");
  }
}

std::vector<std::int64_t> ByteCursor::integers(std::size_t count, NumberType type, Encoding encoding,
                                               std::string_view what) {
  require(count, type, encoding, what);
  std::vector<std::int64_t> values;
  values.reserve(count);
  for (std::size_t i = 0; i < count; ++i) values.push_back(integer(type, encoding, what));
  return values;
}

void ByteCursor::skip(std::size_t count, NumberType type, Encoding encoding, std::string_view what) {
  require(count, type, encoding, what);
  if (!encoding.text) {
    take(count * size_of(type), what);
    return;
  }
  for (std::size_t i = 0; i < count; ++i) word(what);
}

void ByteCursor::fail(const std::string& value, const std::string& rule, const std::string& remedy) const {
  fail_at(mark_, value, rule, remedy);
}

void ByteCursor::fail_at(std::size_t position, const std::string& value, const std::string& rule,
                         const std::string& remedy) const {
  int line = line_;
  if (counting_lines_) {
    const std::string_view before = bytes_.substr(0, position);
    line += static_cast<int>(std::count(before.begin(), before.end(), '\n'));
  }
  throw InputError({.file = file_, .line = line, .path = "", .value = value, .rule = rule, .remedy = remedy});
}

std::string in_quotes(std::string_view text) {
  constexpr std::size_t longest = 40;
  std::string result = "\"";
  for (const char c : text.substr(0, longest)) result += c >= ' ' && c <= '~' ? c : '?';
  result += text.size() > longest ? "...\"" : "\"";
  return result;
}

bool equal_ignoring_case(std::string_view a, std::string_view b) {
  const auto upper = [](char c) { return c >= 'a' && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c; };
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [&](char x, char y) { return upper(x) == upper(y); });
}

}  // namespace sinew::io
