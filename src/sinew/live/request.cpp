#include "sinew/live/request.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "sinew/error/input_error.hpp"

namespace sinew::live {

namespace {

using Json = nlohmann::json;

[[noreturn]] void refuse(const std::string& field, const std::string& rule) {
  throw InputError({.path = "message." + field, .rule = rule});
}

/// What is no text in UTF-8, or too deep, is refused before anything of it is looked at.
Json parse(std::string_view text) {
  if (text.size() > kLongestRequest) refuse("size", fmt::format("must be at most {} bytes", kLongestRequest));
  int deepest = 0;
  const auto shallow = [&deepest](int depth, Json::parse_event_t, Json&) {
    deepest = std::max(deepest, depth);
    return depth <= 4;
  };
  Json all = Json::parse(text, shallow, false);
  if (all.is_discarded() || deepest > 4 || !all.is_object()) refuse("do", "a message is a small JSON object");
  return all;
}

const Json& entry(const Json& all, const char* name) {
  const auto found = all.find(name);
  if (found == all.end()) refuse(name, "is missing");
  return *found;
}

double number(const Json& value, const char* name) {
  if (!value.is_number()) refuse(name, "must be a number");
  const double own = value.get<double>();
  if (!std::isfinite(own) || std::abs(own) > 1e12) refuse(name, "must be finite, and no larger than 1e12");
  return own;
}

std::string word(const Json& all, const char* name) {
  const Json& value = entry(all, name);
  if (!value.is_string()) refuse(name, "must be text");
  return value.get<std::string>();
}

template <class Objects, class Name>
int place_of(const Json& all, const char* kind, const Objects& objects, const Name& name_of) {
  const std::string name = word(all, kind);
  for (std::size_t i = 0; i < objects.size(); ++i) {
    if (name_of(objects[i]) == name) return static_cast<int>(i);
  }
  refuse(kind, "does not exist in this scene");
}

Eigen::VectorXd vector(const Json& value, const char* name, int size) {
  if (!value.is_array() || value.size() != static_cast<std::size_t>(size))
    refuse(name, fmt::format("must be a list of {} numbers", size));
  Eigen::VectorXd all(size);
  for (int i = 0; i < size; ++i) all[i] = number(value[static_cast<std::size_t>(i)], name);
  return all;
}

long whole(const Json& value, const char* name) {
  const double own = number(value, name);
  if (own != std::floor(own) || own < 0.0 || own > 1e9) refuse(name, "must be a whole number, not negative");
  return static_cast<long>(own);
}

std::vector<std::string> field_of(const Json& all, const char* kind, const std::vector<Field>& known) {
  const std::string name = word(all, kind);
  if (name.empty()) return {};
  const auto same = [&name](const Field& own) { return own.name == name; };
  if (std::none_of(known.begin(), known.end(), same)) refuse(kind, "is not known");
  return {name};
}

constexpr auto kName = [](const auto& own) { return own.name; };

}  // namespace

const std::vector<Field>& solid_fields() {
  static const std::vector<Field> fields = {{"von_mises", "Pa"}, {"principal_stress", "Pa"}, {"volume_ratio", "1"}};
  return fields;
}

const std::vector<Field>& rod_fields() {
  static const std::vector<Field> fields = {
      {"bending", "1/m"}, {"torsion", "1/m"}, {"elongation", "1"}, {"von_mises", "Pa"}};
  return fields;
}

Show together(Show one, const Show& other) {
  const auto join = [](std::vector<std::string>& own, const std::vector<std::string>& more) {
    for (const std::string& name : more) {
      if (std::find(own.begin(), own.end(), name) == own.end()) own.push_back(name);
    }
  };
  join(one.solids, other.solids);
  join(one.rods, other.rods);
  one.energies = one.energies || other.energies;
  return one;
}

Show everything() {
  Show all{{}, {}, true};
  for (const Field& own : solid_fields()) all.solids.emplace_back(own.name);
  for (const Field& own : rod_fields()) all.rods.emplace_back(own.name);
  return all;
}

Request read_request(std::string_view text, const Model& model) {
  const Json all = parse(text);
  const std::string what = word(all, "do");
  if (what == "play") return Play{};
  if (what == "pause") return Pause{};
  if (what == "step") return Step{};
  if (what == "reset") return Reset{};
  if (what == "release") return Release{};
  if (what == "speed") {
    const double value = number(entry(all, "value"), "value");
    if (!(value >= 1e-3 && value <= 1e3)) refuse("value", "must be from 0.001 to 1000");
    return Speed{value};
  }
  if (what == "tell") {
    Tell own{place_of(all, "actuator", model.actuators, kName), {}};
    if (const Json& value = entry(all, "value"); !value.is_null()) own.value = number(value, "value");
    return own;
  }
  if (what == "aim") {
    const auto name = [&model](const EffectorModel& own) { return model.outputs[own.output].name; };
    Aim own{place_of(all, "target", model.effectors, name), {}};
    if (const Json& at = entry(all, "at"); !at.is_null()) own.at = vector(at, "at", model.effectors[own.effector].size);
    return own;
  }
  if (what == "grip") {
    Grab own;
    own.grip.solid = place_of(all, "solid", model.solids, kName);
    const long node = whole(entry(all, "node"), "node");
    if (node >= model.solids[own.grip.solid].body.nodes()) refuse("node", "does not exist in this solid");
    own.grip.node = static_cast<int>(node);
    own.grip.to = vector(entry(all, "to"), "to", 3);
    own.grip.stiffness = number(entry(all, "stiffness"), "stiffness");
    if (!(own.grip.stiffness >= 0.0 && own.grip.stiffness <= 1e6)) refuse("stiffness", "must be from 0 to 1e6 N/m");
    return own;
  }
  if (what == "seek") return Seek{whole(entry(all, "frame"), "frame")};
  if (what == "show") {
    const Json& energies = entry(all, "energies");
    if (!energies.is_boolean()) refuse("energies", "must be true or false");
    return Show{field_of(all, "solids", solid_fields()), field_of(all, "rods", rod_fields()), energies.get<bool>()};
  }
  if (what == "ack") return Ack{whole(entry(all, "frame"), "frame")};
  refuse("do", "is not known: play, pause, step, reset, speed, tell, aim, grip, release, seek, show, ack");
}

}  // namespace sinew::live
