#include "sinew/solve/direct.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

namespace sinew::solve {

namespace {

using linalg::Matrix6X;
using linalg::Vec6;

/// Symmetric scaling: every row's and column's largest entry near one (Ruiz, four sweeps).
Eigen::VectorXd equilibrate(Eigen::MatrixXd& K) {
  Eigen::VectorXd scale = Eigen::VectorXd::Ones(K.rows());
  if (K.rows() == 0) return scale;  // rods alone: there is no border
  for (int sweep = 0; sweep < 4; ++sweep) {
    Eigen::VectorXd d = K.cwiseAbs().rowwise().maxCoeff();
    for (double& value : d) value = value > 0.0 ? 1.0 / std::sqrt(value) : 1.0;
    K = d.asDiagonal() * K * d.asDiagonal();
    scale.array() *= d.array();
  }
  return scale;
}

Eigen::Index border_size(const CoupledProblem& problem) { return problem.B.rows() + problem.W.rows(); }

Eigen::MatrixXd bare_border(const CoupledProblem& problem) {
  Eigen::MatrixXd K(border_size(problem), border_size(problem));
  K << problem.B, problem.G.transpose(), problem.G, -problem.W;
  return K;
}

/// Entries of a border vector that belong to a chain's attachments.
Eigen::VectorXd gather(const Eigen::VectorXd& y, const std::vector<int>& at) {
  Eigen::VectorXd own(static_cast<Eigen::Index>(at.size()));
  for (std::size_t i = 0; i < at.size(); ++i) own[static_cast<Eigen::Index>(i)] = y[at[i]];
  return own;
}

auto base_of(const ChainPart& part, Eigen::VectorXd& y) { return y.segment(part.first_base, part.base.cols()); }

/// Sum of y_i g_i over attachments.
Vec6 total_wrench(const ChainPart& part, const Eigen::VectorXd& y) {
  Vec6 sum = Vec6::Zero();
  for (std::size_t i = 0; i < part.at.size(); ++i) sum += y[part.at[i]] * part.attachments[i].g;
  return sum;
}

/// R^T y of all attachments, single ones and those along the whole chain.
Eigen::VectorXd pulled(const ChainPart& part, const Eigen::VectorXd& y) {
  Eigen::VectorXd pull = linalg::across(part.chain, part.attachments, gather(y, part.at));
  for (std::size_t f = 0; f < part.whole_at.size(); ++f)
    pull += y[part.whole_at[f]] * part.whole.col(static_cast<Eigen::Index>(f));
  return pull;
}

constexpr double kTolerance = 1e-9;

}  // namespace

Eigen::MatrixXd written_out(const CoupledProblem& problem) {
  Eigen::Index size = border_size(problem);
  for (const ChainPart& part : problem.chains) size += part.chain.coordinates();
  Eigen::MatrixXd K = Eigen::MatrixXd::Zero(size, size);
  K.topLeftCorner(border_size(problem), border_size(problem)) = bare_border(problem);
  Eigen::Index at = border_size(problem);
  for (const ChainPart& part : problem.chains) {
    const Eigen::Index n = part.chain.coordinates(), nb = part.base.cols();
    const linalg::Chain& chain = part.chain;
    K.block(at, at, n, n) = linalg::dense(chain);
    K.block(part.first_base, at, nb, n) = part.base.transpose() * chain.V;
    K.block(at, part.first_base, n, nb) = (chain.symmetric() ? chain.V : chain.U).transpose() * part.base;
    for (std::size_t i = 0; i < part.at.size(); ++i) {
      const Eigen::VectorXd own = linalg::dense(chain, part.attachments[i]);
      const Eigen::VectorXd base = part.base.transpose() * part.attachments[i].g;
      K.block(at, part.at[i], n, 1) += own;
      K.block(part.at[i], at, 1, n) += own.transpose();
      K.block(part.first_base, part.at[i], nb, 1) += base;
      K.block(part.at[i], part.first_base, 1, nb) += base.transpose();
    }
    for (std::size_t f = 0; f < part.whole_at.size(); ++f) {
      K.block(at, part.whole_at[f], n, 1) += part.whole.col(static_cast<Eigen::Index>(f));
      K.block(part.whole_at[f], at, 1, n) += part.whole.col(static_cast<Eigen::Index>(f)).transpose();
    }
    at += n;
  }
  return K;
}

RightSide right_side(const CoupledProblem& problem) {
  RightSide right{problem.r, problem.c, {}};
  for (const ChainPart& part : problem.chains) right.chains.push_back(part.r);
  return right;
}

CoupledFactor::CoupledFactor(const CoupledProblem& problem) : problem_(problem) {
  K_ = bare_border(problem);
  factors_.resize(problem.chains.size());
  bool ok = true;
  for (std::size_t i = 0; i < problem.chains.size() && ok; ++i) ok = factors_[i].factor(problem.chains[i].chain);
  if (ok) {
    eliminate_chains();
    factor_symmetric();
  } else {
    join_chains();
  }
}

void CoupledFactor::factor_symmetric() {
  if (K_.rows() == 0 || !K_.allFinite() || !K_.isApprox(K_.transpose(), 1e-12)) return;
  // Rows that feel a compliance have negative pivots, what they hold then positive ones; the rest are rows again.
  std::vector<int> order;
  const auto nz = static_cast<int>(problem_.B.rows()), all = static_cast<int>(K_.rows());
  const auto yields = [this](int row) { return K_(row, row) < 0.0; };
  for (int i = nz; i < all; ++i)
    if (yields(i)) order.push_back(i);
  for (int i = 0; i < nz; ++i) order.push_back(i);
  for (int i = nz; i < all; ++i)
    if (!yields(i)) order.push_back(i);
  symmetric_ = std::make_unique<linalg::SymmetricFactor>();
  if (!symmetric_->factor(K_, order)) symmetric_.reset();
}

void CoupledFactor::eliminate_chains() {
  for (std::size_t n = 0; n < problem_.chains.size(); ++n) {
    const ChainPart& part = problem_.chains[n];
    const linalg::ChainFactor& factor = factors_[n];
    const auto nb = part.base.cols(), first = static_cast<Eigen::Index>(part.first_base);
    const auto condensed = factor.condense(part.attachments);
    K_.block(first, first, nb, nb) += part.base.transpose() * factor.base_response() * part.base;
    const Eigen::MatrixXd to_base = part.base.transpose() * condensed.arriving;
    const Eigen::MatrixXd from_base = condensed.answering.transpose() * part.base;
    for (std::size_t i = 0; i < part.at.size(); ++i) {
      const auto column = static_cast<Eigen::Index>(i);
      K_.block(first, part.at[i], nb, 1) += to_base.col(column);
      K_.block(part.at[i], first, 1, nb) += from_base.row(column);
      for (std::size_t l = 0; l < part.at.size(); ++l)
        K_(part.at[i], part.at[l]) -= condensed.W(column, static_cast<Eigen::Index>(l));
    }
    for (std::size_t f = 0; f < part.whole_at.size(); ++f) {
      const auto column = static_cast<Eigen::Index>(f);
      Vec6 base, base_left;
      const Eigen::VectorXd x = factor.solve(part.whole.col(column), Vec6::Zero(), &base);
      const Eigen::VectorXd left = factor.solve_transposed(part.whole.col(column), &base_left);
      const Eigen::VectorXd seen = linalg::along(part.chain, part.attachments, x);
      const Eigen::VectorXd seen_left = linalg::along(part.chain, part.attachments, left);
      const int at = part.whole_at[f];
      for (std::size_t i = 0; i < part.at.size(); ++i) {
        K_(part.at[i], at) -= seen[static_cast<Eigen::Index>(i)];
        K_(at, part.at[i]) -= seen_left[static_cast<Eigen::Index>(i)];
      }
      for (std::size_t g = 0; g < part.whole_at.size(); ++g)
        K_(part.whole_at[g], at) -= part.whole.col(static_cast<Eigen::Index>(g)).dot(x);
      K_.block(first, at, nb, 1) -= part.base.transpose() * base;
      K_.block(at, first, 1, nb) -= base_left.transpose() * part.base;
    }
  }
  scale_ = equilibrate(K_);
}

void CoupledFactor::join_chains() {
  factors_.clear();
  K_ = written_out(problem_);
  scale_ = equilibrate(K_);
  lu_.reset();
}

CoupledSolution CoupledFactor::solve_once(const RightSide& right) const {
  const Eigen::Index nz = problem_.B.rows(), border = border_size(problem_);
  CoupledSolution solution;
  Eigen::VectorXd b(K_.rows());
  b.head(nz) = -right.r;
  b.segment(nz, border - nz) = right.c;
  const bool written_out = factors_.size() != problem_.chains.size();
  Eigen::Index at = border;
  for (std::size_t n = 0; n < problem_.chains.size(); ++n) {
    const ChainPart& part = problem_.chains[n];
    if (written_out) {
      b.segment(at, part.r.size()) = -right.chains[n];
      at += part.r.size();
      continue;
    }
    Vec6 base;
    const Eigen::VectorXd x = factors_[n].solve(-right.chains[n], Vec6::Zero(), &base);
    base_of(part, b) -= part.base.transpose() * base;
    const Eigen::VectorXd seen = linalg::along(part.chain, part.attachments, x);
    for (std::size_t i = 0; i < part.at.size(); ++i) b[part.at[i]] -= seen[static_cast<Eigen::Index>(i)];
    for (std::size_t f = 0; f < part.whole_at.size(); ++f)
      b[part.whole_at[f]] -= part.whole.col(static_cast<Eigen::Index>(f)).dot(x);
  }
  b.array() *= scale_.array();
  Eigen::VectorXd y = b;
  if (singular_) {
    Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd> cod;
    cod.setThreshold(1e-12);
    cod.compute(K_);
    y = cod.solve(b);
    solution.redundant = true;
  } else if (b.size() > 0) {
    y = symmetric_ ? symmetric_->solve(b) : lu_->solve(b);
  }
  y.array() *= scale_.array();
  solution.dz = y.head(nz);
  solution.dlambda = y.segment(nz, border - nz);
  at = border;
  Eigen::VectorXd outside = y.head(border);
  for (std::size_t n = 0; n < problem_.chains.size(); ++n) {
    const ChainPart& part = problem_.chains[n];
    if (written_out) {
      solution.dq.emplace_back(y.segment(at, part.r.size()));
      at += part.r.size();
    } else {
      const Vec6 twist = part.base * base_of(part, outside);
      solution.dq.push_back(factors_[n].solve(-right.chains[n] - pulled(part, outside), twist));
    }
  }
  return solution;
}

RightSide CoupledFactor::residual(const RightSide& right, const CoupledSolution& solution, double& relative) const {
  const Eigen::Index nz = problem_.B.rows(), border = border_size(problem_);
  Eigen::VectorXd y(border), left(border), bound(border);
  y << solution.dz, solution.dlambda;
  left << -right.r - problem_.B * solution.dz - problem_.G.transpose() * solution.dlambda,
      right.c - problem_.G * solution.dz + problem_.W * solution.dlambda;
  bound << right.r.cwiseAbs() + problem_.B.cwiseAbs() * solution.dz.cwiseAbs() +
               problem_.G.transpose().cwiseAbs() * solution.dlambda.cwiseAbs(),
      right.c.cwiseAbs() + problem_.G.cwiseAbs() * solution.dz.cwiseAbs() +
          problem_.W.cwiseAbs() * solution.dlambda.cwiseAbs();
  RightSide rest;
  relative = 0.0;
  for (std::size_t n = 0; n < problem_.chains.size(); ++n) {
    const ChainPart& part = problem_.chains[n];
    const Eigen::VectorXd& x = solution.dq[n];
    const Vec6 twist = part.base * base_of(part, y);
    const Eigen::VectorXd pull = pulled(part, y), own = linalg::multiply(part.chain, x, twist);
    rest.chains.emplace_back(right.chains[n] + own + pull);  // stands with the sign of r
    const Eigen::VectorXd base = part.base.transpose() * (part.chain.V * x + total_wrench(part, y));
    base_of(part, left) -= base;
    base_of(part, bound) += base.cwiseAbs();
    const Eigen::VectorXd seen = linalg::along(part.chain, part.attachments, x);
    for (std::size_t i = 0; i < part.at.size(); ++i) {
      const double moved = seen[static_cast<Eigen::Index>(i)] + part.attachments[i].g.dot(twist);
      left[part.at[i]] -= moved;
      bound[part.at[i]] += std::abs(moved);
    }
    for (std::size_t f = 0; f < part.whole_at.size(); ++f) {
      const double moved = part.whole.col(static_cast<Eigen::Index>(f)).dot(x);
      left[part.whole_at[f]] -= moved;
      bound[part.whole_at[f]] += std::abs(moved);
    }
    if (x.size() > 0) {
      const double size = (right.chains[n].cwiseAbs() + own.cwiseAbs() + pull.cwiseAbs()).lpNorm<Eigen::Infinity>();
      if (size > 0.0) relative = std::max(relative, rest.chains.back().lpNorm<Eigen::Infinity>() / size);
      if (!x.allFinite()) relative = INFINITY;
    }
  }
  if (border > 0) {
    // Row by row in the scaled sense: what is left over against what was summed up, both as the border weighs them.
    const Eigen::VectorXd weight = scale_.head(border);
    const double size = bound.cwiseProduct(weight).lpNorm<Eigen::Infinity>();
    if (size > 0.0) relative = std::max(relative, left.cwiseProduct(weight).lpNorm<Eigen::Infinity>() / size);
  }
  rest.r = -left.head(nz);
  rest.c = left.tail(border - nz);
  if (!left.allFinite()) relative = INFINITY;
  return rest;
}

CoupledSolution CoupledFactor::solve(const RightSide& right) {
  for (;;) {
    const bool written_out = factors_.size() != problem_.chains.size();
    CoupledSolution solution;
    if (!K_.allFinite()) {
      if (written_out || problem_.chains.empty()) return solution;
      join_chains();
      continue;
    }
    if (!symmetric_ && !lu_ && K_.rows() > 0) {
      lu_ = std::make_unique<Eigen::PartialPivLU<Eigen::MatrixXd>>(K_);
      const Eigen::VectorXd pivots = lu_->matrixLU().diagonal().cwiseAbs();
      singular_ = !(pivots.minCoeff() > 1e-14 * pivots.maxCoeff()) || !(lu_->rcond() > 1e-15);
    }
    solution = solve_once(right);
    double relative = INFINITY;
    const RightSide rest = residual(right, solution, relative);
    solution.residual = relative;
    if (std::isfinite(relative) && !singular_) {  // one refinement
      CoupledSolution correction = solve_once(rest);
      correction.dz += solution.dz;
      correction.dlambda += solution.dlambda;
      for (std::size_t n = 0; n < correction.dq.size(); ++n) correction.dq[n] += solution.dq[n];
      residual(right, correction, relative);
      if (relative <= solution.residual) solution = std::move(correction);
      solution.residual = std::min(solution.residual, relative);
    }
    solution.redundant = singular_;
    solution.ok = solution.residual < (singular_ ? 1e-6 : kTolerance);
    if (solution.ok) return solution;
    if (symmetric_) {
      symmetric_.reset();
    } else if (!singular_ && (written_out || problem_.chains.empty())) {
      singular_ = true;  // its LU says it is not, its residual that it is
    } else if (!written_out && !problem_.chains.empty()) {
      join_chains();
      singular_ = false;
    } else {
      return solution;
    }
  }
}

int CoupledFactor::negative() const {
  int count = 0;
  for (const linalg::ChainFactor& factor : factors_) count += factor.negative();
  if (symmetric_) return count + symmetric_->negative();
  if (K_.rows() == 0 || !K_.allFinite()) return count;
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> border(K_, Eigen::EigenvaluesOnly);
  return count + static_cast<int>((border.eigenvalues().array() < 0.0).count());
}

CoupledSolution solve_direct(const CoupledProblem& problem) {
  CoupledFactor factor(problem);
  return factor.solve(right_side(problem));
}

}  // namespace sinew::solve
