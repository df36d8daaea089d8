#include "sinew/linalg/symmetric_factor.hpp"

#include <algorithm>

namespace sinew::linalg {

void SymmetricFactor::start(int n) {
  size_ = n;
  stride_ = whole_lanes(n);
  // A block is divided as whole registers, so that rows beside the last may be written.
  panel_.resize(static_cast<std::size_t>(stride_) * static_cast<std::size_t>(n) + kLanes);
  for (int j = 0; j < n; ++j) std::fill(column(j) + j / kLanes * kLanes, column(j) + stride_, 0.0);
}

bool SymmetricFactor::factor(std::span<const int> begin, std::span<const double> least) {
  begin_.assign(static_cast<std::size_t>(stride_ / kLanes) + 1, size_);
  for (int i = 0; i < size_; ++i) begin_[i / kLanes] = std::min(begin_[i / kLanes], begin[i]);
  pivots_.resize(static_cast<std::size_t>(size_));
  signs_.resize(static_cast<std::size_t>(size_));
  return kernels_->factor_profile(panel_.data(), stride_, size_, begin_.data(), least.data(), pivots_.data(),
                                  signs_.data());
}

void SymmetricFactor::solve(double* b) const {
  std::fill(b + size_, b + stride_, 0.0);
  int first = 0;  // what is zero stays so
  while (first < size_ && b[first] == 0.0) ++first;
  if (first == size_) return;
  first -= first % kLanes;
  kernels_->solve(panel_.data() + static_cast<std::ptrdiff_t>(first) * (stride_ + 1), stride_, size_ - first,
                  b + first);
  for (int i = 0; i < size_; ++i) b[i] *= signs_[i];
  kernels_->solve_transposed(panel_.data(), stride_, size_, b);
}

int SymmetricFactor::negative() const {
  return static_cast<int>(std::count_if(signs_.begin(), signs_.end(), [](double sign) { return sign < 0.0; }));
}

}  // namespace sinew::linalg
