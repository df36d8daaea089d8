// Which of the kernels that are compiled for several widths of registers this processor runs.
#pragma once

#include <array>
#include <initializer_list>
#include <string_view>

namespace sinew::linalg {

/// The sets of kernels there are, the fastest first.
inline constexpr std::array<const char*, 3> kKernelNames = {"avx512", "avx2", "portable"};

/// Whether a set is compiled in and the processor has its registers.
bool runs_here(std::string_view name);

/// The set of a name among those compiled in; null where there is none, or it does not run here.
template <class Kernels>
const Kernels* by_name(std::string_view name, std::initializer_list<const Kernels*> sets) {
  for (const Kernels* set : sets) {
    if (set->name == name && runs_here(name)) return set;
  }
  return nullptr;
}

/// The fastest of a list that ends with the portable one.
template <class Kernels>
const Kernels& fastest(std::initializer_list<const Kernels*> sets) {
  for (const char* name : kKernelNames) {
    if (const Kernels* found = by_name(name, sets)) return *found;
  }
  return **(sets.end() - 1);
}

}  // namespace sinew::linalg
