// One declaration for each key of a file: from it come both the reader, with its messages, and the JSON Schema.
//
// `Type<V>` reads a V from the tree and describes its JSON; `Field<T>` ties a key to a place in the struct T;
// `Object<T>` is the list of its fields plus rules between them; `one_of_kinds` a map whose one key says what it is;
// `name_of` the name of another object of the file. The scene_*.cpp are written in these words.
#pragma once

#include <algorithm>
#include <filesystem>
#include <functional>
#include <limits>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include "sinew/io/document.hpp"
#include "sinew/io/units.hpp"

namespace sinew::io {

using Json = nlohmann::ordered_json;

/// A node as JSON: whole numbers, numbers and booleans become what they look like, other scalars strings.
Json to_json(const Node& node);

enum class Need { required, optional };

/// A key and what a user has to know about it.
struct Key {
  std::string name;
  Need need = Need::required;
  std::string doc;      ///< "Young's modulus [Pa]"
  std::string example;  ///< YAML, "600 kPa"
};

/// "`young` is Young's modulus [Pa]; for example `young: 600 kPa`"
std::string help(const Key& key);

/// A value in the document, with the way to it; whoever finds a fault in it refuses it here.
class At {
 public:
  /// Files that the document names are looked for in `folder`, and listed in `used`. What has no line was set by an
  /// override, unless nothing has one: then a program has put the document together, and `file` is what it is called.
  At(const Node& root, std::string file, std::filesystem::path folder = {},
     std::vector<std::filesystem::path>* used = nullptr)
      : root_(&root),
        node_(&root),
        file_(std::move(file)),
        folder_(std::move(folder)),
        used_(used),
        unlined_(root.line > 0 ? "--set" : file_),
        line_(root.line) {}

  const Node& node() const { return *node_; }
  const std::string& path() const { return path_; }
  bool is(Node::Kind kind) const { return node_->kind == kind; }

  At item(std::size_t index) const;                                  ///< of a list
  bool has(const std::string& key) const;                            ///< of a map
  At child(const std::string& key) const;                            ///< of a map that has it
  At entry(std::size_t index) const;                                 ///< of a map
  At child(const Key& key) const;                                    ///< and remembers its doc and example for messages
  bool says(const std::string& key, const std::string& word) const;  ///< of a map: whether it has `key: word`

  /// The keys of the map that the document has under `group`; none if there is no such map.
  std::vector<std::string> names_in(const std::string& group) const;

  /// What the document has under a key, if it does.
  std::optional<At> top(const std::string& key) const;
  /// Where a file lies that is read for this document.
  std::filesystem::path use(const std::string& name) const;

  /// An object of the document by its group and name, if there is one.
  std::optional<At> object(const std::string& group, const std::string& name) const;

  /// Throws InputError; without a remedy, the doc and example of the key are one.
  [[noreturn]] void refuse(std::string rule, std::string remedy = "") const;
  /// The same about a key of this map, known or not, at the line of that key if it stands there.
  [[noreturn]] void refuse_key(const std::string& key, std::string rule, std::string remedy = "") const;

 private:
  const Node* root_;
  const Node* node_;
  std::string file_;
  std::filesystem::path folder_;
  std::vector<std::filesystem::path>* used_ = nullptr;
  std::string unlined_;
  std::string path_;
  int line_ = 0;
  std::shared_ptr<const Key> key_;
};

/// A function that copies share: types hold types that hold types, and each is held in several closures, so that true
/// copies would double with every level.
template <class Signature>
class Shared;
template <class R, class... Arguments>
class Shared<R(Arguments...)> {
 public:
  Shared(std::nullptr_t) {}  // NOLINT(google-explicit-constructor): none
  template <class F, class = std::enable_if_t<std::is_invocable_r_v<R, const F&, Arguments...>>>
  Shared(F f)  // NOLINT(google-explicit-constructor): a function is a shared function
      : function_(std::make_shared<const std::function<R(Arguments...)>>(std::move(f))) {}
  explicit operator bool() const { return function_ != nullptr; }
  R operator()(Arguments... arguments) const { return (*function_)(std::forward<Arguments>(arguments)...); }

 private:
  std::shared_ptr<const std::function<R(Arguments...)>> function_;
};

template <class V>
struct Type {
  Shared<V(const At&)> read;
  Shared<Json()> schema;
  Shared<Json(const V&)> show = nullptr;  ///< a default value in the schema; none if not set
};

template <class T>
struct Field {
  Key key;
  Shared<void(T&, const At&)> store;
  Shared<Json()> schema;
};

/// `access` (member pointer or callable) names what the value is stored in: a V or an optional V.
template <class T, class Access, class V>
Field<T> field(Key key, Access access, Type<V> type) {
  const auto store = [=](T& object, const At& at) { std::invoke(access, object) = type.read(at); };
  const auto schema = [=] {
    Json json = type.schema();
    using Target = std::remove_cvref_t<std::invoke_result_t<Access, T&>>;
    if constexpr (std::is_same_v<Target, V>) {
      T fresh;
      if (key.need == Need::optional && type.show) json["default"] = type.show(std::invoke(access, fresh));
    }
    return json;
  };
  return {key, store, schema};
}

/// A condition between the keys of one object, for the reader and for the schema.
struct Rule {
  Shared<void(const At&, const std::vector<Key>&)> check;
  Json schema = nullptr;  ///< null: what the schema cannot say
};

Rule exactly_one(std::vector<std::string> keys);
Rule at_least_one(std::vector<std::string> keys);
Rule at_most_one(std::vector<std::string> keys);
/// `key` may not be given together with any of `others`.
Rule excludes(std::string key, std::vector<std::string> others);
/// `key` may only be given together with `other`.
Rule needs(std::string key, std::string other);
/// If `key` is given, `other` is absent or says `word`.
Rule only_with(std::string key, std::string other, std::string word);
/// One of `wanted` must be given unless `key` says `word`.
Rule wanted_unless(std::string key, std::string word, std::vector<std::string> wanted);
/// Schema of an object in which `key` is given and says `word`.
Json says_schema(const std::string& key, const std::string& word);

template <class T>
struct Object {
  std::string what;              ///< "a solid", for messages
  std::vector<Field<T>> fields;  ///< stored in this order, so that one may be read by what those before it say
  std::vector<Rule> rules = {};
  std::function<void(const T&, const At&)> check = nullptr;  ///< on the finished object
};

/// Refuses what is not a map, unknown keys (the nearest known one is suggested), missing keys and broken rules.
void check_keys(const At& at, const std::string& what, const std::vector<Key>& keys, const std::vector<Rule>& rules);
Json object_schema(const std::vector<Key>& keys, const std::vector<Json>& values, const std::vector<Rule>& rules);

/// The name of a struct without its namespaces, under which schemas, and classes made from them, know its objects.
template <class T>
std::string type_name() {
  const std::string_view whole = __PRETTY_FUNCTION__;  // "... [with T = sinew::SolidPart; ...]"
  const std::size_t begin = whole.find("T = ") + 4;
  const std::string_view name = whole.substr(begin, whole.find_first_of(";]", begin) - begin);
  return std::string(name.substr(name.rfind(':') + 1));
}

template <class T>
Type<T> map(Object<T> object) {
  std::vector<Key> keys;
  for (const Field<T>& f : object.fields) keys.push_back(f.key);
  const auto read = [=](const At& at) {
    check_keys(at, object.what, keys, object.rules);
    T value;
    for (const Field<T>& f : object.fields) {
      if (at.has(f.key.name)) f.store(value, at.child(f.key));
    }
    if (object.check) object.check(value, at);
    return value;
  };
  const auto schema = [=] {
    std::vector<Json> values;
    for (const Field<T>& f : object.fields) values.push_back(f.schema());
    Json json = object_schema(keys, values, object.rules);
    json["title"] = type_name<T>();
    json["$comment"] = object.what;
    return json;
  };
  return {read, schema};
}

/// One of the things that a V may be. Its key names it.
template <class V>
struct Kind {
  Key key;
  Shared<V(const At&)> read;
  Shared<Json()> schema;
};

template <class V, class K>
Kind<V> kind(std::string name, std::string doc, std::string example, Type<K> type) {
  return {{std::move(name), Need::optional, std::move(doc), std::move(example)}, type.read, type.schema};
}

/// A map with exactly one key, the kind, as in `{slide: {...}}`.
template <class V>
Type<V> one_of_kinds(std::string what, std::vector<Kind<V>> kinds) {
  std::vector<Key> keys;
  std::vector<std::string> names;
  for (const Kind<V>& one : kinds) {
    keys.push_back(one.key);
    names.push_back(one.key.name);
  }
  const std::vector<Rule> rules = {exactly_one(names)};
  const auto read = [=](const At& at) {
    check_keys(at, what, keys, rules);
    std::size_t given = 0;
    while (!at.has(names[given])) ++given;
    return kinds[given].read(at.child(keys[given]));
  };
  const auto schema = [=] {
    std::vector<Json> values;
    for (const Kind<V>& one : kinds) values.push_back(one.schema());
    return object_schema(keys, values, rules);
  };
  return {read, schema};
}

/// How many elements a list may have.
struct Count {
  std::size_t least = 1;
  std::size_t most = std::numeric_limits<std::size_t>::max();
};

void check_list(const At& at, const std::string& what, Count count);
Json list_schema(const Json& item, Count count);

template <class V>
Type<std::vector<V>> list(std::string what, Type<V> item, Count count,
                          std::function<void(const std::vector<V>&, const At&)> check = nullptr) {
  const auto read = [=](const At& at) {
    check_list(at, what, count);
    std::vector<V> values;
    for (std::size_t i = 0; i < at.node().items.size(); ++i) values.push_back(item.read(at.item(i)));
    if (check) check(values, at);
    return values;
  };
  return {read, [=] { return list_schema(item.schema(), count); }};
}

void check_name(const At& map, const std::string& name);
Json named_schema(const Json& value);

/// A map from names the user chooses to values, in the order of the file.
template <class V>
Type<std::vector<std::pair<std::string, V>>> named(std::string what, Type<V> type) {
  const auto read = [=](const At& at) {
    std::vector<std::pair<std::string, V>> values;
    if (!at.is(Node::Kind::map)) at.refuse("must be a map from the name of " + what + " to what it is");
    for (std::size_t i = 0; i < at.node().entries.size(); ++i) {
      const std::string& name = at.node().entries[i].key;
      check_name(at, name);
      values.emplace_back(name, type.read(at.entry(i)));
    }
    return values;
  };
  return {read, [=] { return named_schema(type.schema()); }};
}

/// Limits of a number, each with what to do about it.
struct Range {
  double lower = -std::numeric_limits<double>::infinity();
  double upper = std::numeric_limits<double>::infinity();
  bool above = false;       ///< lower itself is refused
  bool below = false;       ///< upper itself is refused
  std::string where = "";   ///< appended to the rule: " in a solid"
  std::string remedy = "";  ///< for a value beyond upper
};

Type<double> quantity(Dimension dimension, Range range = {});
Type<int> whole_number(int lower, int upper);
Type<std::string> text();
Type<bool> boolean();

/// The name of an object that the file describes: of a "rod", listed under `rods`.
Type<std::string> name_of(std::string what);

/// What words of an enumeration mean.
template <class E>
using Words = std::vector<std::pair<std::string, E>>;
template <class E>
std::vector<std::string> texts_of(const Words<E>& words) {
  std::vector<std::string> texts;
  for (const auto& [text, value] : words) texts.push_back(text);
  return texts;
}
template <class E>
int number_of(const Words<E>& words, E value) {
  const auto same = [value](const auto& own) { return own.second == value; };
  const auto found = std::find_if(words.begin(), words.end(), same);
  if (found == words.end()) throw std::logic_error("a value that no word of a scene file means");
  return static_cast<int>(found - words.begin());
}

/// One of a few words, by its number.
Type<int> word(std::vector<std::string> words);
/// One of a few words.
template <class E>
Type<E> word_of(Words<E> words) {
  const Type<int> type = word(texts_of(words));
  return {[=](const At& at) { return words[static_cast<std::size_t>(type.read(at))].second; }, type.schema,
          [=](const E& value) { return type.show(number_of(words, value)); }};
}

/// A list of such words, each at most once; sorted by their order.
Type<std::vector<int>> distinct_words(std::string what, std::vector<std::string> words, Count count);
template <class E>
Type<std::vector<E>> distinct(std::string what, Words<E> words, Count count) {
  const Type<std::vector<int>> type = distinct_words(std::move(what), texts_of(words), count);
  const auto read = [=](const At& at) {
    std::vector<E> values;
    for (const int number : type.read(at)) values.push_back(words[static_cast<std::size_t>(number)].second);
    return values;
  };
  const auto show = [=](const std::vector<E>& values) {
    std::vector<int> numbers;
    for (const E value : values) numbers.push_back(number_of(words, value));
    return type.show(numbers);
  };
  return {read, type.schema, show};
}

/// Definitions that the schema of a quantity refers to.
Json quantity_definitions();

/// JSON that validates if one of these does.
Json any_of(std::vector<Json> schemas);

}  // namespace sinew::io
