#include "sinew/solve/quadratic.hpp"

#include <algorithm>
#include <cmath>

#include "sinew/threads/interruption.hpp"

namespace sinew::solve {

namespace {

/// A limit that others exclude by no more than this part of what it is about does not contradict them.
constexpr double kMet = 1e-9;

}  // namespace

/// Q R = L^-1 N, N the normals of the active limits.
void Quadratic::span() {
  const Eigen::Index n = rows_.rows();
  Q_.resize(n, n);
  R_.resize(n, n);
  for (Eigen::Index k = 0; k < active(); ++k) {
    const Limit& own = active_[static_cast<std::size_t>(k)];
    auto q = Q_.col(k);
    q = own.sign * rows_.col(own.row);
    factor_.matrixL().solveInPlace(q);
    R_.col(k).setZero();
    for (int turn = 0; turn < 2; ++turn) {  // the second takes away what rounding left of the first
      for (Eigen::Index j = 0; j < k; ++j) {
        const double part = Q_.col(j).dot(q);
        q -= part * Q_.col(j);
        R_(j, k) += part;
      }
    }
    R_(k, k) = q.norm();
    q /= R_(k, k);
  }
}

/// Splits v = N give + (what moves no active limit), of which L^-T is left in v.
void Quadratic::split(Eigen::VectorXd& v) {
  const auto Q = Q_.leftCols(active());
  factor_.matrixL().solveInPlace(v);
  const double length = v.norm();
  auto give = give_.head(active());
  give.noalias() = Q.transpose().lazyProduct(v);
  v.noalias() -= Q.lazyProduct(give);
  R_.topLeftCorner(active(), active()).triangularView<Eigen::Upper>().solveInPlace(give);
  // What is left of a normal that the active ones span is rounding.
  if (!(v.norm() > 1e-10 * length)) v.setZero();
  factor_.matrixU().solveInPlace(v);
}

/// The least on the active limits, without what rounding has left on the way; and their pulls.
void Quadratic::settle(const Eigen::MatrixXd& H, const Eigen::VectorXd& g, const Eigen::VectorXd& lower,
                       const Eigen::VectorXd& upper, Eigen::VectorXd& x) {
  if (active() == 0) {  // no limit to drift off: one correction is enough
    along_ = -g;
    along_.noalias() -= H.selfadjointView<Eigen::Lower>() * x;
    factor_.solveInPlace(along_);
    x += along_;
    return;
  }
  span();
  for (int turn = 0; turn < 2; ++turn) {
    auto give = give_.head(active());
    for (Eigen::Index k = 0; k < active(); ++k) {
      const Limit& own = active_[static_cast<std::size_t>(k)];
      give[k] = own.sign * ((own.sign > 0.0 ? lower : upper)[own.row] - rows_.col(own.row).dot(x));
    }
    R_.topLeftCorner(active(), active()).triangularView<Eigen::Upper>().transpose().solveInPlace(give);
    normal_.noalias() = Q_.leftCols(active()).lazyProduct(give);
    factor_.matrixU().solveInPlace(normal_);
    x += normal_;
    along_ = -g;
    along_.noalias() -= H.selfadjointView<Eigen::Lower>() * x;
    split(along_);
    x += along_;
  }
  for (Eigen::Index k = 0; k < active(); ++k) {
    Limit& own = active_[static_cast<std::size_t>(k)];
    own.pull = own.equal ? -give_[k] : std::max(0.0, -give_[k]);
  }
}

Quadratic::Outcome Quadratic::minimise(const Eigen::MatrixXd& H, const Eigen::VectorXd& g, const Eigen::MatrixXd& A,
                                       const Eigen::VectorXd& lower, const Eigen::VectorXd& upper, Eigen::VectorXd& x) {
  const auto rows = static_cast<int>(A.rows());
  iterations_ = 0;
  at_.assign(static_cast<std::size_t>(rows), At::between);
  met_.assign(static_cast<std::size_t>(rows), false);
  conflict_.clear();
  active_.clear();
  pulls_.setZero(rows);
  if (!H.allFinite() || !g.allFinite() || !A.allFinite() || !(lower.array() <= upper.array()).all())
    return Outcome::invalid;
  if ((lower.array() == INFINITY).any() || (upper.array() == -INFINITY).any()) return Outcome::invalid;
  factor_.compute(H);
  if (factor_.info() != Eigen::Success) return Outcome::invalid;
  rows_ = A.transpose();
  give_.resize(H.rows());
  x = -g;
  factor_.solveInPlace(x);
  // Violations are compared in units of what their row moves by: |L^-1 n|, the steepness of its limit.
  scale_.setConstant(rows, -1.0);  // not known yet
  const auto steepness = [&](int row) {
    if (scale_[row] < 0.0) {
      half_ = rows_.col(row);
      factor_.matrixL().solveInPlace(half_);
      scale_[row] = half_.norm();
    }
    return scale_[row];
  };
  const double size = std::sqrt(std::abs(g.dot(x)));  // |L^T x|: how far the unbounded least is, in the same units
  const int limit = 100 + 20 * (rows + static_cast<int>(x.size()));

  // What is left of a limit that the others decide.
  const auto room = [&](int row, double bound, const Eigen::VectorXd& at) {
    return kMet * (rows_.col(row).cwiseAbs().dot(at.cwiseAbs()) + std::abs(bound));
  };

  bool settled = false, polished = false;
  while (true) {
    threads::Interruption::check();
    values_.noalias() = rows_.transpose().lazyProduct(x);
    Limit next{-1};
    double worst = 0.0;
    for (int i = 0; i < rows; ++i) {
      if (at_[i] != At::between || met_[static_cast<std::size_t>(i)]) continue;
      const double below = lower[i] - values_[i], above = values_[i] - upper[i], out = std::max(below, above);
      const double bound = below > above ? lower[i] : upper[i];
      if (!(out > 0.0)) continue;
      const double steep = steepness(i);
      if (!(out > 1e-13 * (steep * size + std::abs(bound)))) continue;
      if (steep == 0.0) {  // 0 . x beyond its limit
        conflict_ = {i};
        return Outcome::infeasible;
      }
      // Equalities first: they are never dropped.
      const bool equal = lower[i] == upper[i];
      const double weight = equal ? INFINITY : out / steep;
      if (next.row >= 0 && !(weight > worst)) continue;
      worst = weight;
      next = {i, below > above ? 1.0 : -1.0, equal, 0.0};
    }
    if (next.row < 0) {
      if (settled) {
        for (int i = 0; i < rows; ++i) {
          if (!met_[static_cast<std::size_t>(i)]) continue;
          if (lower[i] - values_[i] <= room(i, lower[i], x) && values_[i] - upper[i] <= room(i, upper[i], x)) continue;
          conflict_ = {i};
          return Outcome::infeasible;
        }
        break;
      }
      settle(H, g, lower, upper, x);
      settled = true;
      continue;
    }
    settled = false;
    while (true) {
      if (++iterations_ > limit) return Outcome::invalid;
      normal_ = next.sign * rows_.col(next.row);
      span();
      along_ = normal_;
      split(along_);
      int leaving = -1;
      double dual = INFINITY;  // the step at which an active limit no longer pushes
      for (std::size_t k = 0; k < active_.size(); ++k) {
        const double give = give_[static_cast<Eigen::Index>(k)];
        if (active_[k].equal || !(give > 1e-14) || !(active_[k].pull / give < dual)) continue;
        dual = active_[k].pull / give;
        leaving = static_cast<int>(k);
      }
      const double bound = next.sign > 0.0 ? lower[next.row] : -upper[next.row];
      const double out = bound - normal_.dot(x), gain = normal_.dot(along_);
      const double primal = gain > 0.0 ? std::max(0.0, out / gain) : INFINITY;
      const double step = std::min(primal, dual);
      // Of a matrix that is nearly singular x drifts off its active limits on the way.
      if (step == INFINITY && !polished) {
        settle(H, g, lower, upper, x);
        polished = true;
        break;
      }
      // What the others leave of it is rounding, of a matrix that may be nearly singular: it is met as well as can be.
      if (step == INFINITY && out <= room(next.row, bound, x)) {
        met_[static_cast<std::size_t>(next.row)] = true;
        break;
      }
      if (step == INFINITY) {
        conflict_ = {next.row};
        for (std::size_t k = 0; k < active_.size(); ++k) {
          const double give = give_[static_cast<Eigen::Index>(k)];
          if (give < -1e-14 || (active_[k].equal && give > 1e-14)) conflict_.push_back(active_[k].row);
        }
        std::sort(conflict_.begin(), conflict_.end());
        return Outcome::infeasible;
      }
      for (std::size_t k = 0; k < active_.size(); ++k) active_[k].pull -= step * give_[static_cast<Eigen::Index>(k)];
      next.pull += step;
      if (gain > 0.0) x += step * along_;
      if (step == primal) {
        at_[next.row] = next.sign > 0.0 ? At::lower : At::upper;
        active_.push_back(next);
        polished = false;
        break;
      }
      at_[active_[leaving].row] = At::between;
      active_.erase(active_.begin() + leaving);
    }
  }
  for (const Limit& own : active_) pulls_[own.row] = own.sign * own.pull;
  return x.allFinite() ? Outcome::solved : Outcome::invalid;
}

}  // namespace sinew::solve
