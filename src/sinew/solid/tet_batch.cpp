#include "sinew/solid/tet_batch.hpp"

#include <string_view>

#include "sinew/linalg/processor.hpp"

namespace sinew::solid {

extern const TetKernels kPortable;
#ifdef SINEW_X86_KERNELS
extern const TetKernels kAvx2, kAvx512;
#endif

const TetKernels* tet_kernels(const char* name) {
  if (!linalg::runs_here(name)) return nullptr;
#ifdef SINEW_X86_KERNELS
  if (name == std::string_view("avx512")) return &kAvx512;
  if (name == std::string_view("avx2")) return &kAvx2;
#endif
  return &kPortable;
}

const TetKernels& tet_kernels() {
  static const TetKernels& found = linalg::fastest([](const char* name) { return tet_kernels(name); });
  return found;
}

}  // namespace sinew::solid
