// Compiled once for each width of registers, as linalg/kernels_lanes.cpp: it includes nothing of others.
#include "sinew/solid/tet_batch.hpp"

namespace sinew::solid {

extern const TetKernels SINEW_KERNELS;

namespace {

constexpr int kWidth = SINEW_LANES;
using Lanes [[gnu::vector_size(8 * SINEW_LANES), gnu::aligned(8), gnu::may_alias]] = double;
using Truth [[gnu::vector_size(8 * SINEW_LANES)]] = long long;

Lanes load(const double* p) { return *reinterpret_cast<const Lanes*>(p); }
void store(double* p, const Lanes& v) { *reinterpret_cast<Lanes*>(p) = v; }

struct Vector {
  Lanes x, y, z;
};
Vector operator+(const Vector& a, const Vector& b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
Vector operator-(const Vector& a, const Vector& b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
Vector operator-(const Vector& a) { return {-a.x, -a.y, -a.z}; }
Vector operator*(const Vector& a, const Lanes& s) { return {a.x * s, a.y * s, a.z * s}; }
Lanes dot(const Vector& a, const Vector& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
Vector cross(const Vector& a, const Vector& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

/// A matrix by its columns.
struct Matrix {
  Vector c0, c1, c2;
};
Matrix operator+(const Matrix& A, const Matrix& B) { return {A.c0 + B.c0, A.c1 + B.c1, A.c2 + B.c2}; }
Matrix operator-(const Matrix& A, const Matrix& B) { return {A.c0 - B.c0, A.c1 - B.c1, A.c2 - B.c2}; }
Matrix operator*(const Matrix& A, const Lanes& s) { return {A.c0 * s, A.c1 * s, A.c2 * s}; }
Vector operator*(const Matrix& A, const Vector& v) { return A.c0 * v.x + A.c1 * v.y + A.c2 * v.z; }
Lanes dot(const Matrix& A, const Matrix& B) { return dot(A.c0, B.c0) + dot(A.c1, B.c1) + dot(A.c2, B.c2); }

/// Some elements of a batch: those of one register.
struct Part {
  const TetBatch& batch;
  int first;

  Lanes operator()(const Eight& numbers) const { return load(numbers + first); }
  Vector gradient(int a) const {
    return {(*this)(batch.gradient[a][0]), (*this)(batch.gradient[a][1]), (*this)(batch.gradient[a][2])};
  }
  Vector at_node(const double* x, int a) const {
    Vector v;
    for (int i = 0; i < kWidth; ++i) {
      const double* own = x + 3L * batch.node[a][first + i];
      v.x[i] = own[0];
      v.y[i] = own[1];
      v.z[i] = own[2];
    }
    return v;
  }
  /// sum_a x_a g_a^T; the fourth gradient is minus the sum of the others.
  Matrix gradient_of(const double* x) const {
    return gradient_of([&](int a) { return at_node(x, a); });
  }
  /// The same of x - start, so that small motions keep their digits.
  Matrix gradient_of_motion(const double* x, const double* start) const {
    return gradient_of([&](int a) { return at_node(x, a) - at_node(start, a); });
  }
  template <class At>
  Matrix gradient_of(const At& at) const {
    const Vector last = at(3), e0 = at(0) - last, e1 = at(1) - last, e2 = at(2) - last;
    const Vector g0 = gradient(0), g1 = gradient(1), g2 = gradient(2);
    return {e0 * g0.x + e1 * g1.x + e2 * g2.x, e0 * g0.y + e1 * g1.y + e2 * g2.y, e0 * g0.z + e1 * g1.z + e2 * g2.z};
  }
};

/// The rotation of the polar decomposition, by Newton's iteration for R^T R = 1 without scaling; false where it has not
/// converged or would end at a mirror.
Matrix rotation(const Matrix& F, Truth& found) {
  constexpr int kMost = 8;
  Matrix X = F;
  found = dot(F.c0, cross(F.c1, F.c2)) > 1e-2;
  for (int i = 0; i < kMost; ++i) {
    const Matrix C = {cross(X.c1, X.c2), cross(X.c2, X.c0), cross(X.c0, X.c1)};
    const Matrix next = X * (Lanes{} + 0.5) + C * (0.5 / dot(X.c0, C.c0));
    const Matrix step = next - X;
    const Truth small = dot(step, step) < 1e-16;  // the error left is about the step's square
    X = next;
    bool all = true;
    for (int k = 0; k < kWidth; ++k) all &= small[k] != 0 || found[k] == 0;
    if (all) break;
    if (i + 1 == kMost) found &= small;
  }
  return X;
}

/// Visits a batch register by register with F and R; a bit for each element without one.
template <class Visit>
unsigned each_part(const TetBatch& batch, const double* x, const Visit& visit) {
  unsigned missing = 0;
  for (int first = 0; first < kBatch; first += kWidth) {
    const Part part{batch, first};
    const Matrix F = part.gradient_of(x);
    Truth found;
    const Matrix R = rotation(F, found);
    for (int k = 0; k < kWidth; ++k) missing |= found[k] ? 0U : 1U << (first + k);
    visit(part, F, R);
  }
  return missing;
}

/// Matrix times the gradients of the four nodes.
void put_forces(const Matrix& P, const Part& part, Eight (&force)[4][3]) {
  Vector sum = {};
  for (int a = 0; a < 3; ++a) {
    const Vector f = P * part.gradient(a);
    store(force[a][0] + part.first, f.x);
    store(force[a][1] + part.first, f.y);
    store(force[a][2] + part.first, f.z);
    sum = sum + f;
  }
  store(force[3][0] + part.first, -sum.x);
  store(force[3][1] + part.first, -sum.y);
  store(force[3][2] + part.first, -sum.z);
}

unsigned forces(const TetBatch& batch, const double* x, const double* start, double rate, TetForces& forces) {
  return each_part(batch, x, [&](const Part& part, const Matrix& F, const Matrix& R) {
    const Lanes pressure = part(batch.lambda) * (dot(R, F) - 3.0);
    put_forces((F - R) * (2.0 * part(batch.mu)) + R * pressure, part, forces.elastic);
    if (rate == 0.0) return;
    // E - E_0 = sym((F_0 + dF / 2)^T dF)
    const Matrix dF = part.gradient_of_motion(x, start), middle = F - dF * (Lanes{} + 0.5);
    const Lanes xx = dot(middle.c0, dF.c0), yy = dot(middle.c1, dF.c1), zz = dot(middle.c2, dF.c2);
    const Lanes mu = rate * part(batch.viscous_mu), trace = rate * part(batch.viscous_lambda) * (xx + yy + zz);
    const Lanes xy = mu * (dot(middle.c0, dF.c1) + dot(middle.c1, dF.c0));
    const Lanes yz = mu * (dot(middle.c1, dF.c2) + dot(middle.c2, dF.c1));
    const Lanes zx = mu * (dot(middle.c2, dF.c0) + dot(middle.c0, dF.c2));
    const Matrix S = {
        {2.0 * mu * xx + trace, xy, zx}, {xy, 2.0 * mu * yy + trace, yz}, {zx, yz, 2.0 * mu * zz + trace}};
    put_forces({F * S.c0, F * S.c1, F * S.c2}, part, forces.viscous);
  });
}

unsigned stiffness(const TetBatch& batch, const double* x, double rate, TetStiffness& stiffness) {
  return each_part(batch, x, [&](const Part& part, const Matrix& F, const Matrix& R) {
    const Lanes mu = part(batch.mu), lambda = part(batch.lambda);
    const Lanes viscous_mu = rate * part(batch.viscous_mu), viscous_lambda = rate * part(batch.viscous_lambda);
    // mu (g_a . g_b + R g_b (R g_a)^T) + lambda R g_a (R g_b)^T, and the same with F and F F^T in place of R and 1.
    Vector g[4] = {part.gradient(0), part.gradient(1), part.gradient(2), {}};
    g[3] = -(g[0] + g[1] + g[2]);
    Vector turned[4], moved[4];
    for (int a = 0; a < 4; ++a) {
      turned[a] = R * g[a];
      moved[a] = F * g[a];
    }
    // F F^T
    const Vector r0 = {F.c0.x, F.c1.x, F.c2.x}, r1 = {F.c0.y, F.c1.y, F.c2.y}, r2 = {F.c0.z, F.c1.z, F.c2.z};
    const Lanes diagonal[3] = {mu + viscous_mu * dot(r0, r0), mu + viscous_mu * dot(r1, r1),
                               mu + viscous_mu * dot(r2, r2)};
    const Lanes xy = viscous_mu * dot(r0, r1), yz = viscous_mu * dot(r1, r2), zx = viscous_mu * dot(r2, r0);
    for (int a = 0; a < 4; ++a) {
      const Vector ta = turned[a] * mu, la = turned[a] * lambda;
      const Vector ma = moved[a] * viscous_mu, na = moved[a] * viscous_lambda;
      for (int b = 0; b <= a; ++b) {
        const Lanes common = dot(g[a], g[b]);
        const Vector &t = turned[b], &m = moved[b];
        // Entry (row, column): t_row ta_column + la_row t_column + ...
        const auto column = [&](const Lanes& tc, const Lanes& lc, const Lanes& mc, const Lanes& nc) -> Vector {
          return t * tc + la * lc + m * mc + na * nc;
        };
        Vector c0 = column(ta.x, t.x, ma.x, m.x), c1 = column(ta.y, t.y, ma.y, m.y), c2 = column(ta.z, t.z, ma.z, m.z);
        c0 = c0 + Vector{diagonal[0] * common, xy * common, zx * common};
        c1 = c1 + Vector{xy * common, diagonal[1] * common, yz * common};
        c2 = c2 + Vector{zx * common, yz * common, diagonal[2] * common};
        Eight(&block)[9] = stiffness.block[a * (a + 1) / 2 + b];
        store(block[0] + part.first, c0.x);
        store(block[1] + part.first, c0.y);
        store(block[2] + part.first, c0.z);
        store(block[3] + part.first, c1.x);
        store(block[4] + part.first, c1.y);
        store(block[5] + part.first, c1.z);
        store(block[6] + part.first, c2.x);
        store(block[7] + part.first, c2.y);
        store(block[8] + part.first, c2.z);
      }
    }
  });
}

using Four [[gnu::vector_size(32), gnu::aligned(8), gnu::may_alias]] = double;
const Four& four(const double* p) { return *reinterpret_cast<const Four*>(p); }
void add_four(double* p, const Four& v) { *reinterpret_cast<Four*>(p) += v; }

/// Columns of blocks come as one number of eight elements after the other, and go as three numbers of one element.
void add(const TetStiffness& stiffness, const TetPlaces& places, double* numbers) {
  for (int k = 0; k < 10; ++k) {
    for (int column = 0; column < 3; ++column) {
      const Eight* rows = stiffness.block[k] + 3 * column;
      for (int first = 0; first < kBatch; first += 4) {
        const Four a = four(rows[0] + first), b = four(rows[1] + first), c = four(rows[2] + first), none = {};
        const Four ab02 = __builtin_shufflevector(a, b, 0, 4, 2, 6), ab13 = __builtin_shufflevector(a, b, 1, 5, 3, 7);
        const Four c02 = __builtin_shufflevector(c, none, 0, 4, 2, 6),
                   c13 = __builtin_shufflevector(c, none, 1, 5, 3, 7);
        double* const own = numbers + 4 * column;
        const std::uint32_t* at = places.block[k] + first;
        add_four(own + at[0], __builtin_shufflevector(ab02, c02, 0, 1, 4, 5));
        add_four(own + at[1], __builtin_shufflevector(ab13, c13, 0, 1, 4, 5));
        add_four(own + at[2], __builtin_shufflevector(ab02, c02, 2, 3, 6, 7));
        add_four(own + at[3], __builtin_shufflevector(ab13, c13, 2, 3, 6, 7));
      }
    }
  }
}

}  // namespace

const TetKernels SINEW_KERNELS{SINEW_NAME, forces, stiffness, add};

}  // namespace sinew::solid
