#include "sinew/rigid/body.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>

#include "sinew/lie/rotation.hpp"

namespace sinew::rigid {
namespace {

Body brick() {
  Body own;
  own.mass = 2.0;
  own.inertia << 0.5, 0.02, -0.01, 0.02, 0.8, 0.03, -0.01, 0.03, 1.1;
  return own;
}

Motion moving() {
  Motion own;
  own.p = Vec3(0.1, -0.2, 0.3);
  own.R = lie::exp(Vec3(0.4, -0.3, 0.8));
  own.v = Vec3(1.0, 0.5, -0.2);
  own.w = Vec3(2.0, -3.0, 1.0);
  return own;
}

TEST(Body, moves_on_with_the_velocities_that_it_has) {
  const Motion start = moving();
  constexpr double kTime = 0.3;
  Motion end = start;
  move_on(start, kTime, end);
  set_velocities(start, 1.0 / kTime, end);
  EXPECT_LT((end.p - start.p - kTime * start.v).norm(), 1e-15);
  EXPECT_LT((end.v - start.v).norm(), 1e-14);
  EXPECT_LT((end.w - start.w).norm(), 1e-13);
}

/// The end that Newton finds; the tangent leaves out its skew part, so more than a few turns are needed.
Motion step(const Body& body, const Motion& start, double h, const Vec3& gravity, int* turns = nullptr) {
  Motion end = start;
  for (int i = 0; i < 100; ++i) {
    const Equations own = equations(body, start, end, 1.0 / h, gravity);
    if (turns) *turns = i;
    if (own.r.norm() < 1e-11 / h) break;
    const Vec6 d = own.tangent.ldlt().solve(-own.r);
    end.p += d.head<3>();
    end.R = lie::exp(d.tail<3>()) * end.R;
  }
  set_velocities(start, 1.0 / h, end);
  return end;
}

TEST(Body, TangentIsTheSymmetricPartOfTheDerivative) {
  const Body body = brick();
  const Motion start = moving();
  for (const double turn : {0.0, 1e-8, 1e-5, 0.3}) {
    Motion end = start;
    end.p += Vec3(0.01, 0.02, -0.01);
    end.R = lie::exp(turn * Vec3(0.5, 1.0, -0.7)) * start.R;
    const double rate = 20.0;
    const Equations here = equations(body, start, end, rate, Vec3(0, 0, -9.81));
    Mat6 D;
    constexpr double e = 1e-6;
    for (int i = 0; i < 6; ++i) {
      Vec6 r[2];
      for (const int side : {0, 1}) {
        Motion moved = end;
        const double d = side ? e : -e;
        if (i < 3) moved.p[i] += d;
        if (i >= 3) moved.R = lie::exp(d * Vec3::Unit(i - 3)) * end.R;
        r[side] = equations(body, start, moved, rate, Vec3(0, 0, -9.81)).r;
      }
      D.col(i) = (r[1] - r[0]) / (2 * e);
    }
    const Mat6 symmetric = 0.5 * (D + D.transpose());
    EXPECT_GT(symmetric.norm(), 100.0);
    EXPECT_LT((here.tangent - symmetric).norm(), 1e-7 * symmetric.norm()) << turn;
  }
}

TEST(Body, FallsAsBackwardEulerDoes) {
  const double h = 0.01;
  Motion now;
  for (int i = 1; i <= 100; ++i) {
    now = step(brick(), now, h, Vec3(0, 0, -9.81));
    EXPECT_NEAR(now.p.z(), -9.81 * h * h * i * (i + 1) / 2, 1e-12);
  }
}

TEST(Body, SpinAboutAPrincipalAxisKeepsItsSpeed) {
  Body body = brick();
  body.inertia = Vec3(0.5, 0.8, 1.1).asDiagonal();
  Motion now;
  now.w = Vec3(0, 0, 7.0);
  for (int i = 0; i < 200; ++i) now = step(body, now, 0.01, Vec3::Zero());
  EXPECT_NEAR(now.w.z(), 7.0, 1e-9);
  EXPECT_NEAR(lie::log(now.R).norm(), std::abs(std::remainder(14.0, 2 * M_PI)), 1e-7);
}

/// A tumbling body loses energy only, and of it and its angular momentum less the shorter the step: first order.
TEST(Body, TumblingLosesEnergyAtFirstOrderOnly) {
  const Body body = brick();
  double lost[2], drifted[2];
  for (const int fine : {0, 1}) {
    const double h = fine ? 0.0025 : 0.005;
    Motion now = moving();
    const double before = kinetic_energy(body, now);
    const Vec3 momentum = now.R * body.inertia * now.w;
    double energy = before;
    for (int i = 0; i < (fine ? 400 : 200); ++i) {
      now = step(body, now, h, Vec3::Zero());
      EXPECT_LE(kinetic_energy(body, now), energy * (1.0 + 1e-12));
      energy = kinetic_energy(body, now);
    }
    lost[fine] = before - energy;
    drifted[fine] = (now.R * body.inertia * now.w - momentum).norm() / momentum.norm();
  }
  EXPECT_NEAR(lost[0] / lost[1], 2.0, 0.25);
  EXPECT_NEAR(drifted[0] / drifted[1], 2.0, 0.25);
  EXPECT_LT(drifted[1], 0.05);
}

}  // namespace
}  // namespace sinew::rigid
