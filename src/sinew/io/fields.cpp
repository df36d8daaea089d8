#include "sinew/io/fields.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <stdexcept>

#include "sinew/error/input_error.hpp"
#include "sinew/io/nearest.hpp"

namespace sinew::io {
namespace {

constexpr std::size_t longest_name = 64;
constexpr const char* name_pattern = "^[a-z][a-z0-9_]*$";

std::string printable(const std::string& key) { return show(key, longest_name); }

const Entry* find(const Node& map, const std::string& key) {
  const auto found = std::find_if(map.entries.begin(), map.entries.end(), [&](const Entry& e) { return e.key == key; });
  return found == map.entries.end() ? nullptr : &*found;
}

}  // namespace

Json to_json(const Node& node) {
  if (node.kind == Node::Kind::map) {
    Json json = Json::object();
    for (const Entry& entry : node.entries) json[entry.key] = to_json(entry.value);
    return json;
  }
  if (node.kind == Node::Kind::list) {
    Json json = Json::array();
    for (const Node& item : node.items) json.push_back(to_json(item));
    return json;
  }
  if (node.text == "true" || node.text == "false") return node.text == "true";
  long whole = 0;
  const char* end = node.text.data() + node.text.size();
  const auto all_of = [end](const std::from_chars_result& read) { return read.ec == std::errc() && read.ptr == end; };
  if (all_of(std::from_chars(node.text.data(), end, whole))) return whole;
  double real = 0.0;
  if (all_of(std::from_chars(node.text.data(), end, real))) return real;
  return node.text;
}

std::string help(const Key& key) {
  return fmt::format("`{}` is {}; for example `{}: {}`", key.name, key.doc, key.name, key.example);
}

At At::item(std::size_t index) const {
  At at = *this;
  at.node_ = &node_->items.at(index);
  at.line_ = at.node_->line;
  at.path_ += (path_.empty() ? "" : ".") + std::to_string(index);
  return at;
}

At At::entry(std::size_t index) const {
  const Entry& found = node_->entries.at(index);
  At at = *this;
  at.node_ = &found.value;
  at.line_ = line_of(found);
  at.path_ += (path_.empty() ? "" : ".") + printable(found.key);
  return at;
}

bool At::has(const std::string& key) const { return find(*node_, key) != nullptr; }

At At::child(const std::string& key) const {
  const Entry* found = find(*node_, key);
  if (found == nullptr) throw std::logic_error("no key " + key + " at " + path_);
  return entry(static_cast<std::size_t>(found - node_->entries.data()));
}

At At::child(const Key& key) const {
  At at = child(key.name);
  at.key_ = std::make_shared<const Key>(key);
  return at;
}

bool At::says(const std::string& key, const std::string& word) const {
  const Entry* found = find(*node_, key);
  return found != nullptr && found->value.kind == Node::Kind::scalar && found->value.text == word;
}

std::vector<std::string> At::names_in(const std::string& group) const {
  std::vector<std::string> names;
  if (const Entry* found = find(*root_, group); found != nullptr) {
    for (const Entry& entry : found->value.entries) names.push_back(entry.key);
  }
  return names;
}

std::optional<At> At::object(const std::string& group, const std::string& name) const {
  const Entry* found = find(*root_, group);
  if (found == nullptr || find(found->value, name) == nullptr) return {};
  At at = *this;
  at.node_ = &found->value;
  at.path_ = group;
  at.key_ = nullptr;
  return at.child(name);
}

std::optional<At> At::top(const std::string& key) const {
  if (find(*root_, key) == nullptr) return {};
  At at = *this;
  at.node_ = root_;
  at.path_.clear();
  at.key_ = nullptr;
  return at.child(key);
}

std::filesystem::path At::use(const std::string& name) const {
  std::filesystem::path path = folder_ / name;
  if (used_ != nullptr && std::find(used_->begin(), used_->end(), path) == used_->end()) used_->push_back(path);
  return path;
}

void At::refuse(std::string rule, std::string remedy) const {
  if (remedy.empty() && key_ != nullptr) remedy = help(*key_);
  throw InputError({.file = line_ > 0 ? file_ : unlined_,
                    .line = line_,
                    .path = path_,
                    .value = show(*node_),
                    .rule = std::move(rule),
                    .remedy = std::move(remedy)});
}

void At::refuse_key(const std::string& key, std::string rule, std::string remedy) const {
  const Entry* found = find(*node_, key);
  const int line = found == nullptr ? line_ : found->line;
  throw InputError({.file = line > 0 ? file_ : unlined_,
                    .line = line,
                    .path = (path_.empty() ? "" : path_ + ".") + printable(key),
                    .value = {},
                    .rule = std::move(rule),
                    .remedy = std::move(remedy)});
}

void check_keys(const At& at, const std::string& what, const std::vector<Key>& keys, const std::vector<Rule>& rules) {
  std::vector<std::string> known;
  for (const Key& key : keys) known.push_back(key.name);
  if (!at.is(Node::Kind::map))
    at.refuse(fmt::format("must be a map with the keys {}", fmt::join(known, ", ")),
              at.path().empty() ? fmt::format("begin with a line like `{}: ...`", known[0]) : "");
  for (const Entry& entry : at.node().entries) {
    if (std::find(known.begin(), known.end(), entry.key) != known.end()) continue;
    const std::string near = nearest(entry.key, known);
    at.refuse_key(entry.key, "is not a key of " + what,
                  fmt::format("{}known here: {}", near.empty() ? "" : fmt::format("did you mean `{}`? ", near),
                              fmt::join(known, ", ")));
  }
  for (const Key& key : keys) {
    if (key.need == Need::required && !at.has(key.name)) at.refuse_key(key.name, "is missing", "add it: " + help(key));
  }
  for (const Key& key : keys) {
    if (at.has(key.name) && at.child(key).is(Node::Kind::empty)) at.child(key).refuse("has no value");
  }
  for (const Rule& rule : rules) rule.check(at, keys);
}

Json object_schema(const std::vector<Key>& keys, const std::vector<Json>& values, const std::vector<Rule>& rules) {
  Json json = {{"type", "object"}, {"additionalProperties", false}, {"properties", Json::object()}};
  for (std::size_t i = 0; i < keys.size(); ++i) {
    Json value = {{"description", keys[i].doc}};
    value.update(values[i]);
    value["examples"] = Json::array({to_json(parse_document(keys[i].example, "example of " + keys[i].name))});
    json["properties"][keys[i].name] = value;
    if (keys[i].need == Need::required) json["required"].push_back(keys[i].name);
  }
  for (const Rule& rule : rules) {
    if (!rule.schema.is_null()) json["allOf"].push_back(rule.schema);
  }
  return json;
}

void check_list(const At& at, const std::string& what, Count count) {
  const std::string rule = "must be a list of " + what;
  if (!at.is(Node::Kind::list)) at.refuse(rule);
  const std::size_t size = at.node().items.size();
  if (size >= count.least && size <= count.most) return;
  if (count.least == count.most) at.refuse(fmt::format("{}, {} of them, not {}", rule, count.least, size));
  if (size < count.least) at.refuse(fmt::format("{}, at least {}, not {}", rule, count.least, size));
  at.refuse(fmt::format("{}, at most {}, not {}", rule, count.most, size));
}

Json list_schema(const Json& item, Count count) {
  Json json = {{"type", "array"}, {"items", item}, {"minItems", count.least}};
  if (count.most != Count{}.most) json["maxItems"] = count.most;
  return json;
}

void check_name(const At& map, const std::string& name) {
  const auto letter = [](char c) { return c >= 'a' && c <= 'z'; };
  const bool good = !name.empty() && letter(name[0]) && std::all_of(name.begin(), name.end(), [&](char c) {
    return letter(c) || (c >= '0' && c <= '9') || c == '_';
  });
  if (!good) map.refuse_key(name, "is not a name", "use small letters, digits and _, with a letter first");
  if (name.size() > longest_name) {
    map.refuse_key(name, fmt::format("is longer than {} characters", longest_name), "use a shorter name");
  }
}

Json named_schema(const Json& value) {
  return {{"type", "object"},
          {"propertyNames", {{"pattern", name_pattern}, {"maxLength", longest_name}}},
          {"additionalProperties", value}};
}

Json any_of(std::vector<Json> schemas) {
  Json choices = Json::array();
  for (Json& schema : schemas) {
    const bool choice = schema.size() == 1 && schema.contains("anyOf");
    for (Json& one : choice ? schema["anyOf"] : Json::array({schema})) choices.push_back(one);
  }
  return {{"anyOf", choices}};
}

}  // namespace sinew::io
