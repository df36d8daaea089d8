// Numbers over time that a scene takes from a file or from a formula.
#pragma once

#include <optional>

#include "sinew/io/fields.hpp"

namespace sinew::io {

struct Samples {
  std::vector<double> times;                ///< [s], ascending
  std::vector<std::vector<double>> values;  ///< of each component, at each time [SI]
};

/// Of a map with the key `file` (a CSV table; with `column`, or `columns` where there are several components, and
/// `time`) or `formula` (of t [s], taken at the times of the scene's steps and at quarters of them); nothing of others.
std::optional<Samples> samples(const At& at, std::size_t components);

/// What such a map may be.
Json samples_schema(std::size_t components);

}  // namespace sinew::io
