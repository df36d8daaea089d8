// Rotation vectors: the exponential of so(3), its integral, and their first and second derivatives.
//
// Everything a section of constant strain needs is one family of maps of a rotation vector f, z = |f|^2:
//
//     M(f) y = c(z) y + a(z) f x y + b(z) f x (f x y),        c = 1,
//     exp(f)            = M with a = C1, b = C2               (Rodrigues)
//     V(f) = int_0^1 exp(t f) dt = M with a = C2, b = C3      (the left tangent operator of SO(3))
//
// where C_n(z) = sum_k (-z)^k / (2k + n)! are entire (Stumpff) functions, smooth at 0: no division by an angle
// anywhere. The maths is derived in README.md of this folder.
#pragma once

#include <Eigen/Core>
#include <array>

namespace sinew::lie {

using Vec3 = Eigen::Vector3d;
using Mat3 = Eigen::Matrix3d;

/// [v]x with [v]x w = v x w.
inline Mat3 hat(const Vec3& v) {
  Mat3 h;
  h << 0.0, -v.z(), v.y(), v.z(), 0.0, -v.x(), -v.y(), v.x(), 0.0;
  return h;
}

/// C_0 .. C_7 at z >= 0 to rounding accuracy (relative 1e-15, except near the zeros of C_0 and C_1).
std::array<double, 8> stumpff(double z);

/// A map M(f) of the family above: coefficients a, b and their first two derivatives with respect to z.
class RotationMap {
 public:
  RotationMap() = default;  ///< nothing yet
  /// exp(f), the rotation by |f| about f.
  static RotationMap exponential(const Vec3& f);
  /// V(f) = int_0^1 exp(t f) dt; d exp(f) exp(f)^-1 = [V(f) df]x.
  static RotationMap tangent(const Vec3& f);
  /// exp and V at the cost of one.
  static std::array<RotationMap, 2> both(const Vec3& f);

  Mat3 matrix() const;
  Vec3 operator*(const Vec3& y) const;
  /// d(M(f) y)/df, 3 x 3.
  Mat3 gradient(const Vec3& y) const;
  /// d(M(f)^T m)/df, 3 x 3: the mixed derivative of m . M(f) y with respect to y (rows) and f (columns).
  Mat3 transposed_gradient(const Vec3& m) const;
  /// d2/df2 of sum_i m_i . M(f) y_i, symmetric 3 x 3, given S = sum_i y_i m_i^T (the sum enters only through S).
  Mat3 hessian(const Mat3& S) const;

 private:
  RotationMap(const Vec3& f, const std::array<double, 8>& C, int n);
  Vec3 f_;
  double z_, a_, b_, da_, db_, dda_, ddb_;
};

/// exp(f) as a matrix.
Mat3 exp(const Vec3& f);

/// The rotation vector of R, |f| <= pi. Accurate at 0 and near pi.
Vec3 log(const Mat3& R);

/// R = Rz(c) Ry(b) Rx(a) for angles (a, b, c) [rad]: the placement convention of NOTATION.md.
Mat3 from_euler_xyz(const Vec3& angles);

/// Rotation vector of the smallest rotation that takes the unit vector u to the unit vector w; when they are opposite,
/// half a turn about an axis perpendicular to u.
Vec3 shortest_rotation(const Vec3& u, const Vec3& w);

}  // namespace sinew::lie
