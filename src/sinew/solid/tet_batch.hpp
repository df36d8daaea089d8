// Linear tetrahedra of the corotational law, eight at a time: the formulas of solid/corotational and of the viscous
// potential (solid/elasticity) for elements of constant strain, written out for registers. README.md derives them.
#pragma once

#include <cstdint>

namespace sinew::solid {

inline constexpr int kBatch = 8;

/// A number of each element of a batch.
using Eight = double[kBatch];

/// Eight elements; what is left over in the last batch of a body has no volume.
struct TetBatch {
  Eight gradient[3][3];  ///< [1/m] of the shape functions of nodes 0, 1, 2, by axis; the fourth's is minus their sum
  Eight mu, lambda;      ///< [N m] Lame's numbers times the volume
  Eight viscous_mu, viscous_lambda;  ///< [N m s]
  int node[4][kBatch];
  int cell[kBatch];
  int count = 0;
};

/// Forces of the nodes, by axis: 2 mu (F - R) + lambda tr(R^T F - 1) R and its viscous counterpart, times gradients.
struct TetForces {
  Eight elastic[4][3], viscous[4][3];  ///< [N]
};

/// On and below the diagonal, block (a, b) of nodes a >= b at a (a + 1) / 2 + b, its entries by columns.
struct TetStiffness {
  Eight block[10][9];  ///< [N/m]
};

/// Where the blocks of each element go: entry (i, j) of one is added at i + 4 j from there, and a zero at 3 + 4 j.
struct TetPlaces {
  std::uint32_t block[10][kBatch];
};

/// One set of kernels (linalg/kernels). Both return a bit for each element whose rotation they did not find, flat or
/// inside out, say; what they give of those means nothing.
struct TetKernels {
  const char* name;
  /// x, start: 3 x nodes [m]; rate [1/s], 0: no viscous forces.
  unsigned (*forces)(const TetBatch& batch, const double* x, const double* start, double rate, TetForces& forces);
  /// The definite tangent: that of linear elasticity in the frame R, and of the viscous forces without their stress.
  unsigned (*stiffness)(const TetBatch& batch, const double* x, double rate, TetStiffness& stiffness);
  /// Adds the blocks of all eight elements.
  void (*add)(const TetStiffness& stiffness, const TetPlaces& places, double* numbers);
};

const TetKernels& tet_kernels();
/// By name (linalg/processor); null where it does not run here.
const TetKernels* tet_kernels(const char* name);

}  // namespace sinew::solid
