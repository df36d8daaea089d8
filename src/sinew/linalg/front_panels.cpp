#include "sinew/linalg/front_panels.hpp"

#include <algorithm>
#include <atomic>
#include <bit>
#include <cmath>
#include <cstdint>
#include <stdexcept>
#include <type_traits>
#include <utility>

#include "sinew/threads/interruption.hpp"

namespace sinew::linalg {

template <class Real>
FrontPanels<Real>::FrontPanels(std::shared_ptr<const Fronts> plan, const KernelsOf<Real>& kernels)
    : plan_(std::move(plan)), kernels_(&kernels) {
  constexpr int kOwn = kLanesOf<Real>;
  if (plan_->precision == Precision::float64 && std::is_same_v<Real, float>)
    throw std::invalid_argument("FrontPanels: a plan for other numbers");
  panels_.assign(plan_->panels + kOwn, Real(0));
  updates_.assign(plan_->updates + kOwn, Real(0));
  diagonal_.setZero(size());
  pivots_.setZero(size());
  signs_.setOnes(size());
  int largest = kOwn;  // numbers that hold any front's unknowns
  for (const Front& front : plan_->fronts) largest = std::max(largest, whole_lanes(front.height(), kOwn) + kOwn);
  minus_W_.setZero(borders() > 0 ? whole_lanes(borders(), kOwn) + kOwn : 0, borders());
  own_.setZero(largest);
  below_ = own_;
  whole_.setZero(size());
  bordering_.setZero(whole_lanes(borders(), kOwn) + kOwn);
}

template <class Real>
bool FrontPanels<Real>::factor(const AlignedVector<double>& values, const std::vector<double>& border_values,
                               threads::Crew& crew, const HalfSolve* right) {
  values_ = values.data();
  border_values_ = border_values.data();
  return factor_fronts(crew, right);
}

template <class Real>
bool FrontPanels<Real>::factor_fronts(threads::Crew& crew, const HalfSolve* right) {
  for (Eigen::Index j = 0; j < minus_W_.cols(); ++j) minus_W_.col(j).tail(minus_W_.rows() - j).setZero();
  while (rooms_.size() < std::min(static_cast<std::size_t>(crew.size()), plan_->parts.size())) {
    Room room;
    room.updates.resize(plan_->part_updates + kLanesOf<Real>);
    room.spare = below_;
    rooms_.push_back(std::move(room));
  }
  if (right) begin(*right);
  if (crew.size() == 1) {  // updates are added while they are in the caches
    Real* const room = rooms_.empty() ? nullptr : rooms_.front().updates.data();
    for (const Front& front : plan_->fronts) {
      if (!factor_front(front, room, below_, crew, right)) return false;
    }
    if (right) end(*right);
    return true;
  }
  // No border row reaches two parts: each writes its own columns of W, and its own places of u and y.
  std::atomic<bool> ok = true;
  std::atomic<std::uint64_t> taken = 0;  // rooms, a bit each
  static_assert(threads::Crew::kMost <= 64);
  crew.each(static_cast<int>(plan_->parts.size()), [&](int i) {
    std::uint64_t before = taken, own = 0;
    do {
      own = ~before & (before + 1);  // the lowest that is free
    } while (!taken.compare_exchange_weak(before, before | own));
    Room& room = rooms_[static_cast<std::size_t>(std::countr_zero(own))];
    const Fronts::Part& part = plan_->parts[static_cast<std::size_t>(i)];
    for (int s = part.first; s < part.end && ok; ++s) {
      const Front& front = plan_->fronts[static_cast<std::size_t>(s)];
      if (!factor_front(front, room.updates.data(), room.spare, threads::Crew::none(), right)) ok = false;
    }
    taken &= ~own;
  });
  for (const int s : plan_->top) {
    threads::Interruption::check();
    const Front& front = plan_->fronts[static_cast<std::size_t>(s)];
    if (!ok || !factor_front(front, nullptr, below_, crew, right)) return false;
  }
  if (ok && right) end(*right);
  return ok;
}

/// Its entries of A, of the border and of the right side, where they belong.
template <class Real>
void FrontPanels<Real>::start_panel(const Front& front, const HalfSolve* right) {
  Real* const panel = panels_.data() + front.panel;
  const std::ptrdiff_t stride = front.stride;
  kernels_->start(panel, front.stride, front.columns, plan_->blocks.data() + front.first_block, front.block_count,
                  values_ + kBlockSize * (front.first_block + 1));
  for (int j = 0; j < front.columns; ++j)
    diagonal_[front.first + j] = static_cast<double>(std::abs(panel[j * (stride + 1)]));
  const auto* entry = plan_->border_entries.data() + front.first_border_entry;
  for (int k = 0; k < front.border_entry_count; ++k, ++entry)
    panel[entry->into] = static_cast<Real>(border_values_[entry->from]);
  for (int j = 0; right && j < front.columns; ++j)
    panel[front.right() + j * stride] = static_cast<Real>(right->y[front.first + j]);
}

/// What has become of a right side in a front: its row is (S y)^T, and -u shrinks by P_h y.
template <class Real>
void FrontPanels<Real>::take_right(const Front& front, Vector& spare, const HalfSolve& right) {
  const Real* const panel = panels_.data() + front.panel;
  for (int j = 0; j < front.columns; ++j) {
    spare[j] = signs_[front.first + j] * panel[front.right() + static_cast<std::ptrdiff_t>(j) * front.stride];
    right.y[front.first + j] = static_cast<double>(spare[j]);
  }
  if (!right.u || front.borders == 0) return;
  auto moved = spare.segment(whole_lanes(front.columns, kLanesOf<Real>), whole_lanes(front.borders, kLanesOf<Real>));
  moved.setZero();
  kernels_->multiply(panel + front.first_border(), front.stride, front.borders, front.columns, spare.data(),
                     moved.data());
  bordering_.segment(front.border, front.borders) += moved.head(front.borders);
}

template <class Real>
bool FrontPanels<Real>::factor_front(const Front& front, Real* room, Vector& spare, threads::Crew& crew,
                                     const HalfSolve* right) {
  constexpr int kColumns = 96;  // of a panel at a time
  Real* const panel = panels_.data() + front.panel;
  const int height = front.height();
  Real* signs = signs_.data() + front.first;
  start_panel(front, right);
  add_children(front, room, true, crew);
  for (int first = 0; first < front.columns; first += kColumns) {
    const int count = std::min(kColumns, front.columns - first), end = first + count;
    Real* const own = panel + static_cast<std::ptrdiff_t>(first) * (front.stride + 1);
    if (!kernels_->factor(own, front.stride, count, height - first, pivots_.data() + front.first + first,
                          signs + first))
      return false;
    if (end < front.columns)
      update(crew, panel + static_cast<std::ptrdiff_t>(end) * (front.stride + 1), front.stride, own + count,
             front.stride, height - end, front.columns - end, count, signs + first, false);
  }
  if (std::find(signs, signs + front.columns, Real(-1)) == signs + front.columns) signs = nullptr;
  update(crew, update_of(front, room), front.update_stride, panel + front.columns, front.stride,
         front.height() - front.columns, front.below, front.columns, signs, true);
  add_children(front, room, false, crew);
  kernels_->update(minus_W_.data() + front.border * (minus_W_.outerStride() + 1),
                   static_cast<int>(minus_W_.outerStride()), panel + front.first_border(), front.stride, front.borders,
                   front.borders, front.columns, signs, false);
  if (right) take_right(front, spare, *right);
  return true;
}

/// Kernels::update; much of it in strips of columns that several threads can take. By size alone: how columns go
/// together decides how sums are rounded.
template <class Real>
void FrontPanels<Real>::update(threads::Crew& crew, Real* C, int C_stride, const Real* A, int A_stride, int height,
                               int columns, int depth, const Real* signs, bool fresh) {
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
template <class Real>
void FrontPanels<Real>::add_children(const Front& front, Real* room, bool to_panel, threads::Crew& crew) {
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

// In several lanes, which do not wait for each other. Signs are 1 or -1.
template <class Real>
typename FrontPanels<Real>::Pivots FrontPanels<Real>::pivots() const {
  using Lanes = Eigen::Array<Real, kLanes, 1>;
  Lanes least = Lanes::Constant(std::numeric_limits<Real>::infinity()), signs = Lanes::Zero();
  int at = 0;
  for (; at + kLanes <= size(); at += kLanes) {
    least = least.min(Lanes::Map(pivots_.data() + at).abs());
    signs += Lanes::Map(signs_.data() + at);
  }
  double smallest = static_cast<double>(least.minCoeff()), sum = signs.template cast<double>().sum();
  for (; at < size(); ++at) {
    smallest = std::min(smallest, static_cast<double>(std::abs(pivots_[at])));
    sum += static_cast<double>(signs_[at]);
  }
  return {smallest, static_cast<int>((size() - sum) / 2.0)};
}

template <class Real>
void FrontPanels<Real>::half_solve(const HalfSolve& right) const {
  begin(right);
  for (const Front& front : plan_->fronts) eliminate(front, right);
  end(right);
}

template <class Real>
void FrontPanels<Real>::begin(const HalfSolve& right) const {
  right.y.resize(size());
  for (int i = 0; i < size(); ++i) right.y[plan_->place[i]] = right.b[i];
  bordering_.setZero();
}

/// A front's part of it: its own y, and what they leave to the rows below and to u.
template <class Real>
void FrontPanels<Real>::eliminate(const Front& front, const HalfSolve& right) const {
  auto y = right.y.segment(front.first, front.columns);
  if ((y.array() == 0.0).all()) return;  // nothing leads here
  const Real* panel = panels_.data() + front.panel;
  own_.head(front.columns) = y.template cast<Real>();
  kernels_->solve(panel, front.stride, front.columns, own_.data());
  y = own_.head(front.columns).template cast<double>();
  const int height = front.below + (right.u ? 1 + front.borders : 0);
  below_.head(whole_lanes(height, kLanesOf<Real>)).setZero();
  kernels_->multiply(panel + front.columns, front.stride, height, front.columns, own_.data(), below_.data());
  const std::span<const int> rows = plan_->rows_below(front);
  for (std::size_t i = 0; i < rows.size(); ++i)
    right.y[rows[i]] += static_cast<double>(below_[static_cast<Eigen::Index>(i)]);
  if (right.u) bordering_.segment(front.border, front.borders) += below_.segment(front.below + 1, front.borders);
}

template <class Real>
void FrontPanels<Real>::end(const HalfSolve& right) const {
  if (!right.u) return;
  right.u->resize(borders());
  for (int i = 0; i < borders(); ++i) (*right.u)[i] = -static_cast<double>(bordering_[plan_->border[i]]);
}

template <class Real>
void FrontPanels<Real>::back_solve(const Eigen::VectorXd& y, const Eigen::VectorXd* u, Eigen::VectorXd& x) const {
  whole_ = signs_.cwiseProduct(y.template cast<Real>());
  for (int i = 0; u && i < borders(); ++i) bordering_[plan_->border[i]] = static_cast<Real>(-(*u)[i]);
  for (auto front = plan_->fronts.rbegin(); front != plan_->fronts.rend(); ++front) {
    const Real* panel = panels_.data() + front->panel;
    const std::span<const int> rows = plan_->rows_below(*front);
    for (std::size_t i = 0; i < rows.size(); ++i) below_[static_cast<Eigen::Index>(i)] = whole_[rows[i]];
    if (u) {
      below_[front->below] = Real(0);  // of a right side
      below_.segment(front->below + 1, front->borders) = bordering_.segment(front->border, front->borders);
    }
    Real* own = whole_.data() + front->first;
    kernels_->multiply_transposed(panel + front->columns, front->stride, front->below + (u ? 1 + front->borders : 0),
                                  front->columns, below_.data(), own);
    kernels_->solve_transposed(panel, front->stride, front->columns, own);
  }
  x.resize(size());
  for (int i = 0; i < size(); ++i) x[i] = static_cast<double>(whole_[plan_->place[i]]);
}

template <class Real>
void FrontPanels<Real>::kept_compliance(std::span<const Run> rows, Eigen::MatrixXd& W) const {
  const Eigen::Index n = rows.empty() ? 0 : rows.back().into + rows.back().length;
  W.resize(n, n);
  const auto take = [&]<int size>(const Run& own, const Run& other) {  // size: of both, if it is known
    auto to = W.block<size, size>(other.into, own.into, other.length, own.length);
    if (own.row <= other.row) {
      to = -minus_W_.template block<size, size>(other.row, own.row, other.length, own.length).template cast<double>();
    } else {
      to = -minus_W_.template block<size, size>(own.row, other.row, own.length, other.length)
                .transpose()
                .template cast<double>();
    }
  };
  for (std::size_t at = 0; at < rows.size(); ++at) {
    for (const Run& other : rows.subspan(at)) {
      if (rows[at].length == 3 && other.length == 3) {  // of points, as most are
        take.template operator()<3>(rows[at], other);
      } else {
        take.template operator()<Eigen::Dynamic>(rows[at], other);
      }
    }
  }
}

template <class Real>
void FrontPanels<Real>::kept_column(int place, Eigen::VectorXd& column) const {
  column.resize(borders());
  column.head(place) = -minus_W_.row(place).head(place).transpose().template cast<double>();
  const Eigen::Index below = borders() - place;
  column.tail(below) = -minus_W_.col(place).segment(place, below).template cast<double>();
}

template <class Real>
void FrontPanels<Real>::border_times(const Eigen::VectorXd& y, Eigen::VectorXd& u) const {
  bordering_.setZero();
  for (const Front& front : plan_->fronts) {
    const Real* border = panels_.data() + front.panel + front.first_border();
    own_.head(front.columns) = y.segment(front.first, front.columns).template cast<Real>();
    kernels_->multiply(border, front.stride, front.borders, front.columns, own_.data(), &bordering_[front.border]);
  }
  u.resize(borders());
  for (int i = 0; i < borders(); ++i) u[i] = -static_cast<double>(bordering_[plan_->border[i]]);
}

template <class Real>
void FrontPanels<Real>::add_border_transposed(const Eigen::VectorXd& u, Eigen::VectorXd& y) const {
  for (int i = 0; i < borders(); ++i) bordering_[plan_->border[i]] = static_cast<Real>(-u[i]);
  whole_.setZero();
  for (const Front& front : plan_->fronts) {
    const Real* border = panels_.data() + front.panel + front.first_border();
    kernels_->multiply_transposed(border, front.stride, front.borders, front.columns, bordering_.data() + front.border,
                                  whole_.data() + front.first);
  }
  y += signs_.cwiseProduct(whole_).template cast<double>();
}

template class FrontPanels<float>;
template class FrontPanels<double>;

}  // namespace sinew::linalg
