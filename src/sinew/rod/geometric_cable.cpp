#include "sinew/rod/geometric_cable.hpp"

#include <cmath>

namespace sinew::rod {

CableLength cable_length(const GeometricCable& cable, const Placement& base, const Eigen::VectorXd& z) {
  CableLength length;
  cable_length(cable, base, z, length);
  return length;
}

void cable_length(const GeometricCable& cable, const Placement& base, const Eigen::VectorXd& z, CableLength& length) {
  const int n = cable.coordinates();
  length.value = 0.0;
  length.gradient.setZero(n);
  length.hessian.setZero(n, n);
  const double rounding = cable.rounding;
  const Vec3 axis = base.R.col(0);
  for (int i = 0; i < cable.points; ++i) {
    const int to = 1 + 3 * i, from = to - 3;
    const Vec3 start = i == 0 ? Vec3(base.p - z[0] * axis) : Vec3(z.segment<3>(from));
    const Vec3 d = z.segment<3>(to) - start;
    const double l = std::sqrt(d.squaredNorm() + rounding * rounding);
    const Vec3 t = d / l;
    const Mat3 H = (Mat3::Identity() - t * t.transpose()) / l;
    length.value += l;
    length.gradient.segment<3>(to) += t;
    length.hessian.block<3, 3>(to, to) += H;
    if (i == 0) {  // d(start)/d(z_0) = -axis
      length.gradient[0] += axis.dot(t);
      length.hessian(0, 0) += axis.dot(H * axis);
      length.hessian.block<3, 1>(to, 0) += H * axis;
      length.hessian.block<1, 3>(0, to) += (H * axis).transpose();
    } else {
      length.gradient.segment<3>(from) -= t;
      length.hessian.block<3, 3>(from, from) += H;
      length.hessian.block<3, 3>(to, from) -= H;
      length.hessian.block<3, 3>(from, to) -= H;
    }
  }
}

}  // namespace sinew::rod
