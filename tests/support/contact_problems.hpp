// Contact problems as steps of many scenes pose them: of two contacts and of five hundred.
#pragma once

#include <random>

#include "sinew/sim/newton.hpp"
#include "support/scenes.hpp"

namespace sinew::test {

/// As the last round of Newton in a step posed it.
struct ContactProblem {
  std::string scene;
  solve::CoulombProblem problem;
};

/// Numbers between -1 and 1, the same on every machine.
class Chance {
 public:
  double number() { return static_cast<double>(engine_()) / 2147483648.0 - 1.0; }
  Vec3 vector() {
    const double x = number(), y = number();
    return {x, y, number()};
  }

 private:
  std::mt19937 engine_{5};
};

inline Scene heavy_floor(double duration) {
  Scene scene;
  scene.time = {0.01, duration};
  scene.gravity = Vec3(0, 0, -9.81);
  Obstacle floor;
  floor.shape = PlaneShape{Vec3::Zero(), Vec3::UnitZ()};
  scene.obstacles.emplace_back("floor", floor);
  return scene;
}

template <class Shape>
RigidBody body_of(const Shape& shape, double mass, const Vec3& at) {
  RigidBody body;
  body.shape = shape;
  body.mass = mass;
  body.pose.translate = at;
  return body;
}

/// Boxes on each other, nx x ny x nz, a little out of place: of like mass, or each layer `heavier` than the one below.
inline Scene pile(int nx, int ny, int nz, double friction, double heavier = 1.0) {
  Scene scene = heavy_floor(0.2);
  scene.contact.friction = friction;
  Chance chance;
  double mass = 0.1;
  for (int k = 0; k < nz; ++k, mass *= heavier) {
    for (int i = 0; i < nx; ++i) {
      for (int j = 0; j < ny; ++j) {
        const Vec3 at((i * 41.0 + chance.number()) * mm, (j * 41.0 + chance.number()) * mm, (k * 40.0 + 20.0) * mm);
        scene.bodies.emplace_back("box" + std::to_string(scene.bodies.size()),
                                  body_of(BoxShape{Vec3::Constant(40 * mm)}, mass, at));
      }
    }
  }
  return scene;
}

/// Bricks in courses, each across the joint below.
inline Scene wall(int wide, int high, double friction) {
  Scene scene = heavy_floor(0.2);
  scene.contact.friction = friction;
  for (int k = 0; k < high; ++k) {
    for (int i = 0; i < wide; ++i) {
      scene.bodies.emplace_back("brick" + std::to_string(scene.bodies.size()),
                                body_of(BoxShape{Vec3(60 * mm, 30 * mm, 20 * mm)}, 0.1,
                                        Vec3((i + 0.5 * (k % 2)) * 60.5 * mm, 0, (k * 20.0 + 10.0) * mm)));
    }
  }
  return scene;
}

/// Balls, capsules and boxes that fall into a pit.
inline Scene heap(int count, double friction) {
  Scene scene = heavy_floor(0.6);
  scene.contact.friction = friction;
  const std::pair<const char*, Vec3> sides[] = {
      {"east", -Vec3::UnitX()}, {"west", Vec3::UnitX()}, {"north", -Vec3::UnitY()}, {"south", Vec3::UnitY()}};
  for (const auto& [name, out] : sides) {
    Obstacle side;
    side.shape = PlaneShape{-60 * mm * out, out};
    scene.obstacles.emplace_back(name, side);
  }
  Chance chance;
  for (int i = 0; i < count; ++i) {
    const Vec3 at(chance.number() * 40 * mm, chance.number() * 40 * mm, (15.0 + 12.0 * i) * mm);
    const double size = (10.0 + 2.0 * chance.number()) * mm;
    RigidBody body;
    if (i % 3 == 0) body = body_of(SphereShape{size}, 0.02, at);
    if (i % 3 == 1) body = body_of(CapsuleShape{0.6 * size, 2.0 * size}, 0.02, at);
    if (i % 3 == 2) body = body_of(BoxShape{Vec3::Constant(1.6 * size)}, 0.02, at);
    body.pose.rotate = chance.vector();
    scene.bodies.emplace_back("piece" + std::to_string(i), body);
  }
  return scene;
}

inline Solid soft(const std::string& mesh, const Vec3& at, double young) {
  Solid solid;
  solid.mesh = mesh;
  solid.material.law = solid::corotational(young, 0.3);
  solid.density = 1000.0;
  solid.rayleigh = {1.0, 0.01};
  solid.pose.translate = at;
  return solid;
}

/// A soft block thrown on the floor, and another one on it.
inline Scene blocks(double young, double friction) {
  Scene scene = heavy_floor(0.3);
  scene.contact.friction = friction;
  scene.solids.emplace_back("lower", soft("slab", Vec3(0, 0, 1 * mm), young));
  scene.solids.emplace_back("upper", soft("cube", Vec3(13 * mm, 17 * mm, 22 * mm), young));
  ContactPair pair;
  pair.first = "lower";
  pair.second = "upper";
  scene.contact.pairs.push_back(pair);
  return scene;
}

/// Rods that fall across each other and a drum.
inline Scene logs(int count, double friction) {
  Scene scene = heavy_floor(0.3);
  scene.contact.friction = friction;
  Obstacle drum;
  drum.shape = CylinderShape{15 * mm, 100 * mm};
  drum.pose = {{0.5 * std::numbers::pi, 0, 0}, {30 * mm, 0, 15 * mm}};
  scene.obstacles.emplace_back("drum", drum);
  for (int i = 0; i < count; ++i) {
    const std::string name = "log" + std::to_string(i);
    Rod rod;
    const double z = (33.0 + 6.0 * i) * mm, angle = 0.7 * i;
    const Vec3 middle(30 * mm, 0, z), half = 40 * mm * Vec3(std::cos(angle), std::sin(angle), 0);
    rod.path = {middle - half, middle + half};
    rod.sections = 8;
    rod.section = Circle{2 * mm};
    rod.material = {1e6, 0.4, 1000.0, 100.0};
    rod.base = {BaseAxis::x, BaseAxis::y, BaseAxis::z, BaseAxis::turn_x, BaseAxis::turn_y, BaseAxis::turn_z};
    scene.rods.emplace_back(name, rod);
    for (int j = 0; j < i; ++j) {
      ContactPair pair;
      pair.first = "log" + std::to_string(j);
      pair.second = name;
      scene.contact.pairs.push_back(pair);
    }
  }
  return scene;
}

inline solid::Mesh slab_or_cube(const std::filesystem::path& name) {
  if (name == "slab") return block_mesh(6, 6, 2, Vec3(60 * mm, 60 * mm, 20 * mm));
  return block_mesh(4, 4, 4, Vec3(30 * mm, 30 * mm, 30 * mm));
}

/// Problems of `count` steps of a scene at most, evenly over its time.
inline void take_problems(const std::string& name, const Scene& scene, int count, std::vector<ContactProblem>& found) {
  const Model model = build(scene, slab_or_cube);
  Workspace workspace(model);
  State state = initial_state(model);
  int taken = 0;
  while (state.time < scene.time.duration * (1.0 - 1e-9)) {
    if (advance(model, workspace, state).status != Status::converged) return;
    const solve::CoulombProblem& problem = workspace.memory().here.contact_problem();
    if (state.contacts.empty() || problem.contacts() == 0) continue;
    if (state.time * count < (taken + 1) * scene.time.duration * (1.0 - 1e-9)) continue;
    found.push_back({name, problem});
    ++taken;
  }
}

/// Plain block Gauss-Seidel from zero: contact after contact solved exactly, until the residual is met or `most` sweeps
/// are made. Returns the sweeps.
inline int plain_sweeps(const solve::CoulombProblem& problem, double tolerance, int most, Eigen::VectorXd& lambda) {
  lambda.setZero(problem.b.size());
  int sweeps = 0;
  while (sweeps < most && solve::residual(problem, lambda).largest() > tolerance) {
    for (int turn = 0; turn < 10; ++turn, ++sweeps) solve::sweep(problem, lambda);
  }
  return sweeps;
}

/// What is at rest from the start on is known after a few steps.
inline Scene brief(Scene scene, double duration = 0.08) {
  scene.time.duration = duration;
  return scene;
}

/// All of them, small ones first.
inline std::vector<ContactProblem> contact_problems() {
  std::vector<ContactProblem> all;
  take_problems("box that slides", pile(1, 1, 1, 0.3), 4, all);
  for (const double friction : {0.0, 0.3, 0.8}) {
    take_problems("stack of 10", pile(1, 1, 10, friction), 6, all);
    take_problems("stack, each twice as heavy", pile(1, 1, 6, friction, 2.0), 6, all);
    take_problems("soft blocks", blocks(1e5, friction), 10, all);
    take_problems("stiff blocks", blocks(1e7, friction), 6, all);
    take_problems("rods on a drum", logs(4, friction), 10, all);
    take_problems("heap of 12", heap(12, friction), 10, all);
    take_problems("wall of 20", brief(wall(5, 4, friction)), 6, all);
    take_problems("heap of 20", heap(20, friction), 6, all);
    take_problems("pile of 27", brief(pile(3, 3, 3, friction)), 8, all);
  }
  take_problems("pile of 48", brief(pile(4, 4, 3, 0.5)), 4, all);
  take_problems("wall of 48", brief(wall(8, 6, 0.5), 0.02), 2, all);
  return all;
}

}  // namespace sinew::test
