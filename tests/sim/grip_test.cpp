// Hands: springs that whoever steps a scene ties to nodes of solids.
#include <gtest/gtest.h>

#include "sinew/sim/run.hpp"
#include "sinew/sim/signals.hpp"
#include "support/meshes.hpp"

namespace sinew {
namespace {

constexpr double kLength = 0.1, kWidth = 0.02;

/// A bar along x that is held at x = 0.
Scene bar(Analysis analysis) {
  Scene scene;
  scene.analysis = analysis;
  scene.gravity = {0.0, 0.0, -9.81};
  auto& [name, solid] = scene.solids.emplace_back();
  name = "bar";
  solid.material.law = solid::corotational(1e6, 0.3);
  solid.density = 1000.0;
  solid.fixed.emplace_back().region = Box{Vec3(-1e-6, -1.0, -1.0), Vec3(1e-6, 1.0, 1.0)};
  return scene;
}

solid::Mesh bar_mesh(const std::filesystem::path&) { return test::block_mesh(10, 2, 2, {kLength, kWidth, kWidth}); }

int farthest_node(const Model& model) {
  Eigen::Index node = 0;
  (model.solids[0].body.rest.row(0) + 1e-3 * model.solids[0].body.rest.row(2)).maxCoeff(&node);
  return static_cast<int>(node);
}

TEST(Grip, IsTheSameAsASpringOfTheScene) {
  Scene sprung = bar(Analysis::dynamic);
  Model model = build(bar(Analysis::dynamic), bar_mesh);
  const int node = farthest_node(model);
  sprung.solids[0].second.springs.push_back({NodeNumbers{{node}}, Vec3(50.0, 50.0, 50.0)});
  const Model other = build(sprung, bar_mesh);
  Workspace a(model), b(other);
  State x = initial_state(model), y = initial_state(other);
  for (int i = 0; i < 20; ++i) {
    Command command = command_at(model, x.time);
    command.grips = {{0, node, 50.0, model.solids[0].body.rest.col(node)}};
    ASSERT_EQ(advance(model, a, x, {}, {&command}).status, Status::converged);
    ASSERT_EQ(advance(other, b, y).status, Status::converged);
  }
  EXPECT_LT((x.solids[0].x - y.solids[0].x).norm(), 1e-12);
  EXPECT_GT((x.solids[0].x - model.solids[0].body.rest).norm(), 1e-3);
}

TEST(Grip, PullsByItsStiffnessAndTheWorkIsTold) {
  const Model model = build(bar(Analysis::quasi_static), bar_mesh);
  const int node = farthest_node(model);
  Workspace workspace(model);
  State state = initial_state(model);
  ASSERT_EQ(advance(model, workspace, state).status, Status::converged);
  const Vec3 alone = state.solids[0].reaction.reshaped(3, state.solids[0].reaction.size() / 3).rowwise().sum();
  const double before = energy_balance(model, state).total() - state.energies.work;
  const Vec3 to = state.solids[0].x.col(node) + Vec3(0.0, 0.0, 0.01);
  for (int i = 1; i <= 200; ++i) {  // slowly, so that the mean of forces is their work
    Command command = command_at(model, state.time);
    command.grips = {{0, node, 0.1 * i, to}};
    ASSERT_EQ(advance(model, workspace, state, {}, {&command}).status, Status::converged);
  }
  const Vec3 held = state.solids[0].reaction.reshaped(3, state.solids[0].reaction.size() / 3).rowwise().sum();
  const Vec3 pull = 20.0 * (to - state.solids[0].x.col(node));
  EXPECT_GT(pull.z(), 0.02);
  EXPECT_LT((alone - held - pull).norm(), 1e-9);  // what the hand takes the support need not bear
  EXPECT_NEAR(energy_balance(model, state).total() - state.energies.work, before, 0.02 * std::abs(state.energies.work));
}

TEST(Grip, IsGoneWhenItIsNotToldAgain) {
  const Model model = build(bar(Analysis::quasi_static), bar_mesh);
  Workspace workspace(model), fresh(model);
  State state = initial_state(model);
  Command command = command_at(model, 0.0);
  command.grips = {{0, farthest_node(model), 50.0, Vec3(0.1, 0.0, 0.05)}};
  ASSERT_EQ(advance(model, workspace, state, {}, {&command}).status, Status::converged);
  State other = state;
  ASSERT_EQ(advance(model, workspace, state).status, Status::converged);
  ASSERT_EQ(advance(model, fresh, other).status, Status::converged);
  EXPECT_EQ(pack(state), pack(other));
}

}  // namespace
}  // namespace sinew
