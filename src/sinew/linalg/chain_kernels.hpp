// The part of a chain's condensation that many wrenches take together, in registers as wide as the processor has.
#pragma once

namespace sinew::linalg {

/// Wrenches side by side: eight first components, eight second ones, and so on.
inline constexpr int kWrenches = 8, kWrenchNumbers = 6 * kWrenches;

/// A link that wrenches w pass on their way to the base.
struct Passage {
  const double *T, *Y;  ///< 6 x columns: w <- w - Y T^T w
  int columns;
  const double* gamma;  ///< 6 x attachments: what they see of w before, gamma^T w
  int attachments;
};

struct ChainKernels {
  const char* name;
  /// Of `blocks` blocks of wrenches, the first of which has row `first` of `seen`, whose columns are a `stride` apart.
  /// There are no rows below 0.
  void (*pass)(const Passage& passage, double* wrenches, int blocks, double* seen, int stride, int first);
};

const ChainKernels& chain_kernels();
/// By name (linalg/processor); null where it does not run here.
const ChainKernels* chain_kernels(const char* name);

}  // namespace sinew::linalg
