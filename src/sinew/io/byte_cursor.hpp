// Bounded reading of a file that lies in memory: words, lines, and numbers as text or as bytes. Nothing here reads past
// the end, and every fault is an InputError that names the file and, in text, the line.
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace sinew::io {

enum class NumberType { i8, u8, i16, u16, i32, u32, i64, u64, f32, f64 };
std::size_t size_of(NumberType type);
bool is_integer(NumberType type);

/// How numbers stand in a file: words, or bytes in this order.
struct Encoding {
  bool text = true;
  std::endian order = std::endian::little;
};

class ByteCursor {
 public:
  /// `bytes` must outlive the cursor; `first_line` is the number of their first line in the file.
  ByteCursor(std::string_view bytes, std::string file, int first_line = 1);

  /// From here on faults name this line: 0 in the binary part of a file, or the line that announced the bytes.
  void fix_line(int line);

  std::size_t position() const { return position_; }
  std::size_t last() const { return mark_; }  ///< where the word or bytes read last begin
  std::size_t remaining() const { return bytes_.size() - position_; }

  /// Whether only white space is left.
  bool done();

  /// The next word; `what` names it in the message if there is none.
  std::string_view word(std::string_view what);

  /// The next word, not taken; empty at the end.
  std::string_view peek();

  /// What is left of this line, without its end; the cursor goes to the next line.
  std::string_view line();

  /// The next `count` bytes.
  std::string_view take(std::size_t count, std::string_view what);

  /// Skips beyond the next occurrence of `mark`; false, and nothing skipped, if there is none.
  bool skip_past(std::string_view mark);

  /// One number. In text `type` tells integers only from reals; a real in text must be finite. Unsigned 64-bit numbers
  /// beyond the range come out negative.
  double real(NumberType type, Encoding encoding, std::string_view what);
  std::int64_t integer(NumberType type, Encoding encoding, std::string_view what);

  /// A count in text, >= 0.
  std::size_t count(std::string_view what);

  /// Call before allocating: that the bytes left can hold `count` numbers of this type, and `int` can count them.
  void require(std::size_t count, NumberType type, Encoding encoding, std::string_view what) const;

  /// All at once: `require`, then `count` numbers.
  std::vector<std::int64_t> integers(std::size_t count, NumberType type, Encoding encoding, std::string_view what);

  /// Skips numbers without looking at them.
  void skip(std::size_t count, NumberType type, Encoding encoding, std::string_view what);

  /// A fault at the word or bytes read last, or at a position met before.
  [[noreturn]] void fail(const std::string& value, const std::string& rule, const std::string& remedy) const;
  [[noreturn]] void fail_at(std::size_t position, const std::string& value, const std::string& rule,
                            const std::string& remedy) const;

 private:
  std::string_view bytes_;
  std::string file_;
  int line_;
  bool counting_lines_ = true;
  std::size_t position_ = 0;
  std::size_t mark_ = 0;
};

/// A piece of a file for a message: quoted, without control characters, cut to a readable length.
std::string in_quotes(std::string_view text);

bool equal_ignoring_case(std::string_view a, std::string_view b);

}  // namespace sinew::io
