#include "sinew/solve/bounded.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <random>

namespace sinew::solve {
namespace {

constexpr double kFree = INFINITY;

/// Every choice of bounds tried: the one that satisfies all conditions.
Eigen::VectorXd by_force(const Eigen::MatrixXd& H, const Eigen::VectorXd& g, const Eigen::VectorXd& lower,
                         const Eigen::VectorXd& upper) {
  const auto n = static_cast<int>(g.size());
  Eigen::VectorXd best;
  double least = INFINITY;
  for (int code = 0; code < static_cast<int>(std::pow(3, n) + 0.5); ++code) {
    Eigen::VectorXd x = Eigen::VectorXd::Zero(n);
    std::vector<int> free;
    for (int i = 0, rest = code; i < n; ++i, rest /= 3) {
      if (rest % 3 == 0) free.push_back(i);
      if (rest % 3 == 1) x[i] = lower[i];
      if (rest % 3 == 2) x[i] = upper[i];
    }
    if (!x.allFinite()) continue;
    if (!free.empty()) {
      const Eigen::VectorXd slope = g + H * x;
      const Eigen::MatrixXd K = H(free, free);
      const Eigen::VectorXd step = K.ldlt().solve(-slope(free));
      for (std::size_t k = 0; k < free.size(); ++k) x[free[k]] = step[static_cast<Eigen::Index>(k)];
    }
    if ((x.array() < lower.array() - 1e-12).any() || (x.array() > upper.array() + 1e-12).any()) continue;
    const double value = 0.5 * x.dot(H * x) + g.dot(x);
    if (value < least) {
      least = value;
      best = x;
    }
  }
  return best;
}

TEST(Bounded, FindsTheLeastOfRandomProblems) {
  std::mt19937 draw(5);
  std::normal_distribution<double> number;
  Bounded solver;
  int at_bounds = 0;
  for (int trial = 0; trial < 500; ++trial) {
    const int n = 1 + static_cast<int>(draw() % 5);
    const auto random = [&](int rows, int columns) {
      return Eigen::MatrixXd::NullaryExpr(rows, columns, [&] { return number(draw); }).eval();
    };
    const Eigen::MatrixXd J = random(3, n);
    const Eigen::MatrixXd H = J.transpose() * J + 1e-3 * Eigen::MatrixXd::Identity(n, n);
    const Eigen::VectorXd g = random(n, 1);
    Eigen::VectorXd lower = Eigen::VectorXd::Zero(n), upper = Eigen::VectorXd::Constant(n, kFree);
    for (int i = 0; i < n; ++i) {
      if (draw() % 3 == 0) upper[i] = std::abs(number(draw));
      if (draw() % 5 == 0) lower[i] = -kFree;
      if (draw() % 11 == 0) lower[i] = upper[i] = 0.1;
    }
    Eigen::VectorXd x = random(n, 1);
    ASSERT_TRUE(solver.minimise(H, g, lower, upper, x)) << trial;
    EXPECT_LT((x - by_force(H, g, lower, upper)).norm(), 1e-9 * (1.0 + x.norm())) << trial;
    for (int i = 0; i < n; ++i) {
      EXPECT_GE(x[i], lower[i]);
      EXPECT_LE(x[i], upper[i]);
      at_bounds += solver.at()[static_cast<std::size_t>(i)] != Bounded::At::between;
    }
    EXPECT_LT(solver.iterations(), 4 * n + 4);
  }
  EXPECT_GT(at_bounds, 300);
}

TEST(Bounded, RefusesWhatHasNoLeast) {
  Bounded solver;
  const Eigen::VectorXd none = Eigen::VectorXd::Zero(2), all = Eigen::VectorXd::Constant(2, kFree);
  Eigen::VectorXd x = none;
  EXPECT_FALSE(solver.minimise(-Eigen::MatrixXd::Identity(2, 2), Eigen::VectorXd::Ones(2), -all, all, x));
  EXPECT_FALSE(solver.minimise(Eigen::MatrixXd::Constant(2, 2, NAN), Eigen::VectorXd::Ones(2), none, all, x));
  EXPECT_FALSE(solver.minimise(Eigen::MatrixXd::Identity(2, 2), Eigen::VectorXd::Ones(2), all, none, x));
  Eigen::VectorXd nothing;
  EXPECT_TRUE(solver.minimise(Eigen::MatrixXd(0, 0), Eigen::VectorXd(), nothing, nothing, nothing));
}

}  // namespace
}  // namespace sinew::solve
