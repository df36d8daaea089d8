// Paths of equilibria past limit points: the deep arch. And the same states by `static` as by load steps.
#include "validation/rods.hpp"

namespace sinew::test {
namespace {

/// DaDeppo and Schmidt, J. Appl. Mech. 42, 1975: a circular arch of radius R = 100 and opening 215 degrees that cannot
/// stretch, clamped at one foot and hinged at the other, E I = 1e6, under a dead weight at its apex: it sways and snaps
/// at P = 8.97 E I / R^2 = 897.
Scene deep_arch(int sections, int order, const std::vector<Strain>& strains) {
  const double half = 215.0 / 2 * pi / 180, length = 100 * 2 * half;
  Scene scene = straight_rod(length, sections, given({1e6, 1e6, 1e6, 1e9, 1e9, 1e9}), strains, order);
  scene.analysis = Analysis::statics;
  Rod& rod = scene.rods[0].second;
  rod.path.clear();
  for (int i = 0; i <= 400; ++i) {
    const double angle = half * (1.0 - 2.0 * i / 400);  // from the vertical, left foot first
    rod.path.emplace_back(-100 * std::sin(angle), 100 * std::cos(angle), 0.0);
  }
  rod.up = Vec3::UnitZ();  // bends about its y axis, the world's z
  add_tie(scene, {true, true, false});
  add_load(scene, Vec3(0, -1000, 0), Vec3::Zero(), length / 2);
  return scene;
}

/// The largest load before it falls.
double limit(const Scene& scene) {
  const Model model = build(scene, read_block);
  double largest = 0.0;
  StepReport failure;
  const RunEnd end = run(
      model, initial_state(model),
      [&](const State& state, const StepReport&) {
        const double load = 1000 * state.loads[0];
        if (load < largest) return false;
        largest = load;
        return true;
      },
      &failure);
  EXPECT_EQ(end, RunEnd::interrupted) << to_string(failure.status) << " at " << largest;
  return largest;
}

class DeepArch : public testing::TestWithParam<std::tuple<int, int, bool>> {};

TEST_P(DeepArch, snaps_under_the_load_of_dadeppo_and_schmidt) {
  const auto [sections, order, extensible] = GetParam();
  const std::vector<Strain> planar = {Strain::bending_y};
  const std::vector<Strain> stretching = {Strain::bending_y, Strain::elongation, Strain::shear_z};
  const double load = limit(deep_arch(sections, order, extensible ? stretching : planar));
  EXPECT_NEAR(load, 897.0, 0.01 * 897.0);
}

INSTANTIATE_TEST_SUITE_P(Cuts, DeepArch,
                         testing::Values(std::tuple(40, 0, false), std::tuple(10, 2, false), std::tuple(40, 0, true)));

TEST(StaticPath, gives_the_elastica_that_load_steps_give) {
  for (const auto& [sections, strains] : {std::pair(20, kBending), std::pair(300, kAll)}) {
    Scene scene = straight_rod(1.0, sections, given({1, 1, 1, 1e5, 1e5, 1e5}), strains, 0, 4);
    add_load(scene, Vec3(0, 5, 1));
    const Solved steps = solve(scene);
    scene.analysis = Analysis::statics;
    const Solved path = solve(scene);
    EXPECT_LT((steps.tip() - path.tip()).norm(), 1e-6);
  }
}

TEST(StaticPath, coils_a_rod_ten_times) {
  Scene scene = straight_rod(1.0, 3, given({0.7, 3.0, 3.0, 1.0, 1.0, 1.0}));
  scene.analysis = Analysis::statics;
  add_load(scene, Vec3::Zero(), Vec3(0, 0, 20.0 * pi * 3.0));
  EXPECT_LT(solve(scene).tip().norm(), 1e-9);
}

TEST(StaticPath, bends_a_hair_of_length_over_radius_1e5) {
  Scene scene = straight_rod(1.0, 60, Circle{1e-5}, kAll);
  scene.analysis = Analysis::statics;
  scene.rods[0].second.material = {1e9, 0.4, 0.0};
  add_load(scene, Vec3(0, 5.0 * 1e9 * pi / 4 * 1e-20, 0));
  EXPECT_NEAR(solve(scene).tip().y(), 0.71379, 1e-3);  // Mattiasson
}

/// A rod clamped at both ends and pushed together by 2 % carries about 4 pi^2 E I / L^2 = 39.5 and bows by 0.09 L, once
/// a small force at its middle has told it where to. The straight one, which carries 0.02 E A, is an equilibrium, too.
Scene pushed_together(double EA, int steps) {
  Scene scene = straight_rod(1.0, 16, given({1, 1, 1, EA, EA, EA}), kAll, 0, steps);
  Frame frame;
  frame.motion = FrameMotion{{0.0, 1.0}, {}, {Vec3::Zero(), Vec3(-0.02, 0, 0)}};
  scene.frames.emplace_back("hand", frame);
  add_tie(scene, {true, true, true}, {true, true, true}).frame = "hand";
  add_load(scene, Vec3(0, 1, 0), Vec3::Zero(), 0.5).factor = Table{{0.0}, {1.0}};
  return scene;
}

bool buckled(const Solved& solved) {
  return std::abs(solved.end().lambda[0] - 38.0) < 3.0 && std::abs(solved.at(0.5).y() - 0.085) < 0.01;
}

TEST(Column, pushed_together_in_load_steps_buckles_or_is_reported_unstable) {
  int unbuckled = 0;
  for (const double EA : {1e4, 1e5, 1e6}) {
    for (const int steps : {1, 10, 100}) {
      const Solved solved = solve(pushed_together(EA, steps));
      EXPECT_TRUE(buckled(solved) || solved.trace.reports.back().unstable)
          << EA << " in " << steps << ": carries " << solved.end().lambda[0];
      unbuckled += !buckled(solved);
    }
  }
  EXPECT_LT(unbuckled, 9);
}

TEST(Column, pushed_together_along_the_static_path_buckles) {
  for (const double EA : {1e4, 1e5, 1e6}) {
    Scene scene = pushed_together(EA, 1);
    scene.analysis = Analysis::statics;
    const Solved solved = solve(scene);
    EXPECT_TRUE(buckled(solved)) << EA << ": carries " << solved.end().lambda[0] << ", unstable "
                                 << solved.trace.reports.back().unstable;
  }
}

}  // namespace
}  // namespace sinew::test
