#include "sinew/sim/inverse.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <utility>

#include "sinew/sim/agreement.hpp"
#include "sinew/sim/motors.hpp"
#include "sinew/sim/newton.hpp"
#include "sinew/sim/places.hpp"
#include "sinew/sim/statics.hpp"
#include "sinew/sim/step_ends.hpp"

namespace sinew {

namespace {

/// [mm, deg, ...] increments that move effectors no more than this end a search; goals are then met to about that.
constexpr double kSettled = 1e-5;
/// Further beyond a limit than this part of its unit, it counts as broken; what is less than rounding costs nothing.
constexpr double kBroken = 1e-4, kRounding = 1e-9;
/// [N] or [N m] forces of motors are not told in less than this.
constexpr double kLeastForce = 1e-4;
/// [mm, deg, ...] that being beyond a limit costs at least, for what moves effectors by as much.
constexpr double kLeastPenalty = 1e-2;

void check(const Model& model, const Goal& goal) {
  if (model.sought.empty() || model.effectors.empty())
    throw std::invalid_argument("inverse_step: the scene has no targets, or no actuator is sought");
  if (goal.at.size() != effector_size(model))
    throw std::invalid_argument("inverse_step: a goal for each component of the effectors is needed");
  if (!goal.at.allFinite()) throw std::invalid_argument("inverse_step: a goal is not finite");
  if (model.scene.analysis != Analysis::dynamic && model.scene.analysis != Analysis::quasi_static)
    throw std::invalid_argument("inverse_step: of dynamic and quasi-static scenes only");
}

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

void Inverse::begin(const Model& model, const State& start, const Goal& goal, double h) {
  goal_ = goal;
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
  effector_errors(model, state, goal_, error_);
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
    if (pair >= 0 && goal_.at[own.first] > 0.0 && std::isinf(pressing_of(state, pair).gap))
      aim.apart = static_cast<int>(k);
  }
  aim.outcome = aim.farthest <= 1.0 ? Aim::Outcome::reached
                : binding_.empty()  ? Aim::Outcome::nearest
                                    : Aim::Outcome::limited;
  return aim;
}

StepReport inverse_step(const Model& model, Workspace& workspace, const Goal& goal, const Command& command, double h,
                        State& state, Effort effort) {
  check(model, goal);
  Memory& memory = workspace.memory();
  memory.inverse.begin(model, state, goal, h);
  memory.command = command;
  for (const int actuator : model.sought) memory.command.actuators[actuator] = told_to(model, state, actuator);
  NewtonRules rules = step_rules(model, effort);
  rules.inverse = &memory.inverse;
  return step_by(rules, memory, memory.command, h, state);
}

namespace {

constexpr int kMostTurns = 60;
/// First region of trust, as a part of the scene's size.
constexpr double kFirstReach = 0.2;
/// Half the square of a weighed error that is as good as none.
constexpr double kMet = 0.5e-4;
/// What is not worth another turn.
constexpr double kNoGain = 1e-8;

/// Solves the linear problem at Memory::iterate in Memory::context; false where a matrix is singular.
bool solve_there(Memory& memory, solid::Tangent tangent, StageTimes& times, const Linearization::Steer& steer) {
  memory.here.evaluate(memory.context, memory.iterate.state, times);
  std::string failed;
  if (!memory.here.finite() || !memory.here.factor(tangent, Linearization::Wanted::any, failed)) return false;
  memory.here.solve(memory.increment, steer);
  return memory.increment.reduced.ok;
}

/// About an equilibrium that a step from `start` has come to.
bool linearize_at(Memory& memory, const State& start, const State& state, const Command& command, double time,
                  StageTimes& times, const Linearization::Steer& steer) {
  StepContext& context = memory.context;
  context.set(start, command, time - start.time);
  context.rate = 0.0;
  memory.iterate.state = state;
  find_contacts(context, memory.iterate.state, memory.here.contacts(), alarm_distance(context));
  return solve_there(memory, solid::Tangent::exact, times, steer);
}

/// Sought commands that agree with those that are told, where rows depend on each other: the nearest to what they are.
void agree(const Model& model, Memory& memory, const State& state, double time, StageTimes& times, Command& told) {
  if (model.redundant.empty()) return;
  StepContext& context = memory.context;
  context.set(state, told, time - state.time);
  context.rate = 0.0;
  memory.iterate.state = state;
  find_contacts(context, memory.iterate.state, memory.here.contacts(), alarm_distance(context));
  memory.here.evaluate(context, memory.iterate.state, times);
  const auto [A, b] = agreement(model, memory.here.reduced());
  if (b.size() == 0) return;
  const Eigen::VectorXd more = A.completeOrthogonalDecomposition().solve(b);
  for (std::size_t a = 0; a < model.sought.size(); ++a)
    told.actuators[model.sought[a]] += more[static_cast<Eigen::Index>(a)];
}

/// The first round of a step of h, as the paper's.
bool linearize_step(Memory& memory, const State& start, const Command& command, double h, StageTimes& times,
                    const Linearization::Steer& steer) {
  memory.context.set(start, command, h);
  begin_step(memory);
  place_held(memory.context, memory.iterate.state);
  return solve_there(memory, solid::Tangent::definite, times, steer);
}

}  // namespace

StepReport inverse_equilibrium(const Model& model, Workspace& workspace, const Goal& goal, const Command& command,
                               double time, State& state) {
  check(model, goal);
  Memory& memory = workspace.memory();
  Inverse& inverse = memory.inverse;
  inverse.begin(model, state, goal, time - state.time);
  Command told = command;
  for (const int actuator : model.sought) told.actuators[actuator] = told_to(model, state, actuator);
  StageTimes agreeing;
  agree(model, memory, state, time, agreeing, told);
  StepResult at = equilibrium_step(model, workspace, told, state, time);
  at.report.times += agreeing;
  if (!accepted(at.report.status)) return at.report;
  // Where friction remembers the way, every trial goes the whole of it.
  const bool remembers = !model.pairs.empty() || !model.rubbing.empty();
  StepReport spent = at.report;
  double reach = kFirstReach * model.size * 1e3, farthest = INFINITY;
  for (int turn = 0; turn < kMostTurns; ++turn) {
    inverse.reach = reach;
    const bool ok = linearize_at(
        memory, remembers ? state : at.next, at.next, told, time, spent.times,
        [&](Increment& increment) { inverse.steer(memory.context, memory.iterate.state, memory.here, increment); });
    ++spent.newton;
    if (!ok) break;
    inverse.weigh_limits();
    const double cost = inverse.cost(model, at.next), promised = cost - inverse.promised();
    if (inverse.motion() <= kSettled && inverse.settled(told, model) && promised <= kNoGain) break;
    Command next = told;
    inverse.take(1.0, model, next);
    StepResult trial = equilibrium_step(model, workspace, next, remembers ? state : at.next, time);
    spent.newton += trial.report.newton;
    spent.times += trial.report.times;
    const double found = accepted(trial.report.status) ? inverse.cost(model, trial.next) : INFINITY;
    const bool better = found < cost - 1e-4 * std::abs(promised) || found < kMet;
    const double moved = inverse.moved();
    // Where there is no equilibrium any more, steps of that length are not tried again.
    if (!accepted(trial.report.status)) farthest = 0.5 * moved;
    if (better) {
      if (cost - found > 0.75 * promised) reach = std::min(std::max(reach, 2.0 * moved), farthest);
      if (cost - found < 0.25 * promised) reach = std::max(0.5 * moved, kSettled);
      at = std::move(trial);
      told = next;
    } else {
      reach = 0.25 * std::min(reach, moved);
      if (!(reach > kSettled)) break;
    }
  }
  inverse.reach = INFINITY;
  if (!remembers) {
    // The whole way in one, as whoever is told these commands goes it.
    StepResult whole = equilibrium_step(model, workspace, told, state, time);
    spent.newton += whole.report.newton;
    spent.times += whole.report.times;
    if (accepted(whole.report.status) &&
        inverse.cost(model, whole.next) <= inverse.cost(model, at.next) * (1.0 + 1e-6) + 1e-8)
      at = std::move(whole);
  }
  StepReport report = at.report;
  report.newton = spent.newton;
  report.times = spent.times;
  report.aim = inverse.aim(model, at.next);
  state = std::move(at.next);
  return report;
}

Manipulability manipulability(const Eigen::MatrixXd& jacobian) {
  const Eigen::JacobiSVD<Eigen::MatrixXd> svd(jacobian, Eigen::ComputeThinU | Eigen::ComputeThinV);
  return {svd.singularValues(), svd.matrixU(), svd.matrixV(), svd.singularValues().prod()};
}

ActuatorJacobian actuator_jacobian(const Model& model, Workspace& workspace, const State& state, JacobianOf of,
                                   double h) {
  if (model.sought.empty() || model.effectors.empty())
    throw std::invalid_argument("actuator_jacobian: the scene has no targets, or no actuator is sought");
  Memory& memory = workspace.memory();
  Inverse& inverse = memory.inverse;
  Goal goal;
  goal.at.resize(effector_size(model));
  for (const EffectorModel& own : model.effectors)
    goal.at.segment(own.first, own.size) = effector_value(model, state, own);
  inverse.begin(model, state, goal, h);
  const Command command = command_of(model, state);
  StageTimes times;
  Eigen::MatrixXd compliance;
  const auto look = [&](Increment& increment) {
    inverse.look(memory.context, memory.iterate.state, memory.here, increment);
    inverse.follow_contacts();
    compliance = inverse.compliance(model, memory.here);
  };
  const bool ok = of == JacobianOf::equilibrium ? linearize_at(memory, state, state, command, state.time, times, look)
                                                : linearize_step(memory, state, command, h, times, look);
  if (!ok || !inverse.jacobian().allFinite()) throw std::runtime_error("actuator_jacobian: a matrix is singular");
  ActuatorJacobian result{inverse.jacobian(), compliance, inverse.force_change(), inverse.position_change(), {}, {}};
  for (const EffectorModel& own : model.effectors) {
    for (const Column& component : effector_columns(model, own))
      result.rows.push_back(component.name + " [" + component.unit + "]");
  }
  for (const int actuator : model.sought) {
    const ActuatorModel& own = model.actuators[actuator];
    const MotorWords words = words_of(own);
    result.columns.push_back(command_name(own) + " [" + (own.told_force() ? words.force_unit : words.position_unit) +
                             "]");
  }
  return result;
}

Eigen::MatrixXd volume_compliance(const Model& model, Workspace& workspace, const State& state, JacobianOf of,
                                  double h) {
  Memory& memory = workspace.memory();
  const Command command = command_of(model, state);
  StageTimes times;
  const auto nothing = [](Increment&) {};
  const bool ok = of == JacobianOf::equilibrium
                      ? linearize_at(memory, state, state, command, state.time, times, nothing)
                      : linearize_step(memory, state, command, h, times, nothing);
  if (!ok) throw std::runtime_error("volume_compliance: a matrix is singular");
  Eigen::MatrixXd W = Eigen::MatrixXd::Zero(model.rows, model.rows);
  for (const solve::VolumePart& volume : memory.here.reduced().problem.volumes) {
    for (std::size_t j = 0; j < volume.at.size(); ++j) {
      for (std::size_t i = 0; i < volume.at.size(); ++i) {
        const auto row = static_cast<Eigen::Index>(i), column = static_cast<Eigen::Index>(j);
        W(volume.at[i], volume.at[j]) +=
            volume.symmetric ? volume.W(std::max(row, column), std::min(row, column)) : volume.W(row, column);
      }
    }
  }
  return W;
}

}  // namespace sinew
