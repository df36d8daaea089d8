// Vectors and matrices of numbers that are worked on side by side, one in each lane of a register. Only for files that
// are compiled once for each width of registers, SINEW_LANES doubles: so all of it belongs to the file that includes
// it.
#pragma once

namespace sinew::lanes {
namespace {  // NOLINT(google-build-namespaces)

constexpr int kWidth = SINEW_LANES;
using Lanes [[gnu::vector_size(8 * SINEW_LANES), gnu::aligned(8), gnu::may_alias]] = double;
using Truth [[gnu::vector_size(8 * SINEW_LANES)]] = long long;

inline Lanes load(const double* p) { return *reinterpret_cast<const Lanes*>(p); }
inline void store(double* p, const Lanes& v) { *reinterpret_cast<Lanes*>(p) = v; }

struct Vector {
  Lanes x, y, z;
};
inline Vector operator+(const Vector& a, const Vector& b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
inline Vector operator-(const Vector& a, const Vector& b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
inline Vector operator-(const Vector& a) { return {-a.x, -a.y, -a.z}; }
inline Vector operator*(const Vector& a, const Lanes& s) { return {a.x * s, a.y * s, a.z * s}; }
inline Lanes dot(const Vector& a, const Vector& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
inline Vector cross(const Vector& a, const Vector& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

/// A matrix by its columns.
struct Matrix {
  Vector c0, c1, c2;
};
inline Matrix operator+(const Matrix& A, const Matrix& B) { return {A.c0 + B.c0, A.c1 + B.c1, A.c2 + B.c2}; }
inline Matrix operator-(const Matrix& A, const Matrix& B) { return {A.c0 - B.c0, A.c1 - B.c1, A.c2 - B.c2}; }
inline Matrix operator*(const Matrix& A, const Lanes& s) { return {A.c0 * s, A.c1 * s, A.c2 * s}; }
inline Vector operator*(const Matrix& A, const Vector& v) { return A.c0 * v.x + A.c1 * v.y + A.c2 * v.z; }
inline Matrix operator*(const Matrix& A, const Matrix& B) { return {A * B.c0, A * B.c1, A * B.c2}; }
inline Lanes dot(const Matrix& A, const Matrix& B) { return dot(A.c0, B.c0) + dot(A.c1, B.c1) + dot(A.c2, B.c2); }
/// A^T v.
inline Vector transposed_times(const Matrix& A, const Vector& v) { return {dot(A.c0, v), dot(A.c1, v), dot(A.c2, v)}; }
/// u v^T.
inline Matrix outer(const Vector& u, const Vector& v) { return {u * v.x, u * v.y, u * v.z}; }
/// v x A, by columns.
inline Matrix cross(const Vector& v, const Matrix& A) { return {cross(v, A.c0), cross(v, A.c1), cross(v, A.c2)}; }

}  // namespace
}  // namespace sinew::lanes
