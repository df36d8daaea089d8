#include "sinew/solve/coulomb.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <iterator>

#include "sinew/threads/interruption.hpp"

namespace sinew::solve {

using Eigen::Vector2d;

namespace {

/// What turns displacements of a contact into forces: the stiffness that it feels by itself.
struct Stiffness {
  double normal = 0.0, tangent = 0.0;  ///< [N/m]
};
Stiffness stiffness(const CoulombProblem& problem, int contact) {
  const OwnCompliance own = own_compliance(problem, contact);
  return {1.0 / std::max(own.normal, 1e-300), 1.0 / std::max(own.tangent, 1e-300)};
}

/// Whether some forces move contacts against themselves, as where bodies would buckle but for their contacts.
bool indefinite(const CoulombProblem& problem) {
  const auto diagonal = problem.D.diagonal();
  if (diagonal.minCoeff() < 0.0) return true;
  Eigen::MatrixXd shifted = problem.D;
  shifted.diagonal().array() += 1e-9 * diagonal.maxCoeff();
  return Eigen::LLT<Eigen::Ref<Eigen::MatrixXd>>(shifted).info() != Eigen::Success;
}

/// The nearest point of a disk.
Vector2d onto_disk(const Vector2d& t, double radius) {
  const double r = t.norm();
  return r <= radius ? t : Vector2d(t * (radius / r));
}

}  // namespace

OwnCompliance own_compliance(const CoulombProblem& problem, int contact) {
  const auto d = problem.D.diagonal().segment<3>(3 * contact);
  return {std::abs(d[0]), 0.5 * (std::abs(d[1]) + std::abs(d[2]))};
}

double CoulombResidual::largest() const { return std::max({complementarity, cone, dissipation}); }

namespace {

/// The largest force there is, b / D_ii included.
double largest_force(const CoulombProblem& problem, const Eigen::VectorXd& lambda) {
  double largest = 0.0;
  for (int i = 0; i < problem.contacts(); ++i) {
    const auto k = 3 * i;
    const auto [normal, tangent] = stiffness(problem, i);
    largest = std::max({largest, lambda.segment<3>(k).norm(), normal * std::abs(problem.b[k]),
                        tangent * problem.mu[i] * problem.b.segment<2>(k + 1).norm()});
  }
  return largest;
}

}  // namespace

CoulombResidual residual(const CoulombProblem& problem, const Eigen::VectorXd& lambda) {
  CoulombResidual left;
  const Eigen::VectorXd u = problem.D * lambda + problem.b;
  const double largest = largest_force(problem, lambda);
  if (!u.allFinite() || !std::isfinite(largest)) return {INFINITY, INFINITY, INFINITY};
  for (int i = 0; i < problem.contacts(); ++i) {
    const auto k = 3 * i;
    const Stiffness own = stiffness(problem, i);
    const double n = lambda[k], mu = problem.mu[i];
    const Vector2d t = lambda.segment<2>(k + 1);
    left.complementarity = std::max(left.complementarity, std::abs(std::min(n, own.normal * u[k])));
    const double radius = mu * std::max(n, 0.0);
    left.cone = std::max(left.cone, t.norm() - radius);
    const Vector2d off = t - onto_disk(t - own.tangent * u.segment<2>(k + 1), radius);
    left.dissipation = std::max(left.dissipation, off.norm());
  }
  if (!(largest > 0.0)) return left;
  left.complementarity /= largest;
  left.cone /= largest;
  left.dissipation /= largest;
  return left;
}

namespace {

/// Slip at one contact: u_n = 0 and lambda = lambda_n (1, -mu d) with u_t = a d, a >= 0, d a direction. The direction
/// is a root of the cross product of d and u_t over the circle.
struct Slip {
  const Eigen::Matrix3d& D;
  const Eigen::Vector3d& b;
  double mu;

  struct At {
    double normal = 0.0;  ///< force
    double cross = 0.0, along = 0.0;
    bool possible = false;
  };
  At at(double angle) const {
    const Vector2d d(std::cos(angle), std::sin(angle));
    const Eigen::Vector3d w(1.0, -mu * d.x(), -mu * d.y());
    const Eigen::Vector3d Dw = D * w;
    At own;
    if (!(Dw[0] > 0.0)) return own;
    own.normal = -b[0] / Dw[0];
    const Vector2d slip = own.normal * Dw.tail<2>() + b.tail<2>();
    own.cross = d.x() * slip.y() - d.y() * slip.x();
    own.along = d.dot(slip);
    own.possible = own.normal >= 0.0;
    return own;
  }
};

}  // namespace

bool solve_one(const Eigen::Matrix3d& D, const Eigen::Vector3d& b, double mu, Eigen::Ref<Eigen::Vector3d> lambda) {
  if (b[0] >= 0.0) {
    lambda.setZero();
    return true;
  }
  if (mu == 0.0) {
    const double force = -b[0] / D(0, 0);
    if (!std::isfinite(force)) return false;
    lambda = Eigen::Vector3d(force, 0.0, 0.0);
    return true;
  }
  const Eigen::LDLT<Eigen::Matrix3d> factor(D);
  if (factor.info() == Eigen::Success) {
    const Eigen::Vector3d stick = factor.solve(-b);
    const bool holds = (D * stick + b).norm() <= 1e-12 * b.norm();
    if (holds && stick[0] >= 0.0 && stick.tail<2>().norm() <= mu * stick[0]) {
      lambda = stick;
      return true;
    }
  }
  const Slip slip{D, b, mu};
  constexpr int kAngles = 24;
  const double step = 2.0 * M_PI / kAngles, first = std::atan2(b[2], b[1]) - 0.5 * step;
  Slip::At before = slip.at(first);
  for (int i = 1; i <= kAngles; ++i) {
    double low = first + (i - 1) * step, high = first + i * step;
    const Slip::At after = slip.at(high);
    Slip::At left = before;
    before = after;
    if (!left.possible || !after.possible || (left.cross > 0.0) == (after.cross > 0.0)) continue;
    // Illinois' regula falsi.
    double f_low = left.cross, f_high = after.cross, angle = low;
    Slip::At found = left;
    for (int turn = 0; turn < 100 && high - low > 1e-15 * (1.0 + std::abs(low)); ++turn) {
      angle = low + (high - low) * std::clamp(f_low / (f_low - f_high), 1e-3, 1.0 - 1e-3);
      found = slip.at(angle);
      if (found.cross == 0.0) break;
      if ((found.cross > 0.0) == (f_low > 0.0)) {
        low = angle;
        f_low = found.cross;
        f_high *= 0.5;
      } else {
        high = angle;
        f_high = found.cross;
        f_low *= 0.5;
      }
    }
    if (!found.possible || found.along < 0.0) continue;
    lambda = found.normal * Eigen::Vector3d(1.0, -mu * std::cos(angle), -mu * std::sin(angle));
    return true;
  }
  return false;
}

void sweep(const CoulombProblem& problem, Eigen::VectorXd& lambda) {
  for (int i = 0; i < problem.contacts(); ++i) {
    const auto k = 3 * i;
    const Eigen::Matrix3d D = problem.D.block<3, 3>(k, k);
    const Eigen::Vector3d own = lambda.segment<3>(k);
    const Eigen::Vector3d b = problem.D.middleCols<3>(k).transpose() * lambda + problem.b.segment<3>(k) - D * own;
    solve_one(D, b, problem.mu[i], lambda.segment<3>(k));
  }
}

// Alart's and Curnier's function: F_n = lambda_n - max(0, lambda_n - rho_n u_n), F_t = lambda_t - (lambda_t - rho_t u_t
// brought to the disk of radius mu max(0, lambda_n - rho_n u_n)). Here u is that of contacts that yield by `yield_` /
// rho from where their forces were (a proximal point): forces that rigid bodies leave undecided stay near these.
double Coulomb::evaluate(const CoulombProblem& problem, const Eigen::VectorXd& lambda) {
  u_.noalias() = problem.D * lambda;
  u_ += problem.b;
  work_ += static_cast<double>(problem.D.size());
  F_.resize(lambda.size());
  for (int i = 0; i < problem.contacts(); ++i) {
    const auto k = 3 * i;
    u_[k] += yield_ / scale_n_[i] * (lambda[k] - held_[k]);
    u_.segment<2>(k + 1) += yield_ / scale_t_[i] * (lambda - held_).segment<2>(k + 1);
    const double pushed = std::max(0.0, lambda[k] - scale_n_[i] * u_[k]);
    F_[k] = lambda[k] - pushed;
    const Vector2d t = lambda.segment<2>(k + 1);
    F_.segment<2>(k + 1) = t - onto_disk(t - scale_t_[i] * u_.segment<2>(k + 1), problem.mu[i] * pushed);
  }
  return F_.squaredNorm();
}

/// Where Alart's and Curnier's function looks for the force along the tangents.
Vector2d Coulomb::aim(const Eigen::VectorXd& lambda, int contact) const {
  return lambda.segment<2>(3 * contact + 1) - scale_t_[contact] * u_.segment<2>(3 * contact + 1);
}

/// Of the disk there.
double Coulomb::radius(const CoulombProblem& problem, const Eigen::VectorXd& lambda, int contact) const {
  return problem.mu[contact] * (lambda[3 * contact] - scale_n_[contact] * u_[3 * contact]);
}

/// A = dF/dlambda and B = dF/du of one contact that is pressed.
void Coulomb::derive(const CoulombProblem& problem, const Eigen::VectorXd& lambda, int contact, bool sticks,
                     Eigen::Matrix3d& A, Eigen::Matrix3d& B) const {
  const double mu = problem.mu[contact], rho = scale_t_[contact];
  const Vector2d tau = aim(lambda, contact);
  const double r = tau.norm();
  A.setZero();
  B.setZero();
  B(0, 0) = scale_n_[contact];
  if (sticks) {
    B(1, 1) = B(2, 2) = rho;
    return;
  }
  const Vector2d d = r > 0.0 ? Vector2d(tau / r) : Vector2d(Vector2d::Zero());
  const double part = r > 0.0 ? radius(problem, lambda, contact) / r : 0.0;
  const Eigen::Matrix2d across = part * (Eigen::Matrix2d::Identity() - d * d.transpose());
  A.bottomRightCorner<2, 2>() = Eigen::Matrix2d::Identity() - across;
  A.bottomLeftCorner<2, 1>() = -mu * d;
  B.bottomRightCorner<2, 2>() = rho * across;
  B.bottomLeftCorner<2, 1>() = mu * scale_n_[contact] * d;
}

bool Coulomb::step(const CoulombProblem& problem, const Eigen::VectorXd& lambda, bool chord) {
  active_.clear();
  step_ = -F_;  // of open contacts: their force goes
  lost_ = step_;
  for (int i = 0; i < problem.contacts(); ++i) {
    if (!(lambda[3 * i] - scale_n_[i] * u_[3 * i] > 0.0)) continue;
    active_.push_back(i);
    lost_.segment<3>(3 * i).setZero();
  }
  if (chord && active_ != factored_) return false;
  if (active_.empty()) return true;
  const auto n = static_cast<Eigen::Index>(3 * active_.size());
  if (!chord) J_.resize(n, n);
  right_.resize(n);
  const Eigen::VectorXd moved = problem.D * lost_;
  for (std::size_t a = 0; a < active_.size(); ++a) {
    const int i = active_[a];
    const auto k = 3 * i, row = 3 * static_cast<int>(a);
    Eigen::Matrix3d A, B;
    derive(problem, lambda, i, aim(lambda, i).norm() <= radius(problem, lambda, i), A, B);
    right_.segment<3>(row) = -F_.segment<3>(k) - B * moved.segment<3>(k);
    if (chord) continue;
    for (std::size_t c = 0; c < active_.size(); ++c)
      J_.block<3, 3>(row, 3 * static_cast<int>(c)).noalias() = B * problem.D.block<3, 3>(k, 3 * active_[c]);
    const Eigen::Vector3d yields(yield_ / scale_n_[i], yield_ / scale_t_[i], yield_ / scale_t_[i]);
    J_.block<3, 3>(row, row) += A + B * yields.asDiagonal();
  }
  if (!chord) {
    work_ += std::pow(static_cast<double>(n), 3) / 3.0;
    factor_.compute(J_);
    factored_ = active_;
  }
  right_ = factor_.solve(right_).eval();
  if (!right_.allFinite()) return false;
  for (std::size_t a = 0; a < active_.size(); ++a)
    step_.segment<3>(3 * active_[a]) = right_.segment<3>(static_cast<Eigen::Index>(3 * a));
  return true;
}

bool Coulomb::newton(const CoulombProblem& problem, double tolerance, Eigen::VectorXd& lambda, int& steps) {
  constexpr int kMost = 40, kHalvings = 8;
  constexpr double kChord = 1e-2;  // of the squares of F
  held_ = lambda;
  double merit = evaluate(problem, lambda);
  int worse = 0;
  for (int turn = 0; turn < kMost && work_ <= kMostWork;) {
    threads::Interruption::check();
    const double largest = std::max(lambda.lpNorm<Eigen::Infinity>(), 1e-300);
    if (F_.lpNorm<Eigen::Infinity>() <= 0.1 * tolerance * largest) {
      if (residual(problem, lambda).largest() <= tolerance) return true;
      held_ = lambda;
      merit = evaluate(problem, lambda);
      ++turn;
    }
    // Steps with the factors of an earlier one, while each is a large gain, are cheap and do not count.
    if (step(problem, lambda, true)) {
      trial_ = lambda + step_;
      const double next = evaluate(problem, trial_);
      if (next < kChord * merit) {
        lambda = trial_;
        merit = next;
        continue;
      }
      evaluate(problem, lambda);
    }
    ++turn;
    ++steps;
    if (!step(problem, lambda, false)) return false;
    double part = 1.0;
    trial_ = lambda + step_;
    double next = evaluate(problem, trial_);
    for (int halving = 0; halving < kHalvings && !(next < merit); ++halving) {
      part *= 0.5;
      trial_ = lambda + part * step_;
      next = evaluate(problem, trial_);
    }
    if (!(next < merit) && ++worse > 3) return false;
    lambda = trial_;
    merit = next;
  }
  return false;
}

void Coulomb::measure(const CoulombProblem& problem) {
  const int n = problem.contacts();
  scale_n_.resize(n);
  scale_t_.resize(n);
  for (int i = 0; i < n; ++i) {
    const Stiffness own = stiffness(problem, i);
    scale_n_[i] = own.normal;
    scale_t_[i] = own.tangent;
  }
}

void Coulomb::modes(const CoulombProblem& problem, const Eigen::VectorXd& lambda, std::vector<CoulombPiece>& modes) {
  measure(problem);
  yield_ = 0.0;
  held_ = lambda;
  evaluate(problem, lambda);
  modes.resize(static_cast<std::size_t>(problem.contacts()));
  double largest = 1e-300;
  for (int i = 0; i < problem.contacts(); ++i)
    largest = std::max({largest, lambda.segment<3>(3 * i).norm(), scale_n_[i] * std::abs(problem.b[3 * i])});
  for (int i = 0; i < problem.contacts(); ++i) {
    CoulombPiece& own = modes[static_cast<std::size_t>(i)];
    own.normal = (lambda[3 * i] - scale_n_[i] * u_[3 * i]) / largest;
    own.tangent = (radius(problem, lambda, i) - aim(lambda, i).norm()) / largest;
    own.mode = !(own.normal > 0.0)                           ? CoulombPiece::Mode::open
               : problem.mu[i] > 0.0 && !(own.tangent < 0.0) ? CoulombPiece::Mode::sticks
                                                             : CoulombPiece::Mode::slips;
  }
}

bool Coulomb::follow(const CoulombProblem& problem, const Eigen::VectorXd& lambda,
                     const std::vector<CoulombPiece>& modes, const Eigen::MatrixXd& B, Eigen::MatrixXd& S) {
  constexpr double kYields = 1e-10;
  S.setZero(lambda.size(), B.cols());
  active_.clear();
  for (int i = 0; i < problem.contacts(); ++i) {
    if (modes[static_cast<std::size_t>(i)].mode != CoulombPiece::Mode::open) active_.push_back(i);
  }
  if (active_.empty()) return true;
  measure(problem);
  yield_ = 0.0;
  held_ = lambda;
  evaluate(problem, lambda);
  const auto n = static_cast<Eigen::Index>(3 * active_.size());
  J_.resize(n, n);
  sides_.resize(n, B.cols());
  for (std::size_t a = 0; a < active_.size(); ++a) {
    const int i = active_[a], row = 3 * static_cast<int>(a);
    Eigen::Matrix3d own_force, own_motion;
    derive(problem, lambda, i, modes[static_cast<std::size_t>(i)].mode == CoulombPiece::Mode::sticks, own_force,
           own_motion);
    for (std::size_t c = 0; c < active_.size(); ++c)
      J_.block<3, 3>(row, 3 * static_cast<int>(c)).noalias() =
          own_motion * problem.D.block<3, 3>(3 * i, 3 * active_[c]);
    const Eigen::Vector3d yields(kYields / scale_n_[i], kYields / scale_t_[i], kYields / scale_t_[i]);
    J_.block<3, 3>(row, row) += own_force + own_motion * yields.asDiagonal();
    sides_.middleRows<3>(row).noalias() = -own_motion * B.middleRows<3>(3 * i);
  }
  const Eigen::PartialPivLU<Eigen::Ref<Eigen::MatrixXd>> lu(J_);
  sides_ = lu.solve(sides_).eval();
  if (!sides_.allFinite()) return false;
  for (std::size_t a = 0; a < active_.size(); ++a)
    S.middleRows<3>(3 * active_[a]) = sides_.middleRows<3>(static_cast<Eigen::Index>(3 * a));
  return true;
}

CoulombReport Coulomb::solve(const CoulombProblem& problem, double tolerance, Eigen::VectorXd& lambda, double nearly) {
  CoulombReport report;
  measure(problem);
  work_ = 0.0;
  best_ = lambda;
  report.residual = residual(problem, lambda);
  const auto keep = [&] {
    const CoulombResidual now = residual(problem, lambda);
    if (now.largest() < report.residual.largest()) {
      report.residual = now;
      best_ = lambda;
    }
    return report.residual.largest() <= tolerance;
  };
  // How far forces may yield in a turn of Newton, measured: stiff solids, whose own compliance is small beside that of
  // their motion as a whole, want little, piles of rigid bodies, whose forces are not decided, more.
  constexpr double kYields[] = {1e-5, 1e-6, 1e-4, 1e-7, 1e-3, 1e-8, 1e-2, 1e-5};
  constexpr int kIdle = 2;
  constexpr double kMostGrowth = 1e6;  // of forces in sweeps
  int sweeps = 4, idle = 0;
  double bound = INFINITY;
  report.solved = report.residual.largest() <= tolerance;
  // Sweeps look at one contact after the other and let go of what only all of them hold: there the forces that there
  // are tell what is closed; and their forces may grow without end.
  if (!report.solved && indefinite(problem)) {
    bound = kMostGrowth * largest_force(problem, lambda);
    yield_ = 0.0;
    newton(problem, tolerance, lambda, report.newton);
    report.solved = keep();
  }
  for (std::size_t turn = 0; turn < std::size(kYields) && !report.solved && idle < kIdle && work_ <= kMostWork;
       ++turn) {
    lambda = best_;
    const double before = report.residual.largest();
    // (Sweeps may have to get worse before they get better: the last ones, which are many, begin afresh.)
    if (turn + 1 == std::size(kYields)) lambda.setZero();
    for (int i = 0; i < sweeps && lambda.lpNorm<Eigen::Infinity>() <= bound && work_ <= kMostWork; ++i) {
      threads::Interruption::check();
      sweep(problem, lambda);
      ++report.sweeps;
      work_ += static_cast<double>(problem.D.size());
    }
    if (!(lambda.lpNorm<Eigen::Infinity>() <= bound)) lambda = best_;
    report.solved = keep();
    if (report.solved) break;
    yield_ = kYields[turn];
    newton(problem, tolerance, lambda, report.newton);
    report.solved = keep();
    sweeps *= 2;
    idle = before <= nearly && report.residual.largest() > 0.5 * before ? idle + 1 : 0;
  }
  lambda = best_;
  report.work = work_;
  report.cut = !report.solved && work_ > kMostWork;
  return report;
}

}  // namespace sinew::solve
