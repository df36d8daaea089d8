// Numbers as a person reads them: three digits and a prefix that fits.
#pragma once

#include <string>
#include <vector>

namespace sinew::io {

/// A unit to show values in: value in SI = shown * factor.
struct ShownUnit {
  double factor = 1.0;
  std::string symbol;  ///< "mm"
};

/// The unit in which values up to `largest` [m] read best: nm, um, mm, m or km.
ShownUnit length_unit(double largest);

/// The same for a stress [Pa]: Pa, kPa, MPa or GPa.
ShownUnit stress_unit(double largest);

/// About three significant digits, no exponent for what is neither tiny nor huge: "34.2", "0.051", "1200".
std::string readable(double shown);

/// Length [m] in its own best unit: "34.2 mm"; "0 mm" for zero.
std::string readable_length(double length);

/// The same of a force [N]: "350 mN"; "0 N" for zero.
std::string readable_force(double force);

/// Largest of 1, 2, 5 times a power of ten that is not above `limit`; 0 if `limit` is not positive and finite.
double round_below(double limit);

/// Round values from 0 up to `largest`, at most `count` + 1 of them; only 0 if there is nothing to divide.
std::vector<double> round_ticks(double largest, int count);

}  // namespace sinew::io
