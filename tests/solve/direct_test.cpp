#include "sinew/solve/direct.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <algorithm>
#include <vector>

namespace sinew::solve {
namespace {

Eigen::MatrixXd waves(int rows, int columns, double phase) {
  return Eigen::MatrixXd::NullaryExpr(rows, columns, [phase](Eigen::Index i, Eigen::Index j) {
    return std::sin(phase + 1.7 * static_cast<double>(i * i) + 2.3 * static_cast<double>(j) +
                    static_cast<double>(i * j));
  });
}

void put(Entries& entries, const Eigen::MatrixXd& M) {
  entries.clear();
  entries.add(0, 0, M);
}

Eigen::MatrixXd dense(const Entries& entries, const Eigen::VectorXd& rows, const Eigen::VectorXd& columns) {
  Eigen::MatrixXd M = Eigen::MatrixXd::Zero(rows.size(), columns.size());
  for (const auto& [row, column, value] : entries) M(row, column) += value;
  return M;
}
Eigen::MatrixXd B_of(const CoupledProblem& p) { return dense(p.B, p.r, p.r); }
Eigen::MatrixXd G_of(const CoupledProblem& p) { return dense(p.G, p.c, p.r); }

CoupledProblem problem(int nz, int rows) {
  const Eigen::MatrixXd b = waves(nz, nz, 0.1), w = waves(rows, rows, 0.7);
  CoupledProblem p;
  put(p.B, 1e-4 * (b * b.transpose() + Eigen::MatrixXd::Identity(nz, nz)));  // as a thin rod: small
  VolumePart& volume = p.volumes.emplace_back();
  volume.W = 1e-3 * (w * w.transpose() + 0.1 * Eigen::MatrixXd::Identity(rows, rows));
  for (int i = 0; i < rows; ++i) volume.at.push_back(i);
  put(p.G, waves(rows, nz, 0.3));
  p.r = waves(nz, 1, 0.5);
  p.c = 1e-2 * waves(rows, 1, 0.9);
  return p;
}

TEST(Direct, agrees_with_eliminating_the_rods_first_as_the_paper_does) {
  const CoupledProblem p = problem(7, 5);
  const CoupledSolution solution = solve_direct(p);
  ASSERT_TRUE(solution.ok);
  EXPECT_FALSE(solution.redundant);
  const Eigen::MatrixXd Binv = B_of(p).inverse(), G = G_of(p);
  const Eigen::MatrixXd W = p.volumes[0].W + G * Binv * G.transpose();     // (11)
  const Eigen::VectorXd lambda = -W.ldlt().solve(p.c + G * (Binv * p.r));  // (12)
  EXPECT_LT((solution.dlambda - lambda).norm(), 1e-10 * lambda.norm());
  EXPECT_LT((solution.dz + Binv * (p.r + G.transpose() * lambda)).norm(), 1e-9 * solution.dz.norm());
}

TEST(Direct, needs_no_inverse_of_the_rods_matrix) {
  CoupledProblem p = problem(4, 6);
  Eigen::MatrixXd B = B_of(p);
  const Eigen::MatrixXd G = G_of(p);
  B.row(2).setZero();
  B.col(2).setZero();  // the abscissa of a point on a straight cable
  put(p.B, B);
  const CoupledSolution solution = solve_direct(p);
  ASSERT_TRUE(solution.ok);
  EXPECT_LT((B * solution.dz + G.transpose() * solution.dlambda + p.r).norm(), 1e-11);
  EXPECT_LT((G * solution.dz - p.volumes[0].W * solution.dlambda - p.c).norm(), 1e-11);
}

TEST(Direct, repeated_rows_that_agree_are_survived) {
  CoupledProblem p = problem(7, 3);
  p.volumes.clear();
  Eigen::MatrixXd G = G_of(p);
  G.row(2) = G.row(1);
  put(p.G, G);
  p.c[2] = p.c[1];
  const CoupledSolution solution = solve_direct(p);
  ASSERT_TRUE(solution.ok);
  EXPECT_TRUE(solution.redundant);
  EXPECT_LT((G * solution.dz - p.c).norm(), 1e-9);
  EXPECT_NEAR(solution.dlambda[1], solution.dlambda[2], 1e-7 * solution.dlambda.norm());  // the load is shared
}

// Of two unknowns that nothing couples to the rest, one has a little stiffness and one only rounding of either sign.
TEST(Direct, what_nothing_resists_counts_as_no_negative_eigenvalue) {
  for (const double rounding : {-1e-19, 0.0, 1e-19}) {
    for (const double little : {-1e-9, 1e-9}) {
      CoupledProblem p = problem(7, 3);
      Eigen::MatrixXd B = B_of(p), G = G_of(p);
      for (const int i : {2, 5}) {
        B.row(i).setZero();
        B.col(i).setZero();
        G.col(i).setZero();
      }
      B(2, 2) = rounding;
      B(5, 5) = little;
      put(p.B, B);
      put(p.G, G);
      p.reference.setZero(7);
      p.reference[2] = p.reference[5] = 1e-3;
      CoupledFactor factor;
      factor.eliminate_chains(p);
      factor.factor();
      const MatrixInertia inertia = factor.inertia();
      EXPECT_EQ(inertia.negative, 3 + (little < 0.0)) << rounding << ' ' << little;
      EXPECT_EQ(inertia.null_unknowns, std::vector<int>{2}) << rounding << ' ' << little;
    }
  }
}

TEST(Direct, contradicting_rows_are_refused) {
  CoupledProblem p = problem(7, 3);
  p.volumes.clear();
  Eigen::MatrixXd G = G_of(p);
  G.row(2) = G.row(1);
  put(p.G, G);
  p.c[2] = p.c[1] + 1.0;
  EXPECT_FALSE(solve_direct(p).ok);
}

TEST(Direct, numbers_that_are_not_finite_are_refused) {
  CoupledProblem p = problem(3, 2);
  p.B.add(1, 1, std::nan(""));
  EXPECT_FALSE(solve_direct(p).ok);
}

TEST(Direct, nothing_to_solve_is_fine) { EXPECT_TRUE(solve_direct(problem(0, 0)).ok); }

/// A problem with two chains, one of them with an unsymmetric matrix, attached to the border in every way there is.
CoupledProblem chained(bool symmetric) {
  CoupledProblem p = problem(7, 5);
  srand(3);
  for (int n = 0; n < 2; ++n) {
    ChainPart part;
    part.chain = linalg::make_chain({3, 2, 3, 3}, symmetric || n == 0);
    part.chain.T.setRandom();
    part.chain.V.setRandom();
    if (!part.chain.symmetric()) part.chain.U.setRandom();
    for (int k = 0; k < part.chain.links(); ++k) {
      const Eigen::MatrixXd b = Eigen::MatrixXd::Random(part.chain.size(k), part.chain.size(k));
      part.chain.block(k) = b + b.transpose() + 8.0 * Eigen::MatrixXd::Identity(b.rows(), b.cols());
    }
    part.base = linalg::Matrix6X::Random(6, 2);
    part.first_base = 2 * n;
    part.r = Eigen::VectorXd::Random(11);
    for (const int link : {0, 1, 1, 3}) {
      part.attachments.push_back({link, linalg::Vec6::Random(), Eigen::VectorXd::Random(part.chain.size(link))});
      part.at.push_back(4 + static_cast<int>(part.at.size()) + 2 * n);  // unknowns and rows
    }
    part.whole = Eigen::MatrixXd::Random(11, 1);
    part.whole_at = {7 + 2};  // a row
    p.chains.push_back(part);
  }
  return p;
}

/// Rows that give way by themselves, each holding one unknown, in their order or the other way round.
CoupledProblem paired(bool reversed) {
  constexpr int kPairs = 24;
  CoupledProblem p;
  for (int i = 0; i < kPairs; ++i) {
    p.B.add(i, i, 1.0 + 0.1 * i);
    p.W.add(i, i, 1.0 + 0.2 * i);
    p.G.add(i, reversed ? kPairs - 1 - i : i, 2.0 - 0.05 * i);
  }
  p.r = waves(kPairs, 1, 0.5);
  p.c = waves(kPairs, 1, 0.9);
  return p;
}

/// One solver after the other problem, whose numbers stand elsewhere, or are more, or fewer.
TEST(Direct, a_solver_is_used_again_for_other_patterns) {
  CoupledProblem moved = problem(7, 5), more = problem(7, 5);
  Eigen::MatrixXd B = B_of(moved);
  B.row(3).setZero();
  B.col(3).setZero();
  moved.B.clear();
  for (int i = 0; i < 7; ++i) moved.B.add(i, i, B(i, i) + 1e-3);
  std::reverse(moved.volumes[0].at.begin(), moved.volumes[0].at.end());
  more.volumes[0].at = {0, 1, 2};
  more.volumes[0].W = Eigen::MatrixXd(more.volumes[0].W.topLeftCorner(3, 3));
  more.W.add(3, 3, 1e-3);
  more.W.add(4, 4, 1e-3);
  CoupledFactor factor;
  const std::vector<CoupledProblem> problems = {problem(7, 5), moved, more,          chained(true),
                                                problem(3, 2), moved, paired(false), paired(true)};
  for (const CoupledProblem& own : problems) {
    factor.eliminate_chains(own);
    factor.factor();
    RightSide right;
    right_side(own, right);
    CoupledSolution solution;
    factor.answer(right, solution);  // not refined: it tells how good the factor is
    const CoupledSolution expected = solve_direct(own);
    ASSERT_TRUE(solution.ok && expected.ok);
    EXPECT_LT((solution.dlambda - expected.dlambda).norm(), 1e-9 * expected.dlambda.norm());
    EXPECT_LT((solution.dz - expected.dz).norm(), 1e-9 * expected.dz.norm());
  }
}

class Chains : public testing::TestWithParam<bool> {};

/// A point that nothing gives way to along the rod that slides through it: its row has no compliance there, and the
/// abscissa nothing but this row.
TEST(Direct, a_row_that_nothing_gives_way_to_holds_its_unknown) {
  for (const double w : {0.0, 1e-19, 1e-12}) {
    CoupledProblem p = problem(5, 6);
    Eigen::MatrixXd B = B_of(p), G = G_of(p);
    B.row(4).setZero();
    B.col(4).setZero();
    G.col(4).setZero();
    G(2, 4) = 1.0;
    put(p.B, B);
    put(p.G, G);
    Eigen::MatrixXd& W = p.volumes[0].W;
    W.row(2).setZero();
    W.col(2).setZero();
    W(2, 2) = w;
    const CoupledSolution solution = solve_direct(p);
    ASSERT_TRUE(solution.ok);
    EXPECT_FALSE(solution.redundant);
    EXPECT_LT(solution.residual, 1e-12);
    EXPECT_LT((B * solution.dz + G.transpose() * solution.dlambda + p.r).norm(), 1e-11);
    EXPECT_LT((G * solution.dz - W * solution.dlambda - p.c).norm(), 1e-11);
    CoupledFactor factor;
    factor.eliminate_chains(p);
    factor.factor();
    const auto values = Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(written_out(p)).eigenvalues();
    EXPECT_EQ(factor.inertia().negative, (values.array() < 0.0).count());
  }
}

TEST_P(Chains, eliminated_or_written_out_give_the_same) {
  const CoupledProblem p = chained(GetParam());
  const CoupledSolution solution = solve_direct(p);
  ASSERT_TRUE(solution.ok);
  const Eigen::MatrixXd K = written_out(p);
  EXPECT_EQ((K - K.transpose()).norm() < 1e-12, GetParam());
  Eigen::VectorXd b(K.rows()), y(K.rows());
  b << -p.r, p.c, -p.chains[0].r, -p.chains[1].r;
  y << solution.dz, solution.dlambda, solution.dq[0], solution.dq[1];
  EXPECT_LT((K * y - b).norm(), 1e-11 * b.norm());
}

/// Nothing is refined in an answer, so it tells how good the factor itself is; some attachments share an unknown.
TEST(ChainAnswers, are_solutions_and_as_good_as_solved_ones_once_they_are_polished) {
  CoupledProblem p = chained(true);
  for (ChainPart& part : p.chains) part.at[2] = part.at[0];
  const Eigen::MatrixXd K = written_out(p);
  RightSide right;
  right_side(p, right);
  Eigen::VectorXd b(K.rows());
  b << -p.r, p.c, -p.chains[0].r, -p.chains[1].r;
  const auto left = [&](const CoupledSolution& solution) {
    Eigen::VectorXd y(K.rows());
    y << solution.dz, solution.dlambda, solution.dq[0], solution.dq[1];
    return (K * y - b).norm() / (b.norm() * y.norm());
  };
  CoupledFactor factor;
  factor.eliminate_chains(p);
  factor.factor();
  CoupledSolution solution;
  factor.answer(right, solution);
  ASSERT_TRUE(solution.ok);
  EXPECT_LT(left(solution), 1e-11);
  solution.dz *= 1.001;
  EXPECT_FALSE(factor.polish(right, solution));
  EXPECT_TRUE(solution.ok);
  EXPECT_LT(solution.residual, 1e-12);
  EXPECT_LT(left(solution), 1e-13);
  solution.dz.setConstant(1e3);
  factor.polish(right, solution);
  EXPECT_TRUE(solution.ok);
  EXPECT_LT(left(solution), 1e-13);
  EXPECT_TRUE(factor.polish(right, solution));
  EXPECT_LT(left(solution), 1e-13);
  // Chains that do not push are passed over.
  for (Eigen::VectorXd& own : right.chains) own.setZero();
  b.tail(p.chains[0].r.size() + p.chains[1].r.size()).setZero();
  factor.answer(right, solution);
  EXPECT_LT(left(solution), 1e-11);
}

TEST_P(Chains, a_chain_that_only_the_rows_hold_joins_the_border) {
  CoupledProblem p = chained(GetParam());
  p.chains[1].chain.block(2).setZero();  // no pivot of its own
  p.chains[1].chain.T.middleCols(5, 3).setZero();
  const CoupledSolution solution = solve_direct(p);
  ASSERT_TRUE(solution.ok);
  const Eigen::MatrixXd K = written_out(p);
  Eigen::VectorXd b(K.rows()), y(K.rows());
  b << -p.r, p.c, -p.chains[0].r, -p.chains[1].r;
  y << solution.dz, solution.dlambda, solution.dq[0], solution.dq[1];
  EXPECT_LT((K * y - b).norm(), 1e-8 * b.norm() * y.norm());
}

TEST(Chains, negative_eigenvalues_are_counted_through_the_elimination) {
  CoupledProblem p = chained(true);
  for (const double shift : {0.0, 6.0, 12.0}) {
    CoupledProblem shifted = p;
    for (int k = 0; k < 4; ++k) shifted.chains[0].chain.block(k).diagonal().array() -= shift;
    CoupledFactor factor;
    factor.eliminate_chains(shifted);
    factor.factor();
    const auto values = Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(written_out(shifted)).eigenvalues();
    EXPECT_EQ(factor.inertia().negative, (values.array() < 0.0).count()) << shift;
  }
}

INSTANTIATE_TEST_SUITE_P(SymmetricOrNot, Chains, testing::Bool());

}  // namespace
}  // namespace sinew::solve
