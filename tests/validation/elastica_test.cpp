// Rods that bend in a plane: the elastica, the roll-up and the unrolling ring.
#include "validation/rods.hpp"

namespace sinew::test {
namespace {

/// Mattiasson, Int. J. Numer. Meth. Engng 17, 1981, table 1: a clamped inextensible rod under a dead transverse tip
/// force P; alpha = P L^2 / (E I), w and u over L, angle of the tip [rad].
struct Row {
  double alpha, w, u, angle;
};
const Row kMattiasson[] = {
    {1, 0.30172, 0.05643, 0.46135}, {2, 0.49346, 0.16064, 0.78175}, {5, 0.71379, 0.38763, 1.21537}};
constexpr double kTolerance = 1e-4;

void expect_elastica(int sections, int order) {
  for (const Row& row : kMattiasson) {
    // L = 2, E I = 3; the torsional stiffness must not matter.
    Scene scene = straight_rod(2.0, sections, given({0.7, 3.0, 3.0, 1.0, 1.0, 1.0}), kBending, order, 2);
    add_load(scene, Vec3(0, row.alpha * 3.0 / 4.0, 0));
    const Solved solved = solve(scene);
    const Vec3 tip = solved.tip();
    const Vec3 tangent = solved.frame(2.0).col(0);
    EXPECT_NEAR(tip.y() / 2.0, row.w, kTolerance * row.w) << row.alpha;
    EXPECT_NEAR(1.0 - tip.x() / 2.0, row.u, kTolerance * row.u) << row.alpha;
    EXPECT_NEAR(std::atan2(tangent.y(), tangent.x()), row.angle, kTolerance * row.angle) << row.alpha;
    EXPECT_NEAR(tip.z(), 0.0, 1e-12);
  }
}

TEST(Elastica, many_sections_of_constant_strain_give_mattiassons_values) { expect_elastica(160, 0); }
TEST(Elastica, one_section_of_cubic_strain_gives_mattiassons_values) { expect_elastica(1, 3); }
TEST(Elastica, two_sections_of_cubic_strain_give_mattiassons_values) { expect_elastica(2, 3); }

// Constant strain is the exact solution of a rod under an end moment: M = 2 pi E I / L closes a circle, whatever the
// number of sections.
class RollUp : public testing::TestWithParam<std::tuple<int, int>> {};

TEST_P(RollUp, end_moment_brings_the_tip_back_to_the_base) {
  const auto [sections, order] = GetParam();
  Scene scene = straight_rod(1.0, sections, given({0.7, 3.0, 3.0, 1.0, 1.0, 1.0}), kBending, order, 8);
  add_load(scene, Vec3::Zero(), Vec3(0, 0, 2.0 * pi * 3.0));
  const Solved solved = solve(scene);
  EXPECT_LT(solved.tip().norm(), 1e-10);
  EXPECT_LT((solved.at(0.5) - Vec3(0, 1.0 / pi, 0)).norm(), 1e-8);
  EXPECT_LT((solved.frame(1.0) - rod::Mat3::Identity()).norm(), 1e-8);
}

INSTANTIATE_TEST_SUITE_P(Sections, RollUp,
                         testing::Values(std::tuple(1, 0), std::tuple(7, 0), std::tuple(1, 2), std::tuple(4, 1)));

/// Ibrahimbegovic, Comput. Meth. Appl. Mech. Engng 122, 1995: a ring of circumference 10, E = 1200, nu = 0, unit square
/// section, cut and clamped at one end. An end moment 10 pi = E I kappa / 2 opens it to a half circle of diameter
/// 20 / pi = 6.366: that is how far the tip moves, and it turns by -pi.
Scene ring(int sections, bool by_path, double moment) {
  const double radius = 10.0 / (2.0 * pi), EI = 1200.0 / 12.0;
  Scene scene = straight_rod(10.0, sections, given({EI, EI, EI, 1200.0, 500.0, 500.0}), kAll, 0, 8);
  Rod& rod = scene.rods[0].second;
  if (by_path) {
    rod.path.clear();
    for (int i = 0; i <= 400; ++i) {
      const double angle = 2.0 * pi * i / 400;
      rod.path.emplace_back(radius * std::sin(angle), radius * (1.0 - std::cos(angle)), 0.0);
    }
  } else {
    rod::Vec6 strains = rod::Vec6::Zero();
    strains[2] = 1.0 / radius;
    rod.rest = RestStrains{{0.0}, {strains}};
  }
  add_load(scene, Vec3::Zero(), Vec3(0, 0, -moment));
  return scene;
}

class UnrollingRing : public testing::TestWithParam<std::tuple<int, bool>> {};

TEST_P(UnrollingRing, opens_to_a_half_circle_and_to_a_line) {
  const auto [sections, by_path] = GetParam();
  const Solved half = solve(ring(sections, by_path, 10.0 * pi));
  const State start = initial_state(half.model);
  EXPECT_LT(tip(half.model, start).norm(), 1e-3);
  const Vec3 moved = half.tip() - tip(half.model, start);
  EXPECT_NEAR(moved.x(), 0.0, 1e-3 * 6.366);
  EXPECT_NEAR(moved.y(), 6.366, 1e-3 * 6.366);
  EXPECT_NEAR(half.frame(half.model.rods[0].rod.length())(0, 0), -1.0, 1e-5);  // turned by pi
  const Solved line = solve(ring(sections, by_path, 20.0 * pi));
  EXPECT_LT((line.tip() - Vec3(10, 0, 0)).norm(), 1e-2);
}

INSTANTIATE_TEST_SUITE_P(RestStrainsAndPath, UnrollingRing,
                         testing::Values(std::tuple(1, false), std::tuple(9, false), std::tuple(20, true)));

}  // namespace
}  // namespace sinew::test
