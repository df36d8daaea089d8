#include "sinew/sim/reduced.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>

#include "sinew/error/input_error.hpp"
#include "support/difference.hpp"
#include "support/scenes.hpp"

namespace sinew {
namespace {

/// A state in the middle of things: bent rod, points off the section edges and off the rod, multipliers of order one.
State busy_state(const Model& model, double size) {
  State state = initial_state(model);
  for (int i = 0; i < state.rods[0].q.size(); ++i)
    state.rods[0].q[i] += (model.rods[0].geometric ? 1e-3 : size) * std::cos(1.3 * i);
  if (!model.rods[0].geometric) state.rods[0].q[0] = 1e-3;
  for (std::size_t k = 0; k < state.points.size(); ++k) {
    if (model.points[k].unknown >= 0) state.points[k].s += 1.3e-3;
    state.points[k].lambda = Vec3(std::cos(1.0 * static_cast<double>(k)), std::sin(2.0 * static_cast<double>(k)), 0.5);
  }
  state.tensions[0] = 2.0;
  return state;
}

class Tangent : public testing::TestWithParam<std::tuple<bool, double>> {};

// Everything the coupled problem says about its unknowns: B is the derivative of r, -G that of c, with respect to
// coordinates and abscissae together, at fixed multipliers.
TEST_P(Tangent, matches_finite_differences) {
  const auto [geometric, size] = GetParam();
  Scene scene = test::cable_block();
  scene.gravity = Vec3(0, 0, -9.81);
  scene.rods[0].second.strains = {Strain::torsion,    Strain::bending_y, Strain::bending_z,
                                  Strain::elongation, Strain::shear_y,   Strain::shear_z};
  if (size > 1.0) scene.rods[0].second.strains.resize(3);  // 10 1/m of curvature; elongation of that size is none
  if (geometric) scene.rods[0].second.cable = Cable::geometric;
  const Model model = build(scene, test::read_block);
  const State start = initial_state(model);
  const StepContext context = make_context(model, start, command_at(model, 0.01), 0.01);
  const State state = busy_state(model, size);

  const int n = model.reduced, own = model.rods[0].coordinates();
  Eigen::VectorXd z(n);
  z.head(own) = state.rods[0].q;
  for (std::size_t k = 0; k < model.points.size(); ++k) {
    if (model.points[k].unknown >= 0) z[model.points[k].unknown] = state.points[k].s;
  }
  const auto at = [&](const Eigen::VectorXd& y) {
    State moved = state;
    moved.rods[0].q = y.head(own);
    for (std::size_t k = 0; k < model.points.size(); ++k) {
      if (model.points[k].unknown >= 0) moved.points[k].s = y[model.points[k].unknown];
    }
    return linearize(context, moved).problem;
  };
  const solve::CoupledProblem problem = at(z);
  const Eigen::MatrixXd dr = test::difference([&](const Eigen::VectorXd& y) { return at(y).r; }, z, 1e-7);
  const Eigen::MatrixXd dc = test::difference([&](const Eigen::VectorXd& y) { return at(y).c; }, z, 1e-7);
  EXPECT_GT(dr.norm(), 1e-3);
  EXPECT_GT(dc.norm(), 1e-3);
  // Column by column: they differ by ten orders of magnitude (elongation, bending, abscissae).
  for (int j = 0; j < n; ++j) {
    EXPECT_LT((problem.B.col(j) - dr.col(j)).norm(), 1e-6 * dr.col(j).norm() + 2e-8) << "r, column " << j;
    EXPECT_LT((problem.G.col(j) + dc.col(j)).norm(), 1e-6 * dc.col(j).norm() + 2e-9) << "c, column " << j;
  }
  EXPECT_LT((problem.B - problem.B.transpose()).norm(), 1e-12 * problem.B.norm());
  // The curvature of the multipliers along the curve is there, and is not nothing.
  if (!geometric && size > 1.0) {
    double along = 0.0;
    for (const PointModel& point : model.points) {
      if (point.unknown >= 0) along = std::max(along, std::abs(problem.B(point.unknown, point.unknown)));
    }
    EXPECT_GT(along, 1.0);
  }
}

INSTANTIATE_TEST_SUITE_P(Reduced, Tangent,
                         testing::Combine(testing::Bool(), testing::Values(0.0, 1e-8, 1e-5, 0.1, 10.0)));

TEST(Build, an_anchor_is_kept_where_nothing_else_could_be) {
  // In a clamped region, on a rod that can only stretch: no row across it says anything, the anchor's row along it
  // does.
  Scene scene = test::cable_block();
  scene.solids[0].second.fixed[0].upper = Vec3(61 * test::mm, 11 * test::mm, 4 * test::mm);
  scene.rods[0].second.path = {Vec3(0, 5 * test::mm, 3 * test::mm), Vec3(60 * test::mm, 5 * test::mm, 3 * test::mm)};
  scene.rods[0].second.strains = {Strain::elongation};
  scene.couplings[0].points = std::vector<double>{60 * test::mm};
  scene.solids[0].second.fixed[0].upper.z() = 6 * test::mm;
  const Model model = build(scene, test::read_block);
  EXPECT_EQ(model.couplings[0].kept, 1);
  const test::Trace trace = test::run_all(model);
  ASSERT_EQ(trace.end, RunEnd::done) << to_string(trace.failure.status);
  const double EA = model.rods[0].rod.stiffness[0][3];
  EXPECT_NEAR(trace.states.back().actuators[0], EA * 2e-3 / 60e-3, 1e-6 * EA);
}

TEST(Build, a_second_coupling_does_not_repeat_the_rows_of_the_first) {
  Scene scene = test::cable_block();
  scene.couplings.push_back(scene.couplings[0]);
  scene.couplings[1].anchor_tip = AnchorTip::none;
  const Model model = build(scene, test::read_block);
  EXPECT_EQ(model.couplings[0].kept, 5);
  EXPECT_EQ(model.couplings[1].kept, 0);
}

TEST(Build, a_geometric_cable_that_nothing_holds_is_refused) {
  Scene scene = test::cable_block();
  scene.rods[0].second.cable = Cable::geometric;
  EXPECT_NO_THROW(build(scene, test::read_block));
  scene.actuators.clear();
  EXPECT_THROW(build(scene, test::read_block), InputError);
}

TEST(Build, points_and_outputs_beyond_the_reach_are_refused_and_within_it_extrapolated) {
  Scene scene = test::cable_block();
  scene.outputs[0].second.point.x = Vec3(63e-3, 5e-3, 5e-3);
  const Model model = build(scene, test::read_block);
  EXPECT_LT((test::tip(model, initial_state(model)) - Vec3(63e-3, 5e-3, 5e-3)).norm(), 1e-15);
  EXPECT_EQ(model.warnings.size(), 1u);
  scene.outputs[0].second.reach = 2e-3;
  EXPECT_THROW(build(scene, test::read_block), InputError);
  scene = test::cable_block();
  for (Vec3& p : scene.rods[0].second.path) p.z() += 10e-3;
  EXPECT_THROW(build(scene, test::read_block), InputError);
}

}  // namespace
}  // namespace sinew
