#include <algorithm>
#include <cctype>

#include "sinew/error/printable.hpp"
#include "sinew/io/document.hpp"

namespace sinew::io {
namespace {

bool is_alnum(char c) { return std::isalnum(static_cast<unsigned char>(c)) != 0; }

/// Whether YAML reads the bare characters as this very scalar, in any place. Errs on the side of quotes.
bool is_plain(const std::string& text) {
  if (text.empty() || text == "null" || text == "Null" || text == "NULL") return false;
  const bool sign = text.size() > 1 && (text[0] == '-' || text[0] == '+') && (is_alnum(text[1]) || text[1] == '.');
  if (!is_alnum(text[0]) && !sign && text[0] != '_' && text[0] != '.' && text[0] != '/') return false;
  if (text.back() == ' ' || text == "...") return false;
  return std::all_of(text.begin(), text.end(), [](char c) {
    return is_alnum(c) || c == ' ' || c == '_' || c == '.' || c == '/' || c == '^' || c == '+' || c == '-';
  });
}

void write_scalar(std::string& out, const std::string& text) {
  if (is_plain(text)) {
    out += text;
    return;
  }
  constexpr char digits[] = "0123456789ABCDEF";
  out += '"';
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    if (c == '"' || c == '\\') {
      out += '\\';
      out += c;
    } else if (byte < 0x20 || byte == 0x7F) {
      out += "\\x";
      out += digits[byte >> 4];
      out += digits[byte & 15];
    } else {
      out += c;
    }
  }
  out += '"';
}

/// In one line; gives up once `out` is longer than `longest`.
void write_flow(std::string& out, const Node& node, std::size_t longest) {
  if (out.size() > longest) return;
  switch (node.kind) {
    case Node::Kind::empty:
      out += "~";
      return;
    case Node::Kind::scalar:
      write_scalar(out, node.text);
      return;
    case Node::Kind::list:
      out += '[';
      for (const Node& item : node.items) {
        if (&item != &node.items.front()) out += ", ";
        write_flow(out, item, longest);
        if (out.size() > longest) return;
      }
      out += ']';
      return;
    case Node::Kind::map:
      out += '{';
      for (const Entry& entry : node.entries) {
        if (&entry != &node.entries.front()) out += ", ";
        write_scalar(out, entry.key);
        out += ": ";
        write_flow(out, entry.value, longest);
        if (out.size() > longest) return;
      }
      out += '}';
      return;
  }
}

bool holds_map(const Node& node) {
  return node.kind == Node::Kind::map || std::any_of(node.items.begin(), node.items.end(), holds_map);
}

/// A list of maps is written in block style, one `-` an item; other lists and empty maps in one line.
bool in_one_line(const Node& node) {
  if (node.kind == Node::Kind::map) return node.entries.empty();
  return node.kind != Node::Kind::list || !holds_map(node);
}

/// Continues a line that stands after `key:` or `-`, or an empty one at the root, and ends it.
void write_block(std::string& out, const Node& node, int indent) {
  if (in_one_line(node)) {
    if (indent > 0) out += ' ';
    write_flow(out, node, std::string::npos);
    out += '\n';
    return;
  }
  if (indent > 0) out += '\n';
  const std::string margin(static_cast<std::size_t>(indent), ' ');
  for (const Node& item : node.items) {
    out += margin + "-";
    write_block(out, item, indent + 2);
  }
  for (const Entry& entry : node.entries) {
    out += margin;
    write_scalar(out, entry.key);
    out += ':';
    write_block(out, entry.value, indent + 2);
  }
}

}  // namespace

std::string write_document(const Node& node) {
  std::string out;
  write_block(out, node, 0);
  return out;
}

std::string show(const std::string& text, std::size_t longest) {
  if (text.size() <= longest) return printable(text);
  std::size_t end = longest;
  while (end > 0 && (static_cast<unsigned char>(text[end]) & 0xC0u) == 0x80u) --end;  // not inside a character
  return printable(std::string_view(text).substr(0, end)) + "...";
}

std::string show(const Node& node, std::size_t longest) {
  if (node.kind == Node::Kind::empty) return "";
  if (node.kind == Node::Kind::scalar) return show(node.text, longest);
  std::string out;
  write_flow(out, node, longest);
  return show(out, longest);
}

}  // namespace sinew::io
