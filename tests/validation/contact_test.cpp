// Exact cases of contact: slopes, stacks, bounces, tipping.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <tuple>

#include "sinew/lie/rotation.hpp"
#include "support/contacts.hpp"

namespace sinew {
namespace {

using test::box_of;
using test::end_of;
using test::kGravity;
using test::mm;
using test::no_mesh;
using test::on_floor;

TEST(Contact, BlockOnASlopeSticksOrSlidesWithTheRightAcceleration) {
  const double angle = 25.0 * std::numbers::pi / 180.0, limit = std::tan(angle);
  for (const double mu : {0.98 * limit, 1.02 * limit, 0.2, 0.0}) {
    Scene scene = on_floor(0.005, 0.5, mu);
    scene.gravity = kGravity * Vec3(std::sin(angle), 0, -std::cos(angle));
    scene.bodies.emplace_back("block", box_of(50 * mm, 0.1, Vec3(0, 0, 25 * mm)));
    const Model model = build(scene, no_mesh);
    double gained = 0.0;
    const State end = end_of(model, &gained);
    const double t = end.time, a = std::max(0.0, kGravity * (std::sin(angle) - mu * std::cos(angle)));
    // Backward Euler's sum: a h^2 n (n + 1) / 2.
    EXPECT_NEAR(end.bodies[0].p.x(), 0.5 * a * t * (t + 0.005), 1e-6 * (1.0 + a)) << "mu " << mu;
    EXPECT_NEAR(end.bodies[0].p.z(), 25 * mm, 1e-9);
    EXPECT_NEAR(end.bodies[0].v.x(), a * t, 1e-6 * (1.0 + a));
    EXPECT_LE(gained, 1e-12);
    EXPECT_EQ(end.contacts.size(), 4U);
    Vec3 force = Vec3::Zero();
    for (const ContactState& own : end.contacts) force += own.force;
    EXPECT_NEAR(force.z(), 0.1 * kGravity * std::cos(angle), 1e-8);
  }
}

TEST(Contact, StackedBoxesStay) {
  Scene scene = on_floor(0.01, 1.0, 0.5);
  for (int i = 0; i < 5; ++i)
    scene.bodies.emplace_back("box" + std::to_string(i), box_of(50 * mm, 0.1, Vec3(0, 0, (25 + 50 * i) * mm)));
  const Model model = build(scene, no_mesh);
  double gained = 0.0;
  const State end = end_of(model, &gained);
  for (int i = 0; i < 5; ++i) EXPECT_LT((end.bodies[i].p - model.bodies[i].start.p).norm(), 1e-6) << i;
  EXPECT_LE(gained, 1e-12);
}

TEST(Contact, HeavyOnLightHolds) {
  Scene scene = on_floor(0.01, 0.5, 0.5);
  scene.bodies.emplace_back("light", box_of(50 * mm, 0.001, Vec3(0, 0, 25 * mm)));
  scene.bodies.emplace_back("heavy", box_of(50 * mm, 10.0, Vec3(0, 0, 75 * mm)));
  const Model model = build(scene, no_mesh);
  const State end = end_of(model);
  for (int i = 0; i < 2; ++i) EXPECT_LT((end.bodies[i].p - model.bodies[i].start.p).norm(), 1e-6) << i;
}

TEST(Contact, BounceReachesRestitutionSquared) {
  for (const double h : {1e-3, 5e-4}) {
    Scene scene = on_floor(h, 1.2, 0.0);
    scene.contact.restitution = 0.7;
    RigidBody ball;
    ball.shape = SphereShape{20 * mm};
    ball.mass = 0.05;
    ball.pose.translate = Vec3(0, 0, 520 * mm);
    scene.bodies.emplace_back("ball", ball);
    const Model model = build(scene, no_mesh);
    double highest = 0.0, energy = energy_balance(model, initial_state(model)).total();
    bool hit = false;
    run(model, initial_state(model), [&](const State& state, const StepReport&) {
      const double now = energy_balance(model, state).total();
      EXPECT_LE(now, energy + 1e-12);
      energy = now;
      if (state.bodies[0].v.z() > 0.0) hit = true;
      if (hit && state.time < 0.9) highest = std::max(highest, state.bodies[0].p.z() - 20 * mm);
      return true;
    });
    EXPECT_NEAR(highest, 0.49 * 0.5, 10.0 * h * 0.5);
  }
}

/// The last step of a run, and what it was warned of.
struct LastStep {
  State before, after;
  std::vector<Warning> warnings;
};
LastStep last_step(const Scene& scene) {
  const Model model = build(scene, no_mesh);
  LastStep last;
  last.after = initial_state(model);
  const RunEnd end = run(model, last.after, [&](const State& state, const StepReport& report) {
    last.before = last.after;
    last.after = state;
    last.warnings = report.warnings;
    return true;
  });
  EXPECT_EQ(end, RunEnd::done);
  return last;
}

/// A body rolls along x. What it is told to be off by is what it is: the way that it turned beside the way it came.
void tells_how_far_rolling_is_off(const BodyShape& shape, const Vec3& rotate) {
  constexpr double kWheel = 10 * mm, kSpin = 20.0;
  for (const double angle : {0.1, 0.2, 0.3, 0.6}) {
    Scene scene = on_floor(angle / kSpin, 4 * angle / kSpin, 0.8);
    RigidBody body = box_of(kWheel, 0.1, Vec3(0, 0, kWheel));
    body.shape = shape;
    body.pose.rotate = rotate;
    body.velocity = Vec3(kSpin * kWheel, 0, 0);
    body.spin = Vec3(0, kSpin, 0);
    scene.bodies.emplace_back("wheel", body);
    const LastStep last = last_step(scene);
    const rigid::Motion &from = last.before.bodies[0], &to = last.after.bodies[0];
    const double turned = lie::log(to.R * from.R.transpose()).y(), came = to.p.x() - from.p.x();
    const double off = 1.0 - came / (kWheel * turned);
    const Warning* told = find_warning(last.warnings, "coarse_rolling");
    EXPECT_NEAR(turned, angle, 0.3 * angle);
    ASSERT_EQ(told != nullptr, off > 0.01) << angle << " rad a step, off by " << off;
    if (told) EXPECT_NEAR(told->value, off, 1e-6 + 1e-3 * off) << angle;
  }
}

TEST(Contact, TellsHowFarRollingIsOff) {
  constexpr double kRight = 0.5 * std::numbers::pi;
  for (const auto& [name, shape, rotate] :
       {std::tuple<const char*, BodyShape, Vec3>("sphere", SphereShape{10 * mm}, Vec3::Zero()),
        {"capsule", CapsuleShape{10 * mm, 30 * mm}, Vec3(kRight, 0, 0)},
        {"cylinder", CylinderShape{10 * mm, 30 * mm}, Vec3(kRight, 0, 0)}}) {
    SCOPED_TRACE(name);
    tells_how_far_rolling_is_off(shape, rotate);
  }
}

// A contact that turns with both objects is no rolling, however far they turn in a step.
TEST(Contact, WhatTurnsTogetherDoesNotRoll) {
  Scene scene = on_floor(0.01, 0.02, 20.0);  // (of 100, a contact that hardly presses slides within the tolerance)
  Frame hand;
  hand.motion = FrameMotion{{0.0, 0.02}, {Vec3::Zero(), Vec3(0.8, 0, 0)}, {}};
  scene.frames.emplace_back("hand", hand);
  scene.obstacles[0].second.shape = PlaneShape{Vec3(0, 0, -5 * mm), Vec3::UnitZ()};
  scene.obstacles[0].second.frame = "hand";
  Rod rod;
  rod.path = {Vec3(-10 * mm, 0, 0), Vec3(10 * mm, 0, 0)};
  rod.strains = {Strain::bending_y, Strain::bending_z};
  rod.section = Circle{5 * mm};
  rod.material = {1e9, 0.3, 1000.0};
  rod.base = {BaseAxis::z, BaseAxis::turn_x};
  scene.rods.emplace_back("held", rod);
  const LastStep last = last_step(scene);
  EXPECT_FALSE(last.after.contacts.empty());
  EXPECT_NEAR(last.after.rods[0].q[1] - last.before.rods[0].q[1], 0.4, 1e-5);
  EXPECT_EQ(find_warning(last.warnings, "coarse_rolling"), nullptr);
}

TEST(Contact, TallBoxTipsBeyondItsDiagonal) {
  // Width over height 1/3: it tips where the slope is steeper.
  for (const double slope : {0.32, 0.35}) {
    Scene scene = on_floor(0.005, 1.0, 2.0);
    const double angle = std::atan(slope);
    scene.gravity = kGravity * Vec3(std::sin(angle), 0, -std::cos(angle));
    RigidBody box = box_of(1.0, 0.1, Vec3(0, 0, 75 * mm));
    box.shape = BoxShape{Vec3(50 * mm, 50 * mm, 150 * mm)};
    scene.bodies.emplace_back("box", box);
    const Model model = build(scene, no_mesh);
    const State end = end_of(model);
    const double tilt = std::acos(std::clamp(end.bodies[0].R(2, 2), -1.0, 1.0));
    if (slope < 1.0 / 3.0) {
      EXPECT_LT(tilt, 1e-6);
    } else {
      EXPECT_GT(tilt, 0.5);
    }
  }
}

// A box tips over the edge of a table, its centre d beyond it and c above: it turns about the edge while it sticks,
// (I/m) theta'' = g (d cos theta + c sin theta). Rounding alone took one of the two points away on which it turns.
TEST(Contact, BoxTurnsAboutTheEdgeOfATable) {
  const double d = 1 * mm, c = 10 * mm;
  const double inertia = (0.06 * 0.06 + 0.02 * 0.02) / 12.0 + d * d + c * c;
  double theta = 0.0, rate = 0.0;
  const double short_step = 1e-6;
  for (int i = 0; i < 120000; ++i) {
    rate += short_step * kGravity * (d * std::cos(theta) + c * std::sin(theta)) / inertia;
    theta += short_step * rate;
  }
  const auto tilt = [&](double h) {
    Scene scene;
    scene.time = {h, 0.12};
    scene.gravity = Vec3(0, 0, -kGravity);
    scene.contact.friction = 1.0;
    Obstacle table;
    table.shape = BoxShape{Vec3(200 * mm, 200 * mm, 40 * mm)};
    table.pose.translate = Vec3(-100 * mm, 0, -20 * mm);
    scene.obstacles.emplace_back("table", table);
    RigidBody box = box_of(1.0, 0.05, Vec3(d, 50 * mm, c));
    box.shape = BoxShape{Vec3(60 * mm, 20 * mm, 20 * mm)};
    scene.bodies.emplace_back("box", box);
    const auto at = end_of(build(scene, no_mesh)).bodies[0];
    EXPECT_NEAR(at.p.y(), 50 * mm, 1e-9) << h;
    EXPECT_LT(std::abs(at.R(1, 0)), 1e-9) << h;
    return std::atan2(-at.R(2, 0), at.R(0, 0));
  };
  const double half_step = tilt(5e-4), step = tilt(1e-3);
  EXPECT_NEAR(2.0 * half_step - step, theta, 2e-3 * theta);
  for (const double h : {2e-3, 5e-3, 1e-2}) EXPECT_NEAR(tilt(h), theta, 25.0 * h * theta) << h;
}

// Between the four points on which it stands a coin that tips by phi would sink in by R (1 - cos(45 deg)) phi.
TEST(Contact, CoinTipsInAnyDirection) {
  for (const double angle : {0.0, 30.0, 45.0, 100.0}) {
    Scene scene = on_floor(2e-3, 2e-3, 0.5);
    RigidBody coin = box_of(0.0, 0.05, Vec3(0, 0, 5 * mm));
    coin.shape = CylinderShape{20 * mm, 10 * mm};
    coin.spin = 2.0 * Vec3(std::cos(angle * std::numbers::pi / 180.0), std::sin(angle * std::numbers::pi / 180.0), 0);
    coin.velocity = Vec3(0, 0, 2.0 * 20 * mm);  // it turns about a point of its rim
    scene.bodies.emplace_back("coin", coin);
    const rigid::Motion at = end_of(build(scene, no_mesh)).bodies[0];
    const Vec3 axis = at.R.col(2);
    EXPECT_GT(std::acos(axis.z()), 1e-3) << angle;  // it tips
    const double lowest = at.p.z() - 5 * mm * axis.z() - 20 * mm * std::hypot(axis.x(), axis.y());
    EXPECT_NEAR(lowest, 0.0, 1e-9) << angle;
  }
}

TEST(Contact, FastBallStopsAtAThinPlate) {
  Scene scene = on_floor(0.01, 0.2, 0.5);
  Obstacle plate;
  plate.shape = BoxShape{Vec3(200 * mm, 200 * mm, 2 * mm)};
  plate.pose.translate = Vec3(0, 0, 300 * mm);
  scene.obstacles.emplace_back("plate", plate);
  for (const double x : {-50 * mm, 50 * mm}) {
    RigidBody body = box_of(10 * mm, 0.01, Vec3(x, 0, 450 * mm));
    if (x > 0.0) body.shape = SphereShape{5 * mm};
    body.velocity = Vec3(0, 0, -10.0);  // 100 mm in a step
    scene.bodies.emplace_back(x > 0.0 ? "ball" : "box", body);
  }
  const Model model = build(scene, no_mesh);
  const State end = end_of(model);
  for (const rigid::Motion& own : end.bodies) EXPECT_NEAR(own.p.z(), 306 * mm, 1e-6);
}

TEST(Contact, WhatStartsInTheGroundIsLiftedGently) {
  Scene scene = on_floor(0.005, 1.0, 0.5);
  const double depth = 5 * mm;
  scene.bodies.emplace_back("box", box_of(50 * mm, 0.1, Vec3(0, 0, 25 * mm - depth)));
  const Model model = build(scene, no_mesh);
  ASSERT_EQ(model.warnings.size(), 1U);
  EXPECT_EQ(to_string(model.warnings[0]).find("contact: floor and box overlap by 5 mm"), 0U)
      << to_string(model.warnings[0]);
  double fastest = 0.0, highest = -INFINITY;
  State last;
  run(model, initial_state(model), [&](const State& state, const StepReport&) {
    fastest = std::max(fastest, state.bodies[0].v.norm());
    highest = std::max(highest, state.bodies[0].p.z());
    last = state;
    return true;
  });
  EXPECT_LT(fastest, std::sqrt(2.0 * kGravity * depth));
  EXPECT_LT(highest, 25 * mm + 1e-4);
  EXPECT_NEAR(last.bodies[0].p.z(), 25 * mm, 1e-5);
  EXPECT_LT(last.bodies[0].v.norm(), 1e-3);
}

/// A coin that falls on its edge comes to lie flat. Its lowest point jumped round the rim as rounding tipped it.
TEST(Contact, CoinsComeToLieFlat) {
  for (const double friction : {0.0, 0.3}) {
    for (const double h : {0.02, 0.01}) {
      SCOPED_TRACE(testing::Message() << "friction " << friction << ", step " << h);
      Scene scene = on_floor(h, 0.8, friction);
      RigidBody coin;
      coin.shape = CylinderShape{12 * mm, 6 * mm};
      coin.density = 630.0;
      coin.pose = {Vec3(60.0, 10.0, 0.0) * std::numbers::pi / 180.0, Vec3(0, 0, 20 * mm)};
      coin.velocity = Vec3(0.3, 0.1, 0.0);
      coin.spin = Vec3(2.0, 0.0, 8.0);
      scene.bodies.emplace_back("coin", coin);
      const State end = end_of(build(scene, no_mesh));
      EXPECT_NEAR(end.bodies[0].p.z(), 3 * mm, 1e-6);
      EXPECT_NEAR(std::abs(end.bodies[0].R(2, 2)), 1.0, 1e-6);
    }
  }
}

/// Without gravity a fiftieth of the depth in a step, and of that a part in a part of the step.
TEST(Contact, PartsOfStepsLiftAtTheSameSpeed) {
  Scene scene = on_floor(0.005, 1.0, 0.5);
  scene.gravity.setZero();
  const double depth = 5 * mm;
  scene.bodies.emplace_back("box", box_of(50 * mm, 0.1, Vec3(0, 0, 25 * mm - depth)));
  const Model model = build(scene, no_mesh);
  for (const double part : {1.0, 0.1, 1e-3}) {
    Workspace workspace = make_workspace(model);
    State state = initial_state(model);
    ASSERT_TRUE(accepted(step(model, workspace, command_at(model, 0.0), part * 0.005, state).status)) << part;
    EXPECT_NEAR(state.bodies[0].v.z(), 0.02 * depth / 0.005, 1e-6) << part;
  }
}

TEST(Contact, SolidBlockRestsOnThePlane) {
  Scene scene = on_floor(0.01, 0.5, 0.5);
  Solid block;
  block.mesh = "block";
  block.material.law = solid::corotational(100e3, 0.3);
  block.density = 1000.0;
  block.rayleigh = {5.0, 0.01};
  block.pose.translate = Vec3(0, 0, 1 * mm);
  scene.solids.emplace_back("block", block);
  const Model model =
      build(scene, [](const std::filesystem::path&) { return test::block_mesh(3, 3, 3, Vec3::Constant(60 * mm)); });
  const State end = end_of(model);
  EXPECT_GT(end.solids[0].x.row(2).minCoeff(), -1e-9);
  Vec3 force = Vec3::Zero();
  for (const ContactState& own : end.contacts) force += own.force;
  EXPECT_NEAR(force.z(), 1000.0 * std::pow(60 * mm, 3) * kGravity, 2e-2);
}

}  // namespace
}  // namespace sinew
