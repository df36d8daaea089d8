// A YAML document as a tree that knows its lines. Deliberately less than YAML: no anchors, aliases or tags, one
// document, no repeated keys, small and shallow; so that a scene reads the way it looks and no file can exhaust the
// program.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

namespace sinew::io {

inline constexpr std::size_t largest_document = 1024 * 1024;  ///< bytes
inline constexpr int deepest_document = 32;                   ///< lists and maps inside one another

struct Entry;

struct Node {
  enum class Kind { empty, scalar, list, map };
  Kind kind = Kind::empty;
  int line = 0;                ///< 1-based; 0: not from the file (set by an override)
  std::string text;            ///< of a scalar
  std::vector<Node> items;     ///< of a list
  std::vector<Entry> entries;  ///< of a map, in the order of the file
};

struct Entry {
  std::string key;
  int line = 0;  ///< of the key
  Node value;
};

/// Line to name for the value of an entry: that of a scalar, else that of the key in front of it.
int line_of(const Entry& entry);

/// The bytes of a file, at most `largest_document` of them. Throws InputError.
std::string read_text(const std::filesystem::path& file);

/// Throws InputError with `name` as the file and the line of the fault. An empty document is a fault.
Node parse_document(const std::string& text, const std::string& name);

/// YAML that parses to the same tree: one key a line, lists in brackets unless they hold maps.
std::string write_document(const Node& node);

/// A value in one line as a user would write it, cut with "..." after about `longest` bytes: for messages.
std::string show(const Node& node, std::size_t longest = 60);
std::string show(const std::string& text, std::size_t longest = 60);

/// Applies "solids.finger.material.young=500 kPa": the value is YAML and replaces what stands there; a missing key is
/// added at the end. Below `frames`, `solids`, `rods`, `actuators`, `loads` and `outputs` only objects that
/// exist can be changed. Throws InputError with "--set" as the file.
void set_value(Node& root, const std::string& assignment);

}  // namespace sinew::io
