#include "sinew/sim/step.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>

#include "sinew/sim/step_ends.hpp"

namespace sinew {

Command command_at(const Model& model, double time) {
  const auto value = [time](const Drive& drive) {
    const Table* table = std::get_if<Table>(&drive);
    return table ? value_at(*table, time) : 0.0;
  };
  Command command;
  for (const ActuatorModel& actuator : model.actuators) command.actuators.push_back(value(actuator.drive));
  for (const LoadModel& load : model.loads) command.loads.push_back(value(load.factor));
  return command;
}

Workspace make_workspace(const Model& model) {
  Workspace workspace;
  workspace.solids = std::vector<Workspace::Solid>(model.solids.size());
  for (std::size_t i = 0; i < model.solids.size(); ++i) {
    workspace.solids[i].matrix = model.solids[i].matrix;
    workspace.solids[i].factor.analyze(model.solids[i].matrix);
  }
  return workspace;
}

namespace {

/// Halves the last increment while it leads where a law ends (an element turned inside out), and that of a static
/// equilibrium while the unbalanced force grows. Motion of rows is not judged: a motor that has moved must load the
/// rods before anything can be balanced.
class LineSearch {
 public:
  void take(const State& from, const Increment& increment, double fraction, const Linearization& there) {
    from_ = from;
    increment_ = increment;
    fraction_ = fraction;
    force_ = there.largest();
    judged_ = there.violation();
    halvings_ = 0;
  }
  bool too_far(const StepContext& context, const Linearization& here) const {
    constexpr int kMostHalvings = 4, kMostRescues = 12;
    if (from_ && !here.finite()) return halvings_ < kMostRescues;
    return context.rate == 0.0 && from_ && judged_ <= 1e-6 * context.model.size && halvings_ < kMostHalvings &&
           !(here.largest() <= force_) && here.largest() > 1e-6 * here.scale();
  }
  State shortened(const StepContext& context) {
    State state = *from_;
    fraction_ *= 0.5;
    ++halvings_;
    advance_by(context, increment_, fraction_, state);
    return state;
  }

 private:
  std::optional<State> from_;
  Increment increment_;
  double fraction_ = 1.0, force_ = 0.0, judged_ = 0.0;
  int halvings_ = 0;
};

}  // namespace

StepResult step(const Model& model, Workspace& workspace, const Command& command, const State& state, double h) {
  StepContext context = make_context(model, state, command, h);
  State iterate = first_guess(context);
  follow_points(context, iterate);
  StepReport report;
  const Newton& newton = model.scene.newton;
  // Modes are those of an equilibrium.
  const bool fixed = newton.iterations > 0 && model.scene.analysis != Analysis::modal;
  double stiffness = inertia_of(context);
  const auto fail = [&](Status status, std::string detail) -> StepResult {
    report.status = status;
    report.detail = std::move(detail);
    return {state, report};
  };

  LineSearch search;
  for (;; ++report.newton) {
    context.first_guess = report.newton == 0 && context.rate > 0.0 && !fixed;
    auto evaluated = std::make_unique<Linearization>(context, workspace, iterate, report.times);
    while (search.too_far(context, *evaluated)) {
      iterate = search.shortened(context);
      evaluated = std::make_unique<Linearization>(context, workspace, iterate, report.times);
    }
    Linearization& here = *evaluated;
    report.residual = here.scale() > 0.0 ? here.largest() / here.scale() : 0.0;
    report.violation = here.violation();
    if (!here.finite()) {
      const std::string where = inside_out(model, iterate);
      return where.empty() ? fail(Status::diverged, "forces are not finite") : fail(Status::inverted, where);
    }
    const bool met = balanced(model, here, stiffness);
    if (fixed ? report.newton == newton.iterations : (met && report.newton > 0)) {
      finish(context, here, iterate);
      break;
    }
    if (!fixed && report.newton == newton.limit) return fail(Status::max_iterations, "");
    std::string failed;
    if (!here.factor(fixed ? solid::Tangent::definite : solid::Tangent::exact, Linearization::Wanted::descent, failed))
      return fail(Status::singular, failed);
    report.rotated |= here.rotated();
    if (context.rate == 0.0) report.unstable = here.unstable();
    stiffness = std::max(stiffness, here.stiffness());
    const Increment increment = here.solve();
    report.redundant |= increment.reduced.redundant;
    if (!increment.reduced.ok) return fail(Status::singular, "constraint rows and rods");
    const double fraction = fixed ? 1.0 : trusted_fraction(context, increment);
    if (!fixed) search.take(iterate, increment, fraction, here);
    advance_by(context, increment, fraction, iterate);
  }

  if (!finite(iterate)) return fail(Status::diverged, "the new state is not finite");
  if (!fixed && turned_over(context, iterate)) return fail(Status::max_iterations, "a tie turned over");
  if (const RodModel* rod = exhausted(model, iterate)) return fail(Status::rod_exhausted, "rods." + rod->name);
  report.status = fixed ? Status::linearized : Status::converged;
  return {std::move(iterate), report};
}

}  // namespace sinew
