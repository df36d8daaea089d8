#include "sinew/rod/geometric_cable.hpp"

#include <gtest/gtest.h>

#include "sinew/lie/rotation.hpp"
#include "support/difference.hpp"

namespace sinew::rod {
namespace {

TEST(GeometricCable, length_gradient_and_hessian_match_finite_differences) {
  const GeometricCable cable{3, 0.1, 1e-6};
  const Placement base{lie::exp(Vec3(0.2, 0.5, -0.3)), Vec3(0.01, 0.02, 0.03)};
  Eigen::VectorXd z(10);
  z << 0.004, 0.02, 0.03, 0.01, 0.05, 0.02, 0.02, 0.08, 0.05, 0.03;
  const CableLength length = cable_length(cable, base, z);
  const auto value = [&](const Eigen::VectorXd& y) {
    return Eigen::VectorXd::Constant(1, cable_length(cable, base, y).value);
  };
  const auto gradient = [&](const Eigen::VectorXd& y) { return cable_length(cable, base, y).gradient; };
  EXPECT_GT(length.gradient.norm(), 0.1);
  EXPECT_LT((length.gradient.transpose() - test::difference(value, z, 1e-7)).norm(), 1e-8);
  EXPECT_GT(length.hessian.norm(), 1.0);
  EXPECT_LT((length.hessian - test::difference(gradient, z, 1e-7)).norm(), 1e-6 * length.hessian.norm());
}

TEST(GeometricCable, a_first_point_at_the_base_has_no_singularity) {
  const GeometricCable cable{2, 0.1, 1e-6};
  Eigen::VectorXd z = Eigen::VectorXd::Zero(7);
  z[4] = 0.1;
  const CableLength length = cable_length(cable, {}, z);
  EXPECT_TRUE(length.gradient.allFinite());
  EXPECT_TRUE(length.hessian.allFinite());
  EXPECT_NEAR(length.value, 0.1, 2e-6);
}

}  // namespace
}  // namespace sinew::rod
