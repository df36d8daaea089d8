// Rods for validation: straight ones of chosen stiffness along x, their equilibria, and how far they bend.
#pragma once

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <numbers>

#include "sinew/rod/kinematics.hpp"
#include "sinew/sim/places.hpp"
#include "support/scenes.hpp"

namespace sinew::test {

using std::numbers::pi;

/// Strains in the order of the engine.
inline const std::vector<Strain> kBending = {Strain::torsion, Strain::bending_y, Strain::bending_z};
inline const std::vector<Strain> kExtensible = {Strain::torsion, Strain::bending_y, Strain::bending_z,
                                                Strain::elongation};
inline const std::vector<Strain> kAll = {Strain::torsion,    Strain::bending_y, Strain::bending_z,
                                         Strain::elongation, Strain::shear_y,   Strain::shear_z};

/// (GJ, EI_y, EI_z, EA, kGA_y, kGA_z) [N m^2, N].
using Stiffness = std::array<double, 6>;

inline GivenSection given(const Stiffness& stiffness, double radius = 0.01) {
  GivenSection section;
  for (int i = 0; i < 6; ++i) section.stiffness(i, i) = stiffness[static_cast<std::size_t>(i)];
  section.radius = radius;
  return section;
}

/// A clamped straight rod from the origin along x whose cross-section's axes are the world's; in equilibrium at
/// `steps` times up to 1.
inline Scene straight_rod(double length, int sections, const CrossSection& section,
                          const std::vector<Strain>& strains = kBending, int order = 0, int steps = 1) {
  Scene scene;
  scene.analysis = Analysis::quasi_static;
  scene.time = {1.0 / steps, 1.0};
  Rod rod;
  rod.path = {Vec3::Zero(), Vec3(length, 0, 0)};
  rod.up = Vec3::UnitY();
  rod.sections = sections;
  rod.strains = strains;
  rod.order.fill(order);
  rod.section = section;
  scene.rods.emplace_back("rod", rod);
  Output tip;
  tip.rod = "rod";
  scene.outputs.emplace_back("tip", tip);
  return scene;
}

/// A point load that grows from zero at t = 0 to its value at t = 1; at the tip unless `at` is given.
inline RodLoad& add_load(Scene& scene, const Vec3& force, const Vec3& moment = Vec3::Zero(),
                         std::optional<double> at = {}) {
  RodLoad load;
  load.rod = "rod";
  load.at = at;
  load.force = force;
  load.moment = moment;
  load.factor = Table{{0.0, 1.0}, {0.0, 1.0}};
  scene.loads.emplace_back("load" + std::to_string(scene.loads.size()), load);
  return std::get<RodLoad>(scene.loads.back().second);
}

/// Turns the base about x to `angle` at t = 1.
inline void turn_base(Scene& scene, double angle) {
  Actuator motor;
  motor.rod = "rod";
  motor.motion = Motion::rotation;
  motor.driven = Driven::angle;
  motor.drive = Table{{0.0, 1.0}, {0.0, angle}};
  scene.actuators.emplace_back("turn", motor);
}

inline Tie& add_tie(Scene& scene, std::array<bool, 3> along, std::array<bool, 3> about = {false, false, false}) {
  Tie tie;
  tie.rod = "rod";
  tie.along = along;
  tie.about = about;
  scene.couplings.emplace_back(tie);
  return std::get<Tie>(scene.couplings.back());
}

struct Solved {
  Model model;
  Trace trace;
  const State& end() const { return trace.states.back(); }
  bool done() const { return trace.end == RunEnd::done; }
  std::string why() const { return std::string(to_string(trace.failure.status)) + " " + trace.failure.detail; }
  rod::Configuration shape(int number = 0) const { return rod_shape(model, end(), number); }
  Vec3 tip(int number = 0) const { return rod::position(shape(number), model.rods[number].rod.length()); }
  Vec3 at(double s) const { return rod::position(shape(), s); }
  rod::Mat3 frame(double s) const { return rod::curve_point(shape(), s).R; }
};

/// Builds and runs a scene to its end, which it must reach.
inline Solved solve(const Scene& scene) {
  Solved solved{build(scene, read_block), {}};
  solved.trace = run_all(solved.model);
  EXPECT_TRUE(solved.done()) << solved.why() << " at t = " << solved.end().time;
  return solved;
}

}  // namespace sinew::test
