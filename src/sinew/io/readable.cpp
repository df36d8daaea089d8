#include "sinew/io/readable.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace sinew::io {
namespace {

/// First unit, from large to small, of which there is at least one.
ShownUnit best(double largest, const std::vector<ShownUnit>& units, const ShownUnit& of_zero) {
  largest = std::abs(largest);
  if (!(largest > 0.0) || !std::isfinite(largest)) return of_zero;
  for (const ShownUnit& unit : units)
    if (largest >= 0.9995 * unit.factor) return unit;  // (0.9996 mm is shown as 1.00 mm)
  return units.back();
}

std::string with_unit(double value, const ShownUnit& unit) { return readable(value / unit.factor) + " " + unit.symbol; }

}  // namespace

ShownUnit length_unit(double largest) {
  return best(largest, {{1e3, "km"}, {1.0, "m"}, {1e-3, "mm"}, {1e-6, "µm"}, {1e-9, "nm"}}, {1e-3, "mm"});
}

ShownUnit stress_unit(double largest) {
  return best(largest, {{1e9, "GPa"}, {1e6, "MPa"}, {1e3, "kPa"}, {1.0, "Pa"}}, {1e3, "kPa"});
}

std::string readable(double shown) {
  const double size = std::abs(shown);
  if (size == 0.0) return "0";
  if (!(size >= 1e-4 && size < 99999.5)) return fmt::format("{:.3g}", shown);
  const int decimals =
      std::clamp(2 - static_cast<int>(std::floor(std::log10(size * 1.0005))), 0, 6);  // (after rounding)
  return fmt::format("{:.{}f}", shown, decimals);
}

std::string readable_length(double length) { return with_unit(length, length_unit(length)); }

std::string readable_force(double force) {
  return with_unit(force, best(force, {{1e3, "kN"}, {1.0, "N"}, {1e-3, "mN"}, {1e-6, "µN"}}, {1.0, "N"}));
}

double round_below(double limit) {
  if (!(limit > 0.0) || !std::isfinite(limit)) return 0.0;
  const double decade = std::pow(10.0, std::floor(std::log10(limit)));
  for (const double digit : {10.0, 5.0, 2.0, 1.0})
    if (digit * decade <= limit * (1.0 + 1e-12)) return digit * decade;
  return decade;
}

std::vector<double> round_ticks(double largest, int count) {
  std::vector<double> ticks = {0.0};
  double step = round_below(largest / count);
  if (!(step > 0.0) || !std::isfinite(largest)) return ticks;
  for (const double wider : {1.0, 2.0, 2.5, 5.0, 10.0}) {  // (2.5 leads from 2 to 5)
    if (largest / (step * wider) > count + 1e-9) continue;
    step *= wider;
    break;
  }
  for (int k = 1; k * step <= largest * (1.0 + 1e-9); ++k) ticks.push_back(k * step);
  return ticks;
}

}  // namespace sinew::io
