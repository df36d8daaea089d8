#include "sinew/sim/placement.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "sinew/error/input_error.hpp"
#include "support/scenes.hpp"

namespace sinew {
namespace {

TEST(Placement, turns_then_moves) {
  const Placement p = placement({{0, 0, std::numbers::pi / 2}, {1, 2, 3}});
  EXPECT_LT((apply(p, Vec3(1, 0, 0)) - Vec3(1, 3, 3)).norm(), 1e-15);
  EXPECT_LT((apply(compose(inverse(p), p), Vec3(4, 5, 6)) - Vec3(4, 5, 6)).norm(), 1e-14);
}

TEST(Placement, tables_are_linear_between_and_hold_their_ends) {
  const Table table{{1.0, 2.0, 4.0}, {10.0, 20.0, 0.0}};
  EXPECT_EQ(value_at(table, 0.0), 10.0);
  EXPECT_EQ(value_at(table, 1.5), 15.0);
  EXPECT_EQ(value_at(table, 3.0), 10.0);
  EXPECT_EQ(value_at(table, 9.0), 0.0);
  EXPECT_EQ(value_at(Table{{0.0}, {7.0}}, 3.0), 7.0);
}

TEST(Placement, boxes_and_points_are_in_the_objects_frame_unless_in_world) {
  Scene scene = test::cable_block();
  scene.solids[0].second.pose = {{0.3, 0.2, 0.1}, {1, 2, 3}};
  scene.rods[0].second.pose = scene.solids[0].second.pose;
  const Model own = build(scene, test::read_block);
  EXPECT_LT(
      (test::tip(own, initial_state(own)) - apply(placement(scene.solids[0].second.pose), Vec3(0.06, 0.005, 0.005)))
          .norm(),
      1e-15);
  scene.outputs[0].second.point = {Vec3(1.0, 2.0, 3.0), In::world};
  const Model world = build(scene, test::read_block);
  EXPECT_LT((test::tip(world, initial_state(world)) - Vec3(1, 2, 3)).norm(), 1e-15);
  std::get<Box>(scene.solids[0].second.fixed[0].region).in = In::world;
  EXPECT_THROW(build(scene, test::read_block), InputError);  // the box is then far from the body
}

TEST(Placement, rods_y_axis_is_the_worlds_up_by_default) {
  Scene scene = test::lone_rod();
  EXPECT_LT((build(scene, test::read_block).rods[0].base.R.col(1) - Vec3::UnitZ()).norm(), 1e-15);
  scene.rods[0].second.up = Vec3(0, 1, 0);
  EXPECT_LT((build(scene, test::read_block).rods[0].base.R.col(1) - Vec3::UnitY()).norm(), 1e-15);
  scene.rods[0].second.up.reset();
  scene.rods[0].second.path = {Vec3::Zero(), Vec3(0, 0, 0.5)};
  EXPECT_LT((build(scene, test::read_block).rods[0].base.R.col(1) - Vec3::UnitY()).norm(), 1e-15);
}

TEST(Build, points_in_a_clamped_region_are_dropped_or_met_by_the_rod) {
  Scene scene = test::cable_block();
  std::get<Box>(scene.solids[0].second.fixed[0].region).upper.x() = 31e-3;  // half the block is held
  test::slide(scene, 0).points = 31;
  const Model model = build(scene, test::read_block);
  EXPECT_EQ(model.couplings[0].no_unknown, std::vector<double>{0.0});  // at the base neither side can move
  EXPECT_GT(model.couplings[0].redundant.size(), 5u);
  const test::Trace trace = test::run_all(model);
  ASSERT_EQ(trace.end, RunEnd::done) << to_string(trace.failure.status) << " " << trace.failure.detail;
  for (const StepReport& report : trace.reports) EXPECT_LT(report.violation, 1e-9);
}

TEST(Signals, a_hole_in_the_clamp_is_watched_where_the_rod_was_drawn_past_it) {
  const Model model = build(test::cable_block(), test::read_block);
  ASSERT_EQ(model.couplings[0].no_unknown, std::vector<double>{0.0});
  ASSERT_TRUE(model.couplings[0].redundant.empty());
  State state = initial_state(model);
  EXPECT_LT(dropped_gap(model, state), 1e-15);
  const double out = 5e-3, radius = 12.5e-3;
  Eigen::VectorXd& q = state.rods[0].q;
  for (Eigen::Index i = 2; i < q.size(); i += 3)
    q[i] = 1.0 / radius;  // base, then torsion and bendings of each section
  q[0] = out;
  EXPECT_NEAR(dropped_gap(model, state), std::hypot(out, radius) - radius, 1e-9);
  q[0] = -out;  // pushed in: the rod begins beyond the hole
  EXPECT_EQ(dropped_gap(model, state), 0.0);
}

TEST(Build, twice_the_same_motion_of_a_rod_is_refused) {
  Scene scene = test::cable_block();
  scene.actuators.emplace_back("again", scene.actuators[0].second);
  EXPECT_THROW(build(scene, test::read_block), InputError);
}

TEST(Build, signals_are_named_as_promised) {
  Scene scene = test::cable_block();
  Actuator twist;
  twist.rod = "cable";
  twist.motion = Motion::rotation;
  twist.driven = Driven::angle;
  twist.drive = Table{{0.0}, {0.0}};
  scene.actuators.emplace_back("twist", twist);
  const Model model = build(scene, test::read_block);
  EXPECT_EQ(signal_names(model),
            (std::vector<std::string>{"tip.x", "tip.y", "tip.z", "pull.displacement", "pull.force", "twist.angle",
                                      "twist.torque", "energy.kinetic", "energy.elastic", "energy.weight",
                                      "energy.work", "energy.dissipated", "energy.work_bound"}));
  EXPECT_EQ(signal_values(model, initial_state(model)).size(), 13u);
}

}  // namespace
}  // namespace sinew
