#include "sinew/linalg/kernels.hpp"

#include "sinew/linalg/processor.hpp"

namespace sinew::linalg {

extern const Kernels kAvx512, kAvx2, kPortable;

const Kernels& kernels() {
  static const Kernels& found = linalg::fastest<Kernels>(SINEW_KERNEL_SETS);
  return found;
}

const Kernels* kernels(const char* name) { return linalg::by_name<Kernels>(name, SINEW_KERNEL_SETS); }

}  // namespace sinew::linalg
