// Compiled once for each width of registers, as linalg/kernels_lanes.cpp: it includes nothing of others.
#include "sinew/linalg/lanes.hpp"
#include "sinew/solid/tet_batch.hpp"

namespace sinew::solid {

extern const TetKernels SINEW_KERNELS;

namespace {

using namespace lanes;

using Four [[gnu::vector_size(32), gnu::aligned(8), gnu::may_alias]] = double;
void add_four(double* p, const Four& v) { *reinterpret_cast<Four*>(p) += v; }

// A record is two vectors, each followed by a zero. Where it fills a register, both are loaded, turned and stored as
// one; elsewhere registers are too few to hold both.
#if SINEW_LANES == 8

struct Two {
  Vector first, second;
};

/// Eight records turned into registers of their numbers, by way of the x and z of both vectors of two records, and of
/// their y.
template <class Load>
Two turned(const Load& row) {
  Lanes low[4], high[4];
#pragma GCC unroll 4
  for (int k = 0; k < 4; ++k) {
    const Lanes a = row(2 * k), b = row(2 * k + 1);
    low[k] = __builtin_shufflevector(a, b, 0, 8, 2, 10, 4, 12, 6, 14);
    high[k] = __builtin_shufflevector(a, b, 1, 9, 3, 11, 5, 13, 7, 15);
  }
  const auto even = [](const Lanes& a, const Lanes& b) {
    return __builtin_shufflevector(a, b, 0, 1, 4, 5, 8, 9, 12, 13);
  };
  const auto odd = [](const Lanes& a, const Lanes& b) {
    return __builtin_shufflevector(a, b, 2, 3, 6, 7, 10, 11, 14, 15);
  };
  const Lanes x0 = even(low[0], low[1]), x1 = even(low[2], low[3]), z0 = odd(low[0], low[1]), z1 = odd(low[2], low[3]),
              y0 = even(high[0], high[1]), y1 = even(high[2], high[3]);
  return {{even(x0, x1), even(y0, y1), even(z0, z1)}, {odd(x0, x1), odd(y0, y1), odd(z0, z1)}};
}

/// And back.
template <class Take>
void turned_back(const Two& v, const Take& take) {
  const auto first = [](const Lanes& a, const Lanes& b) {
    return __builtin_shufflevector(a, b, 0, 1, 8, 9, 2, 3, 10, 11);
  };
  const auto last = [](const Lanes& a, const Lanes& b) {
    return __builtin_shufflevector(a, b, 4, 5, 12, 13, 6, 7, 14, 15);
  };
  const Lanes none = {};
  for (int half = 0; half < 2; ++half) {
    const auto of = [&](const Lanes& a, const Lanes& b) { return half == 0 ? first(a, b) : last(a, b); };
    const Lanes x = of(v.first.x, v.second.x), y = of(v.first.y, v.second.y), z = of(v.first.z, v.second.z);
    const Lanes low[2] = {first(x, z), last(x, z)}, high[2] = {first(y, none), last(y, none)};
    for (int k = 0; k < 2; ++k) {
      take(4 * half + 2 * k, __builtin_shufflevector(low[k], high[k], 0, 8, 2, 10, 4, 12, 6, 14));
      take(4 * half + 2 * k + 1, __builtin_shufflevector(low[k], high[k], 1, 9, 3, 11, 5, 13, 7, 15));
    }
  }
}

/// What the records of the nodes of one register's elements hold.
Two gather(const double* records, const int* node) {
  return turned([&](int i) { return load(records + kRecord * node[i]); });
}

/// Adds to them.
void scatter(const Two& v, const int* node, double* records) {
  turned_back(v, [&](int i, const Lanes& own) {
    double* const to = records + kRecord * node[i];
    store(to, load(to) + own);
  });
}

#else

const Four& four(const double* p) { return *reinterpret_cast<const Four*>(p); }

/// Four vectors of three numbers, which come as their first, second and third numbers.
struct FourVectors {
  Four of[4];
};
FourVectors turned(const Four& x, const Four& y, const Four& z) {
  const Four none = {};
  const Four xy02 = __builtin_shufflevector(x, y, 0, 4, 2, 6), xy13 = __builtin_shufflevector(x, y, 1, 5, 3, 7);
  const Four z02 = __builtin_shufflevector(z, none, 0, 4, 2, 6), z13 = __builtin_shufflevector(z, none, 1, 5, 3, 7);
  return {{__builtin_shufflevector(xy02, z02, 0, 1, 4, 5), __builtin_shufflevector(xy13, z13, 0, 1, 4, 5),
           __builtin_shufflevector(xy02, z02, 2, 3, 6, 7), __builtin_shufflevector(xy13, z13, 2, 3, 6, 7)}};
}

/// One of the vectors in the records of the nodes of one register's elements.
Vector gather(const double* vectors, const int* node) {
  Vector v;
  if constexpr (kWidth < 4) {
    for (int i = 0; i < kWidth; ++i) {
      const double* own = vectors + kRecord * node[i];
      v.x[i] = own[0];
      v.y[i] = own[1];
      v.z[i] = own[2];
    }
  } else {
    for (int i = 0; i < kWidth; i += 4) {
      const auto at = [&](int k) -> const Four& { return four(vectors + kRecord * node[i + k]); };
      const Four ab02 = __builtin_shufflevector(at(0), at(1), 0, 4, 2, 6),
                 ab13 = __builtin_shufflevector(at(0), at(1), 1, 5, 3, 7),
                 cd02 = __builtin_shufflevector(at(2), at(3), 0, 4, 2, 6),
                 cd13 = __builtin_shufflevector(at(2), at(3), 1, 5, 3, 7);
      reinterpret_cast<Four*>(&v.x)[i / 4] = __builtin_shufflevector(ab02, cd02, 0, 1, 4, 5);
      reinterpret_cast<Four*>(&v.y)[i / 4] = __builtin_shufflevector(ab13, cd13, 0, 1, 4, 5);
      reinterpret_cast<Four*>(&v.z)[i / 4] = __builtin_shufflevector(ab02, cd02, 2, 3, 6, 7);
    }
  }
  return v;
}

/// Adds to it.
void scatter(const Vector& v, const int* node, double* vectors) {
  if constexpr (kWidth < 4) {
    for (int i = 0; i < kWidth; ++i) {
      double* own = vectors + kRecord * node[i];
      own[0] += v.x[i];
      own[1] += v.y[i];
      own[2] += v.z[i];
    }
  } else {
    const auto* x = reinterpret_cast<const Four*>(&v.x);
    const auto* y = reinterpret_cast<const Four*>(&v.y);
    const auto* z = reinterpret_cast<const Four*>(&v.z);
    for (int i = 0; i < kWidth; i += 4) {
      const FourVectors own = turned(x[i / 4], y[i / 4], z[i / 4]);
      for (int k = 0; k < 4; ++k) add_four(vectors + kRecord * node[i + k], own.of[k]);
    }
  }
}

#endif

/// Some elements of a batch: those of one register.
struct Part {
  const TetBatch& batch;
  int first;

  Lanes operator()(const Eight& numbers) const { return load(numbers + first); }
  Vector operator()(const Eight (&v)[3]) const { return {(*this)(v[0]), (*this)(v[1]), (*this)(v[2])}; }
  Matrix operator()(const Eight (&A)[3][3]) const { return {(*this)(A[0]), (*this)(A[1]), (*this)(A[2])}; }
  void put(const Vector& v, Eight (&to)[3]) const {
    store(to[0] + first, v.x);
    store(to[1] + first, v.y);
    store(to[2] + first, v.z);
  }
  void put(const Matrix& A, Eight (&to)[3][3]) const {
    put(A.c0, to[0]);
    put(A.c1, to[1]);
    put(A.c2, to[2]);
  }
  Vector gradient(int a) const { return (*this)(batch.gradient[a]); }
  const int* node(int a) const { return batch.node[a] + first; }
};

/// sum_a v_a g_a^T of vectors in the nodes' records; the fourth gradient is minus the sum of the others.
#if SINEW_LANES == 8
struct Gradient {
  Matrix first, second;
};
Gradient gradient_of(const Part& part, const double* records) {
  const Two last = gather(records, part.node(3));
  Gradient sum = {};
  for (int a = 0; a < 3; ++a) {
    const Two own = gather(records, part.node(a));
    const Vector g = part.gradient(a);
    sum.first = sum.first + outer(own.first - last.first, g);
    sum.second = sum.second + outer(own.second - last.second, g);
  }
  return sum;
}
#else
Matrix gradient_of(const Part& part, const double* vectors) {
  const Vector last = gather(vectors, part.node(3));
  const auto of = [&](int a) { return outer(gather(vectors, part.node(a)) - last, part.gradient(a)); };
  return of(0) + of(1) + of(2);
}
#endif
/// Of the second vectors alone.
Matrix second_gradient_of(const Part& part, const double* records) {
#if SINEW_LANES == 8
  return gradient_of(part, records).second;
#else
  return gradient_of(part, records + kRecord / 2);
#endif
}

template <class Visit>
void each_part(const TetBatch& batch, const Visit& visit) {
  for (int first = 0; first < kBatch; first += kWidth) visit(Part{batch, first});
}

unsigned bits(const Truth& truth, int first) {
  unsigned set = 0;
  for (int k = 0; k < kWidth; ++k) set |= truth[k] ? 1U << (first + k) : 0U;
  return set;
}

template <int width>
using Some [[gnu::vector_size(8 * width), gnu::may_alias]] = long long;

/// All lanes are true: half with half.
template <int width>
bool all_true(const Some<width>& v) {
  if constexpr (width == 1) {
    return v[0] != 0;
  } else {
    const auto* halves = reinterpret_cast<const Some<width / 2>*>(&v);
    return all_true<width / 2>(halves[0] & halves[1]);
  }
}

/// The rotations of polar decompositions, by Newton's iteration for R^T R = 1 without scaling; false where one has not
/// converged or would end at a mirror. Every turn waits for itself, so several go by turns.
template <int count>
void rotations(const Matrix (&F)[count], Matrix (&X)[count], Truth (&found)[count]) {
  constexpr int kMost = 8;
#pragma GCC unroll 2
  for (int p = 0; p < count; ++p) {
    X[p] = F[p];
    found[p] = dot(F[p].c0, cross(F[p].c1, F[p].c2)) > 1e-2;
  }
  for (int i = 0; i < kMost; ++i) {
    Truth done = ~Truth{};
#pragma GCC unroll 2
    for (int p = 0; p < count; ++p) {
      Matrix& own = X[p];
      const Matrix C = {cross(own.c1, own.c2), cross(own.c2, own.c0), cross(own.c0, own.c1)};
      const Matrix next = own * (Lanes{} + 0.5) + C * (0.5 / dot(own.c0, C.c0));
      const Matrix step = next - own;
      const Truth small = dot(step, step) < 1e-16;  // the error left is about the step's square
      own = next;
      done &= small | (found[p] == 0);
      if (i + 1 == kMost) found[p] &= small;
    }
    if (all_true<kWidth>(done)) break;
  }
}

/// A symmetric matrix.
struct Symmetric {
  Lanes xx, yy, zz, xy, yz, zx;
};
Symmetric operator+(const Symmetric& A, const Symmetric& B) {
  return {A.xx + B.xx, A.yy + B.yy, A.zz + B.zz, A.xy + B.xy, A.yz + B.yz, A.zx + B.zx};
}
Symmetric operator*(const Symmetric& A, const Lanes& s) {
  return {A.xx * s, A.yy * s, A.zz * s, A.xy * s, A.yz * s, A.zx * s};
}
/// u v^T where that is symmetric.
Symmetric symmetric_outer(const Vector& u, const Vector& v) {
  return {u.x * v.x, u.y * v.y, u.z * v.z, u.x * v.y, u.y * v.z, u.z * v.x};
}
Matrix whole(const Symmetric& A) { return {{A.xx, A.xy, A.zx}, {A.xy, A.yy, A.yz}, {A.zx, A.yz, A.zz}}; }
/// Of a matrix that is, but for rounding.
Symmetric half(const Matrix& A) { return {A.c0.x, A.c1.y, A.c2.z, A.c0.y, A.c1.z, A.c0.z}; }
Vector operator*(const Symmetric& A, const Vector& v) {
  return {A.xx * v.x + A.xy * v.y + A.zx * v.z, A.xy * v.x + A.yy * v.y + A.yz * v.z,
          A.zx * v.x + A.yz * v.y + A.zz * v.z};
}

/// rate C (E - E_0) of the viscosity C, with E - E_0 = sym((F_0 + dF / 2)^T dF): small motions keep their digits.
Symmetric viscous_stress(const Part& part, const Matrix& F, const Matrix& dF, double rate) {
  const Matrix middle = F - dF * (Lanes{} + 0.5);
  const Lanes xx = dot(middle.c0, dF.c0), yy = dot(middle.c1, dF.c1), zz = dot(middle.c2, dF.c2);
  const Lanes mu = rate * part(part.batch.viscous_mu), trace = rate * part(part.batch.viscous_lambda) * (xx + yy + zz);
  return {2.0 * mu * xx + trace,
          2.0 * mu * yy + trace,
          2.0 * mu * zz + trace,
          mu * (dot(middle.c0, dF.c1) + dot(middle.c1, dF.c0)),
          mu * (dot(middle.c1, dF.c2) + dot(middle.c2, dF.c1)),
          mu * (dot(middle.c2, dF.c0) + dot(middle.c0, dF.c2))};
}

/// Finds rotations, and keeps them with F.
template <int count>
void find_frames(const Part (&part)[count], const Matrix (&F)[count], Matrix (&R)[count], TetFrames* const* frames) {
  Truth found[count];
  rotations(F, R, found);
#pragma GCC unroll 2
  for (int p = 0; p < count; ++p) {
    part[p].put(R[p], frames[p]->R);
    part[p].put(F[p], frames[p]->F);
    frames[p]->missing |= bits(found[p] == 0, part[p].first);
  }
}

/// The nodes of a part's elements; of those that are missing, another one instead.
class Nodes {
 public:
  Nodes(const Nodes&) = delete;  // it points into itself
  Nodes(const Part& part, unsigned missing, int nowhere) {
    for (int a = 0; a < 4; ++a) {
      node_[a] = part.node(a);
      if (missing >> part.first == 0) continue;
      for (int i = 0; i < kWidth; ++i) other_[a][i] = missing >> (part.first + i) & 1U ? nowhere : part.node(a)[i];
      node_[a] = other_[a];
    }
  }
  const int* operator()(int a) const { return node_[a]; }

 private:
  const int* node_[4];
  int other_[4][kWidth];
};

/// First Piola and Kirchhoff's stress times volume, by columns, elastic and viscous.
Matrix elastic_stress(const Part& part, const Matrix& F, const Matrix& R) {
  return (F - R) * (2.0 * part(part.batch.mu)) + R * (part(part.batch.lambda) * (dot(R, F) - 3.0));
}
Matrix viscous_stress_times(const Part& part, const Matrix& F, const Matrix& motion, double rate) {
  const Symmetric S = viscous_stress(part, F, motion, rate);
  return {F * Vector{S.xx, S.xy, S.zx}, F * Vector{S.xy, S.yy, S.yz}, F * Vector{S.zx, S.yz, S.zz}};
}

/// Finds frames and adds forces of some parts.
#if SINEW_LANES == 8
template <int count>
void add_forces_of(const Part (&part)[count], const double* nodes, double rate, int nowhere, TetFrames* const* frames,
                   double* forces) {
  Matrix F[count], dF[count], R[count];
#pragma GCC unroll 2
  for (int p = 0; p < count; ++p) {
    const Gradient own = gradient_of(part[p], nodes);
    F[p] = own.first;
    dF[p] = own.second;
  }
  find_frames(part, F, R, frames);
#pragma GCC unroll 2
  for (int p = 0; p < count; ++p) {
    const Matrix elastic = elastic_stress(part[p], F[p], R[p]),
                 viscous = rate > 0.0 ? viscous_stress_times(part[p], F[p], dF[p], rate) : Matrix{};
    const Nodes node(part[p], frames[p]->missing, nowhere);
    Two last = {};
    for (int a = 0; a < 3; ++a) {
      const Two own = {elastic * part[p].gradient(a), viscous * part[p].gradient(a)};
      scatter(own, node(a), forces);
      last = {last.first - own.first, last.second - own.second};
    }
    scatter(last, node(3), forces);
  }
}
#else
template <int count>
void add_forces_of(const Part (&part)[count], const double* nodes, double rate, int nowhere, TetFrames* const* frames,
                   double* forces) {
  Matrix F[count], R[count];
#pragma GCC unroll 2
  for (int p = 0; p < count; ++p) F[p] = gradient_of(part[p], nodes);
  find_frames(part, F, R, frames);
#pragma GCC unroll 2
  for (int p = 0; p < count; ++p) {
    const Nodes node(part[p], frames[p]->missing, nowhere);
    const auto add = [&](const Matrix& stress, double* sum) {
      Vector last = {};
      for (int a = 0; a < 3; ++a) {
        const Vector own = stress * part[p].gradient(a);
        scatter(own, node(a), sum);
        last = last - own;
      }
      scatter(last, node(3), sum);
    };
    add(elastic_stress(part[p], F[p], R[p]), forces);
    if (rate > 0.0)
      add(viscous_stress_times(part[p], F[p], gradient_of(part[p], nodes + kRecord / 2), rate), forces + kRecord / 2);
  }
}
#endif

[[gnu::flatten]] void add_forces(const TetBatch* batches, int count, const double* nodes, double rate, int nowhere,
                                 TetFrames* frames, double* forces) {
  for (int k = 0; k < count; ++k) frames[k].missing = 0;
  const auto part = [batches](int p) { return Part{batches[p * kWidth / kBatch], p * kWidth % kBatch}; };
  const auto frame = [frames](int p) { return frames + p * kWidth / kBatch; };
  const int parts = count * kBatch / kWidth;
  int p = 0;
  for (; p + 1 < parts; p += 2) {
    TetFrames* const own[] = {frame(p), frame(p + 1)};
    add_forces_of<2>({part(p), part(p + 1)}, nodes, rate, nowhere, own, forces);
  }
  if (p < parts) {
    TetFrames* const own[] = {frame(p)};
    add_forces_of<1>({part(p)}, nodes, rate, nowhere, own, forces);
  }
}

/// A part's gradients, and what a matrix makes of them.
struct Gradients {
  Vector of[4];
};
Gradients gradients(const Part& part) {
  Gradients g = {{part.gradient(0), part.gradient(1), part.gradient(2), {}}};
  g.of[3] = -(g.of[0] + g.of[1] + g.of[2]);
  return g;
}
Gradients operator*(const Matrix& A, const Gradients& g) {
  return {{A * g.of[0], A * g.of[1], A * g.of[2], A * g.of[3]}};
}

/// Puts the block of nodes a >= b.
void put(const Part& part, TetStiffness& stiffness, int a, int b, const Matrix& K) {
  Eight(&to)[9] = stiffness.block[a * (a + 1) / 2 + b];
  const Lanes entries[9] = {K.c0.x, K.c0.y, K.c0.z, K.c1.x, K.c1.y, K.c1.z, K.c2.x, K.c2.y, K.c2.z};
#pragma GCC unroll 9
  for (int i = 0; i < 9; ++i) store(to[i] + part.first, entries[i]);
}

Matrix transposed(const Matrix& A) {
  return {{A.c0.x, A.c1.x, A.c2.x}, {A.c0.y, A.c1.y, A.c2.y}, {A.c0.z, A.c1.z, A.c2.z}};
}

/// Puts all blocks, given those of nodes 2 >= a >= b, `block(a, b)` and `diagonal(a)`: no force comes from moving all
/// four nodes alike.
template <class Diagonal, class Block>
void put_blocks(const Part& part, TetStiffness& stiffness, const Diagonal& diagonal, const Block& block) {
  const auto last = [](const auto& A, const auto& B, const auto& C) { return (A + B + C) * (Lanes{} - 1.0); };
  const Matrix K00 = whole(diagonal(0)), K10 = block(1, 0), K20 = block(2, 0);
  put(part, stiffness, 0, 0, K00);
  put(part, stiffness, 1, 0, K10);
  put(part, stiffness, 2, 0, K20);
  const Matrix K30 = last(K00, K10, K20), K11 = whole(diagonal(1)), K21 = block(2, 1);
  put(part, stiffness, 3, 0, K30);
  put(part, stiffness, 1, 1, K11);
  put(part, stiffness, 2, 1, K21);
  const Matrix K31 = last(transposed(K10), K11, K21), K22 = whole(diagonal(2));
  put(part, stiffness, 3, 1, K31);
  put(part, stiffness, 2, 2, K22);
  const Matrix K32 = last(transposed(K20), transposed(K21), K22);
  put(part, stiffness, 3, 2, K32);
  put(part, stiffness, 3, 3, whole(last(half(K30), half(K31), half(K32))));
}

/// mu A g_b (A g_a)^T + lambda A g_a (A g_b)^T: of linear elasticity, which has mu g_a . g_b besides, with A = R; of
/// viscous forces, which have mu A A^T g_a . g_b and their stress besides, with A = F.
struct Projected {
  Lanes mu, lambda;
  Gradients moved;  ///< A g

  Matrix operator()(int a, int b) const {
    return outer(moved.of[b], moved.of[a] * mu) + outer(moved.of[a] * lambda, moved.of[b]);
  }
  Symmetric operator()(int a) const { return symmetric_outer(moved.of[a], moved.of[a] * (mu + lambda)); }
};

Projected viscosity(const Part& part, const Matrix& F, const Gradients& g, double rate) {
  return {rate * part(part.batch.viscous_mu), rate * part(part.batch.viscous_lambda), F * g};
}

/// s + mu F F^T.
Symmetric square(const Matrix& F, const Lanes& mu, const Lanes& s) {
  const Vector x = {F.c0.x, F.c1.x, F.c2.x}, y = {F.c0.y, F.c1.y, F.c2.y}, z = {F.c0.z, F.c1.z, F.c2.z};
  return {s + mu * dot(x, x), s + mu * dot(y, y), s + mu * dot(z, z), mu * dot(x, y), mu * dot(y, z), mu * dot(z, x)};
}

[[gnu::flatten]] void definite(const TetBatch& batch, const TetFrames& frames, double rate, TetStiffness& stiffness) {
  each_part(batch, [&](const Part& part) {
    const Matrix F = part(frames.F);
    const Gradients g = gradients(part);
    const Projected elastic = {part(batch.mu), part(batch.lambda), part(frames.R) * g};
    const Projected viscous = viscosity(part, F, g, rate);
    const Symmetric common = square(F, viscous.mu, elastic.mu);
    put_blocks(
        part, stiffness, [&](int a) { return common * dot(g.of[a], g.of[a]) + elastic(a) + viscous(a); },
        [&](int a, int b) { return whole(common * dot(g.of[a], g.of[b])) + elastic(a, b) + viscous(a, b); });
  });
}

Symmetric inverse(const Symmetric& A) {
  const Lanes xx = A.yy * A.zz - A.yz * A.yz, xy = A.yz * A.zx - A.xy * A.zz, zx = A.xy * A.yz - A.yy * A.zx;
  const Lanes by = 1.0 / (A.xx * xx + A.xy * xy + A.zx * zx);
  return {xx * by, (A.zz * A.xx - A.zx * A.zx) * by, (A.xx * A.yy - A.xy * A.xy) * by,
          xy * by, (A.xy * A.zx - A.xx * A.yz) * by, zx * by};
}

// With T = F R^T and w the turning of R for motions u_a of the nodes, (tr T - T) w = sum_a (R g_a) x u_a, the second
// variation of the energy is 2 mu |dF|^2 + lambda (R . dF)^2 + (lambda tr(R^T F - 1) - 2 mu) w . (tr T - T) w.
// (Where a rotation was found T is positive definite, and so is tr T - T, whose eigenvalues are sums of two of T's.)
[[gnu::flatten]] void exact(const TetBatch& batch, const TetFrames& frames, const double* nodes, double rate,
                            TetStiffness& stiffness) {
  each_part(batch, [&](const Part& part) {
    const Matrix F = part(frames.F), R = part(frames.R);
    const Gradients g = gradients(part), t = R * g;
    const Vector Fx = {F.c0.x, F.c1.x, F.c2.x}, Fy = {F.c0.y, F.c1.y, F.c2.y}, Fz = {F.c0.z, F.c1.z, F.c2.z};
    const Vector Rx = {R.c0.x, R.c1.x, R.c2.x}, Ry = {R.c0.y, R.c1.y, R.c2.y}, Rz = {R.c0.z, R.c1.z, R.c2.z};
    const Lanes Txx = dot(Fx, Rx), Tyy = dot(Fy, Ry), Tzz = dot(Fz, Rz);
    const Symmetric H = inverse({Tyy + Tzz, Tzz + Txx, Txx + Tyy, -0.5 * (dot(Fx, Ry) + dot(Fy, Rx)),
                                 -0.5 * (dot(Fy, Rz) + dot(Fz, Ry)), -0.5 * (dot(Fz, Rx) + dot(Fx, Rz))});
    const Lanes mu = 2.0 * part(batch.mu), lambda = part(batch.lambda), turning = lambda * (Txx + Tyy + Tzz - 3.0) - mu;
    // turning H [t_b]x by columns
    Matrix turned[4];
    for (int b = 0; b < 4; ++b) {
      const Vector own = t.of[b] * turning;
      const Lanes none = {};
      turned[b] = {H * Vector{none, own.z, -own.y}, H * Vector{-own.z, none, own.x}, H * Vector{own.y, -own.x, none}};
    }
    const Projected viscous = viscosity(part, F, g, rate);
    const Symmetric common = square(F, viscous.mu, mu);
    const Symmetric S = rate > 0.0 ? viscous_stress(part, F, second_gradient_of(part, nodes), rate) : Symmetric{};
    const auto block = [&](int a, int b) {
      const Vector& ta = t.of[a];
      Matrix K = whole(common * dot(g.of[a], g.of[b])) + outer(ta * lambda, t.of[b]) + viscous(a, b) +
                 Matrix{cross(turned[b].c0, ta), cross(turned[b].c1, ta), cross(turned[b].c2, ta)};
      const Lanes stress = dot(g.of[a], S * g.of[b]);
      K.c0.x += stress;
      K.c1.y += stress;
      K.c2.z += stress;
      return K;
    };
    put_blocks(
        part, stiffness, [&](int a) { return half(block(a, a)); }, block);
  });
}

/// Adds three numbers of each element, and a zero behind them, which come as one number of all of them after the other.
#if SINEW_LANES == 8
[[gnu::always_inline]] inline void add_threes(const Eight* numbers, double* const (&to)[kBatch], int shift) {
  const Truth three = {-1, -1, -1, 0, -1, -1, -1, 0};
  const Lanes x = load(numbers[0]), y = load(numbers[1]), z = load(numbers[2]),
              even = __builtin_shufflevector(x, y, 0, 8, 2, 10, 4, 12, 6, 14),
              odd = __builtin_shufflevector(x, y, 1, 9, 3, 11, 5, 13, 7, 15);
  const auto add = [&](const Lanes& two, int one, int other) {
    const Lanes own = reinterpret_cast<Lanes>(reinterpret_cast<Truth>(two) & three);
    add_four(to[one] + shift, __builtin_shufflevector(own, own, 0, 1, 2, 3));
    add_four(to[other] + shift, __builtin_shufflevector(own, own, 4, 5, 6, 7));
  };
  add(__builtin_shufflevector(even, z, 0, 1, 8, 8, 2, 3, 10, 10), 0, 2);
  add(__builtin_shufflevector(odd, z, 0, 1, 9, 9, 2, 3, 11, 11), 1, 3);
  add(__builtin_shufflevector(even, z, 4, 5, 12, 12, 6, 7, 14, 14), 4, 6);
  add(__builtin_shufflevector(odd, z, 4, 5, 13, 13, 6, 7, 15, 15), 5, 7);
}
#else
[[gnu::always_inline]] inline void add_threes(const Eight* numbers, double* const (&to)[kBatch], int shift) {
  for (int first = 0; first < kBatch; first += 4) {
    const FourVectors own = turned(four(numbers[0] + first), four(numbers[1] + first), four(numbers[2] + first));
#pragma GCC unroll 4
    for (int i = 0; i < 4; ++i) add_four(to[first + i] + shift, own.of[i]);
  }
}
#endif

/// Block by block, a column of all eight elements at a time.
void add(const TetStiffness& stiffness, const TetPlaces& places, double* numbers) {
  for (int k = 0; k < 10; ++k) {
    double* to[kBatch];
#pragma GCC unroll 8
    for (int i = 0; i < kBatch; ++i) to[i] = numbers + places.block[k][i];
#pragma GCC unroll 3
    for (int column = 0; column < 3; ++column) add_threes(stiffness.block[k] + 3 * column, to, 4 * column);
  }
}

}  // namespace

const TetKernels SINEW_KERNELS{SINEW_NAME, add_forces, definite, exact, add};

}  // namespace sinew::solid
