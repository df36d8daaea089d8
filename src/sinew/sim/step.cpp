#include "sinew/sim/step.hpp"

#include <algorithm>
#include <cmath>

#include "sinew/sim/assessment.hpp"
#include "sinew/sim/clock.hpp"
#include "sinew/sim/contacts.hpp"
#include "sinew/sim/first_guess.hpp"
#include "sinew/sim/motors.hpp"
#include "sinew/sim/newton.hpp"
#include "sinew/sim/places.hpp"
#include "sinew/sim/step_ends.hpp"

namespace sinew {

double told_at(const Drive& drive, double time) {
  const Table* table = std::get_if<Table>(&drive);
  return table ? value_at(*table, time) : 0.0;
}

void command_at(const Model& model, double time, Command& command) {
  command.actuators.resize(model.actuators.size());
  command.loads.resize(model.loads.size());
  for (std::size_t i = 0; i < model.actuators.size(); ++i)
    command.actuators[i] = told_at(model.actuators[i].drive, time);
  for (std::size_t i = 0; i < model.loads.size(); ++i) command.loads[i] = told_at(model.loads[i].factor, time);
  command.grips.clear();
}

Command command_at(const Model& model, double time) {
  Command command;
  command_at(model, time, command);
  return command;
}

Command command_of(const Model& model, const State& state) {
  Command command{state.actuators, state.loads};
  for (std::size_t i = 0; i < model.actuators.size(); ++i)
    command.actuators[i] = told_to(model, state, static_cast<int>(i));
  return command;
}

Command between(Command from, const Command& to, double part) {
  const auto mix = [part](std::vector<double>& a, const std::vector<double>& b) {
    for (std::size_t i = 0; i < a.size(); ++i) a[i] = std::lerp(a[i], b[i], part);
  };
  mix(from.actuators, to.actuators);
  mix(from.loads, to.loads);
  from.grips = to.grips;
  return from;
}

void add_effort(const StepReport& part, StepReport& whole) {
  whole.newton += part.newton;
  whole.times += part.times;
  whole.contact.sweeps += part.contact.sweeps;
  whole.contact.newton += part.contact.newton;
  whole.contact.work += part.contact.work;
  whole.contact.cut += part.contact.cut;
}

Workspace::Workspace(const Model& model, int threads) : memory_(std::make_unique<Memory>(model, threads)) {}
Workspace::~Workspace() = default;
Workspace::Workspace(Workspace&&) noexcept = default;
Workspace& Workspace::operator=(Workspace&&) noexcept = default;

double begin_step(Memory& memory, Guess guess) {
  Iterate& iterate = memory.iterate;
  iterate.t = 1.0;
  first_guess(memory.context, iterate.state);
  double spent = 0.0;
  if (!memory.context.model.pairs.empty()) {  // two readings of the clock cost more than to find none
    const Clock clock(spent);
    find_contacts(memory.context, iterate.state, memory.here.contacts(), memory.alarm, memory.looks);
  }
  follow_points(memory.context, iterate.state, memory.here);
  if (guess == Guess::moved_on) {  // where velocities lead does not decide which points a rod has left
    move_on(memory.context, memory.here.contacts().clear, iterate.state);
    follow_points(memory.context, iterate.state, memory.here, Rows::stay);
  }
  return spent;
}

namespace {

/// A state that stands elsewhere for a while, and comes back whatever happens.
class Lent {
 public:
  Lent(State& own, State& there) : own_(own), there_(there) { std::swap(own_, there_); }
  Lent(const Lent&) = delete;
  Lent& operator=(const Lent&) = delete;
  ~Lent() { std::swap(own_, there_); }

 private:
  State &own_, &there_;
};

}  // namespace

namespace {

/// How far nodes, mass points of rods and rigid bodies are apart at most [m] in two states, and how far those of the
/// first have come since the run began.
struct Apart {
  double states = 0.0, way = 0.0;
};
Apart apart(const Model& model, const State& state, const State& other) {
  Apart most;
  const auto take = [](double& most_of, const auto& a, const auto& b) {
    if (a.cols() > 0) most_of = std::max(most_of, (a - b).colwise().norm().maxCoeff());
  };
  for (std::size_t i = 0; i < state.solids.size(); ++i) {
    take(most.states, state.solids[i].x, other.solids[i].x);
    take(most.way, state.solids[i].x, model.solids[i].body.rest);
  }
  for (std::size_t i = 0; i < state.rods.size(); ++i) {
    take(most.states, state.rods[i].masses, other.rods[i].masses);
    take(most.way, state.rods[i].masses, model.start_masses[i]);
  }
  for (std::size_t i = 0; i < state.bodies.size(); ++i) {
    take(most.states, state.bodies[i].p, other.bodies[i].p);
    take(most.way, state.bodies[i].p, model.bodies[i].start.p);
  }
  return most;
}

/// The same rules with as many iterations as it takes.
NewtonRules converging(const Model& model, NewtonRules rules) {
  rules.limit = model.scene.newton.limit;
  rules.fixed = false;
  return rules;
}

/// Makes the step of Memory::context. It begins where velocities lead and, where that leads nowhere, from its start.
StepReport make_step(NewtonRules rules, Memory& memory) {
  double alarm = alarm_distance(memory.context);
  const auto from = [&](Guess guess) {
    return look_until_found(memory, alarm, [&] {
      const double spent = begin_step(memory, guess);
      rules.on_trial = guess == Guess::moved_on && memory.here.contacts().clear > 0.0;
      // What is prescribed stands in the context already.
      StepReport report = newton([](double, StepContext&) {}, memory, rules, memory.iterate);
      report.times.contact += spent;
      return report;
    });
  };
  // (A linearised step is one about its start. Commands that are looked for begin there, too.)
  const bool moves_on = !rules.fixed && !rules.inverse && memory.context.rate > 0.0 && moves(memory.context.start);
  StepReport report = from(moves_on ? Guess::moved_on : Guess::start);
  if (rules.on_trial && !accepted(report.status)) {
    const StepReport earlier = std::move(report);
    alarm = memory.alarm;
    report = from(Guess::start);
    add_effort(earlier, report);
  }
  return report;
}

/// Makes the step of Memory::context, which Memory::iterate has made by linearisations, once more until it converges,
/// with the same commands and in as many parts as that takes, eight at most: how far that ends beside it
/// (`StepReport::off`); infinite where it does not end.
double off_converged(Memory& memory, NewtonRules rules) {
  constexpr int kMostParts = 8;
  StepContext& context = memory.context;
  const Model& model = context.model;
  rules = converging(model, rules);
  rules.inverse = nullptr;
  Iterate linearised = memory.iterate;
  const Command command = context.command, before = command_of(model, context.start);
  const double h = context.h;
  const auto converges_in = [&](int parts) {
    for (int part = 1; part <= parts; ++part) {
      if (part > 1) std::swap(context.start, memory.iterate.state);
      context.set(part == parts ? command : between(before, command, static_cast<double>(part) / parts), h / parts);
      const StepReport report = look_until_found(memory, alarm_distance(context), [&] {
        begin_step(memory);
        return newton([](double, StepContext&) {}, memory, rules, memory.iterate);
      });
      if (!accepted(report.status)) return false;
    }
    return true;
  };
  double off = INFINITY;
  {
    State start = context.start;
    const Lent lent(start, context.start);  // from here on `start` is what comes back
    for (int parts = 1; parts <= kMostParts && std::isinf(off); parts *= 2) {
      context.start = start;
      if (!converges_in(parts)) continue;
      const Apart most = apart(model, memory.iterate.state, linearised.state);
      off = most.states > 1e-9 * model.size ? most.states / std::max(most.way, 1e-9 * model.size) : 0.0;
    }
  }
  context.set(command, h);
  memory.iterate = std::move(linearised);
  return off;
}

}  // namespace

void add_linearised(const StepReport& linearised, StepReport& report) {
  add_effort(linearised, report);
  if (accepted(report.status)) return;
  report.detail =
      linearised.detail + (linearised.detail.empty() ? "" : "; ") + "repeated until it converges: " + report.detail;
  if (report.status == Status::max_iterations) report.status = linearised.status;
}

StepReport step_by(const NewtonRules& rules, Memory& memory, const Command& command, double h, State& state) {
  StepReport report;
  {
    const Lent lent(state, memory.context.start);
    memory.context.set(command, h);
    report = make_step(rules, memory);
    if (rules.fixed && !rules.inverse && report.status == Status::max_iterations) {  // its contacts add energy
      const StepReport linearised = std::move(report);
      report = make_step(converging(memory.context.model, rules), memory);
      add_linearised(linearised, report);
    }
    // (Before the state moves: from then on nothing asks for memory.)
    if (rules.inverse && accepted(report.status))
      report.aim = rules.inverse->aim(memory.context.model, memory.iterate.state);
    if (report.status == Status::linearized && rules.compared && leaves_much(memory.context.model, report)) {
      report.off = report.aim.off = off_converged(memory, rules);
      warn_of_linearisation(memory.context.model, memory.iterate.state.time, report);
    }
  }
  if (accepted(report.status)) std::swap(state, memory.iterate.state);
  return report;
}

NewtonRules step_rules(const Model& model, const Effort& effort) {
  const Newton& wanted = model.scene.newton;
  const bool fixed = wanted.iterations > 0 && !effort.converged;
  NewtonRules rules{fixed ? wanted.iterations : wanted.limit, fixed};
  rules.evaluation = effort.evaluation;
  rules.compared = effort.compared && effort.evaluation == Evaluation::full;
  return rules;
}

StepReport step(const Model& model, Workspace& workspace, const Command& command, double h, State& state,
                Effort effort) {
  return step_by(step_rules(model, effort), workspace.memory(), command, h, state);
}

StepResult step(const Model& model, Workspace& workspace, const Command& command, const State& state, double h) {
  StepResult result{state, {}};
  result.report = step(model, workspace, command, h, result.next);
  return result;
}

}  // namespace sinew
