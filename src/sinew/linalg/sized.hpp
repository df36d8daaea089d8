// Small matrices of a size known only to the run, as matrices of fixed size: no loop and no heap is left to the run.
#pragma once

#include <Eigen/Core>
#include <type_traits>

namespace sinew::linalg {

/// No small matrix is larger.
constexpr int kLargest = 36;

/// f(the number m as a constant): 1 .. 6 as they are, everything else as Eigen::Dynamic.
template <class F>
auto with_size(Eigen::Index m, const F& f) {
  switch (m) {
    case 1:
      return f(std::integral_constant<int, 1>{});
    case 2:
      return f(std::integral_constant<int, 2>{});
    case 3:
      return f(std::integral_constant<int, 3>{});
    case 4:
      return f(std::integral_constant<int, 4>{});
    case 5:
      return f(std::integral_constant<int, 5>{});
    case 6:
      return f(std::integral_constant<int, 6>{});
    default:
      return f(std::integral_constant<int, Eigen::Dynamic>{});
  }
}

/// Matrices of a size known or not, which live on the stack.
template <int M>
constexpr int kMost = M == Eigen::Dynamic ? kLargest : M;
template <int M>
using Columns = Eigen::Matrix<double, 6, M, 0, 6, kMost<M>>;
template <int M>
using Square = Eigen::Matrix<double, M, M, 0, kMost<M>, kMost<M>>;
template <int M>
using Vector = Eigen::Matrix<double, M, 1, 0, kMost<M>, 1>;

}  // namespace sinew::linalg
