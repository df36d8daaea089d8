#include "sinew/lie/rotation.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <functional>
#include <numbers>

namespace sinew::lie {
namespace {

const Vec3 kAxis = Vec3(0.3, -0.5, 0.8).normalized();
const double kAngles[] = {0.0, 1e-8, 1e-5, 0.4, 1.0, 2.99, 3.01, 3.14159, 7.0, 63.0};

/// Central difference of a vector function of a rotation vector.
Mat3 difference(const std::function<Vec3(const Vec3&)>& function, const Vec3& f) {
  const double e = 1e-6;
  Mat3 D;
  for (int i = 0; i < 3; ++i) D.col(i) = (function(f + e * Vec3::Unit(i)) - function(f - e * Vec3::Unit(i))) / (2 * e);
  return D;
}

TEST(Stumpff, agrees_with_a_long_double_series_at_every_size) {
  for (double z : {0.0, 1e-16, 1e-10, 1e-3, 0.5, 4.0, 8.999, 9.0, 9.001, 30.0}) {
    const auto C = stumpff(z);
    for (int n = 0; n < 8; ++n) {
      long double term = 1.0L, sum = 0.0L;
      for (int k = 2; k <= n; ++k) term /= k;
      for (int k = 0; k < 60; ++k) {
        sum += term;
        term *= -static_cast<long double>(z) / ((2.0L * k + n + 1) * (2.0L * k + n + 2));
      }
      EXPECT_NEAR(C[n], static_cast<double>(sum), 2e-14 * std::max(1.0, std::abs(static_cast<double>(sum))))
          << n << " " << z;
      if (n >= 2) {
        EXPECT_NEAR(C[n] / static_cast<double>(sum), 1.0, 1e-12) << n << " " << z;
      }
    }
  }
}

TEST(Rotation, exp_is_a_rotation_and_log_undoes_it) {
  for (double angle : kAngles) {
    const Mat3 R = exp(angle * kAxis);
    EXPECT_LT((R.transpose() * R - Mat3::Identity()).norm(), 1e-14) << angle;
    EXPECT_LT((R - Eigen::AngleAxisd(angle, kAxis).toRotationMatrix()).norm(), 1e-13) << angle;
    if (angle < std::numbers::pi) {
      EXPECT_LT((log(R) - angle * kAxis).norm(), 1e-12) << angle;
    }
  }
}

TEST(Rotation, tangent_is_the_mean_of_exp_along_the_way) {
  for (double angle : kAngles) {
    const int n = 4000;
    Mat3 mean = Mat3::Zero();
    for (int i = 0; i < n; ++i) mean += exp((i + 0.5) / n * angle * kAxis) / n;
    EXPECT_LT((RotationMap::tangent(angle * kAxis).matrix() - mean).norm(), 1e-7 * (1 + angle * angle)) << angle;
  }
}

TEST(Rotation, tangent_is_the_derivative_of_exp) {
  for (double angle : kAngles) {
    const Vec3 f = angle * kAxis, df(0.2, 0.7, -0.4);
    const double e = 1e-6;
    const Mat3 dR = (exp(f + e * df) - exp(f - e * df)) / (2 * e);
    const Mat3 expected = hat(RotationMap::tangent(f) * df) * exp(f);
    EXPECT_GT(expected.norm(), 1e-3);  // (averages to nearly nothing over ten turns, but not to nothing)
    EXPECT_LT((dR - expected).norm(), 1e-8) << angle;
  }
}

TEST(Rotation, first_and_second_derivatives_match_finite_differences) {
  const Vec3 y(0.9, -0.2, 0.5), m(-0.3, 0.8, 0.6);
  for (double angle : kAngles) {
    const Vec3 f = angle * kAxis;
    for (const bool exponential : {true, false}) {
      const auto map = [exponential](const Vec3& g) {
        return exponential ? RotationMap::exponential(g) : RotationMap::tangent(g);
      };
      EXPECT_LT((map(f).matrix() * y - map(f) * y).norm(), 1e-14);
      const Mat3 gradient = map(f).gradient(y);
      EXPECT_GT(gradient.norm(), 1e-3);
      EXPECT_LT((gradient - difference([&](const Vec3& g) { return map(g) * y; }, f)).norm(), 1e-8) << angle;
      const Mat3 transposed = map(f).transposed_gradient(m);
      EXPECT_GT(transposed.norm(), 1e-3);
      EXPECT_LT(
          (transposed - difference([&](const Vec3& g) -> Vec3 { return map(g).matrix().transpose() * m; }, f)).norm(),
          1e-8);
      const Mat3 H = map(f).hessian(y * m.transpose());
      EXPECT_GT(H.norm(), 1e-3);
      EXPECT_LT((H - difference([&](const Vec3& g) -> Vec3 { return map(g).gradient(y).transpose() * m; }, f)).norm(),
                1e-8)
          << angle;
      EXPECT_LT((H - H.transpose()).norm(), 1e-14);
    }
  }
}

TEST(Rotation, euler_angles_follow_the_stated_order) {
  const Mat3 R = from_euler_xyz(Vec3(0.1, 0.2, 0.3));
  const Mat3 expected = (Eigen::AngleAxisd(0.3, Vec3::UnitZ()) * Eigen::AngleAxisd(0.2, Vec3::UnitY()) *
                         Eigen::AngleAxisd(0.1, Vec3::UnitX()))
                            .toRotationMatrix();
  EXPECT_LT((R - expected).norm(), 1e-15);
}

TEST(Rotation, shortest_rotation_takes_one_to_the_other) {
  const Vec3 u = Vec3(1, 2, 3).normalized();
  for (const Vec3& w :
       {Vec3(Vec3(-3, 1, 0.5).normalized()), u, Vec3(-u), Vec3((u + 1e-9 * Vec3::UnitX()).normalized())}) {
    EXPECT_LT((exp(shortest_rotation(u, w)) * u - w).norm(), 1e-12);
  }
}

}  // namespace
}  // namespace sinew::lie
