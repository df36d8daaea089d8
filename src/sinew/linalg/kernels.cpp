#include "sinew/linalg/kernels.hpp"

#include "sinew/linalg/processor.hpp"

namespace sinew::linalg {

extern const Kernels kPortable;
#ifdef SINEW_X86_KERNELS
extern const Kernels kAvx2, kAvx512;
#define SINEW_SETS \
  { &kAvx512, &kAvx2, &kPortable }
#else
#define SINEW_SETS \
  { &kPortable }
#endif

const Kernels& kernels() {
  static const Kernels& found = linalg::fastest<Kernels>(SINEW_SETS);
  return found;
}

const Kernels* kernels(const char* name) { return linalg::by_name<Kernels>(name, SINEW_SETS); }

}  // namespace sinew::linalg
