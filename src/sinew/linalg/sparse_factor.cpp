#include "sinew/linalg/sparse_factor.hpp"

#include <algorithm>
#include <atomic>
#include <bit>
#include <cmath>
#include <stdexcept>
#include <utility>

namespace sinew::linalg {

namespace {

/// Below this part of what is rounded nothing is left but rounding.
constexpr double kVanished = 1e-13;

}  // namespace

std::shared_ptr<const Fronts> SparseFactor::make_plan(const Matrix& pattern, const Rows& border,
                                                      std::span<const int> slots) {
  return std::make_shared<const Fronts>(
      plan_fronts({static_cast<int>(pattern.cols()), pattern.outerIndexPtr(), pattern.innerIndexPtr()},
                  {static_cast<int>(border.rows()), border.outerIndexPtr(), border.innerIndexPtr()}, slots));
}

SparseFactor::SparseFactor(std::shared_ptr<const Fronts> plan, const Kernels& kernels)
    : plan_(std::move(plan)), kernels_(&kernels) {
  values_.assign(plan_->numbers(), 0.0);
  border_values_.assign(plan_->border_entries.size(), 0.0);
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

void SparseFactor::clear() { std::fill(values_.begin(), values_.end(), 0.0); }

SparseFactor::Matrix SparseFactor::assembled() const {
  std::vector<int> unknown(plan_->place.size());
  for (int i = 0; i < size(); ++i) unknown[plan_->place[i]] = i;
  std::vector<Eigen::Triplet<double>> entries;
  for (const Front& front : plan_->fronts) {
    const std::span<const int> below = plan_->rows_below(front);
    for (int k = 0; k < front.block_count; ++k) {
      const std::size_t number = front.first_block + static_cast<std::size_t>(k);
      const Block& block = plan_->blocks[number];
      int j = static_cast<int>(block.into) / front.stride;
      for (int c = 0; c < 3; ++c) {
        if (!(block.columns >> c & 1)) continue;
        int i = static_cast<int>(block.into) % front.stride;
        for (int r = 0; r < 3; ++r) {
          if (!(block.rows >> r & 1)) continue;
          const auto [a, b] = std::minmax(
              {unknown[i < front.columns ? front.first + i : below[i - front.columns]], unknown[front.first + j]});
          const double value = values_[kBlockSize * (number + 1) + static_cast<std::size_t>(r + 4 * c)];
          if (i >= j && value != 0.0) entries.emplace_back(b, a, value);
          ++i;
        }
        ++j;
      }
    }
  }
  Matrix A(size(), size());
  A.setFromTriplets(entries.begin(), entries.end());
  return A;
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

bool SparseFactor::factor(threads::Crew& crew) {
  if (size() == 0) return true;
  if (!factor_fronts(crew)) return false;
  negative_ = static_cast<int>((pivots_.array() < 0.0).count());
  return pivots_.cwiseAbs().minCoeff() > kVanished * diagonal_.maxCoeff() || scaled_condition() * kVanished < 1.0;
}

bool SparseFactor::factor_fronts(threads::Crew& crew) {
  minus_W_.setZero();
  while (rooms_.size() < std::min(static_cast<std::size_t>(crew.size()), plan_->parts.size()))
    rooms_.emplace_back(plan_->part_updates + kLanes);
  if (crew.size() == 1) {  // updates are added while they are in the caches
    double* const room = rooms_.empty() ? nullptr : rooms_.front().data();
    return std::all_of(plan_->fronts.begin(), plan_->fronts.end(),
                       [&](const Front& front) { return factor_front(front, room, crew); });
  }
  // No border row reaches two parts: each writes its own columns of W.
  std::atomic<bool> ok = true;
  std::atomic<unsigned> taken = 0;  // rooms, a bit each
  crew.each(static_cast<int>(plan_->parts.size()), [&](int i) {
    unsigned before = taken, own = 0;
    do {
      own = ~before & (before + 1);  // the lowest that is free
    } while (!taken.compare_exchange_weak(before, before | own));
    double* const room = rooms_[static_cast<std::size_t>(std::countr_zero(own))].data();
    const Fronts::Part& part = plan_->parts[static_cast<std::size_t>(i)];
    for (int s = part.first; s < part.end && ok; ++s) {
      if (!factor_front(plan_->fronts[static_cast<std::size_t>(s)], room, threads::Crew::none())) ok = false;
    }
    taken &= ~own;
  });
  for (const int s : plan_->top) {
    if (!ok || !factor_front(plan_->fronts[static_cast<std::size_t>(s)], nullptr, crew)) return false;
  }
  return ok;
}

/// Its entries of A and of the border, where they belong.
void SparseFactor::start_panel(const Front& front) {
  double* const panel = panels_.data() + front.panel;
  const std::ptrdiff_t stride = front.stride;
  std::fill_n(panel, stride * front.columns, 0.0);
  constexpr std::uint8_t kAll = 7;
  for (std::size_t k = front.first_block; k < front.first_block + static_cast<std::size_t>(front.block_count); ++k) {
    const Block& block = plan_->blocks[k];
    const double* from = values_.data() + kBlockSize * (k + 1);
    double* to = panel + block.into;
    if (block.rows == kAll && block.columns == kAll) {
      for (int c = 0; c < 3; ++c, from += 4, to += stride) std::copy_n(from, 3, to);
      continue;
    }
    for (int c = 0; c < 3; ++c, from += 4) {
      if (!(block.columns >> c & 1)) continue;
      double* next = to;
      for (int r = 0; r < 3; ++r) {
        if (block.rows >> r & 1) *next++ = from[r];
      }
      to += stride;
    }
  }
  for (int j = 0; j < front.columns; ++j) diagonal_[front.first + j] = std::abs(panel[j * (stride + 1)]);
  const auto* entry = plan_->border_entries.data() + front.first_border_entry;
  for (int k = 0; k < front.border_entry_count; ++k, ++entry)
    panel[entry->into] = border_values_[static_cast<std::size_t>(entry->from)];
}

bool SparseFactor::factor_front(const Front& front, double* room, threads::Crew& crew) {
  constexpr int kColumns = 96;  // of a panel at a time
  double* const panel = panels_.data() + front.panel;
  const int height = front.height();
  double* const signs = signs_.data() + front.first;
  start_panel(front);
  add_children(front, room, true, crew);
  for (int first = 0; first < front.columns; first += kColumns) {
    const int count = std::min(kColumns, front.columns - first), end = first + count;
    double* const own = panel + static_cast<std::ptrdiff_t>(first) * (front.stride + 1);
    if (!kernels_->factor(own, front.stride, count, height - first, pivots_.data() + front.first + first,
                          signs + first))
      return false;
    if (end < front.columns)
      update(crew, panel + static_cast<std::ptrdiff_t>(end) * (front.stride + 1), front.stride, own + count,
             front.stride, height - end, front.columns - end, count, signs + first, false);
  }
  update(crew, update_of(front, room), front.update_stride, panel + front.columns, front.stride,
         front.below + front.borders, front.below, front.columns, signs, true);
  add_children(front, room, false, crew);
  kernels_->update(minus_W_.data() + front.border * (minus_W_.outerStride() + 1),
                   static_cast<int>(minus_W_.outerStride()), panel + front.rows(), front.stride, front.borders,
                   front.borders, front.columns, signs, false);
  return true;
}

/// Kernels::update; much of it in strips of columns that several threads can take. By size alone: how columns go
/// together decides how sums are rounded.
void SparseFactor::update(threads::Crew& crew, double* C, int C_stride, const double* A, int A_stride, int height,
                          int columns, int depth, const double* signs, bool fresh) {
  constexpr int kStrip = 96;
  constexpr double kWorthIt = 2e6;
  if (static_cast<double>(height) * columns * depth < kWorthIt) {
    kernels_->update(C, C_stride, A, A_stride, height, columns, depth, signs, fresh);
    return;
  }
  crew.each((columns + kStrip - 1) / kStrip, [&](int i) {
    const int first = kStrip * i;
    kernels_->update(C + static_cast<std::ptrdiff_t>(first) * (C_stride + 1), C_stride, A + first, A_stride,
                     height - first, std::min(kStrip, columns - first), depth, signs, fresh);
  });
}

/// Adds the updates of a front's children to its panel, or to its own update.
void SparseFactor::add_children(const Front& front, double* room, bool to_panel, threads::Crew& crew) {
  constexpr int kStrip = 256;
  for (const int c : plan_->children_of(front)) {
    const Front& own = plan_->fronts[static_cast<std::size_t>(c)];
    const int first = to_panel ? 0 : own.to_panel, end = to_panel ? own.to_panel : own.below;
    crew.each((end - first + kStrip - 1) / kStrip, [&](int i) {
      const int from = first + kStrip * i;
      kernels_->add(update_of(own, room), own.update_stride, from, std::min(end, from + kStrip),
                    plan_->runs.data() + own.first_run, own.run_count,
                    to_panel ? panels_.data() + front.panel : update_of(front, room),
                    to_panel ? front.stride : front.update_stride, to_panel ? 0 : front.columns);
    });
  }
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
