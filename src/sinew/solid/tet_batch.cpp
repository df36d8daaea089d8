#include "sinew/solid/tet_batch.hpp"

#include "sinew/linalg/processor.hpp"

namespace sinew::solid {

extern const TetKernels kAvx512, kAvx2, kPortable;

const TetKernels& tet_kernels() {
  static const TetKernels& found = linalg::fastest<TetKernels>(SINEW_KERNEL_SETS);
  return found;
}

const TetKernels* tet_kernels(const char* name) { return linalg::by_name<TetKernels>(name, SINEW_KERNEL_SETS); }

}  // namespace sinew::solid
