// Wrenches on their way to the base, eight at a time, beside one at a time.
#include "sinew/linalg/chain_kernels.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <string>

namespace sinew::linalg {
namespace {

class EveryChainKernel : public testing::TestWithParam<const char*> {};

TEST_P(EveryChainKernel, PassesLinks) {
  const ChainKernels* own = chain_kernels(GetParam());
  if (!own) GTEST_SKIP() << "this processor has no " << GetParam();
  for (const int columns : {0, 1, 3, 6}) {
    for (const int attachments : {0, 1, 4}) {
      for (const int first : {-7, -3, 0, 5}) {
        const int blocks = 3, count = first + blocks * kWrenches;
        const Eigen::MatrixXd T = Eigen::MatrixXd::Random(6, columns), Y = Eigen::MatrixXd::Random(6, columns);
        const Eigen::MatrixXd gamma = Eigen::MatrixXd::Random(6, attachments);
        Eigen::MatrixXd moving = Eigen::MatrixXd::Random(kWrenchNumbers, blocks), w(6, blocks * kWrenches);
        const auto wrench = [&](int l) {
          return Eigen::Matrix<double, 6, 1>(moving.col(l / kWrenches)(Eigen::seqN(l % kWrenches, 6, int{kWrenches})));
        };
        for (int l = 0; l < w.cols(); ++l) w.col(l) = wrench(l);
        Eigen::MatrixXd seen = Eigen::MatrixXd::Constant(count, attachments, 77.0);
        const Eigen::MatrixXd untouched = seen;
        own->pass({T.data(), Y.data(), columns, gamma.data(), attachments}, moving.data(), blocks, seen.data(), count,
                  first);
        const Eigen::MatrixXd expected = w.transpose() * gamma, after = w - Y * (T.transpose() * w);
        for (int l = 0; l < w.cols(); ++l) {
          EXPECT_LT((wrench(l) - after.col(l)).norm(), 1e-14 * (1.0 + after.col(l).norm()));
          if (first + l >= 0 && attachments > 0)
            EXPECT_LT((seen.row(first + l) - expected.row(l)).norm(), 1e-14 * (1.0 + expected.row(l).norm()));
        }
        if (first > 0) EXPECT_EQ(seen.topRows(first), untouched.topRows(first));
      }
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Chains, EveryChainKernel, testing::Values("portable", "avx2", "avx512"),
                         [](const auto& tested) { return std::string(tested.param); });

}  // namespace
}  // namespace sinew::linalg
