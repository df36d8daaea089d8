// Steps that fail: their status, the halves they are tried in, and the grid of time they come back to.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "sinew/sim/step.hpp"
#include "support/scenes.hpp"

namespace sinew {
namespace {

using test::mm;

TEST(Status, too_few_iterations_are_reported_and_the_state_is_untouched) {
  Scene scene = test::cable_block(2 * mm, 0.2);
  scene.newton.limit = 1;
  const Model model = build(scene, test::read_block);
  Workspace workspace = make_workspace(model);
  const State start = initial_state(model);
  const StepResult result = step(model, workspace, command_at(model, 0.01), start, 0.01);
  EXPECT_EQ(result.report.status, Status::max_iterations);
  EXPECT_EQ(pack(result.next), pack(start));
}

TEST(Status, a_rod_pushed_back_past_its_entry_is_exhausted) {
  Scene scene = test::cable_block();
  test::slide(scene, 0).anchor_tip = AnchorTip::none;
  scene.actuators[0].second.drive = Table{{0.0, 0.5}, {0.0, -20 * mm}};
  scene.time.duration = 0.5;
  test::slide(scene, 0).points = std::vector<double>{10 * mm, 20 * mm, 30 * mm};
  const Model model = build(scene, test::read_block);
  const test::Trace trace = test::run_all(model);
  EXPECT_EQ(trace.end, RunEnd::stopped);
  EXPECT_EQ(trace.failure.status, Status::rod_exhausted);
  EXPECT_EQ(trace.failure.detail, "rods.cable");
  EXPECT_GT(trace.states.size(), 20u);  // everything up to there is kept
}

TEST(Status, force_beyond_all_numbers_stops_without_nan) {
  Scene scene = test::cable_block();
  scene.actuators[0].second.driven = Driven::force;
  scene.actuators[0].second.drive = Table{{0.0}, {1e200}};
  const Model model = build(scene, test::read_block);
  const test::Trace trace = test::run_all(model);
  EXPECT_EQ(trace.end, RunEnd::stopped);
  EXPECT_FALSE(accepted(trace.failure.status));
  for (const State& state : trace.states) {
    for (double number : pack(state)) ASSERT_TRUE(std::isfinite(number));
  }
}

TEST(Status, every_status_has_a_name_and_a_meaning) {
  for (Status status : {Status::rest, Status::converged, Status::linearized, Status::max_iterations, Status::singular,
                        Status::diverged, Status::inverted, Status::path_lost, Status::rod_exhausted}) {
    EXPECT_NE(to_string(status), "unknown");
    EXPECT_FALSE(explain(status).empty());
    EXPECT_EQ(accepted(to_string(status)), accepted(status)) << to_string(status);
  }
}

TEST(Advance, a_step_that_does_not_converge_is_halved_and_meets_the_grid_again) {
  // A pull that one step cannot follow within three linearisations.
  Scene scene = test::cable_block(6 * mm, 0.3);
  scene.time = {0.02, 0.1};
  scene.newton.limit = 4;
  const Model model = build(scene, test::read_block);
  const test::Trace trace = test::run_all(model);
  ASSERT_EQ(trace.end, RunEnd::done) << to_string(trace.failure.status);
  EXPECT_GT(trace.states.size(), 6u);
  EXPECT_EQ(trace.states.back().grid, 5);
  EXPECT_EQ(trace.states.back().time, 0.1);
  long grid = 0;
  for (const State& state : trace.states) {
    EXPECT_GE(state.grid, grid);
    if (state.grid > grid) {
      EXPECT_EQ(state.time, static_cast<double>(state.grid) * 0.02);
    }
    grid = state.grid;
  }
}

TEST(Advance, a_jump_of_the_command_is_spread_over_the_parts_of_a_halved_step) {
  Scene scene = test::cable_block();
  scene.actuators[0].second.drive = Table{{0.0}, {12 * mm}};  // a fifth of the block's length, from the start
  scene.newton.limit = 8;
  const Model model = build(scene, test::read_block);
  const test::Trace trace = test::run_all(model);
  ASSERT_EQ(trace.end, RunEnd::done) << to_string(trace.failure.status);
  EXPECT_GT(trace.states.size(), 21u);  // halved at the start
  EXPECT_GT(trace.states[1].rods[0].q[0], 0.1 * mm);
  EXPECT_LT(trace.states[1].rods[0].q[0], 11 * mm);
  EXPECT_NEAR(trace.states.back().rods[0].q[0], 12 * mm, 1e-12);
}

/// The block alone, its free end pulled at by a force; or nothing holds it and it falls.
Scene once_linearised_block(double force, double step) {
  Scene scene = test::cable_block();
  scene.rods.clear();
  scene.couplings.clear();
  scene.actuators.clear();
  SolidLoad load;
  load.solid = "block";
  load.region = Plane{Vec3(60 * mm, 0, 0), Vec3::UnitX()};
  load.force = Vec3(0, 0, force);
  if (force != 0.0) scene.loads.emplace_back("push", load);
  if (force == 0.0) scene.solids[0].second.fixed.clear();
  scene.gravity = Vec3(0, 0, force == 0.0 ? -9.81 : 0.0);
  scene.newton.iterations = 1;
  scene.time = {step, 5 * step};
  return scene;
}

TEST(Advance, a_linearisation_beyond_trust_is_refused_and_named) {
  const Model model = build(once_linearised_block(1e5, 0.02), test::read_block);
  const test::Trace trace = test::run_all(model);
  ASSERT_EQ(trace.end, RunEnd::stopped);
  EXPECT_EQ(trace.failure.status, Status::diverged);
  EXPECT_THAT(trace.failure.detail, testing::StartsWith("solids.block, a node moved by "));
}

TEST(Advance, statics_that_fail_are_not_repeated_for_newton_n) {
  std::array<int, 2> iterations{};
  for (int n : {0, 1}) {
    Scene scene = once_linearised_block(1e5, 0.02);
    scene.analysis = Analysis::statics;
    scene.newton.iterations = n;
    const Model model = build(scene, test::read_block);
    Workspace workspace = make_workspace(model);
    State state = initial_state(model);
    StepReport report = advance(model, workspace, state);
    while (accepted(report.status) && state.grid < grid_steps(model.scene)) report = advance(model, workspace, state);
    ASSERT_FALSE(accepted(report.status));
    iterations[n] = report.newton;
  }
  EXPECT_EQ(iterations[1], iterations[0]);
}

TEST(Advance, a_linearisation_beyond_trust_may_go_in_halves) {
  const Model model = build(once_linearised_block(0.5, 0.05), test::read_block);
  const test::Trace trace = test::run_all(model);
  ASSERT_EQ(trace.end, RunEnd::done) << trace.failure.detail;
  EXPECT_TRUE(
      std::any_of(trace.reports.begin(), trace.reports.end(), [](const auto& own) { return own.halvings > 0; }));
}

TEST(Advance, what_flies_as_a_whole_is_no_matter_of_trust) {
  const double h = 0.5, g = 9.81;
  const Model model = build(once_linearised_block(0.0, h), test::read_block);
  const test::Trace trace = test::run_all(model);
  ASSERT_EQ(trace.end, RunEnd::done) << trace.failure.detail;
  for (const StepReport& report : trace.reports) EXPECT_EQ(report.halvings, 0);
  for (const State& state : trace.states) {  // (35 m at the end)
    const Eigen::Matrix3Xd fallen = state.solids[0].x - model.solids[0].body.rest;
    EXPECT_NEAR((fallen.colwise() - fallen.col(0)).norm(), 0.0, 1e-5);
  }
  EXPECT_NEAR(trace.states[1].solids[0].x(2, 0) - model.solids[0].body.rest(2, 0), -g * h * h / (1.0 + 0.1 * h), 1e-6);
}

TEST(Advance, the_grid_covers_the_whole_duration) {
  Scene scene;
  scene.time = {0.01, 2.0};
  EXPECT_EQ(grid_steps(scene), 200);
  scene.time.duration = 0.015;
  EXPECT_EQ(grid_steps(scene), 2);
  scene.time.duration = 0.004;
  EXPECT_EQ(grid_steps(scene), 1);
  scene.time.duration = 0.0;
  EXPECT_EQ(grid_steps(scene), 0);
}

TEST(Advance, parts_of_a_step_begin_at_multiples_of_themselves) {
  const Scene scene = once_linearised_block(1.5, 0.05);
  const Model model = build(scene, test::read_block);
  const test::Trace trace = test::run_all(model);
  ASSERT_EQ(trace.end, RunEnd::done) << trace.failure.detail;
  int most = 0;
  for (std::size_t i = 0; i < trace.reports.size(); ++i) {
    const double part = std::ldexp(scene.time.step, -trace.reports[i].halvings);
    EXPECT_NEAR(trace.states[i + 1].time - trace.states[i].time, part, 1e-12);
    const double begins = trace.states[i].time / part;
    EXPECT_NEAR(begins, std::round(begins), 1e-9) << "after " << trace.reports[i].halvings << " halvings";
    most = std::max(most, trace.reports[i].halvings);
  }
  EXPECT_GE(most, 2);
}

// Times are rounded: no step of 1e-12 s may be left at the end of what was halved.
TEST(Advance, parts_end_on_the_grid_late_in_a_run) {
  Scene scene = once_linearised_block(50.0, 0.05);  // so much that the block goes no further than a 64th
  scene.time.smallest = scene.time.step / 64;
  const Model model = build(scene, test::read_block);
  Workspace workspace = make_workspace(model);
  const int halvings = most_halvings(scene);
  const double smallest = std::ldexp(scene.time.step, -halvings);
  for (long grid = 40960; grid < 60000; grid += 1901) {
    State state = initial_state(model);
    state.loads = {1.0};
    state.grid = grid;
    state.time = static_cast<double>(grid) * scene.time.step;
    for (int part = 0; part < 1 << halvings; ++part) {
      State next = state;
      const StepReport report = advance(model, workspace, next);
      ASSERT_TRUE(accepted(report.status)) << report.detail;
      EXPECT_NEAR(next.time - state.time, smallest, 1e-3 * smallest) << grid << ", part " << part;
      state.grid = next.grid;  // (the block begins each part at rest)
      state.time = next.time;
    }
    EXPECT_EQ(state.grid, grid + 1);
    EXPECT_EQ(state.time, static_cast<double>(grid + 1) * scene.time.step);
  }
}

TEST(Advance, halving_ends) {
  Scene scene = test::cable_block(6 * mm, 0.3);
  scene.newton.limit = 2;
  scene.newton.tolerance = 1e-30;
  const Model model = build(scene, test::read_block);
  const test::Trace trace = test::run_all(model);
  EXPECT_EQ(trace.end, RunEnd::stopped);
  EXPECT_EQ(trace.failure.status, Status::max_iterations);
  EXPECT_EQ(trace.failure.halvings, most_halvings(scene));
  EXPECT_EQ(trace.states.size(), 1u);
}

}  // namespace
}  // namespace sinew
