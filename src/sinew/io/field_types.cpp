// The leaves: numbers, words, text, names of other objects.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <cmath>

#include "sinew/error/input_error.hpp"
#include "sinew/io/fields.hpp"
#include "sinew/io/nearest.hpp"

namespace sinew::io {
namespace {

/// "length" or "line_density", the name of its definition.
std::string word_for(Dimension dimension) {
  const std::string_view full = name(dimension);
  std::string word(full.substr(full.find(' ') + 1));
  std::replace(word.begin(), word.end(), ' ', '_');
  return word;
}

std::string with_unit(double value, Dimension dimension) {
  const std::string_view unit = value == 0.0 && dimension == Dimension::number ? "" : si_unit(dimension);
  return unit.empty() ? fmt::format("{}", value) : fmt::format("{} {}", value, unit);
}

}  // namespace

Type<double> quantity(Dimension dimension, Range range) {
  const auto read = [=](const At& at) {
    if (!at.is(Node::Kind::scalar)) at.refuse(fmt::format("must be {}", name(dimension)));
    double value = 0.0;
    try {
      value = parse_quantity(at.node().text, dimension);
    } catch (const InputError& error) {
      at.refuse(error.fault().rule, error.fault().remedy);
    }
    if (value < range.lower || (range.above && value == range.lower)) {
      at.refuse(fmt::format("must be {} {}{}", range.above ? "greater than" : "at least",
                            with_unit(range.lower, dimension), range.where));
    }
    if (value > range.upper || (range.below && value == range.upper)) {
      at.refuse(fmt::format("must be {} {}{}", range.below ? "below" : "at most", with_unit(range.upper, dimension),
                            range.where),
                range.remedy);
    }
    return value;
  };
  const auto schema = [=] {
    Json json = {{"$ref", "#/$defs/" + word_for(dimension)}};
    if (std::isfinite(range.lower)) json[range.above ? "exclusiveMinimum" : "minimum"] = range.lower;
    if (std::isfinite(range.upper)) json[range.below ? "exclusiveMaximum" : "maximum"] = range.upper;
    return json;
  };
  return {read, schema, [](const double& value) { return Json(value); }};
}

Json quantity_definitions() {
  Json json = Json::object();
  for (const Dimension dimension : all_dimensions) {
    const auto accepted = units(dimension);
    json[word_for(dimension)] = {
        {"description", accepted.empty() ? std::string("a plain number")
                                         : fmt::format("{}: a number in {}, or text with one of the units {}",
                                                       name(dimension), si_unit(dimension), fmt::join(accepted, ", "))},
        {"type", {"number", "string"}},
        {"pattern", quantity_pattern(dimension)}};
  }
  return json;
}

Type<int> whole_number(int lower, int upper) {
  const auto read = [=](const At& at) {
    const std::string& digits = at.node().text;
    int value = 0;
    const auto [end, status] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
    const bool whole = at.is(Node::Kind::scalar) && end == digits.data() + digits.size() && !digits.empty() &&
                       status != std::errc::invalid_argument;
    if (!whole) at.refuse("must be a whole number");
    if (status != std::errc{}) value = digits[0] == '-' ? std::numeric_limits<int>::min() : upper;
    if (value < lower) at.refuse(fmt::format("must be at least {}", lower));
    if (value > upper || status != std::errc{}) at.refuse(fmt::format("must be at most {}", upper));
    return value;
  };
  return {read,
          [=] {
            return Json{{"type", "integer"}, {"minimum", lower}, {"maximum", upper}};
          },
          [](const int& value) { return Json(value); }};
}

Type<std::string> text() {
  const auto read = [](const At& at) {
    if (!at.is(Node::Kind::scalar) || at.node().text.empty()) at.refuse("must be text");
    const std::string& characters = at.node().text;
    if (std::any_of(characters.begin(), characters.end(), [](char c) { return c >= 0 && c < ' ' && c != '\n'; })) {
      at.refuse("must be text without control characters");
    }
    return characters;
  };
  return {read, [] { return Json{{"type", "string"}, {"minLength", 1}}; }};
}

Type<bool> boolean() {
  const auto read = [](const At& at) {
    const bool yes = at.node().text == "true";
    if (!at.is(Node::Kind::scalar) || (!yes && at.node().text != "false")) at.refuse("must be true or false");
    return yes;
  };
  return {read, [] { return Json{{"type", "boolean"}}; }, [](const bool& value) { return Json(value); }};
}

Type<std::string> name_of(std::string what) {
  const Type<std::string> any = text();
  std::string all = what;
  if (all.ends_with('y')) {
    all.pop_back();
    all += "ie";
  }
  all += 's';
  const auto read = [=](const At& at) {
    std::string name = any.read(at);
    const std::vector<std::string> known = at.names_in(all);
    if (std::find(known.begin(), known.end(), name) != known.end()) return name;
    constexpr std::size_t shown = 12;
    const std::vector<std::string> first(known.begin(), known.begin() + std::min(known.size(), shown));
    const std::string near = nearest(name, known);
    at.refuse(fmt::format("is not a {} of this scene", what),
              (near.empty() ? "" : fmt::format("did you mean `{}`? ", near)) +
                  (known.empty() ? fmt::format("the scene has no {}; describe it under `{}:`", all, all)
                                 : fmt::format("the {} are {}{}", all, fmt::join(first, ", "),
                                               known.size() > shown ? ", ..." : "")));
  };
  return {read, any.schema};
}

Type<int> word(std::vector<std::string> words) {
  const auto read = [=](const At& at) {
    const auto found = std::find(words.begin(), words.end(), at.node().text);
    if (at.is(Node::Kind::scalar) && found != words.end()) return static_cast<int>(found - words.begin());
    const std::string near = at.is(Node::Kind::scalar) ? nearest(at.node().text, words) : "";
    at.refuse(words.size() == 1 ? "must be " + words[0] : fmt::format("must be one of {}", fmt::join(words, ", ")),
              near.empty() ? "" : fmt::format("did you mean `{}`?", near));
  };
  return {read,
          [=] {
            return Json{{"enum", words}};
          },
          [=](const int& value) { return Json(words[static_cast<std::size_t>(value)]); }};
}

Type<std::vector<int>> distinct_words(std::string what, std::vector<std::string> words, Count count) {
  const Type<int> one = word(std::move(words));
  const Type<std::vector<int>> several =
      list<int>(std::move(what), one, count, [](const std::vector<int>& values, const At& at) {
        for (std::size_t i = 0; i < values.size(); ++i) {
          if (std::count(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(i), values[i]) > 0) {
            at.item(i).refuse("is listed twice", "keep one of them");
          }
        }
      });
  const auto read = [=](const At& at) {
    std::vector<int> values = several.read(at);
    std::sort(values.begin(), values.end());
    return values;
  };
  const auto schema = [=] {
    Json json = several.schema();
    json["uniqueItems"] = true;
    return json;
  };
  const auto show = [=](const std::vector<int>& values) {
    Json json = Json::array();
    for (const int value : values) json.push_back(one.show(value));
    return json;
  };
  return {read, schema, show};
}

}  // namespace sinew::io
