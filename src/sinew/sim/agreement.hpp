// Commands of motors whose rows depend on each other: which ones agree.
#pragma once

#include "sinew/sim/reduced.hpp"

namespace sinew {

/// What commands of sought motors change by where rows that depend on each other agree with all that is told: A p = b,
/// a row for each combination of them, N^T (c - dc/dp p) = 0.
struct Agreement {
  Eigen::MatrixXd A;
  Eigen::VectorXd b;
};
Agreement agreement(const Model& model, const Reduced& reduced);

}  // namespace sinew
