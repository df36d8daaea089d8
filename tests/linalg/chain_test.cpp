// The recursions of a chain against the same matrix written out.
#include "sinew/linalg/chain.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>

namespace sinew::linalg {
namespace {

Chain random_chain(const std::vector<int>& sizes, bool symmetric) {
  srand(7);
  Chain chain = make_chain(sizes, symmetric);
  chain.T.setRandom();
  chain.V.setRandom();
  if (!symmetric) chain.U.setRandom();
  for (int k = 0; k < chain.links(); ++k) {
    Eigen::MatrixXd block = Eigen::MatrixXd::Random(chain.size(k), chain.size(k));
    if (symmetric) block = (block + block.transpose()).eval();
    chain.block(k) = block + 6.0 * Eigen::MatrixXd::Identity(chain.size(k), chain.size(k));
  }
  return chain;
}

class ChainLaws : public testing::TestWithParam<bool> {};

TEST_P(ChainLaws, SolveAndMultiplyAreThoseOfTheMatrixWrittenOut) {
  const Chain chain = random_chain({3, 1, 0, 2, 5, 3, 9, 4, 6}, GetParam());
  const Eigen::MatrixXd A = dense(chain);
  EXPECT_EQ((A - A.transpose()).norm() < 1e-12, GetParam());
  ChainFactor factor;
  ASSERT_TRUE(factor.factor(chain));
  const Eigen::VectorXd b = Eigen::VectorXd::Random(chain.coordinates());
  const Vec6 tau = Vec6::Random();
  const Matrix6X& U = chain.symmetric() ? chain.V : chain.U;
  Vec6 base;
  Eigen::VectorXd x = b, back;
  factor.solve(x, tau, &base);
  const Eigen::VectorXd expected = A.partialPivLu().solve(b - U.transpose() * tau);
  EXPECT_LT((x - expected).norm(), 1e-11 * expected.norm());
  EXPECT_LT((base - chain.V * expected).norm(), 1e-11 * base.norm());
  Vec6 felt;
  multiply(chain, x, tau, back, felt);
  EXPECT_LT((back - b).norm(), 1e-11 * b.norm());
  EXPECT_LT((felt - base).norm(), 1e-11 * base.norm());
  const Mat6 response = -chain.V * A.partialPivLu().solve(Eigen::MatrixXd(U.transpose()));
  EXPECT_LT((factor.base_response() - response).norm(), 1e-11 * response.norm());
}

TEST_P(ChainLaws, AttachmentsSeeEachOtherAsThroughTheMatrixWrittenOut) {
  const Chain chain = random_chain({3, 1, 2, 5, 3, 0, 9, 4}, GetParam());
  std::vector<Attachment> attachments;
  for (const int link : {0, 0, 1, 3, 3, 3, 6, 7, 7})
    attachments.push_back({link, Vec6::Random(), Eigen::VectorXd::Random(chain.size(link))});
  const Eigen::MatrixXd A = dense(chain);
  const Eigen::MatrixXd inverse = A.inverse();
  Eigen::MatrixXd R(attachments.size(), chain.coordinates());
  Matrix6X g(6, attachments.size());
  for (std::size_t i = 0; i < attachments.size(); ++i) {
    R.row(static_cast<Eigen::Index>(i)) = dense(chain, attachments[i]);
    g.col(static_cast<Eigen::Index>(i)) = attachments[i].g;
  }
  const Eigen::VectorXd x = Eigen::VectorXd::Random(chain.coordinates()), y = Eigen::VectorXd::Random(R.rows());
  const Vec6 tau = Vec6::Random();
  Eigen::VectorXd seen, pulled;
  along(chain, attachments, x, tau, seen);
  EXPECT_LT((seen - R * x - g.transpose() * tau).norm(), 1e-13 * seen.norm());
  const Vec6 wrench = across(chain, attachments, y, pulled);
  EXPECT_LT((pulled - R.transpose() * y).norm(), 1e-13 * pulled.norm());
  EXPECT_LT((wrench - g * y).norm(), 1e-13 * wrench.norm());
  ChainFactor factor;
  ASSERT_TRUE(factor.factor(chain));
  ChainFactor::Condensed condensed;
  factor.condense(attachments, condensed);
  const Eigen::MatrixXd W = R * inverse * R.transpose();
  if (chain.symmetric()) condensed.W = Eigen::MatrixXd(condensed.W.selfadjointView<Eigen::Lower>());
  EXPECT_LT((condensed.W - W).norm(), 1e-11 * W.norm());
  const Matrix6X arriving = g - chain.V * inverse * R.transpose();
  EXPECT_LT((condensed.arriving - arriving).norm(), 1e-11 * arriving.norm());
  const Matrix6X& U = chain.symmetric() ? chain.V : chain.U;
  const Matrix6X answering = g - U * inverse.transpose() * R.transpose();
  EXPECT_LT((condensed.answering - answering).norm(), 1e-11 * answering.norm());
}

INSTANTIATE_TEST_SUITE_P(SymmetricOrNot, ChainLaws, testing::Bool());

TEST(Chain, CountsNegativeEigenvalues) {
  Chain chain = random_chain({3, 2, 3, 3}, true);
  ChainFactor factor;
  for (const double shift : {0.0, 3.0, 6.0, 9.0}) {
    Chain shifted = chain;
    for (int k = 0; k < chain.links(); ++k)
      shifted.block(k) -= shift * Eigen::MatrixXd::Identity(chain.size(k), chain.size(k));
    ASSERT_TRUE(factor.factor(shifted));
    const auto values = Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(dense(shifted)).eigenvalues();
    EXPECT_EQ(factor.negative(), (values.array() < 0.0).count()) << shift;
  }
}

TEST(Chain, ASingularPivotIsReported) {
  Chain chain = make_chain({2, 2}, true);
  ChainFactor factor;
  EXPECT_FALSE(factor.factor(chain));
}

}  // namespace
}  // namespace sinew::linalg
