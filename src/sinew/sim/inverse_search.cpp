// Searches for commands: steps and equilibria that bring effectors nearest to their goals, and derivatives by commands.
#include <Eigen/Dense>
#include <functional>
#include <stdexcept>
#include <utility>

#include "sinew/sim/agreement.hpp"
#include "sinew/sim/first_guess.hpp"
#include "sinew/sim/inverse.hpp"
#include "sinew/sim/motors.hpp"
#include "sinew/sim/newton.hpp"
#include "sinew/sim/places.hpp"
#include "sinew/sim/statics.hpp"
#include "sinew/sim/step_ends.hpp"

namespace sinew {

namespace {

void check(const Model& model, const Goal& goal) {
  if (model.sought.empty() || model.effectors.empty())
    throw std::invalid_argument("inverse_step: the scene has no targets, or no actuator is sought");
  if (goal.at.size() != effector_size(model))
    throw std::invalid_argument("inverse_step: a goal for each component of the effectors is needed");
  if (!goal.at.allFinite()) throw std::invalid_argument("inverse_step: a goal is not finite");
  if (model.scene.analysis != Analysis::dynamic && model.scene.analysis != Analysis::quasi_static)
    throw std::invalid_argument("inverse_step: of dynamic and quasi-static scenes only");
}

/// Of a search, and of one for a step in time, whose next one goes on.
constexpr int kMostTurns = 60, kMostTurnsInMotion = 12;
/// Iterations of Newton, in multiples of `newton.limit`, after which no search turns once more.
constexpr int kMostOfSearch = 16;
/// And after which a trial of one, an equilibrium, is given up.
constexpr int kMostOfTrial = 4;
/// First region of trust, as a part of the scene's size.
constexpr double kFirstReach = 0.2;
/// How far, of the scene's size, commands may move effectors in a step by what they do at rest.
constexpr double kReachAtRest = 0.02;
/// Half the square of a weighed error that is as good as none.
constexpr double kMet = 0.5e-4;
/// What is not worth another turn.
constexpr double kNoGain = 1e-8;

/// Where no second look follows, nothing is taken to fly past.
EarlierLooks all_contacts() {
  EarlierLooks looks;
  looks.nothing_passes = true;
  return looks;
}

/// Solves the linear problem at Memory::iterate in Memory::context; false where a matrix is singular.
bool solve_there(Memory& memory, solid::Tangent tangent, StageTimes& times, const Linearization::Steer& steer) {
  memory.here.evaluate(memory.context, memory.iterate.state, times);
  std::string failed;
  if (!memory.here.finite() || !memory.here.factor(tangent, Linearization::Wanted::any, failed)) return false;
  memory.here.solve(memory.increment, steer);
  return memory.increment.reduced.ok;
}

/// About a state that a step of h from `start` has come to; rate: 1 / h, or 0 of an equilibrium.
bool linearize_at(Memory& memory, const State& start, const State& state, const Command& command, double h, double rate,
                  StageTimes& times, const Linearization::Steer& steer,
                  solid::Tangent tangent = solid::Tangent::exact) {
  StepContext& context = memory.context;
  context.set(start, command, h);
  context.rate = rate;
  memory.iterate.state = state;
  find_contacts(context, memory.iterate.state, memory.here.contacts(), alarm_distance(context), all_contacts());
  return solve_there(memory, tangent, times, steer);
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
  memory.alarm = alarm_distance(memory.context);
  memory.looks = all_contacts();
  begin_step(memory);
  place_held(memory.context, memory.iterate.state);
  return solve_there(memory, solid::Tangent::definite, times, steer);
}

/// How commands lead to states.
struct Way {
  std::function<StepResult(const Command&, const State& near)> make;  ///< a step or an equilibrium, from one near it
  const State* start = nullptr;  ///< of all that `make` makes; else each begins where it is made from
  double time = 0.0;             ///< [s] of the states
  double h = 0.0;                ///< [s] of a step, 0 of equilibria
};

/// Commands, the state they lead to, and what a search has cost.
struct Found {
  Command told;
  StepResult at;
  StepReport spent;
  bool short_of = false;   ///< commands that would come nearer lead nowhere: no step or equilibrium was found
  bool gave_up = false;    ///< of them, some would have been too much work to follow
  bool cut_short = false;  ///< commands that may come nearer were not looked for: it would have been too much work

  void add(const StepReport& report) { add_effort(report, spent); }
  void tell(StepReport& report) const {
    report.newton = spent.newton;
    report.times = spent.times;
    report.contact.sweeps = spent.contact.sweeps;
    report.contact.newton = spent.contact.newton;
    report.contact.work = spent.contact.work;
    report.contact.cut = spent.contact.cut;
  }
};

/// What came of it, where larger commands may come nearer (`short_of`) unless all targets are reached.
Aim aim_at(Inverse& inverse, const Model& model, const State& state, bool short_of) {
  Aim aim = inverse.aim(model, state);
  aim.short_of = aim.outcome != Aim::Outcome::reached && (short_of || aim.short_of);
  return aim;
}

/// Gauss and Newton's method in a region of trust, each of whose steps goes where its commands lead, until no increment
/// helps. A step in time is no further looked for once one was lost on the way: it would end at the brink. False where
/// nothing better was found although there was more to go.
bool search(const Model& model, Memory& memory, const Way& way, Found& found) {
  Inverse& inverse = memory.inverse;
  const bool moves = way.h > 0.0;
  double reach = kFirstReach * model.size * 1e3, farthest = INFINITY;
  bool settled = false, came_nearer = false;
  const int most = moves ? kMostTurnsInMotion : kMostTurns;
  const int before = found.spent.newton, limit = model.scene.newton.limit;
  for (int turn = 0; turn < most && !found.cut_short; ++turn) {
    inverse.reach = reach;
    const State& start = way.start ? *way.start : found.at.next;
    const bool ok = linearize_at(memory, start, found.at.next, found.told, moves ? way.h : way.time - start.time,
                                 moves ? 1.0 / way.h : 0.0, found.spent.times, [&](Increment& increment) {
                                   inverse.steer(memory.context, memory.iterate.state, memory.here, increment);
                                 });
    ++found.spent.newton;
    if (!ok) break;
    inverse.weigh_limits();
    const double cost = inverse.cost(model, found.at.next), promised = cost - inverse.promised();
    found.cut_short = inverse.cut_short() || found.spent.newton - before > kMostOfSearch * limit;
    settled = !found.cut_short && inverse.motion() <= Inverse::kSettled && inverse.settled(found.told, model) &&
              promised <= kNoGain;
    if (settled) break;
    Command next = found.told;
    inverse.take(1.0, model, next);
    StepResult trial = way.make(next, start);
    found.add(trial.report);
    const bool leads = accepted(trial.report.status);
    const double there = leads ? inverse.cost(model, trial.next) : INFINITY;
    const bool better = there < cost - 1e-4 * std::abs(promised) || there < kMet;
    const double moved = inverse.moved();
    // Where there is nothing any more, steps of that length are not tried again.
    if (!leads) {
      farthest = 0.5 * moved;
      found.short_of = true;
      found.gave_up |= !moves && trial.report.newton >= kMostOfTrial * limit;
    }
    if (better) {
      if (cost - there > 0.75 * promised) reach = std::min(std::max(reach, 2.0 * moved), farthest);
      if (cost - there < 0.25 * promised) reach = std::max(0.5 * moved, Inverse::kSettled);
      found.at = std::move(trial);
      found.told = next;
      came_nearer = true;
      if (moves && found.short_of) break;
    } else {
      reach = 0.25 * std::min(reach, moved);
      settled = !(reach > Inverse::kSettled) && !found.short_of;
      if (!(reach > Inverse::kSettled)) break;
    }
  }
  inverse.reach = INFINITY;
  found.cut_short |= !settled && found.gave_up;
  return settled || came_nearer;
}

/// Commands are changed towards those whose equilibrium has the effectors at their goals, as far as the linearisation
/// at a state tells, by no more than moves these by kReachAtRest. Unlike what a step of h would make of them, that is
/// no more where there is less time. Where what commands do at rest is the opposite of what they do within the step,
/// there is no equilibrium that stands, and they stay.
void steer_at_rest(const Model& model, Memory& memory, const State& state, double h, StageTimes& times,
                   Command& command) {
  Inverse& inverse = memory.inverse;
  StepContext& context = memory.context;
  Eigen::MatrixXd at_once, at_rest;
  const auto look = [&](Increment& increment) {
    inverse.look(context, memory.iterate.state, memory.here, increment);
    inverse.follow_contacts();
    at_once = inverse.weighed_jacobian();
  };
  if (!linearize_at(memory, state, state, command, h, 1.0 / h, times, look, solid::Tangent::definite)) return;
  context.rate = 0.0;
  inverse.reach = kReachAtRest * model.size * 1e3;
  const auto steer = [&](Increment& increment) {
    inverse.steer(context, memory.iterate.state, memory.here, increment);
    inverse.follow_contacts();
    at_rest = inverse.weighed_jacobian();
  };
  const bool solved = solve_there(memory, solid::Tangent::exact, times, steer);
  inverse.reach = INFINITY;
  if (!solved || !at_rest.allFinite()) return;
  if ((at_once.cwiseProduct(at_rest).colwise().sum().array() < 0.0).any()) return;
  inverse.take(1.0, model, command);
}

/// A step of h whose commands `steer_at_rest` has changed, or, in the later parts of a step, none. On failure the state
/// stays.
StepReport gentle_step(const Model& model, Memory& memory, const NewtonRules& forward, bool steers, Command command,
                       double h, State& state) {
  StageTimes times;
  agree(model, memory, state, state.time + h, times, command);
  if (steers) steer_at_rest(model, memory, state, h, times, command);
  StepReport report = step_by(forward, memory, command, h, state);
  report.newton += steers ? 2 : 0;
  report.times += times;
  if (!accepted(report.status)) return report;
  report.aim = aim_at(memory.inverse, model, state, true);
  report.aim.certain = false;
  return report;
}

/// From commands as they are to those that bring the effectors as near to what they make for as steps of h converge.
/// On failure the state stays.
StepReport search_step(const Model& model, Memory& memory, const NewtonRules& forward, Command command, double h,
                       State& state) {
  StageTimes times;
  agree(model, memory, state, state.time + h, times, command);
  const Way way{[&](const Command& told, const State& from) {
                  StepResult made{from, {}};
                  made.report = step_by(forward, memory, told, h, made.next);
                  return made;
                },
                &state, 0.0, h};
  Found found{command, way.make(command, state), {}, false};
  found.spent.times = times;
  found.add(found.at.report);
  if (accepted(found.at.report.status) && !search(model, memory, way, found))
    found.at.report.status = Status::max_iterations;
  StepReport report = found.at.report;
  found.tell(report);
  if (!accepted(report.status)) return report;
  report.aim = aim_at(memory.inverse, model, found.at.next, found.short_of || found.cut_short);
  state = std::move(found.at.next);
  return report;
}

}  // namespace

StepReport inverse_step(const Model& model, Workspace& workspace, const Goal& goal, const Command& command, double h,
                        State& state, Effort effort, const PartOfStep& part) {
  check(model, goal);
  if (part.on_the_way) check(model, *part.on_the_way);
  Memory& memory = workspace.memory();
  memory.command = command;
  for (const int actuator : model.sought) memory.command.actuators[actuator] = told_to(model, state, actuator);
  const NewtonRules forward = step_rules(model, effort);
  NewtonRules together = forward;
  together.inverse = &memory.inverse;
  StepReport report;
  bool tried = false;
  const auto made_by = [&](const Goal* on_the_way, const auto& make) {
    memory.inverse.begin(model, state, goal, h, on_the_way);
    StepReport made = make();
    if (accepted(made.status) || !tried) std::swap(report, made);
    if (tried) add_effort(made, report);
    tried = true;
    return accepted(report.status);
  };
  const auto step_together = [&] { return step_by(together, memory, memory.command, h, state); };
  const auto search = [&] { return search_step(model, memory, forward, memory.command, h, state); };
  if (together.fixed || model.scene.analysis != Analysis::dynamic) {
    made_by(part.on_the_way, step_together);
    return report;
  }
  // Less time only makes larger commands necessary, so a part of a step that failed is not steered; but where contacts
  // come and go with the commands, fewer of them do so in less time.
  const bool presses = std::any_of(state.contacts.begin(), state.contacts.end(),
                                   [](const ContactState& contact) { return !contact.force.isZero(0.0); });
  if ((part.at_once || presses) && made_by(part.on_the_way, step_together)) return report;
  if (presses && made_by(part.on_the_way, search)) return report;
  made_by(nullptr, [&] { return gentle_step(model, memory, forward, part.begins, memory.command, h, state); });
  return report;
}

StepReport inverse_equilibrium(const Model& model, Workspace& workspace, const Goal& goal, const Command& command,
                               double time, State& state) {
  check(model, goal);
  Memory& memory = workspace.memory();
  Inverse& inverse = memory.inverse;
  inverse.begin(model, state, goal, time - state.time);
  Found found;
  found.told = command;
  for (const int actuator : model.sought) found.told.actuators[actuator] = told_to(model, state, actuator);
  agree(model, memory, state, time, found.spent.times, found.told);
  // Where friction remembers the way, every trial goes the whole of it.
  const bool remembers = !model.pairs.empty() || !model.rubbing.empty();
  const Way way{[&](const Command& told, const State& near) {
                  return equilibrium_step(model, workspace, told, near, time, kMostOfTrial);
                },
                remembers ? &state : nullptr, time};
  found.at = equilibrium_step(model, workspace, found.told, state, time);
  found.add(found.at.report);
  if (!accepted(found.at.report.status)) {
    found.tell(found.at.report);
    return found.at.report;
  }
  search(model, memory, way, found);
  if (!remembers) {
    // The whole way in one, as whoever is told these commands goes it.
    StepResult whole = equilibrium_step(model, workspace, found.told, state, time);
    found.add(whole.report);
    if (accepted(whole.report.status) &&
        inverse.cost(model, whole.next) <= inverse.cost(model, found.at.next) * (1.0 + 1e-6) + 1e-8)
      found.at = std::move(whole);
  }
  StepReport report = found.at.report;
  found.tell(report);
  report.aim = aim_at(inverse, model, found.at.next, found.cut_short);
  state = std::move(found.at.next);
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
  const bool ok = of == JacobianOf::equilibrium ? linearize_at(memory, state, state, command, 0.0, 0.0, times, look)
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
  const bool ok = of == JacobianOf::equilibrium ? linearize_at(memory, state, state, command, 0.0, 0.0, times, nothing)
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
