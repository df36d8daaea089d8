#include "sinew/contact/simplex.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <random>

namespace sinew::contact {
namespace {

class Somewhere {
 public:
  Vec3 point() { return {next_(), next_(), next_()}; }
  double number() { return next_(); }

 private:
  struct Next {
    std::mt19937 engine{11};
    std::uniform_real_distribution<double> range{-1.0, 1.0};
    double operator()() { return range(engine); }
  } next_;
};

Simplex simplex(Simplex::Kind kind, Somewhere& random, double radius) {
  Simplex own;
  own.kind = kind;
  for (Vec3& x : own.x) x = random.point();
  own.normal = Vec3::Zero();
  if (kind == Simplex::Kind::plane) own.normal = random.point().normalized();
  own.radius = radius;
  return own;
}

Vec3 at(const Simplex& own, const std::array<double, 3>& w) {
  Vec3 p = Vec3::Zero();
  for (int i = 0; i < own.corners(); ++i) p += w[static_cast<std::size_t>(i)] * own.x[static_cast<std::size_t>(i)];
  return p;
}

/// The least distance over a fine grid of weights.
double least_distance(const Simplex& a, const Simplex& b, int n) {
  const auto weights = [n](const Simplex& own) {
    std::vector<std::array<double, 3>> all;
    for (int i = 0; i <= (own.corners() > 1 ? n : 0); ++i) {
      for (int j = 0; j <= (own.corners() > 2 ? n - i : 0); ++j) {
        const double s = static_cast<double>(i) / n, t = static_cast<double>(j) / n;
        all.push_back({1.0 - s - t, s, t});
      }
    }
    return all;
  };
  double least = INFINITY;
  for (const auto& wa : weights(a)) {
    for (const auto& wb : weights(b)) least = std::min(least, (at(a, wa) - at(b, wb)).norm());
  }
  return least;
}

using enum Simplex::Kind;

TEST(Simplex, NearestPointsAreNearest) {
  Somewhere random;
  for (int trial = 0; trial < 200; ++trial) {
    for (const Simplex::Kind kind : {point, segment, triangle}) {
      const bool edges = trial % 2 == 1 && kind == segment;
      const Simplex a = simplex(edges ? segment : point, random, 0.0), b = simplex(kind, random, 0.0);
      const Nearest found = nearest(a, b);
      const Vec3 d = at(a, found.a) - at(b, found.b);
      const int n = edges ? 120 : 200;
      EXPECT_LE(d.norm(), least_distance(a, b, n) + 1e-12);
      EXPECT_GE(d.norm(), least_distance(a, b, n) - 4.0 / n);
      EXPECT_NEAR(std::abs(found.gap), d.norm(), 1e-12);
      EXPECT_NEAR(found.normal.norm(), 1.0, 1e-12);
      EXPECT_NEAR(found.normal.dot(d), found.gap, 1e-12);
    }
  }
}

/// d gap = normal . (sum of a dx_a - sum of b dx_b), for what is not a plane.
TEST(Simplex, GapChangesAsTheNormalSays) {
  Somewhere random;
  constexpr double e = 1e-6;
  for (int trial = 0; trial < 100; ++trial) {
    for (const Simplex::Kind kind : {point, segment, triangle, plane}) {
      const bool edges = trial % 2 == 1 && kind == segment;
      Simplex a = simplex(edges ? segment : point, random, 0.1), b = simplex(kind, random, 0.05);
      if (edges) b.normal = random.point();
      const Nearest here = nearest(a, b);
      Vec3 change = Vec3::Zero();
      Simplex ahead_a = a, ahead_b = b, behind_a = a, behind_b = b;
      for (std::size_t i = 0; i < static_cast<std::size_t>(a.corners()); ++i) {
        const Vec3 dx = random.point();
        change += here.a[i] * dx;
        ahead_a.x[i] += e * dx;
        behind_a.x[i] -= e * dx;
      }
      for (std::size_t i = 0; i < static_cast<std::size_t>(b.corners()); ++i) {
        const Vec3 dx = random.point();
        change -= here.b[i] * dx;
        ahead_b.x[i] += e * dx;
        behind_b.x[i] -= e * dx;
      }
      const Nearest ahead = nearest(ahead_a, ahead_b), behind = nearest(behind_a, behind_b);
      if ((ahead.normal - behind.normal).norm() > 0.01) continue;  // the nearest part changes there
      EXPECT_NEAR((ahead.gap - behind.gap) / (2 * e), here.normal.dot(change), 1e-4);
    }
  }
}

/// The gap's gradient: c_i n over the corners of a and b.
Eigen::VectorXd gradient(const Simplex& a, const Simplex& b, const Nearest& found) {
  Eigen::VectorXd g(3 * (a.corners() + b.corners()));
  for (int i = 0; i < a.corners(); ++i) g.segment<3>(3 * i) = found.a[static_cast<std::size_t>(i)] * found.normal;
  for (int i = 0; i < b.corners(); ++i)
    g.segment<3>(3 * (a.corners() + i)) = -found.b[static_cast<std::size_t>(i)] * found.normal;
  return g;
}

TEST(Simplex, SecondDerivativesOfTheGapAreDifferencesOfItsGradient) {
  Somewhere random;
  constexpr double e = 1e-6;
  std::array<int, 4> compared{};  // by the kind of facing
  for (int trial = 0; trial < 10000; ++trial) {
    const Simplex::Kind kind = std::array{point, segment, triangle, plane}[static_cast<std::size_t>(trial % 4)];
    const bool edges = trial % 8 > 3 && kind == segment, thin = trial % 3 == 0;
    Simplex a = simplex(edges ? segment : point, random, thin ? 0.0 : 0.1),
            b = simplex(kind, random, thin ? 0.0 : 0.05);
    if (edges && thin) b.normal = random.point().normalized();
    const Facing kept = facing(a, b);
    const Nearest here = nearest(a, b, kept);
    if (kept.kind == Facing::Kind::face && kind == triangle && here.b[0] * here.b[1] * here.b[2] == 0.0) continue;
    const GapHessian H = gap_hessian(a, b, here, kept);
    if (kept.kind == Facing::Kind::fixed) {  // the gap along a fixed direction is not stationary in its places
      EXPECT_EQ(H.norm(), 0.0);
      continue;
    }
    if (H.norm() > 30.0) continue;  // all but touching, or all but parallel: differences say nothing
    const Eigen::VectorXd g = gradient(a, b, here);
    Eigen::MatrixXd difference(g.size(), g.size());
    double kink = 0.0;
    for (int i = 0; i < a.corners() + b.corners(); ++i) {
      for (int axis = 0; axis < 3; ++axis) {
        Simplex& moved = i < a.corners() ? a : b;
        double& x = moved.x[static_cast<std::size_t>(i < a.corners() ? i : i - a.corners())][axis];
        const double before = x;
        x = before + e;
        const Eigen::VectorXd plus = gradient(a, b, nearest(a, b, kept));
        x = before - e;
        const Eigen::VectorXd minus = gradient(a, b, nearest(a, b, kept));
        x = before;
        difference.col(3 * i + axis) = (plus - minus) / (2 * e);
        kink = std::max(kink, (plus - 2.0 * g + minus).norm());
      }
    }
    if (kink > 1e-8) continue;  // the nearest part changes there
    EXPECT_LT((H - difference).norm(), 1e-4 * (1.0 + H.squaredNorm())) << trial;
    EXPECT_LT((H - H.transpose()).norm(), 1e-12 * (1.0 + H.norm())) << trial;
    compared[static_cast<std::size_t>(kept.kind)] += H.norm() > 0.1;
  }
  EXPECT_GT(compared[static_cast<std::size_t>(Facing::Kind::apart)], 2000);
  EXPECT_GT(compared[static_cast<std::size_t>(Facing::Kind::face)], 100);
  EXPECT_GT(compared[static_cast<std::size_t>(Facing::Kind::crossing)], 20);
}

TEST(Simplex, NormalOfAFaceStaysWhereAPointPassesThroughIt) {
  Simplex face;
  face.kind = triangle;
  face.x = {Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0)};
  for (const double z : {0.1, 1e-9, 0.0, -1e-9, -0.1}) {
    Simplex p;
    p.x[0] = Vec3(0.2, 0.3, z);
    const Nearest found = nearest(p, face);
    EXPECT_EQ(found.normal, Vec3::UnitZ());
    EXPECT_EQ(found.gap, z);
  }
}

TEST(Simplex, WhatPassesThePlaneOfATriangleBesideItStaysOutside) {
  Simplex triangle;
  triangle.kind = Simplex::Kind::triangle;
  triangle.x = {Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0)};
  const auto thick = [](const Vec3& x) { return contact::point_at(x, 0.1); };
  const auto beside = [&thick](double height) { return thick(Vec3(-0.5, 0.3, height)); };
  const Facing above = facing(beside(0.01), triangle);
  for (const double height : {0.01, 0.0, -0.01, -0.2}) {
    const Nearest found = nearest(beside(height), triangle, above);
    EXPECT_NEAR(found.gap, std::hypot(0.5, height) - 0.1, 1e-15) << height;
    EXPECT_LT(found.normal.x(), 0.0);
  }
  // Through the triangle itself they do come to cross.
  const Simplex over = thick(Vec3(0.3, 0.3, 0.01)), under = thick(Vec3(0.3, 0.3, -0.01));
  EXPECT_NEAR(nearest(under, triangle, facing(over, triangle)).gap, -0.11, 1e-15);
  // What was inside, beside a rim that is told to be hollow, stays there.
  triangle.normal = Vec3(1, 0, 1).normalized();
  const Facing inside = facing(beside(-0.01), triangle);
  EXPECT_NEAR(nearest(beside(-0.02), triangle, inside).gap, -std::hypot(0.5, 0.02) - 0.1, 1e-15);
}

TEST(Simplex, ParallelSegmentsMeetInTheMiddleOfWhatLiesSideBySide) {
  Simplex a, b;
  a.kind = b.kind = segment;
  a.normal = b.normal = Vec3::Zero();
  a.x = {Vec3(0, 0, 1), Vec3(4, 0, 1), Vec3::Zero()};
  b.x = {Vec3(2, 0, 0), Vec3(8, 0, 0), Vec3::Zero()};
  const Nearest found = nearest(a, b);
  EXPECT_NEAR(found.a[1], 0.75, 1e-12);
  EXPECT_NEAR(at(b, found.b).x(), 3.0, 1e-12);
  EXPECT_NEAR(found.gap, 1.0, 1e-12);
}

// Across two parallel lines is what rounding says.
TEST(Simplex, ParallelEdgesOfBodiesAreApartAlongTheirDistance) {
  for (const double off : {0.0, 1e-17, -3e-16, 1e-10}) {
    const Simplex edge = segment_at(Vec3(0, -1, 0.5), Vec3(off, 1, 0.5), Vec3(0, 0, 1), 0.0),
                  axis = segment_at(Vec3(0.3, -2, 1), Vec3(0.3, 2, 1 + off), Vec3::Zero(), 0.2);
    const Facing kept = facing(axis, edge);
    const Nearest found = nearest(axis, edge, kept);
    EXPECT_LT((found.normal - Vec3(0.3, 0, 0.5).normalized()).norm(), 1e-9) << off;
    EXPECT_NEAR(found.gap, std::hypot(0.3, 0.5) - 0.2, 1e-9) << off;
  }
}

TEST(Simplex, ThicknessIsTakenOff) {
  Simplex a, b;
  a.x[0] = Vec3(0, 0, 3);
  b.x[0] = Vec3::Zero();
  a.radius = 1.0;
  b.radius = 0.5;
  EXPECT_NEAR(nearest(a, b).gap, 1.5, 1e-15);
}

TEST(Simplex, OtherPairsAreRefused) {
  Somewhere random;
  EXPECT_THROW(nearest(simplex(triangle, random, 0), simplex(triangle, random, 0)), std::invalid_argument);
}

}  // namespace
}  // namespace sinew::contact
