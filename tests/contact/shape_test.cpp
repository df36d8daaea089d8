#include "sinew/contact/shape.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <random>

#include "sinew/contact/meeting.hpp"

namespace sinew::contact {
namespace {

std::vector<Shape> solid_shapes() {
  return {Ball{0.7}, Capsule{0.4, 1.1}, Cylinder{0.6, 0.9}, Convex{box(Vec3(0.8, 1.2, 0.5))}};
}

Simplex point_at(const Vec3& x) {
  Simplex own;
  own.x[0] = x;
  return own;
}

double distance(const Shape& shape, const Vec3& p) { return nearest(point_at(p), nearest_part(shape, p)).gap; }

/// Signed distance of what is known in closed form.
double exact(const Shape& shape, const Vec3& p) {
  if (const Ball* ball = std::get_if<Ball>(&shape)) return p.norm() - ball->radius;
  if (const Capsule* capsule = std::get_if<Capsule>(&shape)) {
    const double z = std::clamp(p.z(), -0.5 * capsule->length, 0.5 * capsule->length);
    return (p - Vec3(0, 0, z)).norm() - capsule->radius;
  }
  if (const Cylinder* cylinder = std::get_if<Cylinder>(&shape)) {
    const Eigen::Vector2d d(std::hypot(p.x(), p.y()) - cylinder->radius, std::abs(p.z()) - 0.5 * cylinder->length);
    return std::min(d.maxCoeff(), 0.0) + d.cwiseMax(0.0).norm();
  }
  const Vec3 d = p.cwiseAbs() - 0.5 * Vec3(0.8, 1.2, 0.5);
  return std::min(d.maxCoeff(), 0.0) + d.cwiseMax(0.0).norm();
}

TEST(Shape, NearestPartGivesTheSignedDistance) {
  std::mt19937 engine(3);
  std::uniform_real_distribution<double> range(-1.2, 1.2);
  for (const Shape& shape : solid_shapes()) {
    for (int i = 0; i < 2000; ++i) {
      const Vec3 p(range(engine), range(engine), range(engine));
      EXPECT_NEAR(distance(shape, p), exact(shape, p), 1e-12) << shape.index() << " at " << p.transpose();
    }
  }
}

/// Volume and inertia by counting points of a fine grid.
TEST(Shape, BulkIsThatOfItsInside) {
  constexpr int n = 120;
  // Askew, so that no face lies along a layer of samples.
  const Eigen::Matrix3d axes = Eigen::AngleAxisd(0.7, Vec3(1, 2, 3).normalized()).matrix();
  for (const Shape& shape : solid_shapes()) {
    const double e = 2.4 / n;
    double volume = 0.0;
    Eigen::Matrix3d inertia = Eigen::Matrix3d::Zero();
    for (int i = 0; i < n; ++i) {
      for (int j = 0; j < n; ++j) {
        for (int k = 0; k < n; ++k) {
          const Vec3 p = axes * (Vec3(i + 0.5, j + 0.5, k + 0.5) * e - Vec3::Constant(1.2));
          if (exact(shape, p) > 0.0) continue;
          volume += e * e * e;
          inertia += e * e * e * (p.squaredNorm() * Eigen::Matrix3d::Identity() - p * p.transpose());
        }
      }
    }
    const Bulk own = bulk(shape);
    EXPECT_NEAR(own.volume, volume, 0.01 * volume);
    EXPECT_LT((own.inertia - inertia).norm(), 0.01 * inertia.norm()) << shape.index();
    EXPECT_LT(own.centre.norm(), 1e-12);
  }
  EXPECT_THROW(bulk(HalfSpace{}), std::invalid_argument);
}

TEST(Shape, SkinIsClosedAndAsLargeAsTheShape) {
  for (const Shape& shape : solid_shapes()) {
    const Skin own = skin(shape, 1.0);
    double volume = 0.0;
    for (const auto& t : own.triangles) volume += own.points[t[0]].dot(own.points[t[1]].cross(own.points[t[2]])) / 6.0;
    EXPECT_NEAR(volume, bulk(shape).volume, 0.03 * volume) << shape.index();
    for (const Vec3& p : own.points) EXPECT_NEAR(exact(shape, p), 0.0, 1e-12);
  }
}

TEST(Shape, ReachHoldsTheSkin) {
  const Eigen::Matrix3d axes = Eigen::AngleAxisd(0.7, Vec3(1, 2, 3).normalized()).matrix();
  for (const Shape& shape : solid_shapes()) {
    Vec3 farthest = Vec3::Zero();
    for (const Vec3& p : skin(shape, 1.0).points) farthest = farthest.cwiseMax((axes.transpose() * p).cwiseAbs());
    const Vec3 own = reach(shape, axes);
    EXPECT_TRUE((own - farthest).minCoeff() >= -1e-12 && (own - farthest).maxCoeff() < 0.02) << shape.index();
  }
}

/// Boxes one above the other: corners of the overlap, with the normal between them.
TEST(Meeting, FacesMeetInTheCornersOfTheirOverlap) {
  const Shape cube = Convex{box(Vec3::Ones())};
  std::vector<Meeting> found;
  meet(cube, {}, cube, {Eigen::Matrix3d::Identity(), Vec3(0.3, 0.2, 1.001)}, 0.01, found);
  ASSERT_EQ(found.size(), 4U);
  for (const Meeting& met : found) {
    const Pose upper{Eigen::Matrix3d::Identity(), Vec3(0.3, 0.2, 1.001)};
    const Pose &of_a = met.swapped ? upper : Pose{}, &of_b = met.swapped ? Pose{} : upper;
    const Vec3 normal = of_b.R * met.b.normal;
    EXPECT_NEAR(std::abs(normal.z()), 1.0, 1e-15);
    const Vec3 at = of_a * met.a.x[0];
    EXPECT_TRUE(std::abs(at.x() - 0.15 - (at.x() > 0.15 ? 0.35 : -0.35)) < 1e-12) << at.transpose();
    EXPECT_TRUE(std::abs(at.y() - 0.1 - (at.y() > 0.1 ? 0.4 : -0.4)) < 1e-12) << at.transpose();
    EXPECT_NEAR(normal.dot(at - of_b * met.b.x[0]), 0.001, 1e-12);
  }
}

TEST(Meeting, CrossedEdgesMeetAsEdges) {
  const Shape cube = Convex{box(Vec3::Ones())};
  // Both stand on an edge, one along x and one along y.
  const Eigen::Matrix3d first = Eigen::AngleAxisd(M_PI / 4, Vec3::UnitX()).matrix();
  const Eigen::Matrix3d second = Eigen::AngleAxisd(M_PI / 4, Vec3::UnitY()).matrix();
  std::vector<Meeting> found;
  const Pose above{second, Vec3(0.1, -0.05, std::sqrt(2.0) + 0.001)};
  meet(cube, {first, Vec3::Zero()}, cube, above, 0.01, found);
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(found[0].a.kind, Simplex::Kind::segment);
  EXPECT_EQ(found[0].b.kind, Simplex::Kind::segment);
}

TEST(Meeting, NothingBeyondTheAlarm) {
  const Shape cube = Convex{box(Vec3::Ones())};
  for (const Shape& other : solid_shapes()) {
    std::vector<Meeting> found;
    meet(cube, {}, other, {Eigen::Matrix3d::Identity(), Vec3(0, 0, 5)}, 0.01, found);
    EXPECT_TRUE(found.empty());
    meet(cube, {}, other,
         {Eigen::Matrix3d::Identity(), Vec3(0, 0, 0.5 + reach(other, Eigen::Matrix3d::Identity()).z() + 1e-3)}, 0.01,
         found);
    EXPECT_FALSE(found.empty()) << other.index();
  }
}

}  // namespace
}  // namespace sinew::contact
