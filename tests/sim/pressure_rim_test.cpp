// A pressure has a potential where its surface is closed or its rim is held: what `build` says against the tangent.
#include <random>

#include "sinew/sim/first_guess.hpp"
#include "sinew/sim/step_ends.hpp"
#include "sinew/solid/pressure.hpp"
#include "validation/solids.hpp"

namespace sinew::test {
namespace {

using solid::Kind;

/// Part of the tangent of the first load that is not symmetric, over the unknowns, in a disturbed state at the end.
double asymmetry(const Model& model) {
  const State start = initial_state(model);
  const StepContext context = make_context(model, start, command_at(model, 1.0), 1.0);
  State state = start;
  std::mt19937 random(5);
  std::uniform_real_distribution<double> uniform(-0.1, 0.1);
  for (Eigen::Index i = 0; i < state.solids[0].x.size(); ++i) state.solids[0].x(i) += uniform(random);
  place_held(context, state);
  const solid::Body& body = model.solids[0].body;
  const SolidLoadModel& load = std::get<SolidLoadModel>(model.loads[0].on);
  Eigen::MatrixXd K = Eigen::MatrixXd::Zero(body.unknowns, body.unknowns);
  for (const solid::CellFace& face : load.faces) {
    const Eigen::MatrixXd own = solid::pressure_tangent(face, load.pressure, state.solids[0].x);
    for (int j = 0; j < 3 * face.count; ++j) {
      for (int i = 0; i < 3 * face.count; ++i) {
        const int row = body.unknown(i % 3, face.node[i / 3]), column = body.unknown(j % 3, face.node[j / 3]);
        if (row >= 0 && column >= 0) K(row, column) += own(i, j);
      }
    }
  }
  EXPECT_GT(K.norm(), 0.1);
  return (K - K.transpose()).norm() / K.norm();
}

class Rim : public testing::TestWithParam<Kind> {
 protected:
  /// A block held below in all directions, which the pressure on top does not see.
  Rim() { hold(scene, plane(Vec3::Zero(), Vec3::UnitZ())); }

  NodeNumbers where(const std::function<bool(const Vec3&)>& test) const { return nodes_where(mesh, test); }
  void expect(bool conservative, const Region& loaded = plane(Vec3(0, 0, 1), Vec3::UnitZ())) {
    load_solid(scene, loaded, Vec3::Zero(), 1.0);
    const Model model = build(scene, [this](const auto&) { return mesh; });
    EXPECT_EQ(std::get<SolidLoadModel>(model.loads[0].on).conservative(), conservative);
    const double off = asymmetry(model);
    if (conservative) EXPECT_LT(off, 1e-14);
    if (!conservative) EXPECT_GT(off, 1e-4);
  }
  static bool on_rim(const Vec3& x) { return x.z() == 1 && (x.x() == 0 || x.x() == 1 || x.y() == 0 || x.y() == 1); }

  solid::Mesh mesh = block_mesh(3, 3, 1, Vec3(1, 1, 1), GetParam());
  Scene scene = solid_scene(solid::corotational(1e6, 0.3), 1);
};
INSTANTIATE_TEST_SUITE_P(Kinds, Rim, testing::Values(Kind::tet4, Kind::tet10, Kind::hex8));

TEST_P(Rim, closed_surface_has_none) { expect(true, WholeSurface{}); }
TEST_P(Rim, free) { expect(false); }
TEST_P(Rim, held) {
  hold(scene, where(on_rim));
  expect(true);
}
TEST_P(Rim, held_but_for_one_edge) {
  hold(scene, where([](const Vec3& x) { return on_rim(x) && x.x() < 1; }));
  expect(false);
}
TEST_P(Rim, held_along_the_same_two_axes) {
  hold(scene, where(on_rim), {true, true, false});
  expect(true);
}
TEST_P(Rim, held_along_two_axes_but_not_the_same) {
  const auto odd = [](const Vec3& x) { return (std::lround(3 * x.x()) + std::lround(3 * x.y())) % 2 != 0; };
  hold(scene, where([&](const Vec3& x) { return on_rim(x) && odd(x); }), {true, true, false});
  hold(scene, where([&](const Vec3& x) { return on_rim(x) && !odd(x); }), {false, true, true});
  expect(false);
}
TEST_P(Rim, held_along_an_axis_in_planes_across_it) {
  for (const int axis : {0, 1}) {
    std::array<bool, 3> axes = {};
    axes[axis] = true;
    hold(scene, where([=](const Vec3& x) { return on_rim(x) && (x[axis] == 0 || x[axis] == 1); }), axes);
  }
  expect(true);
}
TEST_P(Rim, held_along_an_axis_out_of_plane) {
  for (const int axis : {0, 1}) {
    std::array<bool, 3> axes = {};
    axes[axis] = true;
    hold(scene, where([=](const Vec3& x) { return on_rim(x) && (x[1 - axis] == 0 || x[1 - axis] == 1); }), axes);
  }
  expect(false);
}
TEST_P(Rim, held_in_planes_that_turn) {
  for (const bool turns : {false, true}) {
    scene = solid_scene(solid::corotational(1e6, 0.3), 1);
    hold(scene, plane(Vec3::Zero(), Vec3::UnitZ())).frame = "lid";
    FrameMotion motion;
    motion.times = {0.0, 1.0};
    motion.translate = {Vec3::Zero(), Vec3(0.1, 0.2, 0.3)};
    if (turns) motion.rotate = {Vec3::Zero(), Vec3(0.3, 0.2, 0)};
    scene.frames.emplace_back("lid", Frame{{}, motion});
    hold(scene, where(on_rim), {false, false, true}).frame = "lid";
    expect(!turns);
  }
}

}  // namespace
}  // namespace sinew::test
