// Compiled once for each width of registers, SINEW_LANES doubles, and each kind of number, SINEW_REAL, under the name
// SINEW_KERNELS. It includes nothing of others, so that no function of theirs is compiled for a processor that may not
// be there.
#include "sinew/linalg/kernels.hpp"

namespace sinew::linalg {

extern const Kernels kPortable, kAvx2, kAvx512;
namespace single {
extern const KernelsOf<float> kPortable, kAvx2, kAvx512;
}

namespace {

using Real = SINEW_REAL;
constexpr int kWidth = 8 * SINEW_LANES / sizeof(Real);  ///< numbers in a register
using Lanes [[gnu::vector_size(8 * SINEW_LANES), gnu::aligned(sizeof(Real)), gnu::may_alias]] = Real;

Lanes load(const Real* p) { return *reinterpret_cast<const Lanes*>(p); }
void store(Real* p, const Lanes& v) { *reinterpret_cast<Lanes*>(p) = v; }

/// A tile of C that stays in registers: so many of them down, so many columns across.
constexpr int kDown = SINEW_LANES == 2 ? 4 : 3;
constexpr int kAcross = SINEW_LANES;

struct Product {
  const Real *A, *B;  ///< A (S B^T): rows of A as C's, rows of B as C's columns
  int A_stride, B_stride, depth;
  const Real* signs;           ///< S; null: all positive, or in B already
  const int* begin = nullptr;  ///< of each kLanes rows of A the first column that is not zero; null: all from 0
  int least_begin = 0;         ///< and of the rows of B
  int before = 0;              ///< columns that were left out before the first

  /// Its columns `first` .. before first + count.
  Product part(int first, int count) const {
    Product own = *this;
    own.A += static_cast<long>(first) * A_stride;
    own.B += static_cast<long>(first) * B_stride;
    if (signs) own.signs += first;
    own.before += first;
    own.depth = count;
    return own;
  }
  /// That of `rows` rows from `row` on, without the columns that are zero in all of them.
  Product from(int row, int rows) const {
    Product own = *this;
    own.A += row;
    if (!begin) return own;
    int first = before + depth;
    for (int block = row / kLanes; block * kLanes < row + rows; ++block)
      first = begin[block] < first ? begin[block] : first;
    first = (first < least_begin ? least_begin : first) - before;
    if (first < 0) first = 0;
    if (first > depth) first = depth;
    return own.part(first, depth - first);
  }
};

/// C <- C - A B^T or -A B^T, for one tile, of which C has the first `count` columns.
template <int down, bool whole>
void tile(Real* C, int stride, const Product& product, int count, bool fresh) {
  Lanes sum[kAcross][down];
#pragma GCC unroll 8
  for (int j = 0; j < kAcross; ++j) {
    const bool there = !fresh && (whole || j < count);
#pragma GCC unroll 8
    for (int i = 0; i < down; ++i) sum[j][i] = there ? load(C + static_cast<long>(j) * stride + kWidth * i) : Lanes{};
  }
  const Real *A = product.A, *B = product.B;
  for (int k = 0; k < product.depth; ++k, A += product.A_stride, B += product.B_stride) {
    Lanes a[down];
#pragma GCC unroll 8
    for (int i = 0; i < down; ++i) a[i] = load(A + kWidth * i);
#pragma GCC unroll 8
    for (int j = 0; j < kAcross; ++j) {
#pragma GCC unroll 8
      for (int i = 0; i < down; ++i) sum[j][i] -= a[i] * B[j];
    }
  }
#pragma GCC unroll 8
  for (int j = 0; j < kAcross; ++j) {
    if (!whole && j >= count) break;
#pragma GCC unroll 8
    for (int i = 0; i < down; ++i) store(C + static_cast<long>(j) * stride + kWidth * i, sum[j][i]);
  }
}

/// The same for the rows `top` .. before `height`, to whole registers.
template <bool whole>
void strip(Real* C, int stride, const Product& product, int top, int height, int count, bool fresh) {
  int row = top;
  const auto tiles = [&]<int down>() {
    for (; row + kWidth * (down - 1) < height; row += kWidth * down) {
      const Product own = product.from(row, kWidth * down);
      if (own.depth > 0 || fresh) tile<down, whole>(C + row, stride, own, count, fresh);
    }
  };
  tiles.template operator()<kDown>();
  tiles.template operator()<1>();
}

/// Rows and columns of A that are worked on at a time, so that they stay in the second cache.
constexpr int kChunk = 240, kDepth = 256;
static_assert(kChunk % (kDown * kWidth) == 0 && kChunk % kAcross == 0);

/// C <- C - A S A^T as in Kernels::update, for the rows `top` .. before `height`; signs go into a copy of the few rows
/// of B. Rows of B beside the last are read, and lead nowhere.
[[gnu::always_inline]] inline void update_rows(Real* C, int C_stride, const Product& product, int top, int height,
                                               int columns, bool fresh) {
  Real signed_B[kDepth * kAcross];
  for (int j = 0; j < columns && j < height; j += kAcross) {
    Product own = product;
    own.B += j;
    if (own.signs) {
      for (int k = 0; k < own.depth; ++k) {
        for (int i = 0; i < kAcross; ++i)
          signed_B[k * kAcross + i] = own.B[static_cast<long>(k) * own.B_stride + i] * own.signs[k];
      }
      own.B = signed_B;
      own.B_stride = kAcross;
      own.signs = nullptr;
    }
    Real* const to = C + static_cast<long>(j) * C_stride;
    const int first = j / kWidth * kWidth, from = first > top ? first : top;
    if (j + kAcross <= columns) {
      strip<true>(to, C_stride, own, from, height, kAcross, fresh);
    } else {
      strip<false>(to, C_stride, own, from, height, columns - j, fresh);
    }
  }
}

/// Signs are all positive but for indefinite matrices.
[[gnu::always_inline]] inline void update(Real* C, int C_stride, Product product, int height, int columns, bool fresh) {
  bool negative = false;
  for (int k = 0; product.signs && k < product.depth; ++k) negative |= product.signs[k] < Real(0);
  if (!negative) product.signs = nullptr;
  const bool large = !product.begin && height > 2 * kChunk;
  const int deep = negative || large ? kDepth : product.depth, high = large ? kChunk : height;
  int k = 0;
  do {
    const Product own = product.part(k, product.depth - k < deep ? product.depth - k : deep);
    for (int top = 0; top < height; top += high)
      update_rows(C, C_stride, own, top, top + high < height ? top + high : height, columns, fresh && k == 0);
    k += deep;
  } while (k < product.depth);
}

void update(Real* C, int C_stride, const Real* A, int A_stride, int height, int columns, int depth, const Real* signs,
            bool fresh) {
  update(C, C_stride, Product{A, A, A_stride, A_stride, depth, signs}, height, columns, fresh);
}

using FourDoubles [[gnu::vector_size(32), gnu::aligned(8), gnu::may_alias]] = double;
using Four [[gnu::vector_size(4 * sizeof(Real)), gnu::aligned(sizeof(Real)), gnu::may_alias]] = Real;

// A whole block's zeros below its columns are written over by the next one.
void start(Real* panel, int stride, int columns, const Block* blocks, int count, const double* numbers) {
  for (int j = 0; j < columns; ++j) {
    Real* const column = panel + static_cast<long>(j) * stride;
    for (int i = j / kWidth * kWidth; i < stride; i += kWidth) store(column + i, Lanes{});
  }
  constexpr std::uint8_t kAll = 7;
  for (int k = 0; k < count; ++k, numbers += kBlockSize) {
    const Block& block = blocks[k];
    Real* to = panel + block.into;
    if (block.rows == kAll && block.columns == kAll) {
#pragma GCC unroll 3
      for (int c = 0; c < 3; ++c, to += stride)
        *reinterpret_cast<Four*>(to) =
            __builtin_convertvector(*reinterpret_cast<const FourDoubles*>(numbers + 4 * c), Four);
      continue;
    }
    for (int c = 0; c < 3; ++c) {
      if (!(block.columns >> c & 1)) continue;
      Real* next = to;
      for (int r = 0; r < 3; ++r) {
        if (block.rows >> r & 1) *next++ = static_cast<Real>(numbers[4 * c + r]);
      }
      to += stride;
    }
  }
}

constexpr int kBlock = 8;  ///< columns of a panel that are factored together

/// Columns to the right of each other on the same rows: X <- X L^-T, L with ones on its diagonal, times `scale`.
template <int columns>
void divide(Real* P, int stride, int rows, const Real (&L)[kBlock][kBlock], const Real* scale) {
  for (int r = 0; r < rows; r += kWidth) {
    Lanes x[columns];
#pragma GCC unroll 8
    for (int j = 0; j < columns; ++j) {
      x[j] = load(P + static_cast<long>(j) * stride + r);
#pragma GCC unroll 8
      for (int i = 0; i < j; ++i) x[j] -= x[i] * L[j][i];
    }
#pragma GCC unroll 8
    for (int j = 0; j < columns; ++j) store(P + static_cast<long>(j) * stride + r, x[j] * scale[j]);
  }
}

/// work.operator()<count>() for a count that is known at run time, 1 to kBlock.
template <class Work>
[[gnu::always_inline]] inline auto with_count(int count, const Work& work) {
  switch (count) {
    case 1:
      return work.template operator()<1>();
    case 2:
      return work.template operator()<2>();
    case 3:
      return work.template operator()<3>();
    case 4:
      return work.template operator()<4>();
    case 5:
      return work.template operator()<5>();
    case 6:
      return work.template operator()<6>();
    case 7:
      return work.template operator()<7>();
    default:
      return work.template operator()<8>();
  }
}

void divide(int columns, Real* P, int stride, int rows, const Real (&L)[kBlock][kBlock], const Real* scale) {
  with_count(columns, [&]<int count>() { divide<count>(P, stride, rows, L, scale); });
}

/// What factor_profile says of a matrix; nothing of any other.
struct Profile {
  const int* begin = nullptr;
  const Real* least = nullptr;
};

/// A column of a square, in kSlices registers.
constexpr int kSlice = kWidth < kBlock ? kWidth : kBlock, kSlices = kBlock / kSlice;
using Slice [[gnu::vector_size(sizeof(Real) * kSlice), gnu::aligned(sizeof(Real)), gnu::may_alias]] = Real;
using Truth = decltype(Slice{} < Slice{});
Slice load_slice(const Real* p) { return *reinterpret_cast<const Slice*>(p); }
void store_slice(Real* p, const Slice& v) { *reinterpret_cast<Slice*>(p) = v; }

/// Numbers of the lanes of slice p.
Truth numbered(int p) {
  Truth lane;
  for (int i = 0; i < kSlice; ++i) lane[i] = p * kSlice + i;
  return lane;
}

/// A square on the diagonal, factored as L D L^T: what rows below it are divided by, and the inverse of P.
struct Square {
  Real pivot[kBlock], inverse[kBlock];  ///< D and its inverse
  Real sign[kBlock], scale[kBlock];     ///< S and S |D|^(-1/2)
  Real L[kBlock][kBlock];               ///< by rows; of ones on its diagonal, which are not kept
  Real back[kBlock][kBlock];            ///< rows of P^-1
};

/// The reciprocal of every second pivot is the one before over the determinant of both, and does not wait for that
/// one's reciprocal. Nothing waits for a root, or for a number to change its lane.
template <int count>
bool factor_square(const Real* block, int stride, const Real* least, Square& own) {
  Real A[count][count];  // columns
#pragma GCC unroll 8
  for (int j = 0; j < count; ++j) {
#pragma GCC unroll 8
    for (int i = j; i < count; ++i) A[j][i] = block[static_cast<long>(j) * stride + i];
  }
  Real L[count][count];
  double both = 0.0;  // floats, too, have room for it
#pragma GCC unroll 8
  for (int j = 0; j < count; ++j) {
    Real &d = own.pivot[j], &by = own.inverse[j];
    if (j % 2 == 1 && !least) {
      by = static_cast<Real>(own.pivot[j - 1] / both);
      d = static_cast<Real>(both * own.inverse[j - 1]);
    } else {
      d = least && __builtin_fabs(A[j][j]) < __builtin_fabs(least[j]) ? least[j] : A[j][j];
      by = Real(1) / d;
      if (j + 1 < count)
        both = static_cast<double>(d) * A[j + 1][j + 1] - static_cast<double>(A[j][j + 1]) * A[j][j + 1];
    }
#pragma GCC unroll 8
    for (int k = j + 1; k < count; ++k) {
      L[k][j] = A[j][k] * by;
#pragma GCC unroll 8
      for (int i = k; i < count; ++i) A[k][i] -= A[j][i] * L[k][j];
    }
  }
  bool good = true;
  for (int j = 0; j < count; ++j) {
    const double d = own.pivot[j], size = __builtin_fabs(d), by = __builtin_fabs(own.inverse[j]);
    good &= size > 0.0 && size <= __DBL_MAX__ && by <= __DBL_MAX__;
    own.sign[j] = d < 0.0 ? -Real(1) : Real(1);
    own.scale[j] = own.sign[j] * static_cast<Real>(__builtin_sqrt(by));
  }
#pragma GCC unroll 8
  for (int i = 0; i < count; ++i) {
#pragma GCC unroll 8
    for (int j = 0; j < i; ++j) own.L[i][j] = L[i][j];
  }
  Slice Y[count][kSlices];  // rows of L^-1
#pragma GCC unroll 8
  for (int i = 0; i < count; ++i) {
#pragma GCC unroll 4
    for (int p = 0; p < kSlices; ++p) Y[i][p] = Slice{};
    Y[i][i / kSlice][i % kSlice] = Real(1);
#pragma GCC unroll 8
    for (int j = 0; j < i; ++j) {
      for (int p = 0; p <= j / kSlice; ++p) Y[i][p] -= Y[j][p] * L[i][j];
    }
    const Real by = own.sign[i] * own.scale[i];
#pragma GCC unroll 4
    for (int p = 0; p < kSlices; ++p) store_slice(own.back[i] + p * kSlice, Y[i][p] * by);
  }
  return good;
}

bool factor_square(int columns, const Real* block, int stride, const Real* least, Square& own) {
  return with_count(columns, [&]<int count>() { return factor_square<count>(block, stride, least, own); });
}

bool factor_panel(Real* panel, int stride, int columns, int height, const Profile& profile, Real* pivots, Real* signs) {
  static_assert(kBlock == kLanes);
  bool negative = false;
  for (int first = 0; first < columns; first += kBlock) {
    const int count = columns - first < kBlock ? columns - first : kBlock;
    Real* block = panel + static_cast<long>(first) * stride + first;
    if (first > 0) {
      Product before{panel + first, panel + first, stride, stride, first, negative ? signs : nullptr};
      if (profile.begin) {
        before.begin = profile.begin + first / kLanes;
        before.least_begin = *before.begin;
      }
      update(block, stride, before, height - first, count, false);
    }
    // The square on the diagonal is factored apart; the rows below, by whole registers, are then divided by it.
    Square square;
    if (!factor_square(count, block, stride, profile.least ? profile.least + first : nullptr, square)) return false;
    for (int j = 0; j < count; ++j) {
      pivots[first + j] = square.pivot[j];
      signs[first + j] = square.sign[j];
      negative |= square.sign[j] < Real(0);
    }
    // Runs of rows that have begun.
    const int rows = height - first;
    const auto begun = [&](int row) { return profile.begin[(first + row) / kLanes] < first + count; };
    for (int from = count < kBlock ? 0 : kBlock, end; from < rows; from = end) {
      end = rows;
      if (profile.begin) {
        end = from + kLanes;
        while (end < rows && begun(end) == begun(from)) end += kLanes;
        if (!begun(from)) continue;
      }
      const int own = (end < rows ? end : rows) - from;
      divide(count, block + from, stride, (own + kWidth - 1) / kWidth * kWidth, square.L, square.scale);
    }
    for (int j = 0; j < count; ++j) {
#pragma GCC unroll 4
      for (int p = 0; p < kSlices; ++p) {
        Real* const to = block + static_cast<long>(j) * stride + p * kSlice;
        Slice own = load_slice(square.back[j] + p * kSlice);
        if (count < kBlock) own = numbered(p) < count ? own : load_slice(to);
        store_slice(to, own);
      }
    }
  }
  return true;
}

bool factor(Real* panel, int stride, int columns, int height, Real* pivots, Real* signs) {
  return factor_panel(panel, stride, columns, height, Profile{}, pivots, signs);
}

bool factor_profile(Real* panel, int stride, int columns, const int* begin, const Real* least, Real* pivots,
                    Real* signs) {
  return factor_panel(panel, stride, columns, columns, Profile{begin, least}, pivots, signs);
}

/// to <- to + from for `tail` numbers, fewer than two registers of `width`.
template <int width>
[[gnu::always_inline]] inline void add_tail(const Real* from, Real* to, int tail) {
  using Part [[gnu::vector_size(sizeof(Real) * width), gnu::aligned(sizeof(Real)), gnu::may_alias]] = Real;
  if (tail & width) {
    *reinterpret_cast<Part*>(to) += *reinterpret_cast<const Part*>(from);
    from += width;
    to += width;
  }
  if constexpr (width > 2) {
    add_tail<width / 2>(from, to, tail);
  } else {
    if (tail & 1) *to += *from;
  }
}

/// A rectangle. Its columns are all alike, so that the processor knows what comes.
void add_rectangle(const Real* from, int from_stride, Real* to, int to_stride, int rows, int columns) {
  const int whole = rows / kWidth * kWidth, tail = rows - whole;
  for (int j = 0; j < columns; ++j, from += from_stride, to += to_stride) {
    for (int i = 0; i < whole; i += kWidth) store(to + i, load(to + i) + load(from + i));
    if (tail > 0) add_tail<(kWidth > 2 ? kWidth / 2 : 2)>(from + whole, to + whole, tail);
  }
}

// Run by run of columns, run by run of rows. Above the diagonal numbers without meaning go where nobody reads.
void add(const Real* from, int from_stride, int first, int end, const Run* runs, int count, Real* to, int to_stride,
         int shift) {
  for (int at = 0; at < count && runs[at].row < end; ++at) {
    const int own_first = runs[at].row > first ? runs[at].row : first;
    const int own_end = runs[at].row + runs[at].length < end ? runs[at].row + runs[at].length : end;
    if (own_first >= own_end) continue;
    const Real* own = from + static_cast<long>(own_first) * from_stride;
    Real* column = to + static_cast<long>(runs[at].into + own_first - runs[at].row - shift) * to_stride - shift;
    // What is beside the diagonal.
    add_rectangle(own + own_first, from_stride, column + runs[at].into + own_first - runs[at].row, to_stride,
                  runs[at].row + runs[at].length - own_first, own_end - own_first);
    for (int k = at + 1; k < count; ++k)
      add_rectangle(own + runs[k].row, from_stride, column + runs[k].into, to_stride, runs[k].length,
                    own_end - own_first);
  }
}

void multiply(const Real* A, int stride, int height, int columns, const Real* x, Real* y) {
  constexpr int kRows = 4;  // registers
  const auto rows = [&]<int count>(int at) {
    Lanes sum[count];
    for (int i = 0; i < count; ++i) sum[i] = load(y + at + kWidth * i);
    for (int k = 0; k < columns; ++k) {
      const Real* a = A + static_cast<long>(k) * stride + at;
      for (int i = 0; i < count; ++i) sum[i] -= load(a + kWidth * i) * x[k];
    }
    for (int i = 0; i < count; ++i) store(y + at + kWidth * i, sum[i]);
  };
  int at = 0;
  for (; at + kWidth * kRows <= height; at += kWidth * kRows) rows.template operator()<kRows>(at);
  for (; at < height; at += kWidth) rows.template operator()<1>(at);
}

template <class Register>
Real total(const Register& v) {
  constexpr int kNumbers = sizeof(Register) / sizeof(Real);
  Real sum = v[0];
  for (int i = 1; i < kNumbers; ++i) sum += v[i];
  return sum;
}

/// The sums of four registers' lanes, added by halves.
template <class Register>
void totals(const Register (&v)[4], Real* sums) {
  constexpr int kNumbers = sizeof(Register) / sizeof(Real);
  if constexpr (kNumbers < 4) {
    for (int k = 0; k < 4; ++k) sums[k] = total(v[k]);
  } else {
    Four part[4];
    for (int k = 0; k < 4; ++k) {
      const Four* own = reinterpret_cast<const Four*>(&v[k]);
      part[k] = own[0];
      for (int i = 1; i < kNumbers / 4; ++i) part[k] += own[i];
    }
    const Four low =
        __builtin_shufflevector(part[0], part[1], 0, 4, 2, 6) + __builtin_shufflevector(part[0], part[1], 1, 5, 3, 7);
    const Four high =
        __builtin_shufflevector(part[2], part[3], 0, 4, 2, 6) + __builtin_shufflevector(part[2], part[3], 1, 5, 3, 7);
    *reinterpret_cast<Four*>(sums) =
        __builtin_shufflevector(low, high, 0, 1, 4, 5) + __builtin_shufflevector(low, high, 2, 3, 6, 7);
  }
}

/// `tail`: what is left of y after its whole registers, and zeros. Sums are added up four at a time.
template <int count>
void dots(const Real* A, int stride, int height, const Real* y, const Lanes& tail, Real* x) {
  Lanes sum[4] = {};
  int at = 0;
  for (; at + kWidth <= height; at += kWidth) {
    const Lanes own = load(y + at);
#pragma GCC unroll 4
    for (int k = 0; k < count; ++k) sum[k] += load(A + static_cast<long>(k) * stride + at) * own;
  }
  if (at < height) {
#pragma GCC unroll 4
    for (int k = 0; k < count; ++k) sum[k] += load(A + static_cast<long>(k) * stride + at) * tail;
  }
  Real sums[4];
  totals(sum, sums);
  for (int k = 0; k < count; ++k) x[k] -= sums[k];
}

void multiply_transposed(const Real* A, int stride, int height, int columns, const Real* y, Real* x) {
  Real left[kWidth] = {};
  for (int i = height / kWidth * kWidth; i < height; ++i) left[i % kWidth] = y[i];
  const Lanes tail = load(left);
  int k = 0;
  for (; k + 4 <= columns; k += 4) dots<4>(A + static_cast<long>(k) * stride, stride, height, y, tail, x + k);
  const auto rest = [&]<int count>() {
    dots<count>(A + static_cast<long>(k) * stride, stride, height, y, tail, x + k);
  };
  switch (columns - k) {
    case 3:
      rest.template operator()<3>();
      break;
    case 2:
      rest.template operator()<2>();
      break;
    case 1:
      rest.template operator()<1>();
      break;
    default:
      break;
  }
}

/// x <- P^-1 x, or P^-T x, with a square on the diagonal, whose columns are the rows of P^-1.
template <bool transposed>
void divide_by_square(const Real* block, int stride, int count, Real* x) {
  Real out[kBlock];
  if constexpr (transposed) {
    Slice sum[kSlices] = {};
    for (int j = 0; j < count; ++j) {
#pragma GCC unroll 4
      for (int p = 0; p < kSlices; ++p) sum[p] += load_slice(block + static_cast<long>(j) * stride + p * kSlice) * x[j];
    }
    for (int p = 0; p < kSlices; ++p) store_slice(out + p * kSlice, sum[p]);
  } else {
    Slice own[kSlices];  // beside the square is what is below it
    for (int p = 0; p < kSlices; ++p) own[p] = numbered(p) < count ? load_slice(x + p * kSlice) : Slice{};
    for (int first = 0; first < count; first += 4) {
      Slice sum[4] = {};
#pragma GCC unroll 4
      for (int k = 0; k < 4; ++k) {
        const Real* const column = block + static_cast<long>(first + k) * stride;
        for (int p = 0; first + k < count && p < kSlices; ++p) sum[k] += load_slice(column + p * kSlice) * own[p];
      }
      totals(sum, out + first);
    }
  }
  for (int i = 0; i < count; ++i) x[i] = out[i];
}

// Blocks on the diagonal one by one.
void solve(const Real* panel, int stride, int columns, Real* y) {
  for (int first = 0; first < columns; first += kBlock) {
    const int end = first + kBlock < columns ? first + kBlock : columns;
    const Real* block = panel + static_cast<long>(first) * (stride + 1);
    divide_by_square<false>(block, stride, end - first, y + first);
    if (end < columns) multiply(block + kBlock, stride, columns - end, kBlock, y + first, y + end);
  }
}

void solve_transposed(const Real* panel, int stride, int columns, Real* x) {
  for (int first = (columns - 1) / kBlock * kBlock; first >= 0; first -= kBlock) {
    const int end = first + kBlock < columns ? first + kBlock : columns;
    const Real* block = panel + static_cast<long>(first) * (stride + 1);
    if (end < columns) multiply_transposed(block + kBlock, stride, columns - end, kBlock, x + end, x + first);
    divide_by_square<true>(block, stride, end - first, x + first);
  }
}

}  // namespace

const KernelsOf<Real> SINEW_KERNELS{SINEW_NAME, start, factor,           factor_profile, update,
                                    add,        solve, solve_transposed, multiply,       multiply_transposed};

}  // namespace sinew::linalg
