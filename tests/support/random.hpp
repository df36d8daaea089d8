// Random numbers, the same on every machine with one standard library.
#pragma once

#include <Eigen/Geometry>
#include <random>

namespace sinew::test {

class Random {
 public:
  explicit Random(unsigned seed) : engine_(seed) {}
  double operator()(double from, double to) { return std::uniform_real_distribution<double>(from, to)(engine_); }
  int whole(int from, int to) { return std::uniform_int_distribution<int>(from, to)(engine_); }
  bool chance(double part) { return (*this)(0.0, 1.0) < part; }
  /// In the cube of this half edge.
  Eigen::Vector3d vector(double size) {
    const double x = (*this)(-size, size), y = (*this)(-size, size);
    return {x, y, (*this)(-size, size)};
  }
  /// Any, all as likely.
  Eigen::Matrix3d rotation() {
    const Eigen::Vector4d q(Eigen::Vector4d::NullaryExpr([&] { return std::normal_distribution<double>()(engine_); }));
    return Eigen::Quaterniond(q).normalized().toRotationMatrix();
  }
  /// Turned anyhow, in the cube of this half edge: a contact::Pose, a Placement.
  template <class Placed>
  Placed placed(double far) {
    return Placed{rotation(), vector(far)};
  }

 private:
  std::mt19937 engine_;
};

}  // namespace sinew::test
