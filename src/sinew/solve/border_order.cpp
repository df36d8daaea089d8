#include "sinew/solve/border_order.hpp"

#include <algorithm>
#include <numeric>
#include <utility>

namespace sinew::solve {

namespace {

/// Visits the unknowns of the border that a chain ties to each other.
template <class Visit>
void each_tied(const ChainPart& part, const Visit& visit) {
  for (Eigen::Index i = 0; i < part.base.cols(); ++i) visit(part.first_base + static_cast<int>(i));
  for (const int i : part.at) visit(i);
  for (const int i : part.whole_at) visit(i);
}

/// Sizes, and places that hold numbers.
void gather(const CoupledProblem& problem, std::vector<int>& pattern) {
  pattern.clear();
  const auto add_entries = [&](const Entries& entries) {
    pattern.push_back(static_cast<int>(entries.end() - entries.begin()));
    for (const auto& [row, column, value] : entries) {
      pattern.push_back(row);
      pattern.push_back(column);
    }
  };
  const auto add = [&](const std::vector<int>& at) {
    pattern.push_back(static_cast<int>(at.size()));
    pattern.insert(pattern.end(), at.begin(), at.end());
  };
  for (const auto size : {problem.r.size(), problem.c.size()}) pattern.push_back(static_cast<int>(size));
  for (const auto count : {problem.volumes.size(), problem.chains.size()}) pattern.push_back(static_cast<int>(count));
  for (const Entries* own : {&problem.B, &problem.G, &problem.W}) add_entries(*own);
  for (const VolumePart& volume : problem.volumes) add(volume.at);
  for (const ChainPart& part : problem.chains) {
    pattern.push_back(part.first_base);
    pattern.push_back(static_cast<int>(part.base.cols()));
    add(part.at);
    add(part.whole_at);
  }
}

}  // namespace

void BorderOrder::set(const CoupledProblem& problem) {
  gather(problem, next_);
  if (next_ == pattern_) return;
  pattern_.clear();  // memory may run out
  find(problem);
  pattern_ = next_;
}

void BorderOrder::find(const CoupledProblem& problem) {
  const auto nz = static_cast<int>(problem.r.size()), size = nz + static_cast<int>(problem.c.size());
  constexpr int kNone = -1, kYields = -2;
  place_.assign(static_cast<std::size_t>(size), kNone);
  for (const VolumePart& volume : problem.volumes) {
    for (const int row : volume.at) place_[nz + row] = kYields;
  }
  for (const auto& entry : problem.W) place_[nz + entry.row] = kYields;
  for (const ChainPart& part : problem.chains) {
    each_tied(part, [&](int i) {
      if (i >= nz) place_[i] = kYields;
    });
  }
  int next = 0;  // a volume's rows as they come, so that its W can be copied
  for (const VolumePart& volume : problem.volumes) {
    for (const int row : volume.at) {
      if (place_[nz + row] == kYields) place_[nz + row] = next++;
    }
  }
  for (int i = nz; i < size; ++i) {
    if (place_[i] == kYields) place_[i] = next++;
  }
  yielding_ = next;
  for (int i = 0; i < nz; ++i) place_[i] = next++;
  for (int i = nz; i < size; ++i) {
    if (place_[i] == kNone) place_[i] = next++;
  }
  find_begins(problem);
  held_.resize(static_cast<std::size_t>(nz));  // coordinates that begin together stay together
  std::iota(held_.begin(), held_.end(), 0);
  std::sort(held_.begin(), held_.end(),
            [this](int a, int b) { return std::pair(begin_[place_[a]], a) < std::pair(begin_[place_[b]], b); });
  for (int i = 0; i < nz; ++i) place_[held_[i]] = yielding_ + i;
  find_begins(problem);
}

void BorderOrder::find_begins(const CoupledProblem& problem) {
  const auto nz = static_cast<int>(problem.r.size());
  begin_.resize(place_.size());
  std::iota(begin_.begin(), begin_.end(), 0);
  const auto tie = [&](int i, int j) {
    const auto [first, last] = std::minmax(place_[i], place_[j]);
    begin_[last] = std::min(begin_[last], first);
  };
  for (const auto& entry : problem.B) tie(entry.row, entry.column);
  for (const auto& entry : problem.G) tie(nz + entry.row, entry.column);
  for (const auto& entry : problem.W) tie(nz + entry.row, nz + entry.column);
  for (const VolumePart& volume : problem.volumes) {
    if (volume.at.empty()) continue;
    const int first = *std::min_element(volume.at.begin(), volume.at.end(),
                                        [&](int a, int b) { return place_[nz + a] < place_[nz + b]; });
    for (const int row : volume.at) tie(nz + first, nz + row);
  }
  for (const ChainPart& part : problem.chains) {
    int first = -1;
    each_tied(part, [&](int i) {
      if (first < 0 || place_[i] < place_[first]) first = i;
    });
    each_tied(part, [&](int i) { tie(first, i); });
  }
}

}  // namespace sinew::solve
