// Central differences for tests: what a derivative is compared with.
#pragma once

#include <Eigen/Core>

namespace sinew::test {

/// d function / dq by central differences, one column a coordinate; `function` returns a vector.
template <class Function>
Eigen::MatrixXd difference(const Function& function, const Eigen::VectorXd& q, double e) {
  Eigen::MatrixXd D;
  for (int i = 0; i < q.size(); ++i) {
    Eigen::VectorXd plus = q, minus = q;
    plus[i] += e;
    minus[i] -= e;
    const Eigen::VectorXd column = (function(plus) - function(minus)) / (plus[i] - minus[i]);
    if (i == 0) D.resize(column.size(), q.size());
    D.col(i) = column;
  }
  return D;
}

}  // namespace sinew::test
