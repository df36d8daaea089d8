#include "sinew/solve/coulomb.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <random>

namespace sinew::solve {
namespace {

using Eigen::Matrix3d;
using Eigen::MatrixXd;
using Eigen::Vector2d;
using Eigen::Vector3d;
using Eigen::VectorXd;

struct Random {
  std::mt19937 engine{5};
  std::uniform_real_distribution<double> range{-1.0, 1.0};
  double operator()() { return range(engine); }
  MatrixXd matrix(int rows, int columns) {
    MatrixXd own(rows, columns);
    for (double& value : own.reshaped()) value = (*this)();
    return own;
  }
};

/// The laws, told one by one: independent of the residual that the solver uses.
void expect_laws(const CoulombProblem& problem, const VectorXd& lambda, double tolerance) {
  const VectorXd u = problem.D * lambda + problem.b;
  const double force = lambda.lpNorm<Eigen::Infinity>(), motion = problem.b.lpNorm<Eigen::Infinity>();
  for (int i = 0; i < problem.contacts(); ++i) {
    const double n = lambda[3 * i], mu = problem.mu[i], gap = u[3 * i];
    const Vector2d t = lambda.segment<2>(3 * i + 1), slip = u.segment<2>(3 * i + 1);
    EXPECT_GE(n, -tolerance * force);
    EXPECT_GE(gap, -tolerance * motion);
    EXPECT_LE(std::abs(n * gap), tolerance * force * motion);
    EXPECT_LE(t.norm(), mu * n + tolerance * force);
    // Maximum dissipation: t . slip = -mu n |slip|.
    EXPECT_LE(mu * n * slip.norm() + t.dot(slip), tolerance * force * motion);
  }
}

CoulombProblem definite(Random& random, int contacts, double mu) {
  CoulombProblem problem;
  const MatrixXd G = random.matrix(3 * contacts, 3 * contacts + 3);
  problem.D = G * G.transpose();
  problem.b = random.matrix(3 * contacts, 1);
  problem.mu = VectorXd::Constant(contacts, mu);
  return problem;
}

TEST(Coulomb, OneContactIsExact) {
  Random random;
  int open = 0, stick = 0, slip = 0;
  for (int trial = 0; trial < 2000; ++trial) {
    const double mu = trial % 5 == 0 ? 0.0 : 0.6 * (1.0 + random());
    CoulombProblem problem = definite(random, 1, mu);
    Vector3d lambda = Vector3d::Zero();
    if (!solve_one(problem.D, problem.b, mu, lambda)) continue;  // no or several solutions: friction jams
    expect_laws(problem, lambda, 1e-9);
    const double edge = mu * lambda[0] - lambda.tail<2>().norm();
    ++(lambda[0] == 0.0 ? open : edge > 1e-9 * lambda[0] ? stick : slip);
  }
  EXPECT_GT(open, 300);
  EXPECT_GT(stick, 100);
  EXPECT_GT(slip, 300);
}

TEST(Coulomb, ManyContactsMeetTheLaws) {
  Random random;
  for (const int contacts : {2, 5, 20, 60}) {
    for (const double mu : {0.0, 0.1, 0.5, 1.0}) {
      for (int trial = 0; trial < 5; ++trial) {
        const CoulombProblem problem = definite(random, contacts, mu);
        VectorXd lambda = VectorXd::Zero(3 * contacts);
        Coulomb solver;
        const CoulombReport report = solver.solve(problem, 1e-10, lambda);
        EXPECT_TRUE(report.solved) << contacts << " " << mu << " " << report.residual.largest();
        if (report.solved) expect_laws(problem, lambda, 1e-7);
      }
    }
  }
}

/// A box on four corners: twelve rows on six unknowns.
TEST(Coulomb, BoxOnFourCornersIsUndecidedAndSolvedAllTheSame) {
  for (const double push : {0.0, 0.3, 0.49, 0.51, 2.0}) {
    MatrixXd H(12, 6);
    for (int k = 0; k < 4; ++k) {
      const Vector3d r(k & 1 ? 1.0 : -1.0, k & 2 ? 1.0 : -1.0, -1.0);
      Matrix3d hat;
      hat << 0, -r.z(), r.y(), r.z(), 0, -r.x(), -r.y(), r.x(), 0;
      Eigen::Matrix<double, 3, 6> J;
      J << Matrix3d::Identity(), -hat;
      H.middleRows<3>(3 * k) << J.row(2), J.row(0), J.row(1);
    }
    CoulombProblem problem{H * H.transpose(), H * (VectorXd(6) << push, 0, -1, 0, 0, 0).finished(),
                           VectorXd::Constant(4, 0.5)};
    VectorXd lambda = VectorXd::Zero(12);
    Coulomb solver;
    const CoulombReport report = solver.solve(problem, 1e-10, lambda);
    EXPECT_TRUE(report.solved) << push << " " << report.residual.largest();
    expect_laws(problem, lambda, 1e-8);
    const VectorXd u = problem.D * lambda + problem.b;
    double pressed = 0.0;
    for (int k = 0; k < 4; ++k) pressed += lambda[3 * k];
    EXPECT_NEAR(pressed, 1.0, 1e-8);
    EXPECT_NEAR(u[1], std::max(0.0, push - 0.5), 1e-8);
  }
}

TEST(Coulomb, GoesOnFromWhereItIs) {
  Random random;
  const CoulombProblem problem = definite(random, 30, 0.5);
  VectorXd lambda = VectorXd::Zero(90);
  Coulomb solver;
  ASSERT_TRUE(solver.solve(problem, 1e-10, lambda).solved);
  const CoulombReport again = solver.solve(problem, 1e-9, lambda);
  EXPECT_TRUE(again.solved);
  EXPECT_EQ(again.sweeps + again.newton, 0);
}

// D of bodies that would buckle but for their contacts: sweeps, which look at one contact after the other, let go.
TEST(Coulomb, HoldsWhatWouldBuckle) {
  Random random;
  for (int trial = 0; trial < 200; ++trial) {
    constexpr int kContacts = 4;
    CoulombProblem problem = definite(random, kContacts, 0.5);
    const VectorXd soft = random.matrix(3 * kContacts, 1);
    problem.D -= (2.0 + trial % 7) * soft * soft.transpose();
    VectorXd wanted = 0.1 * random.matrix(3 * kContacts, 1);
    for (int i = 0; i < kContacts; ++i) wanted[3 * i] = 1.5 + 0.5 * random();
    problem.b = -problem.D * wanted;  // all hold and stick
    VectorXd lambda = wanted + 0.05 * random.matrix(3 * kContacts, 1);
    Coulomb solver;
    EXPECT_TRUE(solver.solve(problem, 1e-10, lambda).solved);
    EXPECT_LT((lambda - wanted).norm(), 1e-7);
  }
}

// Two contacts that push each other in, so that no forces obey the laws: sweeps let them grow until they overflow, and
// beside a force that is infinite everything else is nothing.
TEST(Coulomb, ForcesWithoutEndAreNoSolution) {
  CoulombProblem problem;
  problem.D = MatrixXd::Identity(6, 6);
  problem.D(0, 3) = problem.D(3, 0) = -2.0;
  problem.b = VectorXd::Zero(6);
  problem.b[0] = problem.b[3] = -1.0;
  problem.mu = VectorXd::Constant(2, 0.3);
  VectorXd lambda = VectorXd::Zero(6);
  Coulomb solver;
  EXPECT_FALSE(solver.solve(problem, 1e-10, lambda).solved);
  EXPECT_LT(lambda.lpNorm<Eigen::Infinity>(), 1e9);
  EXPECT_EQ(residual(problem, VectorXd::Constant(6, 1e200)).largest(), INFINITY);
}

TEST(Coulomb, ResidualTellsEachLaw) {
  CoulombProblem problem{Matrix3d::Identity(), Vector3d(-1.0, 0.0, 0.0), VectorXd::Constant(1, 0.5)};
  EXPECT_NEAR(residual(problem, Vector3d(1.0, 0.0, 0.0)).largest(), 0.0, 1e-15);
  EXPECT_NEAR(residual(problem, Vector3d(0.5, 0.0, 0.0)).complementarity, 0.5, 1e-12);
  EXPECT_NEAR(residual(problem, Vector3d(1.0, 0.8, 0.0)).cone, 0.3 / std::hypot(1.0, 0.8), 1e-12);
  problem.b = Vector3d(-1.0, 2.0, 0.0);
  EXPECT_GT(residual(problem, Vector3d(1.0, 0.0, 0.0)).dissipation, 0.1);
}

}  // namespace
}  // namespace sinew::solve
