#include "sinew/solid/corotational.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "sinew/lie/rotation.hpp"
#include "sinew/solid/invariants.hpp"

namespace sinew::solid {
namespace {

Mat3 polar_by_svd(const Mat3& F) {
  const Eigen::JacobiSVD<Mat3> svd(F, Eigen::ComputeFullU | Eigen::ComputeFullV);
  Mat3 U = svd.matrixU();
  if ((U * svd.matrixV().transpose()).determinant() < 0.0)
    U.col(2) *= -1.0;  // turn the smallest stretch, it is the cheapest
  const Mat3 R = U * svd.matrixV().transpose();
  return 0.5 * (R + cofactor(R) / R.determinant());  // one step of Newton: orthogonal to the last digit
}

}  // namespace

// Newton for R^T R = I: X <- (g X + X^-T / g) / 2 halves the distance of every stretch to 1, then squares it; g brings
// the stretches together as long as they are far from 1 (Higham, Functions of Matrices, chapter 8).
Mat3 polar_rotation(const Mat3& F) {
  constexpr int kMost = 12;
  Mat3 X = F;
  bool far = true;
  for (int i = 0; i < kMost; ++i) {
    const Mat3 C = cofactor(X);
    const double J = X.col(0).dot(C.col(0)), size = X.squaredNorm();
    // Nearly flat or inverted (J of a rotation is 1, its squared norm 3): Newton would lose digits or end at a mirror.
    if (i == 0 && !(J > 0.0 && J * J > 1e-6 * size * size * size)) return polar_by_svd(F);
    const double g = far ? std::sqrt(std::sqrt(C.squaredNorm() / size) / J) : 1.0;
    const Mat3 next = 0.5 * g * X + 0.5 / (g * J) * C;
    const double change = (next - X).squaredNorm();  // the error left is half of this
    X = next;
    if (change < 1e-16) return X;
    far = change > 1e-2;
  }
  return polar_by_svd(F);
}

Turning frozen_turning(const Mat3& F, Derivatives wanted) {
  Turning turning{polar_rotation(F), Mat9(), true};
  if (wanted != Derivatives::second) return turning;
  const Mat3& R = turning.R;
  for (int j = 0; j < 3; ++j) {  // (dF - R dF^T R) / 2
    for (int k = 0; k < 3; ++k) {
      turning.slope.block<3, 3>(3 * j, 3 * k) = -0.5 * R.col(k) * R.col(j).transpose();
    }
  }
  turning.slope.diagonal().array() += 0.5;
  return turning;
}

// dR = [omega]x R,  (tr T I - T) omega = axial(dF R^T - R dF^T),  T = R S R^T  (McAdams et al. 2011).
// With H = ([R_0]x [R_1]x [R_2]x) over the columns of R the right side is H vec(dF), and vec(dR) = H^T omega.
Turning exact_turning(const Mat3& F, Derivatives wanted) {
  if (wanted != Derivatives::second) return {polar_rotation(F), Mat9(), false};
  const Mat3 R = polar_rotation(F);
  const Mat3 T = 0.5 * (F * R.transpose() + R * F.transpose());
  const double trace = T.trace();
  const Mat3 D = trace * Mat3::Identity() - T;
  const double determinant = D.determinant(), scale = std::pow(std::abs(trace) + T.norm(), 3);
  if (!(std::abs(determinant) > 1e-9 * scale)) return frozen_turning(F, wanted);
  Eigen::Matrix<double, 3, 9> H;
  H << lie::hat(R.col(0)), lie::hat(R.col(1)), lie::hat(R.col(2));
  const Eigen::Matrix<double, 3, 9> GH = D.inverse() * H;
  return {R, H.transpose() * GH, false};
}

}  // namespace sinew::solid
