// Which of the kernels that are compiled for several widths of registers this processor runs.
#pragma once

#include <algorithm>
#include <initializer_list>
#include <string_view>

/// The sets compiled in of a layer that declares its `kAvx512`, `kAvx2` and `kPortable`, the fastest first.
#ifdef SINEW_X86_KERNELS
#define SINEW_KERNEL_SETS \
  { &kAvx512, &kAvx2, &kPortable }
#else
#define SINEW_KERNEL_SETS \
  { &kPortable }
#endif

namespace sinew::linalg {

/// Whether a set is compiled in and the processor has its registers: "avx512", "avx2", "portable".
bool runs_here(std::string_view name);

/// The set of a name; null where there is none, or it does not run here.
template <class Kernels>
const Kernels* by_name(std::string_view name, std::initializer_list<const Kernels*> sets) {
  const auto found = std::find_if(sets.begin(), sets.end(), [name](const Kernels* set) { return set->name == name; });
  return found != sets.end() && runs_here(name) ? *found : nullptr;
}

/// A set's name that the environment gives as SINEW_REGISTERS, to keep from wider ones: for comparisons. Throws
/// std::runtime_error where it names none.
std::string_view widest_wanted();

/// The first that runs here, and is wanted.
template <class Kernels>
const Kernels& fastest(std::initializer_list<const Kernels*> sets) {
  const std::string_view widest = widest_wanted();
  const auto first =
      std::find_if(sets.begin(), sets.end(), [&](const Kernels* set) { return widest.empty() || set->name == widest; });
  // (A name of another machine's sets: whatever there is.)
  return **std::find_if(first == sets.end() ? sets.begin() : first, sets.end(),
                        [](const Kernels* set) { return runs_here(set->name); });
}

}  // namespace sinew::linalg
