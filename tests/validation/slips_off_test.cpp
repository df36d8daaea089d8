// A ball that slips off an edge: when it does, at which force, and what that sets free.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <string>
#include <vector>

#include "support/recorded_run.hpp"
#include "validation/rods.hpp"

namespace sinew::test {
namespace {

RecordedRun run(const std::string& name, const std::vector<std::string>& changes = {}) {
  return run_file(std::filesystem::path(SINEW_SOURCE_DIR) / "tests/validation/faults" / (name + ".yaml"), changes);
}

using Vec2 = Eigen::Vector2d;

/// A clamped elastica in a plane under a force on its end, which is given by its angle to the end's tangent: with the
/// moment 0 at the end, the balance m(s) = (p(L) - p(s)) x F and kappa = m / B are integrated from the end to the base
/// (Runge-Kutta), and the whole is turned so that the base lies along x.
struct Elastica {
  Vec2 end, force;
};
Elastica elastica(double length, double bending, double force, double angle) {
  const Vec2 f = force * Vec2(std::cos(angle), std::sin(angle));
  const auto slope = [&](const Eigen::Vector3d& at) {  // of x, y and the tangent's angle, over the way to the base
    return Eigen::Vector3d(-std::cos(at[2]), -std::sin(at[2]), (at[0] * f.y() - at[1] * f.x()) / bending);
  };
  constexpr int kSteps = 400;
  const double h = length / kSteps;
  Eigen::Vector3d at = Eigen::Vector3d::Zero();
  for (int i = 0; i < kSteps; ++i) {
    const Eigen::Vector3d k1 = slope(at), k2 = slope(at + h / 2 * k1), k3 = slope(at + h / 2 * k2),
                          k4 = slope(at + h * k3);
    at += h / 6 * (k1 + 2 * k2 + 2 * k3 + k4);
  }
  const Eigen::Rotation2Dd turn(-at[2]);
  return {turn * Vec2(-at.head<2>()), turn * f};
}

/// The lowest place of the ball at which it can still be in equilibrium with the cantilever.
struct SlipsOff {
  double height = 0.0, force = 0.0, energy = 0.0;
};

/// A ball of radius R touches the round end (r) of the cantilever, and pushes it by F from its centre
/// c = p - (R + r) F / |F|. For each size of F, its direction is the one that leaves c_x at x; c_z falls as F grows, up
/// to where the ball slips off. The elastic energy is the work of the ball: F_z over c_z.
SlipsOff path_of_equilibria(double x, double reach, double length, double bending) {
  const auto centre = [&](const Elastica& shape) { return Vec2(shape.end - reach * shape.force.normalized()); };
  SlipsOff here{std::sqrt(reach * reach - (x - length) * (x - length)), 0.0, 0.0};
  double angle = std::atan2(-here.height, length - x), pushed = 0.0;
  const double more = 0.005 * bending / (length * length);
  for (double force = more;; force += more) {
    for (int iteration = 0; iteration < 8; ++iteration) {
      const double off = centre(elastica(length, bending, force, angle)).x() - x;
      const double moved = centre(elastica(length, bending, force, angle + 1e-7)).x() - x;
      angle -= 1e-7 * off / (moved - off);
    }
    const Elastica shape = elastica(length, bending, force, angle);
    const double height = centre(shape).y();
    if (height > here.height) return here;
    here = {height, force, here.energy + 0.5 * (pushed + shape.force.y()) * (height - here.height)};
    pushed = shape.force.y();
  }
}

TEST(SlipsOff, a_ball_leaves_the_end_of_a_rod_where_the_path_of_equilibria_ends) {
  const double radius = 2e-3, bending = 10e6 * pi * std::pow(radius, 4) / 4.0;
  for (const double x : {0.102, 0.105}) {
    const SlipsOff expected = path_of_equilibria(x, 12e-3, 0.1, bending);
    const double time = (13e-3 - expected.height) / 0.1;  // [s], as the ball goes down by 100 mm/s
    for (const double step : {0.01, 0.002}) {
      SCOPED_TRACE(testing::Message() << "ball at " << x << ", step " << step);
      const RecordedRun pressed = run(
          "slips_off",
          {"time.step=" + std::to_string(step), "obstacles.ball.pose.translate=[" + std::to_string(x) + ", 0, 13 mm]"});
      ASSERT_TRUE(pressed.done()) << pressed.why();
      const Warning* told = pressed.warning("snapped");
      ASSERT_TRUE(told);
      EXPECT_EQ(told->where, "rods.cantilever");
      EXPECT_NEAR(told->time, time, 0.1 * step);
      EXPECT_LT(pressed.largest("f.normal"), expected.force);
      EXPECT_NEAR(pressed.last("energy.dissipated"), expected.energy, 0.01 * expected.energy);
      EXPECT_NEAR(pressed.last("tip.z"), 0.0, 1e-9);
      EXPECT_EQ(pressed.last("f.contacts"), 0.0);
      EXPECT_FALSE(pressed.warning("unstable"));
    }
  }
}

// The corner of a solid, at rest and in motion that is damped and slow.
TEST(SlipsOff, a_ball_leaves_the_end_of_a_solid_where_slow_motion_does) {
  const auto pressed = [](double duration, std::vector<std::string> changes) {
    const std::string seconds = std::to_string(duration);
    changes.push_back("obstacles.ball.pose.translate=[104 mm, 3 mm, 30 mm]");
    changes.push_back("time.duration=" + seconds);
    changes.push_back("frames.hand.motion={times: [0, " + seconds + "], translate: [[0, 0, 0], [0, 0, -80 mm]]}");
    return run("press_on_beam", changes);
  };
  const RecordedRun rest = pressed(1.0, {}),
                    slow = pressed(40.0, {"analysis=dynamic", "time.step=20 ms",
                                          "solids.beam.rayleigh={mass: 0.1, stiffness: 0.02}"});
  ASSERT_TRUE(rest.done()) << rest.why();
  ASSERT_TRUE(slow.done()) << slow.why();
  const std::vector<double> elastic = slow.signal("energy.elastic");
  const auto leaves = static_cast<double>(std::max_element(elastic.begin(), elastic.end()) - elastic.begin()) /
                      static_cast<double>(elastic.size() - 1);
  const Warning* told = rest.warning("snapped");
  ASSERT_TRUE(told);
  EXPECT_EQ(told->where, "solids.beam");
  EXPECT_NEAR(told->time, leaves, 0.01);
  EXPECT_NEAR(rest.last("energy.dissipated"), slow.last("energy.dissipated"), 0.02 * slow.last("energy.dissipated"));
  EXPECT_NEAR(rest.last("tip.z"), 0.0, 1e-9);
}

}  // namespace
}  // namespace sinew::test
