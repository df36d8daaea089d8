#include "sinew/solve/quadratic.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <random>

namespace sinew::solve {
namespace {

using Outcome = Quadratic::Outcome;
constexpr double kFree = INFINITY;

struct Problem {
  Eigen::MatrixXd H, A;
  Eigen::VectorXd g, lower, upper;

  double value(const Eigen::VectorXd& x) const { return 0.5 * x.dot(H * x) + g.dot(x); }
  bool met(const Eigen::VectorXd& x, double tolerance) const {
    const Eigen::VectorXd row = A * x;
    return ((row - lower).array() >= -tolerance).all() && ((upper - row).array() >= -tolerance).all();
  }
};

/// Every choice of at most n limits as equalities is tried, and the least of what meets all limits taken; empty if
/// nothing does.
Eigen::VectorXd by_force(const Problem& own) {
  const auto n = static_cast<int>(own.g.size()), m = static_cast<int>(own.lower.size());
  Eigen::VectorXd best;
  double least = INFINITY;
  for (int code = 0; code < static_cast<int>(std::pow(3, m) + 0.5); ++code) {
    std::vector<int> rows;
    std::vector<double> to;
    bool finite = true;
    for (int i = 0, rest = code; i < m; ++i, rest /= 3) {
      if (rest % 3 == 0) continue;
      rows.push_back(i);
      to.push_back(rest % 3 == 1 ? own.lower[i] : own.upper[i]);
      finite &= std::isfinite(to.back());
    }
    const auto k = static_cast<int>(rows.size());
    if (!finite || k > n) continue;
    Eigen::MatrixXd K = Eigen::MatrixXd::Zero(n + k, n + k);
    Eigen::VectorXd right(n + k);
    K.topLeftCorner(n, n) = own.H;
    right.head(n) = -own.g;
    for (int i = 0; i < k; ++i) {
      K.block(n + i, 0, 1, n) = own.A.row(rows[static_cast<std::size_t>(i)]);
      K.block(0, n + i, n, 1) = own.A.row(rows[static_cast<std::size_t>(i)]).transpose();
      right[n + i] = to[static_cast<std::size_t>(i)];
    }
    const Eigen::FullPivLU<Eigen::MatrixXd> lu(K);
    if (!lu.isInvertible()) continue;
    const Eigen::VectorXd x = lu.solve(right).head(n);
    if (!own.met(x, 1e-10)) continue;
    if (own.value(x) < least) {
      least = own.value(x);
      best = x;
    }
  }
  return best;
}

Problem random_problem(std::mt19937& draw) {
  std::normal_distribution<double> number;
  const auto random = [&](int rows, int columns) {
    return Eigen::MatrixXd::NullaryExpr(rows, columns, [&] { return number(draw); }).eval();
  };
  Problem own;
  const int n = 1 + static_cast<int>(draw() % 4), more = static_cast<int>(draw() % 4), m = n + more;
  const Eigen::MatrixXd J = random(3, n);
  own.H = J.transpose() * J + 1e-3 * Eigen::MatrixXd::Identity(n, n);
  own.g = random(n, 1);
  own.A.resize(m, n);
  own.A << Eigen::MatrixXd::Identity(n, n), random(more, n);
  own.lower.resize(m);
  own.upper.resize(m);
  for (int i = 0; i < m; ++i) {
    own.lower[i] = draw() % 4 == 0 ? -kFree : number(draw) - 0.5;
    own.upper[i] = draw() % 4 == 0 ? kFree : own.lower[i] + std::abs(number(draw));
    if (!std::isfinite(own.upper[i]) && own.upper[i] < 0.0) own.upper[i] = number(draw);
    if (draw() % 9 == 0 && std::isfinite(own.lower[i])) own.upper[i] = own.lower[i];
  }
  return own;
}

TEST(Quadratic, FindsTheLeastOfRandomProblemsOrThatThereIsNone) {
  std::mt19937 draw(5);
  Quadratic solver;
  int active = 0, infeasible = 0;
  for (int trial = 0; trial < 2000; ++trial) {
    const Problem own = random_problem(draw);
    const Eigen::VectorXd expected = by_force(own);
    Eigen::VectorXd x;
    const Outcome outcome = solver.minimise(own.H, own.g, own.A, own.lower, own.upper, x);
    ASSERT_EQ(outcome, expected.size() > 0 ? Outcome::solved : Outcome::infeasible) << trial;
    if (outcome == Outcome::infeasible) {
      // What is named excludes itself, and nothing of it can be spared.
      ++infeasible;
      Problem named = own;
      const std::vector<int>& rows = solver.conflict();
      named.A = own.A(rows, Eigen::all);
      named.lower = own.lower(rows);
      named.upper = own.upper(rows);
      EXPECT_EQ(by_force(named).size(), 0) << trial;
      continue;
    }
    EXPECT_LT((x - expected).norm(), 1e-8 * (1.0 + x.norm())) << trial;
    EXPECT_TRUE(own.met(x, 1e-9)) << trial;
    // The conditions of Karush, Kuhn and Tucker.
    EXPECT_LT((own.H * x + own.g - own.A.transpose() * solver.pulls()).norm(), 1e-8 * (1.0 + own.g.norm())) << trial;
    for (Eigen::Index i = 0; i < own.lower.size(); ++i) {
      const At at = solver.at()[static_cast<std::size_t>(i)];
      active += at != At::between;
      const double pull = solver.pulls()[i], row = own.A.row(i).dot(x);
      if (own.lower[i] == own.upper[i]) continue;
      if (at == At::between) {
        EXPECT_EQ(pull, 0.0) << trial;
        continue;
      }
      EXPECT_GE(at == At::lower ? pull : -pull, 0.0) << trial;
      EXPECT_NEAR(row, at == At::lower ? own.lower[i] : own.upper[i], 1e-9) << trial;
    }
  }
  EXPECT_GT(active, 1000);
  EXPECT_GT(infeasible, 100);
}

// Many limits through one point: sets of active ones that hold each other.
TEST(Quadratic, LimitsThatMeetInOnePoint) {
  constexpr int kSides = 24;
  Problem own{Eigen::MatrixXd::Identity(3, 3), Eigen::MatrixXd(kSides, 3), Eigen::Vector3d(0.1, -0.2, -3.0),
              Eigen::VectorXd::Constant(kSides, -kFree), Eigen::VectorXd::Constant(kSides, 1.0)};
  for (int i = 0; i < kSides; ++i) {
    const double angle = 2.0 * M_PI * i / kSides;
    own.A.row(i) << std::cos(angle), std::sin(angle), 1.0;  // a cone with its tip at (0, 0, 1)
  }
  Quadratic solver;
  Eigen::VectorXd x;
  ASSERT_EQ(solver.minimise(own.H, own.g, own.A, own.lower, own.upper, x), Outcome::solved);
  EXPECT_LT((x - Eigen::Vector3d(0, 0, 1)).norm(), 1e-12);
  EXPECT_LT((own.H * x + own.g - own.A.transpose() * solver.pulls()).norm(), 1e-12);
}

// Numbers of a soft robot: forces of newtons that move a tip by micrometres, and limits in two units.
TEST(Quadratic, IsIndifferentToUnits) {
  std::mt19937 draw(11);
  Quadratic solver;
  for (int trial = 0; trial < 200; ++trial) {
    const Problem own = random_problem(draw);
    Eigen::VectorXd x, scaled_x;
    const Outcome outcome = solver.minimise(own.H, own.g, own.A, own.lower, own.upper, x);
    constexpr double kForce = 1e-6, kValue = 1e-9;
    Problem scaled = own;
    scaled.H *= kValue / (kForce * kForce);
    scaled.g *= kValue / kForce;
    for (Eigen::Index i = 0; i < own.lower.size(); ++i) {
      const double unit = i % 2 == 0 ? 1e3 : 1e-4;
      scaled.A.row(i) *= unit / kForce;
      scaled.lower[i] *= unit;
      scaled.upper[i] *= unit;
    }
    ASSERT_EQ(solver.minimise(scaled.H, scaled.g, scaled.A, scaled.lower, scaled.upper, scaled_x), outcome) << trial;
    if (outcome != Outcome::solved) continue;
    EXPECT_LT((scaled_x / kForce - x).norm(), 1e-8 * (1.0 + x.norm())) << trial;
  }
}

TEST(Quadratic, BalancesToRoundingWhereNoLimitIsInTheWay) {
  std::srand(3);
  for (const double smallest : {1.0, 1e-4, 1e-8, 1e-12}) {
    const Eigen::MatrixXd Q = Eigen::HouseholderQR<Eigen::MatrixXd>(Eigen::MatrixXd::Random(6, 6)).householderQ();
    Eigen::VectorXd sizes(6);
    for (int i = 0; i < 6; ++i) sizes[i] = std::pow(smallest, i / 5.0);
    const Eigen::MatrixXd H = Q * sizes.asDiagonal() * Q.transpose(), A = Eigen::MatrixXd::Random(4, 6);
    const Eigen::VectorXd g = Eigen::VectorXd::Random(6), far = Eigen::VectorXd::Constant(4, 1e3 / smallest);
    Quadratic solver;
    Eigen::VectorXd x;
    ASSERT_EQ(solver.minimise(H, g, A, -far, far, x), Outcome::solved);
    EXPECT_LT((H.selfadjointView<Eigen::Lower>() * x + g).norm(), 4e-16 * (x.norm() + g.norm())) << smallest;
    EXPECT_TRUE(solver.pulls().isZero(0.0));
  }
}

TEST(Quadratic, RefusesWhatHasNoLeast) {
  Quadratic solver;
  Problem own{Eigen::MatrixXd::Identity(2, 2), Eigen::MatrixXd::Identity(2, 2), Eigen::Vector2d(1, 2),
              Eigen::Vector2d(-1, -1), Eigen::Vector2d(1, 1)};
  Eigen::VectorXd x;
  const auto outcome = [&](auto change) {
    Problem changed = own;
    change(changed);
    return solver.minimise(changed.H, changed.g, changed.A, changed.lower, changed.upper, x);
  };
  EXPECT_EQ(outcome([](Problem&) {}), Outcome::solved);
  EXPECT_EQ(outcome([](Problem& p) { p.H(1, 1) = -1.0; }), Outcome::invalid);
  EXPECT_EQ(outcome([](Problem& p) { p.H(0, 0) = NAN; }), Outcome::invalid);
  EXPECT_EQ(outcome([](Problem& p) { p.g[0] = NAN; }), Outcome::invalid);
  EXPECT_EQ(outcome([](Problem& p) { p.A(0, 1) = INFINITY; }), Outcome::invalid);
  EXPECT_EQ(outcome([](Problem& p) { p.lower[0] = 2.0; }), Outcome::invalid);
  EXPECT_EQ(outcome([](Problem& p) { p.upper[0] = NAN; }), Outcome::invalid);
  EXPECT_EQ(outcome([](Problem& p) { p.lower[0] = p.upper[0] = kFree; }), Outcome::invalid);
  // A row that nothing moves, beyond its limit.
  EXPECT_EQ(outcome([](Problem& p) {
              p.A.row(1).setZero();
              p.lower[1] = 0.5;
            }),
            Outcome::infeasible);
  EXPECT_EQ(solver.conflict(), std::vector<int>{1});
}

}  // namespace
}  // namespace sinew::solve
