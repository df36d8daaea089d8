// `newton: {precision: single}`: factors in floats, solutions as in doubles.
#include <gtest/gtest.h>

#include "sinew/io/mesh_file.hpp"
#include "sinew/sim/run.hpp"
#include "support/meshes.hpp"
#include "support/robots.hpp"
#include "validation/solids.hpp"

namespace sinew::test {
namespace {

constexpr auto kSingle = linalg::Precision::float32;

struct Moved {
  State start, state;
  std::vector<StepReport> reports;
};

Moved moved(Scene scene, const MeshReader& meshes, int steps, linalg::Precision precision, int threads = 1) {
  scene.newton.precision = precision;
  const Model model = build(scene, meshes);
  Workspace workspace = make_workspace(model, threads);
  Moved own{initial_state(model), initial_state(model), {}};
  for (int i = 0; i < steps; ++i) {
    own.reports.push_back(advance(model, workspace, own.state));
    EXPECT_TRUE(accepted(own.reports.back().status))
        << to_string(own.reports.back().status) << " " << own.reports.back().detail;
  }
  return own;
}

void expect_alike(const Moved& one, const Moved& other, double tolerance) {
  for (std::size_t i = 0; i < one.state.solids.size(); ++i) {
    const double distance = (one.state.solids[i].x - one.start.solids[i].x).norm();
    EXPECT_GT(distance, 0.0);
    EXPECT_LT((one.state.solids[i].x - other.state.solids[i].x).norm(), tolerance * distance);
  }
  for (std::size_t i = 0; i < one.state.rods.size(); ++i)
    EXPECT_LT((one.state.rods[i].q - other.state.rods[i].q).norm(), tolerance * (1e-3 + one.state.rods[i].q.norm()));
  EXPECT_LE((one.state.lambda - other.state.lambda).norm(), tolerance * one.state.lambda.norm());
}

/// Single steps correct nothing later: what a refinement leaves stays.
TEST(Precision, SingleStepsAreThoseOfDoubles) {
  for (const int cells : {300, 4000}) {
    const Moved twice = moved(block(), block_of(cells), 5, linalg::Precision::float64);
    const Moved once = moved(block(), block_of(cells), 5, kSingle);
    expect_alike(twice, once, 1e-9);
    EXPECT_FALSE(twice.state.solids[0].x == once.state.solids[0].x);  // another factor was at work
  }
}

/// Step by step from the same state: the trunk's slack cables swing up, and any rounding with them.
TEST(Precision, RobotsMoveAsInDoubles) {
  const std::filesystem::path meshes = SINEW_SHARED_MESHES;
  if (!std::filesystem::exists(meshes / "finger.vtk")) GTEST_SKIP() << "no finger.vtk in " << meshes;
  for (Scene scene : {finger(meshes, 15, 15, Cable::cosserat), finger(meshes, 1, 15, Cable::geometric),
                      trunk(meshes, 10), trunk(meshes, 21)}) {
    const Model twice = build(scene, io::read_mesh);
    scene.newton.precision = kSingle;
    const Model once = build(scene, io::read_mesh);
    Workspace workspace = make_workspace(twice), own = make_workspace(once);
    State state = initial_state(twice);
    for (int i = 0; i < 5; ++i) {
      const Moved before{state, state, {}};
      Moved doubles = before, floats = before;
      EXPECT_TRUE(accepted(advance(twice, workspace, doubles.state).status));
      EXPECT_TRUE(accepted(advance(once, own, floats.state).status));
      expect_alike(doubles, floats, 1e-9);
      state = doubles.state;
    }
  }
}

/// Follower pressure on a face with a free rim: a tangent that is not symmetric.
TEST(Precision, StaticsTakesAsManyIterations) {
  for (const solid::Kind kind : {solid::Kind::tet4, solid::Kind::tet10, solid::Kind::hex8}) {
    Scene scene = solid_scene(solid::neo_hookean(1e6, 0.3), 1);
    hold(scene, plane(Vec3::Zero(), Vec3::UnitZ()));
    load_solid(scene, plane(Vec3(0, 0, 1), Vec3::UnitZ()), Vec3::Zero(), -2e5);
    const auto mesh = [kind](const auto&) { return block_mesh(3, 3, 3, Vec3(1, 1, 1), kind); };
    const Moved twice = moved(scene, mesh, 1, linalg::Precision::float64), once = moved(scene, mesh, 1, kSingle);
    expect_alike(twice, once, 1e-9);
    EXPECT_EQ(twice.reports[0].newton, once.reports[0].newton);
  }
}

/// Bodies that yield ever less in volume, until more digits than a float has are between their stiffnesses: refined, or
/// refused with the reason.
TEST(Precision, WhatCannotBeRefinedSaysSo) {
  int refused = 0;
  for (const double compressible : {1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8}) {
    Scene scene = solid_scene(solid::corotational(1e6, 0.5 - compressible), 1);
    hold(scene, plane(Vec3::Zero(), Vec3::UnitZ()));
    load_solid(scene, plane(Vec3(0, 0, 1), Vec3::UnitZ()), Vec3(1.0, 0.0, 0.0));
    const auto mesh = [](const auto&) { return block_mesh(3, 3, 3, Vec3(1, 1, 1), solid::Kind::hex8); };
    scene.newton.precision = kSingle;
    const Model model = build(scene, mesh);
    Workspace workspace = make_workspace(model);
    State state = initial_state(model);
    const State before = state;
    const StepReport report = advance(model, workspace, state);
    if (accepted(report.status)) {
      EXPECT_EQ(refused, 0);
      const State wanted = moved(scene, mesh, 1, linalg::Precision::float64).state;
      EXPECT_LT((state.solids[0].x - wanted.solids[0].x).norm(),
                1e-7 * (wanted.solids[0].x - before.solids[0].x).norm());
      continue;
    }
    ++refused;
    EXPECT_EQ(report.status, Status::singular);
    EXPECT_NE(report.detail.find("in `newton: {precision: single}`"), std::string::npos) << report.detail;
    EXPECT_EQ(pack(state), pack(before));
  }
  EXPECT_GT(refused, 0);
  EXPECT_LT(refused, 5);
}

TEST(Precision, ThreadsGiveTheSameBits) {
  const Moved one = moved(block(), block_of(4000), 3, kSingle), two = moved(block(), block_of(4000), 3, kSingle, 2);
  EXPECT_EQ(one.state.solids[0].x, two.state.solids[0].x);
  EXPECT_EQ(one.state.lambda, two.state.lambda);
}

}  // namespace
}  // namespace sinew::test
