#include "sinew/solve/direct.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "sinew/linalg/finite.hpp"

namespace sinew::solve {

namespace {

using linalg::Matrix6X;
using linalg::Vec6;

constexpr double kAimed = 2e-13;      ///< residual that solutions are refined to ...
constexpr double kExpected = 2e-15;   ///< ... and that is not looked at where it is expected
constexpr double kSymmetric = 1e-11;  ///< residual that is good enough: of the symmetric factor, or an LU takes over;
constexpr double kTolerance = 1e-9;   ///< of the LU, or chains join the border;
constexpr double kSingular = 1e-6;    ///< of the smallest solution of a singular border
/// A compliance smaller than this part of the largest one counts as none.
constexpr double kVanished = 1e-10;

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

int unknowns_of(const CoupledProblem& problem) { return static_cast<int>(problem.r.size()); }
int border_size(const CoupledProblem& problem) { return static_cast<int>(problem.r.size() + problem.c.size()); }

/// A border written out: entries (i, j) of the border are those of a matrix.
class Dense {
 public:
  explicit Dense(Eigen::MatrixXd& K) : K_(K) {}
  void add(int i, int j, double value) { K_(i, j) += value; }
  /// Subtracts a matrix over the border unknowns `shift` + at; of a symmetric one only the lower triangle counts.
  void subtract(const std::vector<int>& at, int shift, const Eigen::MatrixXd& M, bool symmetric) {
    for (Eigen::Index b = 0; b < M.cols(); ++b) {
      for (Eigen::Index a = 0; a < M.rows(); ++a)
        K_(shift + at[a], shift + at[b]) -= symmetric && a < b ? M(b, a) : M(a, b);
    }
  }

 private:
  Eigen::MatrixXd& K_;
};

/// The same of a symmetric matrix, in the order of its elimination: half of it is enough.
class Half {
 public:
  Half(linalg::SymmetricFactor& factor, const std::vector<int>& place, std::vector<int>& places)
      : factor_(factor), place_(place), places_(places) {}
  void add(int i, int j, double value) {
    if (place_[i] >= place_[j]) factor_.column(place_[j])[place_[i]] += value;
  }
  void subtract(const std::vector<int>& at, int shift, const Eigen::MatrixXd& M, bool) {
    const auto n = static_cast<int>(at.size());
    places_.resize(at.size());
    bool consecutive = true;  // as a volume's rows are
    for (int a = 0; a < n; ++a) {
      places_[a] = place_[shift + at[a]];
      consecutive &= a == 0 || places_[a] == places_[a - 1] + 1;
    }
    for (int b = 0; b < n; ++b) {
      const int own = places_[b];
      if (consecutive) {
        Eigen::VectorXd::Map(factor_.column(own) + own, n - b) -= M.col(b).tail(n - b);
        continue;
      }
      double* const column = factor_.column(own);
      column[own] -= M(b, b);
      for (int a = b + 1; a < n; ++a) {
        const int other = places_[a];
        if (other > own) {
          column[other] -= M(a, b);
        } else {  // above the diagonal; the same unknown twice stands on both sides of it
          factor_.column(other)[own] -= (own == other ? 2.0 : 1.0) * M(a, b);
        }
      }
    }
  }

 private:
  linalg::SymmetricFactor& factor_;
  const std::vector<int>& place_;
  std::vector<int>& places_;
};

/// What the border is without chains.
template <class Border>
void fill_bare(const CoupledProblem& problem, Border& border) {
  const int nz = unknowns_of(problem);
  for (const auto& [row, column, value] : problem.B) border.add(row, column, value);
  for (const auto& [row, column, value] : problem.G) {
    border.add(nz + row, column, value);
    border.add(column, nz + row, value);
  }
  for (const auto& [row, column, value] : problem.W) border.add(nz + row, nz + column, -value);
  for (const VolumePart& volume : problem.volumes) border.subtract(volume.at, nz, volume.W, volume.symmetric);
}

auto base_of(const ChainPart& part, Eigen::VectorXd& y) { return y.segment(part.first_base, part.base.cols()); }

/// pull = R^T y of all attachments, single ones and those along the whole chain; `own` is room. Returns the wrench that
/// the base feels of the former.
Vec6 pull_of(const ChainPart& part, const Eigen::VectorXd& y, Eigen::VectorXd& own, Eigen::VectorXd& pull) {
  own.resize(static_cast<Eigen::Index>(part.at.size()));
  for (std::size_t i = 0; i < part.at.size(); ++i) own[static_cast<Eigen::Index>(i)] = y[part.at[i]];
  Vec6 wrench = linalg::across(part.chain, part.attachments, own, pull);
  for (std::size_t f = 0; f < part.whole_at.size(); ++f)
    pull += y[part.whole_at[f]] * part.whole.col(static_cast<Eigen::Index>(f));
  return wrench;
}

bool finite(const CoupledSolution& solution) {
  return linalg::finite(solution.dz) && linalg::finite(solution.dlambda) &&
         std::all_of(solution.dq.begin(), solution.dq.end(), [](const auto& own) { return linalg::finite(own); });
}

template <class Vector>
double largest(const Eigen::MatrixBase<Vector>& v) {
  return v.size() > 0 ? v.template lpNorm<Eigen::Infinity>() : 0.0;
}

}  // namespace

CoupledSolution& CoupledSolution::operator+=(const CoupledSolution& other) {
  dz += other.dz;
  dlambda += other.dlambda;
  for (std::size_t n = 0; n < dq.size(); ++n) dq[n] += other.dq[n];
  return *this;
}

Eigen::MatrixXd written_out(const CoupledProblem& problem) {
  Eigen::Index size = border_size(problem);
  for (const ChainPart& part : problem.chains) size += part.chain.coordinates();
  Eigen::MatrixXd K = Eigen::MatrixXd::Zero(size, size);
  Dense border(K);
  fill_bare(problem, border);
  Eigen::Index at = border_size(problem);
  for (const ChainPart& part : problem.chains) {
    const Eigen::Index n = part.chain.coordinates(), nb = part.base.cols();
    const linalg::Chain& chain = part.chain;
    K.block(at, at, n, n) = linalg::dense(chain);
    K.block(part.first_base, at, nb, n) = part.base.transpose() * chain.V;
    K.block(at, part.first_base, n, nb) = chain.left().transpose() * part.base;
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

void right_side(const CoupledProblem& problem, RightSide& right) {
  right.r = problem.r;
  right.c = problem.c;
  right.chains.resize(problem.chains.size());
  for (std::size_t n = 0; n < problem.chains.size(); ++n) right.chains[n] = problem.chains[n].r;
}

void CoupledFactor::eliminate_chains(const CoupledProblem& problem) {
  problem_ = &problem;
  factors_.resize(problem.chains.size());
  condensed_.resize(problem.chains.size());
  rooms_.resize(problem.chains.size());
  correction_.dz.resize(problem.r.size());
  correction_.dlambda.resize(problem.c.size());
  correction_.dq.resize(problem.chains.size());
  for (std::size_t n = 0; n < problem.chains.size(); ++n) correction_.dq[n].resize(problem.chains[n].r.size());
  chains_ = true;
  for (std::size_t n = 0; n < problem.chains.size() && chains_; ++n) {
    const ChainPart& part = problem.chains[n];
    chains_ = factors_[n].factor(part.chain);
    if (chains_) factors_[n].condense(part.attachments, condensed_[n]);
  }
}

void CoupledFactor::factor() {
  lu_.reset();
  bool symmetric = chains_;
  for (const ChainPart& part : problem_->chains) symmetric &= part.chain.symmetric();
  for (const VolumePart& volume : problem_->volumes) symmetric &= volume.symmetric;
  if (!symmetric || !factor_symmetric()) factor_general(!chains_);
}

/// Weights of the border's unknowns, so that rows of different units are judged alike, by Ruiz' sweeps over its few
/// entries and its diagonal, which bounds what is dense.
void CoupledFactor::weigh() {
  const CoupledProblem& problem = *problem_;
  const int nz = unknowns_of(problem), size = border_size(problem);
  diagonal_.resize(size);
  const std::vector<int>& place = order_.place();
  for (int i = 0; i < size; ++i) diagonal_[i] = std::abs(symmetric_.column(place[i])[place[i]]);
  double most = 0.0;  // but for rows that hold nothing now
  for (const VolumePart& volume : problem.volumes) {
    for (Eigen::Index i = 0; i < volume.W.rows(); ++i) {
      if (volume.W(i, i) != 0.0) most = std::max(most, diagonal_[nz + volume.at[static_cast<std::size_t>(i)]]);
    }
  }
  for (const ChainPart& part : problem.chains) {
    for (const int i : part.at) most = i >= nz ? std::max(most, diagonal_[i]) : most;
  }
  least_.assign(static_cast<std::size_t>(size), 0.0);
  scale_.setOnes(size);
  for (int sweep = 0; sweep < 4; ++sweep) {
    largest_ = diagonal_.cwiseProduct(scale_.cwiseProduct(scale_));
    const auto meet = [this](int i, int j, double value) {
      const double weighed = std::abs(value) * scale_[i] * scale_[j];
      largest_[i] = std::max(largest_[i], weighed);
      largest_[j] = std::max(largest_[j], weighed);
    };
    for (const auto& [row, column, value] : problem.G) meet(nz + row, column, value);
    for (const auto& [row, column, value] : problem.B) meet(row, column, value);
    for (double& own : largest_) own = own > 0.0 ? own : 1.0;
    scale_.array() /= largest_.array().sqrt();
  }
  std::fill_n(least_.begin(), order_.yielding(), -kVanished * most);
  for (int i = 0; i < nz; ++i) {
    least_[place[i]] = kVanished / (scale_[i] * scale_[i]);
    if (problem.reference.size() > 0) least_[place[i]] = std::max(least_[place[i]], kVanished * problem.reference[i]);
  }
}

bool CoupledFactor::factor_symmetric() {
  const CoupledProblem& problem = *problem_;
  const int size = border_size(problem);
  order_.set(problem);
  symmetric_.start(size);
  Half border(symmetric_, order_.place(), places_);
  fill(border);
  weigh();
  if (!scale_.allFinite() || !symmetric_.factor(order_.begin(), least_)) return false;
  // What is left of the pivots of rows that depend on each other is rounding.
  double smallest = INFINITY, most = 0.0;
  for (int i = unknowns_of(problem); i < size; ++i) {
    if (order_.yields(i)) continue;
    const double pivot = std::abs(symmetric_.pivot(order_.place()[i])) * scale_[i] * scale_[i];
    smallest = std::min(smallest, pivot);
    most = std::max(most, pivot);
  }
  if (most > 0.0 && !(smallest > 1e-14 * most)) return false;
  replaced_ = false;
  for (int i = 0; i < size; ++i)
    replaced_ |= least_[static_cast<std::size_t>(i)] != 0.0 &&
                 std::abs(symmetric_.pivot(i)) <= std::abs(least_[static_cast<std::size_t>(i)]);
  kind_ = Kind::symmetric;
  joined_ = false;
  return true;
}

void CoupledFactor::factor_general(bool join_chains) {
  joined_ = join_chains;
  orthogonal_.reset();
  if (joined_) {
    K_ = written_out(*problem_);
  } else {
    K_.setZero(border_size(*problem_), border_size(*problem_));
    Dense border(K_);
    fill(border);
  }
  scale_ = equilibrate(K_);
  kind_ = Kind::general;
  if (K_.rows() == 0 || !K_.allFinite()) return;
  lu_ = std::make_unique<Eigen::PartialPivLU<Eigen::MatrixXd>>(K_);
  const Eigen::VectorXd pivots = lu_->matrixLU().diagonal().cwiseAbs();
  if (!(pivots.minCoeff() > 1e-14 * pivots.maxCoeff()) || !(lu_->rcond() > 1e-15)) kind_ = Kind::singular;
}

/// The border with all chains eliminated.
template <class Border>
void CoupledFactor::fill(Border& border) const {
  fill_bare(*problem_, border);
  for (std::size_t n = 0; n < problem_->chains.size(); ++n) {
    const ChainPart& part = problem_->chains[n];
    const linalg::ChainFactor& factor = factors_[n];
    const linalg::ChainFactor::Condensed& condensed = condensed_[n];
    const auto nb = static_cast<int>(part.base.cols());
    border.subtract(part.at, 0, condensed.W, part.chain.symmetric());
    for (int i = 0; i < nb; ++i) {
      const Vec6 felt = factor.base_response().transpose() * part.base.col(i);
      const int own = part.first_base + i;
      for (int j = 0; j < nb; ++j) border.add(own, part.first_base + j, felt.dot(part.base.col(j)));
      for (std::size_t k = 0; k < part.at.size(); ++k) {
        const auto column = static_cast<Eigen::Index>(k);
        border.add(own, part.at[k], part.base.col(i).dot(condensed.arriving.col(column)));
        border.add(part.at[k], own, part.base.col(i).dot(condensed.answering.col(column)));
      }
    }
    for (std::size_t f = 0; f < part.whole_at.size(); ++f) {
      const auto column = static_cast<Eigen::Index>(f);
      Vec6 base, base_left;
      Eigen::VectorXd x = part.whole.col(column), left = x, seen, seen_left;
      factor.solve(x, Vec6::Zero(), &base);
      factor.solve_transposed(left, &base_left);
      linalg::along(part.chain, part.attachments, x, Vec6::Zero(), seen);
      linalg::along(part.chain, part.attachments, left, Vec6::Zero(), seen_left);
      const int at = part.whole_at[f];
      for (std::size_t i = 0; i < part.at.size(); ++i) {
        border.add(part.at[i], at, -seen[static_cast<Eigen::Index>(i)]);
        border.add(at, part.at[i], -seen_left[static_cast<Eigen::Index>(i)]);
      }
      for (std::size_t g = 0; g < part.whole_at.size(); ++g)
        border.add(part.whole_at[g], at, -part.whole.col(static_cast<Eigen::Index>(g)).dot(x));
      for (int i = 0; i < nb; ++i) {
        border.add(part.first_base + i, at, -part.base.col(i).dot(base));
        border.add(at, part.first_base + i, -part.base.col(i).dot(base_left));
      }
    }
  }
}

void CoupledFactor::solve_once(const RightSide& right, CoupledSolution& solution, Part wanted) {
  const CoupledProblem& problem = *problem_;
  const Eigen::Index nz = unknowns_of(problem), border = border_size(problem);
  Eigen::VectorXd& y = y_;
  y.resize(joined_ ? K_.rows() : border);
  y.head(nz) = -right.r;
  y.segment(nz, border - nz) = right.c;
  solution.dq.resize(problem.chains.size());
  Eigen::Index at = border;
  for (std::size_t n = 0; n < problem.chains.size(); ++n) {
    const ChainPart& part = problem.chains[n];
    Eigen::VectorXd& x = solution.dq[n];
    x.resize(right.chains[n].size());
    if (joined_) {
      y.segment(at, part.r.size()) = -right.chains[n];
      at += part.r.size();
      continue;
    }
    Vec6 base;
    if (right.chains[n].isZero(0.0)) {  // as answers to motors of bases are
      x.setZero();
      continue;
    }
    x = -right.chains[n];
    factors_[n].solve(x, Vec6::Zero(), &base);
    base_of(part, y).noalias() -= part.base.transpose().lazyProduct(base);
    Eigen::VectorXd& seen = rooms_[n].attached;
    linalg::along(part.chain, part.attachments, x, Vec6::Zero(), seen);
    for (std::size_t i = 0; i < part.at.size(); ++i) y[part.at[i]] -= seen[static_cast<Eigen::Index>(i)];
    for (std::size_t f = 0; f < part.whole_at.size(); ++f)
      y[part.whole_at[f]] -= part.whole.col(static_cast<Eigen::Index>(f)).dot(x);
  }
  if (kind_ == Kind::symmetric) {
    const std::vector<int>& place = order_.place();
    ordered_.resize(symmetric_.room());
    for (Eigen::Index i = 0; i < border; ++i) ordered_[place[i]] = y[i];
    symmetric_.solve(ordered_.data());
    for (Eigen::Index i = 0; i < border; ++i) y[i] = ordered_[place[i]];
  } else if (y.size() > 0) {
    y.array() *= scale_.array();
    if (kind_ == Kind::singular) {
      if (!orthogonal_) (orthogonal_ = std::make_unique<Orthogonal>())->setThreshold(1e-12).compute(K_);
      y = orthogonal_->solve(Eigen::VectorXd(y));
    } else {
      y = lu_->solve(Eigen::VectorXd(y));
    }
    y.array() *= scale_.array();
  }
  solution.dz = y.head(nz);
  solution.dlambda = y.segment(nz, border - nz);
  if (joined_) {
    at = border;
    for (Eigen::VectorXd& x : solution.dq) {
      x = y.segment(at, x.size());
      at += x.size();
    }
  } else if (wanted == Part::all) {
    find_strains(right, solution);
  } else {
    for (Eigen::VectorXd& x : solution.dq) x.setZero();
  }
}

/// They follow from all else.
void CoupledFactor::find_strains(const RightSide& right, CoupledSolution& solution) {
  y_.resize(border_size(*problem_));
  y_ << solution.dz, solution.dlambda;
  for (std::size_t n = 0; n < problem_->chains.size(); ++n) {
    const ChainPart& part = problem_->chains[n];
    Eigen::VectorXd& x = solution.dq[n];
    pull_of(part, y_, rooms_[n].attached, x);
    x = -right.chains[n] - x;
    Vec6 twist;
    twist.noalias() = part.base.lazyProduct(base_of(part, y_));
    factors_[n].solve(x, twist);
  }
}

double CoupledFactor::size_of(const RightSide& right, const CoupledSolution& solution) const {
  const Eigen::Index nz = right.r.size(), rows = right.c.size();
  return std::max({largest(right.r.cwiseProduct(scale_.head(nz))),
                   largest(right.c.cwiseProduct(scale_.segment(nz, rows))),
                   largest(solution.dz.cwiseQuotient(scale_.head(nz))),
                   largest(solution.dlambda.cwiseQuotient(scale_.segment(nz, rows)))});
}

double CoupledFactor::residual(const RightSide& right, const CoupledSolution& solution, RightSide& rest) {
  const CoupledProblem& problem = *problem_;
  const Eigen::Index nz = unknowns_of(problem), border = border_size(problem);
  y_.resize(border);
  y_ << solution.dz, solution.dlambda;
  Eigen::VectorXd& left = left_;
  left.resize(border);
  left << -right.r, right.c;
  const double *z = y_.data(), *lambda = z + nz;
  for (const auto& [row, column, value] : problem.B) left[row] -= value * z[column];
  for (const auto& [row, column, value] : problem.G) {
    left[nz + row] -= value * z[column];
    left[column] -= value * lambda[row];
  }
  for (const auto& [row, column, value] : problem.W) left[nz + row] += value * lambda[column];
  for (const VolumePart& volume : problem.volumes) {
    const auto count = static_cast<Eigen::Index>(volume.at.size());
    forces_.resize(count);
    for (Eigen::Index i = 0; i < count; ++i) forces_[i] = lambda[volume.at[i]];
    moved_.resize(count);
    if (volume.symmetric) {
      moved_.noalias() = volume.W.selfadjointView<Eigen::Lower>() * forces_;
    } else {
      moved_.noalias() = volume.W.lazyProduct(forces_);
    }
    for (Eigen::Index i = 0; i < count; ++i) left[nz + volume.at[i]] += moved_[i];
  }
  double relative = 0.0;
  rest.chains.resize(problem.chains.size());
  for (std::size_t n = 0; n < problem.chains.size(); ++n) {
    const ChainPart& part = problem.chains[n];
    const Eigen::VectorXd& x = solution.dq[n];
    Vec6 twist, wrench;
    twist.noalias() = part.base.lazyProduct(base_of(part, y_));
    auto& [attached, answer] = rooms_[n];
    linalg::along(part.chain, part.attachments, x, twist, attached);
    for (std::size_t i = 0; i < part.at.size(); ++i) left[part.at[i]] -= attached[static_cast<Eigen::Index>(i)];
    for (std::size_t f = 0; f < part.whole_at.size(); ++f)
      left[part.whole_at[f]] -= part.whole.col(static_cast<Eigen::Index>(f)).dot(x);
    Eigen::VectorXd& own = rest.chains[n];  // stands with the sign of r
    const Vec6 pulled = pull_of(part, y_, attached, own);
    // (Inertia of a base that is moved and of strains may cancel to nothing.)
    const double parts = linalg::multiply(part.chain, x, twist, answer, wrench);
    wrench += pulled;
    base_of(part, left).noalias() -= part.base.transpose().lazyProduct(wrench);
    const double size = std::max({largest(right.chains[n]), largest(own), parts});
    own += right.chains[n] + answer;
    if (size > 0.0) relative = std::max(relative, largest(own) / size);
    if (!x.allFinite()) relative = INFINITY;
  }
  const double size = size_of(right, solution);
  if (size > 0.0) relative = std::max(relative, largest(left.cwiseProduct(scale_.head(border))) / size);
  rest.r = -left.head(nz);
  rest.c = left.tail(border - nz);
  return left.allFinite() ? relative : INFINITY;
}

/// Until the equations hold, or do not get better; tells what was left at first. What a correction leaves goes with its
/// size, and is expected where it is small.
double CoupledFactor::refine(const RightSide& right, CoupledSolution& solution) {
  constexpr int kRefinements = 4;
  const double limit = kind_ == Kind::symmetric ? kSymmetric : kind_ == Kind::general ? kTolerance : kSingular;
  const double first = solution.residual = residual(right, solution, rest_);
  for (int i = 0; i < kRefinements && solution.residual > kAimed && std::isfinite(solution.residual); ++i) {
    if (kind_ == Kind::singular) break;
    solve_once(rest_, correction_);
    const double expected = solution.residual * size_of(rest_, correction_) / size_of(right, solution);
    const bool look = !(solution.residual < limit && expected < kExpected && finite(correction_));
    correction_ += solution;
    const double relative = look ? residual(right, correction_, rest_) : std::max(expected, 1e-16);
    if (!(relative < solution.residual)) break;
    std::swap(solution, correction_);
    solution.residual = relative;
  }
  solution.redundant = kind_ == Kind::singular;
  solution.ok = solution.residual < limit;
  return first;
}

void CoupledFactor::answer(const RightSide& right, CoupledSolution& solution, Part part) {
  if (kind_ != Kind::symmetric) return solve(right, solution);
  solve_once(right, solution, part);
  solution.redundant = false;
  solution.residual = 0.0;
  solution.ok = finite(solution);
}

bool CoupledFactor::polish(const RightSide& right, CoupledSolution& solution) {
  if (!joined_) find_strains(right, solution);
  const bool good = refine(right, solution) < kTolerance && solution.ok;
  if (!solution.ok) solve(right, solution);
  return good;
}

void CoupledFactor::solve(const RightSide& right, CoupledSolution& solution) {
  solution.ok = false;
  for (;;) {
    if (kind_ == Kind::symmetric || K_.allFinite()) {
      solve_once(right, solution);
      refine(right, solution);
      if (solution.ok) return;
    }
    const bool last = joined_ || problem_->chains.empty();
    if (kind_ == Kind::symmetric) {
      factor_general(false);
    } else if (!last) {
      factor_general(true);
    } else if (kind_ == Kind::general && K_.allFinite()) {
      kind_ = Kind::singular;  // its LU says it is not, its residual that it is
    } else {
      return;
    }
  }
}

MatrixInertia CoupledFactor::inertia() const {
  constexpr int kLargest = 600;  // beyond that it takes seconds, and the factor's pivots have to do
  MatrixInertia all;
  if (kind_ != Kind::symmetric) {
    if (K_.rows() > 0 && K_.allFinite()) all = inertia_of(K_);
  } else if (const int size = border_size(*problem_); replaced_ && size <= kLargest) {
    Eigen::MatrixXd K = Eigen::MatrixXd::Zero(size, size);
    Dense border(K);
    fill(border);
    all = inertia_of(std::move(K));
  } else {
    all.negative = symmetric_.negative();
  }
  if (!joined_) {
    for (const linalg::ChainFactor& factor : factors_) all.negative += factor.negative();
  }
  return all;
}

/// By its eigenvalues, scaled: those that are zero but for rounding belong to motions that nothing resists, and count
/// as none.
MatrixInertia CoupledFactor::inertia_of(Eigen::MatrixXd K) const {
  constexpr double kZero = 1e-12;
  constexpr double kTakesPart = 0.1;  // of the largest part of a motion
  const Eigen::VectorXd& reference = problem_->reference;
  Eigen::VectorXd scale = equilibrate(K);
  for (Eigen::Index i = 0; i < reference.size(); ++i) {
    // What is left of it may be rounding, which must not be made larger.
    const double more = scale[i] * std::sqrt(kVanished / kZero * reference[i]);
    if (!(more > 1.0)) continue;
    K.row(i) /= more;
    K.col(i) /= more;
    scale[i] /= more;
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> values(K, Eigen::EigenvaluesOnly);
  MatrixInertia found;
  found.negative = static_cast<int>((values.eigenvalues().array() < -kZero).count());
  const bool known = reference.size() > 0 && reference.maxCoeff() > 0.0;
  if (!known || !(values.eigenvalues().cwiseAbs().minCoeff() <= kZero)) return found;
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> motions(K);
  Eigen::VectorXd part = Eigen::VectorXd::Zero(reference.size());
  for (Eigen::Index i = 0; i < K.rows(); ++i) {
    if (std::abs(motions.eigenvalues()[i]) > kZero) continue;
    // (What depends on each other among the rows is no motion: beside its multipliers there is rounding.)
    if (motions.eigenvectors().col(i).head(reference.size()).norm() < 1e-6) continue;
    const Eigen::VectorXd motion = motions.eigenvectors().col(i).cwiseProduct(scale).head(reference.size());
    const Eigen::VectorXd weighed = motion.cwiseAbs().cwiseProduct(reference.cwiseSqrt());
    if (const double largest = weighed.maxCoeff(); largest > 0.0) part = part.cwiseMax(weighed / largest);
  }
  for (int i = 0; i < static_cast<int>(part.size()); ++i) {
    if (part[i] > kTakesPart) found.null_unknowns.push_back(i);
  }
  return found;
}

CoupledSolution solve_direct(const CoupledProblem& problem) {
  CoupledFactor factor;
  factor.eliminate_chains(problem);
  factor.factor();
  RightSide right;
  right_side(problem, right);
  CoupledSolution solution;
  factor.solve(right, solution);
  return solution;
}

}  // namespace sinew::solve
