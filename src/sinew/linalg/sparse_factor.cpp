#include "sinew/linalg/sparse_factor.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

namespace sinew::linalg {

namespace {

/// Below this part of what is rounded nothing is left but rounding.
constexpr double kVanished = 1e-13;

}  // namespace

std::shared_ptr<const Fronts> SparseFactor::make_plan(const Matrix& pattern, const Rows& border) {
  return std::make_shared<const Fronts>(
      plan_fronts({static_cast<int>(pattern.cols()), pattern.outerIndexPtr(), pattern.innerIndexPtr()},
                  {static_cast<int>(border.rows()), border.outerIndexPtr(), border.innerIndexPtr()}));
}

SparseFactor::SparseFactor(std::shared_ptr<const Fronts> plan, const Kernels& kernels)
    : plan_(std::move(plan)), kernels_(&kernels) {
  panels_.assign(plan_->panels + kLanes, 0.0);
  updates_.assign(plan_->updates + kLanes, 0.0);
  diagonal_.setZero(size());
  pivots_.setZero(size());
  signs_.setOnes(size());
  largest_ = kLanes;
  for (const Front& front : plan_->fronts)
    largest_ = std::max(largest_, static_cast<std::size_t>(whole_lanes(front.rows()) + kLanes));
  minus_W_.setZero(borders() > 0 ? whole_lanes(borders()) + kLanes : 0, borders());
  own_.setZero(static_cast<Eigen::Index>(largest_));
  below_ = own_;
  whole_.setZero(size());
  bordering_.setZero(whole_lanes(borders()) + kLanes);
}

void SparseFactor::clear() { std::fill(panels_.begin(), panels_.end(), 0.0); }

SparseFactor::Matrix SparseFactor::assembled() const {
  std::vector<int> unknown(plan_->place.size());
  for (int i = 0; i < size(); ++i) unknown[plan_->place[i]] = i;
  std::vector<Eigen::Triplet<double>> entries;
  for (const Front& front : plan_->fronts) {
    const std::span<const int> below = plan_->rows_below(front);
    for (int j = 0; j < front.columns; ++j) {
      const double* column = panels_.data() + front.panel + static_cast<std::ptrdiff_t>(j) * front.stride;
      for (int i = j; i < front.rows(); ++i) {
        const int row = i < front.columns ? front.first + i : below[i - front.columns];
        const auto [a, b] = std::minmax({unknown[row], unknown[front.first + j]});
        if (column[i] != 0.0) entries.emplace_back(b, a, column[i]);
      }
    }
  }
  Matrix A(size(), size());
  A.setFromTriplets(entries.begin(), entries.end());
  return A;
}

bool SparseFactor::factor(const Matrix& A, const Rows& border) {
  if (A.cols() != size() || border.rows() != borders())
    throw std::invalid_argument("SparseFactor: a matrix of another pattern");
  clear();
  for (Eigen::Index j = 0; j < A.outerSize(); ++j) {
    for (Matrix::InnerIterator at(A, j); at; ++at)
      panels_[plan_->entry(static_cast<int>(at.row()), static_cast<int>(j))] += at.value();
  }
  for (Eigen::Index k = 0; k < border.outerSize(); ++k) {
    for (Rows::InnerIterator at(border, k); at; ++at)
      panels_[plan_->border_entry(static_cast<int>(k), static_cast<int>(at.col()))] += at.value();
  }
  return factor();
}

bool SparseFactor::factor() {
  if (size() == 0) return true;
  for (const Front& front : plan_->fronts) {
    for (int j = 0; j < front.columns; ++j)
      diagonal_[front.first + j] = std::abs(panels_[front.panel + static_cast<std::size_t>(j) * (front.stride + 1)]);
  }
  if (!factor_fronts()) return false;
  negative_ = static_cast<int>((pivots_.array() < 0.0).count());
  return pivots_.cwiseAbs().minCoeff() > kVanished * diagonal_.maxCoeff() || scaled_condition() * kVanished < 1.0;
}

bool SparseFactor::factor_fronts() {
  minus_W_.setZero();
  for (const Front& front : plan_->fronts) {
    double* panel = panels_.data() + front.panel;
    double* update = updates_.data() + front.update;
    const std::span<const int> children = plan_->children_of(front);
    const auto add = [&](const Front& own, int first, int end, double* to, int stride, int shift) {
      kernels_->add(updates_.data() + own.update, own.update_stride, first, end, plan_->runs.data() + own.first_run,
                    own.run_count, to, stride, shift);
    };
    for (const int c : children) add(plan_->fronts[c], 0, plan_->fronts[c].to_panel, panel, front.stride, 0);
    double* signs = signs_.data() + front.first;
    if (!kernels_->factor(panel, front.stride, front.columns, front.height(), pivots_.data() + front.first, signs))
      return false;
    kernels_->update(update, front.update_stride, panel + front.columns, front.stride, front.below + front.borders,
                     front.below, front.columns, signs, true);
    for (const int c : children)
      add(plan_->fronts[c], plan_->fronts[c].to_panel, plan_->fronts[c].below, update, front.update_stride,
          front.columns);
    kernels_->update(minus_W_.data() + front.border * (minus_W_.outerStride() + 1),
                     static_cast<int>(minus_W_.outerStride()), panel + front.rows(), front.stride, front.borders,
                     front.borders, front.columns, signs, false);
  }
  return true;
}

/// Largest eigenvalue of Delta^(1/2) A^-1 Delta^(1/2), Delta the diagonal: how much of a solution is rounding, which
/// goes with Delta. A slender body beside a stiff spring has pivots that are small beside the spring, and is well;
/// where a stiff and a soft part float together, what is left of the soft pivots is the rounding of the stiff ones.
double SparseFactor::scaled_condition() const {
  Eigen::VectorXd scale(size());  // by unknowns
  for (int i = 0; i < size(); ++i) scale[i] = std::sqrt(diagonal_[plan_->place[i]]);
  Eigen::VectorXd y =
      Eigen::VectorXd::NullaryExpr(size(), [](Eigen::Index i) { return std::sin(1.0 + 0.7 * static_cast<double>(i)); });
  double growth = 1.0;
  for (int i = 0; i < 3; ++i) {  // inverse iteration: the first turn finds the direction but for the square root of n
    y = scale.cwiseProduct(solve(scale.cwiseProduct(y / y.norm())));
    growth = y.norm();
  }
  return growth;
}

void SparseFactor::half_solve(const Eigen::Ref<const Eigen::VectorXd>& b, Eigen::Ref<Eigen::VectorXd> y) const {
  for (int i = 0; i < size(); ++i) y[plan_->place[i]] = b[i];
  for (const Front& front : plan_->fronts) {
    const double* panel = panels_.data() + front.panel;
    std::copy_n(&y[front.first], front.columns, own_.data());
    kernels_->solve(panel, front.stride, front.columns, own_.data());
    std::copy_n(own_.data(), front.columns, &y[front.first]);
    std::fill_n(below_.data(), whole_lanes(front.below), 0.0);
    kernels_->multiply(panel + front.columns, front.stride, front.below, front.columns, own_.data(), below_.data());
    const std::span<const int> rows = plan_->rows_below(front);
    for (std::size_t i = 0; i < rows.size(); ++i) y[rows[i]] += below_[static_cast<Eigen::Index>(i)];
  }
}

void SparseFactor::back_solve(const Eigen::Ref<const Eigen::VectorXd>& y, Eigen::Ref<Eigen::VectorXd> x) const {
  whole_ = signs_.cwiseProduct(y);
  for (auto front = plan_->fronts.rbegin(); front != plan_->fronts.rend(); ++front) {
    const double* panel = panels_.data() + front->panel;
    const std::span<const int> rows = plan_->rows_below(*front);
    for (std::size_t i = 0; i < rows.size(); ++i) below_[static_cast<Eigen::Index>(i)] = whole_[rows[i]];
    double* own = whole_.data() + front->first;
    kernels_->multiply_transposed(panel + front->columns, front->stride, front->below, front->columns, below_.data(),
                                  own);
    kernels_->solve_transposed(panel, front->stride, front->columns, own);
  }
  for (int i = 0; i < size(); ++i) x[i] = whole_[plan_->place[i]];
}

Eigen::VectorXd SparseFactor::solve(const Eigen::Ref<const Eigen::VectorXd>& b) const {
  Eigen::VectorXd y(size()), x(size());
  half_solve(b, y);
  back_solve(y, x);
  return x;
}

void SparseFactor::compliance(Eigen::MatrixXd& W) const {
  W.resize(borders(), borders());
  for (int j = 0; j < borders(); ++j) {
    for (int i = 0; i <= j; ++i) {
      const auto [column, row] = std::minmax({plan_->border[i], plan_->border[j]});
      W(j, i) = W(i, j) = -minus_W_(row, column);
    }
  }
}

void SparseFactor::border_times(const Eigen::Ref<const Eigen::VectorXd>& y, Eigen::Ref<Eigen::VectorXd> u) const {
  bordering_.setZero();
  for (const Front& front : plan_->fronts) {
    const double* border = panels_.data() + front.panel + front.rows();
    kernels_->multiply(border, front.stride, front.borders, front.columns, y.data() + front.first,
                       &bordering_[front.border]);
  }
  for (int i = 0; i < borders(); ++i) u[i] = -bordering_[plan_->border[i]];
}

void SparseFactor::add_border_transposed(const Eigen::Ref<const Eigen::VectorXd>& u,
                                         Eigen::Ref<Eigen::VectorXd> y) const {
  for (int i = 0; i < borders(); ++i) bordering_[plan_->border[i]] = -u[i];
  whole_.setZero();
  for (const Front& front : plan_->fronts) {
    const double* border = panels_.data() + front.panel + front.rows();
    kernels_->multiply_transposed(border, front.stride, front.borders, front.columns, bordering_.data() + front.border,
                                  whole_.data() + front.first);
  }
  y += signs_.cwiseProduct(whole_);
}

}  // namespace sinew::linalg
