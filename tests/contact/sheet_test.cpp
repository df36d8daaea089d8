#include "sinew/contact/sheet.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "sinew/contact/mesh.hpp"
#include "sinew/contact/shape.hpp"

namespace sinew::contact {
namespace {

using testing::HasSubstr;

struct Surface {
  Eigen::Matrix3Xd points;
  std::vector<std::array<int, 3>> triangles;
};

/// n x n squares over [-1, 1]^2, each of two triangles, every other one turned over; raised by `height`(x, y).
template <class Height>
Surface carpet(int n, const Height& height) {
  Surface own;
  own.points.resize(3, (n + 1) * (n + 1));
  for (int i = 0; i <= n; ++i)
    for (int j = 0; j <= n; ++j) {
      const double x = 2.0 * i / n - 1.0, y = 2.0 * j / n - 1.0;
      own.points.col(i * (n + 1) + j) = Eigen::Vector3d(x, y, height(x, y));
    }
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) {
      const int at = i * (n + 1) + j;
      own.triangles.push_back({at, at + n + 1, at + n + 2});
      own.triangles.push_back({at, at + 1, at + n + 2});
    }
  return own;
}

std::string refusal(const Surface& own, double thickness) {
  try {
    thicken(own.points, own.triangles, thickness);
  } catch (const NoSheet& wrong) {
    return wrong.what();
  }
  return "";
}

TEST(Sheet, FlatIsABox) {
  const Surface flat = carpet(4, [](double, double) { return 0.0; });
  const Sheet sheet = thicken(flat.points, flat.triangles, 0.1);
  EXPECT_EQ(open_edges(sheet.triangles), 0);
  const Bulk bulk = contact::bulk(make_mesh(sheet.points, sheet.triangles));
  EXPECT_NEAR(std::abs(bulk.volume), 0.4, 1e-14);
  EXPECT_LT(bulk.centre.norm(), 1e-14);
  EXPECT_NEAR(sheet.points.row(2).maxCoeff(), 0.05, 1e-16);
  EXPECT_NEAR(sheet.points.row(2).minCoeff(), -0.05, 1e-16);
}

TEST(Sheet, OfABowlHasItsThicknessEverywhere) {
  const Surface bowl = carpet(24, [](double x, double y) { return 0.3 * (x * x + y * y); });
  const Sheet sheet = thicken(bowl.points, bowl.triangles, 0.02);
  EXPECT_EQ(open_edges(sheet.triangles), 0);
  // Half the thickness away from every triangle of the middle, no less.
  const Eigen::Index corners = bowl.points.cols();
  ASSERT_EQ(sheet.points.cols(), 2 * corners);
  for (const std::array<int, 3>& t : sheet.triangles) {
    if ((t[0] < corners) != (t[1] < corners) || (t[0] < corners) != (t[2] < corners)) continue;  // a wall
    const auto middle = [&](int i) -> Eigen::Vector3d {
      return 0.5 * (sheet.points.col(i % corners) + sheet.points.col(corners + i % corners));
    };
    const Eigen::Vector3d n = (middle(t[1]) - middle(t[0])).cross(middle(t[2]) - middle(t[0])).normalized();
    for (const int corner : t) {
      const double away = n.dot(Eigen::Vector3d(sheet.points.col(corner)) - middle(corner));
      EXPECT_GT(away, 0.01 * (1.0 - 1e-9));
      EXPECT_LT(away, 0.0102);
    }
  }
}

TEST(Sheet, OfAFoldIsBevelled) {
  // A roof with an angle of 2 a at its ridge: moved by t / 2 / sin(a), at most by t.
  for (const double angle : {60.0, 30.0, 20.0}) {
    const double a = angle * std::numbers::pi / 180.0, slope = 1.0 / std::tan(a);
    const Surface roof = carpet(2, [&](double x, double) { return -slope * std::abs(x); });
    const Sheet sheet = thicken(roof.points, roof.triangles, 0.1);
    EXPECT_EQ(open_edges(sheet.triangles), 0);
    EXPECT_NEAR(sheet.points.row(2).maxCoeff(), 0.05 / std::max(std::sin(a), 0.5), 1e-12) << angle;
  }
}

TEST(Sheet, ThatMeetsItselfInACornerIsTwo) {
  Surface own;
  own.points.resize(3, 5);
  own.points << 0, 1, 1, -1, -1,  //
      0, -1, 1, 1, -1,            //
      0, 0, 0, 0, 0;
  own.triangles = {{0, 1, 2}, {0, 3, 4}};
  const Sheet sheet = thicken(own.points, own.triangles, 0.1);
  EXPECT_EQ(open_edges(sheet.triangles), 0);
  EXPECT_EQ(sheet.points.cols(), 12);
}

TEST(Sheet, OfAClosedSurfaceIsHollow) {
  const Polyhedron cube = box({1.0, 1.0, 1.0});
  Surface own;
  own.points.resize(3, 8);
  for (int i = 0; i < 8; ++i) own.points.col(i) = cube.corners[static_cast<std::size_t>(i)];
  for (const std::vector<int>& face : cube.faces) {
    own.triangles.push_back({face[0], face[1], face[2]});
    own.triangles.push_back({face[0], face[2], face[3]});
  }
  const Sheet sheet = thicken(own.points, own.triangles, 0.1);
  const Bulk bulk = contact::bulk(make_mesh(sheet.points, sheet.triangles));
  EXPECT_NEAR(std::abs(bulk.volume), 1.1 * 1.1 * 1.1 - 0.9 * 0.9 * 0.9, 1e-12);
}

TEST(Sheet, ThatIsNoneIsRefused) {
  Surface flat = carpet(2, [](double, double) { return 0.0; });
  flat.triangles.push_back({0, 4, 2});
  flat.triangles.push_back({0, 4, 6});
  EXPECT_THAT(refusal(flat, 0.1), HasSubstr("1 edges where more than two triangles meet"));

  Surface strip;  // of Moebius
  const int n = 20;
  strip.points.resize(3, 2 * n);
  for (int i = 0; i < n; ++i) {
    const double turn = 2.0 * std::numbers::pi * i / n;
    const Eigen::Vector3d out(std::cos(turn), std::sin(turn), 0.0);
    const Eigen::Vector3d across = std::cos(0.5 * turn) * Eigen::Vector3d::UnitZ() + std::sin(0.5 * turn) * out;
    strip.points.col(2 * i) = out - 0.3 * across;
    strip.points.col(2 * i + 1) = out + 0.3 * across;
    const int a = 2 * i, b = 2 * i + 1;
    const bool last = i == n - 1;
    const int c = last ? 1 : a + 2, d = last ? 0 : b + 2;
    strip.triangles.push_back({a, c, b});
    strip.triangles.push_back({b, c, d});
  }
  EXPECT_THAT(refusal(strip, 0.01), HasSubstr("one side only"));

  const Surface bent = carpet(20, [](double x, double) { return 0.2 * std::cos(6.0 * x); });
  EXPECT_EQ(refusal(bent, 0.1), "");  // its least radius is 0.14
  EXPECT_THAT(refusal(bent, 0.5), testing::AnyOf(HasSubstr("bends more sharply"), HasSubstr("nearer to itself")));
  const Surface sharp = carpet(2, [](double x, double) { return -40.0 * std::abs(x); });
  EXPECT_THAT(refusal(sharp, 0.01), testing::AnyOf(HasSubstr("folds back"), HasSubstr("bends more sharply")));

  // Two leaves, 0.2 apart.
  Surface leaves = carpet(2, [](double, double) { return 0.0; });
  const Surface upper = carpet(2, [](double, double) { return 0.2; });
  const int first = static_cast<int>(leaves.points.cols());
  Eigen::Matrix3Xd both(3, 2 * first);
  both << leaves.points, upper.points;
  leaves.points = both;
  for (const std::array<int, 3>& t : upper.triangles)
    leaves.triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
  EXPECT_EQ(refusal(leaves, 0.19), "");
  EXPECT_THAT(refusal(leaves, 0.21), HasSubstr("nearer to itself"));
}

}  // namespace
}  // namespace sinew::contact
