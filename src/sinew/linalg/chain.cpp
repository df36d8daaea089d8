#include "sinew/linalg/chain.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>

#include "sinew/linalg/chain_kernels.hpp"

namespace sinew::linalg {

Chain make_chain(const std::vector<int>& sizes, bool symmetric) {
  std::vector<int> first = {0};
  for (const int size : sizes) first.push_back(first.back() + size);
  Chain chain;
  make_chain(first, symmetric, chain);
  return chain;
}

void make_chain(const std::vector<int>& first, bool symmetric, Chain& chain) {
  chain.first = first;
  int largest = 0;
  for (int k = 0; k < chain.links(); ++k) largest = std::max(largest, chain.size(k));
  const int n = chain.coordinates();
  chain.T.setZero(6, n);
  chain.V.setZero(6, n);
  chain.U.setZero(6, symmetric ? 0 : n);
  chain.D.setZero(largest, n);
}

Eigen::MatrixXd dense(const Chain& chain) {
  const int n = chain.coordinates();
  Eigen::MatrixXd A = Eigen::MatrixXd::Zero(n, n);
  for (int k = 0; k < chain.links(); ++k) {
    const int at = chain.first[k], m = chain.size(k);
    A.block(at, at, m, m) = chain.block(k);
    A.block(0, at, at, m) = chain.T.leftCols(at).transpose() * chain.V.middleCols(at, m);
    A.block(at, 0, m, at) = chain.left().middleCols(at, m).transpose() * chain.T.leftCols(at);
  }
  return A;
}

double multiply(const Chain& chain, const Eigen::VectorXd& x, const Vec6& tau, Eigen::VectorXd& y, Vec6& wrench) {
  y.resize(chain.coordinates());
  double largest = 0.0;
  const auto see = [&largest](const auto& part) {
    for (Eigen::Index i = 0; i < part.size(); ++i) largest = std::max(largest, std::abs(part[i]));
  };
  const Matrix6X& left = chain.left();
  Vec6 twist = tau;
  for (int k = 0; k < chain.links(); ++k) {
    const int at = chain.first[k], m = chain.size(k);
    with_size(m, [&](auto size) {
      constexpr int M = decltype(size)::value;
      const Vector<M> own = x.segment<M>(at, m);
      const Vector<M> pushed = left.middleCols<M>(at, m).transpose() * twist;
      see(pushed);
      y.segment<M>(at, m).noalias() = pushed + chain.D.block<M, M>(0, at, m, m).lazyProduct(own);
      twist.noalias() += chain.T.middleCols<M>(at, m) * own;
    });
  }
  wrench.setZero();
  for (int k = chain.links() - 1; k >= 0; --k) {
    const int at = chain.first[k], m = chain.size(k);
    with_size(m, [&](auto size) {
      constexpr int M = decltype(size)::value;
      auto own = y.segment<M>(at, m);
      see(own);
      own.noalias() += chain.T.middleCols<M>(at, m).transpose() * wrench;
      see(own);
      wrench.noalias() += chain.V.middleCols<M>(at, m) * x.segment<M>(at, m);
    });
  }
  return largest;
}

Eigen::VectorXd dense(const Chain& chain, const Attachment& attachment) {
  Eigen::VectorXd r = Eigen::VectorXd::Zero(chain.coordinates());
  const int at = chain.first[attachment.link];
  r.head(at) = chain.T.leftCols(at).transpose() * attachment.g;
  r.segment(at, chain.size(attachment.link)) = attachment.b;
  return r;
}

void along(const Chain& chain, const std::vector<Attachment>& attachments, const Eigen::VectorXd& x, const Vec6& tau,
           Eigen::VectorXd& y) {
  y.resize(static_cast<Eigen::Index>(attachments.size()));
  Vec6 twist = tau;
  std::size_t next = 0;
  for (int k = 0; k < chain.links() && next < attachments.size(); ++k) {
    const int at = chain.first[k], m = chain.size(k);
    with_size(m, [&](auto size) {
      constexpr int M = decltype(size)::value;
      const Vector<M> own = x.segment<M>(at, m);
      for (; next < attachments.size() && attachments[next].link == k; ++next)
        y[static_cast<Eigen::Index>(next)] = attachments[next].g.dot(twist) + attachments[next].b.head<M>(m).dot(own);
      twist.noalias() += chain.T.middleCols<M>(at, m) * own;
    });
  }
}

Vec6 across(const Chain& chain, const std::vector<Attachment>& attachments, const Eigen::VectorXd& y,
            Eigen::VectorXd& x) {
  x.resize(chain.coordinates());
  Vec6 wrench = Vec6::Zero();
  auto left = static_cast<std::ptrdiff_t>(attachments.size()) - 1;
  for (int k = chain.links() - 1; k >= 0; --k) {
    const int at = chain.first[k], m = chain.size(k);
    with_size(m, [&](auto size) {
      constexpr int M = decltype(size)::value;
      Vector<M> own = chain.T.middleCols<M>(at, m).transpose() * wrench;
      for (; left >= 0 && attachments[static_cast<std::size_t>(left)].link == k; --left) {
        own += y[left] * attachments[static_cast<std::size_t>(left)].b.head<M>(m);
        wrench += y[left] * attachments[static_cast<std::size_t>(left)].g;
      }
      x.segment<M>(at, m) = own;
    });
  }
  return wrench;
}

namespace {

/// The inverse of a positive definite matrix, which needs no search for pivots; false where it is none.
template <int M>
bool invert_positive(const Square<M>& S, Square<M>& inverse) {
  if constexpr (M == Eigen::Dynamic) {
    return false;
  } else {
    double A[M][M], L[M][M], by[M];  // A: columns; L: the inverse of the unit triangle
#pragma GCC unroll 6
    for (int j = 0; j < M; ++j) {
#pragma GCC unroll 6
      for (int i = j; i < M; ++i) A[j][i] = S(i, j);
    }
#pragma GCC unroll 6
    for (int j = 0; j < M; ++j) {
      if (!(A[j][j] > 0.0 && A[j][j] <= std::numeric_limits<double>::max())) return false;
      by[j] = 1.0 / A[j][j];
#pragma GCC unroll 6
      for (int c = 0; c < j; ++c) L[j][c] = -(A[c][j] * by[c]);
#pragma GCC unroll 6
      for (int k = 1; k < j; ++k) {
#pragma GCC unroll 6
        for (int c = 0; c < k; ++c) L[j][c] -= A[k][j] * by[k] * L[k][c];
      }
#pragma GCC unroll 6
      for (int k = j + 1; k < M; ++k) {
        const double factor = A[j][k] * by[j];
#pragma GCC unroll 6
        for (int i = k; i < M; ++i) A[k][i] -= A[j][i] * factor;
      }
    }
    bool finite = true;
#pragma GCC unroll 6
    for (int a = 0; a < M; ++a) {
#pragma GCC unroll 6
      for (int b = 0; b <= a; ++b) {
        double sum = (a == b ? 1.0 : L[a][b]) * by[a];
#pragma GCC unroll 6
        for (int k = a + 1; k < M; ++k) sum += L[k][a] * L[k][b] * by[k];
        inverse(a, b) = inverse(b, a) = sum;
        finite &= std::abs(sum) <= std::numeric_limits<double>::max();
      }
    }
    return finite;
  }
}

/// The inverse of a symmetric matrix and the number of its negative eigenvalues, by elimination with pivots on the
/// diagonal, the largest first; false where those do not suffice, as never happens if it is positive definite.
template <int M>
bool invert_symmetric(const Square<M>& S, Square<M>& inverse, int& negative) {
  const Eigen::Index m = S.rows();
  inverse = -S;  // turns into the inverse row and column by row and column
  Eigen::Array<bool, M, 1, 0, kMost<M>, 1> done(m);
  done.setConstant(false);
  for (Eigen::Index step = 0; step < m; ++step) {
    Eigen::Index k = -1;
    for (Eigen::Index i = 0; i < m; ++i)
      if (!done[i] && (k < 0 || std::abs(inverse(i, i)) > std::abs(inverse(k, k)))) k = i;
    const double pivot = -inverse(k, k);
    const Vector<M> column = inverse.col(k), scaled = column / pivot;
    for (Eigen::Index i = 0; i < m; ++i)
      if (!done[i] && !(0.1 * std::abs(column[i]) <= std::abs(pivot))) return false;
    if (pivot < 0.0) ++negative;
    inverse.noalias() += column * scaled.transpose();
    inverse.col(k) = scaled;
    inverse.row(k) = scaled.transpose();
    inverse(k, k) = 1.0 / pivot;
    done[k] = true;
  }
  return inverse.allFinite();
}

int negative_eigenvalues(const Eigen::MatrixXd& S) {
  return static_cast<int>(
      (Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(S, Eigen::EigenvaluesOnly).eigenvalues().array() < 0.0).count());
}

/// The inverse of a pivot and how many of its eigenvalues are negative (if symmetric); false if singular.
template <int M>
bool invert(const Square<M>& S, bool symmetric, Square<M>& inverse, int& negative) {
  if (symmetric && invert_positive<M>(S, inverse)) return true;
  if (!S.allFinite()) return false;
  if (symmetric) {
    int found = 0;
    if (invert_symmetric<M>(S, inverse, found)) {
      negative += found;
      return true;
    }
    negative += negative_eigenvalues(S);
  }
  const Eigen::PartialPivLU<Square<M>> lu(S);
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
      const Columns<M> T = chain.T.middleCols<M>(at, m);
      const Columns<M> PT = P * T;
      const Columns<M> G = PT + chain.V.middleCols<M>(at, m);
      Square<M> S = chain.D.block<M, M>(0, at, m, m);
      S.noalias() += T.transpose() * PT;
      Square<M> inverse(m, m);
      if (!invert<M>(S, chain.symmetric(), inverse, negative_)) return false;
      const Columns<M> Y = G * inverse;
      Columns<M> C = G;
      if (!chain.symmetric()) C = chain.U.middleCols<M>(at, m) + P.transpose() * T;
      P.noalias() -= Y * C.transpose();
      Y_.middleCols<M>(at, m) = Y;
      C_.middleCols<M>(at, m) = C;
      S_.block<M, M>(0, at, m, m) = inverse;
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

void ChainFactor::solve_transposed(Eigen::VectorXd& x, Vec6* base) const {
  (turned_ ? *turned_ : *this).solve(x, Vec6::Zero(), base);
}

void ChainFactor::solve(Eigen::VectorXd& x, const Vec6& tau, Vec6* base) const {
  const Chain& chain = *chain_;
  Vec6 p = Vec6::Zero();
  for (int k = chain.links() - 1; k >= 0; --k) {
    const int at = chain.first[k], m = chain.size(k);
    with_size(m, [&](auto size) {
      constexpr int M = decltype(size)::value;
      auto own = x.segment<M>(at, m);
      own.noalias() -= chain.T.middleCols<M>(at, m).transpose() * p;
      p.noalias() += Y_.middleCols<M>(at, m) * own;
    });
  }
  if (base) *base = base_ * tau + p;
  Vec6 twist = tau;
  for (int k = 0; k < chain.links(); ++k) {
    const int at = chain.first[k], m = chain.size(k);
    with_size(m, [&](auto size) {
      constexpr int M = decltype(size)::value;
      auto own = x.segment<M>(at, m);
      const Vector<M> left = own - C_.middleCols<M>(at, m).transpose() * twist;
      own.noalias() = S_.block<M, M>(0, at, m, m) * left;
      twist.noalias() += chain.T.middleCols<M>(at, m) * own;
    });
  }
}

namespace {

/// Copies the triangle below the diagonal of `from` to above that of `to`, block by block so that both stay in the
/// cache.
void mirror(const Eigen::MatrixXd& from, Eigen::MatrixXd& to) {
  constexpr Eigen::Index kBlock = 16;
  const Eigen::Index n = from.cols();
  for (Eigen::Index j = 0; j < n; j += kBlock) {
    for (Eigen::Index i = j; i < n; i += kBlock) {
      for (Eigen::Index b = j; b < std::min(j + kBlock, n); ++b) {
        for (Eigen::Index a = std::max(i, b + 1); a < std::min(i + kBlock, n); ++a) to(b, a) = from(a, b);
      }
    }
  }
}

}  // namespace

void ChainFactor::condense_upper(const std::vector<Attachment>& attachments, Condensed& room, Eigen::MatrixXd& turned_W,
                                 Matrix6X& arriving) const {
  const Chain& chain = *chain_;
  const auto count = static_cast<int>(attachments.size());
  turned_W.resize(count, count);
  arriving.resize(6, count);

  // Flexibility of the link ends from the base on, and with it the two six-vectors of each attachment: what it sees of
  // a wrench that arrives beyond its link is (alpha + beta) . wrench less what the link itself gives way.
  Matrix6X &alpha = room.alpha, &gamma = room.gamma;
  alpha.resize(6, count);
  gamma.resize(6, count);
  Mat6 F = Mat6::Zero();
  int next = 0;
  const int last_link = count > 0 ? attachments.back().link : -1;
  for (int k = 0; k <= last_link; ++k) {
    const int at = chain.first[k], m = chain.size(k);
    with_size(m, [&](auto size) {
      constexpr int M = decltype(size)::value;
      const Columns<M> T = chain.T.middleCols<M>(at, m), Y = Y_.middleCols<M>(at, m);
      const Columns<M> C = C_.middleCols<M>(at, m);
      const Square<M> S = S_.block<M, M>(0, at, m, m);
      for (; next < count && attachments[next].link == k; ++next) {
        const Vector<M> b = attachments[next].b;
        const Vector<M> left = S.transpose() * b;
        alpha.col(next).noalias() = F.transpose() * (attachments[next].g - C * left);
        const Vector<M> given = left - Y.transpose() * alpha.col(next);
        gamma.col(next) = alpha.col(next) + T * given;
      }
      // F <- (1 - T S C^T) F (1 - Y T^T) + T S T^T
      const Columns<M> TS = T * S;
      const Eigen::Matrix<double, M, 6> CF = C.transpose() * F;
      F.noalias() -= TS * CF;
      const Columns<M> FY = TS - F * Y;
      F.noalias() += FY * T.transpose();
    });
  }

  // Wrenches on their way to the base, met by the attachments they pass; the last of them in the last lane.
  const int blocks = (count + kWrenches - 1) / kWrenches, shift = blocks * kWrenches - count;
  const ChainKernels& kernels = chain_kernels();
  Eigen::MatrixXd& moving = room.moving;
  moving.setZero(kWrenchNumbers, blocks);
  int beyond = count;  // attachments of links beyond k: from this number on
  for (int k = last_link; k >= 0; --k) {
    const int at = chain.first[k], m = chain.size(k);
    int own = beyond;
    while (own > 0 && attachments[own - 1].link == k) --own;
    // Lanes before `beyond` are still empty; what they leave in W is written over, or lies above the diagonal.
    if (const int block = (beyond + shift) / kWrenches; block < blocks) {
      const Passage passage{chain.T.data() + 6 * at, Y_.data() + 6 * at, m, gamma.data() + 6 * own, beyond - own};
      kernels.pass(passage, moving.col(block).data(), blocks - block, turned_W.data() + own * turned_W.outerStride(),
                   count, kWrenches * block - shift);
    }
    with_size(m, [&](auto size) {
      constexpr int M = decltype(size)::value;
      const Columns<M> Y = Y_.middleCols<M>(at, m);
      const Square<M> S = S_.block<M, M>(0, at, m, m);
      for (int l = own; l < beyond; ++l) {
        const Vector<M> b = attachments[l].b;
        const Vec6 arrived = attachments[l].g - Y * b;
        const Vector<M> right = S * b;
        for (int c = 0; c < 6; ++c)
          moving(kWrenches * c + (l + shift) % kWrenches, (l + shift) / kWrenches) = arrived[c];
        for (int i = own; i <= l; ++i) turned_W(l, i) = alpha.col(i).dot(arrived) + attachments[i].b.dot(right);
      }
    });
    beyond = own;
  }
  for (int l = 0; l < count; ++l) {
    for (int c = 0; c < 6; ++c)
      arriving(c, l) = moving(kWrenches * c + (l + shift) % kWrenches, (l + shift) / kWrenches);
  }
}

void ChainFactor::condense(const std::vector<Attachment>& attachments, Condensed& condensed) const {
  if (chain_->symmetric()) {
    condense_upper(attachments, condensed, condensed.W, condensed.arriving);
    condensed.answering = condensed.arriving;
    return;
  }
  // Below the diagonal: the upper part of the transposed matrix, turned.
  condense_upper(attachments, condensed, condensed.above, condensed.arriving);
  turned_->condense_upper(attachments, condensed, condensed.W, condensed.answering);
  condensed.W.diagonal() = condensed.above.diagonal();
  mirror(condensed.above, condensed.W);
}

}  // namespace sinew::linalg
