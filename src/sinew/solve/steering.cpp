#include "sinew/solve/steering.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "sinew/threads/interruption.hpp"

namespace sinew::solve {

namespace {

using Mode = CoulombPiece::Mode;

/// Part of its own compliance that every increment is held by: redundant commands share what there is to do, and a
/// goal within reach is still met to about this part of the way to it.
constexpr double kProximal = 1e-9;
/// Directions that move effectors by less than this part of what others do leave a choice.
constexpr double kChoice = 1e-6;
/// Contacts this near to doing something else, in parts of the largest force, may do that as well.
constexpr double kKink = 1e-6;
constexpr double kMet = 1e-5;        ///< weighed error that does not matter
constexpr double kContacts = 1e-10;  ///< tolerance of forces at contacts
constexpr double kNearly = 1e-5;     ///< is enough where rounding, or forces that are not decided, keep it from that

/// H = J^T J, held a little.
void gauss(const Eigen::MatrixXd& J, Eigen::MatrixXd& H) {
  const Eigen::Index n = J.cols();
  H.resize(n, n);
  H.noalias() = J.transpose().lazyProduct(J);
  const double mean = H.trace() / static_cast<double>(std::max<Eigen::Index>(n, 1));
  for (Eigen::Index a = 0; a < n; ++a) H(a, a) += kProximal * (H(a, a) + 1e-6 * mean) + 1e-300;
}

double beyond(double value, double lower, double upper) { return std::max({0.0, lower - value, value - upper}); }

}  // namespace

/// Everything at p, contacts included.
void Steering::place(const SteeringProblem& problem, Point& at) {
  at.e = problem.e;
  at.e.noalias() += problem.J.lazyProduct(at.p);
  at.rows.resize(problem.A.rows());
  at.rows.noalias() = problem.A.lazyProduct(at.p);
  if (problem.held.size() == 0) return;
  contacts_.b = problem.contacts.b + problem.B * at.p;
  work_ += coulomb_.solve(contacts_, kContacts, at.lambda, kNearly).work;
  coulomb_.modes(contacts_, at.lambda, at.modes);
  const Eigen::VectorXd more = at.lambda - problem.held;
  at.e.noalias() += problem.L * more;
  at.rows.noalias() += problem.C * more;
}

double Steering::cost(const Point& at) const {
  double sum = 0.5 * at.e.squaredNorm();
  for (Eigen::Index row = 0; row < at.rows.size(); ++row)
    sum += penalty_[row] * beyond(at.rows[row], at.lower[row], at.upper[row]);
  return sum;
}

/// The best d from a point, on the piece that its modes say or, as far as that can be told without leaving it, on all.
bool Steering::piece(const SteeringProblem& problem, Point& at, Stay stay) {
  const Eigen::Index m = problem.A.rows();
  if (problem.held.size() == 0) {
    J_ = problem.J;
    A_ = problem.A;
  } else {
    contacts_.b = problem.contacts.b + problem.B * at.p;
    if (!coulomb_.follow(contacts_, at.lambda, at.modes, problem.B, S_)) return false;
    J_ = problem.J + problem.L * S_;
    A_ = problem.A + problem.C * S_;
  }
  gauss(J_, H_);
  g_.resize(J_.cols());
  g_.noalias() = J_.transpose().lazyProduct(at.e);
  lower_ = at.lower - at.rows;
  upper_ = at.upper - at.rows;
  if (problem.held.size() > 0 && stay == Stay::on_piece) {
    const Eigen::MatrixXd moved = contacts_.D * S_ + problem.B;
    const Eigen::VectorXd u = contacts_.D * at.lambda + contacts_.b;
    const auto contacts = static_cast<Eigen::Index>(at.modes.size());
    A_.conservativeResize(m + 2 * contacts, Eigen::NoChange);
    lower_.conservativeResize(m + 2 * contacts);
    upper_.conservativeResize(m + 2 * contacts);
    upper_.tail(2 * contacts).setConstant(INFINITY);
    for (Eigen::Index i = 0; i < contacts; ++i) {
      const CoulombPiece& own = at.modes[static_cast<std::size_t>(i)];
      const Eigen::Index row = m + 2 * i, k = 3 * i;
      const double mu = contacts_.mu[i];
      A_.middleRows<2>(row).setZero();
      lower_[row + 1] = -INFINITY;
      if (own.mode == Mode::open) {
        A_.row(row) = moved.row(k);
        lower_[row] = std::min(0.0, -u[k]);
        continue;
      }
      A_.row(row) = S_.row(k);
      lower_[row] = std::min(0.0, -at.lambda[k]);
      const double size = at.lambda.segment<2>(k + 1).norm();
      if (!(mu > 0.0 && size > 0.0)) continue;
      const Eigen::RowVector2d along = at.lambda.segment<2>(k + 1).transpose() / size;
      if (own.mode == Mode::sticks) {
        A_.row(row + 1) = mu * S_.row(k) - along * S_.middleRows<2>(k + 1);
        lower_[row + 1] = std::min(0.0, size - mu * at.lambda[k]);
      } else {
        A_.row(row + 1) = -along * moved.middleRows<2>(k + 1);
        lower_[row + 1] = std::min(0.0, along.dot(u.segment<2>(k + 1)));
      }
    }
  }
  using Outcome = Quadratic::Outcome;
  Outcome outcome = quadratic_.minimise(H_, g_, A_, lower_, upper_, d_);
  if (outcome == Outcome::infeasible && stay == Stay::anywhere) {
    if (!relax(problem, at)) return false;
    outcome = quadratic_.minimise(H_, g_, A_, lower_, upper_, d_);
  }
  if (outcome != Outcome::solved) return false;
  pulls_ = quadratic_.pulls().head(m);
  strength_.resize(m);
  const double strength = g_.size() > 0 ? g_.cwiseAbs().maxCoeff() : 0.0;
  for (Eigen::Index row = 0; row < m; ++row) {
    const double largest = A_.cols() > 0 ? A_.row(row).cwiseAbs().maxCoeff() : 0.0;
    strength_[row] = largest > 0.0 ? strength / largest : INFINITY;
  }
  penalty_ = penalty_.cwiseMax(2.0 * pulls_.cwiseAbs());
  promise_ = -(g_.dot(d_) + 0.5 * J_.lazyProduct(d_).squaredNorm());
  for (Eigen::Index row = 0; row < m; ++row)
    promise_ += penalty_[row] * beyond(at.rows[row], at.lower[row], at.upper[row]);
  return true;
}

/// Widens limits that exclude each other by as little as can be: those of least firmness and, only where that does not
/// help, firmer ones too. First the least t that make A d + t keep the limits, of d only as far as that leaves a choice
/// the shortest; then nothing more is asked of these than to become no worse.
bool Steering::relax(const SteeringProblem& problem, Point& at) {
  constexpr double kShort = 1e-10, kRounding = 1e-10;
  const Eigen::Index n = A_.cols(), m = problem.A.rows();
  // Limits in units of what they are, commands in units of what these limits ask of them.
  const Eigen::VectorXd& unit = problem.unit;
  Eigen::VectorXd length = Eigen::VectorXd::Zero(n), x;
  for (Eigen::Index row = 0; row < m; ++row) {
    if (!std::isfinite(lower_[row]) && !std::isfinite(upper_[row])) continue;
    const double steep = n > 0 ? A_.row(row).cwiseAbs().maxCoeff() : 0.0;
    for (Eigen::Index a = 0; a < n; ++a) {
      if (std::abs(A_(row, a)) > 1e-3 * steep) length[a] = std::max(length[a], unit[row] / std::abs(A_(row, a)));
    }
  }
  for (double& own : length) own = own > 0.0 ? own : 1.0;
  Eigen::MatrixXd H = Eigen::MatrixXd::Identity(n + m, n + m), A = Eigen::MatrixXd::Zero(m, n + m);
  H.diagonal().head(n).setConstant(kShort);
  A.leftCols(n) = A_.topRows(m) * length.asDiagonal();
  Eigen::VectorXd least = lower_.head(m), most = upper_.head(m);
  for (Eigen::Index row = 0; row < m; ++row) {
    A.row(row) /= unit[row];
    least[row] /= unit[row];
    most[row] /= unit[row];
  }
  for (double firmness = problem.firmness.minCoeff(); std::isfinite(firmness);) {
    double firmer = INFINITY;
    for (Eigen::Index row = 0; row < m; ++row) {
      A(row, n + row) = problem.firmness[row] <= firmness ? 1.0 : 0.0;
      if (problem.firmness[row] > firmness) firmer = std::min(firmer, problem.firmness[row]);
    }
    firmness = firmer;
    const Eigen::VectorXd zero = Eigen::VectorXd::Zero(n + m);
    if (quadratic_.minimise(H, zero, A, least, most, x) != Quadratic::Outcome::solved) continue;
    for (Eigen::Index row = 0; row < m; ++row) {
      if (A(row, n + row) == 0.0) continue;
      const double more = x[n + row];
      // (Limits that just meet exclude each other by rounding, which is not worth a word.)
      const double down = unit[row] * (kRounding + std::max(0.0, more)),
                   up = unit[row] * (kRounding - std::min(0.0, more));
      lower_[row] -= down;
      at.lower[row] -= down;
      upper_[row] += up;
      at.upper[row] += up;
      if (std::abs(more) > 1e-9) at.broken.push_back({static_cast<int>(row), more > 0.0 ? At::lower : At::upper});
    }
    return true;
  }
  return false;
}

/// Goes along d as far as that helps; false where it does not. Slip turns as it goes: where much less is gained than
/// was promised, half the way may gain more.
bool Steering::search(const SteeringProblem& problem, Point& at, int halvings) {
  const double before = cost(at);
  double part = 1.0, best = 0.0;
  for (int halving = 0; halving <= halvings && (halving == 0 || !cut_short()); ++halving, part *= 0.5) {
    trial_ = at;
    trial_.p += part * d_;
    if (problem.held.size() > 0) trial_.lambda += part * (S_ * d_);
    place(problem, trial_);
    const double gain = before - cost(trial_);
    if (best > 0.0 && !(gain > best)) break;
    if (!(gain >= 1e-3 * part * promise_)) continue;
    best = gain;
    std::swap(best_, trial_);
    if (gain >= 0.5 * part * promise_) break;
  }
  if (!(best > 0.0)) return false;
  std::swap(at, best_);
  return true;
}

bool Steering::descend(const SteeringProblem& problem, Point& at) {
  constexpr int kMost = 60;
  penalty_.setZero(problem.A.rows());
  place(problem, at);
  for (int turn = 0; turn < kMost && (turn == 0 || !cut_short()); ++turn) {
    threads::Interruption::check();
    if (!piece(problem, at, Stay::anywhere)) return turn > 0;
    const double size = cost(at);
    if (!(promise_ > 1e-13 * size)) return true;
    if (search(problem, at, 3)) continue;
    if (piece(problem, at, Stay::on_piece) && promise_ > 1e-12 * size && search(problem, at, 6)) continue;
    // In a kink: what contacts may do as well.
    bool better = false;
    const std::vector<CoulombPiece> modes = at.modes;
    for (std::size_t i = 0; i < modes.size() && !better && !cut_short(); ++i) {
      const CoulombPiece& own = modes[i];
      const bool opens = std::abs(own.normal) <= kKink, slips = own.mode != Mode::open &&
                                                                contacts_.mu[static_cast<Eigen::Index>(i)] > 0.0 &&
                                                                std::abs(own.tangent) <= kKink;
      if (!opens && !slips) continue;
      at.modes = modes;
      Mode& mode = at.modes[i].mode;
      if (opens) {
        mode = mode != Mode::open                                 ? Mode::open
               : contacts_.mu[static_cast<Eigen::Index>(i)] > 0.0 ? Mode::sticks
                                                                  : Mode::slips;
      } else {
        mode = mode == Mode::sticks ? Mode::slips : Mode::sticks;
      }
      better = piece(problem, at, Stay::on_piece) && promise_ > 1e-12 * size && search(problem, at, 6);
    }
    if (better) continue;
    at.modes = modes;
    return piece(problem, at, Stay::on_piece);
  }
  return true;
}

/// What has just slid as far as it did, and stays there if nothing changes, may slide on as well as stick: takes `at`
/// along the best of sliding on.
bool Steering::slide(const SteeringProblem& problem, Point& at) {
  penalty_.setZero(problem.A.rows());
  place(problem, at);
  bool any = false;
  for (CoulombPiece& own : at.modes) {
    if (own.mode != Mode::sticks || own.tangent > kKink) continue;
    own.mode = Mode::slips;
    any = true;
  }
  return any && piece(problem, at, Stay::anywhere) && search(problem, at, 3);
}

/// Branch and bound over which contacts are open and which closed, without friction, of the nearest dozen. Takes `at`
/// to the best there is, and returns what that leaves; no more is known where contacts were left out or there is none.
std::optional<double> Steering::bound(const SteeringProblem& problem, Point& at) {
  constexpr std::size_t kMostContacts = 12, kMostNodes = 2000;
  const Eigen::Index n = problem.J.cols(), m = problem.A.rows();
  const int all = problem.contacts.contacts();
  std::vector<int> near(static_cast<std::size_t>(all));
  for (int i = 0; i < all; ++i) near[static_cast<std::size_t>(i)] = i;
  const auto gap = [&](int i) { return problem.contacts.b[3 * i] / std::max(problem.B.row(3 * i).norm(), 1e-300); };
  std::stable_sort(near.begin(), near.end(), [&](int i, int j) { return gap(i) < gap(j); });
  if (near.size() > kMostContacts) near.resize(kMostContacts);
  const auto k = static_cast<Eigen::Index>(near.size());
  // x = (p, forces in units that move their contact as far as commands do).
  Eigen::VectorXd unit(k), held = -problem.L * problem.held, rows = -problem.C * problem.held;
  Eigen::MatrixXd J(problem.J.rows(), n + k), A(m + 2 * k, n + k);
  A.setZero();
  J.leftCols(n) = problem.J;
  A.topLeftCorner(m, n) = problem.A;
  Eigen::VectorXd lower(m + 2 * k), upper = Eigen::VectorXd::Constant(m + 2 * k, INFINITY);
  for (Eigen::Index i = 0; i < k; ++i) {
    const Eigen::Index own = 3 * near[static_cast<std::size_t>(i)];
    unit[i] = problem.B.row(own).norm() / problem.contacts.D(own, own);
    if (!(unit[i] > 0.0 && std::isfinite(unit[i]))) return {};
  }
  for (Eigen::Index i = 0; i < k; ++i) {
    const Eigen::Index own = 3 * near[static_cast<std::size_t>(i)];
    J.col(n + i) = unit[i] * problem.L.col(own);
    A.col(n + i).head(m) = unit[i] * problem.C.col(own);
    A.row(m + 2 * i).head(n) = problem.B.row(own);
    for (Eigen::Index j = 0; j < k; ++j)
      A(m + 2 * i, n + j) = unit[j] * problem.contacts.D(own, 3 * near[static_cast<std::size_t>(j)]);
    A(m + 2 * i + 1, n + i) = 1.0;
    lower[m + 2 * i] = -problem.contacts.b[own];
    lower[m + 2 * i + 1] = 0.0;
  }
  lower.head(m) = problem.lower - rows;
  upper.head(m) = problem.upper - rows;
  const Eigen::VectorXd e = problem.e + held;
  Eigen::MatrixXd H;
  gauss(J, H);
  const Eigen::VectorXd g = J.transpose() * e;
  struct Node {
    std::vector<Mode> modes;  ///< sticks: not decided
    double least = -INFINITY;
  };
  std::vector<Node> open = {{std::vector<Mode>(near.size(), Mode::sticks), -INFINITY}};
  double best = INFINITY;
  Eigen::VectorXd x, found;
  std::size_t nodes = 0;
  const double size = 0.5 * e.squaredNorm();
  while (!open.empty() && nodes < kMostNodes) {
    threads::Interruption::check();
    const Node node = std::move(open.back());
    open.pop_back();
    if (node.least >= best) continue;
    ++nodes;
    Eigen::VectorXd own_upper = upper;
    for (Eigen::Index i = 0; i < k; ++i) {
      const Mode mode = node.modes[static_cast<std::size_t>(i)];
      if (mode == Mode::open) own_upper[m + 2 * i + 1] = 0.0;
      if (mode == Mode::slips) own_upper[m + 2 * i] = lower[m + 2 * i];
    }
    if (quadratic_.minimise(H, g, A, lower, own_upper, x) != Quadratic::Outcome::solved) continue;
    const double value = 0.5 * (e + J * x).squaredNorm();
    if (!(value < best - 1e-9 * size)) continue;
    Eigen::Index undecided = -1;
    double worst = 1e-9;
    for (Eigen::Index i = 0; i < k; ++i) {
      if (node.modes[static_cast<std::size_t>(i)] != Mode::sticks) continue;
      const double away = A.row(m + 2 * i).dot(x) - lower[m + 2 * i], scale = A.row(m + 2 * i).norm();
      const double both = std::min(x[n + i], away / scale);
      if (!(both > worst * x.norm())) continue;
      worst = both / x.norm();
      undecided = i;
    }
    if (undecided < 0) {
      best = value;
      found = x;
      continue;
    }
    // The likelier one is looked at first: the last in.
    const double away = A.row(m + 2 * undecided).dot(x) - lower[m + 2 * undecided];
    const bool closed_first = x[n + undecided] > away / A.row(m + 2 * undecided).norm();
    for (const bool closed : {!closed_first, closed_first}) {
      open.push_back({node.modes, value});
      open.back().modes[static_cast<std::size_t>(undecided)] = closed ? Mode::slips : Mode::open;
    }
  }
  if (found.size() == 0) return {};
  at.p = found.head(n);
  at.lambda.setZero();
  for (Eigen::Index i = 0; i < k; ++i) at.lambda[3 * near[static_cast<std::size_t>(i)]] = unit[i] * found[n + i];
  if (!open.empty() || static_cast<std::size_t>(all) != near.size()) return {};
  return best;
}

/// Among p that do the same for the effectors, those whose first rows are nearest to what is wished.
void Steering::prefer(const SteeringProblem& problem) {
  const Eigen::Index n = J_.cols(), m = A_.rows();
  if (n == 1 && J_.squaredNorm() > 0.0) return;
  unit_.resize(n);
  for (Eigen::Index a = 0; a < n; ++a) unit_[a] = 1.0 / std::max(J_.col(a).norm(), 1e-300);
  scaled_.resize(J_.rows(), n);
  scaled_.noalias() = J_ * unit_.asDiagonal();
  if (!scaled_.allFinite()) return;
  svd_.compute(scaled_, Eigen::ComputeFullV);
  Eigen::Index rank = 0;
  while (rank < svd_.singularValues().size() && svd_.singularValues()[rank] > kChoice * svd_.singularValues()[0])
    ++rank;
  if (rank == n) return;
  kept_.resize(m + rank, n);
  kept_.topRows(m) = A_;
  kept_.bottomRows(rank) = svd_.matrixV().leftCols(rank).transpose() * unit_.cwiseInverse().asDiagonal();
  kept_lower_.setZero(m + rank);
  kept_upper_.setZero(m + rank);
  // From the point as it is (A_ and limits are told from there), within what rounding has left of limits.
  kept_lower_.head(m) = lower_.cwiseMin(0.0);
  kept_upper_.head(m) = upper_.cwiseMax(0.0);
  const auto F = A_.topRows(problem.wish.size());
  H_.noalias() = F.transpose().lazyProduct(F);
  H_.diagonal() *= 1.0 + kProximal;
  unit_ = here_.rows.head(problem.wish.size()) - problem.wish;
  g_.noalias() = F.transpose().lazyProduct(unit_);
  if (quadratic_.minimise(H_, g_, kept_, kept_lower_, kept_upper_, d_) != Quadratic::Outcome::solved) return;
  const double enough = cost(here_) + 1e-9 * 0.5 * problem.e.squaredNorm() + 0.5 * kMet * kMet;
  there_ = here_;
  there_.p += d_;
  place(problem, there_);
  if (problem.held.size() > 0) {
    // Where contacts turn their forces on the way, effectors are led back, if that way with it.
    const Eigen::VectorXd whole = d_;
    double part = 1.0;
    for (int halving = 0; halving < 4 && !(cost(there_) <= enough); ++halving, part *= 0.5) {
      there_ = here_;
      there_.p += part * whole;
      if (!descend(problem, there_)) return;
    }
  }
  if (cost(there_) <= enough) std::swap(here_, there_);
}

bool Steering::solve(const SteeringProblem& problem) {
  const bool touches = problem.held.size() > 0;
  here_.p.setZero(problem.J.cols());
  here_.lambda = problem.held;
  here_.lower = problem.lower;
  here_.upper = problem.upper;
  here_.broken.clear();
  here_.modes.clear();
  work_ = 0.0;
  certain_ = !touches;
  if (!touches) {
    penalty_.setZero(problem.A.rows());
    place(problem, here_);
    if (!piece(problem, here_, Stay::anywhere)) return false;
    here_.p = d_;
    place(problem, here_);
    lower_ = here_.lower - here_.rows;
    upper_ = here_.upper - here_.rows;
    prefer(problem);
    return here_.p.allFinite();
  }
  contacts_ = problem.contacts;
  coulomb_.begin();
  const Point start = here_;
  if (!descend(problem, here_)) return false;
  const auto try_from_there = [&] {
    const Eigen::VectorXd before = penalty_;
    // (From where it started, and from its end, it has been looked.)
    if (there_.p == here_.p || there_.p == start.p || !descend(problem, there_)) return;
    penalty_ = penalty_.cwiseMax(before);
    if (cost(there_) < cost(here_) * (1.0 - 1e-9)) std::swap(here_, there_);
  };
  if (cut_short()) return here_.p.allFinite() && here_.lambda.allFinite();
  there_ = start;
  if (slide(problem, there_)) try_from_there();
  there_ = start;
  const std::optional<double> best = bound(problem, there_);
  try_from_there();
  certain_ = best && problem.contacts.mu.isZero(0.0) &&
             0.5 * here_.e.squaredNorm() <= *best + 1e-6 * 0.5 * problem.e.squaredNorm();
  if (!piece(problem, here_, Stay::on_piece)) return here_.p.allFinite();
  const Eigen::VectorXd pulls = pulls_, strength = strength_;
  prefer(problem);
  pulls_ = pulls;  // what is in the way of effectors, not of the wish
  strength_ = strength;
  return here_.p.allFinite() && here_.lambda.allFinite();
}

const Eigen::MatrixXd& Steering::reaction(const SteeringProblem& problem) {
  here_.lambda = problem.held;
  contacts_ = problem.contacts;
  coulomb_.modes(contacts_, here_.lambda, here_.modes);
  if (!coulomb_.follow(contacts_, here_.lambda, here_.modes, problem.B, S_))
    S_.setConstant(problem.held.size(), problem.B.cols(), NAN);
  return S_;
}

}  // namespace sinew::solve
