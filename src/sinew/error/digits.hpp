// Numbers in messages.
#pragma once

#include <cstdio>
#include <string>

namespace sinew {

/// With three digits: "0.0312", "1.25e+09".
inline std::string three_digits(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.3g", value);
  return text;
}

}  // namespace sinew
