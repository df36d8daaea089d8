// Rigid bodies that carry nodes of solids, and hold points of rods.
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>

#include "sinew/error/input_error.hpp"
#include "support/scenes.hpp"

namespace sinew {
namespace {

using test::mm;

constexpr double g = 9.81;

solid::Mesh beam(const std::filesystem::path&) { return test::block_mesh(12, 3, 3, Vec3(60 * mm, 10 * mm, 10 * mm)); }

Solid soft_beam() {
  Solid solid;
  solid.mesh = "beam";
  solid.material.law = solid::corotational(1e6, 0.4);
  solid.density = 1000.0;
  return solid;
}

RigidBody plate(double mass, const Vec3& at) {
  RigidBody body;
  body.shape = BoxShape{Vec3(4 * mm, 20 * mm, 20 * mm)};
  body.mass = mass;
  body.pose.translate = at;
  return body;
}

/// A beam with a plate on its end at x = 60 mm.
Scene beam_with_plate(double mass) {
  Scene scene;
  scene.gravity = Vec3(0, 0, -g);
  scene.solids.emplace_back("beam", soft_beam());
  scene.bodies.emplace_back("plate", plate(mass, Vec3(62 * mm, 5 * mm, 5 * mm)));
  scene.couplings.emplace_back(Glue{"beam", "plate", Plane{Vec3(60 * mm, 0, 0), Vec3::UnitX()}});
  return scene;
}

TEST(Glue, PlateOnABeamHangsAsItsWeightAndLeverSay) {
  Scene scene = beam_with_plate(0.01);
  scene.analysis = Analysis::statics;
  scene.time = {1.0, 1.0};
  scene.solids[0].second.fixed.push_back({Plane{Vec3::Zero(), Vec3::UnitX()}});
  const Model model = build(scene, beam);
  EXPECT_TRUE(model.pairs.empty());
  const test::Trace trace = test::run_all(model);
  ASSERT_EQ(trace.end, RunEnd::done) << to_string(trace.failure.status) << trace.failure.detail;
  const State& end = trace.states.back();
  Vec3 reaction = Vec3::Zero();
  for (Eigen::Index i = 0; i < end.solids[0].reaction.size(); ++i) reaction[i % 3] += end.solids[0].reaction[i];
  const double weight = (0.01 + model.solids[0].body.masses.sum()) * g;
  EXPECT_LT((reaction - Vec3(0, 0, weight)).norm(), 1e-6 * weight);
  // Its nodes are where the plate carries them.
  const rigid::Motion& own = end.bodies[0];
  int glued = 0;
  for (int node = 0; node < model.solids[0].body.nodes(); ++node) {
    const Vec3 X = model.solids[0].body.rest.col(node);
    if (X.x() < 59.9 * mm) continue;
    ++glued;
    EXPECT_LT((end.solids[0].x.col(node) - (own.p + own.R * (X - Vec3(62 * mm, 5 * mm, 5 * mm)))).norm(), 1e-9);
  }
  EXPECT_EQ(glued, 16);
  EXPECT_LT(own.p.z(), 5 * mm - 1 * mm);
  EXPECT_LT(own.R(2, 0), -0.01);  // it turns with the beam's end
  // What holds the plate carries its weight at its centre: forces and moments of the glue balance it.
  Vec3 force = Vec3::Zero(), moment = Vec3::Zero();
  for (const SolidRow& row : model.solid_rows) {
    const Vec3 lambda = end.lambda.segment<3>(row.row);
    force -= lambda;
    moment -= (own.R * row.arm).cross(lambda);
  }
  EXPECT_LT((force - Vec3(0, 0, 0.01 * g)).norm(), 1e-6 * 0.01 * g);
  EXPECT_LT(moment.norm(), 1e-6 * 0.01 * g * 60 * mm);
}

TEST(Glue, FreeFlightKeepsMomentumAndNewtonIsQuick) {
  Scene scene = beam_with_plate(0.02);
  scene.gravity.setZero();
  scene.time = {0.002, 0.1};
  scene.solids[0].second.rayleigh = {0.0, 0.002};
  scene.bodies[0].second.velocity = Vec3(0.2, -0.1, 0.4);
  scene.bodies[0].second.spin = Vec3(3, 20, -8);
  const Model model = build(scene, beam);
  const test::Trace trace = test::run_all(model);
  ASSERT_EQ(trace.end, RunEnd::done) << to_string(trace.failure.status);
  const Vec3 before = 0.02 * Vec3(0.2, -0.1, 0.4);
  for (std::size_t i = 1; i < trace.states.size(); ++i) {
    const State& state = trace.states[i];
    const Vec3 now = 0.02 * state.bodies[0].v + state.solids[0].v * model.solids[0].body.masses;
    EXPECT_LT((now - before).norm(), 1e-7 * before.norm());
    EXPECT_LE(trace.reports[i - 1].newton, 6) << i;
  }
}

/// Whatever the order of couplings: what is glued and what ties follow on a solid are numbered apart.
TEST(Glue, OrderOfCouplingsDoesNotMatter) {
  std::vector<Vec3> ends;
  for (const bool first : {true, false}) {
    Scene scene = beam_with_plate(0.01);
    scene.analysis = Analysis::statics;
    scene.time = {1.0, 1.0};
    scene.solids[0].second.fixed.push_back({Plane{Vec3::Zero(), Vec3::UnitX()}});
    Rod rod;
    rod.path = {Vec3(30 * mm, 5 * mm, 10 * mm), Vec3(30 * mm, 5 * mm, 60 * mm)};
    rod.sections = 4;
    rod.section = Circle{2 * mm};
    rod.material = {1e8, 0.4, 1100.0};
    rod.base = {BaseAxis::x, BaseAxis::y, BaseAxis::z, BaseAxis::turn_x, BaseAxis::turn_y, BaseAxis::turn_z};
    scene.rods.emplace_back("mast", rod);
    Tie tie;
    tie.rod = "mast";
    tie.at = 0.0;
    tie.solid = "beam";
    tie.about = {true, true, true};
    ContactPair off;
    off.first = "mast";
    off.second = "plate";
    off.off = true;
    scene.contact.pairs.push_back(off);
    scene.couplings.insert(first ? scene.couplings.begin() : scene.couplings.end(), tie);
    const Model model = build(scene, beam);
    const test::Trace trace = test::run_all(model);
    ASSERT_EQ(trace.end, RunEnd::done) << to_string(trace.failure.status) << trace.failure.detail;
    ends.push_back(trace.states.back().bodies[0].p);
  }
  EXPECT_LT(ends[0].z(), 5 * mm - 1 * mm);
  EXPECT_LT((ends[0] - ends[1]).norm(), 1e-9);
}

TEST(Glue, NamesWhatItDoesNotFind) {
  Scene scene = beam_with_plate(0.01);
  std::get<Glue>(scene.couplings[0]).body = "disc";
  EXPECT_THROW(build(scene, beam), InputError);
  scene = beam_with_plate(0.01);
  scene.solids[0].second.fixed.push_back({Plane{Vec3(60 * mm, 0, 0), Vec3::UnitX()}});
  EXPECT_THROW(build(scene, beam), InputError);
  scene = beam_with_plate(0.01);
  scene.couplings.push_back(scene.couplings[0]);
  EXPECT_THROW(build(scene, beam), InputError);
}

Scene rod_with_disc(double mass, const Vec3& offset) {
  Scene scene;
  scene.analysis = Analysis::statics;
  scene.time = {1.0, 1.0};
  scene.gravity = Vec3(0, 0, -g);
  Rod rod;
  rod.path = {Vec3::Zero(), Vec3(0.2, 0, 0)};
  rod.sections = 10;
  rod.section = Circle{2 * mm};
  rod.material = {1e9, 0.4, 1100.0};
  scene.rods.emplace_back("rod", rod);
  if (mass > 0.0) {
    scene.bodies.emplace_back("disc", plate(mass, Vec3(0.2, 0, 0) + offset));
    Tie tie;
    tie.rod = "rod";
    tie.body = "disc";
    tie.about = {true, true, true};
    scene.couplings.emplace_back(tie);
  }
  Output tip;
  tip.rod = "rod";
  scene.outputs.emplace_back("tip", tip);
  return scene;
}

TEST(Tie, DiscAtTheTipOfARodIsAForceAndItsLever) {
  const double mass = 0.05;
  const Vec3 offset(10 * mm, 0, -15 * mm);
  const Model model = build(rod_with_disc(mass, offset), beam);
  const test::Trace trace = test::run_all(model);
  ASSERT_EQ(trace.end, RunEnd::done) << to_string(trace.failure.status) << trace.failure.detail;
  const rigid::Motion& disc = trace.states.back().bodies[0];
  const Vec3 tip = test::tip(model, trace.states.back());
  EXPECT_LT(tip.z(), -20 * mm);
  EXPECT_LT((tip + disc.R * offset - disc.p).norm(), 1e-9);
  // The same with a force and the moment that it has about the tip where the disc ends.
  Scene other = rod_with_disc(0.0, offset);
  RodLoad load;
  load.rod = "rod";
  load.force = Vec3(0, 0, -mass * g);
  load.moment = (disc.p - tip).cross(Vec3(0, 0, -mass * g));
  other.loads.emplace_back("disc", load);
  const Model plain = build(other, beam);
  const test::Trace expected = test::run_all(plain);
  ASSERT_EQ(expected.end, RunEnd::done) << to_string(expected.failure.status);
  EXPECT_LT((tip - test::tip(plain, expected.states.back())).norm(), 1e-6 * 0.2);
}

TEST(Tie, DiscAtTheTipOfARodSwingsWithItsMass) {
  Scene scene = rod_with_disc(1.0, Vec3::Zero());
  scene.gravity.setZero();
  scene.analysis = Analysis::modal;
  scene.modes = 2;
  scene.bodies[0].second.shape = SphereShape{1 * mm};
  scene.rods[0].second.material.density = 1.0;
  const Model model = build(scene, beam);
  const test::Trace trace = test::run_all(model);
  ASSERT_EQ(trace.end, RunEnd::done) << to_string(trace.failure.status) << trace.failure.detail;
  const double EI = 1e9 * std::numbers::pi / 4.0 * std::pow(2 * mm, 4);
  const double expected = std::sqrt(3.0 * EI / std::pow(0.2, 3)) / (2.0 * std::numbers::pi);
  EXPECT_NEAR(trace.states[1].frequency, expected, 5e-3 * expected);  // ten sections of constant curvature
}

}  // namespace
}  // namespace sinew
