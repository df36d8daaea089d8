// Every kernel beside the same written with Eigen, over sizes around the width of registers and tiles.
#include "sinew/linalg/kernels.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <bit>
#include <string>
#include <vector>

namespace sinew::linalg {
namespace {

class Kernel : public testing::TestWithParam<const char*> {
 protected:
  void SetUp() override {
    own = kernels(GetParam());
    if (!own) GTEST_SKIP() << "this processor has no " << GetParam();
  }
  const Kernels* own = nullptr;
};

/// A matrix with room for whole registers behind its last row.
Eigen::MatrixXd roomy(Eigen::Index rows, Eigen::Index columns) {
  Eigen::MatrixXd A = Eigen::MatrixXd::Zero(whole_lanes(static_cast<int>(rows)) + kLanes, columns + 1);
  A.topLeftCorner(rows, columns).setRandom();
  return A;
}

Eigen::VectorXd random_signs(int n) {
  return Eigen::VectorXd::Random(n).unaryExpr([](double x) { return x < 0.0 ? -1.0 : 1.0; });
}

int stride(const Eigen::MatrixXd& A) { return static_cast<int>(A.outerStride()); }

/// C - A S A^T and - A S A^T by the kernel and by Eigen, on and below the diagonal.
void expect_update(const Kernels& kernels, int height, int columns, int depth, bool fresh,
                   const Eigen::VectorXd& signs) {
  const Eigen::MatrixXd A = roomy(height, depth), before = roomy(height, columns);
  Eigen::MatrixXd C = before;
  kernels.update(C.data(), stride(C), A.data(), stride(A), height, columns, depth, signs.data(), fresh);
  const Eigen::MatrixXd rows = A.topLeftCorner(height, depth);
  Eigen::MatrixXd expected = -rows * signs.asDiagonal() * rows.transpose();
  if (!fresh) expected.leftCols(columns) += before.topLeftCorner(height, columns);
  for (int j = 0; j < columns; ++j) {
    EXPECT_LT((C.col(j).segment(j, height - j) - expected.col(j).tail(height - j)).norm(), 1e-13 * (depth + 1));
    EXPECT_EQ(C.col(j).tail(kLanes).norm(), 0.0);  // behind whole lanes
  }
}

TEST_P(Kernel, Updates) {
  for (const int depth : {0, 1, 7, 16, 20}) {
    for (const int height : {0, 1, 2, 7, 8, 9, 17, 31, 50}) {
      for (const int columns : {height, height / 2, height / 3}) {
        for (const bool fresh : {false, true}) {
          Eigen::VectorXd signs = random_signs(depth);
          if (depth % 2 == 1) signs.setOnes();
          if (depth == 16) signs.setConstant(-1.0);
          expect_update(*own, height, columns, depth, fresh, signs);
        }
      }
    }
  }
}

/// Chunks of rows and of depth.
TEST_P(Kernel, UpdatesThatAreLarge) {
  for (const bool fresh : {false, true}) {
    expect_update(*own, 601, 500, 300, fresh, Eigen::VectorXd::Ones(300));
    expect_update(*own, 485, 485, 260, fresh, random_signs(260));
  }
}

/// The squares of kLanes columns on the diagonal of a panel between how they are and how they are kept, with the
/// transposed inverse in place of their triangle.
void invert_squares(Eigen::MatrixXd& panel, int columns) {
  for (int first = 0; first < columns; first += kLanes) {
    const int size = std::min(kLanes, columns - first);
    auto square = panel.block(first, first, size, size);
    square = Eigen::MatrixXd(square.inverse().transpose());  // triangles both: one lower, one upper
  }
}

TEST_P(Kernel, FactorsPanels) {
  for (const int columns : {1, 2, 3, 7, 8, 9, 15, 16, 24, 41}) {
    for (const int more : {0, 1, 5, 8, 30}) {
      for (const bool definite : {true, false}) {
        const int height = columns + more;
        const Eigen::MatrixXd B = Eigen::MatrixXd::Random(height, height);
        Eigen::MatrixXd A = B + B.transpose();
        for (int i = 0; i < height; ++i) A(i, i) = (definite || i % 3 != 1 ? 1.0 : -1.0) * (2.0 * height + i);
        Eigen::MatrixXd panel = Eigen::MatrixXd::Zero(whole_lanes(height), columns);
        panel.topRows(height) = A.leftCols(columns);
        Eigen::VectorXd pivots(columns), signs(columns);
        ASSERT_TRUE(own->factor(panel.data(), stride(panel), columns, height, pivots.data(), signs.data()));
        for (int first = 0; first < columns; first += kLanes) {
          const int size = std::min(kLanes, columns - first);
          const Eigen::MatrixXd square = panel.block(first, first, size, size);
          EXPECT_TRUE(square.isUpperTriangular(0.0));
        }
        Eigen::MatrixXd P = panel.topRows(height);
        invert_squares(P, columns);
        P.topRows(columns).triangularView<Eigen::StrictlyUpper>().setZero();
        const Eigen::MatrixXd product = P * signs.asDiagonal() * P.topRows(columns).transpose();
        EXPECT_LT((product - A.leftCols(columns)).norm(), 1e-13 * A.norm()) << columns << " x " << height;
        EXPECT_LT((P.diagonal().cwiseAbs2().cwiseProduct(signs) - pivots).norm(), 1e-13 * A.norm());
        EXPECT_EQ((signs.array() < 0.0).any(), !definite && columns > 1);
        EXPECT_EQ(panel.bottomRows(panel.rows() - height).norm(), 0.0);
      }
    }
  }
}

/// Nodes of which some coordinates are held, a panel of the first ones' columns.
TEST_P(Kernel, StartsPanelsFromTheirBlocks) {
  constexpr std::array<std::uint8_t, 7> kSlots = {7, 7, 5, 7, 2, 7, 3};
  std::array<int, 8> first{};  // unknown of each node, and their number
  for (std::size_t i = 0; i < kSlots.size(); ++i) first[i + 1] = first[i] + std::popcount(kSlots[i]);
  for (const int own_nodes : {1, 3, 5, 7}) {
    const int columns = first[static_cast<std::size_t>(own_nodes)], height = first.back();
    Eigen::MatrixXd panel = Eigen::MatrixXd::Constant(whole_lanes(height) + kLanes, columns, NAN);
    Eigen::MatrixXd expected = Eigen::MatrixXd::Zero(panel.rows(), columns);
    std::vector<Block> blocks;
    std::vector<double> numbers;
    for (std::size_t j = 0; j < static_cast<std::size_t>(own_nodes); ++j) {
      for (std::size_t i = j; i < kSlots.size(); ++i) {
        if ((i + j) % 4 == 3) continue;  // nodes that do not meet
        const Eigen::Matrix3d entries = Eigen::Matrix3d::Random();
        for (int c = 0; c < 3; ++c) {
          for (int r = 0; r < 4; ++r) numbers.push_back(r < 3 ? entries(r, c) : 0.0);
        }
        blocks.push_back({static_cast<std::uint32_t>(first[i] + first[j] * stride(panel)), kSlots[i], kSlots[j]});
        for (int c = 0, column = first[j]; c < 3; ++c) {
          if (!(kSlots[j] >> c & 1)) continue;
          for (int r = 0, row = first[i]; r < 3; ++r) {
            if (kSlots[i] >> r & 1) expected(row++, column) = entries(r, c);
          }
          ++column;
        }
      }
    }
    own->start(panel.data(), stride(panel), columns, blocks.data(), static_cast<int>(blocks.size()), numbers.data());
    for (int j = 0; j < columns; ++j)
      EXPECT_EQ(panel.col(j).tail(panel.rows() - j), expected.col(j).tail(panel.rows() - j)) << j << " of " << columns;
  }
}

TEST_P(Kernel, RefusesPivotsThatAreNone) {
  for (const double bad : {0.0, static_cast<double>(NAN), static_cast<double>(INFINITY)}) {
    for (const int at : {0, 5, 12}) {
      Eigen::MatrixXd panel = Eigen::MatrixXd::Identity(16, 13);
      panel(at, at) = bad;
      Eigen::VectorXd pivots(13), signs(13);
      EXPECT_FALSE(own->factor(panel.data(), 16, 13, 13, pivots.data(), signs.data()));
    }
  }
}

TEST_P(Kernel, SolvesAndMultiplies) {
  for (const int columns : {1, 3, 8, 9, 21}) {
    for (const int height : {0, 1, 7, 8, 33, 70}) {
      const Eigen::MatrixXd A = roomy(height, columns);
      const Eigen::MatrixXd rows = A.topLeftCorner(height, columns);
      const Eigen::VectorXd x = Eigen::VectorXd::Random(columns);
      Eigen::VectorXd y = Eigen::VectorXd::Random(whole_lanes(height));
      const Eigen::VectorXd before = y;
      own->multiply(A.data(), stride(A), height, columns, x.data(), y.data());
      EXPECT_LT((y.head(height) - (before.head(height) - rows * x)).norm(), 1e-13 * (1 + columns));
      Eigen::VectorXd back = x;
      own->multiply_transposed(A.data(), stride(A), height, columns, before.data(), back.data());
      EXPECT_LT((back - (x - rows.transpose() * before.head(height))).norm(), 1e-13 * (1 + height));
    }
    Eigen::MatrixXd P = roomy(whole_lanes(columns), columns);  // below the square are other rows
    for (int i = 0; i < columns; ++i) P(i, i) += 5.0;
    const Eigen::MatrixXd L = P.topLeftCorner(columns, columns).triangularView<Eigen::Lower>();
    P.topLeftCorner(columns, columns) = L;
    invert_squares(P, columns);
    Eigen::VectorXd y = Eigen::VectorXd::Random(whole_lanes(columns) + kLanes);
    const Eigen::VectorXd right = y.head(columns);
    own->solve(P.data(), stride(P), columns, y.data());
    EXPECT_LT((L * y.head(columns) - right).norm(), 1e-12);
    y.head(columns) = right;
    own->solve_transposed(P.data(), stride(P), columns, y.data());
    EXPECT_LT((L.transpose() * y.head(columns) - right).norm(), 1e-12);
  }
}

INSTANTIATE_TEST_SUITE_P(Kernels, Kernel, testing::Values("portable", "avx2", "avx512"),
                         [](const auto& tested) { return std::string(tested.param); });

}  // namespace
}  // namespace sinew::linalg
