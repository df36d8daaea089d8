// Solids for validation: structured blocks, bent to shape by a map, and their equilibria.
#pragma once

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <functional>
#include <numbers>

#include "sinew/sim/places.hpp"
#include "support/scenes.hpp"

namespace sinew::test {

using std::numbers::pi;

/// A unit block of so many boxes, moved to where `place` puts its points.
inline solid::Mesh mapped_block(solid::Kind kind, int nx, int ny, int nz,
                                const std::function<Vec3(const Vec3&)>& place) {
  solid::Mesh mesh = block_mesh(nx, ny, nz, Vec3::Ones(), kind);
  for (Eigen::Index i = 0; i < mesh.nodes.cols(); ++i) mesh.nodes.col(i) = place(mesh.nodes.col(i));
  return mesh;
}

/// Numbers of the nodes of a mesh that pass a test.
inline NodeNumbers nodes_where(const solid::Mesh& mesh, const std::function<bool(const Vec3&)>& test) {
  NodeNumbers list;
  for (Eigen::Index i = 0; i < mesh.nodes.cols(); ++i) {
    if (test(mesh.nodes.col(i))) list.numbers.push_back(static_cast<int>(i));
  }
  return list;
}

/// One solid in equilibrium under the loads of t = 1; with `steps` at so many times up to there.
inline Scene solid_scene(const solid::Law& law, int steps = 0) {
  Scene scene;
  scene.analysis = steps > 0 ? Analysis::quasi_static : Analysis::statics;
  scene.time = {1.0 / std::max(steps, 1), 1.0};
  Solid solid;
  solid.mesh = "mesh";
  solid.material.law = law;
  solid.density = 1000.0;
  scene.solids.emplace_back("solid", solid);
  return scene;
}

inline Held& hold(Scene& scene, const Region& region, std::array<bool, 3> axes = {true, true, true}) {
  return scene.solids[0].second.fixed.emplace_back(Held{region, axes, {}});
}

inline SolidLoad& load_solid(Scene& scene, const Region& region, const Vec3& force, double pressure = 0.0) {
  SolidLoad load{"solid", region, force, pressure, Table{{0.0, 1.0}, {0.0, 1.0}}};
  scene.loads.emplace_back("load" + std::to_string(scene.loads.size()), load);
  return std::get<SolidLoad>(scene.loads.back().second);
}

struct SolvedSolid {
  Model model;
  Trace trace;
  const State& end() const { return trace.states.back(); }
  /// Displacement of a material point.
  Vec3 moved(const Vec3& at) const {
    const solid::Body& body = model.solids[0].body;
    const solid::EmbeddedPoint point = solid::embed(body.rest, body.cells, at);
    return solid_point(model, end(), 0, point) - solid::position(point, body.cells, body.rest);
  }
  solid::Mat3 stress(const Vec3& at) const {
    const solid::Body& body = model.solids[0].body;
    return solid::cauchy_stress(body, solid::embed(body.rest, body.cells, at), end().solids[0].x);
  }
};

inline SolvedSolid solve(const Scene& scene, const solid::Mesh& mesh) {
  SolvedSolid solved{build(scene, [&mesh](const std::filesystem::path&) { return mesh; }), {}};
  solved.trace = run_all(solved.model);
  EXPECT_EQ(solved.trace.end, RunEnd::done)
      << to_string(solved.trace.failure.status) << " " << solved.trace.failure.detail;
  return solved;
}

inline Plane plane(const Vec3& point, const Vec3& normal) { return {point, normal, {}, In::object}; }

}  // namespace sinew::test
