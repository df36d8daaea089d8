#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>

#include "sinew/error/input_error.hpp"
#include "sinew/io/document.hpp"
#include "sinew/io/nearest.hpp"

namespace sinew::io {
namespace {

/// Maps from a name the user chose: a new name here would only be a misspelled one.
constexpr std::array<std::string_view, 6> named = {"frames", "solids", "rods", "actuators", "loads", "outputs"};

[[noreturn]] void refuse(const std::string& path, const std::string& rule, const std::string& remedy) {
  throw InputError({.file = "--set", .line = 0, .path = path, .value = {}, .rule = rule, .remedy = remedy});
}

std::vector<std::string> split(const std::string& path) {
  std::vector<std::string> steps(1);
  for (const char c : path) {
    if (c == '.') {
      steps.emplace_back();
    } else {
      steps.back() += c;
    }
  }
  return steps;
}

void forget_lines(Node& node) {
  node.line = 0;
  for (Node& item : node.items) forget_lines(item);
  for (Entry& entry : node.entries) {
    entry.line = 0;
    forget_lines(entry.value);
  }
}

Node& item_at(Node& list, const std::string& step, const std::string& path) {
  std::size_t index = 0;
  const auto [end, status] = std::from_chars(step.data(), step.data() + step.size(), index);
  if (status != std::errc{} || end != step.data() + step.size() || index >= list.items.size()) {
    refuse(
        path, fmt::format("has no element '{}'", step),
        list.items.empty() ? "the list is empty" : fmt::format("the list has elements 0 to {}", list.items.size() - 1));
  }
  return list.items[index];
}

[[noreturn]] void refuse_name(const Node& map, const std::string& step, const std::string& path) {
  std::vector<std::string> known;
  for (const Entry& entry : map.entries) known.push_back(entry.key);
  const std::string near = nearest(step, known);
  std::string all;
  for (const std::string& name : known) all += (all.empty() ? "" : ", ") + name;
  refuse(path + "." + step, "does not exist in this scene",
         (near.empty() ? "" : "did you mean `" + near + "`? ") + path + (all.empty() ? " is empty" : " holds " + all));
}

}  // namespace

void set_value(Node& root, const std::string& assignment) {
  const std::size_t equals = assignment.find('=');
  const std::string path = assignment.substr(0, equals);
  const std::vector<std::string> steps = split(path);
  if (equals == std::string::npos || steps.size() > deepest_document ||
      std::any_of(steps.begin(), steps.end(), [](const std::string& step) { return step.empty(); })) {
    throw InputError({.file = "--set",
                      .line = 0,
                      .path = {},
                      .value = show(assignment),
                      .rule = "must be path=value",
                      .remedy = "for example `solids.finger.material.young=500 kPa` or `couplings.0.slide.points=31`"});
  }
  if (assignment.find_first_not_of(" \t\r\n", equals + 1) == std::string::npos) {
    refuse(path, "is given no value", "write one after the `=`, for example `title=bent`");
  }
  Node value;
  try {
    value = parse_document(assignment.substr(equals + 1), "--set");
  } catch (const InputError& error) {
    InputFault fault = error.fault();
    fault.line = 0;
    fault.path = path;
    throw InputError(fault);
  }
  forget_lines(value);

  Node* place = &root;
  std::string so_far;
  for (std::size_t i = 0; i < steps.size(); ++i) {
    const std::string& step = steps[i];
    if (place->kind == Node::Kind::list) {
      place = &item_at(*place, step, so_far);
    } else if (place->kind == Node::Kind::scalar) {
      refuse(path, fmt::format("does not exist: {} is a single value, not a map", so_far),
             fmt::format("replace the value as a whole: `{}=...`", so_far));
    } else {
      place->kind = Node::Kind::map;
      const auto entry = std::find_if(place->entries.begin(), place->entries.end(),
                                      [&](const Entry& known) { return known.key == step; });
      if (entry != place->entries.end()) {
        place = &entry->value;
      } else {
        const bool of_named = i == 1 && std::find(named.begin(), named.end(), steps[0]) != named.end();
        if (of_named && steps.size() > 2) refuse_name(*place, step, so_far);
        place->entries.push_back({step, 0, Node{}});
        place = &place->entries.back().value;
      }
    }
    so_far += (so_far.empty() ? "" : ".") + step;
  }
  *place = std::move(value);
}

}  // namespace sinew::io
