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

void add(const Vector& v, Eight (&sum)[3], int first) {
  lanes::store(sum[0] + first, load(sum[0] + first) + v.x);
  lanes::store(sum[1] + first, load(sum[1] + first) + v.y);
  lanes::store(sum[2] + first, load(sum[2] + first) + v.z);
}

void add(const Vector& above, const Vector& below, Eight (&sum)[6], int first) {
  const Lanes numbers[6] = {above.x, above.y, above.z, below.x, below.y, below.z};
  for (int i = 0; i < 6; ++i) lanes::store(sum[i] + first, load(sum[i] + first) + numbers[i]);
}

/// A^T B.
Matrix transposed_times(const Matrix& A, const Matrix& B) {
  return {lanes::transposed_times(A, B.c0), lanes::transposed_times(A, B.c1), lanes::transposed_times(A, B.c2)};
}

/// Exponentials of some sections.
struct Exponential {
  Matrix R;  ///< where they begin
  Lanes length;
  Vector rho;
  Tangent map;
  Vector end;

  Exponential(const SectionLanes& from, const Lanes& own_length, const Vector& f, const Lanes& z, const Stumpff& of,
              int first)
      : R(part(from.R, first)),
        length(own_length),
        rho(part(from.translation, first) * own_length),
        map(f, z, of.C),
        end(part(from.p, first) + R * (map * rho)) {}
};

/// The loads beyond them.
struct Loads {
  Vector moment, force, bending_moment, bending_force;
  Matrix second;
  Vector lever;
  Lanes weight;
};

void cross(const Exponential& to, const Loads& beyond, CrossedLanes& crossed, int first) {
  // The twists of the exponential: it turns what lies beyond by `turn` about the origin and moves that by `move`.
  const Matrix turn = to.R * to.map.matrix(), shift = to.R * to.map.gradient(to.rho),
               move = shift + cross(to.end, turn);
  const Vector& world = beyond.bending_force;
  const Vector bending = beyond.bending_moment - cross(to.end, world);
  const Vector force = lanes::transposed_times(to.R, world), moment = lanes::transposed_times(to.R, bending);
  // The moment about the end changes as the end moves.
  const Matrix H =
      to.map.transposed_gradient(moment) + to.map.hessian(to.rho, force) + transposed_times(turn, cross(world, shift));
  // K of rod/beyond: its upper left is the trace of `second` less itself.
  const Lanes trace = beyond.second.c0.x + beyond.second.c1.y + beyond.second.c2.z;
  const Matrix above = turn * trace - beyond.second * turn + cross(beyond.lever - world, move);
  const Matrix below = move * beyond.weight - cross(beyond.lever, turn);
  const Matrix tangent = H + transposed_times(turn, above) + transposed_times(move, below);
  const Vector gradient = lanes::transposed_times(turn, beyond.moment) + lanes::transposed_times(move, beyond.force);
  const Lanes square = to.length * to.length;
  add(gradient * to.length, crossed.gradient, first);
  add(above.c0 * to.length, below.c0 * to.length, crossed.KT[0], first);
  add(above.c1 * to.length, below.c1 * to.length, crossed.KT[1], first);
  add(above.c2 * to.length, below.c2 * to.length, crossed.KT[2], first);
  add(tangent.c0 * square, crossed.tangent[0], first);
  add(tangent.c1 * square, crossed.tangent[1], first);
  add(tangent.c2 * square, crossed.tangent[2], first);
}

[[gnu::flatten]] void cross(const SectionLanes& sections, const CrossingLanes& crossing, CrossedLanes& crossed) {
  for (int first = 0; first < sections.count; first += kWidth) {
    const Lanes length = load(crossing.length + first);
    const Vector f = part(sections.rotation, first) * length;
    const Lanes z = dot(f, f);
    const Exponential to(sections, length, f, z, Stumpff(z), first);
    const LoadLanes& own = crossing.beyond;
    const Loads beyond = {part(own.moment, first),        part(own.force, first),  part(own.bending_moment, first),
                          part(own.bending_force, first), part(own.second, first), part(own.lever, first),
                          load(own.weight + first)};
    cross(to, beyond, crossed, first);
  }
}

// Points x = Q o feel w x - b: sums of w x, of x b^T, whose skew part is that of -x x f, and of w x x^T.
[[gnu::flatten]] void meet(const SectionLanes& sections, const double (&gravity)[3], bool bends, StationLanes& station,
                           CrossedLanes& crossed, Eight& acting) {
  for (int first = 0; first < sections.count; first += kWidth) {
    const Lanes length = load(station.length + first), none = {};
    const Vector f = part(sections.rotation, first) * length;
    const Lanes z = dot(f, f);
    const Stumpff of(z);
    const Exponential to(sections, length, f, z, of, first);
    const Matrix frame = to.R * RotationMap{f, z, of.C[1], of.C[2]}.matrix();
    const Matrix Q = {to.end, frame.c1, frame.c2}, weight = part(station.weight, first),
                 pull = part(station.pull, first);
    const Vector lever = Q * weight.c0, force = lever - pull.c0;
    const Matrix pulled = outer(Q.c0, pull.c0) + outer(Q.c1, pull.c1) + outer(Q.c2, pull.c2);
    const Vector moment = {pulled.c1.z - pulled.c2.y, pulled.c2.x - pulled.c0.z, pulled.c0.y - pulled.c1.x};
    Loads beyond = {moment, force, moment, force, pulled, lever, weight.c0.x};
    if (!bends) {
      const Matrix QJ = Q * weight;
      beyond.bending_moment = beyond.bending_force = {none, none, none};
      beyond.second = outer(QJ.c0, Q.c0) + outer(QJ.c1, Q.c1) + outer(QJ.c2, Q.c2);
    }
    const Vector heavy = all(gravity) * load(station.mass + first), inertia = force + heavy;
    Lanes size = dot(inertia, inertia);
    for (int k = 0; k < kWidth; ++k) size[k] = __builtin_sqrt(size[k]);
    lanes::store(acting + first, load(acting + first) + size);
    LoadLanes& own = station.loads;
    store(beyond.moment, own.moment, first);
    store(beyond.force, own.force, first);
    store(beyond.bending_moment, own.bending_moment, first);
    store(beyond.bending_force, own.bending_force, first);
    store(beyond.second.c0, own.second[0], first);
    store(beyond.second.c1, own.second[1], first);
    store(beyond.second.c2, own.second[2], first);
    store(beyond.lever, own.lever, first);
    lanes::store(own.weight + first, beyond.weight);
    cross(to, beyond, crossed, first);
  }
}

}  // namespace

const RodKernels SINEW_KERNELS{SINEW_NAME, cross, meet, reach};

}  // namespace sinew::rod
