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
  const Real* signs;           ///< S; null: those of B are in it already
  Real sign = Real(1);         ///< of all, where they are alike
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

/// C <- C - A S B^T or -A S B^T, for one tile.
template <int down, int across>
void tile(Real* C, int stride, const Product& product, bool fresh) {
  Lanes sum[across][down];
#pragma GCC unroll 8
  for (int j = 0; j < across; ++j) {
#pragma GCC unroll 8
    for (int i = 0; i < down; ++i) sum[j][i] = Lanes{};
  }
  const Real *A = product.A, *B = product.B;
  for (int k = 0; k < product.depth; ++k, A += product.A_stride, B += product.B_stride) {
    Lanes a[down];
#pragma GCC unroll 8
    for (int i = 0; i < down; ++i) a[i] = load(A + kWidth * i);
#pragma GCC unroll 8
    for (int j = 0; j < across; ++j) {
#pragma GCC unroll 8
      for (int i = 0; i < down; ++i) sum[j][i] -= a[i] * B[j];
    }
  }
#pragma GCC unroll 8
  for (int j = 0; j < across; ++j) {
    Real* c = C + static_cast<long>(j) * stride;
#pragma GCC unroll 8
    for (int i = 0; i < down; ++i) {
      const Lanes own = sum[j][i] * product.sign;
      store(c + kWidth * i, fresh ? own : load(c + kWidth * i) + own);
    }
  }
}

/// The same for the rows `top` .. before `height`, to whole registers, of `across` columns.
template <int across>
void strip(Real* C, int stride, const Product& product, int top, int height, bool fresh) {
  int row = top;
  const auto tiles = [&]<int down>() {
    for (; row + kWidth * (down - 1) < height; row += kWidth * down) {
      const Product own = product.from(row, kWidth * down);
      if (own.depth > 0 || fresh) tile<down, across>(C + row, stride, own, fresh);
    }
  };
  tiles.template operator()<kDown>();
  tiles.template operator()<1>();
}

/// Rows and columns of A that are worked on at a time, so that they stay in the second cache.
constexpr int kChunk = 240, kDepth = 256;
static_assert(kChunk % (kDown * kWidth) == 0 && kChunk % kAcross == 0);

/// C <- C - A S A^T as in Kernels::update, for the rows `top` .. before `height`; signs that differ go into a copy of
/// the few rows of B.
void update_rows(Real* C, int C_stride, const Product& product, int top, int height, int columns, bool fresh) {
  int j = 0;
  Real signed_B[kDepth * kAcross];
  const auto strips = [&]<int across>() {
    for (; j + across <= columns && j < height; j += across) {
      Product own = product;
      own.B += j;
      if (own.signs) {
        for (int k = 0; k < own.depth; ++k) {
          for (int i = 0; i < across; ++i)
            signed_B[k * across + i] = own.B[static_cast<long>(k) * own.B_stride + i] * own.signs[k];
        }
        own.B = signed_B;
        own.B_stride = across;
        own.signs = nullptr;
      }
      const int first = j / kWidth * kWidth;
      strip<across>(C + static_cast<long>(j) * C_stride, C_stride, own, first > top ? first : top, height, fresh);
    }
  };
  strips.template operator()<kAcross>();
  if constexpr (kAcross > 4) strips.template operator()<4>();
  if constexpr (kAcross > 2) strips.template operator()<2>();
  strips.template operator()<1>();
}

/// Signs differ rarely: where an indefinite matrix changes its sign.
void update(Real* C, int C_stride, Product product, int height, int columns, bool fresh) {
  bool mixed = false;
  for (int k = 1; k < product.depth; ++k) mixed |= product.signs[k] != product.signs[0];
  if (!mixed) {
    product.sign = product.depth > 0 ? product.signs[0] : Real(1);
    product.signs = nullptr;
  }
  const bool large = !product.begin && height > 2 * kChunk;
  const int deep = mixed || large ? kDepth : product.depth, high = large ? kChunk : height;
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

constexpr int kBlock = 8;  ///< columns of a panel that are factored together

/// Columns to the right of each other on the same rows: X <- X U^-1, U[i][j] = signs[i] P[j, i].
template <int columns>
void divide(Real* P, int stride, int rows, const Real (&U)[kBlock][kBlock], const Real* inverse) {
  for (int r = 0; r < rows; r += kWidth) {
    Lanes x[columns];
#pragma GCC unroll 8
    for (int j = 0; j < columns; ++j) {
      x[j] = load(P + static_cast<long>(j) * stride + r);
#pragma GCC unroll 8
      for (int i = 0; i < j; ++i) x[j] -= x[i] * U[i][j];
      x[j] *= inverse[j];
    }
#pragma GCC unroll 8
    for (int j = 0; j < columns; ++j) store(P + static_cast<long>(j) * stride + r, x[j]);
  }
}

void divide(int columns, Real* P, int stride, int rows, const Real (&U)[kBlock][kBlock], const Real* inverse) {
  switch (columns) {
    case 1:
      return divide<1>(P, stride, rows, U, inverse);
    case 2:
      return divide<2>(P, stride, rows, U, inverse);
    case 3:
      return divide<3>(P, stride, rows, U, inverse);
    case 4:
      return divide<4>(P, stride, rows, U, inverse);
    case 5:
      return divide<5>(P, stride, rows, U, inverse);
    case 6:
      return divide<6>(P, stride, rows, U, inverse);
    case 7:
      return divide<7>(P, stride, rows, U, inverse);
    default:
      return divide<8>(P, stride, rows, U, inverse);
  }
}

/// What factor_profile says of a matrix; nothing of any other.
struct Profile {
  const int* begin = nullptr;
  const Real* least = nullptr;
};

bool factor_panel(Real* panel, int stride, int columns, int height, const Profile& profile, Real* pivots, Real* signs) {
  static_assert(kBlock == kLanes);
  for (int first = 0; first < columns; first += kBlock) {
    const int count = columns - first < kBlock ? columns - first : kBlock;
    Real* block = panel + static_cast<long>(first) * stride + first;
    if (first > 0) {
      Product before{panel + first, panel + first, stride, stride, first, signs};
      if (profile.begin) {
        before.begin = profile.begin + first / kLanes;
        before.least_begin = *before.begin;
      }
      update(block, stride, before, height - first, count, false);
    }
    // The square on the diagonal is factored apart; all rows, its own too, are then divided by it.
    Real square[kBlock][kBlock], U[kBlock][kBlock], inverse[kBlock], root[kBlock];
    for (int j = 0; j < count; ++j) {
      for (int r = j; r < count; ++r) {
        square[j][r] = block[static_cast<long>(j) * stride + r];
        for (int i = 0; i < j; ++i) square[j][r] -= square[i][r] * U[i][j];
      }
      Real& d = square[j][j];
      if (profile.least && __builtin_fabs(d) < __builtin_fabs(profile.least[first + j])) d = profile.least[first + j];
      const Real size = d < Real(0) ? -d : d, sign = d < Real(0) ? -Real(1) : Real(1);
      if (!(size > Real(0)) || !(size <= __DBL_MAX__)) return false;
      pivots[first + j] = d;
      signs[first + j] = sign;
      root[j] = static_cast<Real>(__builtin_sqrt(size));
      inverse[j] = sign / root[j];
      for (int r = j; r < count; ++r) {
        square[j][r] *= inverse[j];
        U[j][r] = sign * square[j][r];
      }
    }
    // Runs of rows that have begun.
    const int rows = height - first;
    const auto begun = [&](int row) { return profile.begin[(first + row) / kLanes] < first + count; };
    for (int from = 0, end; from < rows; from = end) {
      end = rows;
      if (profile.begin) {
        end = from + kLanes;
        while (end < rows && begun(end) == begun(from)) end += kLanes;
        if (!begun(from)) continue;
      }
      const int own = (end < rows ? end : rows) - from;
      divide(count, block + from, stride, (own + kWidth - 1) / kWidth * kWidth, U, inverse);
    }
    for (int j = 0; j < count; ++j) block[static_cast<long>(j) * stride + j] = root[j];  // also where d was replaced
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

Real total(const Lanes& v) {
  Real sum = v[0];
  for (int i = 1; i < kWidth; ++i) sum += v[i];
  return sum;
}

/// The sums of four registers' lanes, added by halves.
void totals(const Lanes (&v)[4], Real* sums) {
  if constexpr (kWidth < 4) {
    for (int k = 0; k < 4; ++k) sums[k] = total(v[k]);
  } else {
    using Four [[gnu::vector_size(4 * sizeof(Real)), gnu::aligned(sizeof(Real)), gnu::may_alias]] = Real;
    Four part[4];
    for (int k = 0; k < 4; ++k) {
      const Four* own = reinterpret_cast<const Four*>(&v[k]);
      part[k] = own[0];
      for (int i = 1; i < kWidth / 4; ++i) part[k] += own[i];
    }
    const Four low =
        __builtin_shufflevector(part[0], part[1], 0, 4, 2, 6) + __builtin_shufflevector(part[0], part[1], 1, 5, 3, 7);
    const Four high =
        __builtin_shufflevector(part[2], part[3], 0, 4, 2, 6) + __builtin_shufflevector(part[2], part[3], 1, 5, 3, 7);
    *reinterpret_cast<Four*>(sums) =
        __builtin_shufflevector(low, high, 0, 1, 4, 5) + __builtin_shufflevector(low, high, 2, 3, 6, 7);
  }
}

template <int count>
void dots(const Real* A, int stride, int height, const Real* y, Real* x) {
  Lanes sum[count] = {};
  int at = 0;
  for (; at + kWidth <= height; at += kWidth) {
    const Lanes own = load(y + at);
#pragma GCC unroll 4
    for (int k = 0; k < count; ++k) sum[k] += load(A + static_cast<long>(k) * stride + at) * own;
  }
  if (at < height) {
    Lanes own = {};
    for (int i = at; i < height; ++i) own[i - at] = y[i];
#pragma GCC unroll 4
    for (int k = 0; k < count; ++k) sum[k] += load(A + static_cast<long>(k) * stride + at) * own;
  }
  Real sums[count];
  if constexpr (count == 4) {
    totals(sum, sums);
  } else {
    for (int k = 0; k < count; ++k) sums[k] = total(sum[k]);
  }
  for (int k = 0; k < count; ++k) x[k] -= sums[k];
}

void multiply_transposed(const Real* A, int stride, int height, int columns, const Real* y, Real* x) {
  int k = 0;
  for (; k + 4 <= columns; k += 4) dots<4>(A + static_cast<long>(k) * stride, stride, height, y, x + k);
  for (; k < columns; ++k) dots<1>(A + static_cast<long>(k) * stride, stride, height, y, x + k);
}

// Blocks on the diagonal one by one; y and x have whole lanes.
void solve(const Real* panel, int stride, int columns, Real* y) {
  for (int first = 0; first < columns; first += kBlock) {
    const int end = first + kBlock < columns ? first + kBlock : columns;
    for (int j = first; j < end; ++j) {
      const Real* column = panel + static_cast<long>(j) * stride;
      y[j] /= column[j];
      for (int r = j + 1; r < end; ++r) y[r] -= column[r] * y[j];
    }
    if (end < columns)
      multiply(panel + static_cast<long>(first) * stride + end, stride, columns - end, kBlock, y + first, y + end);
  }
}

void solve_transposed(const Real* panel, int stride, int columns, Real* x) {
  for (int first = (columns - 1) / kBlock * kBlock; first >= 0; first -= kBlock) {
    const int end = first + kBlock < columns ? first + kBlock : columns;
    multiply_transposed(panel + static_cast<long>(first) * stride + end, stride, columns - end, end - first, x + end,
                        x + first);
    for (int j = end - 1; j >= first; --j) {
      const Real* column = panel + static_cast<long>(j) * stride;
      for (int r = j + 1; r < end; ++r) x[j] -= column[r] * x[r];
      x[j] /= column[j];
    }
  }
}

}  // namespace

const KernelsOf<Real> SINEW_KERNELS{SINEW_NAME,       factor,   factor_profile,     update, add, solve,
                                    solve_transposed, multiply, multiply_transposed};

}  // namespace sinew::linalg
