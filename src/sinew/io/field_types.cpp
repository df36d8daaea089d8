// The leaves: numbers, words, text; and the rules between keys.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>

#include "sinew/error/input_error.hpp"
#include "sinew/io/fields.hpp"
#include "sinew/io/nearest.hpp"

namespace sinew::io {
namespace {

constexpr std::array<Dimension, 11> dimensions = {Dimension::number,       Dimension::length,   Dimension::mass,
                                                  Dimension::time,         Dimension::angle,    Dimension::force,
                                                  Dimension::torque,       Dimension::pressure, Dimension::density,
                                                  Dimension::acceleration, Dimension::rate};

/// "length", the name of its definition.
std::string word_for(Dimension dimension) {
  const std::string_view full = name(dimension);
  return std::string(full.substr(full.find(' ') + 1));
}

std::string with_unit(double value, Dimension dimension) {
  const std::string_view unit = value == 0.0 && dimension == Dimension::number ? "" : si_unit(dimension);
  return unit.empty() ? fmt::format("{}", value) : fmt::format("{} {}", value, unit);
}

bool says(const At& map, const std::string& key, const std::string& word) {
  return map.has(key) && map.child(key).is(Node::Kind::scalar) && map.child(key).node().text == word;
}

const Key& find(const std::vector<Key>& keys, const std::string& name) {
  return *std::find_if(keys.begin(), keys.end(), [&](const Key& key) { return key.name == name; });
}

/// Schema of an object in which `key` is given and says `word`.
Json says_schema(const std::string& key, const std::string& word) {
  return {{"properties", {{key, {{"const", word}}}}}, {"required", Json::array({key})}};
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
  for (const Dimension dimension : dimensions) {
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

Rule exactly_one(std::vector<std::string> keys) {
  Json schema;
  for (const std::string& key : keys) schema["oneOf"].push_back({{"required", Json::array({key})}});
  const auto check = [=](const At& at, const std::vector<Key>& all) {
    std::vector<std::string> given;
    std::copy_if(keys.begin(), keys.end(), std::back_inserter(given), [&](const std::string& k) { return at.has(k); });
    const std::string choice = fmt::format("{}", fmt::join(keys, ", "));
    if (given.empty())
      at.refuse_key(keys[0], fmt::format("is missing: exactly one of {} is needed", choice),
                    "add one: " + help(find(all, keys[0])));
    if (given.size() > 1) {
      at.refuse_key(given[1],
                    fmt::format("cannot be given together with {}: exactly one of {} is needed", given[0], choice),
                    fmt::format("remove one of {}", fmt::join(given, " and ")));
    }
  };
  return {check, schema};
}

Rule needs(std::string key, std::string other) {
  const auto check = [=](const At& at, const std::vector<Key>&) {
    if (at.has(key) && !at.has(other)) {
      at.refuse_key(key, fmt::format("is given without `{}`", other),
                    fmt::format("add `{}`, or remove `{}`", other, key));
    }
  };
  return {check, {{"dependentRequired", {{key, Json::array({other})}}}}};
}

Rule only_with(std::string key, std::string other, std::string word) {
  const auto check = [=](const At& at, const std::vector<Key>&) {
    if (at.has(key) && at.has(other) && !says(at, other, word)) {
      at.child(other).refuse(fmt::format("must be {} for {}", word, key),
                             fmt::format("write `{}: {}`, or leave it out", other, word));
    }
  };
  return {check, {{"dependentSchemas", {{key, {{"properties", {{other, {{"const", word}}}}}}}}}}};
}

Rule wanted_unless(std::string key, std::string word, std::vector<std::string> wanted) {
  const auto check = [=](const At& at, const std::vector<Key>& all) {
    if (says(at, key, word)) return;
    for (const std::string& one : wanted) {
      if (!at.has(one))
        at.refuse_key(one, "is missing", fmt::format("add it, or write `{}: {}`: {}", key, word, help(find(all, one))));
    }
  };
  return {check, {{"if", says_schema(key, word)}, {"else", {{"required", wanted}}}}};
}

}  // namespace sinew::io
