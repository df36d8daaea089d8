// The example's grasper: three fingers close around a cube, lift it by 50 mm and hold it for five seconds.
#include <gtest/gtest.h>

#include <cmath>

#include "support/grasps.hpp"

namespace sinew {
namespace {

using test::mm;

using test::Grasp;

Grasp grasp(const std::vector<std::string>& changes) { return test::grasp("examples/grasper.yaml", changes); }

TEST(Grasper, LiftsTheCubeAndHoldsIt) {
  const Grasp found = grasp({});
  EXPECT_NEAR(found.at(3.0).z() - found.at(2.0).z(), 50 * mm, 1 * mm);
  EXPECT_LT(found.slip(3.0), 1 * mm);
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

/// Two soft pads with parallel faces close on a cube by 1 mm each and lift it by 50 mm. Nothing but friction carries
/// it.
Grasp between_pads(double friction) {
  Scene scene;
  scene.time = {0.01, 3.0};
  scene.newton.iterations = 1;
  scene.gravity = Vec3(0, 0, -9.81);
  scene.contact.friction = friction;
  for (const double side : {-1.0, 1.0}) {
    const std::string name = side < 0.0 ? "left" : "right";
    Frame frame;
    frame.motion = FrameMotion{
        {0.0, 0.5, 1.0, 2.0},
        {},
        {Vec3::Zero(), Vec3(-2 * side * mm, 0, 0), Vec3(-2 * side * mm, 0, 0), Vec3(-2 * side * mm, 0, 50 * mm)}};
    scene.frames.emplace_back(name, frame);
    Solid pad;
    pad.mesh = "pad";
    pad.material.law = solid::corotational(3e5, 0.3);
    pad.density = 1000.0;
    pad.rayleigh = {1.0, 0.01};
    pad.frame = name;
    pad.pose.translate = Vec3(side < 0.0 ? -21 * mm : 11 * mm, -6 * mm, 4 * mm);
    pad.fixed.push_back({Plane{Vec3(side < 0.0 ? 0.0 : 10 * mm, 0, 0), Vec3::UnitX()}});
    scene.solids.emplace_back(name, pad);
  }
  RigidBody cube;
  cube.shape = BoxShape{Vec3::Constant(20 * mm)};
  cube.mass = 0.03;
  cube.pose.translate = Vec3(0, 0, 10 * mm);
  scene.bodies.emplace_back("cube", cube);
  Obstacle floor;
  floor.shape = PlaneShape{Vec3::Zero(), Vec3::UnitZ()};
  scene.obstacles.emplace_back("floor", floor);
  ContactPair off;
  off.first = "floor";
  off.off = true;
  for (const char* pad : {"left", "right"}) {
    off.second = pad;
    scene.contact.pairs.push_back(off);
  }
  return test::grasp(
      build(scene, [](const auto&) { return test::block_mesh(2, 3, 3, Vec3(10 * mm, 12 * mm, 12 * mm)); }));
}

TEST(Grasper, ParallelPadsHoldWithFrictionAndDropWithout) {
  const Grasp held = between_pads(0.5);
  EXPECT_NEAR(held.cube.back().z(), 60 * mm, 1 * mm);
  EXPECT_LT(held.slip(2.0), 0.1 * mm);
  EXPECT_GT(held.deepest, -0.1 * mm);
  EXPECT_NEAR(between_pads(0.02).cube.back().z(), 10 * mm, 0.1 * mm);
}

}  // namespace
}  // namespace sinew
