// Scenes for tests: the comparison finger, and blocks and rods that need no file.
#pragma once

#include <cmath>
#include <numbers>
#include <string>

#include "sinew/sim/places.hpp"
#include "sinew/sim/run.hpp"
#include "sinew/sim/signals.hpp"
#include "support/meshes.hpp"

namespace sinew::test {

inline constexpr double mm = 1e-3;

/// Ties the rod "cable" to a solid at so many points, anchors its tip, and pulls it.
inline void tie_and_pull(Scene& scene, const std::string& solid, int points, double pull, double rate) {
  Slide slide;
  slide.rod = "cable";
  slide.solid = solid;
  slide.points = points;
  scene.couplings.push_back(slide);
  Actuator actuator;
  actuator.rod = "cable";
  actuator.drive = Table{{0.0, pull / rate}, {0.0, pull}};
  scene.actuators.emplace_back("pull", actuator);
}

/// The slide that stands at this place among the couplings.
inline Slide& slide(Scene& scene, std::size_t number) { return std::get<Slide>(scene.couplings[number]); }

/// The comparison scene: the public finger mesh turned about y, a straight massless cable of 81 mm along +x from the
/// origin in 8 sections tied at 9 points, no gravity, pulled at `rate`. `rigid` moves everything through poses.
inline Scene comparison_finger(const std::filesystem::path& mesh, double pull, double rate = 0.01,
                               const Pose& rigid = {}) {
  Scene scene;
  scene.time = {0.01, pull / rate + 2.0};
  const auto moved = [&rigid](const Pose& pose) {  // the pose that does `pose` first and `rigid` after it
    if (rigid.rotate.isZero() && rigid.translate.isZero()) return pose;
    const Placement both = compose(placement(rigid), placement(pose));
    const rod::Mat3& R = both.R;
    Pose out;
    out.rotate = {std::atan2(R(2, 1), R(2, 2)), -std::asin(R(2, 0)), std::atan2(R(1, 0), R(0, 0))};
    out.translate = both.p;
    return out;
  };
  Solid finger;
  finger.mesh = mesh;
  finger.scale = 1e-3;
  finger.pose = moved({{0.0, std::numbers::pi, 0.0}, {-17.5 * mm, -12.5 * mm, 7.5 * mm}});
  finger.material.law = solid::corotational(500e3, 0.45);
  finger.mass = 0.075;
  finger.rayleigh = {0.1, 0.1};
  // World box [-18, -15, -8] .. [2, -3, 8] mm seen from the mesh, before its pose.
  finger.fixed.push_back({Box{Vec3(-19.5 * mm, -2.5 * mm, -0.5 * mm), Vec3(0.5 * mm, 9.5 * mm, 15.5 * mm)}});
  scene.solids.emplace_back("finger", finger);
  Rod cable;
  cable.path = {Vec3::Zero(), Vec3(81 * mm, 0, 0)};
  cable.pose = rigid;
  cable.sections = 8;
  cable.section = Circle{0.5 * mm};
  cable.material = {5e9, 0.45, 0.0};
  scene.rods.emplace_back("cable", cable);
  tie_and_pull(scene, "finger", 9, pull, rate);
  Output tip;
  tip.solid = "finger";
  // World (85.5, -5.5, 0.5) mm seen from the mesh.
  tip.point.x = Vec3(-103.0 * mm, 7.0 * mm, 7.0 * mm);
  scene.outputs.emplace_back("tip", tip);
  return scene;
}

/// A block 60 x 10 x 10 mm clamped at x = 0 with a cable off its middle, anchored at its end; no file is read.
inline Scene cable_block(double pull = 2 * mm, double rate = 0.02) {
  Scene scene;
  scene.time = {0.01, 0.2};
  Solid block;
  block.mesh = "block";
  block.material.law = solid::corotational(300e3, 0.4);
  block.density = 1000.0;
  block.rayleigh = {0.1, 0.02};
  block.fixed.push_back({Box{Vec3(-mm, -mm, -mm), Vec3(mm, 11 * mm, 11 * mm)}});
  scene.solids.emplace_back("block", block);
  Rod cable;
  cable.path = {Vec3(0, 5 * mm, 8 * mm), Vec3(60 * mm, 5 * mm, 8 * mm)};
  cable.sections = 6;
  cable.section = Circle{0.3 * mm};
  cable.material = {2e9, 0.4, 1100.0};
  scene.rods.emplace_back("cable", cable);
  tie_and_pull(scene, "block", 6, pull, rate);
  Output tip;
  tip.solid = "block";
  tip.point.x = Vec3(60 * mm, 5 * mm, 5 * mm);
  scene.outputs.emplace_back("tip", tip);
  return scene;
}

inline solid::Mesh read_block(const std::filesystem::path&) {
  return block_mesh(12, 2, 2, Vec3(60 * mm, 10 * mm, 10 * mm));
}

/// A clamped or actuated rod alone: length 0.5 m along x, radius 5 mm, E = 10 MPa.
inline Scene lone_rod(double density = 1000.0, int sections = 10) {
  Scene scene;
  scene.time = {0.01, 0.5};
  Rod rod;
  rod.path = {Vec3::Zero(), Vec3(0.5, 0, 0)};
  rod.sections = sections;
  rod.section = Circle{5 * mm};
  rod.material = {10e6, 0.45, density};
  scene.rods.emplace_back("rod", rod);
  Output tip;
  tip.rod = "rod";
  tip.at = 0.5;
  scene.outputs.emplace_back("tip", tip);
  return scene;
}

struct Trace {
  std::vector<State> states;        ///< the first is the initial one
  std::vector<StepReport> reports;  ///< of the steps that led to states 1, 2, ...
  RunEnd end = RunEnd::done;
  StepReport failure;
};

inline Trace run_all(const Model& model) {
  Trace trace;
  trace.states.push_back(initial_state(model));
  trace.end = run(
      model, trace.states.front(),
      [&trace](const State& state, const StepReport& report) {
        trace.states.push_back(state);
        trace.reports.push_back(report);
        return true;
      },
      &trace.failure);
  return trace;
}

inline Vec3 tip(const Model& model, const State& state) { return output_position(model, state, model.outputs[0]); }

}  // namespace sinew::test
