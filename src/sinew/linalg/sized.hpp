// Small matrices of a size known only to the run, as matrices of fixed size: no loop and no heap is left to the run.
#pragma once

#include <Eigen/Core>
#include <type_traits>

namespace sinew::linalg {

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

}  // namespace sinew::linalg
