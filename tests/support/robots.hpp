// The robots whose steps are timed: the public finger and trunk, and blocks of any size, one linearisation a step.
#pragma once

#include <cmath>
#include <filesystem>
#include <limits>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "support/scenes.hpp"

namespace sinew::test {

/// A cable of three strains along a straight line, tied at abscissae, the last one its tip.
inline void add_cable(Scene& scene, const std::string& name, const std::vector<Vec3>& path, int sections,
                      std::vector<double> points, double radius, double pull) {
  Rod rod;
  rod.path = path;
  rod.sections = sections;
  rod.section = Circle{radius};
  rod.material = {5e9, 0.4, 1100.0};
  scene.rods.emplace_back(name, rod);
  Slide slide;
  slide.rod = name;
  slide.solid = "body";
  slide.points = std::move(points);
  scene.couplings.emplace_back(slide);
  Actuator actuator;
  actuator.rod = name;
  actuator.drive = Table{{0.0, 2.0}, {0.0, pull}};
  scene.actuators.emplace_back(name, actuator);
}

/// A point of the body that forces of all actuators, of `most` at most, are to bring where the caller says.
inline void add_target(Scene& scene, const Vec3& point, double most = std::numeric_limits<double>::infinity()) {
  Output output;
  output.solid = "body";
  output.point.x = point;
  scene.outputs.emplace_back("tip", output);
  Target target;
  target.output = "tip";
  target.at = External{};
  scene.targets.push_back(target);
  for (auto& [name, actuator] : scene.actuators) {
    actuator.driven = Driven::force;
    actuator.drive = Sought{};
    actuator.limits.force = Span{0.0, most};
  }
}

inline std::vector<double> evenly(double length, int count) {
  std::vector<double> at;
  for (int i = 1; i <= count; ++i) at.push_back(length * i / count);
  return at;
}

inline Scene linearised() {
  Scene scene;
  scene.time = {0.01, 1000.0};
  scene.newton.iterations = 1;
  scene.gravity = Vec3::Zero();
  return scene;
}

/// The public finger (158 nodes) with a straight cable in `sections`, tied at `points`.
inline Scene finger(const std::filesystem::path& meshes, int sections, int points, Cable kind) {
  Scene scene = linearised();
  Solid body;
  body.mesh = meshes / "finger.vtk";
  body.scale = mm;
  body.pose = {{0.0, std::numbers::pi, 0.0}, {-17.5 * mm, -12.5 * mm, 7.5 * mm}};
  body.material.law = solid::corotational(500e3, 0.45);
  body.mass = 0.075;
  body.rayleigh = {0.1, 0.1};
  body.fixed.push_back({Box{Vec3(-19.5 * mm, -2.5 * mm, -0.5 * mm), Vec3(0.5 * mm, 9.5 * mm, 15.5 * mm)}});
  scene.solids.emplace_back("body", body);
  add_cable(scene, "cable", {Vec3::Zero(), Vec3(81 * mm, 0, 0)}, sections, evenly(81 * mm, points), 0.5 * mm, 5 * mm);
  scene.rods[0].second.cable = kind;
  return scene;
}

/// The public trunk (709 nodes) with its four cables, tied where the paper's are (10 points a cable) or evenly.
inline Scene trunk(const std::filesystem::path& meshes, int points) {
  Scene scene = linearised();
  Solid body;
  body.mesh = meshes / "trunk.vtk";
  body.scale = mm;
  body.material.law = solid::corotational(450e3, 0.45);
  body.mass = 0.042;
  body.rayleigh = {0.1, 0.1};
  body.fixed.push_back({Plane{Vec3::Zero(), Vec3::UnitZ(), 1 * mm}});
  scene.solids.emplace_back("body", body);
  constexpr double length = 185.368 * mm;
  const Vec3 way = Vec3(0, -8, 195).normalized();
  std::vector<double> at = evenly(length, points);
  if (points == 10) {
    at.clear();
    for (int j = 0; j < 9; ++j) at.push_back((32.743 + 17.485 * j) * mm);
    at.push_back(length);
  }
  for (int i = 0; i < 4; ++i) {
    const Eigen::AngleAxisd turn(i * std::numbers::pi / 2, Vec3::UnitZ());
    const Vec3 from = turn * Vec3(0, 10 * mm, 0), to = from + length * (turn * way);
    add_cable(scene, "cable" + std::to_string(i), {from, to}, 20, at, 0.2 * mm, i == 0 ? 2 * mm : 0.0);
  }
  return scene;
}

/// A block of about so many tetrahedra with one cable off its middle, tied at 15 points.
inline Scene block() {
  Scene scene = linearised();
  Solid body;
  body.mesh = "block";
  body.material.law = solid::corotational(600e3, 0.45);
  body.density = 1000.0;
  body.rayleigh = {0.1, 0.02};
  body.fixed.push_back({Plane{Vec3::Zero(), Vec3::UnitX()}});
  scene.solids.emplace_back("body", body);
  add_cable(scene, "cable", {Vec3(0, 7 * mm, 5 * mm), Vec3(50 * mm, 7 * mm, 5 * mm)}, 15, evenly(50 * mm, 15), 0.5 * mm,
            2 * mm);
  return scene;
}

inline MeshReader block_of(int cells) {
  return [cells](const auto&) {
    const auto n = static_cast<int>(std::lround(std::cbrt(cells / 30.0)));
    return block_mesh(static_cast<int>(std::lround(cells / (6.0 * n * n))), n, n, Vec3(0.05, 0.01, 0.01),
                      solid::Kind::tet4);
  };
}

}  // namespace sinew::test
