// Which of many constraint points are worth keeping: those that do not repeat one another.
#pragma once

#include <Eigen/Core>
#include <vector>

namespace sinew::constraint {

/// Pivoted Cholesky of a Gram matrix, G = A A^T with one row of A a candidate: the numbers of the rows kept, in the
/// order in which they were chosen. The first `forced` rows are kept whatever they say; a later one is dropped once the
/// part of it that the kept ones do not already span is shorter than `tolerance` times its length, or times what
/// `lengths` says instead, if it is not empty.
std::vector<int> independent_rows(Eigen::MatrixXd gram, double tolerance, int forced = 0,
                                  const Eigen::VectorXd& lengths = {});

}  // namespace sinew::constraint
