#include "sinew/sim/agreement.hpp"

#include <Eigen/Dense>
#include <algorithm>

namespace sinew {

namespace {

constexpr double kNoPart = 1e-6;  ///< of a combination of length 1

}  // namespace

Agreement agreement(const Model& model, const Reduced& reduced) {
  const auto n = static_cast<Eigen::Index>(model.sought.size());
  Agreement all{Eigen::MatrixXd(0, n), Eigen::VectorXd(0)};
  const Eigen::VectorXd c = reduced.as_told();
  for (const RedundantRows& redundant : reduced.redundant) {
    const Eigen::Index first = all.b.size(), count = redundant.null.cols();
    all.A.conservativeResize(first + count, n);
    all.b.conservativeResize(first + count);
    all.A.bottomRows(count).setZero();
    all.b.tail(count) = redundant.null.transpose() * c(redundant.rows);
    for (Eigen::Index a = 0; a < n; ++a) {
      const int row = model.actuators[model.sought[static_cast<std::size_t>(a)]].row;
      const auto place = std::lower_bound(redundant.rows.begin(), redundant.rows.end(), row);
      if (place == redundant.rows.end() || *place != row) continue;
      const auto part = redundant.null.row(place - redundant.rows.begin());
      // (Rows of a group that have no part in a combination are there by rounding.)
      if (part.norm() >= kNoPart) all.A.col(a).tail(count) = part.transpose();
    }
  }
  return all;
}

}  // namespace sinew
