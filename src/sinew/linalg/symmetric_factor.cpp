#include "sinew/linalg/symmetric_factor.hpp"

#include <algorithm>
#include <cmath>

namespace sinew::linalg {

bool SymmetricFactor::factor(const Eigen::MatrixXd& A, std::span<const int> order, double vanished) {
  const auto n = static_cast<int>(A.rows());
  order_.assign(order.begin(), order.end());
  stride_ = whole_lanes(n);
  panel_.assign(static_cast<std::size_t>(stride_) * static_cast<std::size_t>(n), 0.0);
  pivots_.setZero(n);
  signs_.setOnes(n);
  for (int j = 0; j < n; ++j) {
    double* column = panel_.data() + static_cast<std::ptrdiff_t>(j) * stride_;
    for (int i = j; i < n; ++i) column[i] = A(order_[i], order_[j]);
  }
  if (!kernels_->factor(panel_.data(), stride_, n, n, pivots_.data(), signs_.data())) return false;
  return n == 0 || pivots_.cwiseAbs().minCoeff() > vanished * pivots_.cwiseAbs().maxCoeff();
}

Eigen::VectorXd SymmetricFactor::solve(const Eigen::VectorXd& b) const {
  const auto n = static_cast<int>(b.size());
  Eigen::VectorXd y = Eigen::VectorXd::Zero(stride_ + kLanes), x(n);
  for (int i = 0; i < n; ++i) y[i] = b[order_[i]];
  kernels_->solve(panel_.data(), stride_, n, y.data());
  y.head(n).array() *= signs_.array();
  kernels_->solve_transposed(panel_.data(), stride_, n, y.data());
  for (int i = 0; i < n; ++i) x[order_[i]] = y[i];
  return x;
}

int SymmetricFactor::negative() const { return static_cast<int>((signs_.array() < 0.0).count()); }

}  // namespace sinew::linalg
