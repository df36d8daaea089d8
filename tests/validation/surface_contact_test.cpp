// Contact between what bends: solids with solids, rods and themselves; and what holds for every contact.
#include <gtest/gtest.h>

#include <cmath>

#include "support/scenes.hpp"

namespace sinew {
namespace {

using test::mm;

constexpr double kGravity = 9.81;

Scene falling(double duration) {
  Scene scene;
  scene.time = {0.01, duration};
  scene.gravity = Vec3(0, 0, -kGravity);
  return scene;
}

Solid rubber(const std::string& mesh, const Vec3& at) {
  Solid solid;
  solid.mesh = mesh;
  solid.material.law = solid::corotational(100e3, 0.3);
  solid.density = 1000.0;
  solid.rayleigh = {5.0, 0.01};
  solid.pose.translate = at;
  return solid;
}

void meet(Scene& scene, const std::string& first, const std::string& second) {
  ContactPair pair;
  pair.first = first;
  pair.second = second;
  scene.contact.pairs.push_back(pair);
}

/// "wide" is a slab of 60 x 60 x 20 mm, "small" a block of 30 x 30 x 20 mm whose nodes do not match it; "fork" a bar of
/// 60 x 10 x 15 mm with a slot of 5 mm between two arms.
solid::Mesh read(const std::filesystem::path& name) {
  if (name == "wide") return test::block_mesh(6, 6, 2, Vec3(60 * mm, 60 * mm, 20 * mm));
  if (name == "small") return test::block_mesh(4, 4, 2, Vec3(30 * mm, 30 * mm, 20 * mm));
  solid::Mesh fork = test::block_mesh(12, 2, 3, Vec3(60 * mm, 10 * mm, 15 * mm));
  std::erase_if(fork.cells, [&](const solid::Cell& cell) {
    const Vec3 middle = solid::cell_nodes(fork.nodes, cell).rowwise().mean();
    return middle.x() > 10 * mm && middle.z() > 5 * mm && middle.z() < 10 * mm;
  });
  return fork;
}

struct Sum {
  Vec3 force = Vec3::Zero();
  double gap = 0.0;
};

/// Force on the first of a pair, and the least gap.
Sum sum_of(const Model& model, const State& state, int pair) {
  Sum sum;
  for (const ContactState& own : state.contacts) {
    if (own.pair != pair) continue;
    sum.force += own.a.on == model.pairs[pair].a ? own.force : Vec3(-own.force);
    sum.gap = std::min(sum.gap, own.gap);
  }
  return sum;
}

TEST(SurfaceContact, SoftBlockRestsOnASoftSlab) {
  Scene scene = falling(1.0);
  Solid slab = rubber("wide", Vec3::Zero());
  slab.fixed.push_back({Box{Vec3::Constant(-1.0), Vec3(1, 1, 1 * mm)}});
  scene.solids.emplace_back("slab", slab);
  scene.solids.emplace_back("block", rubber("small", Vec3(13 * mm, 17 * mm, 20.5 * mm)));
  meet(scene, "block", "slab");
  const Model model = build(scene, read);
  ASSERT_EQ(model.pairs.size(), 1u);
  const test::Trace trace = test::run_all(model);
  ASSERT_EQ(trace.end, RunEnd::done) << to_string(trace.failure.status);
  const double weight = 1000.0 * 30 * 30 * 20 * 1e-9 * kGravity;
  const Sum on_slab = sum_of(model, trace.states.back(), 0);
  EXPECT_NEAR(on_slab.force.z(), -weight, 0.02 * weight);
  EXPECT_LT(on_slab.force.head<2>().norm(), 0.02 * weight);
  for (const State& state : trace.states) EXPECT_GT(sum_of(model, state, 0).gap, -1e-8);
  EXPECT_GT(trace.states.back().solids[1].x.row(2).minCoeff(), 19 * mm);
}

TEST(SurfaceContact, ArmsOfAForkStopEachOther) {
  for (const bool wanted : {false, true}) {
    Scene scene = falling(0.5);
    scene.gravity.setZero();
    Solid fork = rubber("fork", Vec3::Zero());
    fork.fixed.push_back({Box{Vec3::Constant(-1.0), Vec3(1 * mm, 1, 1)}});
    scene.solids.emplace_back("fork", fork);
    for (const double side : {-1.0, 1.0}) {
      SolidLoad press;
      press.solid = "fork";
      const double z = side > 0.0 ? 15 * mm : 0.0;
      press.region = {Box{Vec3(55 * mm, -1, z - 0.1 * mm), Vec3(1, 1, z + 0.1 * mm)}};
      press.force = Vec3(0, 0, -side * 0.05);
      press.factor = Table{{0.0, 0.2}, {0.0, 1.0}};
      scene.loads.emplace_back(side > 0.0 ? "down" : "up", press);
    }
    if (wanted) meet(scene, "fork", "fork");
    const Model model = build(scene, read);
    const test::Trace trace = test::run_all(model);
    ASSERT_EQ(trace.end, RunEnd::done) << to_string(trace.failure.status);
    const Eigen::Matrix3Xd &x = trace.states.back().solids[0].x, &rest = model.solids[0].body.rest;
    // Nodes at the ends of the arms, across from each other.
    double least = INFINITY, most = -INFINITY;
    for (const double y : {0.0, 5 * mm, 10 * mm}) {
      const auto height = [&](double z) {
        Eigen::Index node = 0;
        (rest.colwise() - Vec3(60 * mm, y, z)).colwise().squaredNorm().minCoeff(&node);
        return x(2, node);
      };
      least = std::min(least, height(10 * mm) - height(5 * mm));
      most = std::max(most, height(10 * mm) - height(5 * mm));
    }
    if (wanted) {
      EXPECT_GT(least, -0.01 * mm);
      EXPECT_LT(most, 0.01 * mm);
      EXPECT_FALSE(trace.states.back().contacts.empty());
    } else {
      EXPECT_LT(most, -1.0 * mm);
    }
  }
}

Rod bar(const Vec3& from, const Vec3& to) {
  Rod rod;
  rod.path = {from, to};
  rod.sections = 10;
  rod.section = Circle{2 * mm};
  rod.material = {1e6, 0.4, 1000.0, 100.0};
  return rod;
}

TEST(SurfaceContact, RodsLieOnEachOtherAndOnASolid) {
  // A free rod falls across two that stick out of a wall, then the same onto a slab.
  const std::vector<BaseAxis> free{BaseAxis::x,      BaseAxis::y,      BaseAxis::z,
                                   BaseAxis::turn_x, BaseAxis::turn_y, BaseAxis::turn_z};
  const double weight = 1000.0 * M_PI * 4e-6 * 60 * mm * kGravity;
  for (const bool on_slab : {false, true}) {
    Scene scene = falling(1.0);
    Rod above = bar(Vec3(0, 30 * mm, 23 * mm), Vec3(60 * mm, 30 * mm, 23 * mm));
    above.base = free;
    if (on_slab) {
      Solid slab = rubber("wide", Vec3(-5 * mm, 0, 0));
      slab.fixed.push_back({Box{Vec3::Constant(-1.0), Vec3(1, 1, 1 * mm)}});
      scene.solids.emplace_back("slab", slab);
      meet(scene, "above", "slab");
    } else {
      for (const double x : {11 * mm, 47 * mm}) {
        const std::string name = x < 30 * mm ? "left" : "right";
        Rod below = bar(Vec3(x, 0, 18 * mm), Vec3(x, 60 * mm, 18 * mm));
        below.material.young = 1e8;
        scene.rods.emplace_back(name, below);
        meet(scene, "above", name);
      }
    }
    scene.rods.emplace_back("above", above);
    const Model model = build(scene, read);
    const test::Trace trace = test::run_all(model);
    ASSERT_EQ(trace.end, RunEnd::done) << to_string(trace.failure.status);
    double carried = 0.0;
    for (std::size_t p = 0; p < model.pairs.size(); ++p) {
      const Sum sum = sum_of(model, trace.states.back(), static_cast<int>(p));
      carried += std::abs(sum.force.z());
      for (const State& state : trace.states) EXPECT_GT(sum_of(model, state, static_cast<int>(p)).gap, -1e-7);
    }
    EXPECT_NEAR(carried, weight, 0.03 * weight) << on_slab;
  }
}

/// Of everything [N s].
Vec3 momentum(const Model& model, const State& state) {
  Vec3 sum = Vec3::Zero();
  for (std::size_t i = 0; i < model.bodies.size(); ++i) sum += model.bodies[i].body.mass * state.bodies[i].v;
  for (std::size_t i = 0; i < model.solids.size(); ++i) sum += state.solids[i].v * model.solids[i].body.masses;
  return sum;
}

RigidBody cube(double edge, double mass, const Vec3& at) {
  RigidBody body;
  body.shape = BoxShape{Vec3::Constant(edge)};
  body.mass = mass;
  body.pose.translate = at;
  return body;
}

TEST(SurfaceContact, ForcesAreEqualAndOppositeAndTakeNoMoreEnergyThanThereIs) {
  Scene scene = falling(0.3);
  scene.time.step = 0.002;
  scene.gravity.setZero();
  scene.solids.emplace_back("block", rubber("small", Vec3(-15 * mm, -15 * mm, -10 * mm)));
  scene.solids[0].second.rayleigh = {0.0, 0.005};
  scene.bodies.emplace_back("hammer", cube(10 * mm, 0.02, Vec3(3 * mm, 2 * mm, 17 * mm)));
  scene.bodies[0].second.velocity = Vec3(0.1, 0, -0.5);
  scene.bodies[0].second.pose.rotate = {0.3, 0.2, 0.1};
  const Model model = build(scene, read);
  const test::Trace trace = test::run_all(model);
  ASSERT_EQ(trace.end, RunEnd::done) << to_string(trace.failure.status);
  const Vec3 before = momentum(model, trace.states[0]);
  double energy = energy_balance(model, trace.states[0]).total();
  bool touched = false;
  for (const State& state : trace.states) {
    touched |= !state.contacts.empty();
    EXPECT_LT((momentum(model, state) - before).norm(), 1e-9 * before.norm());
    const double now = energy_balance(model, state).total();
    EXPECT_LE(now, energy + 1e-9 * energy);
    energy = now;
  }
  EXPECT_TRUE(touched);
}

}  // namespace
}  // namespace sinew
