// Factorisation by fronts with every set of kernels, on bodies of three unknowns a node, beside dense matrices.
#include "sinew/linalg/fronts.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <random>
#include <set>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "sinew/linalg/sparse_factor.hpp"

namespace sinew::linalg {
namespace {

using Matrix = SparseFactor::Matrix;
using Rows = SparseFactor::Rows;

/// A bar of cells with random stiffness, some unknowns of its nodes held, and border rows in random cells.
struct Bar {
  Matrix A;
  Rows H;
};

Bar random_bar(int length, int rows, double shift, unsigned seed) {
  std::mt19937 draw(seed);
  std::normal_distribution<double> number;
  constexpr int width = 3;
  const auto node = [](int i, int j, int k) { return (i * width + j) * width + k; };
  const int nodes = length * width * width;
  std::vector<int> unknown;
  int unknowns = 0;
  for (int i = 0; i < 3 * nodes; ++i) unknown.push_back(draw() % 7 == 0 ? -1 : unknowns++);
  std::vector<std::vector<int>> cells;  // their unknowns
  std::vector<Eigen::Triplet<double>> entries;
  for (int i = 0; i + 1 < length; ++i) {
    for (int j = 0; j + 1 < width; ++j) {
      for (int k = 0; k + 1 < width; ++k) {
        std::vector<int>& own = cells.emplace_back();
        for (int c = 0; c < 24; ++c) {
          const int corner = c / 3;
          const int u = unknown[3 * node(i + corner % 2, j + corner / 2 % 2, k + corner / 4) + c % 3];
          if (u >= 0) own.push_back(u);
        }
        const auto n = static_cast<Eigen::Index>(own.size());
        const Eigen::MatrixXd B = Eigen::MatrixXd::NullaryExpr(n, n, [&] { return number(draw); });
        const Eigen::MatrixXd K = B * B.transpose();
        for (Eigen::Index a = 0; a < n; ++a) {
          for (Eigen::Index b = 0; b < n; ++b) {
            if (own[a] >= own[b]) entries.emplace_back(own[a], own[b], K(a, b));
          }
        }
      }
    }
  }
  for (int i = 0; i < unknowns; ++i) entries.emplace_back(i, i, 1.0 - shift);
  Bar bar{Matrix(unknowns, unknowns), Rows(rows, unknowns)};
  bar.A.setFromTriplets(entries.begin(), entries.end());
  entries.clear();
  for (int r = 0; r + 1 < rows; ++r) {  // the last one touches nothing
    for (const int u : cells[draw() % cells.size()]) {
      if (draw() % 2 == 0) entries.emplace_back(r, u, number(draw));
    }
  }
  bar.H.setFromTriplets(entries.begin(), entries.end());
  return bar;
}

/// n x n x n nodes of three unknowns, each tied to its neighbours, and border rows of one unknown.
Bar random_cube(int n, int rows) {
  std::mt19937 draw(3);
  std::uniform_real_distribution<double> number(-1.0, 1.0);
  std::vector<Eigen::Triplet<double>> entries;
  for (int i = 0; i < n * n * n; ++i) {
    const std::array<int, 3> place = {i / (n * n), i / n % n, i % n}, next = {i + n * n, i + n, i + 1};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      entries.emplace_back(3 * i + static_cast<int>(axis), 3 * i + static_cast<int>(axis), 24.0);
      if (place[axis] + 1 == n) continue;
      for (int a = 0; a < 3; ++a) {
        for (int b = 0; b < 3; ++b) entries.emplace_back(3 * next[axis] + a, 3 * i + b, number(draw));
      }
    }
  }
  Bar bar{Matrix(3 * n * n * n, 3 * n * n * n), Rows(rows, 3 * n * n * n)};
  bar.A.setFromTriplets(entries.begin(), entries.end());
  entries.clear();
  for (int r = 0; r < rows; ++r) entries.emplace_back(r, static_cast<int>(draw() % bar.A.cols()), 1.0);
  bar.H.setFromTriplets(entries.begin(), entries.end());
  return bar;
}

Eigen::MatrixXd dense(const Matrix& A) { return Eigen::MatrixXd(A).selfadjointView<Eigen::Lower>(); }

class EveryKernel : public testing::TestWithParam<const char*> {
 protected:
  void SetUp() override {
    if (!kernels(GetParam())) GTEST_SKIP() << "this processor has no " << GetParam();
  }
};

TEST_P(EveryKernel, SolvesAndCondensesAsTheMatrixWrittenOut) {
  for (const double shift : {0.0, 20.0}) {
    for (const int length : {2, 3, 9, 25}) {
      const Bar bar = random_bar(length, 3 * length, shift, static_cast<unsigned>(length));
      const Eigen::MatrixXd A = dense(bar.A), H = bar.H;
      const Eigen::PartialPivLU<Eigen::MatrixXd> lu(A);
      SparseFactor factor(SparseFactor::make_plan(bar.A, bar.H), *kernels(GetParam()));
      for (int again = 0; again < 2; ++again) {  // nothing of the first is left in the second
        SCOPED_TRACE("length " + std::to_string(length) + ", shift " + std::to_string(shift));
        ASSERT_TRUE(factor.factor(bar.A, bar.H));
        const Eigen::VectorXd b = Eigen::VectorXd::Random(A.rows());
        Eigen::VectorXd y(A.rows()), x(A.rows()), motion(H.rows());
        Eigen::MatrixXd compliance;
        factor.half_solve(b, y);
        factor.back_solve(y, x);
        EXPECT_LT((A * x - b).norm(), 1e-12 * (A.norm() * x.norm() + b.norm()));
        EXPECT_EQ(factor.negative() > 0, shift > 0.0);
        EXPECT_EQ(factor.negative(),
                  (Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(A).eigenvalues().array() < 0.0).count());
        const Eigen::MatrixXd W = H * lu.solve(Eigen::MatrixXd(H.transpose()));
        compliance = factor.compliance();
        EXPECT_LT((compliance - W).norm(), 1e-10 * W.norm());
        factor.border_times(y, motion);
        EXPECT_LT((motion - H * x).norm(), 1e-10 * (H * x).norm());
        Eigen::VectorXd along, moved;  // the same right side, eliminated beside the matrix
        const HalfSolve right{b, along, &moved};
        ASSERT_TRUE(factor.factor(threads::Crew::none(), &right));
        EXPECT_LT((along - y).norm(), 1e-12 * y.norm());
        EXPECT_LT((moved - H * x).norm(), 1e-10 * (H * x).norm());
        EXPECT_LT((factor.compliance() - W).norm(), 1e-10 * W.norm());
        const Eigen::VectorXd u = Eigen::VectorXd::Random(H.rows());
        Eigen::VectorXd back(A.rows());
        y.setZero();
        factor.add_border_transposed(u, y);
        factor.back_solve(y, back);
        EXPECT_LT((A * back - H.transpose() * u).norm(), 1e-11 * A.norm() * back.norm());
      }
    }
  }
}

TEST(SparseFactor, GivesBackWhatWasPutTogether) {
  const Bar bar = random_bar(9, 20, 0.0, 4);
  const auto plan = SparseFactor::make_plan(bar.A, bar.H);
  SparseFactor factor(plan);
  for (Eigen::Index j = 0; j < bar.A.cols(); ++j) {
    for (Matrix::InnerIterator at(bar.A, j); at; ++at)
      factor.values()[plan->entry(static_cast<int>(j), static_cast<int>(at.row()))] += at.value();
  }
  EXPECT_EQ((dense(factor.assembled()) - dense(bar.A)).norm(), 0.0);
  EXPECT_TRUE(factor.factor());
  EXPECT_THROW(factor.factor(bar.A), std::invalid_argument);  // its border rows are missing
}

TEST_P(EveryKernel, GivesWhatTheOthersGive) {
  const Bar bar = random_bar(12, 20, 0.0, 7);
  const auto plan = SparseFactor::make_plan(bar.A, bar.H);
  SparseFactor portable(plan, *kernels("portable")), own(plan, *kernels(GetParam()));
  ASSERT_TRUE(portable.factor(bar.A, bar.H));
  ASSERT_TRUE(own.factor(bar.A, bar.H));
  const Eigen::VectorXd b = Eigen::VectorXd::Ones(bar.A.cols());
  const Eigen::VectorXd x = portable.solve(b);
  EXPECT_LT((own.solve(b) - x).norm(), 1e-12 * x.norm());
  Eigen::MatrixXd expected, found;
  expected = portable.compliance();
  found = own.compliance();
  EXPECT_LT((found - expected).norm(), 1e-12 * expected.norm());
}

TEST_P(EveryKernel, TellsWhereSquaresHaveNoRoom) {
  const Bar bar = random_bar(6, 20, 0.0, 5);
  const auto plan = SparseFactor::make_plan(bar.A, bar.H);
  const Eigen::VectorXd b = Eigen::VectorXd::Ones(bar.A.cols());
  for (const double scale : {1e-140, 1e140}) {
    SparseFactor factor(plan, *kernels(GetParam()));
    ASSERT_TRUE(factor.factor(Matrix(scale * bar.A), bar.H)) << scale;
    const Eigen::VectorXd x = factor.solve(b);
    EXPECT_LT((scale * dense(bar.A) * x - b).norm(), 1e-11 * b.norm()) << scale;
  }
  for (const double scale : {1e-170, 1e-320, 1e170, 1e300}) {
    SparseFactor factor(plan, *kernels(GetParam()));
    EXPECT_FALSE(factor.factor(Matrix(scale * bar.A), bar.H)) << scale;
  }
}

TEST_P(EveryKernel, SinglePrecisionIsRefinedToDouble) {
  for (const int length : {2, 3, 9, 25}) {
    const Bar bar = random_bar(length, 3 * length, 0.0, static_cast<unsigned>(length));
    const Eigen::MatrixXd A = dense(bar.A), H = bar.H;
    const auto plan = SparseFactor::make_plan(bar.A, bar.H, {}, Precision::float32);
    SparseFactor factor(plan, *single::kernels(GetParam()));
    ASSERT_TRUE(factor.factor(bar.A, bar.H));
    EXPECT_EQ((dense(factor.assembled()) - A).norm(), 0.0);
    EXPECT_EQ(factor.negative(), 0);
    const Eigen::MatrixXd W = H * A.ldlt().solve(Eigen::MatrixXd(H.transpose()));
    Eigen::MatrixXd compliance;
    compliance = factor.compliance();
    EXPECT_LT((compliance - W).norm(), 1e-3 * W.norm());
    EXPECT_GT((compliance - W).norm(), 1e-9 * W.norm());  // it is what it says
    const Eigen::VectorXd b = Eigen::VectorXd::Random(A.rows()), u = Eigen::VectorXd::Random(H.rows());
    Eigen::VectorXd x = Eigen::VectorXd::Zero(A.rows()), y(A.rows()), back(A.rows()), r = b;
    double before = b.norm();
    for (int turn = 0; turn < 6; ++turn) {
      const Eigen::VectorXd part = factor.solve(r);
      x += part;
      factor.subtract_product(part, r);
      if (turn < 3) EXPECT_LT(r.norm(), 0.01 * std::exchange(before, r.norm()));
    }
    EXPECT_LT((A * x - b).norm(), 1e-15 * A.norm() * x.norm());
    y.setZero();
    factor.add_border_transposed(u, y);
    factor.back_solve(y, back);
    EXPECT_LT((A * back - H.transpose() * u).norm(), 1e-5 * A.norm() * back.norm());
    Eigen::VectorXd motion(H.rows());
    factor.half_solve(b, y);
    factor.border_times(y, motion);
    EXPECT_LT((motion - H * x).norm(), 1e-3 * (H * x).norm());
    Eigen::VectorXd along, moved;  // the same right side, eliminated beside the matrix
    const HalfSolve right{b, along, &moved};
    ASSERT_TRUE(factor.factor(threads::Crew::none(), &right));
    EXPECT_LT((along - y).norm(), 1e-4 * y.norm());
    EXPECT_LT((moved - H * x).norm(), 1e-3 * (H * x).norm());
  }
}

TEST(SparseFactor, APlanForDoublesDoesNotServeFloats) {
  const Bar bar = random_bar(4, 6, 0.0, 3);
  EXPECT_THROW(SparseFactor(SparseFactor::make_plan(bar.A, bar.H), single::kernels()), std::invalid_argument);
}

TEST_P(EveryKernel, RefusesWhatHasNoFactor) {
  Bar bar = random_bar(4, 6, 0.0, 3);
  SparseFactor factor(SparseFactor::make_plan(bar.A, bar.H), *kernels(GetParam()));
  const Matrix sound = bar.A;
  for (const double bad : {NAN, INFINITY}) {
    bar.A = sound;
    bar.A.valuePtr()[bar.A.nonZeros() / 2] = bad;
    EXPECT_FALSE(factor.factor(bar.A, bar.H));
  }
  bar.A = sound;
  for (int k = 0; k < bar.A.nonZeros(); ++k) bar.A.valuePtr()[k] = 0.0;
  EXPECT_FALSE(factor.factor(bar.A, bar.H));
  EXPECT_TRUE(factor.factor(sound, bar.H));
}

INSTANTIATE_TEST_SUITE_P(Fronts, EveryKernel, testing::Values("portable", "avx2", "avx512"),
                         [](const auto& tested) { return std::string(tested.param); });

Compressed columns(const Matrix& A) { return {static_cast<int>(A.cols()), A.outerIndexPtr(), A.innerIndexPtr()}; }

Fronts plan_of(const Bar& bar) {
  return plan_fronts(columns(bar.A), {static_cast<int>(bar.H.rows()), bar.H.outerIndexPtr(), bar.H.innerIndexPtr()});
}

TEST(Fronts, EachUnknownIsEliminatedOnceAndAllItMeetsAreInItsFront) {
  const Bar bar = random_bar(20, 30, 0.0, 5);
  const Fronts plan = plan_of(bar);
  EXPECT_EQ(std::set<int>(plan.place.begin(), plan.place.end()).size(), plan.place.size());
  EXPECT_EQ(*std::max_element(plan.place.begin(), plan.place.end()) + 1, static_cast<int>(plan.place.size()));
  int next = 0;
  for (const Front& front : plan.fronts) {
    EXPECT_EQ(front.first, next);
    next += front.columns;
    EXPECT_EQ(front.parent < 0, front.below == 0);
  }
  EXPECT_EQ(next, bar.A.cols());
  std::vector<std::set<int>> rows(plan.fronts.size());
  for (std::size_t s = 0; s < plan.fronts.size(); ++s) {
    const Front& front = plan.fronts[s];
    for (int i = 0; i < front.columns; ++i) rows[s].insert(front.first + i);
    for (const int i : plan.rows_below(front)) rows[s].insert(i);
  }
  for (Eigen::Index j = 0; j < bar.A.cols(); ++j) {
    for (Matrix::InnerIterator at(bar.A, j); at; ++at) {
      const auto [first, later] = std::minmax({plan.place[at.row()], plan.place[j]});
      const auto front = std::find_if(plan.fronts.begin(), plan.fronts.end(), [first = first](const Front& own) {
        return own.first <= first && first < own.first + own.columns;
      });
      EXPECT_TRUE(rows[static_cast<std::size_t>(front - plan.fronts.begin())].contains(later));
    }
  }
}

TEST(Fronts, UpdatesThatLiveAtOneTimeDoNotOverlap) {
  const Fronts plan = plan_of(random_bar(40, 30, 0.0, 6));
  ASSERT_GT(plan.fronts.size(), 10u);
  const auto end = [](const Front& front) {
    return front.update + static_cast<std::size_t>(front.update_stride) * static_cast<std::size_t>(front.below);
  };
  std::size_t all = 0;
  for (std::size_t s = 0; s < plan.fronts.size(); ++s) {
    const Front& own = plan.fronts[s];
    all += end(own) - own.update;
    EXPECT_LE(end(own), own.in_part ? plan.part_updates : plan.updates);
    for (std::size_t t = 0; t < s; ++t) {
      const Front& earlier = plan.fronts[t];
      if (earlier.parent < static_cast<int>(s) || earlier.below == 0 || own.below == 0) continue;
      if (earlier.in_part != own.in_part) continue;
      EXPECT_TRUE(end(earlier) <= own.update || end(own) <= earlier.update) << t << " and " << s;
    }
  }
  EXPECT_LT(plan.updates + plan.part_updates, all / 2);
}

/// Roots of parts wait for their parents whatever the order of the parts.
TEST(Fronts, UpdatesOfPartsDoNotOverlapThoseThatWait) {
  const Fronts plan = plan_of(random_cube(8, 30));
  std::vector<int> order;
  for (const Fronts::Part& part : plan.parts) order.push_back(part.end - 1);
  order.insert(order.end(), plan.top.begin(), plan.top.end());
  const auto end = [](const Front& front) {
    return front.update + static_cast<std::size_t>(front.update_stride) * static_cast<std::size_t>(front.below);
  };
  for (std::size_t k = 0; k < order.size(); ++k) {
    const Front& own = plan.fronts[static_cast<std::size_t>(order[k])];
    for (std::size_t j = 0; j < k; ++j) {
      const Front& earlier = plan.fronts[static_cast<std::size_t>(order[j])];
      const bool gone = k >= plan.parts.size() && earlier.parent < order[k];
      if (gone || earlier.below == 0 || own.below == 0) continue;
      EXPECT_TRUE(end(earlier) <= own.update || end(own) <= earlier.update) << j << " and " << k;
    }
  }
}

TEST(Fronts, PartsAreSubtreesThatShareNothing) {
  const Fronts plan = plan_of(random_cube(8, 30));
  ASSERT_GT(plan.parts.size(), 4u);
  std::vector<int> part(plan.fronts.size(), -1);
  for (std::size_t p = 0; p < plan.parts.size(); ++p) {
    for (int s = plan.parts[p].first; s < plan.parts[p].end; ++s) {
      EXPECT_EQ(std::exchange(part[static_cast<std::size_t>(s)], static_cast<int>(p)), -1);
    }
  }
  for (const int s : plan.top) EXPECT_EQ(part[static_cast<std::size_t>(s)], -1);
  EXPECT_EQ(std::count(part.begin(), part.end(), -1), static_cast<std::ptrdiff_t>(plan.top.size()));
  for (std::size_t s = 0; s < plan.fronts.size(); ++s) {
    const Front& own = plan.fronts[s];
    EXPECT_EQ(own.in_part, part[s] >= 0 && static_cast<int>(s) + 1 < plan.parts[static_cast<std::size_t>(part[s])].end);
    if (part[s] < 0) {
      EXPECT_TRUE(own.parent < 0 || part[static_cast<std::size_t>(own.parent)] < 0);
    } else if (own.parent >= 0 && part[static_cast<std::size_t>(own.parent)] != part[s]) {
      EXPECT_EQ(part[static_cast<std::size_t>(own.parent)], -1);
      EXPECT_EQ(static_cast<int>(s) + 1, plan.parts[static_cast<std::size_t>(part[s])].end);
    }
    for (std::size_t t = 0; t < s; ++t) {
      const Front& other = plan.fronts[t];
      if (part[s] < 0 || part[t] < 0 || part[s] == part[t]) continue;
      EXPECT_TRUE(other.border + other.borders <= own.border || own.border + own.borders <= other.border);
    }
  }
}

TEST(Fronts, CrewsOfAnySizeGiveTheSameBits) {
  const auto [A, H] = random_cube(13, 60);  // with fronts whose updates are cut into strips
  const auto plan = SparseFactor::make_plan(A, H);
  EXPECT_GT(std::max_element(plan->fronts.begin(), plan->fronts.end(),
                             [](const Front& a, const Front& b) { return a.columns < b.columns; })
                ->columns,
            300);
  const Eigen::VectorXd b = Eigen::VectorXd::Random(A.cols());
  SparseFactor alone(plan);
  ASSERT_TRUE(alone.factor(A, H));
  const Eigen::VectorXd x = alone.solve(b);
  Eigen::VectorXd y, u, own_y, own_u;
  const HalfSolve right{b, y, &u}, own_right{b, own_y, &own_u};
  ASSERT_TRUE(alone.factor(threads::Crew::none(), &right));
  EXPECT_LT((u - H * x).norm(), 1e-13 * u.norm());
  Eigen::MatrixXd W, own;
  W = alone.compliance();
  EXPECT_LT((A.selfadjointView<Eigen::Lower>() * x - b).norm(), 1e-13 * b.norm());
  for (int i = 0; i < 3; ++i) {
    const Eigen::VectorXd motion = H * alone.solve(Eigen::VectorXd(H.row(i).transpose()));
    EXPECT_LT((motion - W.col(i)).norm(), 1e-13 * W.norm());
  }
  for (const int size : {2, 3, 40}) {
    threads::Crew crew(size);
    SparseFactor factor(plan);
    for (int again = 0; again < 3; ++again) {
      ASSERT_TRUE(factor.factor(A, H, crew));
      own = factor.compliance();
      EXPECT_EQ(own, W);
      EXPECT_EQ(factor.solve(b), x);
      ASSERT_TRUE(factor.factor(crew, &own_right));
      EXPECT_EQ(own_y, y);
      EXPECT_EQ(own_u, u);
    }
  }
}

/// Whole nodes of up to three unknowns, whichever of them are held.
TEST(Fronts, SlotsPutTheSameMatrixTogether) {
  constexpr int n = 5;
  std::mt19937 draw(7);
  const Bar full = random_cube(n, 20);
  std::vector<int> unknown, slots;
  for (int i = 0; i < 3 * n * n * n; ++i) {
    const bool held = draw() % 5 == 0;
    unknown.push_back(held ? -1 : static_cast<int>(slots.size()));
    if (!held) slots.push_back(4 * (i / 3) + i % 3);
  }
  const auto size = static_cast<int>(slots.size());
  std::vector<Eigen::Triplet<double>> entries, rows;
  for (Eigen::Index j = 0; j < full.A.cols(); ++j) {
    for (Matrix::InnerIterator at(full.A, j); at; ++at) {
      if (unknown[at.row()] >= 0 && unknown[j] >= 0) entries.emplace_back(unknown[at.row()], unknown[j], at.value());
    }
    for (Eigen::Index i = j + 1; i < 3 * (j / 3 + 1); ++i) {  // coordinates of a node meet
      if (unknown[i] >= 0 && unknown[j] >= 0) entries.emplace_back(unknown[i], unknown[j], 0.5);
    }
  }
  for (int r = 0; r < 20; ++r) rows.emplace_back(r, static_cast<int>(draw() % static_cast<unsigned>(size)), 1.0);
  Bar held{Matrix(size, size), Rows(20, size)};
  held.A.setFromTriplets(entries.begin(), entries.end());
  held.H.setFromTriplets(rows.begin(), rows.end());
  for (const Precision precision : {Precision::float64, Precision::float32}) {
    SparseFactor nodes(SparseFactor::make_plan(held.A, held.H, slots, precision));
    EXPECT_LT(nodes.plan().blocks.size(), held.A.nonZeros() / 4);
    ASSERT_TRUE(nodes.factor(held.A, held.H));
    EXPECT_EQ((dense(nodes.assembled()) - dense(held.A)).norm(), 0.0);
    const Eigen::VectorXd b = Eigen::VectorXd::Random(size), x = nodes.solve(b);
    const double rounding = precision == Precision::float64 ? 1e-13 : 1e-5;
    EXPECT_LT((dense(held.A) * x - b).norm(), rounding * b.norm());
    Eigen::VectorXd r = b;
    nodes.subtract_product(x, r);
    EXPECT_LT((r - (b - dense(held.A) * x)).norm(), 1e-14 * b.norm());
    Eigen::MatrixXd W;
    W = nodes.compliance();
    const Eigen::MatrixXd H = held.H, expected = H * dense(held.A).llt().solve(Eigen::MatrixXd(H.transpose()));
    EXPECT_LT((W - expected).norm(), rounding * expected.norm());
  }
  std::vector<int> four = slots, apart = slots;
  four[1] = four[0] + 3;
  EXPECT_THROW(SparseFactor::make_plan(held.A, held.H, four), std::invalid_argument);
  apart.back() = apart.front();
  EXPECT_NO_THROW(SparseFactor::make_plan(held.A, held.H, apart));  // another node's number is no matter
  for (int i = 0; i < size; ++i) apart[static_cast<std::size_t>(i)] = 4 * (i / 2) + i % 2;  // nodes of two strangers
  EXPECT_THROW(SparseFactor::make_plan(held.A, held.H, apart), std::invalid_argument);
}

TEST(Fronts, UnknownsOfABorderRowMustMeet) {
  Bar bar = random_bar(20, 2, 0.0, 8);
  std::vector<Eigen::Triplet<double>> ends = {{0, 0, 1.0}, {0, static_cast<int>(bar.A.cols()) - 1, 1.0}};
  bar.H.setFromTriplets(ends.begin(), ends.end());
  EXPECT_THROW(plan_of(bar), std::invalid_argument);
}

TEST(Graph, UnknownsWithTheSameNeighboursAreOne) {
  // A chain of three nodes of two unknowns each, and the last one of the chain held in one direction.
  std::vector<Eigen::Triplet<double>> entries;
  for (const auto& [a, b] : std::vector<std::array<int, 2>>{
           {0, 0}, {1, 0}, {2, 0}, {3, 0}, {1, 1}, {2, 1}, {3, 1}, {2, 2}, {3, 2}, {4, 2}, {3, 3}, {4, 3}, {4, 4}})
    entries.emplace_back(a, b, 1.0);
  Matrix A(5, 5);
  A.setFromTriplets(entries.begin(), entries.end());
  const Graph graph = graph_of(5, A.outerIndexPtr(), A.innerIndexPtr());
  EXPECT_EQ(graph.weight, (std::vector<int>{2, 2, 1}));
  EXPECT_EQ(graph.member, (std::vector<int>{0, 1, 2, 3, 4}));
  EXPECT_EQ(graph.first, (std::vector<int>{0, 1, 3, 4}));
  EXPECT_EQ(graph.neighbour, (std::vector<int>{1, 0, 2, 1}));
  for (std::vector<int> order : {minimum_degree(graph), nested_dissection(graph)}) {
    std::sort(order.begin(), order.end());
    EXPECT_EQ(order, (std::vector<int>{0, 1, 2}));
  }
}

}  // namespace
}  // namespace sinew::linalg
