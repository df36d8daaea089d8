#include "sinew/linalg/processor.hpp"

#include <cstdlib>
#include <stdexcept>
#include <string>

namespace sinew::linalg {

bool runs_here(std::string_view name) {
#ifdef SINEW_X86_KERNELS
  if (name == "avx512")
    return __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512vl") &&
           __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("fma");
  if (name == "avx2") return __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma");
#endif
  return name == "portable";
}

std::string_view widest_wanted() {
  const char* const given = std::getenv("SINEW_REGISTERS");
  const std::string_view name = given ? given : "";
  for (const std::string_view known : {"", "avx512", "avx2", "portable"}) {
    if (name == known) return known;
  }
  throw std::runtime_error("SINEW_REGISTERS=" + std::string(name) + ": is none of avx512, avx2, portable");
}

}  // namespace sinew::linalg
