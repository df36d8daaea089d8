#include <gtest/gtest.h>

#include <Eigen/Dense>

#include "sinew/solid/body.hpp"

namespace sinew::solid {
namespace {

TEST(Stress, principal_values_are_the_stretch_along_turned_axes_largest_first) {
  const Mat3 R = (Eigen::AngleAxisd(0.7, Vec3(1, 2, -1).normalized())).toRotationMatrix();
  const Vec3 values = principal_values(R * Vec3(-2, 5, 1).asDiagonal() * R.transpose());
  EXPECT_LT((values - Vec3(5, 1, -2)).norm(), 1e-14);
  // Shear is tension and compression of the same size, at 45 degrees.
  EXPECT_LT((principal_values(Mat3{{0, 3, 0}, {3, 0, 0}, {0, 0, 0}}) - Vec3(3, 0, -3)).norm(), 1e-14);
}

}  // namespace
}  // namespace sinew::solid
