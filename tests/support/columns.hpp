// Random columns: rods under loads along them, straight or bent at rest, alone or tied to another one, pulled by
// tendons or not.
#pragma once

#include <cmath>
#include <numbers>

#include "sinew/sim/scene.hpp"
#include "support/random.hpp"

namespace sinew::test {

/// Stress-free with this curvature [1/m].
inline RestStrains bent(double length, double curvature) {
  Eigen::Matrix<double, 6, 1> strains = Eigen::Matrix<double, 6, 1>::Zero();
  strains[static_cast<int>(Strain::bending_y)] = curvature;
  return {{0.0, length}, {strains, strains}};
}

inline Scene column(Random& random) {
  using enum Strain;
  static const std::vector<std::vector<Strain>> kStrains = {
      {torsion, bending_y, bending_z, elongation, shear_y, shear_z},
      {torsion, bending_y, bending_z, elongation},
      {torsion, bending_y, bending_z},
      {bending_y, bending_z}};
  Scene scene;
  scene.analysis = Analysis::quasi_static;
  scene.time = {1.0, 1.0};
  scene.gravity = random.chance(0.1) ? Vec3(0, 0, -9.81) : Vec3(Vec3::Zero());
  const double length = random(0.1, 0.3), radius = random(0.5e-3, 4e-3), young = std::pow(10.0, random(6.0, 10.0));
  Rod rod;
  rod.path = {Vec3::Zero(), Vec3(length, 0, 0)};
  const int sections = random.whole(3, 10);
  rod.sections = sections;
  rod.strains = kStrains[static_cast<std::size_t>(random.whole(0, 3))];
  rod.order.fill(random.whole(0, 2));
  rod.section = Circle{radius};
  rod.material = {young, 0.4, 1100.0, 0.0, 0.0};
  if (random.chance(0.3)) {
    rod.start = Start::path;
    rod.rest = bent(length, random(-5.0, 5.0));
  }
  scene.rods.emplace_back("a", rod);
  if (random.chance(0.5)) {
    if (rod.start) rod.rest = bent(length, random(-8.0, 8.0));
    scene.rods.emplace_back("b", rod);
    const int ties = random.whole(1, std::min(4, sections));
    for (int i = 0; i < ties; ++i) {
      Tie tie;
      tie.rod = "a";
      tie.other = "b";
      tie.at = tie.other_at = length * (i + 1) / (ties + 1);
      tie.along = {random.chance(0.3) && rod.strains.size() > 3, true, true};
      scene.couplings.emplace_back(tie);
    }
  }
  const double buckles = std::numbers::pi * std::numbers::pi * young * std::numbers::pi * std::pow(radius, 4) / 4.0 /
                         (4.0 * length * length);
  RodLoad push;
  push.rod = "a";
  push.force = Vec3(-buckles * random(0.0, 4.0), 0, 0);
  if (random.chance(0.2)) push.force.y() = buckles * random(-0.5, 0.5);
  scene.loads.emplace_back("push", push);
  if (random.chance(0.3)) {
    Actuator pull;
    pull.rod = "a";
    pull.tendon = Tendon{};
    pull.tendon->distance = {0.6 * radius, 0.6 * radius};
    pull.driven = Driven::force;
    pull.drive = Table{{0.0}, {buckles * random(0.0, 2.0)}};
    scene.actuators.emplace_back("pull", pull);
  }
  return scene;
}

}  // namespace sinew::test
