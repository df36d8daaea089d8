// Ties against statics: turned shafts, propped beams, moving supports, rods joined to rods.
#include "validation/rods.hpp"

namespace sinew::test {
namespace {

constexpr double L = 0.8, EI = 2.5, GJ = 1.7;
const Stiffness kStiffness = {GJ, EI, EI, 1e6, 1e6, 1e6};
/// Loads so small that beam theory holds to their square.
constexpr double kSmall = 1e-4 * EI / (L * L);

/// Force of the holder on the rod in row `i` of a tie: rows along an axis are holder minus rod.
double on_rod(const Solved& solved, int i, std::size_t tie = 0) {
  return -solved.end().lambda[solved.model.ties[tie].row + i];
}

/// Moment of the holder on the rod in row `i`: rows about an axis are length times rod minus holder.
double moment_on_rod(const Solved& solved, int i) {
  return solved.end().lambda[solved.model.ties[0].row + i] * solved.model.ties[0].length;
}

class TurnedShaft : public testing::TestWithParam<std::tuple<double, int>> {};

TEST_P(TurnedShaft, with_its_tip_anchored_by_position_has_no_torque) {
  const auto [angle, sections] = GetParam();
  Scene scene = straight_rod(L, sections, given(kStiffness), kAll, 0, 8);
  turn_base(scene, angle);
  add_tie(scene, {true, true, true});
  const Solved solved = solve(scene);
  EXPECT_LT(std::abs(solved.end().actuators[0]), 1e-10 * GJ / L);
  EXPECT_LT((solved.tip() - Vec3(L, 0, 0)).norm(), 1e-10);
  EXPECT_NEAR(solved.frame(L)(2, 1), std::sin(angle), 1e-8);  // it has turned all along
  EXPECT_NEAR(solved.frame(L)(1, 1), std::cos(angle), 1e-8);
}

TEST_P(TurnedShaft, with_its_tip_clamped_twists_evenly) {
  const auto [angle, sections] = GetParam();
  Scene scene = straight_rod(L, sections, given(kStiffness), kAll, 0, 8);
  turn_base(scene, angle);
  add_tie(scene, {true, true, true}, {true, true, true});
  const Solved solved = solve(scene);
  const double torque = GJ * angle / L;
  EXPECT_NEAR(solved.end().actuators[0], torque, 1e-9 * torque);
  EXPECT_NEAR(moment_on_rod(solved, 3), -torque, 1e-9 * torque);
}

// The clamped one would buckle at 8.99 E I / (G J) = 13 rad.
INSTANTIATE_TEST_SUITE_P(AnglesAndSections, TurnedShaft,
                         testing::Combine(testing::Values(0.01, 1.0, 2.5), testing::Values(1, 6)));

TEST(Tie, inextensible_straight_rod_anchored_by_position_turns_without_torque) {
  // The row along its axis says nothing new: the tip of a straight rod that cannot stretch does not move along it.
  Scene scene = straight_rod(L, 5, given(kStiffness), kBending, 0, 8);
  turn_base(scene, 1.5);
  add_tie(scene, {true, true, true});
  const Solved solved = solve(scene);
  EXPECT_LT(std::abs(solved.end().actuators[0]), 1e-10 * GJ / L);
  EXPECT_NEAR(solved.frame(L)(1, 1), std::cos(1.5), 1e-8);
}

RodLoad& add_line_load(Scene& scene, double q) {
  RodLoad& load = add_load(scene, Vec3(0, -q, 0));
  load.from = 0.0;
  load.to = L;
  return load;
}

TEST(Tie, propped_cantilever_leaves_three_eighths_on_the_prop) {
  const double q = kSmall / L;
  Scene scene = straight_rod(L, 8, given(kStiffness), kAll, 2);
  add_line_load(scene, q);
  add_tie(scene, {false, true, false});
  const Solved solved = solve(scene);
  EXPECT_NEAR(on_rod(solved, 0), 3.0 / 8 * q * L, 1e-4 * q * L);
  const double moment = rod::strain(solved.model.rods[0].rod, solved.end().rods[0].q, 0.0)[2] * EI;
  EXPECT_NEAR(moment, -q * L * L / 8, 1e-3 * q * L * L / 8);
  EXPECT_LT(std::abs(solved.tip().y()), 1e-12);
}

TEST(Tie, beam_clamped_at_both_ends_halves_the_load) {
  const double q = kSmall / L;
  Scene scene = straight_rod(L, 8, given(kStiffness), kAll, 2);
  add_line_load(scene, q);
  add_tie(scene, {false, true, true}, {true, true, true});
  const Solved solved = solve(scene);
  EXPECT_NEAR(on_rod(solved, 0), q * L / 2, 1e-4 * q * L);
  EXPECT_NEAR(moment_on_rod(solved, 4), -q * L * L / 12, 1e-4 * q * L * L);
  EXPECT_NEAR(solved.at(L / 2).y(), -q * std::pow(L, 4) / (384 * EI), 1e-3 * q * std::pow(L, 4) / (384 * EI));
}

TEST(Tie, beam_on_two_pins_and_a_middle_support) {
  // Two spans under an even load: 5/8 of it on the middle, 3/16 on each end.
  const double q = kSmall / L;
  Scene scene = straight_rod(L, 8, given(kStiffness), kAll, 2);
  scene.rods[0].second.base = {BaseAxis::turn_z};
  add_line_load(scene, q);
  add_tie(scene, {false, true, false});
  add_tie(scene, {false, true, false}).at = L / 2;
  const Solved solved = solve(scene);
  EXPECT_NEAR(on_rod(solved, 0, 0), 3.0 / 16 * q * L, 1e-4 * q * L);
  EXPECT_NEAR(on_rod(solved, 0, 1), 5.0 / 8 * q * L, 1e-4 * q * L);
}

Scene held_by_frame(const Vec3& turn, const Vec3& shift, std::array<bool, 3> along, std::array<bool, 3> about) {
  Scene scene = straight_rod(L, 8, given(kStiffness), kAll, 2, 4);
  Frame frame;
  frame.motion = FrameMotion{{0.0, 1.0}, {Vec3::Zero(), turn}, {Vec3::Zero(), shift}};
  scene.frames.emplace_back("hand", frame);
  add_tie(scene, along, about).frame = "hand";
  return scene;
}

TEST(Tie, support_that_sinks_takes_three_e_i_over_l_cubed) {
  const double d = 1e-4 * L;
  const Solved solved = solve(held_by_frame(Vec3::Zero(), Vec3(0, d, 0), {false, true, false}, {}));
  EXPECT_NEAR(solved.tip().y(), d, 1e-12);
  EXPECT_NEAR(on_rod(solved, 0), 3 * EI * d / (L * L * L), 1e-3 * 3 * EI * d / (L * L * L));
}

TEST(Tie, clamp_that_turns_takes_four_e_i_over_l) {
  // The frame turns about the tip: x -> R x + (tip - R tip), so the shift is not linear in time, but at its end.
  const double turn = 1e-4;
  const Vec3 shift(L - L * std::cos(turn), -L * std::sin(turn), 0);
  const Solved solved = solve(held_by_frame(Vec3(0, 0, turn), shift, {false, true, true}, {true, true, true}));
  EXPECT_LT(std::abs(solved.tip().y()), 1e-9);
  EXPECT_NEAR(moment_on_rod(solved, 4), 4 * EI * turn / L, 1e-3 * 4 * EI * turn / L);
  EXPECT_NEAR(on_rod(solved, 0), -6 * EI * turn / (L * L), 1e-3 * 6 * EI * turn / (L * L));
}

TEST(Tie, pin_follows_a_frame_through_a_large_motion) {
  const Vec3 turn(0.3, -0.2, 0.6), shift(-0.35, 0.1, 0.25);
  const Solved solved = solve(held_by_frame(turn, shift, {true, true, true}, {}));
  const Vec3 there = frame_displacement(solved.model.scene.frames[0].second, 1.0).R * Vec3(L, 0, 0) + shift;
  EXPECT_GT((there - Vec3(L, 0, 0)).norm(), 0.2 * L);
  EXPECT_LT((solved.tip() - there).norm(), 1e-8);
}

TEST(Tie, clamp_follows_a_frame_through_a_large_motion) {
  const Vec3 turn(0.3, -0.2, 0.6), shift(-0.15, 0.1, 0.05);
  Scene scene = held_by_frame(turn, shift, {true, true, true}, {true, true, true});
  scene.rods[0].second.section = given({GJ, EI, EI, 1e3, 1e3, 1e3});
  const Solved solved = solve(scene);
  const Placement hand = frame_displacement(solved.model.scene.frames[0].second, 1.0);
  EXPECT_LT((solved.tip() - apply(hand, Vec3(L, 0, 0))).norm(), 1e-8);
  EXPECT_LT((solved.frame(L) - hand.R).norm(), 1e-8);
}

// A frame turns twice about the axis that a tie leaves free: the rod's tip goes on pointing along that axis, the rod
// stays as it is, and moments are about the axes that are held.
class FreeTurn : public testing::TestWithParam<int> {};

TEST_P(FreeTurn, goes_round_and_round) {
  const int free = GetParam();
  std::array<bool, 3> about = {true, true, true};
  about[static_cast<std::size_t>(free)] = false;
  Scene scene = straight_rod(L, 8, given({GJ, EI, EI, 1e3, 1e3, 1e3}), kAll, 1, 60);
  Frame frame;
  frame.motion = FrameMotion{{0.0, 1.0}, {Vec3::Zero(), 4.0 * pi * Vec3::Unit(free)}, {Vec3::Zero(), Vec3::Zero()}};
  scene.frames.emplace_back("hand", frame);
  add_tie(scene, {false, false, false}, about).frame = "hand";
  add_load(scene, EI * Vec3(0.3, 0.5, -0.4));
  const Solved solved = solve(scene);
  scene.couplings.clear();
  scene.frames.clear();
  add_tie(scene, {false, false, false}, about);
  const Solved still = solve(scene);
  EXPECT_LT((solved.tip() - still.tip()).norm(), 1e-7);
  EXPECT_LT((solved.frame(L).col(free) - Vec3::Unit(free)).norm(), 1e-8);
}
INSTANTIATE_TEST_SUITE_P(Axes, FreeTurn, testing::Range(0, 3));

/// A second rod that comes towards the first one's tip along -x from `from`.
Tie& add_second(Scene& scene, double from, int sections, const std::vector<BaseAxis>& base) {
  Rod second = scene.rods[0].second;
  second.path = {Vec3(from, 0, 0), Vec3(L, 0, 0)};
  second.sections = sections;
  second.base = base;
  scene.rods.emplace_back("second", second);
  Tie tie;
  tie.rod = "second";
  tie.other = "rod";
  scene.couplings.emplace_back(tie);
  return std::get<Tie>(scene.couplings.back());
}

class Joined : public testing::TestWithParam<bool> {};

TEST_P(Joined, two_rods_rigidly_tip_to_tip_are_one_rod) {
  const Stiffness stiffness = {GJ, EI, 1.3 * EI, 60.0, 40.0, 50.0};
  const auto& strains = GetParam() ? kAll : kBending;
  const Vec3 force = EI * Vec3(-0.5, 1.5, 2.0);
  Scene one = straight_rod(1.5 * L, 6, given(stiffness), strains, 0, 4);
  add_load(one, force);
  Scene two = straight_rod(L, 4, given(stiffness), strains, 0, 4);
  add_second(two, 1.5 * L, 2,
             {BaseAxis::x, BaseAxis::y, BaseAxis::z, BaseAxis::turn_x, BaseAxis::turn_y, BaseAxis::turn_z})
      .about = {true, true, true};
  RodLoad& load = add_load(two, force, Vec3::Zero(), 0.0);
  load.rod = "second";
  const Solved whole = solve(one), halves = solve(two);
  EXPECT_GT((whole.tip() - Vec3(1.5 * L, 0, 0)).norm(), 0.2 * L);
  EXPECT_LT((halves.tip(0) - whole.at(L)).norm(), 1e-7);
  EXPECT_LT((halves.tip(1) - whole.at(L)).norm(), 1e-7);
  EXPECT_LT((rod::position(halves.shape(1), 0.0) - whole.tip()).norm(), 1e-7);
}

INSTANTIATE_TEST_SUITE_P(Strains, Joined, testing::Values(false, true));

TEST(Tie, two_cantilevers_pinned_tip_to_tip_share_a_load) {
  Scene scene = straight_rod(L, 4, given(kStiffness), kAll, 1);
  add_second(scene, 2 * L, 4, {}).along = {false, true, true};
  add_load(scene, Vec3(0, kSmall, 0));
  const Solved solved = solve(scene);
  const double exact = kSmall * L * L * L / (6 * EI);
  EXPECT_NEAR(solved.tip(0).y(), exact, 1e-3 * exact);
  EXPECT_NEAR(solved.tip(1).y(), solved.tip(0).y(), 1e-9 * exact + 1e-13);
}

TEST(Tie, that_nothing_in_the_rod_can_follow_warns) {
  Scene scene = straight_rod(0.5, 4, given({1, 1, 1, 1, 1, 1}));
  add_tie(scene, {true, false, false});
  const Model locked = build(scene, read_block);
  ASSERT_EQ(locked.warnings.size(), 1u);
  EXPECT_NE(to_string(locked.warnings[0]).find("add `elongation`"), std::string::npos) << to_string(locked.warnings[0]);
  scene.rods[0].second.strains = kExtensible;
  EXPECT_TRUE(build(scene, read_block).warnings.empty());
  scene.rods[0].second.strains = {Strain::bending_z};
  std::get<Tie>(scene.couplings[0]) = Tie{};
  std::get<Tie>(scene.couplings[0]).rod = "rod";
  std::get<Tie>(scene.couplings[0]).along = {false, true, false};
  std::get<Tie>(scene.couplings[0]).about = {true, false, true};
  EXPECT_EQ(build(scene, read_block).warnings.size(), 1u);  // about x
}

}  // namespace
}  // namespace sinew::test
