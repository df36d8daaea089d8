// Hertz's contact of a sphere and an elastic half-space (K. L. Johnson, Contact Mechanics, 1985, section 4.2):
//     a^2 = R d,   F = 4/3 E / (1 - nu^2) R^1/2 d^3/2.
#include <gtest/gtest.h>

#include <cmath>

#include "support/scenes.hpp"

namespace sinew {
namespace {

using test::mm;

constexpr double kBall = 20 * mm, kDepth = 0.05 * mm, kYoung = 1e6, kPoisson = 0.3;
const double kContact = std::sqrt(kBall * kDepth);  // 1 mm

/// A quarter of a block, 40 contact radii wide and deep from the point of contact at the origin, z up. Cells are a
/// sixth of the radius there and grow outwards.
solid::Mesh quarter(const std::filesystem::path&) {
  constexpr int kFine = 8, kCoarse = 9;
  solid::Mesh mesh = test::block_mesh(kFine + kCoarse, kFine + kCoarse, kFine + kCoarse,
                                      Vec3::Constant(kFine + kCoarse), solid::Kind::hex8);
  const double cell = kContact / 6.0, reach = 40.0 * kContact;
  const auto series = [](double growth) { return growth * (std::pow(growth, kCoarse) - 1.0) / (growth - 1.0); };
  double growth = 1.01, most = 2.0;  // such that the cells fill the block
  while (most - growth > 1e-12) {
    const double middle = 0.5 * (growth + most);
    (series(middle) > reach / cell - kFine ? most : growth) = middle;
  }
  const auto place = [&](double number) {
    if (number <= kFine) return number * cell;
    const double more = number - kFine;
    return cell * (kFine + growth * (std::pow(growth, more) - 1.0) / (growth - 1.0));
  };
  for (Eigen::Index n = 0; n < mesh.nodes.cols(); ++n) {
    auto x = mesh.nodes.col(n);
    x = Vec3(place(x.x()), place(x.y()), place(x.z()));
  }
  return mesh;
}

TEST(Hertz, BallOnABlock) {
  Scene scene;
  scene.time = {1000.0, 4000.0};  // so slow that inertia is nothing
  scene.contact.friction = 0.0;
  Frame press;
  press.motion = FrameMotion{{0.0, 4000.0}, {}, {Vec3::Zero(), Vec3(0, 0, kDepth)}};
  scene.frames.emplace_back("press", press);
  Obstacle ball;
  ball.shape = SphereShape{kBall};
  ball.pose.translate = Vec3(0, 0, -kBall);
  ball.frame = "press";
  scene.obstacles.emplace_back("ball", ball);
  Solid block;  // upside down: its surface at z = 0, the ball comes from below
  block.mesh = "quarter";
  block.material.law = solid::corotational(kYoung, kPoisson);
  block.density = 1000.0;
  const double far = 40.0 * kContact;
  block.fixed.push_back({Box{Vec3(-1, -1, far - 1e-6), Vec3(1, 1, 1)}});
  block.fixed.push_back({Box{Vec3(-1e-6, -1, -1), Vec3(1e-6, 1, 1)}, {true, false, false}});
  block.fixed.push_back({Box{Vec3(-1, -1e-6, -1), Vec3(1, 1e-6, 1)}, {false, true, false}});
  scene.solids.emplace_back("block", block);
  const Model model = build(scene, quarter);
  const test::Trace trace = test::run_all(model);
  ASSERT_EQ(trace.end, RunEnd::done) << to_string(trace.failure.status);
  for (const State& state : trace.states) {
    const double depth = kDepth * state.time / 4000.0;
    if (depth < 0.4 * kDepth) continue;  // with few nodes in contact
    double force = 0.0, widest = 0.0;
    for (const ContactState& own : state.contacts) {
      force += std::abs(own.force.z());
      widest = std::max(widest, own.point.head<2>().norm());
    }
    const double expected =
        0.25 * 4.0 / 3.0 * kYoung / (1.0 - kPoisson * kPoisson) * std::sqrt(kBall) * std::pow(depth, 1.5);
    EXPECT_NEAR(force, expected, 0.05 * expected) << depth;
    EXPECT_NEAR(widest, std::sqrt(kBall * depth), 0.2 * kContact) << depth;
  }
}

}  // namespace
}  // namespace sinew
