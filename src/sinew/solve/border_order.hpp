// The order in which a symmetric border is eliminated.
#pragma once

#include <vector>

#include "sinew/solve/coupled_problem.hpp"

namespace sinew::solve {

/// Rows that feel a compliance have negative pivots, what they hold then positive ones; the rest are rows again. In
/// this order a row of the matrix begins with the first unknown that anything ties it to. Volumes' rows stand as they
/// come: whoever numbers them puts together what one chain is tied to. z stands in the order in which it begins.
class BorderOrder {
 public:
  /// Found again only where other places of the problem hold numbers than before.
  void set(const CoupledProblem& problem);

  const std::vector<int>& place() const { return place_; }  ///< of each border unknown, z first, then rows
  const std::vector<int>& begin() const { return begin_; }  ///< of each place: its row's first number
  int yielding() const { return yielding_; }                ///< so many rows feel a compliance
  bool yields(int unknown) const { return place_[static_cast<std::size_t>(unknown)] < yielding_; }

 private:
  void find(const CoupledProblem& problem);
  void find_begins(const CoupledProblem& problem);  ///< once all have their places

  std::vector<int> place_, begin_;
  std::vector<int> held_;            ///< room
  std::vector<int> pattern_, next_;  ///< sizes, and where there are numbers
  int yielding_ = 0;
};

}  // namespace sinew::solve
