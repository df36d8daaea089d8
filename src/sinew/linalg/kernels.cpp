#include "sinew/linalg/kernels.hpp"

#include <string_view>

#include "sinew/linalg/processor.hpp"

namespace sinew::linalg {

extern const Kernels kPortable;
#ifdef SINEW_X86_KERNELS
extern const Kernels kAvx2, kAvx512;
#endif

const Kernels* kernels(const char* name) {
  if (!linalg::runs_here(name)) return nullptr;
#ifdef SINEW_X86_KERNELS
  if (name == std::string_view("avx512")) return &kAvx512;
  if (name == std::string_view("avx2")) return &kAvx2;
#endif
  return &kPortable;
}

const Kernels& kernels() {
  static const Kernels& found = linalg::fastest([](const char* name) { return kernels(name); });
  return found;
}

}  // namespace sinew::linalg
