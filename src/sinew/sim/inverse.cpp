#include "sinew/sim/inverse.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>

#include "sinew/sim/agreement.hpp"
#include "sinew/sim/motors.hpp"
#include "sinew/sim/newton.hpp"
#include "sinew/sim/places.hpp"
#include "sinew/sim/step_ends.hpp"

namespace sinew {

namespace {

/// Further beyond a limit than this part of its unit, it counts as broken; what is less than rounding costs nothing.
constexpr double kBroken = 1e-4, kRounding = 1e-9;
/// [N] or [N m] forces of motors are not told in less than this.
constexpr double kLeastForce = 1e-4;
/// [mm, deg, ...] that being beyond a limit costs at least, for what moves effectors by as much.
constexpr double kLeastPenalty = 1e-2;

/// The four kinds of limits of a motor, as rows.
struct Kind {
  Limit least, most;
  bool of_force, of_rate;
};
constexpr std::array<Kind, 4> kKinds = {{{Limit::least_force, Limit::most_force, true, false},
                                         {Limit::least_position, Limit::most_position, false, false},
                                         {Limit::force_rate, Limit::force_rate, true, true},
                                         {Limit::speed, Limit::speed, false, true}}};
constexpr auto kRows = static_cast<Eigen::Index>(kKinds.size());

}  // namespace

void Inverse::begin(const Model& model, const State& start, const Goal& goal, double h, const Goal* on_the_way) {
  asked_ = goal;
  goal_ = on_the_way ? *on_the_way : goal;
  on_the_way_ = on_the_way != nullptr;
  h_ = h;
  reach = INFINITY;
  binding_.clear();
  dropped_.clear();
  penalty_.setZero(kRows * static_cast<Eigen::Index>(model.sought.size()));
  start_force_.clear();
  start_position_.clear();
  const auto n = static_cast<Eigen::Index>(model.sought.size());
  // Strains are asked for by effectors on rods and by tendons alone.
  const bool strains = std::any_of(model.effectors.begin(), model.effectors.end(),
                                   [&](const EffectorModel& own) { return model.outputs[own.output].rod >= 0; }) ||
                       std::any_of(model.sought.begin(), model.sought.end(),
                                   [&](int motor) { return model.actuators[motor].tendon.has_value(); });
  part_ = strains ? solve::CoupledFactor::Part::all : solve::CoupledFactor::Part::without_strains;
  weights_.resize(effector_size(model));
  for (const EffectorModel& own : model.effectors) weights_.segment(own.first, own.size) = own.weights;
  preferred_.resize(n);
  J_.setZero(weights_.size(), n);
  for (Eigen::Index a = 0; a < n; ++a) {
    const int actuator = model.sought[static_cast<std::size_t>(a)];
    start_force_.push_back(start.actuators[actuator]);
    start_position_.push_back(motor_position(model, start, model.actuators[actuator]));
    preferred_[a] = model.actuators[actuator].preferred;
  }
}

// The step is linear in the commands and in forces at contacts: its solution is that of the commands as they are plus
// p_a times the answer to one more unit of each, and so with forces.
void Inverse::look(const StepContext& context, const State& iterate, Linearization& here, const Increment& increment,
                   bool polished) {
  const Model& model = context.model;
  const auto n = static_cast<Eigen::Index>(model.sought.size());
  effector_errors(model, iterate, goal_, error_);
  rows_.look(context, iterate, here, goal_, error_);
  base_.resize(error_.size());
  rows_.motion(here, increment.reduced, true, base_);
  base_ += error_;
  const Eigen::Index rows = here.touched() ? here.contact_forces().found().size() : 0;
  responses_.resize(model.sought.size());
  J_.resize(error_.size(), n);
  F_.resize(n, n);
  X_.resize(n, n);
  problem_.B.resize(rows, n);
  const auto read_motors = [&](const solve::CoupledSolution& response, Eigen::Ref<Eigen::VectorXd> force,
                               Eigen::Ref<Eigen::VectorXd> position) {
    for (Eigen::Index b = 0; b < n; ++b) {
      const int motor = model.sought[static_cast<std::size_t>(b)];
      const bool told_force = model.actuators[motor].told_force();
      force[b] = told_force ? 0.0 : motor_reaction(model, motor, response);
      position[b] = told_force ? motor_motion(model, iterate, motor, response) : 0.0;
    }
  };
  clear(model, unit_);
  for (Eigen::Index a = 0; a < n; ++a) {
    const int actuator = model.sought[static_cast<std::size_t>(a)];
    solve::CoupledSolution& response = responses_[static_cast<std::size_t>(a)];
    tell_motor(model, iterate, actuator, 1.0, unit_);
    if (polished) {
      here.answer(unit_, response, part_);
    } else {
      here.couple(unit_, response);
    }
    tell_motor(model, iterate, actuator, -1.0, unit_);
    if (!response.ok) {
      J_.col(a).setConstant(NAN);
      continue;
    }
    rows_.motion(here, response, false, J_.col(a));
    read_motors(response, F_.col(a), X_.col(a));
    (model.actuators[actuator].told_force() ? F_ : X_)(a, a) = 1.0;
    if (rows > 0) here.contact_motion(response, false, problem_.B.col(a));
  }
  if (rows > 0) {
    rows_.choose_gaps(here, problem_.B);
    for (Eigen::Index a = 0; a < n; ++a) rows_.add_gaps(problem_.B.col(a), J_.col(a));
  }
  rows_.force_errors(here, goal_, base_);
  L_.setZero(error_.size(), rows);
  F_pressed_.setZero(n, rows);
  X_pressed_.setZero(n, rows);
  problem_.held.resize(rows);
  if (rows == 0) return;
  problem_.contacts = here.contact_forces().problem();
  problem_.held = here.contact_forces().found();
  for (Eigen::Index k = 0; k < rows; ++k) {
    forces_ = Eigen::VectorXd::Unit(rows, k);
    const solve::CoupledSolution& response = here.press(forces_);
    rows_.pressed(here, forces_, problem_.contacts.D.col(k), response, L_.col(k));
    read_motors(response, F_pressed_.col(k), X_pressed_.col(k));
  }
}

void Inverse::follow_contacts() {
  S_.resize(problem_.held.size(), J_.cols());
  if (S_.rows() > 0) S_ = steering_.reaction(problem_);
}

Eigen::MatrixXd Inverse::compliance(const Model& model, Linearization& here) {
  const Eigen::Index n = error_.size();
  Eigen::MatrixXd C(n, n);
  std::vector<Eigen::VectorXd> forces(model.solids.size());
  solve::CoupledSolution response;
  Eigen::MatrixXd moved(problem_.held.size(), n);
  for (Eigen::Index i = 0; i < n; ++i) {
    rows_.force_on(model, static_cast<int>(i), forces, unit_);
    here.couple(forces, unit_, response);
    if (!response.ok) {
      C.setConstant(NAN);
      return C;
    }
    rows_.motion(here, response, true, C.col(i));
    if (moved.rows() > 0) here.contact_motion(response, true, moved.col(i));
  }
  if (moved.rows() == 0) return C;
  const Eigen::MatrixXd B = std::exchange(problem_.B, moved);
  C += L_ * steering_.reaction(problem_);
  problem_.B = B;
  return C;
}

Span Inverse::span_of(const ActuatorModel& motor, Eigen::Index row) const {
  const Kind& kind = kKinds[static_cast<std::size_t>(row / J_.cols())];
  if (!kind.of_rate) return kind.of_force ? motor.force : motor.position;
  const double start = (kind.of_force ? start_force_ : start_position_)[static_cast<std::size_t>(row % J_.cols())];
  const double rate = kind.of_force ? motor.force_rate : motor.speed, most = h_ > 0.0 ? rate * h_ : INFINITY;
  return {start - most, start + most};
}

// An exact penalty: more than what a limit costs the effectors at the best there is, and never nothing.
void Inverse::weigh_limits() {
  for (Eigen::Index row = 0; row < penalty_.size(); ++row) {
    const Eigen::Index a = row % J_.cols();
    const double own = std::abs(problem_.A(row, a)), pull = 2.0 * std::abs(steering_.pulls()[row]);
    const double least = own > kRounding * problem_.unit[row] ? kLeastPenalty * lengths_[a] / own : 0.0;
    penalty_[row] = std::max({penalty_[row], pull, least});
  }
}

double Inverse::value_of(const Model& model, const State& state, Eigen::Index row) const {
  const int actuator = model.sought[static_cast<std::size_t>(row % J_.cols())];
  return kKinds[static_cast<std::size_t>(row / J_.cols())].of_force
             ? state.actuators[actuator]
             : motor_position(model, state, model.actuators[actuator]);
}

double Inverse::unit_of(const Model& model, Eigen::Index row) const {
  const ActuatorModel& motor = model.actuators[model.sought[static_cast<std::size_t>(row % J_.cols())]];
  const Kind& kind = kKinds[static_cast<std::size_t>(row / J_.cols())];
  if (kind.of_rate) {
    const double most = (kind.of_force ? motor.force_rate : motor.speed) * h_;
    return most > 0.0 && std::isfinite(most) ? most : 1.0;  // (without one it is never broken)
  }
  const Span& span = kind.of_force ? motor.force : motor.position;
  double unit = kind.of_force ? kLeastForce : motor.turns() ? 1.0 : model.size;
  for (const double end : {span.least, span.most}) unit = std::max(unit, std::isfinite(end) ? std::abs(end) : 0.0);
  return unit;
}

double Inverse::cost(const Model& model, const State& state) {
  effector_errors(model, state, goal_, error_);
  double sum = 0.5 * weights_.cwiseProduct(error_).squaredNorm();
  for (Eigen::Index row = 0; row < penalty_.size(); ++row) {
    const ActuatorModel& own = model.actuators[model.sought[static_cast<std::size_t>(row % J_.cols())]];
    const double beyond = span_of(own, row).beyond(value_of(model, state, row));
    if (beyond > kRounding * unit_of(model, row)) sum += penalty_[row] * beyond;
  }
  return sum;
}

double Inverse::promised() const {
  double sum = 0.5 * steering_.left().squaredNorm();
  for (Eigen::Index row = 0; row < penalty_.size(); ++row)
    sum += penalty_[row] * Span{problem_.lower[row], problem_.upper[row]}.beyond(steering_.rows()[row]);
  return sum;
}

void Inverse::set_limits(const StepContext& context, const State& iterate, const solve::CoupledSolution& solution) {
  const Model& model = context.model;
  const auto n = static_cast<Eigen::Index>(model.sought.size());
  problem_.A.resize((kRows + 1) * n, n);
  problem_.C.setZero(problem_.A.rows(), L_.cols());
  problem_.lower.resize(problem_.A.rows());
  problem_.upper.resize(problem_.A.rows());
  problem_.firmness.setConstant(problem_.A.rows(), INFINITY);
  problem_.unit.setOnes(problem_.A.rows());
  problem_.wish.resize(n);
  lengths_.resize(n);
  bounds_.resize(static_cast<std::size_t>(2 * kRows * n));
  for (Eigen::Index a = 0; a < n; ++a) {
    const int actuator = model.sought[static_cast<std::size_t>(a)];
    const ActuatorModel& own = model.actuators[actuator];
    const double told = context.command.actuators[actuator];
    const double force =
        motor_force(model, context.command, iterate, actuator) + motor_reaction(model, actuator, solution);
    const double position = own.told_force()
                                ? motor_position(model, iterate, own) + motor_motion(model, iterate, actuator, solution)
                                : told;
    problem_.wish[a] = preferred_[a] - force;
    for (Eigen::Index k = 0; k < kRows; ++k) {
      const Kind& kind = kKinds[static_cast<std::size_t>(k)];
      const Eigen::Index row = k * n + a;
      problem_.A.row(row) = kind.of_force ? F_.row(a) : X_.row(a);
      problem_.C.row(row) = kind.of_force ? F_pressed_.row(a) : X_pressed_.row(a);
      const double now = kind.of_force ? force : position;
      const Span span = span_of(own, row);
      problem_.lower[row] = span.least - now;
      problem_.upper[row] = span.most - now;
      problem_.firmness[row] = kind.of_rate ? 1.0 : 0.0;
      problem_.unit[row] = unit_of(model, row);
      bounds_[static_cast<std::size_t>(2 * row)] = {actuator, kind.least};
      bounds_[static_cast<std::size_t>(2 * row + 1)] = {actuator, kind.most};
    }
    // How far the linearisation is trusted.
    const Eigen::Index row = kRows * n + a;
    const double length =
        std::max(problem_.J.col(a).norm(), std::abs(X_(a, a)) * (own.turns() ? 180.0 / std::numbers::pi : 1e3));
    lengths_[a] = length;
    problem_.A.row(row) = Eigen::RowVectorXd::Unit(n, a);
    problem_.upper[row] = length > 0.0 ? reach / length : INFINITY;
    problem_.lower[row] = -problem_.upper[row];
  }
}

void Inverse::add_agreement(const Model& model, const Reduced& reduced) {
  if (reduced.redundant.empty()) return;
  const auto [A, b] = agreement(model, reduced);
  for (Eigen::Index k = 0; k < b.size(); ++k) {
    const double size = A.row(k).norm();
    if (size == 0.0) continue;
    const Eigen::Index row = problem_.A.rows();
    problem_.A.conservativeResize(row + 1, A.cols());
    problem_.C.conservativeResize(row + 1, problem_.C.cols());
    problem_.A.row(row) = A.row(k) / size;
    problem_.C.row(row).setZero();
    for (Eigen::VectorXd* const vector : {&problem_.lower, &problem_.upper, &problem_.firmness, &problem_.unit})
      vector->conservativeResize(row + 1);
    problem_.lower[row] = problem_.upper[row] = b[k] / size;
    problem_.firmness[row] = INFINITY;
    problem_.unit[row] = model.size;
  }
}

void Inverse::steer(const StepContext& context, const State& iterate, Linearization& here, Increment& increment) {
  const bool polished = !here.touched();  // (with contacts the increment answers their forces, too)
  look(context, iterate, here, increment, polished);
  problem_.e = weights_.cwiseProduct(base_);
  problem_.J = weights_.asDiagonal() * J_;
  problem_.L = weights_.asDiagonal() * L_;
  set_limits(context, iterate, increment.reduced);
  add_agreement(context.model, here.reduced());
  binding_.clear();
  dropped_.clear();
  if (!steering_.solve(problem_)) {
    increment.reduced.ok = false;
    return;
  }
  const Eigen::VectorXd& pulls = steering_.pulls();
  for (Eigen::Index row = 0; row < kRows * J_.cols(); ++row) {
    if (std::abs(pulls[row]) > 1e-6 * steering_.strength()[row])
      binding_.push_back(bounds_[static_cast<std::size_t>(2 * row + (pulls[row] > 0.0 ? 0 : 1))]);
  }
  for (const solve::Broken& own : steering_.broken())
    dropped_.push_back(bounds_[2 * static_cast<std::size_t>(own.row) + (own.at == solve::At::lower ? 0 : 1)]);
  for (std::size_t a = 0; a < responses_.size(); ++a) {
    const double own = steering_.p()[static_cast<Eigen::Index>(a)];
    increment.reduced.dz += own * responses_[a].dz;
    increment.reduced.dlambda += own * responses_[a].dlambda;
    for (std::size_t i = 0; i < increment.reduced.dq.size(); ++i) increment.reduced.dq[i] += own * responses_[a].dq[i];
  }
  if (polished) {
    told_ = here.side();
    for (std::size_t a = 0; a < responses_.size(); ++a)
      tell_motor(context.model, iterate, context.model.sought[a], steering_.p()[static_cast<Eigen::Index>(a)], told_);
    here.polish(told_, increment);
    return;
  }
  moved_ = problem_.B * steering_.p();
  here.change_contacts(moved_, steering_.lambda(), increment);
}

bool Inverse::settled(const Command& command, const Model& model) const {
  double change = 0.0, size = 0.0;
  for (std::size_t a = 0; a < model.sought.size(); ++a) {
    const auto at = static_cast<Eigen::Index>(a);
    const double own = std::abs(steering_.p()[at]);
    change = std::max(change, own / std::max(std::abs(command.actuators[model.sought[a]]), 1e-300));
    size = std::max(size, problem_.J.col(at).norm() * own);
  }
  return change <= 1e-6 || size <= kSettled;
}

void Inverse::take(double fraction, const Model& model, Command& command) const {
  for (std::size_t a = 0; a < model.sought.size(); ++a) {
    const ActuatorModel& own = model.actuators[model.sought[a]];
    double& told = command.actuators[model.sought[a]];
    const Span& span = told_span(own);
    const double wanted = told + fraction * steering_.p()[static_cast<Eigen::Index>(a)];
    // (Not beyond the limit by rounding; what is outside may come back.)
    told = wanted > told ? std::min(wanted, std::max(told, span.most)) : std::max(wanted, std::min(told, span.least));
  }
}

Aim Inverse::aim(const Model& model, const State& state) {
  Aim aim;
  effector_errors(model, state, asked_, error_);
  aim.farthest = farthest(model, error_);
  aim.binding = binding_;
  aim.dropped = dropped_;
  aim.certain = steering_.certain();
  for (Eigen::Index row = 0; row < kRows * J_.cols(); ++row) {
    const int actuator = model.sought[static_cast<std::size_t>(row % J_.cols())];
    const Kind& kind = kKinds[static_cast<std::size_t>(row / J_.cols())];
    const Span span = span_of(model.actuators[actuator], row);
    const double value = value_of(model, state, row);
    if (!(span.beyond(value) > kBroken * unit_of(model, row))) continue;
    const Bound bound{actuator, value < span.least ? kind.least : kind.most};
    const auto same = [&](const Bound& own) { return own.actuator == bound.actuator && own.limit == bound.limit; };
    if (std::none_of(aim.dropped.begin(), aim.dropped.end(), same)) aim.broken.push_back(bound);
  }
  for (std::size_t k = 0; k < model.effectors.size(); ++k) {
    const EffectorModel& own = model.effectors[k];
    const int pair = model.outputs[own.output].pair;
    if (pair >= 0 && asked_.at[own.first] > 0.0 && std::isinf(pressing_of(state, pair).gap))
      aim.apart = static_cast<int>(k);
  }
  aim.outcome = aim.farthest <= 1.0 ? Aim::Outcome::reached
                : !binding_.empty() ? Aim::Outcome::limited
                : on_the_way_       ? Aim::Outcome::on_the_way
                                    : Aim::Outcome::nearest;
  aim.short_of = aim.outcome != Aim::Outcome::reached && steering_.cut_short();
  return aim;
}

}  // namespace sinew
