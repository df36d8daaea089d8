#include "sinew/solid/corotational.hpp"

#include <Eigen/Dense>
#include <cmath>

#include "sinew/lie/rotation.hpp"

namespace sinew::solid {

Lame lame(double young, double poisson) {
  return {young / (2.0 * (1.0 + poisson)), young * poisson / ((1.0 + poisson) * (1.0 - 2.0 * poisson))};
}

Mat3 polar_rotation(const Mat3& F) {
  const Eigen::JacobiSVD<Mat3> svd(F, Eigen::ComputeFullU | Eigen::ComputeFullV);
  Mat3 U = svd.matrixU();
  if ((U * svd.matrixV().transpose()).determinant() < 0.0)
    U.col(2) *= -1.0;  // turn the smallest stretch, it is the cheapest
  return U * svd.matrixV().transpose();
}

double energy_density(const Lame& material, const Mat3& F, const Mat3& R) {
  const double trace = (R.transpose() * F).trace() - 3.0;
  return material.mu * (F - R).squaredNorm() + 0.5 * material.lambda * trace * trace;
}

Mat3 stress(const Lame& material, const Mat3& F, const Mat3& R) {
  const double trace = (R.transpose() * F).trace() - 3.0;
  return 2.0 * material.mu * (F - R) + material.lambda * trace * R;
}

Mat3 corotated_stress(const Lame& material, const Mat3& F, const Mat3& R) {
  const Mat3 T = F * R.transpose();  // left stretch, up to rounding symmetric
  const Mat3 e = 0.5 * (T + T.transpose()) - Mat3::Identity();
  return 2.0 * material.mu * e + material.lambda * e.trace() * Mat3::Identity();
}

TangentFrame exact_tangent(const Lame& material, const Mat3& F, const Mat3& R) {
  const Mat3 T = 0.5 * (F * R.transpose() + R * F.transpose());
  const double trace = T.trace();
  Mat3 D = trace * Mat3::Identity() - T;
  const double determinant = D.determinant(), scale = std::pow(std::abs(trace) + T.norm(), 3);
  // Where two stretches add up to zero the frame may turn freely (an inverted element on the edge of another rotation):
  // frozen there, the tangent stays finite.
  if (!(std::abs(determinant) > 1e-9 * scale)) return rotated_tangent(material, R);
  return {R, D.inverse(), material.lambda * (trace - 3.0) - 2.0 * material.mu};
}

TangentFrame rotated_tangent(const Lame& material, const Mat3& R) {
  return {R, 0.5 * Mat3::Identity(), -2.0 * material.mu};
}

Mat3 stiffness_block(const Lame& material, const TangentFrame& frame, const Vec3& gradient_i, const Vec3& gradient_j) {
  const Vec3 bi = frame.R * gradient_i, bj = frame.R * gradient_j;
  Mat3 K = material.lambda * bi * bj.transpose() - frame.turning * (lie::hat(bi) * frame.G * lie::hat(bj));
  K.diagonal().array() += 2.0 * material.mu * gradient_i.dot(gradient_j);
  return K;
}

double von_mises(const Mat3& cauchy) {
  const Mat3 deviator = cauchy - cauchy.trace() / 3.0 * Mat3::Identity();
  return std::sqrt(1.5) * deviator.norm();
}

}  // namespace sinew::solid
