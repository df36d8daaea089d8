// Wall time of stages, added to their sums when they end.
#pragma once

#include <chrono>

namespace sinew {

class Clock {
 public:
  explicit Clock(double& sum) : sum_(&sum), start_(std::chrono::steady_clock::now()) {}
  Clock(const Clock&) = delete;
  Clock& operator=(const Clock&) = delete;
  ~Clock() { end(); }
  /// Ends a stage where another one begins.
  void next(double& sum) {
    start_ = end();
    sum_ = &sum;
  }

 private:
  std::chrono::steady_clock::time_point end() {
    const auto now = std::chrono::steady_clock::now();
    *sum_ += std::chrono::duration<double>(now - start_).count();
    return now;
  }

  double* sum_;
  std::chrono::steady_clock::time_point start_;
};

}  // namespace sinew
