// The dense work of a factorisation, in registers as wide as the processor has. README.md says what they compute.
#pragma once

#include <cstdint>

namespace sinew::linalg {

/// Registers hold up to so many numbers. Tails of columns are worked on as if there were as many rows as fill one, so
/// that many must be there to be read, and where a kernel adds to them to be written: strides are multiples of it.
template <class Real>
inline constexpr int kLanesOf = 64 / static_cast<int>(sizeof(Real));
inline constexpr int kLanes = kLanesOf<double>;
constexpr int whole_lanes(int n, int lanes = kLanes) { return (n + lanes - 1) / lanes * lanes; }

/// The entries of two nodes, while a matrix is put together: four rows to a column, the last one zero, three columns,
/// by slots, the coordinates of a node. Rows are those of the node that is eliminated later.
inline constexpr int kBlockSize = 12;
struct Block {
  std::uint32_t into = 0;              ///< of the first entry, in the panel
  std::uint8_t rows = 0, columns = 0;  ///< which slots are unknowns, a bit each
};

/// Rows of one matrix that are rows of another, one after the other in both.
struct Run {
  int row = 0, into = 0, length = 0;
};

/// One set of kernels, for matrices by columns; a stride is the way from one column to the next.
template <class Real>
struct KernelsOf {
  const char* name;

  /// A panel that is zero from its diagonal down but for `count` blocks, by columns, each column's from the diagonal
  /// down. Their numbers stand one after the other. A row below the last must be there to be written.
  void (*start)(Real* panel, int stride, int columns, const Block* blocks, int count, const double* numbers);

  /// Factors a panel of `columns` columns, P <- L |D|^(1/2) where P = L D [its upper part]^T and L has ones on its
  /// diagonal. The squares of kLanes columns on P's diagonal give their places to their transposed inverses, upper
  /// triangles; farther above the diagonal anything is left. False where a pivot, an entry of D, or a product of two,
  /// in doubles, is zero or not finite.
  bool (*factor)(Real* panel, int stride, int columns, int height, Real* pivots, Real* signs);

  /// The same of a square one whose rows begin with zeros, which stay: `begin` has the first column that is not zero of
  /// each kLanes rows. A pivot smaller than the size of its number in `least` is replaced by that number.
  bool (*factor_profile)(Real* panel, int stride, int columns, const int* begin, const Real* least, Real* pivots,
                         Real* signs);

  /// C <- C - A S A^T, or -A S A^T where C is `fresh`: its first `columns` columns from the diagonal down to `height`;
  /// beside the diagonal anything is left above it. A is height x depth, `signs` the diagonal of S; null: all are
  /// positive.
  void (*update)(Real* C, int C_stride, const Real* A, int A_stride, int height, int columns, int depth,
                 const Real* signs, bool fresh);

  /// Adds columns first .. before end of a lower triangle to columns of another matrix, whose rows and columns are
  /// given by runs; `shift` is taken off both.
  void (*add)(const Real* from, int from_stride, int first, int end, const Run* runs, int count, Real* to,
              int to_stride, int shift);

  /// y <- P^-1 y (y: whole lanes) and x <- P^-T x with the square on top of a factored panel.
  void (*solve)(const Real* panel, int stride, int columns, Real* y);
  void (*solve_transposed)(const Real* panel, int stride, int columns, Real* x);

  /// y <- y - A x (y: whole lanes of `height`) and x <- x - A^T y, A: height x columns.
  void (*multiply)(const Real* A, int stride, int height, int columns, const Real* x, Real* y);
  void (*multiply_transposed)(const Real* A, int stride, int height, int columns, const Real* y, Real* x);
};
using Kernels = KernelsOf<double>;

/// The fastest that runs on this processor.
const Kernels& kernels();
/// By name (linalg/processor); null where it does not run here.
const Kernels* kernels(const char* name);
/// The same of floats.
namespace single {
const KernelsOf<float>& kernels();
const KernelsOf<float>* kernels(const char* name);
}  // namespace single

}  // namespace sinew::linalg
