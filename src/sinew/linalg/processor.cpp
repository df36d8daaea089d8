#include "sinew/linalg/processor.hpp"

#include <string_view>

namespace sinew::linalg {

bool runs_here(const char* name) {
  const std::string_view asked = name;
#ifdef SINEW_X86_KERNELS
  if (asked == "avx512") return __builtin_cpu_supports("avx512f");
  if (asked == "avx2") return __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma");
#endif
  return asked == "portable";
}

}  // namespace sinew::linalg
