#include "sinew/sim/agreement.hpp"

#include <Eigen/Dense>

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
    for (std::size_t i = 0; i < redundant.rows.size(); ++i) {
      // (Rows of a group that have no part in a combination are there by rounding.)
      if (redundant.null.row(static_cast<Eigen::Index>(i)).norm() < kNoPart) continue;
      for (Eigen::Index a = 0; a < n; ++a) {
        if (model.actuators[model.sought[static_cast<std::size_t>(a)]].row == redundant.rows[i])
          all.A.col(a).tail(count) = redundant.null.row(static_cast<Eigen::Index>(i)).transpose();
      }
    }
  }
  return all;
}

}  // namespace sinew
