// Factors of sparse matrices against the same matrices written out, and when they are refused.
#include "sinew/linalg/sparse_factor.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <Eigen/OrderingMethods>
#include <Eigen/SparseCholesky>
#include <array>
#include <vector>

namespace sinew::linalg {
namespace {

using Matrix = SparseFactor::Matrix;

/// Springs between masses (other = -1: the ground).
struct Spring {
  int one, other;
  double stiffness;
};

Matrix structure(int masses, const std::vector<Spring>& springs) {
  std::vector<Eigen::Triplet<double>> entries;
  for (const auto& [a, b, k] : springs) {
    entries.emplace_back(a, a, k);
    if (b < 0) continue;
    entries.emplace_back(b, b, k);
    entries.emplace_back(std::max(a, b), std::min(a, b), -k);
  }
  Matrix A(masses, masses);
  A.setFromTriplets(entries.begin(), entries.end());
  return A;
}

Eigen::MatrixXd written_out(const Matrix& A) { return Eigen::MatrixXd(A).selfadjointView<Eigen::Lower>(); }

/// n x n x n masses, each tied to its neighbours and weakly to the ground.
Matrix grid(int n) {
  std::vector<Spring> springs;
  const auto number = [n](int i, int j, int k) { return (i * n + j) * n + k; };
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < n; ++j) {
      for (int k = 0; k < n; ++k) {
        springs.push_back({number(i, j, k), -1, 0.01});
        if (i + 1 < n) springs.push_back({number(i, j, k), number(i + 1, j, k), 1.0});
        if (j + 1 < n) springs.push_back({number(i, j, k), number(i, j + 1, k), 2.0});
        if (k + 1 < n) springs.push_back({number(i, j, k), number(i, j, k + 1), 3.0});
      }
    }
  }
  return structure(n * n * n, springs);
}

TEST(SparseFactor, SolvesAndCountsNegativeEigenvaluesAsTheMatrixWrittenOut) {
  Matrix A = grid(4);
  const Eigen::VectorXd b = Eigen::VectorXd::Random(A.rows());
  SparseFactor factor(SparseFactor::make_plan(A));
  for (const double shift : {0.0, 2.0, 5.0}) {
    A.diagonal().array() -= shift;
    ASSERT_TRUE(factor.factor(A));
    const Eigen::VectorXd expected = written_out(A).partialPivLu().solve(b);
    EXPECT_LT((factor.solve(b) - expected).norm(), 1e-10 * expected.norm());
    const auto values = Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(written_out(A)).eigenvalues();
    EXPECT_EQ(factor.negative(), (values.array() < 0.0).count());
    EXPECT_EQ(factor.negative() > 0, shift > 0.0);
  }
}

TEST(SparseFactor, LargeBodiesFillInLessThanByMinimumDegreeAndSmallOnesNoMore) {
  for (const int n : {1, 2, 5, 20}) {
    const Matrix A = grid(n);
    Eigen::SimplicialLDLT<Matrix, Eigen::Lower, Eigen::AMDOrdering<int>> by_degree;
    by_degree.compute(A);
    // What fills in, in the plan's order; the zeros of merged fronts are not counted.
    const auto plan = SparseFactor::make_plan(A);
    const Eigen::PermutationMatrix<Eigen::Dynamic, Eigen::Dynamic, int> P(
        Eigen::Map<const Eigen::VectorXi>(plan->place.data(), A.cols()));
    Matrix ordered;
    ordered.selfadjointView<Eigen::Lower>() = A.selfadjointView<Eigen::Lower>().twistedBy(P);
    Eigen::SimplicialLDLT<Matrix, Eigen::Lower, Eigen::NaturalOrdering<int>> as_planned;
    as_planned.compute(ordered);
    const auto bound = static_cast<double>(by_degree.matrixL().nestedExpression().nonZeros());
    EXPECT_LE(static_cast<double>(as_planned.matrixL().nestedExpression().nonZeros()), (n < 20 ? 1.0 : 0.9) * bound)
        << n;
  }
}

TEST(SparseFactor, GivesPartsOfTheComplianceInAnyOrder) {
  const Matrix A = grid(4);
  constexpr int kRows = 20;  // more than a register beside the diagonal, above which kernels leave anything
  SparseFactor::Rows H(kRows, A.cols());
  for (int i = 0; i < kRows; ++i) {
    H.insert(i, 2 * i) = 1.0 + i;
    H.insert(i, 2 * i + 1) = -0.5;
  }
  H.makeCompressed();
  for (const Precision precision : {Precision::float64, Precision::float32}) {
    SparseFactor factor(SparseFactor::make_plan(A, H, {}, precision));
    ASSERT_TRUE(factor.factor(A, H));
    const Eigen::MatrixXd W = factor.compliance();
    const double tolerance = precision == Precision::float64 ? 1e-12 : 1e-5;
    EXPECT_LT((W - Eigen::MatrixXd(H) * written_out(A).ldlt().solve(Eigen::MatrixXd(H).transpose())).norm(),
              tolerance * W.norm());
    Eigen::VectorXi row(kRows);  // at each place
    for (int i = 0; i < kRows; ++i) row[factor.plan().border[static_cast<std::size_t>(i)]] = i;
    Eigen::VectorXd column;
    for (int place = 0; place < kRows; ++place) {
      factor.kept_column(place, column);
      for (int i = 0; i < kRows; ++i) EXPECT_EQ(column[i], W(row[i], row[place]));
    }
    for (const std::vector<int>& places :
         {std::vector{0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15, 16, 17, 18, 19}, std::vector{1, 2, 5},
          std::vector{19}, std::vector{0, 2, 4, 6, 19}, std::vector{19, 1, 2, 0},
          std::vector{17, 18, 19, 0, 1, 2, 7, 8, 9}, std::vector<int>{}}) {
      std::vector<linalg::Run> runs;
      for (std::size_t k = 0; k < places.size(); ++k) {
        if (k > 0 && places[k] == places[k - 1] + 1) {
          ++runs.back().length;
        } else {
          runs.push_back({places[k], static_cast<int>(k), 1});
        }
      }
      Eigen::MatrixXd part;
      factor.kept_compliance(runs, part);
      ASSERT_EQ(part.rows(), static_cast<Eigen::Index>(places.size()));
      for (std::size_t j = 0; j < places.size(); ++j) {
        for (std::size_t i = j; i < places.size(); ++i)
          EXPECT_EQ(part(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)),
                    W(row[places[i]], row[places[j]]));
      }
    }
  }
}

TEST(SparseFactor, MassesWithoutNeighboursAreNoObstacle) {
  const Matrix A = structure(3, {{0, -1, 1.0}, {1, -1, 2.0}, {2, -1, 4.0}});
  SparseFactor factor(SparseFactor::make_plan(A));
  ASSERT_TRUE(factor.factor(A));
  EXPECT_LT((factor.solve(Eigen::VectorXd::Ones(3)) - Eigen::Vector3d(1.0, 0.5, 0.25)).norm(), 1e-14);
}

/// A cantilever of E = 100 kPa, 1 x 1 x 100 mm, in a hundred hinges w_(i-1) - 2 w_i + w_(i+1), its stiffness E h / 12
/// each, beside a spring of 1e9 N/m. The tip is tied to all, so that it comes last: its pivot is then the stiffness of
/// the whole, E h / 4 (h / L)^3.
TEST(SparseFactor, ASlenderBodyBesideAStiffSpringIsSound) {
  constexpr int n = 100;
  constexpr double tip = 1e5 * 1e-3 / 4 * 1e-6;
  std::vector<Eigen::Triplet<double>> entries;
  for (int i = 0; i < n; ++i) {  // masses 0 .. n - 1, at and before the clamp w = 0
    const std::array<int, 3> at = {i - 2, i - 1, i};
    const std::array<double, 3> weight = {1.0, -2.0, 1.0};
    for (std::size_t a = 0; a < 3; ++a) {
      for (std::size_t b = 0; b < 3; ++b) {
        if (at[a] >= at[b] && at[b] >= 0) entries.emplace_back(at[a], at[b], 1e5 * 1e-3 / 12 * weight[a] * weight[b]);
      }
    }
    if (i + 1 < n) entries.emplace_back(n - 1, i, 0.0);
  }
  entries.emplace_back(n, n, 1e9);
  Matrix A(n + 1, n + 1);
  A.setFromTriplets(entries.begin(), entries.end());
  SparseFactor factor(SparseFactor::make_plan(A));
  ASSERT_TRUE(factor.factor(A));
  EXPECT_EQ(factor.negative(), 0);
  const Eigen::VectorXd x = factor.solve(Eigen::VectorXd::Unit(n + 1, n - 1));
  EXPECT_NEAR(tip * x[n - 1], 1.0, 0.05);
}

/// A stiff truss of 20 masses and a soft one, tied together. What is left of the last pivot, a soft one, is the
/// rounding of the stiff ones, and large beside the soft springs.
TEST(SparseFactor, AStiffAndASoftPartThatFloatTogetherAreSingular) {
  for (const double stiff : {1.0, 1e3, 1e6, 1e9, 1e12}) {
    std::vector<Spring> springs;
    for (int i = 0; i < 40; ++i) {
      for (int j = i + 1; j < 40 && j < i + 7; ++j) {
        const double k = 1.0 / (3.0 + (7 * i + 3 * j) % 11);
        springs.push_back({i, j, j < 20 ? stiff * k : k});
      }
      springs.push_back({i, 40, 0.01 / (1.0 + i)});  // tied to all, it comes last
    }
    Matrix A = structure(41, springs);
    SparseFactor factor(SparseFactor::make_plan(A));
    EXPECT_FALSE(factor.factor(A)) << stiff;
    A.coeffRef(0, 0) += 1e-3 * stiff;  // held
    EXPECT_TRUE(factor.factor(A)) << stiff;
  }
}

}  // namespace
}  // namespace sinew::linalg
