// Bodies on a floor.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>

#include "sinew/sim/run.hpp"
#include "sinew/sim/signals.hpp"
#include "support/scenes.hpp"

namespace sinew::test {

inline solid::Mesh no_mesh(const std::filesystem::path&) { return {}; }

inline constexpr double kGravity = 9.81;

inline RigidBody box_of(double edge, double mass, const Vec3& at) {
  RigidBody body;
  body.shape = BoxShape{Vec3::Constant(edge)};
  body.mass = mass;
  body.pose.translate = at;
  return body;
}

inline Scene on_floor(double h, double duration, double friction) {
  Scene scene;
  scene.time = {h, duration};
  scene.gravity = Vec3(0, 0, -kGravity);
  scene.contact.friction = friction;
  Obstacle floor;
  floor.shape = PlaneShape{Vec3::Zero(), Vec3::UnitZ()};
  scene.obstacles.emplace_back("floor", floor);
  return scene;
}

/// Runs to the end; the last state.
inline State end_of(const Model& model, double* most_energy = nullptr) {
  State last = initial_state(model);
  double energy = energy_balance(model, last).total();
  StepReport failure;
  const RunEnd end = run(
      model, last,
      [&](const State& state, const StepReport&) {
        const double now = energy_balance(model, state).total();
        if (most_energy) *most_energy = std::max(*most_energy, now - energy);
        energy = now;
        last = state;
        return true;
      },
      &failure);
  EXPECT_EQ(end, RunEnd::done) << to_string(failure.status) << " " << failure.detail;
  return last;
}

}  // namespace sinew::test
