// Contact between solids; and what holds for every contact.
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

/// "wide" is a slab of 60 x 60 x 20 mm, "small" a block of 30 x 30 x 20 mm whose nodes do not match it.
solid::Mesh read(const std::filesystem::path& name) {
  if (name == "wide") return test::block_mesh(6, 6, 2, Vec3(60 * mm, 60 * mm, 20 * mm));
  return test::block_mesh(4, 4, 2, Vec3(30 * mm, 30 * mm, 20 * mm));
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
  slab.fixed = {{Box{Vec3::Constant(-1.0), Vec3(1, 1, 1 * mm)}}};
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
