// Lines of an input file of Abaqus: keywords with parameters, and data separated by commas. Comments begin with **.
#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "sinew/io/byte_cursor.hpp"

namespace sinew::io {

/// "*ELEMENT, TYPE=C3D4, ELSET=arm": ELEMENT, and the values of its parameters, empty where they have none.
struct Keyword {
  std::string name;                               ///< in capitals, with single blanks
  std::map<std::string, std::string> parameters;  ///< names in capitals, values without quotes
  /// The value of a parameter; null if it is not there.
  const std::string* find(const std::string& parameter) const;
};

class AbaqusLines {
 public:
  /// `bytes` must outlive this.
  AbaqusLines(std::string_view bytes, const std::string& file) : cursor_(bytes, file) {}

  /// Goes to the next line that is neither a comment nor empty; false at the end.
  bool next();
  /// Goes to the next line if it is data; else the keyword that ends the block is the result of the next `next`.
  bool next_data();

  bool is_keyword() const { return text_.starts_with("*"); }
  /// The keyword of this line and of those it goes on in.
  Keyword keyword();
  std::string_view text() const { return text_; }   ///< of this line, without blanks around it
  std::size_t place() const { return place_; }      ///< where the line begins
  std::vector<std::string_view> fields() const;     ///< of this line; the last is empty if it ends with a comma
  int number(std::string_view field) const;         ///< of a node or element, 1 or more
  double coordinate(std::string_view field) const;  ///< finite; 1.5D0 as in Fortran is 1.5

  [[noreturn]] void fail(const std::string& value, const std::string& rule, const std::string& remedy) const {
    fail_at(place_, value, rule, remedy);
  }
  /// A fault of an earlier line, by its place.
  [[noreturn]] void fail_at(std::size_t place, const std::string& value, const std::string& rule,
                            const std::string& remedy) const {
    cursor_.fail_at(place, value, rule, remedy);
  }

 private:
  ByteCursor cursor_;
  std::string_view text_;
  std::size_t place_ = 0;
  bool again_ = false;  // the next line is this one
};

std::string in_capitals(std::string_view text);
std::string_view without_quotes(std::string_view text);
/// A number of a node or element in decimal digits, if it is nothing else.
std::optional<int> node_or_element_number(std::string_view text);

}  // namespace sinew::io
