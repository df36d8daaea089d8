// What the keys of rods, and of what acts on them, mean.
#include <gtest/gtest.h>

#include <numbers>

#include "full_scene.hpp"
#include "sinew/io/scene_file.hpp"

namespace sinew::io {
namespace {

constexpr double pi = std::numbers::pi;

Scene scene_of(const std::string& text, const std::vector<std::string>& overrides = {}) {
  return parse_scene(text, "rods.yaml", "scenes", overrides).scene;
}

void expect_taper(const Taper& taper, double start, double end) {
  EXPECT_EQ(taper.start, start);
  EXPECT_EQ(taper.end, end);
}

Eigen::Matrix<double, 6, 1> strains(double a, double b, double c, double d, double e, double f) {
  return (Eigen::Matrix<double, 6, 1>() << a, b, c, d, e, f).finished();
}

/// Entry of a list by name and place, so that the order of the file is checked too.
template <class T>
const T& at(const Named<T>& objects, std::size_t i, const std::string& name) {
  EXPECT_EQ(objects.at(i).first, name);
  return objects.at(i).second;
}

TEST(SceneRods, ReadsTheAnalysis) {
  const Scene scene = scene_of(rods_scene);
  EXPECT_EQ(scene.analysis, Analysis::statics);
  EXPECT_EQ(scene.modes, 4);
  EXPECT_EQ(scene_of(full_scene).analysis, Analysis::dynamic);
  EXPECT_EQ(scene_of(full_scene).modes, Scene{}.modes);
  EXPECT_EQ(scene_of(full_scene, {"analysis=dynamic"}).analysis, Analysis::dynamic);
  EXPECT_EQ(scene_of(full_scene, {"analysis=quasi_static"}).analysis, Analysis::quasi_static);
  EXPECT_EQ(scene_of(full_scene).snap, Snap::follow);
  EXPECT_EQ(scene_of(full_scene, {"snap=stop"}).snap, Snap::stop);
  EXPECT_EQ(scene_of(full_scene, {"analysis=modal", "modes=12"}).analysis, Analysis::modal);
  EXPECT_EQ(scene_of(full_scene, {"modes=12"}).modes, 12);
}

TEST(SceneRods, ReadsOrders) {
  const Scene scene = scene_of(rods_scene);
  EXPECT_EQ(at(scene.rods, 0, "spine").order, (std::array{1, 2, 3, 4, 5, 0}));
  EXPECT_EQ(at(scene.rods, 1, "tube").order, (std::array{2, 2, 2, 0, 0, 0}));  // of the default strains
  EXPECT_EQ(at(scene.rods, 2, "blade").order, (std::array<int, 6>{}));
  EXPECT_EQ(scene_of(rods_scene, {"rods.tube.strains=[shear_z, bending_y]"}).rods[1].second.order,
            (std::array{0, 2, 0, 0, 0, 2}));
  EXPECT_EQ(scene_of(rods_scene, {"rods.spine.order={shear_y: 5}"}).rods[0].second.order,
            (std::array{0, 0, 0, 0, 5, 0}));
}

TEST(SceneRods, ReadsRestAndStart) {
  const Scene scene = scene_of(rods_scene);
  const Rod& spine = at(scene.rods, 0, "spine");
  const auto& rest = std::get<RestStrains>(spine.rest);
  EXPECT_EQ(rest.at, (std::vector<double>{0, 0.05}));
  ASSERT_EQ(rest.strains.size(), 2u);
  EXPECT_EQ(rest.strains[0], strains(0.5, 1, 0, 0, 0.01, 0.02));
  EXPECT_EQ(rest.strains[1], strains(0.5, 2, 200, 0.1, 0.01, -0.03));
  EXPECT_EQ(spine.start, Start::path);
  const Rod& tube = at(scene.rods, 1, "tube");
  EXPECT_EQ(std::get<Rest>(tube.rest), Rest::straight);
  EXPECT_EQ(tube.start, Start::rest);
  const Rod& blade = at(scene.rods, 2, "blade");
  const auto& constant = std::get<RestStrains>(blade.rest);
  EXPECT_EQ(constant.at, std::vector<double>{0});
  ASSERT_EQ(constant.strains.size(), 1u);
  EXPECT_EQ(constant.strains[0], strains(0, 0, 20, 0, 0, 0));
  EXPECT_FALSE(blade.start);
  EXPECT_EQ(std::get<Rest>(at(scene.rods, 3, "oval").rest), Rest::path);
  const auto held = std::get<RestStrains>(
      scene_of(rods_scene, {"rods.blade.rest={at: [0, 1 cm, 2 cm], bending_z: 20}"}).rods[2].second.rest);
  ASSERT_EQ(held.strains.size(), 3u);
  EXPECT_EQ(held.strains[2], strains(0, 0, 20, 0, 0, 0));
}

TEST(SceneRods, ReadsFreeMotionsOfTheBase) {
  using enum BaseAxis;
  const Scene scene = scene_of(rods_scene);
  EXPECT_EQ(scene.rods[0].second.base, (std::vector{x, turn_z}));
  EXPECT_EQ(scene.rods[1].second.base, (std::vector{x, y, z, turn_x, turn_y, turn_z}));
  EXPECT_TRUE(scene.rods[2].second.base.empty());
  EXPECT_TRUE(scene.rods[3].second.base.empty());
  EXPECT_EQ(scene_of(rods_scene, {"rods.tube.base=[turn_y, z, turn_x, y]"}).rods[1].second.base,
            (std::vector{y, z, turn_x, turn_y}));
}

TEST(SceneRods, ReadsSectionsAndMaterials) {
  const Scene scene = scene_of(rods_scene);
  const auto& tube = std::get<Tube>(at(scene.rods, 1, "tube").section);
  expect_taper(tube.outer, 0.005, 0.005);
  expect_taper(tube.inner, 0.004, 0.004);
  const RodMaterial& material = scene.rods[1].second.material;
  EXPECT_EQ(material.young, 1e6);
  EXPECT_EQ(material.poisson, 0.4);
  EXPECT_EQ(material.density, 1100.0);
  EXPECT_EQ(material.viscosity, 2.0);
  EXPECT_EQ(material.damping, 1.0);
  const auto& blade = std::get<Rectangle>(at(scene.rods, 2, "blade").section);
  expect_taper(blade.y, 0.004, 0.004);
  expect_taper(blade.z, 0.002, 0.002);
  EXPECT_EQ(scene.rods[2].second.material.viscosity, 0.0);
  EXPECT_EQ(scene.rods[2].second.material.damping, 0.0);
  const auto& oval = std::get<Ellipse>(at(scene.rods, 3, "oval").section);
  expect_taper(oval.y, 0.002, 0.001);
  expect_taper(oval.z, 0.001, 0.001);
}

TEST(SceneRods, ReadsGivenStiffness) {
  const Scene scene = scene_of(rods_scene);
  const Rod& rod = at(scene.rods, 4, "given");
  const auto& given = std::get<GivenSection>(rod.section);
  Eigen::Matrix<double, 6, 6> expected = strains(1, 2, 3, 4e3, 5e3, 6e3).asDiagonal();
  expected(1, 2) = expected(2, 1) = 1;
  expected(2, 5) = expected(5, 2) = 10;
  EXPECT_EQ(given.stiffness, expected);
  EXPECT_EQ(given.line_density, 0.1);
  EXPECT_EQ(given.radius, 0.005);
  EXPECT_EQ(rod.material.damping, 0.02);
  EXPECT_EQ(rod.material.young, 0.0);
  // Digits that another program rounded are no asymmetry, and what is read is symmetric.
  const auto rounded = std::get<GivenSection>(
      scene_of(rods_scene, {"rods.given.section.stiffness.matrix.1.2=1.0000000001"}).rods[4].second.section);
  EXPECT_EQ(rounded.stiffness, rounded.stiffness.transpose().eval());
  EXPECT_NEAR(rounded.stiffness(1, 2), 1.0 + 0.5e-10, 1e-13);
}

TEST(SceneRods, ReadsParts) {
  const Rod rod = scene_of(rods_scene).rods[0].second;
  ASSERT_EQ(rod.parts.size(), 5u);
  for (std::size_t i = 0; i < 5; ++i) EXPECT_DOUBLE_EQ(rod.parts[i].to, 0.02 * static_cast<double>(i + 1));
  expect_taper(std::get<Circle>(rod.parts[0].section).radius, 0.002, 0.001);
  expect_taper(std::get<Tube>(rod.parts[1].section).outer, 0.005, 0.004);
  expect_taper(std::get<Tube>(rod.parts[1].section).inner, 0.003, 0.003);
  expect_taper(std::get<Ellipse>(rod.parts[2].section).y, 0.002, 0.002);
  expect_taper(std::get<Ellipse>(rod.parts[2].section).z, 0.001, 0.001);
  expect_taper(std::get<Rectangle>(rod.parts[3].section).y, 0.004, 0.004);
  expect_taper(std::get<Rectangle>(rod.parts[3].section).z, 0.002, 0.001);
  const auto& given = std::get<GivenSection>(rod.parts[4].section);
  EXPECT_EQ(given.stiffness, (Eigen::Matrix<double, 6, 6>(strains(1, 2, 3, 4e3, 5e3, 6e3).asDiagonal())));
  EXPECT_EQ(given.line_density, 0.002);
  EXPECT_EQ(given.radius, 0.001);
  EXPECT_EQ(rod.parts[1].material.young, 2e6);
  EXPECT_EQ(rod.parts[1].material.density, 1200.0);
  EXPECT_EQ(rod.parts[1].material.viscosity, 300.0);
  EXPECT_EQ(rod.parts[1].material.damping, 0.01);
  EXPECT_EQ(rod.parts[3].material.poisson, 0.0);
}

TEST(SceneRods, ReadsCouplingsOfBothKinds) {
  const Scene scene = scene_of(rods_scene);
  ASSERT_EQ(scene.couplings.size(), 5u);
  const Slide& slide = std::get<Slide>(scene.couplings[0]);
  EXPECT_EQ(slide.channel, (std::vector<Vec3>{{0.001, 0.002, 0.003}, {0.004, 0.005, 0.006}}));
  EXPECT_EQ(slide.anchor_tip, AnchorTip::pose);
  EXPECT_TRUE(std::get<Slide>(scene_of(full_scene).couplings[0]).channel.empty());

  const Tie& to_frame = std::get<Tie>(scene.couplings[1]);
  EXPECT_EQ(to_frame.rod, "spine");
  EXPECT_EQ(to_frame.at, 0.05);
  EXPECT_EQ(to_frame.frame, "hand");
  EXPECT_FALSE(to_frame.solid);
  EXPECT_FALSE(to_frame.other);
  EXPECT_EQ(to_frame.along, (std::array{true, false, true}));
  EXPECT_EQ(to_frame.about, (std::array{false, true, false}));
  EXPECT_FALSE(to_frame.reach);

  const Tie& to_solid = std::get<Tie>(scene.couplings[2]);
  EXPECT_FALSE(to_solid.at);
  EXPECT_EQ(to_solid.solid, "finger");
  EXPECT_EQ(to_solid.along, (std::array{false, false, false}));
  EXPECT_EQ(to_solid.about, (std::array{true, true, true}));
  EXPECT_EQ(to_solid.reach, 0.001);

  const Tie& to_rod = std::get<Tie>(scene.couplings[3]);
  EXPECT_EQ(to_rod.at, 0.01);
  EXPECT_EQ(to_rod.other, "blade");
  EXPECT_EQ(to_rod.other_at, 0.02);

  const Tie& to_ground = std::get<Tie>(scene.couplings[4]);
  EXPECT_FALSE(to_ground.frame || to_ground.solid || to_ground.other || to_ground.other_at);
  EXPECT_EQ(to_ground.along, Tie{}.along);
  EXPECT_EQ(to_ground.about, Tie{}.about);
}

TEST(SceneRods, ReadsAxesAndTendons) {
  const Scene scene = scene_of(rods_scene);
  const Actuator& lift = at(scene.actuators, 0, "lift");
  EXPECT_EQ(lift.axis, 2);
  EXPECT_FALSE(lift.tendon);
  EXPECT_EQ(lift.motion, Motion::translation);
  const Actuator& roll = at(scene.actuators, 1, "roll");
  EXPECT_EQ(roll.axis, 1);
  EXPECT_EQ(roll.motion, Motion::rotation);
  EXPECT_FALSE(scene_of(full_scene).actuators[0].second.axis);

  const Actuator& wire = at(scene.actuators, 2, "wire");
  EXPECT_FALSE(wire.axis);
  EXPECT_EQ(wire.driven, Driven::force);
  EXPECT_EQ(std::get<Table>(wire.drive).values, (std::vector<double>{0, 2}));
  ASSERT_TRUE(wire.tendon);
  EXPECT_EQ(wire.tendon->from, 0.01);
  EXPECT_EQ(wire.tendon->to, 0.09);
  expect_taper(wire.tendon->distance, 0.01, 0.005);
  expect_taper(wire.tendon->angle, 0, 2 * pi);

  const Actuator& reel = at(scene.actuators, 3, "reel");
  EXPECT_EQ(reel.driven, Driven::displacement);
  ASSERT_TRUE(reel.tendon);
  EXPECT_EQ(reel.tendon->from, 0.0);
  EXPECT_FALSE(reel.tendon->to);
  expect_taper(reel.tendon->angle, 0, 0);

  const Actuator& hook = at(scene.actuators, 4, "hook");
  EXPECT_EQ(hook.driven, Driven::force);
  EXPECT_TRUE(std::holds_alternative<External>(hook.drive));
  expect_taper(hook.tendon->angle, pi / 2, pi / 2);
}

TEST(SceneRods, ReadsLoads) {
  const Scene scene = scene_of(rods_scene);
  ASSERT_EQ(scene.loads.size(), 4u);
  const RodLoad& weight = std::get<RodLoad>(at(scene.loads, 0, "weight"));
  EXPECT_EQ(weight.rod, "spine");
  EXPECT_FALSE(weight.at || weight.from || weight.to);
  EXPECT_EQ(weight.force, Vec3(0, 0, -1));
  EXPECT_EQ(weight.moment, Vec3::Zero().eval());
  EXPECT_FALSE(weight.follower);
  EXPECT_EQ(std::get<Table>(weight.factor).values, std::vector<double>{1});

  const RodLoad& wind = std::get<RodLoad>(at(scene.loads, 1, "wind"));
  EXPECT_EQ(wind.from, 0.01);
  EXPECT_EQ(wind.to, 0.05);
  EXPECT_EQ(wind.force, Vec3(0, 2, 0));
  EXPECT_EQ(wind.moment, Vec3(1, 0, 0));
  EXPECT_EQ(std::get<Table>(wind.factor).values, (std::vector<double>{0, 3}));

  const RodLoad& screw = std::get<RodLoad>(at(scene.loads, 2, "screw"));
  EXPECT_EQ(screw.at, 0.05);
  EXPECT_EQ(screw.moment, Vec3(0.02, 0, 0));
  EXPECT_TRUE(screw.follower);
  EXPECT_TRUE(std::holds_alternative<External>(screw.factor));

  const RodLoad& push = std::get<RodLoad>(at(scene.loads, 3, "push"));
  EXPECT_FALSE(push.follower);
  EXPECT_EQ(std::get<Table>(push.factor).values, std::vector<double>{-2.5});
}

TEST(SceneRods, ReadsQuantitiesOfOutputs) {
  const Scene scene = scene_of(rods_scene);
  EXPECT_EQ(at(scene.outputs, 0, "tip").quantity, Quantity::position);
  EXPECT_EQ(at(scene.outputs, 1, "root").quantity, Quantity::moment);
  EXPECT_EQ(scene_of(full_scene).outputs[0].second.quantity, Quantity::position);
  for (const auto& [word, quantity] :
       {std::pair("strain", Quantity::strain), {"force", Quantity::force}, {"stress", Quantity::stress}}) {
    EXPECT_EQ(scene_of(rods_scene, {std::string("outputs.root.quantity=") + word}).outputs[1].second.quantity,
              quantity);
  }
}

TEST(SceneRods, OverridesReachTheNewKeys) {
  const Scene scene =
      scene_of(rods_scene, {"rods.spine.order.torsion=3", "rods.spine.parts.1.section={circle: {radius: 1 mm}}",
                            "loads.weight.force.2=-2 N", "couplings.1.tie.at=20 mm", "actuators.wire.tendon.angle=0"});
  EXPECT_EQ(scene.rods[0].second.order[0], 3);
  EXPECT_EQ(std::get<Circle>(scene.rods[0].second.parts[1].section).radius.end, 0.001);
  EXPECT_EQ(std::get<RodLoad>(scene.loads[0].second).force.z(), -2.0);
  EXPECT_EQ(std::get<Tie>(scene.couplings[1]).at, 0.02);
  EXPECT_EQ(scene.actuators[2].second.tendon->angle.end, 0.0);
}

/// What is written after an override is the same scene.
TEST(SceneRods, TextReproducesTheScene) {
  const SceneFile first = parse_scene(rods_scene, "rods.yaml", "", {"title=x"});
  const SceneFile second = parse_scene(first.text, "rods.yaml", "");
  EXPECT_EQ(parse_scene(second.text, "rods.yaml", "", {"title=x"}).text, first.text);
  EXPECT_EQ(std::get<RestStrains>(second.scene.rods[0].second.rest).strains[1], strains(0.5, 2, 200, 0.1, 0.01, -0.03));
  EXPECT_TRUE(std::get<RodLoad>(second.scene.loads[2].second).follower);
  EXPECT_EQ(std::get<Tie>(second.scene.couplings[2]).along, (std::array{false, false, false}));
}

}  // namespace
}  // namespace sinew::io
