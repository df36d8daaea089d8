// Compiled once for each width of registers, as linalg/kernels_lanes.cpp: it includes nothing of others.
#include "sinew/linalg/lanes.hpp"
#include "sinew/rod/crossings.hpp"

namespace sinew::rod {

extern const RodKernels SINEW_KERNELS;

namespace {

using namespace lanes;

Lanes all(double value) { return Lanes{} + value; }
Vector all(const double (&v)[3]) { return {all(v[0]), all(v[1]), all(v[2])}; }
Matrix all(const double (&A)[3][3]) { return {all(A[0]), all(A[1]), all(A[2])}; }
Vector part(const Eight (&v)[3], int first) { return {load(v[0] + first), load(v[1] + first), load(v[2] + first)}; }
Matrix part(const Eight (&A)[3][3], int first) { return {part(A[0], first), part(A[1], first), part(A[2], first)}; }

/// 1 / (2k + n)! for n = 6 and 7.
struct Series {
  static constexpr int kTerms = 13, kFew = 7;  ///< up to z = 9, and up to 0.25 (lie/rotation)
  double six[kTerms] = {}, seven[kTerms] = {};
  constexpr Series() {
    double factorial = 720.0;
    for (int k = 0; k < kTerms; ++k) {
      six[k] = 1.0 / factorial;
      factorial *= 2.0 * k + 7.0;
      seven[k] = 1.0 / factorial;
      factorial *= 2.0 * k + 8.0;
    }
  }
};
constexpr Series kSeries;

/// C_1 .. C_7 of lie/rotation.
struct Stumpff {
  Lanes C[8];

  explicit Stumpff(const Lanes& z) {
    bool few = true;
    for (int k = 0; k < kWidth; ++k) few &= z[k] < 0.25;
    const int terms = few ? Series::kFew : Series::kTerms;
    C[6] = all(kSeries.six[terms - 1]);
    C[7] = all(kSeries.seven[terms - 1]);
    for (int k = terms - 2; k >= 0; --k) {
      C[6] = kSeries.six[k] - z * C[6];
      C[7] = kSeries.seven[k] - z * C[7];
    }
    C[5] = 1.0 / 120.0 - z * C[7];
    C[4] = 1.0 / 24.0 - z * C[6];
    C[3] = 1.0 / 6.0 - z * C[5];
    C[2] = 0.5 - z * C[4];
    C[1] = 1.0 - z * C[3];
  }
};

/// The map M(f) of lie/rotation with coefficients a and b.
struct RotationMap {
  Vector f;
  Lanes z, a, b;

  Vector operator*(const Vector& y) const {
    const Vector fy = cross(f, y);
    return y + fy * a + cross(f, fy) * b;
  }
  Matrix matrix() const {
    Matrix m = outer(f * b, f);
    const Vector g = f * a;
    const Lanes d = 1.0 - b * z;
    m.c0 = m.c0 + Vector{d, g.z, -g.y};
    m.c1 = m.c1 + Vector{-g.z, d, g.x};
    m.c2 = m.c2 + Vector{g.y, -g.x, d};
    return m;
  }
};

/// V(f), and the derivatives of its coefficients with respect to z = |f|^2.
struct Tangent : RotationMap {
  Lanes da, db, dda, ddb;

  Tangent(const Vector& angle, const Lanes& square, const Lanes (&C)[8]) : RotationMap{angle, square, C[2], C[3]} {
    // C_n' = (n C_{n+2} - C_{n+1}) / 2
    const Lanes d4 = 0.5 * (4.0 * C[6] - C[5]), d5 = 0.5 * (5.0 * C[7] - C[6]);
    da = 0.5 * (2.0 * C[4] - C[3]);
    db = 0.5 * (3.0 * C[5] - C[4]);
    dda = 0.5 * (2.0 * d4 - db);
    ddb = 0.5 * (3.0 * d5 - d4);
  }
  /// radial f^T + sign a [y]x + b (f y^T - 2 y f^T + f . y).
  Matrix gradient(const Vector& radial, const Vector& y, double sign) const {
    const Vector by = y * b, ay = y * (sign * a), left = radial - by * all(2.0);
    const Lanes d = dot(f, by);
    Matrix g = outer(left, f) + outer(f, by);
    g.c0 = g.c0 + Vector{d, ay.z, -ay.y};
    g.c1 = g.c1 + Vector{-ay.z, d, ay.x};
    g.c2 = g.c2 + Vector{ay.y, -ay.x, d};
    return g;
  }
  /// d(V y)/df.
  Matrix gradient(const Vector& y) const {
    const Vector fy = cross(f, y);
    return gradient(fy * (2.0 * da) + cross(f, fy) * (2.0 * db), y, -1.0);
  }
  /// d(V^T m)/df.
  Matrix transposed_gradient(const Vector& m) const {
    return gradient(cross(m, f) * (2.0 * da) + (f * dot(f, m) - m * z) * (2.0 * db), m, 1.0);
  }
  /// d2/df2 of m . V y.
  Matrix hessian(const Vector& y, const Vector& m) const {
    const Vector A = cross(y, m);
    const Lanes t = dot(y, m), yf = dot(y, f), mf = dot(m, f), fA = dot(f, A), B = yf * mf - z * t;
    const Vector dB = y * mf + m * yf - f * (2.0 * t);
    const Vector side = A * (2.0 * da) + dB * (2.0 * db);
    const Vector own = side + f * (4.0 * (dda * fA + ddb * B));
    Matrix H = outer(own, f) + outer(f, side) + outer(y * b, m) + outer(m * b, y);
    const Lanes d = 2.0 * (da * fA + db * B - b * t);
    H.c0.x += d;
    H.c1.y += d;
    H.c2.z += d;
    return H;
  }
};

void store(const Vector& v, Eight (&to)[3], int first) {
  lanes::store(to[0] + first, v.x);
  lanes::store(to[1] + first, v.y);
  lanes::store(to[2] + first, v.z);
}

[[gnu::flatten]] void reach(const Beginning& from, const Eight& length, int count, Reached& reached) {
  const Matrix R = all(from.R);
  for (int first = 0; first < count; first += kWidth) {
    const Lanes own = load(length + first);
    const Vector f = all(from.rotation) * own;
    const Lanes z = dot(f, f);
    const Stumpff of(z);
    const RotationMap turn{f, z, of.C[1], of.C[2]}, tangent{f, z, of.C[2], of.C[3]};
    const Matrix E = R * turn.matrix();
    store(E.c0, reached.R[0], first);
    store(E.c1, reached.R[1], first);
    store(E.c2, reached.R[2], first);
    store(all(from.p) + R * (tangent * (all(from.translation) * own)), reached.p, first);
  }
}

void add(const Vector& v, double* sum) {
  sum[0] += total(v.x);
  sum[1] += total(v.y);
  sum[2] += total(v.z);
}

/// A^T B.
Matrix transposed_times(const Matrix& A, const Matrix& B) {
  return {lanes::transposed_times(A, B.c0), lanes::transposed_times(A, B.c1), lanes::transposed_times(A, B.c2)};
}

[[gnu::flatten]] void cross(const Crossings& given, Crossed& crossed) {
  crossed = {};
  const Beginning& from = given.from;
  const Matrix R = all(from.R);
  for (int first = 0; first < given.count; first += kWidth) {
    const Lanes length = load(given.length + first);
    const Vector rho = all(from.translation) * length, f = all(from.rotation) * length;
    const Lanes z = dot(f, f);
    const Tangent map(f, z, Stumpff(z).C);
    const Vector end = all(from.p) + R * (map * rho);
    // The twists of the exponential: it turns what lies beyond by `turn` about the origin and moves that by `move`.
    const Matrix turn = R * map.matrix(), shift = R * map.gradient(rho), move = shift + cross(end, turn);
    const Vector world = part(given.bending_force, first);
    const Vector bending = part(given.bending_moment, first) - cross(end, world);
    const Vector force = lanes::transposed_times(R, world), moment = lanes::transposed_times(R, bending);
    // The moment about the end changes as the end moves.
    const Matrix H =
        map.transposed_gradient(moment) + map.hessian(rho, force) + transposed_times(turn, cross(world, shift));
    const Vector lever = part(given.lever, first);
    const Matrix above = part(given.turning, first) * turn + cross(lever - world, move);
    const Matrix below = move * load(given.weight + first) - cross(lever, turn);
    const Matrix tangent = H + transposed_times(turn, above) + transposed_times(move, below);
    const Vector gradient = lanes::transposed_times(turn, part(given.moment, first)) +
                            lanes::transposed_times(move, part(given.force, first));
    const Lanes square = length * length;
    add(gradient * length, crossed.gradient);
    add(above.c0 * length, crossed.KT[0]);
    add(above.c1 * length, crossed.KT[1]);
    add(above.c2 * length, crossed.KT[2]);
    add(below.c0 * length, crossed.KT[0] + 3);
    add(below.c1 * length, crossed.KT[1] + 3);
    add(below.c2 * length, crossed.KT[2] + 3);
    add(tangent.c0 * square, crossed.tangent[0]);
    add(tangent.c1 * square, crossed.tangent[1]);
    add(tangent.c2 * square, crossed.tangent[2]);
  }
}

}  // namespace

const RodKernels SINEW_KERNELS{SINEW_NAME, cross, reach};

}  // namespace sinew::rod
