// One step: told by the scene, or by whoever calls.
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/shared_ptr.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include <algorithm>
#include <cmath>

#include "docs.hpp"
#include "engine.hpp"
#include "sinew/error/input_error.hpp"
#include "sinew/io/units.hpp"
#include "sinew/sim/run.hpp"
#include "sinew/threads/interruption.hpp"

namespace sinew::python {

namespace {

io::Dimension told_in(const ActuatorModel& own) {
  switch (own.driven) {
    case Driven::force:
      return io::Dimension::force;
    case Driven::torque:
      return io::Dimension::torque;
    case Driven::displacement:
      return io::Dimension::length;
    case Driven::angle:
      return io::Dimension::angle;
  }
  return io::Dimension::number;
}

bool is_mapping(nb::handle given) {
  if (nb::isinstance<nb::dict>(given)) return true;
  if (nb::isinstance<nb::list>(given) || nb::isinstance<nb::tuple>(given)) return false;
  return nb::isinstance(given, nb::module_::import_("collections.abc").attr("Mapping"));
}

/// Values by name, or all in order, over `numbers`.
void take(nb::handle given, const std::vector<std::string>& names, const std::string& group,
          const std::function<io::Dimension(std::size_t)>& dimension, std::vector<double>& numbers) {
  if (is_mapping(given)) {
    const nb::object items = given.attr("items")();
    for (const nb::handle item : nb::iter(items)) {
      const std::string name = text_of(nb::str(item[0]));
      const std::size_t i = place_of(name, names, group);
      numbers[i] = number_of(item[1], dimension(i), group + "." + name);
    }
    return;
  }
  if (nb::isinstance<nb::str>(given) || nb::isinstance<nb::bytes>(given) || PyAnySet_Check(given.ptr()) ||
      !nb::hasattr(given, "__iter__"))
    throw InputError({.path = group,
                      .value = text_of(nb::repr(given)),
                      .rule = "must be a dict by names, or a list of all in their order",
                      .remedy = fmt::format("in this order: {}", fmt::join(names, ", "))});
  std::size_t i = 0;
  for (const nb::handle value : nb::iter(given)) {
    if (i < names.size()) numbers[i] = number_of(value, dimension(i), group + "." + names[i]);
    if (++i > names.size()) break;
  }
  if (i != names.size()) {
    const Py_ssize_t size = PyObject_Size(given.ptr());
    if (size < 0) PyErr_Clear();
    throw InputError(
        {.path = group,
         .rule = fmt::format("there are {}, not {}", names.size(), size < 0 ? "more" : fmt::to_string(size)),
         .remedy = fmt::format("in this order: {}", fmt::join(names, ", "))});
  }
}

/// Over `goal`, which stays as it is where nothing is told.
void take_goal(nb::handle given, const Model& model, Eigen::VectorXd& goal) {
  if (!is_mapping(given)) {
    std::vector<double> all(static_cast<std::size_t>(goal.size()));
    std::vector<std::string> places;
    for (const EffectorModel& own : model.effectors) {
      for (const Column& column : effector_columns(model, own)) places.push_back(column.name);
    }
    take(
        given, places, "targets", [](std::size_t) { return io::Dimension::number; }, all);
    goal = Eigen::Map<const Eigen::VectorXd>(all.data(), goal.size());
    return;
  }
  const std::vector<std::string> names = effector_names(model);
  const nb::object items = given.attr("items")();
  for (const nb::handle item : nb::iter(items)) {
    const std::string name = text_of(nb::str(item[0]));
    const nb::object value = item[1];
    const EffectorModel& own = model.effectors[place_of(name, names, "targets")];
    const Measure measure = measure_of(model, own);
    const io::Dimension dimension = std::string(measure.si) == "m"     ? io::Dimension::length
                                    : std::string(measure.si) == "rad" ? io::Dimension::angle
                                    : std::string(measure.si) == "N"   ? io::Dimension::force
                                    : std::string(measure.si) == "1/m" ? io::Dimension::curvature
                                                                       : io::Dimension::number;
    if (own.size == 1) {
      goal[own.first] = number_of(value, dimension, "targets." + name);
      continue;
    }
    std::vector<double> numbers(goal.data() + own.first, goal.data() + own.first + own.size);
    const std::vector<std::string> axes = {"x", "y", "z"};
    take(
        value, axes, "targets." + name, [&](std::size_t) { return dimension; }, numbers);
    for (int i = 0; i < own.size; ++i) goal[own.first + i] = numbers[static_cast<std::size_t>(i)];
  }
}

/// What the scene says at the end of the step, what was last told where it leaves that open, and what is told now.
/// True if motors that are sought are told what to do, which targets cannot then.
bool command_of(const Model& model, nb::handle command, nb::handle loads, double time, Command& last, Command& told) {
  command_at(model, time, told);
  for (std::size_t i = 0; i < told.actuators.size(); ++i) {
    if (std::holds_alternative<External>(model.actuators[i].drive)) told.actuators[i] = last.actuators[i];
  }
  for (std::size_t i = 0; i < told.loads.size(); ++i) {
    if (std::holds_alternative<External>(model.loads[i].factor)) told.loads[i] = last.loads[i];
  }
  bool forward = false;
  if (!command.is_none()) {
    for (const int sought : model.sought) told.actuators[sought] = NAN;
    take(
        command, names_of(model.actuators), "actuators", [&](std::size_t i) { return told_in(model.actuators[i]); },
        told.actuators);
    const auto left = [&](int sought) { return std::isnan(told.actuators[sought]); };
    const auto open = std::count_if(model.sought.begin(), model.sought.end(), left);
    forward = !model.sought.empty() && open == 0;
    if (open > 0 && open < static_cast<std::ptrdiff_t>(model.sought.size())) {
      const int first = *std::find_if(model.sought.begin(), model.sought.end(), left);
      throw InputError({.path = "actuators." + model.actuators[first].name,
                        .rule = "is looked for, while others of the motors that are `inverse` are told what to do",
                        .remedy = "tell all of them, and targets are left out in this step, or none"});
    }
    for (const int sought : model.sought) {
      if (left(sought)) told.actuators[sought] = 0.0;  // not looked at
    }
  }
  if (!loads.is_none())
    take(
        loads, names_of(model.loads), "loads", [](std::size_t) { return io::Dimension::number; }, told.loads);
  last = told;
  return forward;
}

FullReport step(SharedModel& shared, nb::handle command, LiveState& live, nb::handle targets, nb::handle loads,
                int threads, bool full) {
  const Model& model = shared.model;
  if (live.model.get() != &shared) throw nb::value_error("this is a state of another model");
  require_threads(threads, 1);
  if (model.scene.analysis != Analysis::dynamic && model.scene.analysis != Analysis::quasi_static &&
      !(command.is_none() && targets.is_none() && loads.is_none()))
    throw nb::value_error("a static or modal analysis goes its own way: give no command, targets or loads");
  Command last = live.command, told;
  Goal goal;
  const double time = static_cast<double>(live.state().grid + 1) * model.scene.time.step;
  const bool forward = command_of(model, command, loads, time, last, told);
  if (forward && !targets.is_none())
    throw InputError({.path = "targets",
                      .rule = "cannot be given together with commands of the motors that are to reach them",
                      .remedy = "leave one of the two out"});
  if (!model.effectors.empty()) {
    goal_at(model, time, goal);
    for (std::size_t i = 0; i < model.effectors.size(); ++i) {
      const EffectorModel& own = model.effectors[i];
      if (std::holds_alternative<External>(model.scene.targets[i].at))
        goal.at.segment(own.first, own.size) = live.goal.at.segment(own.first, own.size);
    }
  }
  if (!targets.is_none()) {
    if (model.effectors.empty()) throw nb::value_error("targets: this scene has none");
    take_goal(targets, model, goal.at);
  }
  FullReport report;
  PythonSignals signals;
  // From here on nothing of Python's runs that could look at the state: what is told has been taken.
  State& state = live.own();
  try {
    live.busy = true;
    const struct Free {
      bool& busy;
      ~Free() { busy = false; }
    } free{live.busy};
    const nb::gil_scoped_release release;
    const threads::Interruption interruption([&signals] { return signals.thrown(); });
    Workspaces::Loan workspace = shared.workspaces.lend(threads);
    const bool grid = model.scene.analysis == Analysis::dynamic || model.scene.analysis == Analysis::quasi_static;
    const Told by{grid ? &told : nullptr, model.effectors.empty() ? nullptr : &goal, forward};
    const long before = state.grid;
    StageTimes times;
    std::vector<Warning> warnings;  // of all parts of a halved step
    do {
      static_cast<StepReport&>(report) =
          advance(model, *workspace, state, {full ? Evaluation::full : Evaluation::motion}, by);
      times += report.times;
      merge(report.warnings, warnings);
    } while (grid && accepted(report.status) && state.grid == before);
    report.times = times;
    report.warnings = std::move(warnings);
    if (!model.effectors.empty() && !forward) report.targets = describe(model, report.aim);
  } catch (const threads::Interrupted&) {
    signals.rethrow();
  }
  live.command = std::move(last);
  live.goal = std::move(goal);
  return report;
}

nb::dict times_of(const FullReport& own) {
  nb::dict all;
  for (const Stage& stage : kStages) all[stage.name] = own.times.*stage.seconds;
  return all;
}

}  // namespace

void bind_steps(nb::module_& module) {
  nb::class_<Warning>(module, "RunWarning", doc::Warning)
      .def_ro("code", &Warning::code, doc::Warning_code)
      .def_ro("where", &Warning::where, doc::Warning_where)
      .def_ro("message", &Warning::message, doc::Warning_message)
      .def_ro("remedy", &Warning::remedy, doc::Warning_remedy)
      .def_ro("time", &Warning::time, doc::Warning_time)
      .def_ro("value", &Warning::value, doc::Warning_value)
      .def_ro("limit", &Warning::limit, doc::Warning_limit)
      .def_ro("unit", &Warning::unit, "Of value and limit.")
      .def_ro("steps", &Warning::steps, doc::Warning_steps)
      .def("__str__", [](const Warning& own) { return to_string(own); })
      .def("__repr__",
           [](const Warning& own) { return "<sinew.RunWarning " + own.code + ": " + to_string(own) + ">"; });
  nb::class_<FullReport>(module, "StepReport", doc::StepReport)
      .def_prop_ro(
          "status", [](const FullReport& own) { return std::string(to_string(own.status)); },
          "How the step ended: converged, linearized, max_iterations, singular, ...")
      .def_prop_ro(
          "accepted", [](const FullReport& own) { return accepted(own.status); },
          "The state was stepped; if not, it stays at the last that was.")
      .def_prop_ro(
          "meaning", [](const FullReport& own) { return std::string(explain(own.status)); }, doc::explain)
      .def_ro("detail", &FullReport::detail, doc::StepReport_detail)
      .def_ro("newton", &FullReport::newton, doc::StepReport_newton)
      .def_ro("halvings", &FullReport::halvings, doc::StepReport_halvings)
      .def_ro("residual", &FullReport::residual, doc::StepReport_residual)
      .def_ro("violation", &FullReport::violation, doc::StepReport_violation)
      .def_ro("rotated", &FullReport::rotated, doc::StepReport_rotated)
      .def_ro("unstable", &FullReport::unstable, doc::StepReport_unstable)
      .def_ro("stability_known", &FullReport::stability_known, doc::StepReport_stability_known)
      .def_ro("redundant", &FullReport::redundant, doc::StepReport_redundant)
      .def_ro("at_floor", &FullReport::at_floor, doc::StepReport_at_floor)
      .def_ro("judged", &FullReport::judged, doc::StepReport_judged)
      .def_ro("warnings", &FullReport::warnings, doc::StepReport_warnings)
      .def_prop_ro(
          "contacts", [](const FullReport& own) { return own.contact.contacts; }, doc::ContactReport_contacts)
      .def_prop_ro(
          "penetration", [](const FullReport& own) { return own.contact.penetration; }, doc::ContactReport_penetration)
      .def_ro("targets", &FullReport::targets,
              "'reached', or what keeps the effectors from their goals; empty without targets.")
      .def_prop_ro(
          "reached", [](const FullReport& own) { return own.aim.outcome == Aim::Outcome::reached; },
          "All targets are, within their tolerances.")
      .def_prop_ro(
          "farthest", [](const FullReport& own) { return own.aim.farthest; }, doc::Aim_farthest)
      .def_prop_ro("times", &times_of, nb::sig("def times(self) -> dict[str, float]"), doc::StageTimes)
      .def("__repr__", [](const FullReport& own) {
        return "<sinew.StepReport " + std::string(to_string(own.status)) + ", " + std::to_string(own.newton) +
               " iterations" + (own.targets.empty() ? "" : ", " + own.targets) + ">";
      });
  module.def(
      "step", &step, "model"_a, "command"_a.none(), "state"_a, nb::kw_only(), "targets"_a = nb::none(),
      "loads"_a = nb::none(), "threads"_a = 1, "full"_a = true,
      nb::sig("def step(model: Model, command: collections.abc.Mapping[str, float | str] | "
              "collections.abc.Iterable[float | str] | None, state: State, *, targets: collections.abc.Mapping[str, "
              "float | "
              "str | collections.abc.Iterable[float | str]] | collections.abc.Iterable[float] | None = None, loads: "
              "collections.abc.Mapping[str, float] | collections.abc.Iterable[float] | None = None, threads: int = 1, "
              "full: bool = True) -> StepReport"),
      "Advances a state, in place, to the next point of the scene's time grid.\n\n"
      "command: what motors are told for the end of the step, in N, m, N m or rad or as text with a unit: a dict "
      "by names, or all of them in the order of `model.actuators`; None, and motors that are not named, obey the "
      "scene, and those driven from outside what they were last told. Motors that are `inverse` look for their own "
      "command; if all of them are told one they obey it, and targets are left out in this step.\n"
      "targets: the same for outputs with a target, {'tip': [0.1, 0, 0.02]} in SI. loads: the same for loads' "
      "factors.\n"
      "threads: that share the work of the step; the result has the same bits for any number.\n"
      "full: False leaves out what the next step does not need (reactions, internal forces), for `newton: 1`.\n\n"
      "Where the step does not converge it is halved, as in a run; where that does not help the report's status "
      "says why, and the state stays at the last that was accepted. Other threads run meanwhile. Throws "
      "InputError for names that do not exist and numbers that are not finite.");
}

}  // namespace sinew::python
