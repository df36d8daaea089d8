#include "sinew/linalg/chain_kernels.hpp"

#include "sinew/linalg/processor.hpp"

namespace sinew::linalg {

namespace chain {
extern const ChainKernels kAvx512, kAvx2, kPortable;
}
using namespace chain;

const ChainKernels& chain_kernels() {
  static const ChainKernels& found = fastest<ChainKernels>(SINEW_KERNEL_SETS);
  return found;
}

const ChainKernels* chain_kernels(const char* name) { return by_name<ChainKernels>(name, SINEW_KERNEL_SETS); }

}  // namespace sinew::linalg
