#include "sinew/io/units.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <numbers>

#include "sinew/error/input_error.hpp"
#include "sinew/io/nearest.hpp"

namespace sinew::io {
namespace {

/// SI value = number * times / over. One of the two is 1, so "9 mm" is the double nearest to 0.009.
struct Unit {
  std::string_view symbol;
  Dimension dimension;
  double times = 1.0;
  double over = 1.0;
};

using enum Dimension;

constexpr std::array all_units = std::to_array<Unit>({
    {"um", length, 1.0, 1e6},
    {"mm", length, 1.0, 1e3},
    {"cm", length, 1.0, 1e2},
    {"m", length},
    {"mg", mass, 1.0, 1e6},
    {"g", mass, 1.0, 1e3},
    {"kg", mass},
    {"us", time, 1.0, 1e6},
    {"ms", time, 1.0, 1e3},
    {"s", time},
    {"min", time, 60.0},
    {"mrad", angle, 1.0, 1e3},
    {"deg", angle, std::numbers::pi, 180.0},
    {"rad", angle},
    {"mN", force, 1.0, 1e3},
    {"N", force},
    {"kN", force, 1e3},
    {"mN m", torque, 1.0, 1e3},
    {"mNm", torque, 1.0, 1e3},
    {"N mm", torque, 1.0, 1e3},
    {"Nmm", torque, 1.0, 1e3},
    {"N m", torque},
    {"Nm", torque},
    {"Pa", pressure},
    {"kPa", pressure, 1e3},
    {"MPa", pressure, 1e6},
    {"GPa", pressure, 1e9},
    {"kg/m^3", density},
    {"g/cm^3", density, 1e3},
    {"mm/s^2", acceleration, 1.0, 1e3},
    {"m/s^2", acceleration},
    {"1/s", rate},
    {"1/m", curvature},
    {"1/cm", curvature, 1e2},
    {"1/mm", curvature, 1e3},
    {"mPa s", viscosity, 1.0, 1e3},
    {"Pa s", viscosity},
    {"kPa s", viscosity, 1e3},
    {"g/m", line_density, 1.0, 1e3},
    {"kg/m", line_density},
    {"mN/m", line_load, 1.0, 1e3},
    {"N/m", line_load},
    {"kN/m", line_load, 1e3},
    {"mm/s", velocity, 1.0, 1e3},
    {"cm/s", velocity, 1.0, 1e2},
    {"m/s", velocity},
    {"deg/s", turning, std::numbers::pi, 180.0},
    {"rad/s", turning},
    {"mN/s", force_rate, 1.0, 1e3},
    {"N/s", force_rate},
    {"kN/s", force_rate, 1e3},
});

bool is_space(char c) { return c == ' ' || c == '\t'; }

std::string_view trim(std::string_view text) {
  while (!text.empty() && is_space(text.front())) text.remove_prefix(1);
  while (!text.empty() && is_space(text.back())) text.remove_suffix(1);
  return text;
}

/// Runs of white space become one blank, so "N  m" is "N m".
std::string single_blanks(std::string_view text) {
  std::string out;
  for (const char c : text) {
    if (!is_space(c)) {
      out += c;
    } else if (out.empty() || out.back() != ' ') {
      out += ' ';
    }
  }
  return out;
}

std::string how_to_write(Dimension dimension) {
  if (dimension == number) return "write a plain number, without a unit";
  return fmt::format("write a plain number in {} or a number with one of the units {}", si_unit(dimension),
                     fmt::join(units(dimension), ", "));
}

[[noreturn]] void refuse(std::string_view text, std::string rule, std::string remedy) {
  throw InputError({.file = {},
                    .line = 0,
                    .path = {},
                    .value = std::string(text),
                    .rule = std::move(rule),
                    .remedy = std::move(remedy)});
}

[[noreturn]] void refuse_unit(std::string_view text, const std::string& unit, Dimension dimension) {
  const auto* known = std::find_if(all_units.begin(), all_units.end(), [&](const Unit& u) { return u.symbol == unit; });
  if (known != all_units.end()) {
    refuse(text, fmt::format("must be {}, but '{}' is a unit of {}", name(dimension), unit, name(known->dimension)),
           how_to_write(dimension));
  }
  std::string rule = fmt::format("must be {}, but '{}' is not a unit known here", name(dimension), unit);
  const std::vector<std::string_view> accepted = units(dimension);
  const std::string near = nearest(unit, {accepted.begin(), accepted.end()});
  refuse(text, std::move(rule),
         (near.empty() ? "" : fmt::format("did you mean `{}`? ", near)) + how_to_write(dimension));
}

}  // namespace

std::string_view name(Dimension dimension) {
  switch (dimension) {
    case number:
      return "a number";
    case length:
      return "a length";
    case mass:
      return "a mass";
    case time:
      return "a time";
    case angle:
      return "an angle";
    case force:
      return "a force";
    case torque:
      return "a torque";
    case pressure:
      return "a pressure";
    case density:
      return "a density";
    case acceleration:
      return "an acceleration";
    case rate:
      return "a rate";
    case curvature:
      return "a curvature";
    case viscosity:
      return "a viscosity";
    case line_density:
      return "a line density";
    case line_load:
      return "a line load";
    case velocity:
      return "a velocity";
    case turning:
      return "an angular velocity";
    case force_rate:
      return "a rate of force";
  }
  return "";
}

std::string_view si_unit(Dimension dimension) {
  switch (dimension) {
    case number:
      return "";
    case length:
      return "m";
    case mass:
      return "kg";
    case time:
      return "s";
    case angle:
      return "rad";
    case force:
      return "N";
    case torque:
      return "N m";
    case pressure:
      return "Pa";
    case density:
      return "kg/m^3";
    case acceleration:
      return "m/s^2";
    case rate:
      return "1/s";
    case curvature:
      return "1/m";
    case viscosity:
      return "Pa s";
    case line_density:
      return "kg/m";
    case line_load:
      return "N/m";
    case velocity:
      return "m/s";
    case turning:
      return "rad/s";
    case force_rate:
      return "N/s";
  }
  return "";
}

std::vector<std::string_view> units(Dimension dimension) {
  std::vector<std::string_view> symbols;
  for (const Unit& unit : all_units) {
    if (unit.dimension == dimension) symbols.push_back(unit.symbol);
  }
  return symbols;
}

std::string quantity_pattern(Dimension dimension) {
  const std::string decimal = R"([+-]?([0-9]+\.?[0-9]*|\.[0-9]+)([eE][+-]?[0-9]+)?)";
  std::string alternatives;
  for (const std::string_view symbol : units(dimension)) {
    if (!alternatives.empty()) alternatives += '|';
    for (const char c : symbol) {
      if (c == '^') alternatives += '\\';
      alternatives += c == ' ' ? "[ \\t]+" : std::string(1, c);
    }
  }
  if (alternatives.empty()) return fmt::format("^[ \\t]*{}[ \\t]*$", decimal);
  return fmt::format("^[ \\t]*{}([ \\t]*({}))?[ \\t]*$", decimal, alternatives);
}

double parse_quantity(std::string_view text, Dimension dimension) {
  std::string_view rest = trim(text);
  const auto starts_number = [](std::string_view s) {
    return !s.empty() && ((s[0] >= '0' && s[0] <= '9') || (s[0] == '.' && s.size() > 1 && s[1] >= '0' && s[1] <= '9'));
  };
  const bool negative = rest.starts_with('-');
  if (negative || rest.starts_with('+')) rest.remove_prefix(1);
  if (!starts_number(rest)) refuse(text, fmt::format("must be {}", name(dimension)), how_to_write(dimension));

  double value = 0.0;
  const auto [end, status] = std::from_chars(rest.data(), rest.data() + rest.size(), value);
  if (status != std::errc{}) refuse(text, "is too large or too small for a number here", how_to_write(dimension));
  rest.remove_prefix(static_cast<std::size_t>(end - rest.data()));

  if (const std::string unit = single_blanks(trim(rest)); !unit.empty()) {
    const auto* found = std::find_if(all_units.begin(), all_units.end(),
                                     [&](const Unit& u) { return u.dimension == dimension && u.symbol == unit; });
    if (found == all_units.end()) refuse_unit(text, unit, dimension);
    value = value * found->times / found->over;
  }
  if (!std::isfinite(value)) refuse(text, "is too large or too small for a number here", how_to_write(dimension));
  return negative ? -value : value;
}

}  // namespace sinew::io
