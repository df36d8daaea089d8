// Numbers as people write them: bare (SI) or with a unit, "12 mm", "250 kPa", "9.81 m/s^2".
#pragma once

#include <array>
#include <string>
#include <string_view>
#include <vector>

namespace sinew::io {

/// What a number measures, and so which units it may carry.
enum class Dimension {
  number,
  length,
  mass,
  time,
  angle,
  force,
  torque,
  pressure,
  density,
  acceleration,
  rate,
  curvature,
  viscosity,
  line_density,
  line_load,
  velocity,
  turning,
  force_rate
};

inline constexpr std::array all_dimensions = {
    Dimension::number,   Dimension::length,    Dimension::mass,      Dimension::time,         Dimension::angle,
    Dimension::force,    Dimension::torque,    Dimension::pressure,  Dimension::density,      Dimension::acceleration,
    Dimension::rate,     Dimension::curvature, Dimension::viscosity, Dimension::line_density, Dimension::line_load,
    Dimension::velocity, Dimension::turning,   Dimension::force_rate};

/// "a length"
std::string_view name(Dimension dimension);

/// Unit of a bare number, "m"; empty for a pure number.
std::string_view si_unit(Dimension dimension);

/// Every accepted unit, smallest first, the SI unit among them.
std::vector<std::string_view> units(Dimension dimension);

/// Regular expression (ECMA 262, as in a JSON Schema) of the accepted texts.
std::string quantity_pattern(Dimension dimension);

/// The value in SI of "12 mm", "-3e-2" or "0.1 1/s". Decimal, whatever the locale; white space around the number and
/// the unit is free. Throws InputError (value, rule and remedy filled in) on anything else: another dimension, an
/// unknown unit, not a number, not finite, trailing text.
double parse_quantity(std::string_view text, Dimension dimension);

}  // namespace sinew::io
