// The example's grasper: three fingers close around a cube, lift it by 50 mm and hold it for five seconds.
#include <gtest/gtest.h>

#include <cmath>

#include "sinew/io/mesh_file.hpp"
#include "sinew/io/scene_file.hpp"
#include "support/scenes.hpp"

namespace sinew {
namespace {

using test::mm;

struct Grasp {
  std::vector<double> times;
  std::vector<Vec3> cube;
  double deepest = 0.0;  ///< [m] least gap of all contacts
  double pull = 0.0;     ///< [N] of the left cable at the end
  const Vec3& at(double time) const {
    std::size_t i = 0;
    while (i + 1 < times.size() && times[i] < time - 1e-6) ++i;
    return cube[i];
  }
};

Grasp grasp(const std::vector<std::string>& changes) {
  const std::filesystem::path file = std::filesystem::path(SINEW_SOURCE_DIR) / "examples/grasper.yaml";
  const Model model = build(io::read_scene(file, changes).scene, io::read_mesh);
  Grasp found;
  StepReport failure;
  const RunEnd end = run(
      model, initial_state(model),
      [&](const State& state, const StepReport&) {
        found.times.push_back(state.time);
        found.cube.push_back(state.bodies[0].p);
        for (const ContactState& own : state.contacts) found.deepest = std::min(found.deepest, own.gap);
        found.pull = state.actuators[0];
        return true;
      },
      &failure);
  EXPECT_EQ(end, RunEnd::done) << to_string(failure.status) << " " << failure.detail;
  return found;
}

TEST(Grasper, LiftsTheCubeAndHoldsIt) {
  const Grasp found = grasp({});
  EXPECT_NEAR(found.at(3.0).z() - found.at(2.0).z(), 50 * mm, 1 * mm);
  for (std::size_t i = 0; i < found.times.size(); ++i) {
    if (found.times[i] >= 3.0) {
      EXPECT_LT((found.cube[i] - found.at(3.0)).norm(), 1 * mm) << found.times[i];
    }
  }
  EXPECT_GT(found.deepest, -0.1 * mm);
}

TEST(Grasper, SingleStepsFollowConvergedOnes_slow) {
  const Grasp single = grasp({"time.duration=3 s"}), converged = grasp({"time.duration=3 s", "newton={limit: 25}"});
  EXPECT_LT((single.cube.back() - converged.cube.back()).norm(), 0.5 * mm);
  EXPECT_GT(converged.deepest, -0.1 * mm);
}

TEST(Grasper, DropsTheCubeWithLittleFriction) {
  const Grasp found = grasp({"contact.friction=0.02", "time.duration=4 s"});
  EXPECT_NEAR(found.cube.back().z(), 10 * mm, 0.1 * mm);
}

TEST(Grasper, StiffCablesChangeTheGrasp) {
  const std::string stiff = "rods.left_cable.material.young=200 GPa";
  const Grasp soft = grasp({"time.duration=2 s"}),
              other = grasp({"time.duration=2 s", stiff, "rods.right_front_cable.material.young=200 GPa",
                             "rods.right_back_cable.material.young=200 GPa"});
  EXPECT_GT((soft.cube.back() - other.cube.back()).norm(), 2 * mm);
  EXPECT_GT(other.pull, 1.3 * soft.pull);
}

}  // namespace
}  // namespace sinew
