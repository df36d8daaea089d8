// Rods at the ends of their range: nearly straight, coiled, hair-thin, stocky, finely cut.
#include "sinew/sim/strained_rods.hpp"
#include "support/recorded_run.hpp"
#include "validation/shooting.hpp"

namespace sinew::test {
namespace {

TEST(ExtremeRod, nearly_straight_keeps_its_digits) {
  // Curvatures of 1e-10 / m: those of beam theory, F (L - s) / (E I), section by section to nine digits.
  Scene scene = straight_rod(1.0, 10, given({0.7, 3.0, 2.0, 1e3, 1e3, 1e3}), kAll, 1);
  add_load(scene, 1e-10 * Vec3(0.4, 2.0, -3.0));
  const Solved solved = solve(scene);
  for (double s : {0.0, 0.33, 0.95}) {
    const rod::Vec6 strain = rod::strain(solved.model.rods[0].rod, solved.end().rods[0].q, s);
    EXPECT_NEAR(strain[1], 1e-10 * 3.0 * (1 - s) / 3.0, 1e-19);
    EXPECT_NEAR(strain[2], 1e-10 * 2.0 * (1 - s) / 2.0, 1e-19);
    EXPECT_NEAR(strain[3], 1e-10 * 0.4 / 1e3, 1e-20);
    EXPECT_NEAR(strain[0], 0.0, 1e-19);
  }
}

TEST(ExtremeRod, nearly_straight_stress_free_shape_bends_like_a_straight_one) {
  const auto tip_of = [](double curvature) {
    Scene scene = straight_rod(1.0, 12, given({0.7, 3.0, 2.0, 1e3, 1e3, 1e3}), kAll, 0, 2);
    rod::Vec6 rest = rod::Vec6::Zero();
    rest[1] = rest[2] = curvature;
    scene.rods[0].second.rest = RestStrains{{0.0}, {rest}};
    add_load(scene, Vec3(-2, 3, 4));
    return solve(scene).tip();
  };
  const Vec3 straight = tip_of(0.0);
  EXPECT_GT(straight.y(), 0.1);
  EXPECT_LT((tip_of(1e-10) - straight).norm(), 1e-9);
  EXPECT_LT((tip_of(1e-7) - straight).norm(), 1e-6);
}

class TenTurns : public testing::TestWithParam<int> {};

TEST_P(TenTurns, end_moment_coils_a_straight_rod_ten_times) {
  Scene scene = straight_rod(1.0, GetParam(), given({0.7, 3.0, 3.0, 1.0, 1.0, 1.0}), kBending, 0, 80);
  add_load(scene, Vec3::Zero(), Vec3(0, 0, 20.0 * pi * 3.0));
  const Solved solved = solve(scene);
  EXPECT_LT(solved.tip().norm(), 1e-9);
  EXPECT_LT((solved.frame(1.0) - rod::Mat3::Identity()).norm(), 1e-7);
}

INSTANTIATE_TEST_SUITE_P(Sections, TenTurns, testing::Values(1, 3, 40));

TEST(ExtremeRod, coil_spring_of_ten_turns_stretches_as_the_textbook_says) {
  // Close-coiled helix of radius R and n turns with its ends' force on the axis: k = G J / (2 pi R^3 n) to the order of
  // (pitch / R)^2 (Love, Mathematical Theory of Elasticity, 271). Rigid arms bring the force to the axis: a force at
  // the tip and the moment it has about the axis.
  const double R = 0.01, pitch = 0.002, turns = 10.0, wire = 5e-4, G = 80e9 / 2.6, E = 80e9;
  const double per_turn = std::hypot(2 * pi * R, pitch), L = turns * per_turn;
  rod::Vec6 rest = rod::Vec6::Zero();
  rest[0] = 2 * pi * pitch / (per_turn * per_turn);
  rest[2] = 4 * pi * pi * R / (per_turn * per_turn);
  Scene scene = straight_rod(L, 120, Circle{wire}, kAll, 1, 2);
  Rod& rod = scene.rods[0].second;
  rod.material = {E, 0.3, 0.0};
  rod.rest = RestStrains{{0.0}, {rest}};
  rod.path = {Vec3::Zero(), L * Vec3(0, std::cos(pitch / (2 * pi * R)), std::sin(pitch / (2 * pi * R)))};
  rod.up = -Vec3::UnitX();
  const Model model = build(scene, read_block);
  // Where the helix ends: on its cylinder, whose axis must be the world's z for the force below.
  const auto shape = rod_shape(model, initial_state(model), 0);
  const Vec3 turn = rod::position(shape, per_turn), end = rod::position(shape, L);
  const Vec3 axis = turn.normalized();  // one turn is a pure shift along the axis
  EXPECT_NEAR(turn.norm(), pitch, 1e-9);
  EXPECT_NEAR(end.norm(), 10 * pitch, 1e-8);
  const Vec3 centre = 0.5 * (rod::position(shape, 0.0) + rod::position(shape, 0.5 * per_turn));
  const Vec3 arm = centre - centre.dot(axis) * axis;  // from the wire to the axis
  EXPECT_NEAR(arm.norm(), R, 2e-4 * R);
  const double stiffness = G * pi * std::pow(wire, 4) / 2 / (2 * pi * R * R * R * turns);
  const double force = 0.001 * R * stiffness;
  add_load(scene, force * axis, arm.cross(force * axis));
  const Solved solved = solve(scene);
  const Vec3 moved = solved.tip() - end;
  EXPECT_NEAR(moved.dot(axis), 0.001 * R, 0.01 * 0.001 * R);
}

TEST(ExtremeRod, hair_of_length_over_radius_1e5_bends_into_the_elastica) {
  // E A / (E I / L^2) = 4e10. Mattiasson's tip for alpha = 5, though the rod may stretch and shear.
  for (const auto& [sections, order] : {std::pair(60, 0), std::pair(300, 0), std::pair(4, 2)}) {
    Scene scene = straight_rod(1.0, sections, Circle{1e-5}, kAll, order, 5);
    scene.rods[0].second.material = {1e9, 0.4, 0.0};
    add_load(scene, Vec3(0, 5.0 * 1e9 * pi / 4 * 1e-20, 0));
    const Solved solved = solve(scene);
    EXPECT_NEAR(solved.tip().y(), 0.71379, 1e-3);
    EXPECT_NEAR(solved.tip().x(), 1 - 0.38763, 1e-3);
  }
}

TEST(ExtremeRod, stocky_rod_of_length_over_radius_3_is_timoshenkos) {
  const double E = 1e6, nu = 0.3, r = 1.0 / 3, G = E / 2.6, A = pi * r * r, I = pi * std::pow(r, 4) / 4;
  const double k = 6 * (1 + nu) / (7 + 6 * nu);  // Cowper
  const double F = 1e-5 * E * I;
  Scene scene = straight_rod(1.0, 3, Circle{r}, kAll, 1);
  scene.rods[0].second.material = {E, nu, 0.0};
  add_load(scene, Vec3(0, F, 0));
  const double exact = F / (3 * E * I) + F / (k * G * A);
  EXPECT_GT(F / (k * G * A), 0.1 * exact);
  EXPECT_NEAR(solve(scene).tip().y(), exact, 1e-5 * exact);
}

TEST(ExtremeRod, stocky_rod_converges_under_a_load_of_the_size_of_its_stiffness) {
  const Stiffness stiffness = {0.8, 1.0, 1.0, 36.0, 12.0, 12.0};
  Scene scene = straight_rod(1.0, 6, given(stiffness), kAll, 2, 4);
  add_load(scene, Vec3(1, 5, 4));
  EXPECT_LT((solve(scene).tip() - shoot_cantilever(1.0, Vec3(1, 5, 4), stiffness, true).p).norm(), 1e-6);
}

TEST(ExtremeRod, three_hundred_sections_agree_with_shooting) {
  const Stiffness stiffness = {0.8, 1.0, 1.5, 60.0, 25.0, 30.0};
  const Vec3 force(-1, 6, 5);
  Scene scene = straight_rod(1.0, 300, given(stiffness), kAll, 0, 4);
  add_load(scene, force);
  EXPECT_LT((solve(scene).tip() - shoot_cantilever(1.0, force, stiffness, true).p).norm(), 1e-5);
}

/// The force along the rod of the scene, of which E A is 78.54 N, and the warnings of the run.
RecordedRun pushed(double force, const std::string& analysis) {
  return run_file(std::filesystem::path(SINEW_SOURCE_DIR) / "tests/validation/faults/rod_crushed.yaml",
                  {"loads.push.force=[" + std::to_string(force) + ", 0, 0]", "analysis=" + analysis});
}

TEST(ExtremeRod, no_rod_is_inside_out_without_a_word) {
  const double EA = 1e6 * pi * 25e-6;
  for (const std::string analysis : {"dynamic", "quasi_static"}) {
    const RecordedRun run = pushed(-100.0, analysis);
    ASSERT_TRUE(run.done()) << run.why();
    EXPECT_LT(run.last("tip.x"), 0.0);  // it is where its law takes it, which is no place for a rod
    const Warning* told = run.warning("rod_crushed", "rods.a");
    ASSERT_TRUE(told) << analysis;
    const bool rests = analysis == "quasi_static";
    EXPECT_NEAR(told->value, 100.0 / EA, rests ? 1e-9 : 1e-4);
    const double crushed = 0.5 * 0.8 * EA / 100.0;  // [s] of loads that grow for half a second
    EXPECT_GE(told->time, crushed);
    EXPECT_LE(told->time, crushed + (rests ? 0.01 : 0.01 + 0.05));  // a step later; in motion, and by its damping
  }
  EXPECT_FALSE(pushed(-0.75 * EA, "quasi_static").warning("rod_crushed"));
  EXPECT_TRUE(pushed(-0.85 * EA, "quasi_static").warning("rod_crushed"));
  EXPECT_FALSE(pushed(4.9 * EA, "quasi_static").warning("rod_overstretched"));
  EXPECT_TRUE(pushed(5.1 * EA, "quasi_static").warning("rod_overstretched"));
}

TEST(ExtremeRod, stretch_is_found_where_it_is_most) {
  Scene scene = straight_rod(1.0, 2, given({1.0, 1.0, 1.0, 10.0, 1.0, 1.0}), kAll, 1);
  const Model model = build(scene, read_block);
  Eigen::VectorXd q = Eigen::VectorXd::Zero(model.rods[0].rod.coordinates());
  EXPECT_EQ(stretch_of(model.rods[0].rod, q).least, 1.0);
  const std::vector<rod::Mode>& modes = model.rods[0].rod.sections[1].modes;
  for (std::size_t i = 0; i < modes.size(); ++i)
    if (modes[i].strain == 3 && modes[i].degree == 1)
      q[model.rods[0].rod.first[1] + static_cast<Eigen::Index>(i)] = 0.5;
  EXPECT_NEAR(stretch_of(model.rods[0].rod, q).least, 0.5, 1e-6);
  EXPECT_NEAR(stretch_of(model.rods[0].rod, q).most, 1.5, 1e-6);
}

}  // namespace
}  // namespace sinew::test
