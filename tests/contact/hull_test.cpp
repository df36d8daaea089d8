#include "sinew/contact/hull.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <random>
#include <stdexcept>

#include "sinew/contact/shape.hpp"

namespace sinew::contact {
namespace {

/// Points of a grid in and on a box: its hull has the box's faces, edges and volume, whichever way it is turned.
TEST(Hull, OfABoxFullOfPointsIsTheBox) {
  const Vec3 size(0.03, 0.02, 0.01);
  for (const double angle : {0.0, 0.3, 2.1}) {
    const Eigen::Matrix3d turn = Eigen::AngleAxisd(angle, Vec3(1, 2, 3).normalized()).matrix();
    std::vector<Vec3> points;
    for (int i = 0; i < 125; ++i) {
      const Vec3 part(i % 5, i / 5 % 5, i / 25);
      points.push_back(turn * (0.25 * part - Vec3::Constant(0.5)).cwiseProduct(size));
    }
    const Polyhedron made = hull(points);
    EXPECT_EQ(made.corners.size(), 8U);
    EXPECT_EQ(made.faces.size(), 6U);
    EXPECT_EQ(made.edges.size(), 12U);
    const Bulk own = bulk(Convex{made});
    EXPECT_NEAR(own.volume, size.prod(), 1e-12 * size.prod());
    EXPECT_NEAR(own.centre.norm(), 0.0, 1e-15);
  }
}

TEST(Hull, HoldsAllPointsBelowItsFaces) {
  std::mt19937 engine(5);
  std::normal_distribution<double> normal(0.0, 0.02);
  std::vector<Vec3> points;
  for (int i = 0; i < 300; ++i) points.emplace_back(normal(engine), normal(engine), normal(engine));
  const Polyhedron made = hull(points);
  // Euler's formula, and every face turned outward.
  EXPECT_EQ(made.corners.size() + made.faces.size(), made.edges.size() + 2);
  for (std::size_t f = 0; f < made.faces.size(); ++f) {
    for (const Vec3& p : points) EXPECT_LE(made.normals[f].dot(p - made.corners[made.faces[f][0]]), 1e-15);
  }
}

TEST(Hull, RefusesWhatHasNoVolume) {
  EXPECT_THROW(hull({}), std::invalid_argument);
  EXPECT_THROW(hull({Vec3::Zero(), Vec3::UnitX(), Vec3::UnitY()}), std::invalid_argument);
  EXPECT_THROW(hull({Vec3::Zero(), Vec3::UnitX(), Vec3::UnitY(), Vec3(1, 1, 0), Vec3(0.3, 0.2, 0)}),
               std::invalid_argument);
  EXPECT_THROW(hull(std::vector<Vec3>(10, Vec3::Ones())), std::invalid_argument);
  EXPECT_THROW(hull({Vec3::Zero(), Vec3::UnitX(), Vec3::UnitY(), Vec3(0, 0, NAN)}), std::invalid_argument);
}

}  // namespace
}  // namespace sinew::contact
