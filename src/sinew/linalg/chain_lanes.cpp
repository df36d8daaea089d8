// Compiled once for each width of registers, as kernels_lanes.cpp: it includes nothing of others.
#include "sinew/linalg/chain_kernels.hpp"
#include "sinew/linalg/lanes.hpp"

namespace sinew::linalg {

namespace chain {
extern const ChainKernels SINEW_KERNELS;
}

namespace {

using namespace lanes;

/// v . w of each wrench.
Lanes dot(const double* v, const Lanes (&w)[6]) {
  return (v[0] * w[0] + v[1] * w[1] + v[2] * w[2]) + (v[3] * w[3] + v[4] * w[4] + v[5] * w[5]);
}

void pass(const Passage& passage, double* wrenches, int blocks, double* seen, int stride, int first) {
  for (int at = 0; at < blocks * kWrenches; at += kWidth) {
    double* const own = wrenches + at / kWrenches * kWrenchNumbers + at % kWrenches;
    Lanes before[6];
    for (int c = 0; c < 6; ++c) before[c] = load(own + c * kWrenches);
    for (int i = 0; i < passage.attachments; ++i) {
      const Lanes row = dot(passage.gamma + 6L * i, before);
      double* const column = seen + static_cast<long>(i) * stride;
      const int at_row = first + at;
      if (at_row >= 0) {
        store(column + at_row, row);
      } else {
        for (int k = -at_row; k < kWidth; ++k) column[at_row + k] = row[k];
      }
    }
    Lanes after[6];
    for (int c = 0; c < 6; ++c) after[c] = before[c];
    for (int j = 0; j < passage.columns; ++j) {
      const Lanes felt = dot(passage.T + 6L * j, before);
      const double* const Y = passage.Y + 6L * j;
      for (int c = 0; c < 6; ++c) after[c] -= Y[c] * felt;
    }
    for (int c = 0; c < 6; ++c) store(own + c * kWrenches, after[c]);
  }
}

}  // namespace

const ChainKernels chain::SINEW_KERNELS{SINEW_NAME, pass};

}  // namespace sinew::linalg
