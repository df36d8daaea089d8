#include "sinew/lie/rotation.hpp"

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

namespace sinew::lie {

namespace {

constexpr std::array<double, 8> kInverseFactorial = {1.0,      1.0,       1.0 / 2,   1.0 / 6,
                                                     1.0 / 24, 1.0 / 120, 1.0 / 720, 1.0 / 5040};

/// Terms that sum_k (-z)^k / (2k + n)! needs, n = 6 and 7, below 1e-18 of it, up to z = 0.25 and up to z = 9.
constexpr int kFewTerms = 7, kAllTerms = 13;

/// 1 / (2k + n)!
constexpr std::array<double, kAllTerms> series_coefficients(int n) {
  std::array<double, kAllTerms> c{};
  double factorial = 1.0;
  for (int i = 2; i <= n; ++i) factorial *= i;
  for (int k = 0; k < kAllTerms; ++k) {
    c[static_cast<std::size_t>(k)] = 1.0 / factorial;
    factorial *= (2.0 * k + n + 1.0) * (2.0 * k + n + 2.0);
  }
  return c;
}
constexpr auto kSeries6 = series_coefficients(6), kSeries7 = series_coefficients(7);

/// The first terms of both series by Horner's rule.
template <int terms>
void sum_series(double z, std::array<double, 8>& C) {
  double six = kSeries6[terms - 1], seven = kSeries7[terms - 1];
  for (std::size_t k = terms - 1; k-- > 0;) {
    six = kSeries6[k] - z * six;
    seven = kSeries7[k] - z * seven;
  }
  C[6] = six;
  C[7] = seven;
}

}  // namespace

std::array<double, 8> stumpff(double z) {
  std::array<double, 8> C{};
  if (z < 9.0) {
    z < 0.25 ? sum_series<kFewTerms>(z, C) : sum_series<kAllTerms>(z, C);
    for (int n = 5; n >= 0; --n) C[n] = kInverseFactorial[n] - z * C[n + 2];  // stable downwards for small z
  } else {
    const double angle = std::sqrt(z);
    C[0] = std::cos(angle);
    C[1] = std::sin(angle) / angle;
    for (int n = 0; n < 6; ++n) C[n + 2] = (kInverseFactorial[n] - C[n]) / z;  // stable upwards for large z
  }
  return C;
}

RotationMap::RotationMap(const Vec3& f, const std::array<double, 8>& C, int n) : f_(f), z_(f.squaredNorm()) {
  // C_n' = (n C_{n+2} - C_{n+1}) / 2
  const auto d = [&C](int k) { return 0.5 * (k * C[k + 2] - C[k + 1]); };
  const auto dd = [&d](int k) { return 0.5 * (k * d(k + 2) - d(k + 1)); };
  a_ = C[n];
  b_ = C[n + 1];
  da_ = d(n);
  db_ = d(n + 1);
  dda_ = dd(n);
  ddb_ = dd(n + 1);
}

RotationMap RotationMap::exponential(const Vec3& f) { return {f, stumpff(f.squaredNorm()), 1}; }

RotationMap RotationMap::tangent(const Vec3& f) { return {f, stumpff(f.squaredNorm()), 2}; }

std::array<RotationMap, 2> RotationMap::both(const Vec3& f) {
  const auto C = stumpff(f.squaredNorm());
  return {RotationMap(f, C, 1), RotationMap(f, C, 2)};
}

Mat3 RotationMap::matrix() const {
  // f x (f x y) = f (f . y) - z y
  Mat3 m = b_ * f_ * f_.transpose() + a_ * hat(f_);
  m.diagonal().array() += 1.0 - b_ * z_;
  return m;
}

Vec3 RotationMap::operator*(const Vec3& y) const {
  const Vec3 fy = f_.cross(y);
  return y + a_ * fy + b_ * f_.cross(fy);
}

Mat3 RotationMap::gradient(const Vec3& y) const {
  const Vec3 fy = f_.cross(y);
  const Vec3 radial = 2.0 * da_ * fy + 2.0 * db_ * f_.cross(fy);  // dz = 2 f . df
  Mat3 g = radial * f_.transpose() - a_ * hat(y) + b_ * (f_ * y.transpose() - 2.0 * y * f_.transpose());
  g.diagonal().array() += b_ * f_.dot(y);
  return g;
}

Mat3 RotationMap::transposed_gradient(const Vec3& m) const {
  const Vec3 mf = m.cross(f_);  // M^T has -a for a
  const Vec3 radial = 2.0 * da_ * mf + 2.0 * db_ * (f_ * f_.dot(m) - z_ * m);
  Mat3 g = radial * f_.transpose() + a_ * hat(m) + b_ * (f_ * m.transpose() - 2.0 * m * f_.transpose());
  g.diagonal().array() += b_ * f_.dot(m);
  return g;
}

Mat3 RotationMap::hessian(const Mat3& S) const {
  // sum m . M y = t + a (f . A) + b B,  A = sum y x m,  t = tr S,  B = f^T S f - z t.
  const Vec3 A(S(1, 2) - S(2, 1), S(2, 0) - S(0, 2), S(0, 1) - S(1, 0));
  const double t = S.trace();
  const Mat3 Q = S + S.transpose();
  const Vec3 dB = Q * f_ - 2.0 * t * f_;
  const double B = 0.5 * f_.dot(Q * f_) - z_ * t;
  const double fA = f_.dot(A);
  Mat3 H = 2.0 * da_ * (A * f_.transpose() + f_ * A.transpose()) +
           2.0 * db_ * (dB * f_.transpose() + f_ * dB.transpose()) +
           4.0 * (dda_ * fA + ddb_ * B) * f_ * f_.transpose() + b_ * Q;
  H.diagonal().array() += 2.0 * da_ * fA + 2.0 * db_ * B - 2.0 * b_ * t;
  return H;
}

Mat3 exp(const Vec3& f) { return RotationMap::exponential(f).matrix(); }

Vec3 log(const Mat3& R) {
  // Through the quaternion, whose vector part is sin(angle / 2) times the axis: well conditioned at 0 and at pi.
  Eigen::Quaterniond q(R);
  if (q.w() < 0.0) q.coeffs() *= -1.0;
  const double s = q.vec().norm();
  if (s < 1e-9) return 2.0 * q.vec() / q.w();
  return 2.0 * std::atan2(s, q.w()) / s * q.vec();
}

Mat3 from_euler_xyz(const Vec3& angles) {
  return exp(angles.z() * Vec3::UnitZ()) * exp(angles.y() * Vec3::UnitY()) * exp(angles.x() * Vec3::UnitX());
}

Vec3 shortest_rotation(const Vec3& u, const Vec3& w) {
  const Vec3 axis = u.cross(w);
  const double sine = axis.norm(), cosine = u.dot(w);
  if (sine > 1e-14) return axis * (std::atan2(sine, cosine) / sine);
  if (cosine > 0.0) return Vec3::Zero();
  return std::numbers::pi * u.unitOrthogonal();
}

}  // namespace sinew::lie
