// Runs of hands that pick something up, and what became of it.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "sinew/io/mesh_file.hpp"
#include "sinew/io/scene_file.hpp"
#include "support/scenes.hpp"

namespace sinew::test {

struct Grasp {
  std::vector<double> times;
  std::vector<Vec3> cube;  ///< [m] where the first body is
  double deepest = 0.0;    ///< [m] least gap of all contacts
  double pull = 0.0;       ///< [N] of the first cable at the end

  const Vec3& at(double time) const {
    std::size_t i = 0;
    while (i + 1 < times.size() && times[i] < time - 1e-6) ++i;
    return cube[i];
  }
  /// [m] farthest that it has moved since.
  double slip(double since) const {
    double most = 0.0;
    for (std::size_t i = 0; i < times.size(); ++i) {
      if (times[i] >= since - 1e-6) most = std::max(most, (cube[i] - at(since)).norm());
    }
    return most;
  }
};

inline Grasp grasp(const Model& model) {
  Grasp found;
  StepReport failure;
  const RunEnd end = run(
      model, initial_state(model),
      [&](const State& state, const StepReport&) {
        found.times.push_back(state.time);
        found.cube.push_back(state.bodies[0].p);
        for (const ContactState& own : state.contacts) found.deepest = std::min(found.deepest, own.gap);
        if (!state.actuators.empty()) found.pull = state.actuators[0];
        return true;
      },
      &failure);
  EXPECT_EQ(end, RunEnd::done) << to_string(failure.status) << " " << failure.detail;
  return found;
}

/// Of a scene file below the project's folder.
inline Grasp grasp(const std::string& file, const std::vector<std::string>& changes) {
  return grasp(build(io::read_scene(std::filesystem::path(SINEW_SOURCE_DIR) / file, changes).scene, io::read_mesh));
}

}  // namespace sinew::test
