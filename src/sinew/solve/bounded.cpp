#include "sinew/solve/bounded.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

namespace sinew::solve {

/// Towards the least over what is free, up to the first bound in the way; false without a factor. `step_` is left zero
/// if no bound was.
bool Bounded::move_free(const Eigen::MatrixXd& H, const Eigen::VectorXd& lower, const Eigen::VectorXd& upper,
                        Eigen::VectorXd& x) {
  const auto n = static_cast<Eigen::Index>(free_.size());
  K_.resize(H.rows(), H.cols());
  step_.resize(H.rows());
  auto K = K_.topLeftCorner(n, n);
  auto step = step_.head(n);
  for (Eigen::Index j = 0; j < n; ++j) {
    step[j] = -slope_[free_[j]];
    for (Eigen::Index i = 0; i < n; ++i) K(i, j) = H(free_[i], free_[j]);
  }
  const Eigen::LLT<Eigen::Ref<Eigen::MatrixXd>> factor(K);
  if (factor.info() != Eigen::Success) return false;
  factor.solveInPlace(step);
  double part = 1.0;
  int blocking = -1;
  for (Eigen::Index j = 0; j < n; ++j) {
    const int i = free_[j];
    const double room = step[j] < 0.0 ? lower[i] - x[i] : upper[i] - x[i];
    if (step[j] == 0.0 || !(room / step[j] < part)) continue;
    part = std::max(0.0, room / step[j]);
    blocking = static_cast<int>(j);
  }
  for (Eigen::Index j = 0; j < n; ++j) x[free_[j]] += part * step[j];
  if (blocking < 0) {
    free_.clear();
    return true;
  }
  const int i = free_[blocking];
  const bool down = step[blocking] < 0.0;
  x[i] = down ? lower[i] : upper[i];
  at_[i] = down ? At::lower : At::upper;
  return true;
}

bool Bounded::minimise(const Eigen::MatrixXd& H, const Eigen::VectorXd& g, const Eigen::VectorXd& lower,
                       const Eigen::VectorXd& upper, Eigen::VectorXd& x) {
  const auto n = static_cast<int>(H.rows());
  iterations_ = 0;
  at_.assign(static_cast<std::size_t>(n), At::between);
  if (n == 0) return true;
  if (!H.allFinite() || !g.allFinite() || !(lower.array() <= upper.array()).all()) return false;
  for (int i = 0; i < n; ++i) {
    x[i] = std::isfinite(x[i]) ? std::clamp(x[i], lower[i], upper[i]) : std::clamp(0.0, lower[i], upper[i]);
    if (lower[i] == upper[i]) at_[i] = At::lower;
  }
  const double scale = g.cwiseAbs().maxCoeff() + H.cwiseAbs().maxCoeff() * x.cwiseAbs().maxCoeff();
  // Every set of bounds is met at most once, since the function falls: far fewer than the limit.
  const int limit = 100 + 20 * n;
  while (++iterations_ <= limit) {
    slope_ = g;
    slope_.noalias() += H.selfadjointView<Eigen::Lower>() * x;
    free_.clear();
    for (int i = 0; i < n; ++i) {
      if (at_[i] == At::between) free_.push_back(i);
    }
    if (!free_.empty()) {
      if (!move_free(H, lower, upper, x)) return false;
      if (!free_.empty()) continue;  // a bound was in the way
      slope_ = g;
      slope_.noalias() += H.selfadjointView<Eigen::Lower>() * x;
    }
    // The bound that is left with the greatest gain.
    int leaving = -1;
    double gain = 1e-14 * scale;
    for (int i = 0; i < n; ++i) {
      if (at_[i] == At::between || lower[i] == upper[i]) continue;
      const double pull = at_[i] == At::lower ? -slope_[i] : slope_[i];
      if (pull > gain) {
        gain = pull;
        leaving = i;
      }
    }
    if (leaving < 0) return true;
    at_[leaving] = At::between;
  }
  return false;
}

}  // namespace sinew::solve
