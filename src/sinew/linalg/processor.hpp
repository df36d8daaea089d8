// Which of the kernels that are compiled for several widths of registers this processor runs.
#pragma once

#include <array>

namespace sinew::linalg {

/// The sets of kernels there are, the fastest first.
inline constexpr std::array<const char*, 3> kKernelNames = {"avx512", "avx2", "portable"};

/// Whether a set is compiled in and the processor has its registers.
bool runs_here(const char* name);

/// The fastest set that runs here; `find` gives it by name, or null.
template <class Find>
const auto& fastest(const Find& find) {
  for (const char* name : kKernelNames) {
    if (const auto* found = find(name)) return *found;
  }
  return *find("portable");  // not reached: it runs everywhere
}

}  // namespace sinew::linalg
