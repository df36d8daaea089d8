#include "sinew/sim/redundancy.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <set>
#include <utility>

#include "sinew/sim/row_jacobian.hpp"

namespace sinew {

namespace {

using Entry = RowJacobian::Entry;
using Row = RowJacobian::Row;

constexpr double kZero = 1e-8;  ///< singular values of scaled rows that count as zero
constexpr double kSuspect =
    1e-11;  ///< pivots of their Gram matrix that are looked at more closely (singular values squared)
constexpr double kPrivate = 1e-2;         ///< entries that make a row independent where no other row has its column
constexpr Eigen::Index kMostRows = 3000;  ///< beyond this a dense rank would take minutes: none is looked for
constexpr double kNear = 0.1;             ///< sigma_1: singular values of combinations that give way
constexpr Eigen::Index kMostNear = 200;   ///< rows of a group beyond which no singular values are looked for

double norm_of(const Row& row) {
  double sum = 0.0;
  for (const Entry& entry : row) sum += entry.value * entry.value;
  return std::sqrt(sum);
}

/// The rows that may depend on others: what is left once every row that has a column to itself is taken away, again and
/// again. Rows of length zero are left.
std::vector<std::size_t> entangled(const RowJacobian& J) {
  const std::size_t count = J.rows().size();
  std::map<int, std::vector<std::size_t>> users;
  std::vector<double> norms(count);
  for (std::size_t i = 0; i < count; ++i) {
    norms[i] = norm_of(J.of(i));
    for (const Entry& entry : J.of(i)) {
      if (std::abs(entry.value) > 1e-12 * norms[i]) users[entry.column].push_back(i);
    }
  }
  std::map<int, std::size_t> open;  // users of a column that are still there
  for (const auto& [column, rows] : users) open[column] = rows.size();
  std::vector<bool> gone(count, false);
  std::vector<std::size_t> waiting(count);
  std::iota(waiting.begin(), waiting.end(), std::size_t{0});
  while (!waiting.empty()) {
    const std::size_t i = waiting.back();
    waiting.pop_back();
    if (gone[i] || norms[i] <= kZero) continue;
    const bool own = std::any_of(J.of(i).begin(), J.of(i).end(), [&](const Entry& entry) {
      return std::abs(entry.value) > kPrivate * norms[i] && open[entry.column] == 1;
    });
    if (!own) continue;
    gone[i] = true;
    for (const Entry& entry : J.of(i)) {
      if (!(std::abs(entry.value) > 1e-12 * norms[i]) || --open[entry.column] != 1) continue;
      for (const std::size_t other : users[entry.column]) {
        if (!gone[other]) waiting.push_back(other);
      }
    }
  }
  std::vector<std::size_t> left;
  for (std::size_t i = 0; i < count; ++i) {
    if (!gone[i]) left.push_back(i);
  }
  return left;
}

/// Columns that some rows use, in their order, as rows of a dense matrix: J^T, each column over its length, or over
/// that in `norms` where it is longer; zero rows stay zero. `norms` becomes what they were divided by, or 0.
Eigen::MatrixXd dense_transposed(const RowJacobian& J, const std::vector<std::size_t>& rows, Eigen::VectorXd& norms) {
  std::map<int, Eigen::Index> place;
  for (const std::size_t i : rows) {
    for (const Entry& entry : J.of(i)) place.try_emplace(entry.column, static_cast<Eigen::Index>(place.size()));
  }
  Eigen::MatrixXd dense =
      Eigen::MatrixXd::Zero(std::max<Eigen::Index>(1, std::ssize(place)), static_cast<Eigen::Index>(rows.size()));
  norms.conservativeResizeLike(Eigen::VectorXd::Zero(dense.cols()));
  for (Eigen::Index k = 0; k < dense.cols(); ++k) {
    const Row& row = J.of(rows[static_cast<std::size_t>(k)]);
    norms[k] = std::max(norms[k], norm_of(row));
    if (!(norms[k] > kZero)) continue;
    for (const Entry& entry : row) dense(place[entry.column], k) = entry.value / norms[k];
  }
  return dense;
}

/// J^T of all rows, scaled, and what they were divided by: at least `norms`, 0 of zero rows.
struct ScaledRows {
  Eigen::VectorXd norms;
  Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr;

  explicit ScaledRows(const RowJacobian& J, Eigen::VectorXd at_least = {}) : norms(std::move(at_least)) {
    std::vector<std::size_t> all(J.rows().size());
    std::iota(all.begin(), all.end(), std::size_t{0});
    qr.compute(dense_transposed(J, all, norms));
  }
  /// Combinations of scaled rows as those of the rows as they are.
  void unscale(Eigen::MatrixXd& combinations) const {
    for (Eigen::Index i = 0; i < norms.size(); ++i) {
      if (norms[i] > kZero) combinations.row(i) /= norms[i];
    }
  }
};

/// Combinations n of scaled rows with J^T n = 0, a column each.
Eigen::MatrixXd null_space(const Eigen::ColPivHouseholderQR<Eigen::MatrixXd>& qr) {
  const Eigen::Index count = qr.cols();
  const auto& R = qr.matrixR();
  Eigen::Index rank = 0;
  while (rank < std::min(qr.rows(), count) && std::abs(R(rank, rank)) > kZero) ++rank;
  Eigen::MatrixXd null(count, count - rank);
  if (rank == count) return null;
  null.topRows(rank) = -R.topLeftCorner(rank, rank)
                            .template triangularView<Eigen::Upper>()
                            .solve(Eigen::MatrixXd(R.block(0, rank, rank, count - rank)));
  null.bottomRows(count - rank).setIdentity();
  return qr.colsPermutation() * null;
}

/// Columns at right angles that span the same.
Eigen::MatrixXd orthonormal(const Eigen::MatrixXd& columns) {
  const Eigen::HouseholderQR<Eigen::MatrixXd> qr(columns);
  return qr.householderQ() * Eigen::MatrixXd::Identity(columns.rows(), columns.cols());
}

/// Combinations n of scaled rows with J^T n small, where most of n is in `start`: a column and a singular value each,
/// as many as `start` has beside those of `null`, and at right angles to these.
struct Near {
  Eigen::MatrixXd vectors;
  std::vector<double> sigma;
};
Near nearly_null(const Eigen::ColPivHouseholderQR<Eigen::MatrixXd>& qr, const Eigen::MatrixXd& start,
                 const Eigen::MatrixXd& null) {
  const Eigen::Index count = qr.cols(), wanted = start.cols() - null.cols();
  Near near{Eigen::MatrixXd(count, 0), {}};
  if (wanted <= 0 || count > kMostNear) return near;
  const Eigen::Index rows = std::min(qr.rows(), count);
  const Eigen::MatrixXd R = qr.matrixR().topRows(rows).triangularView<Eigen::Upper>();
  Eigen::MatrixXd gram = qr.colsPermutation() * (R.transpose() * R) * qr.colsPermutation().transpose();
  if (null.cols() > 0) {  // of length 1, far from small
    const Eigen::MatrixXd own = orthonormal(null);
    gram += own * own.transpose();
  }
  // (Squares of singular values below 1e-8 are rounding; all of these give way alike.)
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> squares(gram);
  const Eigen::MatrixXd& V = squares.eigenvectors();
  std::vector<std::pair<double, Eigen::Index>> found;  // part that is not in `start`, and place
  for (Eigen::Index k = 0; k < count; ++k) {
    const double sigma = std::sqrt(std::max(0.0, squares.eigenvalues()[k]));
    const double other = 1.0 - (start.transpose() * V.col(k)).squaredNorm();
    if (sigma < kNear && other < 0.5) found.emplace_back(other, k);
  }
  std::sort(found.begin(), found.end());
  if (std::ssize(found) > wanted) found.resize(static_cast<std::size_t>(wanted));
  near.vectors.resize(count, std::ssize(found));
  for (std::size_t i = 0; i < found.size(); ++i) {
    near.vectors.col(static_cast<Eigen::Index>(i)) = V.col(found[i].second);
    near.sigma.push_back(std::sqrt(std::max(0.0, squares.eigenvalues()[found[i].second])));
  }
  return near;
}

/// Rows that hold auxiliary unknowns are in no group by themselves: one each, they are independent.
std::vector<int> told_rows(const Model& model, const State& iterate) {
  std::vector<bool> left_out(static_cast<std::size_t>(model.rows), false);
  for (const int row : rows_of_followed(model)) left_out[row] = true;
  for (std::size_t k = 0; k < model.points.size(); ++k) {
    if (iterate.points[k].on) continue;
    for (int i = 0; i < 3; ++i) left_out[model.points[k].row + i] = true;
  }
  std::vector<int> rows;
  for (int row = 0; row < model.rows; ++row) {
    if (!left_out[row]) rows.push_back(row);
  }
  return rows;
}

/// 1 of rows in metres, whose multipliers are newtons; those of angles are newton metres.
double weight_of(const Model& model, int row) {
  const double arm = arm_of(model, row);
  return 1.0 / (arm * arm);
}

/// Which rows each group of combinations ties to each other.
class Groups {
 public:
  explicit Groups(std::size_t count) : of_(count) { std::iota(of_.begin(), of_.end(), std::size_t{0}); }
  std::size_t find(std::size_t i) {
    while (of_[i] != i) i = of_[i] = of_[of_[i]];
    return i;
  }
  void join(std::size_t i, std::size_t j) { of_[find(i)] = find(j); }

 private:
  std::vector<std::size_t> of_;
};

/// Whether rows of a length-scaled Gram matrix may depend on others: a Cholesky factorisation with diagonal pivoting
/// that leaves almost nothing of them.
bool may_depend(Eigen::MatrixXd gram) {
  const Eigen::LDLT<Eigen::MatrixXd> factor(gram);
  return !(factor.vectorD().minCoeff() > kSuspect);
}

}  // namespace

double arm_of(const Model& model, int row) {
  for (const ActuatorModel& actuator : model.actuators) {
    if (actuator.row == row && actuator.turns()) return model.rods[actuator.line.rod].rod.length();
  }
  return 1.0;
}

double RedundantRows::contradiction(const Eigen::VectorXd& c) const {
  double worst = 0.0;
  for (Eigen::Index k = 0; k < null.cols(); ++k) {
    double sum = 0.0, size = 0.0;
    for (std::size_t i = 0; i < rows.size(); ++i) {
      const double n = null(static_cast<Eigen::Index>(i), k);
      sum += n * c[rows[i]];
      size += weight[static_cast<Eigen::Index>(i)] * n * n;
    }
    const double slack_of = k < exact ? 0.0 : slack[k - exact];
    if (size > 0.0) worst = std::max(worst, std::abs(sum) / std::sqrt(size) - slack_of);
  }
  return worst;
}

std::vector<int> RedundantRows::contradicting(const Eigen::VectorXd& c) const {
  std::vector<int> found;
  const Eigen::VectorXd own = c(rows);
  const Eigen::VectorXd left = null * (null.transpose() * null).ldlt().solve(null.transpose() * own);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const auto at = static_cast<Eigen::Index>(i);
    if (weight[at] > 0.0 && std::abs(left[at]) > 1e-3 * left.cwiseAbs().maxCoeff()) found.push_back(rows[i]);
  }
  return found;
}

void RedundantRows::make_smallest(const Eigen::VectorXd& lambda, Eigen::VectorXd& dlambda) const {
  if (exact == 0) return;
  const auto N = null.leftCols(exact);
  const Eigen::MatrixXd weighted = weight.asDiagonal() * N;
  const Eigen::VectorXd own = lambda(rows) + dlambda(rows);
  const Eigen::VectorXd along = (N.transpose() * weighted).ldlt().solve(weighted.transpose() * own);
  dlambda(rows) -= N * along;
}

std::vector<std::vector<int>> find_redundant_rows(const Model& model, const State& iterate,
                                                  const solve::CoupledProblem& problem) {
  std::vector<std::vector<int>> groups;
  const RowJacobian J(model, iterate, problem, told_rows(model, iterate));
  const std::vector<std::size_t> left = entangled(J);
  if (left.empty() || std::ssize(left) > kMostRows) return groups;
  Eigen::VectorXd norms;
  const Eigen::MatrixXd dense = dense_transposed(J, left, norms);
  if (norms.minCoeff() > kZero && !may_depend(dense.transpose() * dense)) return groups;
  const Eigen::MatrixXd null = null_space(Eigen::ColPivHouseholderQR<Eigen::MatrixXd>(dense));
  Groups joined(left.size());
  std::vector<bool> in_one(left.size(), false);
  for (Eigen::Index k = 0; k < null.cols(); ++k) {
    const double most = null.col(k).cwiseAbs().maxCoeff();
    std::size_t first = left.size();
    for (std::size_t i = 0; i < left.size(); ++i) {
      if (std::abs(null(static_cast<Eigen::Index>(i), k)) < 1e-6 * most) continue;
      in_one[i] = true;
      if (first == left.size()) first = i;
      joined.join(i, first);
    }
  }
  std::map<std::size_t, std::vector<int>> found;
  for (std::size_t i = 0; i < left.size(); ++i) {
    if (in_one[i]) found[joined.find(i)].push_back(J.rows()[left[i]]);
  }
  for (auto& [root, rows] : found) groups.push_back(std::move(rows));
  std::sort(groups.begin(), groups.end());
  return groups;
}

namespace {

/// What a row belongs to: "actuators.a", "couplings.3", "rods.cable".
std::string owner_of(const Model& model, int row) {
  for (const ActuatorModel& actuator : model.actuators) {
    if (actuator.row == row) return "actuators." + actuator.name;
  }
  for (const GeometricCableModel& cable : model.cables) {
    if (cable.length_row == row) return "rods." + cable.name;
  }
  for (const PointModel& point : model.points) {
    if (row >= point.row && row < point.row + 3) return "couplings." + std::to_string(point.coupling);
  }
  for (const TieModel& tie : model.ties) {
    const int last = tie.body() ? tie.body_row + (tie.directors ? 12 : 3)
                                : tie.row + static_cast<int>(tie.along.size() + tie.about.size());
    if (row >= tie.row && row < last) return "couplings." + std::to_string(tie.coupling);
  }
  return "row " + std::to_string(row);
}

/// The rods whose strains would answer.
std::set<int> rods_of(const Model& model, const std::vector<int>& rows) {
  std::set<int> rods;
  const auto in = [&rows](int first, int count) {
    return std::any_of(rows.begin(), rows.end(), [&](int row) { return row >= first && row < first + count; });
  };
  for (const ActuatorModel& actuator : model.actuators) {
    if (actuator.row >= 0 && actuator.line.rod >= 0 && in(actuator.row, 1)) rods.insert(actuator.line.rod);
  }
  for (const PointModel& point : model.points) {
    if (point.line.rod >= 0 && in(point.row, 3)) rods.insert(point.line.rod);
  }
  for (const TieModel& tie : model.ties) {
    if (!in(tie.row, static_cast<int>(tie.along.size() + tie.about.size()))) continue;
    rods.insert(tie.rod);
    if (tie.other >= 0) rods.insert(tie.other);
  }
  return rods;
}

bool has_strain(const rod::Rod& rod, int strain) {
  return std::any_of(rod.sections.begin(), rod.sections.end(), [strain](const rod::Section& section) {
    return std::any_of(section.modes.begin(), section.modes.end(),
                       [strain](const rod::Mode& mode) { return mode.strain == strain; });
  });
}

std::string listed(const std::vector<std::string>& names) {
  constexpr std::size_t kShown = 6;
  std::string text;
  for (std::size_t i = 0; i < names.size() && i < kShown; ++i) text += (i == 0 ? "" : ", ") + names[i];
  if (names.size() > kShown) text += " and " + std::to_string(names.size() - kShown) + " more";
  return text;
}

}  // namespace

RedundantRows redundant_rows(const Model& model, const State& iterate, const solve::CoupledProblem& problem,
                             const std::vector<int>& rows) {
  return redundant_rows(model, iterate, problem, RedundantGroup{rows, {}, {}, 0.0, {}});
}

RedundantRows redundant_rows(const Model& model, const State& iterate, const solve::CoupledProblem& problem,
                             const RedundantGroup& group) {
  RedundantRows own;
  const std::vector<int>& rows = group.rows;
  const RowJacobian J(model, iterate, problem, rows);
  const ScaledRows scaled_rows(J, group.norms);
  Eigen::MatrixXd null = null_space(scaled_rows.qr);
  own.exact = null.cols();
  const Near near = nearly_null(scaled_rows.qr, group.null, null);
  null.conservativeResize(null.rows(), own.exact + near.vectors.cols());
  null.rightCols(near.vectors.cols()) = near.vectors;
  if (null.cols() == 0) return own;
  scaled_rows.unscale(null);
  // What the rows take of those that hold auxiliary unknowns goes with them.
  std::map<int, Eigen::RowVectorXd> of_row;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    of_row[rows[i]] = null.row(static_cast<Eigen::Index>(i));
    for (const Entry& entry : J.substituted(i)) {
      auto [place, fresh] = of_row.try_emplace(entry.column, Eigen::RowVectorXd::Zero(null.cols()));
      place->second -= entry.value * null.row(static_cast<Eigen::Index>(i));
    }
  }
  own.null.resize(static_cast<Eigen::Index>(of_row.size()), null.cols());
  own.weight.setZero(own.null.rows());
  for (const auto& [row, values] : of_row) {
    const auto i = static_cast<Eigen::Index>(own.rows.size());
    own.null.row(i) = values;
    if (std::binary_search(rows.begin(), rows.end(), row)) own.weight[i] = weight_of(model, row);
    own.rows.push_back(row);
  }
  if (own.exact > 0 && own.exact < null.cols()) {  // give has no part in what nothing answers
    const auto N = own.null.leftCols(own.exact);
    auto rest = own.null.rightCols(null.cols() - own.exact);
    const Eigen::MatrixXd weighted = own.weight.asDiagonal() * N;
    rest -= (N * (N.transpose() * weighted).ldlt().solve(weighted.transpose() * rest)).eval();
  }
  own.give.resize(null.cols() - own.exact);
  own.slack.setZero(own.give.size());
  own.slack_of_strains.setZero(own.give.size());
  const Eigen::MatrixXd scaled = null.rightCols(own.give.size());  // combinations of the rows as they are
  for (Eigen::Index k = 0; k < null.cols(); ++k) {
    const double norm = std::sqrt(own.weight.dot(own.null.col(k).cwiseAbs2()));
    own.null.col(k) /= norm;
    if (k < own.exact) continue;
    const double sigma = near.sigma[static_cast<std::size_t>(k - own.exact)], part = sigma / kNear;
    own.give[k - own.exact] = group.give * (1.0 - part * part) * (1.0 - part * part);
    std::map<int, double> answer;  // J^T n
    for (std::size_t i = 0; i < rows.size(); ++i) {
      for (const Entry& entry : J.of(i))
        answer[entry.column] += entry.value * scaled(static_cast<Eigen::Index>(i), k - own.exact) / norm;
    }
    for (const auto& [column, value] : answer) {
      const double most = std::abs(value) * J.moved(column);
      own.slack[k - own.exact] += most;
      if (J.is_strain(column)) own.slack_of_strains[k - own.exact] += most;
    }
  }
  return own;
}

bool is_chosen(const Model& model, const std::vector<int>& rows) {
  return std::any_of(model.actuators.begin(), model.actuators.end(), [&](const ActuatorModel& own) {
    return own.sought() && own.row >= 0 && std::binary_search(rows.begin(), rows.end(), own.row);
  });
}

bool is_carried(const Model& model, const std::vector<int>& rows) {
  const auto moves = [&model](int frame) {
    return frame >= 0 && model.scene.frames[static_cast<std::size_t>(frame)].second.motion.has_value();
  };
  return std::any_of(model.ties.begin(), model.ties.end(), [&](const TieModel& tie) {
    const int last = tie.row + static_cast<int>(tie.along.size() + tie.about.size());
    const bool in = std::any_of(rows.begin(), rows.end(), [&](int row) { return row >= tie.row && row < last; });
    return in && (moves(tie.frame) || moves(model.rods[tie.rod].frame) ||
                  (tie.other >= 0 && moves(model.rods[tie.other].frame)));
  });
}

double contradiction_of(const Model& model, const RedundantGroup& group, const std::vector<double>& commands) {
  if (group.told.size() == 0) return 0.0;
  Eigen::VectorXd sum = Eigen::VectorXd::Zero(group.told.cols());
  for (std::size_t i = 0; i < model.actuators.size(); ++i) {
    const auto place = std::lower_bound(group.rows.begin(), group.rows.end(), model.actuators[i].row);
    if (model.actuators[i].row >= 0 && place != group.rows.end() && *place == model.actuators[i].row)
      sum += commands[i] * group.told.row(place - group.rows.begin()).transpose();
  }
  return sum.cwiseAbs().maxCoeff();
}

RedundantGroup redundant_group(const Model& model, const State& iterate, const solve::CoupledProblem& problem,
                               const std::vector<int>& rows) {
  RedundantGroup group{rows, {}, {}, model.size / model.bearing, {}};
  const RowJacobian J(model, iterate, problem, rows);
  const ScaledRows scaled_rows(J);
  Eigen::MatrixXd null = null_space(scaled_rows.qr);
  // (What a frame asks for as it moves cannot be told from what a posture does: nothing gives way.)
  if (null.cols() > 0 && !is_carried(model, rows)) group.null = orthonormal(null);
  scaled_rows.unscale(null);
  group.norms = (scaled_rows.norms.array() > kZero).select(scaled_rows.norms, 1.0);
  if (!is_chosen(model, rows)) group.told = null.colwise().normalized();
  double longest = 0.0;
  for (const int number : rods_of(model, rows)) {
    const rod::Rod& rod = model.rods[number].rod;
    longest = std::max(longest, rod.length() / rod::stiffness_at(rod.profile, 0.5 * rod.length())(3, 3));
  }
  if (longest > 0.0) group.give = longest;
  return group;
}

void add_compliance(const RedundantRows& redundant, double alpha, const Eigen::VectorXd& lambda,
                    solve::CoupledProblem& problem, Eigen::VectorXd& given) {
  const Eigen::MatrixXd weighted = redundant.weight.asDiagonal() * redundant.null;
  const Eigen::Index near = weighted.cols() - redundant.exact;
  const auto some = weighted.rightCols(near);
  Eigen::MatrixXd W = alpha * weighted.leftCols(redundant.exact) * weighted.leftCols(redundant.exact).transpose();
  if (near > 0) {
    W += some * redundant.give.asDiagonal() * some.transpose();
    given(redundant.rows) += some * redundant.give.cwiseProduct(some.transpose() * lambda(redundant.rows));
  }
  for (Eigen::Index i = 0; i < W.rows(); ++i) {
    if (redundant.weight[i] == 0.0) continue;
    for (Eigen::Index j = 0; j < W.cols(); ++j) {
      if (redundant.weight[j] != 0.0)
        problem.W.add(redundant.rows[static_cast<std::size_t>(i)], redundant.rows[static_cast<std::size_t>(j)],
                      W(i, j));
    }
  }
}

std::vector<std::vector<int>> join_by_rods(const Model& model, const std::vector<std::vector<int>>& groups) {
  Groups joined(groups.size());
  std::map<int, std::size_t> first_on;  // group of each rod
  for (std::size_t i = 0; i < groups.size(); ++i) {
    for (const int rod : rods_of(model, groups[i])) joined.join(i, first_on.try_emplace(rod, i).first->second);
  }
  std::map<std::size_t, std::vector<int>> found;
  for (std::size_t i = 0; i < groups.size(); ++i) {
    std::vector<int>& rows = found[joined.find(i)];
    rows.insert(rows.end(), groups[i].begin(), groups[i].end());
  }
  std::vector<std::vector<int>> all;
  for (auto& [root, rows] : found) {
    const std::set<int> rods = rods_of(model, rows);
    for (const ActuatorModel& actuator : model.actuators) {
      if (actuator.row >= 0 && rods.contains(actuator.line.rod)) rows.push_back(actuator.row);
    }
    for (const TieModel& tie : model.ties) {
      if (!rods.contains(tie.rod) && !rods.contains(tie.other)) continue;
      for (std::size_t i = 0; i < tie.along.size() + tie.about.size(); ++i)
        rows.push_back(tie.row + static_cast<int>(i));
    }
    std::sort(rows.begin(), rows.end());
    rows.erase(std::unique(rows.begin(), rows.end()), rows.end());
    all.push_back(std::move(rows));
  }
  std::sort(all.begin(), all.end());
  return all;
}

std::string name_of_rows(const Model& model, const std::vector<int>& rows) {
  std::vector<std::string> names;
  for (const int row : rows) {
    const std::string name = owner_of(model, row);
    if (std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
  }
  return listed(names);
}

std::string remedy_of_rows(const Model& model, const std::vector<int>& rows) {
  const bool actuated = std::any_of(model.actuators.begin(), model.actuators.end(), [&](const ActuatorModel& own) {
    return own.row >= 0 && std::binary_search(rows.begin(), rows.end(), own.row);
  });
  std::string strains;
  for (int strain = 0; strain < 6; ++strain) {
    if (actuated && strain > 3) break;  // shear does not make a tendon longer to speak of
    const std::set<int> rods = rods_of(model, rows);
    const bool missing =
        std::any_of(rods.begin(), rods.end(), [&](int n) { return !has_strain(model.rods[n].rod, strain); });
    if (!missing || (actuated && strain < 3)) continue;
    strains += (strains.empty() ? "`" : ", `") + std::string(rod::kStrainNames[static_cast<std::size_t>(strain)]) + "`";
  }
  std::vector<std::string> names;
  for (const int n : rods_of(model, rows)) names.push_back("rods." + model.rods[n].name);
  std::string text;
  if (!strains.empty()) text = "add " + strains + " to the strains of " + listed(names);
  const std::string also = text.empty() ? "" : ", or ";
  if (actuated) return text + also + "drive one of them by force (`tension` of a tendon) instead of a position";
  return text + also + "leave out axes that another one holds already";
}

}  // namespace sinew
