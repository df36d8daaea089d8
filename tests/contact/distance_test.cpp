// Distances and signs of shapes that meet, against an independent computation, over random placements near and far.
#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include "sinew/contact/hull.hpp"
#include "sinew/contact/meeting.hpp"
#include "support/min_norm_point.hpp"
#include "support/random.hpp"

namespace sinew::contact {
namespace {

using test::distance_of;
using test::hull_of;
using test::Random;
using test::Support;

/// A shape's core, a polytope in the world, and the radius around it.
struct Core {
  std::vector<Vec3> points;
  double radius = 0.0;
};
Core core_of(const Shape& shape, const Pose& pose) {
  Core core;
  if (const Ball* ball = std::get_if<Ball>(&shape)) {
    core = {{Vec3::Zero()}, ball->radius};
  } else if (const Capsule* capsule = std::get_if<Capsule>(&shape)) {
    core = {{Vec3(0, 0, -0.5 * capsule->length), Vec3(0, 0, 0.5 * capsule->length)}, capsule->radius};
  } else if (const Cylinder* cylinder = std::get_if<Cylinder>(&shape)) {
    core.points = prism(*cylinder).corners;
  } else {
    core.points = std::get<Convex>(shape).surface.corners;
  }
  for (Vec3& x : core.points) x = pose * x;
  return core;
}

/// The least gap of all that meets; infinite where nothing does.
double least_gap(const Shape& a, const Pose& at, const Shape& b, const Pose& there, double alarm) {
  std::vector<Meeting> found;
  meet(a, at, b, there, alarm, found);
  double least = INFINITY;
  for (const Meeting& own : found)
    least =
        std::min(least, nearest(moved(own.swapped ? there : at, own.a), moved(own.swapped ? at : there, own.b)).gap);
  return least;
}

Shape random_shape(Random& random, int kind) {
  switch (kind) {
    case 0:
      return Ball{random(0.1, 0.5)};
    case 1:
      return Capsule{random(0.05, 0.4), random(0.0, 1.5)};
    case 2:
      return Convex{box({random(0.1, 1.0), random(0.1, 1.0), random(0.1, 1.0)})};
    case 3: {
      std::vector<Vec3> points;
      for (int i = 0; i < 12; ++i) points.push_back(random.vector(0.5));
      return Convex{hull(points)};
    }
    default:
      return Cylinder{random(0.1, 0.5), random(0.1, 1.0)};
  }
}

/// Pairs with a capsule or a ball: distances, and whether they overlap at all. Those of cylinders are known to their
/// prism's error.
void look_at_round_shapes(int placements, unsigned seed) {
  Random random(seed);
  double worst = 0.0, worst_of_cylinders = 0.0;
  int overlaps = 0, apart = 0;
  for (int i = 0; i < placements; ++i) {
    const int first = i % 2, second = (i / 2) % 5;
    const Shape a = random_shape(random, first), b = random_shape(random, second);
    const Pose at = random.placed<Pose>(1.0), there = random.placed<Pose>(0.3);
    const Core core_a = core_of(a, at), core_b = core_of(b, there);
    const double cores = distance_of(hull_of(core_a.points), hull_of(core_b.points));
    const double expected = cores - core_a.radius - core_b.radius, found = least_gap(a, at, b, there, 3.0);
    const double cylinder = second == 4 ? 2e-3 : 0.0;
    ASSERT_TRUE(std::isfinite(found)) << i;
    if (cores > 1e-9) {
      double& largest = second == 4 ? worst_of_cylinders : worst;
      largest = std::max(largest, std::abs(found - expected));
      ASSERT_NEAR(found, expected, 1e-9 + cylinder) << i << " of kinds " << first << " and " << second;
    } else {
      ASSERT_LT(found, -core_a.radius - core_b.radius + 1e-9 + cylinder) << i;
    }
    (expected < 0.0 ? overlaps : apart) += 1;
  }
  EXPECT_GT(overlaps, placements / 10);
  EXPECT_GT(apart, placements / 10);
  testing::Test::RecordProperty("worst", std::to_string(worst));
  testing::Test::RecordProperty("worst_of_cylinders", std::to_string(worst_of_cylinders));
}
TEST(Distance, round_shapes_meet_where_they_are) { look_at_round_shapes(20000, 1); }
TEST(Distance, round_shapes_meet_where_they_are_a_million_times_slow) { look_at_round_shapes(1000000, 2); }

/// Pairs of boxes, hulls and cylinders: whether they overlap, and no nearer than they are.
void look_at_polyhedra(int placements, unsigned seed) {
  Random random(seed);
  int overlaps = 0, apart = 0;
  for (int i = 0; i < placements; ++i) {
    const Shape a = random_shape(random, 2 + i % 3), b = random_shape(random, 2 + (i / 3) % 3);
    const Pose at = random.placed<Pose>(0.8), there = random.placed<Pose>(0.3);
    const double expected = distance_of(hull_of(core_of(a, at).points), hull_of(core_of(b, there).points)),
                 found = least_gap(a, at, b, there, 3.0);
    if (expected > 1e-9) {
      ASSERT_NEAR(found, expected, 1e-7) << i << ": kinds " << 2 + i % 3 << " and " << 2 + (i / 3) % 3;
      ++apart;
    } else {
      ASSERT_LT(found, 1e-9) << i;
      ++overlaps;
    }
  }
  EXPECT_GT(overlaps, placements / 10);
  EXPECT_GT(apart, placements / 10);
}
TEST(Distance, polyhedra_overlap_or_do_not) { look_at_polyhedra(3000, 3); }
TEST(Distance, polyhedra_overlap_or_do_not_a_hundred_thousand_times_slow) { look_at_polyhedra(100000, 4); }

}  // namespace
}  // namespace sinew::contact
