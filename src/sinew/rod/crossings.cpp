#include "sinew/rod/crossings.hpp"

#include "sinew/linalg/processor.hpp"

namespace sinew::rod {

extern const RodKernels kAvx512, kAvx2, kPortable;

const RodKernels& rod_kernels() {
  static const RodKernels& found = linalg::fastest<RodKernels>(SINEW_KERNEL_SETS);
  return found;
}

const RodKernels* rod_kernels(const char* name) { return linalg::by_name<RodKernels>(name, SINEW_KERNEL_SETS); }

}  // namespace sinew::rod
