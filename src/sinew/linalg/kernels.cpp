#include "sinew/linalg/kernels.hpp"

#include "sinew/linalg/processor.hpp"

namespace sinew::linalg {

extern const Kernels kAvx512, kAvx2, kPortable;

const Kernels& kernels() {
  static const Kernels& found = linalg::fastest<Kernels>(SINEW_KERNEL_SETS);
  return found;
}

const Kernels* kernels(const char* name) { return linalg::by_name<Kernels>(name, SINEW_KERNEL_SETS); }

namespace single {

extern const KernelsOf<float> kAvx512, kAvx2, kPortable;

const KernelsOf<float>& kernels() {
  static const KernelsOf<float>& found = linalg::fastest<KernelsOf<float>>(SINEW_KERNEL_SETS);
  return found;
}

const KernelsOf<float>* kernels(const char* name) { return linalg::by_name<KernelsOf<float>>(name, SINEW_KERNEL_SETS); }

}  // namespace single

}  // namespace sinew::linalg
