#include "sinew/io/abaqus_lines.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <utility>

namespace sinew::io {
namespace {

std::string_view without_blanks(std::string_view text) {
  constexpr std::string_view kBlanks = " \t\r\f\v";
  const std::size_t first = text.find_first_not_of(kBlanks);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(kBlanks) - first + 1);
}

std::vector<std::string_view> between_commas(std::string_view text) {
  std::vector<std::string_view> fields;
  while (true) {
    const std::size_t comma = text.find(',');
    fields.push_back(without_blanks(text.substr(0, comma)));
    if (comma == std::string_view::npos) return fields;
    text.remove_prefix(comma + 1);
  }
}

std::string keyword_name(std::string_view text) {
  std::string name;
  for (const char c : in_capitals(text)) {
    if (c != ' ' && c != '\t')
      name += c;
    else if (!name.empty() && name.back() != ' ')
      name += ' ';
  }
  return name;
}

}  // namespace

std::string in_capitals(std::string_view text) {
  std::string capitals(text);
  for (char& c : capitals)
    if (c >= 'a' && c <= 'z') c = static_cast<char>(c - 'a' + 'A');
  return capitals;
}

std::string_view without_quotes(std::string_view text) {
  return text.size() > 1 && text.front() == '"' && text.back() == '"' ? text.substr(1, text.size() - 2) : text;
}

std::optional<int> node_or_element_number(std::string_view text) {
  if (text.starts_with("+")) text.remove_prefix(1);
  int value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size() || value < 1) return std::nullopt;
  return value;
}

const std::string* Keyword::find(const std::string& parameter) const {
  const auto at = parameters.find(parameter);
  return at == parameters.end() ? nullptr : &at->second;
}

bool AbaqusLines::next() {
  if (std::exchange(again_, false)) return true;
  while (!cursor_.done()) {  // this leaves out empty lines, and blanks before the first word
    text_ = without_blanks(cursor_.line());
    place_ = cursor_.last();
    if (!text_.starts_with("**")) return true;
  }
  text_ = {};
  return false;
}

bool AbaqusLines::next_data() {
  if (!next()) return false;
  again_ = is_keyword();
  return !again_;
}

Keyword AbaqusLines::keyword() {
  std::vector<std::string_view> fields = between_commas(text_.substr(1));
  Keyword found = {keyword_name(fields.front()), {}};
  fields.erase(fields.begin());
  while (true) {
    for (const std::string_view field : fields) {
      const std::size_t equals = std::min(field.find('='), field.size());
      const std::string name = keyword_name(without_blanks(field.substr(0, equals)));
      if (!name.empty())
        found.parameters[name] = without_quotes(without_blanks(field.substr(std::min(equals + 1, field.size()))));
    }
    const bool goes_on = !fields.empty() && fields.back().empty();
    if (!goes_on || !next_data()) return found;
    fields = between_commas(text_);
  }
}

std::vector<std::string_view> AbaqusLines::fields() const { return between_commas(text_); }

int AbaqusLines::number(std::string_view field) const {
  const std::optional<int> value = node_or_element_number(field);
  if (!value)
    fail(in_quotes(field), "the number of a node or element must be a whole number from 1 to 2147483647",
         "write it in decimal digits, for example 12");
  return *value;
}

double AbaqusLines::coordinate(std::string_view field) const {
  std::string digits(field.substr(field.starts_with("+") ? 1 : 0));
  std::replace_if(
      digits.begin(), digits.end(), [](char c) { return c == 'd' || c == 'D'; }, 'e');
  const char* const last = digits.data() + digits.size();
  double value = 0.0;
  const auto [end, error] = std::from_chars(digits.data(), last, value);
  if (error != std::errc() || end != last || !std::isfinite(value))
    fail(in_quotes(field), "a coordinate must be a finite number",
         "write it in decimal digits, for example 12.5 or 1.25e1");
  return value;
}

}  // namespace sinew::io
