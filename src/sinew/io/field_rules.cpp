// The rules between the keys of an object.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <iterator>

#include "sinew/io/fields.hpp"

namespace sinew::io {
namespace {

const Key& find(const std::vector<Key>& keys, const std::string& name) {
  return *std::find_if(keys.begin(), keys.end(), [&](const Key& key) { return key.name == name; });
}

std::vector<std::string> given(const At& at, const std::vector<std::string>& keys) {
  std::vector<std::string> found;
  std::copy_if(keys.begin(), keys.end(), std::back_inserter(found), [&](const std::string& k) { return at.has(k); });
  return found;
}

[[noreturn]] void refuse_missing(const At& at, const std::vector<Key>& all, const std::vector<std::string>& keys,
                                 const std::string& number) {
  at.refuse_key(keys[0], fmt::format("is missing: {} of {} is needed", number, fmt::join(keys, ", ")),
                "add one: " + help(find(all, keys[0])));
}

/// `number` and `may` stand before and after the list of all keys.
void refuse_second(const At& at, const std::vector<std::string>& keys, const std::string& number,
                   const std::string& may) {
  const std::vector<std::string> found = given(at, keys);
  if (found.size() < 2) return;
  at.refuse_key(
      found[1],
      fmt::format("cannot be given together with {}: {} of {} {}", found[0], number, fmt::join(keys, ", "), may),
      fmt::format("remove one of {}", fmt::join(found, " and ")));
}

}  // namespace

Json says_schema(const std::string& key, const std::string& word) {
  return {{"properties", {{key, {{"const", word}}}}}, {"required", Json::array({key})}};
}

Rule exactly_one(std::vector<std::string> keys) {
  Json schema;
  for (const std::string& key : keys) schema["oneOf"].push_back({{"required", Json::array({key})}});
  const auto check = [=](const At& at, const std::vector<Key>& all) {
    if (given(at, keys).empty()) refuse_missing(at, all, keys, "exactly one");
    refuse_second(at, keys, "exactly one", "is needed");
  };
  return {check, schema};
}

Rule at_least_one(std::vector<std::string> keys) {
  Json schema;
  for (const std::string& key : keys) schema["anyOf"].push_back({{"required", Json::array({key})}});
  const auto check = [=](const At& at, const std::vector<Key>& all) {
    if (given(at, keys).empty()) refuse_missing(at, all, keys, "at least one");
  };
  return {check, schema};
}

Rule at_most_one(std::vector<std::string> keys) {
  Json pairs = Json::array();
  for (std::size_t i = 0; i < keys.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) pairs.push_back({{"required", Json::array({keys[j], keys[i]})}});
  }
  const auto check = [=](const At& at, const std::vector<Key>&) {
    refuse_second(at, keys, "at most one", "may be given");
  };
  return {check, {{"not", {{"anyOf", pairs}}}}};
}

Rule excludes(std::string key, std::vector<std::string> others) {
  Json pairs = Json::array();
  for (const std::string& other : others) pairs.push_back({{"required", Json::array({key, other})}});
  const auto check = [=](const At& at, const std::vector<Key>&) {
    if (!at.has(key)) return;
    for (const std::string& other : given(at, others)) {
      at.refuse_key(other, fmt::format("cannot be given together with {}", key),
                    fmt::format("remove one of {} and {}", key, other));
    }
  };
  return {check, {{"not", {{"anyOf", pairs}}}}};
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
    if (at.has(key) && at.has(other) && !at.says(other, word)) {
      at.child(other).refuse(fmt::format("must be {} for {}", word, key),
                             fmt::format("write `{}: {}`, or leave it out", other, word));
    }
  };
  return {check, {{"dependentSchemas", {{key, {{"properties", {{other, {{"const", word}}}}}}}}}}};
}

Rule wanted_unless(std::string key, std::string word, std::vector<std::string> wanted) {
  Json one_of_them;
  for (const std::string& one : wanted) one_of_them["anyOf"].push_back({{"required", Json::array({one})}});
  const auto check = [=](const At& at, const std::vector<Key>& all) {
    if (at.says(key, word) || !given(at, wanted).empty()) return;
    std::string others;
    for (std::size_t i = 1; i < wanted.size(); ++i) others += fmt::format(", or `{}`", wanted[i]);
    at.refuse_key(wanted[0], "is missing",
                  fmt::format("add it{}, or write `{}: {}`: {}", others, key, word, help(find(all, wanted[0]))));
  };
  return {check, {{"if", says_schema(key, word)}, {"else", one_of_them}}};
}

}  // namespace sinew::io
