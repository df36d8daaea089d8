#include "sinew/linalg/sparse_factor.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

namespace sinew::linalg {

namespace {

/// Below so many roundings of what is rounded nothing is left but rounding. Of what is refined later, and judged by
/// that, more may be.
constexpr double kRoundings = 450.0, kRefined = 16.0;

}  // namespace

std::shared_ptr<const Fronts> SparseFactor::make_plan(const Matrix& pattern, const Rows& border,
                                                      std::span<const int> slots, Precision precision) {
  return std::make_shared<const Fronts>(
      plan_fronts({static_cast<int>(pattern.cols()), pattern.outerIndexPtr(), pattern.innerIndexPtr()},
                  {static_cast<int>(border.rows()), border.outerIndexPtr(), border.innerIndexPtr()}, slots, precision));
}

SparseFactor::SparseFactor(std::shared_ptr<const Fronts> plan, Panels panels)
    : plan_(std::move(plan)), panels_(std::move(panels)) {
  unknown_.resize(plan_->place.size());
  for (int i = 0; i < size(); ++i) unknown_[plan_->place[i]] = i;
  values_.assign(plan_->numbers(), 0.0);
  border_values_.assign(plan_->border_entries.size(), 0.0);
}

SparseFactor::SparseFactor(std::shared_ptr<const Fronts> plan, const Kernels& kernels)
    : SparseFactor(plan, FrontPanels<double>(plan, kernels)) {}

SparseFactor::SparseFactor(std::shared_ptr<const Fronts> plan, const KernelsOf<float>& kernels)
    : SparseFactor(plan, FrontPanels<float>(plan, kernels)) {}

SparseFactor::SparseFactor(std::shared_ptr<const Fronts> plan)
    : SparseFactor(plan->precision == Precision::float64 ? SparseFactor(plan, kernels())
                                                         : SparseFactor(plan, single::kernels())) {}

void SparseFactor::clear() { std::fill(values_.begin(), values_.end(), 0.0); }

template <class Visit>
void SparseFactor::each_entry(const Visit& visit) const {
  for (const Front& front : plan_->fronts) {
    const std::span<const int> below = plan_->rows_below(front);
    const double* from = values_.data() + kBlockSize * (front.first_block + 1);
    for (int k = 0; k < front.block_count; ++k, from += kBlockSize) {
      const Block& block = plan_->blocks[front.first_block + static_cast<std::size_t>(k)];
      const int first = static_cast<int>(block.into) % front.stride;
      int j = static_cast<int>(block.into) / front.stride;
      for (int c = 0; c < 3; ++c) {
        if (!(block.columns >> c & 1)) continue;
        for (int r = 0, i = first; r < 3; ++r) {
          if (!(block.rows >> r & 1)) continue;
          if (i >= j)
            visit(unknown_[i < front.columns ? front.first + i : below[i - front.columns]], unknown_[front.first + j],
                  from[r + 4 * c]);
          ++i;
        }
        ++j;
      }
    }
  }
}

SparseFactor::Matrix SparseFactor::assembled() const {
  std::vector<Eigen::Triplet<double>> entries;
  each_entry([&](int i, int j, double value) {
    if (value != 0.0) entries.emplace_back(std::max(i, j), std::min(i, j), value);
  });
  Matrix A(size(), size());
  A.setFromTriplets(entries.begin(), entries.end());
  return A;
}

void SparseFactor::subtract_product(const Eigen::Ref<const Eigen::VectorXd>& x, Eigen::Ref<Eigen::VectorXd> r) const {
  each_entry([&](int i, int j, double value) {
    r[i] -= value * x[j];
    if (i != j) r[j] -= value * x[i];
  });
}

bool SparseFactor::factor(const Matrix& A, const Rows& border, threads::Crew& crew) {
  if (A.cols() != size() || border.rows() != borders())
    throw std::invalid_argument("SparseFactor: a matrix of another pattern");
  clear();
  for (Eigen::Index j = 0; j < A.outerSize(); ++j) {
    for (Matrix::InnerIterator at(A, j); at; ++at)
      values_[plan_->entry(static_cast<int>(at.row()), static_cast<int>(j))] += at.value();
  }
  Rows rows = border;
  rows.makeCompressed();
  if (rows.nonZeros() != static_cast<Eigen::Index>(border_values_.size()))
    throw std::invalid_argument("SparseFactor: border rows of another pattern");
  std::copy_n(rows.valuePtr(), rows.nonZeros(), border_values_.begin());
  return factor(crew);
}

bool SparseFactor::factor(threads::Crew& crew, const HalfSolve* right) {
  if (size() == 0) {
    if (right) right->y.resize(0);
    if (right && right->u) right->u->setZero(borders());
    return true;
  }
  return std::visit(
      [&](auto& panels) {
        if (!panels.factor(values_, border_values_, crew, right)) return false;
        const auto [smallest, negative] = panels.pivots();
        negative_ = negative;
        largest_diagonal_ = panels.diagonal().maxCoeff();
        const double vanished = panels.rounding() * (plan_->precision == Precision::float64 ? kRoundings : kRefined);
        return smallest > vanished * largest_diagonal_ || scaled_condition() * vanished < 1.0;
      },
      panels_);
}

const Eigen::VectorXd& SparseFactor::diagonal() const {
  return std::visit([](const auto& panels) -> const Eigen::VectorXd& { return panels.diagonal(); }, panels_);
}

Eigen::VectorXd SparseFactor::signs() const {
  return std::visit([](const auto& panels) { return panels.signs(); }, panels_);
}

/// Largest eigenvalue of Delta^(1/2) A^-1 Delta^(1/2), Delta the diagonal: how much of a solution is rounding, which
/// goes with Delta. A slender body beside a stiff spring has pivots that are small beside the spring, and is well;
/// where a stiff and a soft part float together, what is left of the soft pivots is the rounding of the stiff ones.
double SparseFactor::scaled_condition() const {
  Eigen::VectorXd scale(size());  // by unknowns
  for (int i = 0; i < size(); ++i) scale[i] = std::sqrt(diagonal()[plan_->place[i]]);
  Eigen::VectorXd y =
      Eigen::VectorXd::NullaryExpr(size(), [](Eigen::Index i) { return std::sin(1.0 + 0.7 * static_cast<double>(i)); });
  double growth = 1.0;
  for (int i = 0; i < 3; ++i) {  // inverse iteration: the first turn finds the direction but for the square root of n
    y = scale.cwiseProduct(solve(scale.cwiseProduct(y / y.norm())));
    growth = y.norm();
  }
  return growth;
}

void SparseFactor::half_solve(const Eigen::VectorXd& b, Eigen::VectorXd& y) const {
  std::visit([&](const auto& panels) { panels.half_solve({b, y}); }, panels_);
}

void SparseFactor::half_solve(const Eigen::VectorXd& b, Eigen::VectorXd& y, Eigen::VectorXd& u) const {
  std::visit([&](const auto& panels) { panels.half_solve({b, y, &u}); }, panels_);
}

std::vector<int> SparseFactor::reach(std::span<const int> unknowns) const {
  std::vector<bool> met(plan_->fronts.size(), false);
  for (const int unknown : unknowns) {
    for (auto i = static_cast<int>(&plan_->front_of(unknown) - plan_->fronts.data()); i >= 0 && !met[i];
         i = plan_->fronts[i].parent)
      met[i] = true;
  }
  std::vector<int> places;
  for (std::size_t i = 0; i < met.size(); ++i) {
    const Front& front = plan_->fronts[i];
    for (int k = 0; met[i] && k < front.columns; ++k) places.push_back(front.first + k);
  }
  return places;
}

void SparseFactor::back_solve(const Eigen::VectorXd& y, Eigen::VectorXd& x) const {
  std::visit([&](const auto& panels) { panels.back_solve(y, nullptr, x); }, panels_);
}

void SparseFactor::back_solve(const Eigen::VectorXd& y, const Eigen::VectorXd& u, Eigen::VectorXd& x) const {
  std::visit([&](const auto& panels) { panels.back_solve(y, &u, x); }, panels_);
}

void SparseFactor::kept_compliance(std::span<const Run> rows, Eigen::MatrixXd& W) const {
  std::visit([&](const auto& panels) { panels.kept_compliance(rows, W); }, panels_);
}

void SparseFactor::kept_column(int place, Eigen::VectorXd& column) const {
  std::visit([&](const auto& panels) { panels.kept_column(place, column); }, panels_);
}

Eigen::MatrixXd SparseFactor::compliance() const {
  Eigen::MatrixXd kept;
  const Run all{0, 0, borders()};
  kept_compliance({&all, 1}, kept);
  const Eigen::VectorXi at = Eigen::VectorXi::Map(plan_->border.data(), borders());
  return Eigen::MatrixXd(kept.selfadjointView<Eigen::Lower>())(at, at);
}

void SparseFactor::border_times(const Eigen::VectorXd& y, Eigen::VectorXd& u) const {
  std::visit([&](const auto& panels) { panels.border_times(y, u); }, panels_);
}

void SparseFactor::add_border_transposed(const Eigen::VectorXd& u, Eigen::VectorXd& y) const {
  std::visit([&](const auto& panels) { panels.add_border_transposed(u, y); }, panels_);
}

Eigen::VectorXd SparseFactor::solve(const Eigen::VectorXd& b) const {
  Eigen::VectorXd y, x;
  half_solve(b, y);
  back_solve(y, x);
  return x;
}

}  // namespace sinew::linalg
