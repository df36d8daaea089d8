// Newton's end with contacts at rest: each iteration squares what the one before has left.
#include <fmt/core.h>
#include <gtest/gtest.h>

#include <cmath>

#include "sinew/io/scene_file.hpp"
#include "sinew/sim/newton.hpp"
#include "sinew/sim/run.hpp"
#include "support/meshes.hpp"
#include "support/scenes.hpp"

namespace sinew::test {
namespace {

/// The 36 runs of bench/press_on_beam.py at rest: a ball of 12 mm goes 40 mm down on a cantilever of 100 x 30 x 30 mm.
struct Press {
  int nx, ny, nz;
  double place, friction, step;
};
Model pressed_beam(const Press& own) {
  Scene scene =
      io::read_scene(std::filesystem::path(SINEW_SOURCE_DIR) / "tests/validation/faults/press_on_beam.yaml",
                     {"contact.friction=" + std::to_string(own.friction), "time.step=" + std::to_string(own.step),
                      "obstacles.ball.pose.translate=[" + std::to_string(own.place) + ", 3 mm, 30 mm]"})
          .scene;
  return build(scene, [&own](const std::filesystem::path&) {
    solid::Mesh mesh = block_mesh(own.nx, own.ny, own.nz, Vec3(0.1, 0.03, 0.03));
    mesh.nodes.colwise() -= Vec3(0.0, 0.015, 0.015);
    return mesh;
  });
}

// Of order 1.5 at least, whatever constant goes with it; but contacts are corrected to a quarter of the tolerance, no
// further, and what their correction does not see may leave as much again.
TEST(Contraction, of_a_ball_on_a_beam_at_rest_is_quadratic_slow) {
  const auto at_most = [](double before) { return 10.0 * std::pow(before, 1.5); };
  const double corrected = 5e-10;
  fmt::print("| cells | place, mm | friction | step, ms | last residuals |\n|---|---|---|---|---|\n");
  for (const auto& [nx, ny, nz] : {std::array{6, 2, 2}, {10, 3, 3}, {16, 5, 5}}) {
    for (const double place : {0.1, 0.08, 0.05}) {
      for (const double friction : {0.0, 0.5}) {
        for (const double step : {0.01, 0.05}) {
          const Model model = pressed_beam({nx, ny, nz, place, friction, step});
          Workspace workspace = make_workspace(model);
          State state = initial_state(model);
          StepReport report;
          while (state.time < 1.0 - 1e-9) {
            report = advance(model, workspace, state);
            ASSERT_TRUE(accepted(report.status)) << state.time << ": " << report.detail;
          }
          const auto [first, second, last] = workspace.memory().residuals;
          fmt::print("| {} x {} x {} | {} | {} | {} | {:.0e}, {:.0e}, {:.0e} |\n", nx, ny, nz, 1e3 * place, friction,
                     1e3 * step, first, second, last);
          EXPECT_LE(second, at_most(first));
          EXPECT_LE(last, std::max(at_most(second), corrected));
        }
      }
    }
  }
}

}  // namespace
}  // namespace sinew::test
