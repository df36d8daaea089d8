// Compiled once for each width of registers: SINEW_LANES doubles, under the name SINEW_KERNELS. It includes nothing of
// others, so that no function of theirs is compiled for a processor that may not be there.
#include "sinew/linalg/kernels.hpp"

namespace sinew::linalg {

extern const Kernels SINEW_KERNELS;

namespace {

constexpr int kWidth = SINEW_LANES;  ///< doubles in a register
using Lanes [[gnu::vector_size(8 * SINEW_LANES), gnu::aligned(8), gnu::may_alias]] = double;

Lanes load(const double* p) { return *reinterpret_cast<const Lanes*>(p); }
void store(double* p, const Lanes& v) { *reinterpret_cast<Lanes*>(p) = v; }

/// A tile of C that stays in registers: so many of them down, so many columns across.
constexpr int kDown = kWidth == 8 ? 3 : kWidth == 4 ? 3 : 4;
constexpr int kAcross = kWidth == 8 ? 8 : kWidth == 4 ? 4 : 2;

struct Product {
  const double *A, *B;  ///< A (S B^T): rows of A as C's, rows of B as C's columns
  int stride, depth;
  const double* signs;
  double sign = 1.0;           ///< of all, where they are alike
  const int* begin = nullptr;  ///< of each kLanes rows of A the first column that is not zero; null: all from 0
  int least_begin = 0;         ///< and of the rows of B

  /// That of `rows` rows from `row` on, without the columns that are zero in all of them.
  Product from(int row, int rows) const {
    Product own = *this;
    own.A += row;
    if (!begin) return own;
    int first = depth;
    for (int block = row / kLanes; block * kLanes < row + rows; ++block)
      first = begin[block] < first ? begin[block] : first;
    if (first < least_begin) first = least_begin;
    if (first > depth) first = depth;
    own.A += static_cast<long>(first) * stride;
    own.B += static_cast<long>(first) * stride;
    own.signs += first;
    own.depth -= first;
    return own;
  }
};

/// C <- C - A S B^T or -A S B^T, for one tile.
template <int down, int across, bool turned>
void tile(double* C, int stride, const Product& product, bool fresh) {
  Lanes sum[across][down];
#pragma GCC unroll 8
  for (int j = 0; j < across; ++j) {
#pragma GCC unroll 8
    for (int i = 0; i < down; ++i) sum[j][i] = Lanes{};
  }
  const double *A = product.A, *B = product.B;
  for (int k = 0; k < product.depth; ++k, A += product.stride, B += product.stride) {
    Lanes a[down];
#pragma GCC unroll 8
    for (int i = 0; i < down; ++i) a[i] = load(A + kWidth * i);
#pragma GCC unroll 8
    for (int j = 0; j < across; ++j) {
      const double b = turned ? B[j] * product.signs[k] : B[j];
#pragma GCC unroll 8
      for (int i = 0; i < down; ++i) sum[j][i] -= a[i] * b;
    }
  }
#pragma GCC unroll 8
  for (int j = 0; j < across; ++j) {
    double* c = C + static_cast<long>(j) * stride;
#pragma GCC unroll 8
    for (int i = 0; i < down; ++i) {
      const Lanes own = turned ? sum[j][i] : sum[j][i] * product.sign;
      store(c + kWidth * i, fresh ? own : load(c + kWidth * i) + own);
    }
  }
}

/// The same for the rows `top` .. before `height`, to whole registers, of `across` columns.
template <int across, bool turned>
void strip(double* C, int stride, const Product& product, int top, int height, bool fresh) {
  int row = top;
  const auto tiles = [&]<int down>() {
    for (; row + kWidth * (down - 1) < height; row += kWidth * down) {
      const Product own = product.from(row, kWidth * down);
      if (own.depth > 0 || fresh) tile<down, across, turned>(C + row, stride, own, fresh);
    }
  };
  tiles.template operator()<kDown>();
  tiles.template operator()<1>();
}

/// Rows and columns of A that are worked on at a time, so that they stay in the second cache.
constexpr int kChunk = 240, kDepth = 256;
static_assert(kChunk % (kDown * kWidth) == 0 && kChunk % kAcross == 0);

/// C <- C - A S A^T as in Kernels::update, for the rows `top` .. before `height`.
template <bool turned>
void update_rows(double* C, int C_stride, const Product& product, int top, int height, int columns, bool fresh) {
  int j = 0;
  const auto strips = [&]<int across>() {
    for (; j + across <= columns && j < height; j += across) {
      Product own = product;
      own.B += j;
      const int first = j / kWidth * kWidth;
      strip<across, turned>(C + static_cast<long>(j) * C_stride, C_stride, own, first > top ? first : top, height,
                            fresh);
    }
  };
  strips.template operator()<kAcross>();
  if constexpr (kAcross > 4) strips.template operator()<4>();
  if constexpr (kAcross > 2) strips.template operator()<2>();
  strips.template operator()<1>();
}

template <bool turned>
void rank_update(double* C, int C_stride, const Product& product, int height, int columns, bool fresh) {
  if (product.begin || height <= 2 * kChunk) {
    update_rows<turned>(C, C_stride, product, 0, height, columns, fresh);
    return;
  }
  for (int k = 0; k < product.depth; k += kDepth) {
    Product own = product;
    own.A += static_cast<long>(k) * own.stride;
    own.B = own.A;
    own.signs += k;
    own.depth = product.depth - k < kDepth ? product.depth - k : kDepth;
    for (int top = 0; top < height; top += kChunk)
      update_rows<turned>(C, C_stride, own, top, top + kChunk < height ? top + kChunk : height, columns,
                          fresh && k == 0);
  }
}

void update(double* C, int C_stride, Product product, int height, int columns, bool fresh) {
  bool mixed = false;  // rarely: where an indefinite matrix changes its sign
  for (int k = 1; k < product.depth; ++k) mixed |= product.signs[k] != product.signs[0];
  product.sign = product.depth > 0 ? product.signs[0] : 1.0;
  if (mixed) {
    rank_update<true>(C, C_stride, product, height, columns, fresh);
  } else {
    rank_update<false>(C, C_stride, product, height, columns, fresh);
  }
}

void update(double* C, int C_stride, const double* A, int A_stride, int height, int columns, int depth,
            const double* signs, bool fresh) {
  update(C, C_stride, Product{A, A, A_stride, depth, signs}, height, columns, fresh);
}

constexpr int kBlock = 8;  ///< columns of a panel that are factored together

/// Columns to the right of each other on the same rows: X <- X U^-1, U[i][j] = signs[i] P[j, i].
template <int columns>
void divide(double* P, int stride, int rows, const double (&U)[kBlock][kBlock], const double* inverse) {
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

void divide(int columns, double* P, int stride, int rows, const double (&U)[kBlock][kBlock], const double* inverse) {
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
  const double* least = nullptr;
};

bool factor_panel(double* panel, int stride, int columns, int height, const Profile& profile, double* pivots,
                  double* signs) {
  static_assert(kBlock == kLanes);
  for (int first = 0; first < columns; first += kBlock) {
    const int count = columns - first < kBlock ? columns - first : kBlock;
    double* block = panel + static_cast<long>(first) * stride + first;
    if (first > 0) {
      Product before{panel + first, panel + first, stride, first, signs};
      if (profile.begin) {
        before.begin = profile.begin + first / kLanes;
        before.least_begin = *before.begin;
      }
      update(block, stride, before, height - first, count, false);
    }
    // The square on the diagonal is factored apart; all rows, its own too, are then divided by it.
    double square[kBlock][kBlock], U[kBlock][kBlock], inverse[kBlock], root[kBlock];
    for (int j = 0; j < count; ++j) {
      for (int r = j; r < count; ++r) {
        square[j][r] = block[static_cast<long>(j) * stride + r];
        for (int i = 0; i < j; ++i) square[j][r] -= square[i][r] * U[i][j];
      }
      double& d = square[j][j];
      if (profile.least && __builtin_fabs(d) < __builtin_fabs(profile.least[first + j])) d = profile.least[first + j];
      const double size = __builtin_fabs(d), sign = d < 0.0 ? -1.0 : 1.0;
      if (!(size > 0.0) || !(size <= __DBL_MAX__)) return false;
      pivots[first + j] = d;
      signs[first + j] = sign;
      root[j] = __builtin_sqrt(size);
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

bool factor(double* panel, int stride, int columns, int height, double* pivots, double* signs) {
  return factor_panel(panel, stride, columns, height, Profile{}, pivots, signs);
}

bool factor_profile(double* panel, int stride, int columns, const int* begin, const double* least, double* pivots,
                    double* signs) {
  return factor_panel(panel, stride, columns, columns, Profile{begin, least}, pivots, signs);
}

/// to <- to + from, with registers of ever smaller size.
template <int width>
void add_run(const double* from, double* to, int length) {
  using Part [[gnu::vector_size(8 * width), gnu::aligned(8), gnu::may_alias]] = double;
  int i = 0;
  for (; i + width <= length; i += width) *reinterpret_cast<Part*>(to + i) += *reinterpret_cast<const Part*>(from + i);
  if constexpr (width > 2) {
    add_run<width / 2>(from + i, to + i, length - i);
  } else {
    if (i < length) to[i] += from[i];
  }
}

void add(const double* from, int from_stride, int first, int end, const Run* runs, int count, double* to, int to_stride,
         int shift) {
  int at = 0;  // the run of column j
  for (int j = first; j < end; ++j) {
    while (runs[at].row + runs[at].length <= j) ++at;
    const double* own = from + static_cast<long>(j) * from_stride;
    const int into = runs[at].into + j - runs[at].row;
    double* column = to + static_cast<long>(into - shift) * to_stride - shift;
    add_run<kWidth>(own + j, column + into, runs[at].row + runs[at].length - j);
    for (int k = at + 1; k < count; ++k) add_run<kWidth>(own + runs[k].row, column + runs[k].into, runs[k].length);
  }
}

void multiply(const double* A, int stride, int height, int columns, const double* x, double* y) {
  constexpr int kRows = 4;  // registers
  const auto rows = [&]<int count>(int at) {
    Lanes sum[count];
    for (int i = 0; i < count; ++i) sum[i] = load(y + at + kWidth * i);
    for (int k = 0; k < columns; ++k) {
      const double* a = A + static_cast<long>(k) * stride + at;
      for (int i = 0; i < count; ++i) sum[i] -= load(a + kWidth * i) * x[k];
    }
    for (int i = 0; i < count; ++i) store(y + at + kWidth * i, sum[i]);
  };
  int at = 0;
  for (; at + kWidth * kRows <= height; at += kWidth * kRows) rows.template operator()<kRows>(at);
  for (; at < height; at += kWidth) rows.template operator()<1>(at);
}

double total(const Lanes& v) {
  double sum = v[0];
  for (int i = 1; i < kWidth; ++i) sum += v[i];
  return sum;
}

template <int count>
void dots(const double* A, int stride, int height, const double* y, double* x) {
  Lanes sum[count] = {};
  int at = 0;
  for (; at + kWidth <= height; at += kWidth) {
    const Lanes own = load(y + at);
    for (int k = 0; k < count; ++k) sum[k] += load(A + static_cast<long>(k) * stride + at) * own;
  }
  for (int k = 0; k < count; ++k) {
    double rest = 0.0;
    for (int i = at; i < height; ++i) rest += A[static_cast<long>(k) * stride + i] * y[i];
    x[k] -= total(sum[k]) + rest;
  }
}

void multiply_transposed(const double* A, int stride, int height, int columns, const double* y, double* x) {
  int k = 0;
  for (; k + 4 <= columns; k += 4) dots<4>(A + static_cast<long>(k) * stride, stride, height, y, x + k);
  for (; k < columns; ++k) dots<1>(A + static_cast<long>(k) * stride, stride, height, y, x + k);
}

// Blocks on the diagonal one by one; y and x have whole lanes.
void solve(const double* panel, int stride, int columns, double* y) {
  for (int first = 0; first < columns; first += kBlock) {
    const int end = first + kBlock < columns ? first + kBlock : columns;
    for (int j = first; j < end; ++j) {
      const double* column = panel + static_cast<long>(j) * stride;
      y[j] /= column[j];
      for (int r = j + 1; r < end; ++r) y[r] -= column[r] * y[j];
    }
    if (end < columns)
      multiply(panel + static_cast<long>(first) * stride + end, stride, columns - end, kBlock, y + first, y + end);
  }
}

void solve_transposed(const double* panel, int stride, int columns, double* x) {
  for (int first = (columns - 1) / kBlock * kBlock; first >= 0; first -= kBlock) {
    const int end = first + kBlock < columns ? first + kBlock : columns;
    multiply_transposed(panel + static_cast<long>(first) * stride + end, stride, columns - end, end - first, x + end,
                        x + first);
    for (int j = end - 1; j >= first; --j) {
      const double* column = panel + static_cast<long>(j) * stride;
      for (int r = j + 1; r < end; ++r) x[j] -= column[r] * x[r];
      x[j] /= column[j];
    }
  }
}

}  // namespace

const Kernels SINEW_KERNELS{SINEW_NAME,       factor,   factor_profile,     update, add, solve,
                            solve_transposed, multiply, multiply_transposed};

}  // namespace sinew::linalg
