// Commands under limits and contacts, against trying them all.
#include "sinew/solve/steering.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <random>

namespace sinew::solve {
namespace {

/// Random effectors, limits and contacts of a body with a compliance that is symmetric as a whole: what commands do to
/// contacts and what contacts do to effectors come from the same matrix.
class RandomProblems {
 public:
  explicit RandomProblems(unsigned seed) : engine_(seed) {}
  double number() { return normal_(engine_); }
  Eigen::MatrixXd matrix(Eigen::Index rows, Eigen::Index cols) {
    Eigen::MatrixXd M(rows, cols);
    for (double& own : M.reshaped()) own = number();
    return M;
  }

  /// `motions`: in how many ways the body can move, none: in enough to decide all forces.
  SteeringProblem problem(int commands, int contacts, double friction, Eigen::Index motions = 0) {
    const Eigen::Index n = commands, k = 3 * contacts, e = n + 1, all = n + k + e;
    const Eigen::MatrixXd R = matrix(all, motions > 0 ? motions : all + 2);
    const Eigen::MatrixXd W = R * R.transpose() / static_cast<double>(all);
    SteeringProblem own;
    own.J = W.block(n + k, 0, e, n);
    own.L = W.block(n + k, n, e, k);
    own.e = 2.0 * matrix(e, 1);
    own.A = Eigen::MatrixXd::Identity(n, n);
    own.C = Eigen::MatrixXd::Zero(n, k);
    own.lower.setConstant(n, -2.0);
    own.upper.setConstant(n, 2.0);
    own.firmness.setOnes(n);
    own.unit.setOnes(n);
    own.wish.setZero(n);
    own.B = W.block(n, 0, k, n);
    own.contacts.D = W.block(n, n, k, k);
    own.contacts.b = 0.5 * matrix(k, 1);
    own.contacts.mu.setConstant(contacts, friction);
    own.held.setZero(k);
    if (contacts > 0) Coulomb().solve(own.contacts, 1e-12, own.held);
    return own;
  }

 private:
  std::mt19937 engine_;
  std::normal_distribution<double> normal_;
};

double left_by(const SteeringProblem& problem, const Eigen::VectorXd& p, Eigen::VectorXd lambda) {
  CoulombProblem moved = problem.contacts;
  if (lambda.size() > 0) {
    moved.b += problem.B * p;
    EXPECT_TRUE(Coulomb().solve(moved, 1e-10, lambda).solved);
  }
  return (problem.e + problem.J * p + problem.L * (lambda - problem.held)).norm();
}

void expect_consistent(const SteeringProblem& problem, const Steering& found) {
  CoulombProblem moved = problem.contacts;
  moved.b += problem.B * found.p();
  EXPECT_LT(residual(moved, found.lambda()).largest(), 1e-9);
  EXPECT_NEAR(left_by(problem, found.p(), found.lambda()), found.left().norm(), 1e-8);
  for (Eigen::Index a = 0; a < found.p().size(); ++a) EXPECT_LE(std::abs(found.p()[a]), 2.0 + 1e-9);
}

TEST(Steering, IsTheBestOfAllCommandsWithoutFriction) {
  RandomProblems random(1);
  Steering steering;
  int certain = 0;
  for (int trial = 0; trial < 60; ++trial) {
    const SteeringProblem problem = random.problem(2, 1 + trial % 6, 0.0);
    ASSERT_TRUE(steering.solve(problem));
    expect_consistent(problem, steering);
    certain += steering.certain() ? 1 : 0;
    double best = INFINITY;
    for (int i = 0; i <= 40; ++i) {
      for (int j = 0; j <= 40; ++j)
        best = std::min(best, left_by(problem, Eigen::Vector2d(-2.0 + 0.1 * i, -2.0 + 0.1 * j), problem.held));
    }
    EXPECT_LE(steering.left().norm(), best * (1.0 + 1e-9)) << trial;
  }
  EXPECT_EQ(certain, 60);
}

/// With friction: none of the commands around does better.
TEST(Steering, IsTheBestAroundWithFriction) {
  RandomProblems random(2);
  Steering steering;
  for (int trial = 0; trial < 100; ++trial) {
    const SteeringProblem problem = random.problem(2, 1 + trial % 6, 0.4);
    ASSERT_TRUE(steering.solve(problem));
    EXPECT_FALSE(steering.certain());
    expect_consistent(problem, steering);
    for (int i = 0; i < 16; ++i) {
      for (const double far : {1e-5, 1e-3, 1e-2}) {
        Eigen::VectorXd p = steering.p() + far * Eigen::Vector2d(std::cos(M_PI / 8.0 * i), std::sin(M_PI / 8.0 * i));
        p = p.cwiseMax(-2.0).cwiseMin(2.0);
        EXPECT_GE(left_by(problem, p, steering.lambda()), steering.left().norm() * (1.0 - 1e-5 * far - 1e-9))
            << trial << " " << i << " " << far;
      }
    }
  }
}

TEST(Steering, ReactionIsTheDifferenceOfForces) {
  RandomProblems random(3);
  Steering steering;
  for (int trial = 0; trial < 50; ++trial) {
    const SteeringProblem problem = random.problem(2, 4, trial % 2 == 0 ? 0.5 : 0.0);
    const Eigen::MatrixXd S = steering.reaction(problem);
    for (Eigen::Index a = 0; a < 2; ++a) {
      const double e = 1e-6;
      Eigen::VectorXd high = problem.held, low = problem.held;
      CoulombProblem moved = problem.contacts;
      moved.b = problem.contacts.b + e * problem.B.col(a);
      Coulomb().solve(moved, 1e-14, high);
      moved.b = problem.contacts.b - e * problem.B.col(a);
      Coulomb().solve(moved, 1e-14, low);
      EXPECT_LT(((high - low) / (2.0 * e) - S.col(a)).norm(), 1e-5 * (1.0 + S.col(a).norm())) << trial;
    }
  }
}

/// A wall in front of a spring that a command pushes: what is behind it is not reached, what it presses is.
TEST(Steering, PressesWhatItTouches) {
  SteeringProblem problem;
  problem.J.setZero(1, 1);
  problem.L.setZero(1, 3);
  problem.L(0, 0) = 1.0;  // the force on the wall
  problem.e.setConstant(1, -3.0);
  problem.A = Eigen::MatrixXd::Identity(1, 1);
  problem.C.setZero(1, 3);
  problem.lower.setConstant(1, -INFINITY);
  problem.upper.setConstant(1, INFINITY);
  problem.firmness.setOnes(1);
  problem.unit.setOnes(1);
  problem.wish.setZero(1);
  problem.contacts = {Eigen::Matrix3d::Identity(), Eigen::Vector3d(2.0, 0.0, 0.0), Eigen::VectorXd::Zero(1)};
  problem.B.setZero(3, 1);
  problem.B(0, 0) = -1.0;
  problem.held.setZero(3);
  Steering steering;
  ASSERT_TRUE(steering.solve(problem));
  EXPECT_NEAR(steering.p()[0], 5.0, 1e-6);  // 2 to the wall, 3 to press
  EXPECT_NEAR(steering.lambda()[0], 3.0, 1e-6);
  EXPECT_TRUE(steering.certain());
}

/// Limits that exclude each other: what is less firm gives way, and is told.
TEST(Steering, BreaksTheLessFirm) {
  SteeringProblem problem;
  problem.J = Eigen::MatrixXd::Identity(1, 1);
  problem.e.setConstant(1, -5.0);
  problem.A.setOnes(2, 1);
  problem.lower = Eigen::Vector2d(2.0, -1.0);
  problem.upper = Eigen::Vector2d(9.0, 1.0);
  problem.firmness = Eigen::Vector2d(1.0, 1e4);
  problem.unit.setOnes(2);
  problem.wish.setZero(1);
  Steering steering;
  ASSERT_TRUE(steering.solve(problem));
  EXPECT_NEAR(steering.p()[0], 1.0, 1e-3);
  ASSERT_EQ(steering.broken().size(), 1U);
  EXPECT_EQ(steering.broken()[0].row, 0);
  EXPECT_EQ(steering.broken()[0].at, At::lower);
}

/// Hundreds of contacts of what moves in a dozen ways, solved anew for each p, are more work than a step is worth: what
/// was found by then stands, is no worse than nothing and is not said to be the best.
TEST(Steering, EndsAtALimitOfWork) {
  RandomProblems random(5);
  Steering steering;
  const SteeringProblem few = random.problem(2, 8, 0.4);
  ASSERT_TRUE(steering.solve(few));
  EXPECT_FALSE(steering.cut_short());
  const SteeringProblem many = random.problem(3, 150, 0.4, 12);
  ASSERT_TRUE(steering.solve(many));
  EXPECT_TRUE(steering.cut_short());
  EXPECT_FALSE(steering.certain());
  EXPECT_LE(steering.left().norm(), many.e.norm() * (1.0 + 1e-4));  // (forces are solved to 1e-5)
  EXPECT_EQ(steering.pulls().size(), many.A.rows());
  ASSERT_TRUE(steering.solve(few));
  EXPECT_FALSE(steering.cut_short());
}

}  // namespace
}  // namespace sinew::solve
