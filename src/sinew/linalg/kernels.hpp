// The dense work of a factorisation, in registers as wide as the processor has. README.md says what they compute.
#pragma once

namespace sinew::linalg {

/// Registers hold 2, 4 or 8 doubles. Tails of columns are worked on as if there were as many rows as fill eight, so
/// that many must be there to be read, and where a kernel adds to them to be written: strides are multiples of eight.
inline constexpr int kLanes = 8;
constexpr int whole_lanes(int n) { return (n + kLanes - 1) / kLanes * kLanes; }

/// Rows of one matrix that are rows of another, one after the other in both.
struct Run {
  int row = 0, into = 0, length = 0;
};

/// One set of kernels, for matrices by columns; a stride is the way from one column to the next.
struct Kernels {
  const char* name;

  /// Factors a panel of `columns` columns, P <- L |D|^(1/2) where P = L D [its upper part]^T and L has ones on its
  /// diagonal. Above the diagonal anything is left. False where a pivot, an entry of D, is zero or not finite.
  bool (*factor)(double* panel, int stride, int columns, int height, double* pivots, double* signs);

  /// The same of a square one whose rows begin with zeros, which stay: `begin` has the first column that is not zero of
  /// each kLanes rows. A pivot smaller than the size of its number in `least` is replaced by that number.
  bool (*factor_profile)(double* panel, int stride, int columns, const int* begin, const double* least, double* pivots,
                         double* signs);

  /// C <- C - A S A^T, or -A S A^T where C is `fresh`: its first `columns` columns from the diagonal down to `height`;
  /// beside the diagonal anything is left above it. A is height x depth, `signs` the diagonal of S.
  void (*update)(double* C, int C_stride, const double* A, int A_stride, int height, int columns, int depth,
                 const double* signs, bool fresh);

  /// Adds columns first .. before end of a lower triangle to columns of another matrix, whose rows and columns are
  /// given by runs; `shift` is taken off both.
  void (*add)(const double* from, int from_stride, int first, int end, const Run* runs, int count, double* to,
              int to_stride, int shift);

  /// y <- P^-1 y and x <- P^-T x with the square on top of a factored panel.
  void (*solve)(const double* panel, int stride, int columns, double* y);
  void (*solve_transposed)(const double* panel, int stride, int columns, double* x);

  /// y <- y - A x (y: whole lanes of `height`) and x <- x - A^T y, A: height x columns.
  void (*multiply)(const double* A, int stride, int height, int columns, const double* x, double* y);
  void (*multiply_transposed)(const double* A, int stride, int height, int columns, const double* y, double* x);
};

/// The fastest that runs on this processor.
const Kernels& kernels();
/// By name (linalg/processor); null where it does not run here.
const Kernels* kernels(const char* name);

}  // namespace sinew::linalg
