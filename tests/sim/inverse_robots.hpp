// Robots whose motors are looked for.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "sinew/sim/inverse.hpp"
#include "sinew/sim/places.hpp"
#include "sinew/sim/statics.hpp"
#include "support/meshes.hpp"
#include "support/robots.hpp"

namespace sinew::test {

constexpr double kNone = INFINITY;

/// A block with a cable along two of its sides, pulled by forces that move its upper far corner.
inline Scene two_cables(double most = kNone) {
  Scene scene = block();
  scene.time.step = 0.02;
  add_cable(scene, "other", {Vec3(0, 3 * mm, 5 * mm), Vec3(50 * mm, 3 * mm, 5 * mm)}, 10, evenly(50 * mm, 10), 0.5 * mm,
            0.0);
  add_target(scene, Vec3(50 * mm, 5 * mm, 5 * mm), most);
  return scene;
}

inline void drive_by_displacement(Scene& scene) {
  for (auto& [name, actuator] : scene.actuators) {
    actuator.driven = Driven::displacement;
    actuator.drive = Sought{};
  }
}

/// Turns and strains of rods, turns of solids, beside positions.
inline Scene hinged() {
  Scene scene = two_cables();
  scene.outputs[0].second.quantity = Quantity::orientation;
  scene.targets[0].weights = {0, 0, 1};
  Output strain;
  strain.rod = "other";
  strain.at = 25 * mm;
  strain.quantity = Quantity::strain;
  scene.outputs.emplace_back("bend", strain);
  Output along = strain;
  along.quantity = Quantity::orientation;
  scene.outputs.emplace_back("turn", along);
  Output point = strain;
  point.quantity = Quantity::position;
  scene.outputs.emplace_back("middle", point);
  return scene;
}

inline Target wish(const std::string& output, std::vector<double> weights = {}) {
  Target target;
  target.output = output;
  target.at = External{};
  target.strain = Strain::bending_z;
  target.weights = std::move(weights);
  return target;
}

/// A robot and what is done with it.
class Inverse : public testing::Test {
 protected:
  struct Robot {
    explicit Robot(const Scene& scene) : model(build(scene, block_of(600))), workspace(make_workspace(model)) {}
    Model model;
    Workspace workspace;
    State state = initial_state(model);

    Vec3 tip(const State& at) const { return output_position(model, at, model.outputs[0]); }
    Vec3 tip() const { return tip(state); }
    Command nothing() const { return {std::vector<double>(model.actuators.size(), 0.0), {}}; }
    StepReport seek(const Eigen::VectorXd& goal) {
      return inverse_step(model, workspace, {goal}, nothing(), model.scene.time.step, state);
    }
    StepReport settle(const Eigen::VectorXd& goal) {
      return inverse_equilibrium(model, workspace, {goal}, nothing(), state.time + model.scene.time.step, state);
    }
    /// The same step with commands as they are given.
    State direct(const State& from, const std::vector<double>& commands) {
      State next = from;
      Workspace own = make_workspace(model);
      EXPECT_TRUE(accepted(step(model, own, {commands, {}}, model.scene.time.step, next).status));
      return next;
    }
    State at_rest(const std::vector<double>& commands) {
      Workspace own = make_workspace(model);
      const StepResult result = equilibrium_step(model, own, {commands, {}}, initial_state(model), 0.02);
      EXPECT_TRUE(accepted(result.report.status));
      return result.next;
    }
  };
};

}  // namespace sinew::test
