#include "sinew/rod/path.hpp"

#include <gtest/gtest.h>

#include <numbers>

#include "sinew/lie/rotation.hpp"
#include "sinew/rod/kinematics.hpp"

namespace sinew::rod {
namespace {

std::vector<double> equal_ends(double length, int sections) {
  std::vector<double> ends(sections + 1);
  for (int i = 0; i <= sections; ++i) ends[i] = length * i / sections;
  return ends;
}

TEST(Path, straight_points_give_a_straight_rod_and_exact_length) {
  const Path path({{0, 0, 0}, {0.01, 0, 0}, {0.05, 0, 0}, {0.081, 0, 0}});
  EXPECT_NEAR(path.length(), 0.081, 1e-16);
  const Layout layout = lay_along(path, equal_ends(path.length(), 8), Vec3::UnitZ());
  for (const Coefficients& Z : layout.strains) EXPECT_EQ(Z.norm(), 0.0);
  EXPECT_LT(layout.deviation, 1e-16);
  EXPECT_LT((layout.base.R.col(1) - Vec3::UnitZ()).norm(), 1e-15);
  EXPECT_LT((layout.base.R.col(2) + Vec3::UnitY()).norm(), 1e-15);  // z = x cross y
}

TEST(Path, y_follows_when_up_is_parallel) {
  const Mat3 R = frame_along(Vec3::UnitZ(), Vec3::UnitZ());
  EXPECT_LT((R.col(1) - Vec3::UnitY()).norm(), 1e-15);
}

TEST(Path, arc_is_followed) {
  std::vector<Vec3> points;
  for (int i = 0; i <= 24; ++i)
    points.emplace_back(std::sin(i * std::numbers::pi / 24), 0.0, 1.0 - std::cos(i * std::numbers::pi / 24));
  const Path path(points);
  EXPECT_NEAR(path.length(), std::numbers::pi, 2e-4);
  const Layout layout = lay_along(path, equal_ends(path.length(), 12), Vec3::UnitZ());
  // x along the start, y = z of the world, z = x cross y: bending up is about z... with curvature 1.
  for (const Coefficients& Z : layout.strains) EXPECT_NEAR(Z(2, 0), 1.0, 0.02);
  EXPECT_LT(layout.deviation, 2e-4);
}

TEST(Path, finger_cable_that_folds_back_is_followed_without_twist) {
  // The path of the public finger scene [mm]: along, around the tip, and back.
  const double mm = 1e-3;
  std::vector<Vec3> points;
  for (double x : {0.0, -17.5, -32.5, -47.5, -62.5, -77.5}) points.emplace_back(x * mm, 12.5 * mm, 2.5 * mm);
  points.emplace_back(-83.5 * mm, 12.5 * mm, 4.5 * mm);
  points.emplace_back(-85.5 * mm, 12.5 * mm, 6.5 * mm);
  points.emplace_back(-85.5 * mm, 12.5 * mm, 8.5 * mm);
  points.emplace_back(-83.5 * mm, 12.5 * mm, 10.5 * mm);
  for (double x : {-77.5, -62.5, -47.5, -32.5, -17.5}) points.emplace_back(x * mm, 12.5 * mm, 12.5 * mm);
  const Path path(points);
  const Layout layout = lay_along(path, equal_ends(path.length(), 60), Vec3::UnitZ());
  for (const Coefficients& Z : layout.strains) EXPECT_EQ(Z(0, 0), 0.0);
  EXPECT_LT(layout.deviation, 0.3 * mm);
  Discretisation cut;
  cut.ends = equal_ends(path.length(), 60);
  cut.rest = layout.strains;
  const Rod rod = make_rod(cut, {});
  const Configuration shape = configure(rod, layout.base, Eigen::VectorXd());
  EXPECT_LT((shape.p.back() - points.back()).norm(), 0.3 * mm);
}

TEST(Path, few_sections_of_high_degree_follow_as_well_as_many_constant_ones) {
  std::vector<Vec3> points;  // a curve whose bending changes sign
  for (int i = 0; i <= 40; ++i) points.emplace_back(0.01 * i, 0.02 * std::sin(0.3 * i), 0.0);
  const Path path(points);
  const double one = lay_along(path, equal_ends(path.length(), 4), Vec3::UnitZ()).deviation;
  const double quintic = lay_along(path, equal_ends(path.length(), 4), Vec3::UnitZ(), 5).deviation;
  EXPECT_LT(quintic, 5e-4);
  EXPECT_GT(one, 5.0 * quintic);
}

TEST(Path, thousands_of_sections_are_laid_in_linear_time) {
  std::vector<Vec3> points;
  for (int i = 0; i <= 40; ++i) points.emplace_back(0.01 * i, 0.02 * std::sin(0.3 * i), 0.0);
  const Path path(points);
  EXPECT_LT(lay_along(path, equal_ends(path.length(), 4000), Vec3::UnitZ()).deviation, 1e-5);
}

TEST(Masses, weigh_what_the_rod_weighs_and_turn_like_its_section) {
  Discretisation cut;
  cut.ends = {0.0, 0.2, 1.0};
  const Rod rod = make_rod(cut, {{0.0, 1.0, SolidPart{Circle{0.01}, Circle{0.01}, 1e6, 0.4, 1100.0}}});
  double mass = 0, first = 0, inertia = 0;
  for (const MassPoint& point : rod.masses) {
    mass += point.mass;
    first += point.mass * point.s;
    inertia += point.mass * point.offset.y() * point.offset.y();
  }
  EXPECT_NEAR(mass, 1100.0 * std::numbers::pi * 1e-4, 1e-14);
  EXPECT_NEAR(first, 0.5 * mass, 1e-14);
  EXPECT_NEAR(inertia, mass * 1e-4 / 4, 1e-18);  // m r^2 / 4
}

TEST(Masses, of_a_cone_weigh_its_volume) {
  Discretisation cut;
  cut.ends = {0.0, 1.0};
  const Rod rod = make_rod(cut, {{0.0, 1.0, SolidPart{Circle{0.02}, Circle{0.01}, 1e6, 0.4, 1000.0}}});
  double mass = 0;
  for (const MassPoint& point : rod.masses) mass += point.mass;
  EXPECT_NEAR(mass, 1000.0 * std::numbers::pi / 3.0 * (4e-4 + 2e-4 + 1e-4), 1e-13);
}

}  // namespace
}  // namespace sinew::rod
