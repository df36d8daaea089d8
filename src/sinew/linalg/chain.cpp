#include "sinew/linalg/chain.hpp"

#include <Eigen/Dense>
#include <algorithm>

namespace sinew::linalg {

Chain make_chain(const std::vector<int>& sizes, bool symmetric) {
  Chain chain;
  chain.first.push_back(0);
  int largest = 0;
  for (const int size : sizes) {
    chain.first.push_back(chain.first.back() + size);
    largest = std::max(largest, size);
  }
  const int n = chain.coordinates();
  chain.T.setZero(6, n);
  chain.V.setZero(6, n);
  if (!symmetric) chain.U.setZero(6, n);
  chain.D.setZero(largest, n);
  return chain;
}

Eigen::MatrixXd dense(const Chain& chain) {
  const int n = chain.coordinates();
  Eigen::MatrixXd A = Eigen::MatrixXd::Zero(n, n);
  for (int k = 0; k < chain.links(); ++k) {
    const int at = chain.first[k], m = chain.size(k);
    A.block(at, at, m, m) = chain.block(k);
    A.block(0, at, at, m) = chain.T.leftCols(at).transpose() * chain.wrenches(k);
    A.block(at, 0, m, at) = chain.left_wrenches(k).transpose() * chain.T.leftCols(at);
  }
  return A;
}

Eigen::VectorXd multiply(const Chain& chain, const Eigen::VectorXd& x, const Vec6& tau) {
  Eigen::VectorXd y(chain.coordinates());
  Vec6 twist = tau;
  for (int k = 0; k < chain.links(); ++k) {
    const int at = chain.first[k], m = chain.size(k);
    y.segment(at, m) = chain.left_wrenches(k).transpose() * twist + chain.block(k) * x.segment(at, m);
    twist += chain.twists(k) * x.segment(at, m);
  }
  Vec6 wrench = Vec6::Zero();
  for (int k = chain.links() - 1; k >= 0; --k) {
    const int at = chain.first[k], m = chain.size(k);
    y.segment(at, m) += chain.twists(k).transpose() * wrench;
    wrench += chain.wrenches(k) * x.segment(at, m);
  }
  return y;
}

Eigen::VectorXd dense(const Chain& chain, const Attachment& attachment) {
  Eigen::VectorXd r = Eigen::VectorXd::Zero(chain.coordinates());
  const int at = chain.first[attachment.link];
  r.head(at) = chain.T.leftCols(at).transpose() * attachment.g;
  r.segment(at, chain.size(attachment.link)) = attachment.b;
  return r;
}

Eigen::VectorXd along(const Chain& chain, const std::vector<Attachment>& attachments, const Eigen::VectorXd& x) {
  Eigen::VectorXd y(static_cast<Eigen::Index>(attachments.size()));
  Vec6 twist = Vec6::Zero();
  int k = 0;
  for (std::size_t i = 0; i < attachments.size(); ++i) {
    for (; k < attachments[i].link; ++k) twist += chain.twists(k) * x.segment(chain.first[k], chain.size(k));
    y[static_cast<Eigen::Index>(i)] =
        attachments[i].g.dot(twist) + attachments[i].b.dot(x.segment(chain.first[k], chain.size(k)));
  }
  return y;
}

Eigen::VectorXd across(const Chain& chain, const std::vector<Attachment>& attachments, const Eigen::VectorXd& y) {
  Eigen::VectorXd x = Eigen::VectorXd::Zero(chain.coordinates());
  Vec6 wrench = Vec6::Zero();
  auto left = static_cast<std::ptrdiff_t>(attachments.size()) - 1;
  for (int k = chain.links() - 1; k >= 0; --k) {
    auto own = x.segment(chain.first[k], chain.size(k));
    own = chain.twists(k).transpose() * wrench;
    for (; left >= 0 && attachments[static_cast<std::size_t>(left)].link == k; --left) {
      own += y[left] * attachments[static_cast<std::size_t>(left)].b;
      wrench += y[left] * attachments[static_cast<std::size_t>(left)].g;
    }
  }
  return x;
}

namespace {

/// Blocks of a link as matrices of fixed size where they are small, so that no loop is left to the run.
template <int M>
struct Sized {
  using Wide = Eigen::Matrix<double, 6, M>;
  using Square = Eigen::Matrix<double, M, M>;
};

/// Calls f with the number of coordinates of a link as a constant, -1 (dynamic) beyond six.
template <class F>
auto with_size(int m, const F& f) {
  switch (m) {
    case 1:
      return f(std::integral_constant<int, 1>{});
    case 2:
      return f(std::integral_constant<int, 2>{});
    case 3:
      return f(std::integral_constant<int, 3>{});
    case 4:
      return f(std::integral_constant<int, 4>{});
    case 6:
      return f(std::integral_constant<int, 6>{});
    default:
      return f(std::integral_constant<int, Eigen::Dynamic>{});
  }
}

/// The inverse of a pivot and how many of its eigenvalues are negative (if symmetric); false if singular.
template <class Square>
bool invert(const Square& S, bool symmetric, Square& inverse, int& negative) {
  if (!S.allFinite()) return false;
  if (symmetric) {
    const Eigen::LDLT<Square> ldlt(S);
    const auto d = ldlt.vectorD();
    if (ldlt.info() == Eigen::Success && d.minCoeff() > 0.0) {
      inverse.setIdentity(S.rows(), S.cols());
      ldlt.solveInPlace(inverse);
      return inverse.allFinite();
    }
    negative += static_cast<int>(
        (Eigen::SelfAdjointEigenSolver<Square>(S, Eigen::EigenvaluesOnly).eigenvalues().array() < 0.0).count());
  }
  const Eigen::PartialPivLU<Square> lu(S);
  if (!(lu.matrixLU().diagonal().cwiseAbs().minCoeff() > 1e-300)) return false;
  inverse = lu.inverse();
  return inverse.allFinite();
}

}  // namespace

bool ChainFactor::factor_only(const Chain& chain) {
  chain_ = &chain;
  negative_ = 0;
  Y_.resize(6, chain.coordinates());
  C_.resize(6, chain.coordinates());
  S_.resize(chain.D.rows(), chain.D.cols());
  Mat6 P = Mat6::Zero();
  for (int k = chain.links() - 1; k >= 0; --k) {
    const int at = chain.first[k], m = chain.size(k);
    if (m == 0) continue;
    const bool ok = with_size(m, [&](auto size) {
      constexpr int M = decltype(size)::value;
      const typename Sized<M>::Wide T = chain.twists(k);
      const typename Sized<M>::Wide PT = P * T;
      const typename Sized<M>::Wide G = PT + chain.wrenches(k);
      const typename Sized<M>::Square S = chain.block(k) + T.transpose() * PT;
      typename Sized<M>::Square inverse(m, m);
      if (!invert(S, chain.symmetric(), inverse, negative_)) return false;
      const typename Sized<M>::Wide Y = G * inverse;
      typename Sized<M>::Wide C = G;
      if (!chain.symmetric()) C = chain.left_wrenches(k) + P.transpose() * T;
      P.noalias() -= Y * C.transpose();
      Y_.middleCols(at, m) = Y;
      C_.middleCols(at, m) = C;
      S_.block(0, at, m, m) = inverse;
      return true;
    });
    if (!ok) return false;
  }
  base_ = P;
  return P.allFinite();
}

bool ChainFactor::factor(const Chain& chain) {
  turned_.reset();
  if (!factor_only(chain)) return false;
  if (chain.symmetric()) return true;
  auto turned = std::make_shared<Chain>(chain);
  std::swap(turned->U, turned->V);
  for (int k = 0; k < turned->links(); ++k) turned->block(k).transposeInPlace();
  auto other = std::make_shared<ChainFactor>();
  other->turned_chain_ = turned;
  const bool ok = other->factor_only(*turned);
  turned_ = other;
  return ok;
}

Eigen::VectorXd ChainFactor::solve_transposed(const Eigen::VectorXd& b, Vec6* base) const {
  return turned_ ? turned_->solve(b, Vec6::Zero(), base) : solve(b, Vec6::Zero(), base);
}

Eigen::VectorXd ChainFactor::solve(const Eigen::VectorXd& b, const Vec6& tau, Vec6* base) const {
  const Chain& chain = *chain_;
  Eigen::VectorXd x = b;
  Vec6 p = Vec6::Zero();
  for (int k = chain.links() - 1; k >= 0; --k) {
    const int at = chain.first[k], m = chain.size(k);
    x.segment(at, m) -= chain.twists(k).transpose() * p;
    p += Y_.middleCols(at, m) * x.segment(at, m);
  }
  if (base) *base = base_ * tau + p;
  Vec6 twist = tau;
  for (int k = 0; k < chain.links(); ++k) {
    const int at = chain.first[k], m = chain.size(k);
    x.segment(at, m) = (S_.block(0, at, m, m) * (x.segment(at, m) - C_.middleCols(at, m).transpose() * twist)).eval();
    twist += chain.twists(k) * x.segment(at, m);
  }
  return x;
}

void ChainFactor::condense_upper(const std::vector<Attachment>& attachments, Eigen::MatrixXd& W,
                                 Matrix6X& arriving) const {
  const Chain& chain = *chain_;
  const auto count = static_cast<int>(attachments.size());
  W.resize(count, count);
  arriving.resize(6, count);

  // Flexibility of the link ends from the base on, and with it the two six-vectors of each attachment.
  Matrix6X alpha(6, count), beta(6, count);
  Mat6 F = Mat6::Zero();
  int next = 0;
  const int last_link = count > 0 ? attachments.back().link : -1;
  for (int k = 0; k <= last_link; ++k) {
    const int at = chain.first[k], m = chain.size(k);
    for (; next < count && attachments[next].link == k; ++next) {
      const Attachment& own = attachments[next];
      const Eigen::VectorXd left = S_.block(0, at, m, m).transpose() * own.b;
      alpha.col(next) = F.transpose() * (own.g - C_.middleCols(at, m) * left);
      beta.col(next) = chain.twists(k) * left;
    }
    with_size(m, [&](auto size) {
      constexpr int M = decltype(size)::value;
      const typename Sized<M>::Wide T = chain.twists(k);
      const typename Sized<M>::Wide TS = T * S_.block(0, at, m, m);
      const Mat6 left = Mat6::Identity() - TS * C_.middleCols(at, m).transpose();
      const Mat6 right = Mat6::Identity() - Y_.middleCols(at, m) * T.transpose();
      const Mat6 moved = left * F;
      F.noalias() = moved * right + TS * T.transpose();
    });
  }

  // Wrenches on their way to the base, met by the attachments they pass.
  int beyond = count;  // attachments of links beyond k: from this number on
  Matrix6X before;
  for (int k = last_link; k >= 0; --k) {
    const int at = chain.first[k], m = chain.size(k);
    int own = beyond;
    while (own > 0 && attachments[own - 1].link == k) --own;
    auto passing = arriving.rightCols(count - beyond);
    if (own < beyond) before = passing;
    with_size(m, [&](auto size) {
      constexpr int M = decltype(size)::value;
      const typename Sized<M>::Wide T = chain.twists(k), Y = Y_.middleCols(at, m);
      for (int l = beyond; l < count; ++l) {
        const Eigen::Matrix<double, M, 1> felt = T.transpose() * arriving.col(l);
        arriving.col(l).noalias() -= Y * felt;
      }
    });
    for (int l = own; l < beyond; ++l) {
      const Attachment& attachment = attachments[l];
      arriving.col(l) = attachment.g - Y_.middleCols(at, m) * attachment.b;
    }
    const int here = beyond - own;
    if (here == 0) continue;
    if (beyond < count) {
      W.block(own, beyond, here, count - beyond).noalias() = alpha.middleCols(own, here).transpose() * passing;
      W.block(own, beyond, here, count - beyond).noalias() += beta.middleCols(own, here).transpose() * before;
    }
    for (int i = own; i < beyond; ++i) {
      const Eigen::VectorXd left = S_.block(0, at, m, m).transpose() * attachments[i].b;
      for (int l = own; l < beyond; ++l) W(i, l) = alpha.col(i).dot(arriving.col(l)) + left.dot(attachments[l].b);
    }
    beyond = own;
  }
}

ChainFactor::Condensed ChainFactor::condense(const std::vector<Attachment>& attachments) const {
  Condensed condensed;
  condense_upper(attachments, condensed.W, condensed.arriving);
  if (chain_->symmetric()) {
    condensed.W.triangularView<Eigen::StrictlyLower>() = condensed.W.transpose();
    condensed.answering = condensed.arriving;
    return condensed;
  }
  // Below the diagonal: the upper part of the transposed matrix.
  Eigen::MatrixXd below;
  turned_->condense_upper(attachments, below, condensed.answering);
  condensed.W.triangularView<Eigen::StrictlyLower>() = below.transpose();
  return condensed;
}

}  // namespace sinew::linalg
