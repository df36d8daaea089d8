#include "sinew/constraint/independent.hpp"

namespace sinew::constraint {

std::vector<int> independent_rows(Eigen::MatrixXd gram, double tolerance, int forced, const Eigen::VectorXd& lengths) {
  const Eigen::Index n = gram.rows();
  const Eigen::VectorXd length2 =
      lengths.size() > 0 ? Eigen::VectorXd(lengths.cwiseAbs2()) : Eigen::VectorXd(gram.diagonal());
  const auto says_something = [&](Eigen::Index i) { return gram(i, i) > tolerance * tolerance * length2[i]; };
  std::vector<bool> used(static_cast<std::size_t>(n), false);
  std::vector<int> kept;
  for (Eigen::Index step = 0; step < n; ++step) {
    Eigen::Index pivot = -1;
    if (step < forced) {
      pivot = step;
    } else {
      for (Eigen::Index i = forced; i < n; ++i) {
        if (used[static_cast<std::size_t>(i)] || !says_something(i)) continue;
        if (pivot < 0 || gram(i, i) > gram(pivot, pivot) * (1.0 + 1e-9)) pivot = i;
      }
      if (pivot < 0) break;
    }
    used[static_cast<std::size_t>(pivot)] = true;
    kept.push_back(static_cast<int>(pivot));
    if (!says_something(pivot)) continue;  // forced, but repeats others: nothing to project out
    const Eigen::VectorXd column = gram.col(pivot);
    gram -= column * column.transpose() / column[pivot];
  }
  return kept;
}

}  // namespace sinew::constraint
