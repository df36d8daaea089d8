#include "sinew/sim/inverse.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <functional>
#include <stdexcept>

#include "sinew/sim/newton.hpp"
#include "sinew/sim/places.hpp"
#include "sinew/sim/step_ends.hpp"

namespace sinew {

namespace {

/// Part of the effectors' own compliance that increments of forces are held by: redundant actuators share what there is
/// to do, and a goal within reach is still met to about this part of the way to it.
constexpr double kProximal = 1e-9;

void check(const Model& model, const Goal& goal) {
  const std::size_t n = model.actuators.size();
  if (goal.positions.size() != model.effectors.size() || goal.least.size() != n || goal.most.size() != n)
    throw std::invalid_argument("inverse_step: a goal for each effector and bounds for each actuator are needed");
  for (const Vec3& x : goal.positions) {
    if (!x.allFinite()) throw std::invalid_argument("inverse_step: a goal is not finite");
  }
  for (std::size_t a = 0; a < n; ++a) {
    if (!(goal.least[a] <= goal.most[a]))
      throw std::invalid_argument("inverse_step: bounds of actuators." + model.actuators[a].name);
  }
  for (const ActuatorModel& actuator : model.actuators) {
    if (actuator.row >= 0 || actuator.tendon || actuator.motion != Motion::translation)
      throw std::invalid_argument("inverse_step: actuators." + actuator.name + " is not a force on a rod's base");
  }
  if (model.scene.analysis != Analysis::dynamic) throw std::invalid_argument("inverse_step: of dynamic scenes only");
}

}  // namespace

/// The step is linear in the forces: lambda = lambda_0 + sum_a p_a lambda_a, where lambda_a answers one newton of
/// actuator a with everything else at rest. So effectors move to e_0 + J p, J = W_es lambda_a by columns.
void InverseRoom::steer(const Goal& goal, StepContext& context, const State& iterate, Linearization& here,
                        solve::CoupledSolution& solution) {
  const Model& model = context.model;
  const std::size_t n = model.actuators.size();
  const auto effectors = static_cast<Eigen::Index>(3 * model.effectors.size());
  responses.resize(n);
  J.resize(effectors, static_cast<Eigen::Index>(n));
  e.resize(effectors);
  here.effector_motion(solution.dlambda, true, e);
  for (std::size_t k = 0; k < model.effectors.size(); ++k) {
    const EffectorModel& own = model.effectors[k];
    e.segment<3>(static_cast<Eigen::Index>(3 * k)) +=
        solid_point(model, iterate, own.solid, own.where) - goal.positions[k];
  }
  clear(model, unit);
  bool ok = solution.ok;
  for (std::size_t a = 0; a < n; ++a) {
    unit.r[model.actuators[a].unknown] = -1.0;
    here.couple(unit, responses[a]);
    unit.r[model.actuators[a].unknown] = 0.0;
    ok &= responses[a].ok;
    if (responses[a].ok) here.effector_motion(responses[a].dlambda, false, J.col(static_cast<Eigen::Index>(a)));
  }
  H.noalias() = J.transpose().lazyProduct(J);
  H.diagonal().array() += kProximal * std::max(H.trace() / std::max(1.0, static_cast<double>(n)), 1e-300);
  g.noalias() = J.transpose().lazyProduct(e);
  lower.resize(static_cast<Eigen::Index>(n));
  upper.resize(static_cast<Eigen::Index>(n));
  p.setZero(static_cast<Eigen::Index>(n));
  for (std::size_t a = 0; a < n; ++a) {
    lower[static_cast<Eigen::Index>(a)] = goal.least[a] - context.command.actuators[a];
    upper[static_cast<Eigen::Index>(a)] = goal.most[a] - context.command.actuators[a];
  }
  if (!ok || !bounded.minimise(H, g, lower, upper, p)) {
    solution.ok = false;
    return;
  }
  e.noalias() += J * p;
  for (std::size_t a = 0; a < n; ++a) {
    const double own = p[static_cast<Eigen::Index>(a)];
    context.command.actuators[a] = std::clamp(context.command.actuators[a] + own, goal.least[a], goal.most[a]);
    solution.dz += own * responses[a].dz;
    solution.dlambda += own * responses[a].dlambda;
    for (std::size_t i = 0; i < solution.dq.size(); ++i) solution.dq[i] += own * responses[a].dq[i];
  }
}

InverseReport inverse_step(const Model& model, Workspace& workspace, const Goal& goal, double h, State& state,
                           Evaluation evaluation) {
  check(model, goal);
  Memory& memory = workspace.memory();
  memory.command.actuators = state.actuators;
  memory.command.loads.resize(model.loads.size());
  for (std::size_t i = 0; i < model.loads.size(); ++i)
    memory.command.loads[i] = told_at(model.loads[i].factor, state.time + h);
  memory.context.set(state, memory.command, h);
  Iterate& iterate = memory.iterate;
  iterate.t = 1.0;
  first_guess(memory.context, iterate.state);
  follow_points(memory.context, iterate.state, memory.room);
  find_contacts(memory.context, iterate.state, memory.here.contacts());
  NewtonRules rules{1, true};
  rules.evaluation = evaluation;
  const auto steer = [&](solve::CoupledSolution& solution) {
    memory.inverse.steer(goal, memory.context, iterate.state, memory.here, solution);
  };
  rules.steer = std::cref(steer);  // (by reference: a copy would ask for memory)
  InverseReport report;
  report.step = newton([](double, StepContext&) {}, memory, rules, iterate);
  report.distance = accepted(report.step.status) ? memory.inverse.e.norm() : NAN;
  if (accepted(report.step.status)) std::swap(state, iterate.state);
  return report;
}

}  // namespace sinew
