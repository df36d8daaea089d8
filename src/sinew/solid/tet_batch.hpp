// Linear tetrahedra of the corotational law, eight at a time: the formulas of solid/corotational and of the viscous
// potential (solid/elasticity) for elements of constant strain, written out for registers. README.md derives them.
#pragma once

#include <cstdint>

namespace sinew::solid {

inline constexpr int kBatch = 8;
inline constexpr int kLine = 64;  ///< [bytes] of the cache

/// A number of each element of a batch.
using Eight = double[kBatch];

/// Eight elements; what is left over in the last batch of a body has no volume.
struct alignas(kLine) TetBatch {
  Eight gradient[3][3];  ///< [1/m] of the shape functions of nodes 0, 1, 2, by axis; the fourth's is minus their sum
  Eight mu, lambda;      ///< [N m] Lame's numbers times the volume
  Eight viscous_mu, viscous_lambda;  ///< [N m s]
  int node[4][kBatch];
  int cell[kBatch];
  int count = 0;
};

/// The deformation gradients of a batch's elements and their rotations, by columns.
struct alignas(kLine) TetFrames {
  Eight F[3][3], R[3][3];
  unsigned missing = 0;  ///< a bit for each element whose rotation was not found, flat or inside out, say
};

/// On and below the diagonal, block (a, b) of nodes a >= b at a (a + 1) / 2 + b, its entries by columns.
struct alignas(kLine) TetStiffness {
  Eight block[10][9];  ///< [N/m]
};

/// Where the blocks of each element go: entry (i, j) of one is added at i + 4 j from there, and a zero at 3 + 4 j.
struct TetPlaces {
  std::uint32_t block[10][kBatch];
};

/// Numbers in a node's record: two vectors, a zero behind each.
inline constexpr int kRecord = 8;

/// One set of kernels (linalg/kernels). `nodes`: records of x and x - x_0 [m].
struct TetKernels {
  const char* name;
  /// Finds the frames of `count` batches, and adds to the records of the nodes' forces [N], elastic and viscous ones,
  /// 2 mu (F - R) + lambda tr(R^T F - 1) R and its viscous counterpart, times gradients; those of missing elements go
  /// to the node `nowhere`. `rate` [1/s], 0: no viscous forces.
  void (*add_forces)(const TetBatch* batches, int count, const double* nodes, double rate, int nowhere,
                     TetFrames* frames, double* forces);
  /// The definite tangent: that of linear elasticity in the frame R, and of the viscous forces without their stress.
  /// `exact`: the derivative of the forces. Both give nothing of use for elements that are missing.
  void (*definite)(const TetBatch& batch, const TetFrames& frames, double rate, TetStiffness& stiffness);
  void (*exact)(const TetBatch& batch, const TetFrames& frames, const double* nodes, double rate,
                TetStiffness& stiffness);
  /// Adds the blocks of all eight elements.
  void (*add)(const TetStiffness& stiffness, const TetPlaces& places, double* numbers);
};

const TetKernels& tet_kernels();
/// By name (linalg/processor); null where it does not run here.
const TetKernels* tet_kernels(const char* name);

}  // namespace sinew::solid
