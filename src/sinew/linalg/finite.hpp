// Whether numbers are numbers.
#pragma once

#include <Eigen/Core>

namespace sinew::linalg {

/// Whether all are finite: 0 times infinity or NaN is NaN. (Eigen's allFinite asks one after the other.)
template <class Numbers>
bool finite(const Eigen::PlainObjectBase<Numbers>& numbers) {
  using Eight = Eigen::Array<double, 8, 1>;
  Eight sums = Eight::Zero();
  const double* at = numbers.data();
  const double* const end = at + numbers.size();
  for (; end - at >= 8; at += 8) sums += 0.0 * Eight::Map(at);
  double sum = 0.0;
  for (; at != end; ++at) sum += 0.0 * *at;
  return sums.sum() + sum == 0.0;
}

}  // namespace sinew::linalg
