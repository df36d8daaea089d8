#include "sinew/linalg/processor.hpp"

namespace sinew::linalg {

bool runs_here(std::string_view name) {
#ifdef SINEW_X86_KERNELS
  if (name == "avx512") return __builtin_cpu_supports("avx512f");
  if (name == "avx2") return __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma");
#endif
  return name == "portable";
}

}  // namespace sinew::linalg
