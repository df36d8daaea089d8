#include "sinew/solid/tet_batch.hpp"

#include "sinew/linalg/processor.hpp"

namespace sinew::solid {

extern const TetKernels kPortable;
#ifdef SINEW_X86_KERNELS
extern const TetKernels kAvx2, kAvx512;
#define SINEW_SETS \
  { &kAvx512, &kAvx2, &kPortable }
#else
#define SINEW_SETS \
  { &kPortable }
#endif

const TetKernels& tet_kernels() {
  static const TetKernels& found = linalg::fastest<TetKernels>(SINEW_SETS);
  return found;
}

const TetKernels* tet_kernels(const char* name) { return linalg::by_name<TetKernels>(name, SINEW_SETS); }

}  // namespace sinew::solid
