#include "sinew/io/scene_file.hpp"

#include <gtest/gtest.h>

#include <fstream>
#include <numbers>
#include <set>

#include "full_scene.hpp"
#include "parse.hpp"
#include "sinew/error/input_error.hpp"

namespace sinew::io {
namespace {

InputFault scene_fault(const std::string& text, const std::vector<std::string>& overrides = {}) {
  try {
    parse(text, overrides);
    ADD_FAILURE() << "accepted";
  } catch (const InputError& error) {
    return error.fault();
  }
  return {};
}

TEST(SceneFile, ReadsTheWholeScene) {
  const Scene scene = parse(full_scene).scene;
  EXPECT_EQ(scene.title, "A finger pulled by one cable");
  EXPECT_EQ(scene.folder, "scenes");
  EXPECT_EQ(scene.time.step, 0.01);
  EXPECT_EQ(scene.time.duration, 2.0);
  EXPECT_EQ(scene.gravity, Vec3(0, -9.81, 0));
  EXPECT_EQ(scene.newton.iterations, 0);
  EXPECT_EQ(scene.newton.limit, 20);
  EXPECT_EQ(scene.newton.tolerance, 1e-10);
  EXPECT_EQ(scene.newton.precision, linalg::Precision::float32);
  EXPECT_EQ(scene.view.interval, 0.02);

  ASSERT_EQ(scene.frames.size(), 1u);
  EXPECT_EQ(scene.frames[0].first, "hand");
  const Frame& hand = scene.frames[0].second;
  EXPECT_EQ(hand.pose.rotate, Vec3(0, 0, std::numbers::pi / 2));
  EXPECT_EQ(hand.pose.translate, Vec3(0, 0.01, 0));
  ASSERT_TRUE(hand.motion);
  EXPECT_EQ(hand.motion->times, (std::vector<double>{0, 1}));
  EXPECT_EQ(hand.motion->rotate, (std::vector<Vec3>{Vec3::Zero(), Vec3(0, 0, 0.5)}));
  EXPECT_EQ(hand.motion->translate, (std::vector<Vec3>{Vec3::Zero(), Vec3(0, 0.02, 0)}));
}

TEST(SceneFile, ReadsSolids) {
  const Scene scene = parse(full_scene).scene;
  ASSERT_EQ(scene.solids.size(), 2u);
  EXPECT_EQ(scene.solids[0].first, "finger");
  const Solid& finger = scene.solids[0].second;
  EXPECT_EQ(finger.mesh, "finger.vtk");
  EXPECT_EQ(finger.scale, 0.001);
  EXPECT_EQ(finger.pose.rotate, Vec3::Zero().eval());
  EXPECT_EQ(finger.pose.translate, Vec3(0, 0.002, 0));
  EXPECT_EQ(finger.frame, "hand");
  const auto& law = std::get<solid::Corotational>(finger.material.law);
  EXPECT_EQ(law.young, 600e3);
  EXPECT_EQ(law.poisson, 0.45);
  EXPECT_EQ(finger.mass, 0.075);
  EXPECT_FALSE(finger.density);
  EXPECT_EQ(finger.rayleigh.mass, 0.1);
  EXPECT_EQ(finger.rayleigh.stiffness, 0.1);
  ASSERT_EQ(finger.fixed.size(), 1u);
  EXPECT_EQ(std::get<Box>(finger.fixed[0].region).lower, Vec3(-0.015, 0, 0));
  EXPECT_EQ(std::get<Box>(finger.fixed[0].region).upper, Vec3(0.005, 0.01, 0.015));
  EXPECT_EQ(std::get<Box>(finger.fixed[0].region).in, In::object);

  const Solid& block = scene.solids[1].second;
  EXPECT_EQ(block.scale, 1.0);
  EXPECT_FALSE(block.frame);
  EXPECT_FALSE(block.mass);
  EXPECT_EQ(block.density, 1100.0);
  ASSERT_EQ(block.fixed.size(), 2u);
  EXPECT_EQ(std::get<Box>(block.fixed[0].region).in, In::world);
  EXPECT_EQ(std::get<Box>(block.fixed[1].region).upper,
            Vec3(0, 0.001, 0.001));  // a flat box is a region: a face of the mesh
}

TEST(SceneFile, ReadsRodsAndCouplings) {
  const Scene scene = parse(full_scene).scene;
  ASSERT_EQ(scene.rods.size(), 2u);
  EXPECT_EQ(scene.rods[0].first, "cable");
  const Rod& cable = scene.rods[0].second;
  EXPECT_EQ(cable.path, (std::vector<Vec3>{{0, 0.005, 0.007}, {0.05, 0.005, 0.007}, {0.1, 0.005, 0.007}}));
  EXPECT_EQ(cable.path_in, In::world);
  EXPECT_EQ(cable.up, Vec3(0, 0, 1));
  EXPECT_EQ(cable.frame, "hand");
  EXPECT_EQ(cable.cable, Cable::cosserat);
  EXPECT_EQ(std::get<int>(cable.sections), 15);
  EXPECT_EQ(cable.strains, (std::vector{Strain::torsion, Strain::bending_y, Strain::bending_z}));
  EXPECT_EQ(std::get<Circle>(cable.section).radius.start, 0.0005);
  EXPECT_EQ(std::get<Circle>(cable.section).radius.end, 0.0005);
  EXPECT_EQ(cable.material.young, 5e9);
  EXPECT_EQ(cable.material.poisson, 0.5);
  EXPECT_EQ(cable.material.density, 1100.0);
  const Rod& thread = scene.rods[1].second;
  EXPECT_EQ(thread.path_in, In::object);
  EXPECT_FALSE(thread.up);
  EXPECT_EQ(thread.cable, Cable::geometric);
  EXPECT_EQ(std::get<std::vector<double>>(thread.sections), (std::vector<double>{0, 0.04, 0.1}));

  ASSERT_EQ(scene.couplings.size(), 2u);
  const Slide& first = std::get<Slide>(scene.couplings[0]);
  EXPECT_EQ(first.rod, "cable");
  EXPECT_EQ(first.solid, "finger");
  EXPECT_EQ(std::get<int>(first.points), 15);
  EXPECT_EQ(first.anchor_tip, AnchorTip::position);
  EXPECT_EQ(first.reach, 0.002);
  const Slide& second = std::get<Slide>(scene.couplings[1]);
  EXPECT_EQ(std::get<std::vector<double>>(second.points), (std::vector<double>{0, 0.03}));
  EXPECT_EQ(second.anchor_tip, AnchorTip::none);
  EXPECT_FALSE(second.reach);
  EXPECT_EQ(first.friction, 0.0);
  EXPECT_EQ(second.friction, 0.1);
}

TEST(SceneFile, ReadsBodiesAndContact) {
  const Scene scene = parse(bodies_scene).scene;
  ASSERT_EQ(scene.bodies.size(), 6u);
  const auto& [name, cube] = scene.bodies[0];
  EXPECT_EQ(name, "cube");
  EXPECT_EQ(std::get<BoxShape>(cube.shape).size, Vec3(0.02, 0.03, 0.04));
  EXPECT_EQ(cube.pose.translate, Vec3(0, 0, 0.01));
  EXPECT_EQ(cube.mass, 0.03);
  EXPECT_FALSE(cube.density);
  EXPECT_EQ(cube.velocity, Vec3(0, 0, 0));
  const RigidBody& ball = scene.bodies[1].second;
  EXPECT_EQ(std::get<SphereShape>(ball.shape).radius, 0.01);
  EXPECT_EQ(ball.density, 1200.0);
  EXPECT_EQ(ball.velocity, Vec3(0, 0, -1));
  EXPECT_NEAR(ball.spin.y(), std::numbers::pi, 1e-15);
  EXPECT_EQ(std::get<CylinderShape>(scene.bodies[2].second.shape).length, 0.05);
  EXPECT_EQ(std::get<CapsuleShape>(scene.bodies[3].second.shape).radius, 0.005);
  const MeshShape& part = std::get<MeshShape>(scene.bodies[4].second.shape);
  EXPECT_EQ(part.file, "part.stl");
  EXPECT_EQ(part.scale, 0.001);
  EXPECT_TRUE(part.hull);
  EXPECT_EQ(part.thickness, 0.0);
  EXPECT_EQ(std::get<MeshShape>(scene.bodies[5].second.shape).thickness, 0.001);

  ASSERT_EQ(scene.obstacles.size(), 7u);
  const PlaneShape& floor = std::get<PlaneShape>(scene.obstacles[0].second.shape);
  EXPECT_EQ(floor.point, Vec3(0, 0, -0.001));
  EXPECT_EQ(floor.normal, Vec3(0, 0, 2));
  EXPECT_FALSE(scene.obstacles[0].second.frame);
  const Obstacle& step = scene.obstacles[1].second;
  EXPECT_EQ(std::get<BoxShape>(step.shape).size, Vec3(1, 1, 1));
  EXPECT_EQ(step.frame, "hand");
  EXPECT_EQ(step.pose.translate, Vec3(1, 0, 0));

  const MeshShape& terrain = std::get<MeshShape>(scene.obstacles[5].second.shape);
  EXPECT_EQ(terrain.scale, 2.0);
  EXPECT_TRUE(terrain.hull);

  EXPECT_EQ(scene.contact.friction, 0.4);
  EXPECT_EQ(scene.contact.restitution, 0.1);
  ASSERT_EQ(scene.contact.pairs.size(), 2u);
  EXPECT_EQ(scene.contact.pairs[0].first, "cube");
  EXPECT_EQ(scene.contact.pairs[0].second, "floor");
  EXPECT_EQ(scene.contact.pairs[0].friction, 0.08);
  EXPECT_EQ(scene.contact.pairs[0].restitution, 0.3);
  EXPECT_FALSE(scene.contact.pairs[0].off);
  EXPECT_TRUE(scene.contact.pairs[1].off);
  EXPECT_FALSE(scene.contact.pairs[1].friction);
  ASSERT_EQ(scene.outputs.size(), 3u);
  EXPECT_EQ(scene.outputs[1].second.body, "cube");
  EXPECT_EQ(scene.outputs[1].second.quantity, Quantity::force);
  EXPECT_EQ(scene.outputs[2].second.between, (std::vector<std::string>{"cube", "floor"}));
}

TEST(SceneFile, ReadsActuatorsAndOutputs) {
  const Scene scene = parse(full_scene).scene;
  ASSERT_EQ(scene.actuators.size(), 4u);
  const auto expect = [&](std::size_t i, const std::string& name, Motion motion, Driven driven) -> const Drive& {
    EXPECT_EQ(scene.actuators[i].first, name);
    EXPECT_EQ(scene.actuators[i].second.motion, motion) << name;
    EXPECT_EQ(scene.actuators[i].second.driven, driven) << name;
    return scene.actuators[i].second.drive;
  };
  const auto pull = std::get<Table>(expect(0, "pull", Motion::translation, Driven::displacement));
  EXPECT_EQ(pull.times, (std::vector<double>{0, 1}));
  EXPECT_EQ(pull.values, (std::vector<double>{0, 0.02}));
  const auto twist = std::get<Table>(expect(1, "twist", Motion::rotation, Driven::angle));
  EXPECT_EQ(twist.times.size(), 1u);
  EXPECT_EQ(twist.values, std::vector<double>{std::numbers::pi / 2});
  EXPECT_TRUE(std::holds_alternative<External>(expect(2, "motor", Motion::translation, Driven::force)));
  EXPECT_EQ(std::get<Table>(expect(3, "screw", Motion::rotation, Driven::torque)).values, std::vector<double>{2.0});

  ASSERT_EQ(scene.outputs.size(), 2u);
  const Output& tip = scene.outputs[0].second;
  EXPECT_EQ(tip.solid, "finger");
  EXPECT_FALSE(tip.rod);
  EXPECT_EQ(tip.point.x, Vec3(0.1, 0.005, 0.007));
  EXPECT_EQ(tip.point.in, In::world);
  EXPECT_EQ(tip.reach, 0.001);
  const Output& end = scene.outputs[1].second;
  EXPECT_FALSE(end.solid);
  EXPECT_EQ(end.rod, "cable");
  EXPECT_EQ(end.at, 0.1);
}

TEST(SceneFile, WhatIsNotGivenKeepsTheDefaultsOfTheScene) {
  const Scene scene = parse("rods: {r: {path: [[0, 0, 0], [1, 0, 0]], cable: geometric}}").scene, fresh;
  EXPECT_EQ(scene.time.step, fresh.time.step);
  EXPECT_EQ(scene.newton.limit, fresh.newton.limit);
  EXPECT_EQ(scene.rods[0].second.strains, Rod{}.strains);
  EXPECT_EQ(std::get<int>(scene.rods[0].second.sections), 1);
  EXPECT_EQ(parse(other_scene).scene.newton.iterations, 1);
  EXPECT_EQ(parse(other_scene, {"newton=converged"}).scene.newton.iterations, 0);
}

TEST(SceneFile, KnowsTheLines) {
  const SceneFile file = parse(full_scene);
  EXPECT_EQ(file.path, "finger.yaml");
  EXPECT_EQ(line_of(file, "title"), 2);
  EXPECT_EQ(line_of(file, "solids.finger"), 12);
  EXPECT_EQ(line_of(file, "solids.finger.material.poisson"), 17);
  EXPECT_EQ(line_of(file, "solids.block.fixed.1.box.0.2"), 28);
  EXPECT_EQ(line_of(file, "couplings.1.slide.points"), 47);
  EXPECT_EQ(line_of(file, "couplings.1.slide.reach"), 47);  // not given: the slide's own
  EXPECT_EQ(line_of(file, "solids.finger.elements.12"), 12);
  EXPECT_EQ(line_of(file, "nothing.of.this"), 0);
  EXPECT_EQ(line_of(file, ""), 0);
  EXPECT_EQ(line_of(parse(full_scene, {"solids.finger.scale=1"}), "solids.finger.scale"), 0);
}

TEST(SceneFile, OverridesReplaceValues) {
  const Scene scene = parse(full_scene, {"solids.finger.material.young=500 kPa", "couplings.0.slide.points=31",
                                         "newton=3", "rods.thread.up=[0, 1, 0]", "solids.block.fixed.1.in=world",
                                         "actuators.extra={rod: cable, force: 1 N}", "time.step=5 ms"})
                          .scene;
  EXPECT_EQ(std::get<solid::Corotational>(scene.solids[0].second.material.law).young, 500e3);
  EXPECT_EQ(std::get<int>(std::get<Slide>(scene.couplings[0]).points), 31);
  EXPECT_EQ(scene.newton.iterations, 3);
  EXPECT_EQ(scene.newton.limit, Newton{}.limit);
  EXPECT_EQ(scene.rods[1].second.up, Vec3(0, 1, 0));
  EXPECT_EQ(std::get<Box>(scene.solids[1].second.fixed[1].region).in, In::world);
  EXPECT_EQ(scene.actuators.back().first, "extra");
  EXPECT_EQ(scene.time.step, 0.005);
  EXPECT_EQ(parse(other_scene, {"time.step=5 ms"}).scene.time.step, 0.005);  // the file has no `time`
}

TEST(SceneFile, FaultsInOverridesSaySo) {
  InputFault fault = scene_fault(full_scene, {"solids.finger.material.yung=500 kPa"});
  EXPECT_EQ(fault.file, "--set");
  EXPECT_EQ(fault.line, 0);
  EXPECT_EQ(fault.path, "solids.finger.material.yung");
  EXPECT_EQ(fault.remedy,
            "did you mean `young`? known here: law, young, poisson, c10, c01, mu, alpha, bulk, viscosity, density");
  fault = scene_fault(full_scene, {"solids.finger.material.young=-5"});
  EXPECT_EQ(to_string(fault).substr(0, to_string(fault).find('\n')),
            "--set: solids.finger.material.young = -5: must be greater than 0 Pa");
  fault = scene_fault(full_scene, {"solids.fingr.mesh=a.vtk"});
  EXPECT_EQ(fault.remedy, "did you mean `finger`? solids holds finger, block");
  fault = scene_fault(full_scene, {"gravitation=0"});
  EXPECT_EQ(fault.file, "--set");
  fault = scene_fault(full_scene, {"rods.cable.path.1=[0, 5 mm, 7 mm]"});
  EXPECT_EQ(fault.path, "rods.cable.path.1");
  EXPECT_EQ(fault.rule, "is the same point as the one before it");
}

TEST(SceneFile, TextReproducesTheScene) {
  EXPECT_EQ(parse(full_scene).text, full_scene);
  const std::vector<std::string> overrides = {"solids.finger.mass=80 g", "title=\"a: 'b' # c\"",
                                              "outputs.mid={rod: cable, at: 50 mm}", "couplings.1.slide.points=3"};
  const SceneFile first = parse(full_scene, overrides);
  EXPECT_NE(first.text, full_scene);
  const SceneFile second = parse(first.text);
  EXPECT_EQ(second.text, first.text);
  EXPECT_EQ(parse(second.text, {"title=x"}).text,
            parse(full_scene, {"solids.finger.mass=80 g", "title=x", overrides[2], overrides[3]}).text);
  EXPECT_EQ(second.scene.title, "a: 'b' # c");
  EXPECT_EQ(second.scene.solids[0].second.mass, 0.08);
  EXPECT_EQ(second.scene.outputs.back().second.at, 0.05);
  EXPECT_EQ(second.scene.rods[0].second.path, first.scene.rods[0].second.path);
  EXPECT_EQ(second.scene.frames[0].second.motion->rotate, first.scene.frames[0].second.motion->rotate);
  std::set<std::string> before, after;
  for (const auto& [path, line] : first.lines) before.insert(path);
  for (const auto& [path, line] : second.lines) after.insert(path);
  EXPECT_EQ(before, after);
}

TEST(SceneFile, ReadsFiles) {
  const std::filesystem::path folder = std::filesystem::path(testing::TempDir()) / "sinew_scene_file_test";
  std::filesystem::create_directories(folder);
  std::ofstream(folder / "finger.yaml") << full_scene;
  const SceneFile file = read_scene(folder / "finger.yaml", {"title=x"});
  EXPECT_EQ(file.scene.folder, folder);
  EXPECT_EQ(file.path, folder / "finger.yaml");
  EXPECT_EQ(file.scene.title, "x");
  std::filesystem::remove_all(folder);
}

}  // namespace
}  // namespace sinew::io
