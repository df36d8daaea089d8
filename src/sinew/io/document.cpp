#include "sinew/io/document.hpp"

#include <fmt/format.h>
#include <yaml-cpp/eventhandler.h>
#include <yaml-cpp/exceptions.h>
#include <yaml-cpp/mark.h>
#include <yaml-cpp/parser.h>

#include <algorithm>
#include <fstream>
#include <optional>
#include <set>
#include <sstream>
#include <utility>

#include "sinew/error/input_error.hpp"

namespace sinew::io {
namespace {

/// Builds the tree from the parser's events and stops at what a scene file may not hold.
class Builder : public YAML::EventHandler {
 public:
  explicit Builder(std::string name) : name_(std::move(name)) {}

  Node take() { return std::move(root_); }
  int line() const { return line_; }  ///< up to which everything was understood

  void OnDocumentStart(const YAML::Mark& mark) override {
    if (documents_++ == 0) return;
    refuse(mark, "", "holds more than one document", "keep one scene in a file, and no `---` or stray text after it");
  }
  void OnDocumentEnd() override {}
  void OnAnchor(const YAML::Mark& mark, const std::string& anchor) override {
    refuse(mark, "&" + anchor, "anchors and aliases are not supported", "write the value out where it is needed");
  }
  void OnAlias(const YAML::Mark& mark, YAML::anchor_t) override {
    refuse(mark, "", "anchors and aliases are not supported", "write the value out");
  }
  void OnNull(const YAML::Mark& mark, YAML::anchor_t) override {
    if (!open_.empty() && open_.back().node.kind == Node::Kind::map && !open_.back().key) {
      refuse(mark, "", "a key is missing before the ':'", "write `key: value`");
    }
    Node node;
    node.line = open_.empty() || !open_.back().key ? mark.line + 1 : open_.back().key_line;
    close(std::move(node));
  }
  void OnScalar(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t, const std::string& text) override {
    refuse_tag(mark, tag);
    line_ = mark.line + 1;
    if (!open_.empty() && open_.back().node.kind == Node::Kind::map && !open_.back().key) {
      if (!open_.back().keys.insert(text).second) {
        refuse(mark, text, "is given twice in the same place", "keep one of the two");
      }
      open_.back().key = text;
      open_.back().key_line = mark.line + 1;
      return;
    }
    Node node;
    node.kind = Node::Kind::scalar;
    node.line = mark.line + 1;
    node.text = text;
    close(std::move(node));
  }
  void OnSequenceStart(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t,
                       YAML::EmitterStyle::value) override {
    open(mark, tag, Node::Kind::list);
  }
  void OnSequenceEnd() override { close_open(); }
  void OnMapStart(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t, YAML::EmitterStyle::value) override {
    open(mark, tag, Node::Kind::map);
  }
  void OnMapEnd() override { close_open(); }

 private:
  /// A list or map whose end has not come yet.
  struct Open {
    Node node;
    std::set<std::string> keys;      ///< seen so far
    std::optional<std::string> key;  ///< that waits for its value
    int key_line = 0;
  };

  [[noreturn]] void refuse(const YAML::Mark& mark, std::string value, std::string rule, std::string remedy) const {
    throw InputError({.file = name_,
                      .line = mark.line + 1,
                      .path = {},
                      .value = std::move(value),
                      .rule = std::move(rule),
                      .remedy = std::move(remedy)});
  }
  void refuse_tag(const YAML::Mark& mark, const std::string& tag) const {
    if (tag.empty() || tag == "?" || tag == "!") return;  // the parser's marks for plain and quoted
    refuse(mark, tag, "tags are not supported", "leave the tag out; the kind of a value follows from its key");
  }
  void open(const YAML::Mark& mark, const std::string& tag, Node::Kind kind) {
    refuse_tag(mark, tag);
    if (static_cast<int>(open_.size()) >= deepest_document) {
      refuse(mark, "", fmt::format("is nested more than {} deep", deepest_document), "close the brackets");
    }
    if (!open_.empty() && open_.back().node.kind == Node::Kind::map && !open_.back().key) {
      refuse(mark, "", "a list or map cannot be a key",
             "close every bracket, and write `key: value` with a plain word as the key");
    }
    Open fresh;
    fresh.node.kind = kind;
    fresh.node.line = mark.line + 1;
    open_.push_back(std::move(fresh));
  }
  void close_open() {
    Node node = std::move(open_.back().node);
    open_.pop_back();
    close(std::move(node));
  }
  void close(Node node) {
    if (open_.empty()) {
      root_ = std::move(node);
    } else if (Open& top = open_.back(); top.node.kind == Node::Kind::list) {
      top.node.items.push_back(std::move(node));
    } else {
      top.node.entries.push_back({std::move(*top.key), top.key_line, std::move(node)});
      top.key.reset();
    }
  }

  std::string name_;
  int documents_ = 0;
  int line_ = 1;
  std::vector<Open> open_;
  Node root_;
};

/// Bytes of the UTF-8 character at the start of `text`; 0 if it is none or a control character other than tab, line
/// feed and carriage return.
std::size_t character(std::string_view text) {
  const auto byte = [&](std::size_t i) { return i < text.size() ? static_cast<unsigned char>(text[i]) : 0u; };
  const unsigned first = byte(0);
  if (first < 0x80) return first >= 0x20 || first == '\t' || first == '\n' || first == '\r' ? 1 : 0;
  const std::size_t count = first >= 0xF0 ? 4 : first >= 0xE0 ? 3 : 2;
  if (first < 0xC2 || first > 0xF4) return 0;
  unsigned code = first & (0xFFu >> (count + 1));
  for (std::size_t i = 1; i < count; ++i) {
    if ((byte(i) & 0xC0u) != 0x80u) return 0;
    code = (code << 6) | (byte(i) & 0x3Fu);
  }
  const bool too_long = (count == 3 && code < 0x800) || (count == 4 && code < 0x10000);
  const bool surrogate = code >= 0xD800 && code <= 0xDFFF;
  return too_long || surrogate || code > 0x10FFFF ? 0 : count;
}

[[noreturn]] void refuse_size(const std::string& name) {
  throw InputError({.file = name,
                    .line = 0,
                    .path = {},
                    .value = {},
                    .rule = fmt::format("is larger than {} MiB, so it is not a scene", largest_document >> 20),
                    .remedy = "give a YAML scene file; meshes and tables of measurements belong in their own files"});
}

void require_text(const std::string& text, const std::string& name) {
  if (text.size() > largest_document) refuse_size(name);
  int line = 1;
  for (std::size_t i = 0; i < text.size();) {
    const std::size_t count = character(std::string_view(text).substr(i));
    if (count == 0) {
      throw InputError({.file = name,
                        .line = line,
                        .path = {},
                        .value = fmt::format("byte 0x{:02X}", static_cast<unsigned char>(text[i])),
                        .rule = "is not text in UTF-8",
                        .remedy = "give a YAML scene file, saved as UTF-8"});
    }
    if (text[i] == '\n') ++line;
    i += count;
  }
}

}  // namespace

int line_of(const Entry& entry) { return entry.value.kind == Node::Kind::scalar ? entry.value.line : entry.line; }

std::string read_text(const std::filesystem::path& file) {
  const std::string name = file.string();
  std::error_code unknown, ignored;
  if (!std::filesystem::exists(file, unknown)) {
    throw InputError({.file = name,
                      .line = 0,
                      .path = {},
                      .value = {},
                      .rule = unknown ? "cannot be looked for: " + unknown.message() : "does not exist",
                      .remedy = "check the path"});
  }
  if (std::filesystem::is_directory(file, ignored)) {
    throw InputError({.file = name,
                      .line = 0,
                      .path = {},
                      .value = {},
                      .rule = "is a folder",
                      .remedy = "give the scene file inside it"});
  }
  std::ifstream in(file, std::ios::binary);
  std::string text(largest_document + 1, '\0');
  in.read(text.data(), static_cast<std::streamsize>(text.size()));
  if (!in && !in.eof()) {
    throw InputError({.file = name,
                      .line = 0,
                      .path = {},
                      .value = {},
                      .rule = "cannot be read",
                      .remedy = "check the permissions"});
  }
  text.resize(static_cast<std::size_t>(in.gcount()));
  if (text.size() > largest_document) refuse_size(name);
  return text;
}

namespace {
/// The first line with a tab among the blanks it begins with, 0 if there is none.
int line_that_begins_with_a_tab(const std::string& text) {
  std::istringstream lines(text);
  std::string line;
  for (int number = 1; std::getline(lines, line); ++number) {
    if (line.substr(0, line.find_first_not_of(" \t")).find('\t') != std::string::npos) return number;
  }
  return 0;
}
}  // namespace

Node parse_document(const std::string& text, const std::string& name) {
  require_text(text, name);
  const int lines = static_cast<int>(std::count(text.begin(), text.end(), '\n')) + (text.ends_with('\n') ? 0 : 1);
  std::istringstream in(text + "\n#");  // a comment, without which the parser takes a quote that is never closed
  Builder builder(name);
  bool any = false;
  try {
    YAML::Parser parser(in);
    while (parser.HandleNextDocument(builder)) any = true;
  } catch (const YAML::Exception& error) {
    const bool quote = error.msg == "illegal EOF in scalar";
    const int tab = line_that_begins_with_a_tab(text);
    if (!quote && tab > 0) {
      throw InputError({.file = name,
                        .line = tab,
                        .rule = "a tab begins this line: YAML takes only blanks there",
                        .remedy = "indent with blanks"});
    }
    const int line = quote ? builder.line() : error.mark.is_null() ? 0 : std::min(error.mark.line + 1, lines);
    throw InputError(
        {.file = name,
         .line = line,
         .path = {},
         .value = {},
         .rule = quote ? "has a quote, here or below, that is never closed" : "is not valid YAML: " + error.msg,
         .remedy = "check indentation, colons, quotes and brackets on this line and the one above"});
  }
  Node root = any ? builder.take() : Node{};
  if (root.kind == Node::Kind::empty) {
    throw InputError({.file = name,
                      .line = 0,
                      .path = {},
                      .value = {},
                      .rule = "is empty",
                      .remedy = "describe a scene in it, see examples/"});
  }
  return root;
}

}  // namespace sinew::io
