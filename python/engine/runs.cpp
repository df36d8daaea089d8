// Whole runs.
#include <nanobind/stl/filesystem.h>
#include <nanobind/stl/function.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/shared_ptr.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include <chrono>
#include <cmath>

#include "docs.hpp"
#include "engine.hpp"
#include "sinew/error/input_error.hpp"
#include "sinew/sim/reach.hpp"
#include "sinew/sim/signals.hpp"
#include "sinew/sim/view.hpp"
#include "sinew/threads/interruption.hpp"

namespace sinew::python {

namespace {

using Clock = std::chrono::steady_clock;

/// Looks, some times a second, whether Ctrl-C was pressed, and tells how far the run is.
class Watch {
 public:
  explicit Watch(nb::handle progress) : progress_(progress) {}
  bool goes_on(double done, const std::string& note) {
    const Clock::time_point now = Clock::now();
    if (now - last_ < std::chrono::milliseconds(50)) return true;
    last_ = now;
    if (signals_.thrown()) return false;
    const nb::gil_scoped_acquire acquire;
    if (!progress_.is_none()) progress_(done, note);
    return true;
  }
  PythonSignals& signals() { return signals_; }
  /// Once the run has ended, with the GIL: whether Ctrl-C ended it; what else a signal's handler threw is thrown.
  bool interrupted() { return signals_.rethrow(true); }

 private:
  PythonSignals signals_;
  nb::handle progress_;
  Clock::time_point last_ = Clock::now();
};

/// Of a run that was interrupted the tables alone.
void write_views_of(const Run& run, const std::filesystem::path& folder) {
  const io::RecordingHeader header = runs::header_of(run.model->loaded);
  const runs::StepSource steps = runs::steps_of(run.steps);
  const runs::Digest digest = runs::digest(run.model->model, run.summary, header.signal_names, steps);
  const bool interrupted = run.summary.end == "interrupted";
  runs::write_views(folder, {run.model->loaded, header, steps, run.summary, digest},
                    interrupted ? runs::Views::tables : runs::Views::all);
}

std::shared_ptr<Run> simulate(ModelPointer shared, const LiveState& start, const std::optional<std::string>& folder,
                              bool replace, nb::handle progress, int threads) {
  if (start.model != shared) throw nb::value_error("this is a state of another model");
  require_threads(threads, 0);
  const Model& model = shared->model;
  auto all = std::make_shared<Run>(Run{shared, {}, {}});
  const State first = start.state();
  Watch watch(progress);
  {
    const nb::gil_scoped_release release;
    std::optional<io::RecordingWriter> writer;
    if (folder) writer = runs::begin_recording(shared->loaded, first, *folder, replace);
    all->steps.push_back(runs::recorded(model, first, StepReport{}));
    const auto asked = [&watch] { return watch.signals().thrown(); };
    runs::Recorded recorded = [&] {
      const threads::Interruption interruption(asked);
      return runs::record(
          model, first,
          [&](io::RecordedStep step) {
            if (writer) writer->append(step);
            all->steps.push_back(std::move(step));
          },
          [&](const State& state, const StepReport&) { return watch.goes_on(state.time, when(model, state)); },
          threads > 0 ? threads : runs::usual_threads());
    }();
    all->summary = std::move(recorded.summary);
    if (folder && recorded.end == RunEnd::interrupted) {
      write_views_of(*all, *folder);
    } else if (folder) {
      try {
        const threads::Interruption interruption(asked);
        write_views_of(*all, *folder);
      } catch (const threads::Interrupted&) {
        all->summary.end = "interrupted";
      }
    }
  }
  watch.interrupted();
  return all;
}

std::shared_ptr<Run> read_run(const std::string& name) {
  const nb::gil_scoped_release release;
  const std::filesystem::path folder = name;
  const std::filesystem::path path = std::filesystem::is_directory(folder) ? runs::recording_path(folder) : folder;
  io::Recording recording = io::read_recording(path);
  if (recording.steps.empty())
    throw InputError({path.string(), 0, "", "", "holds no finished step", "run the scene again"});
  auto shared = std::make_shared<SharedModel>(runs::load_recorded(recording, path));
  auto all = std::make_shared<Run>(Run{shared, {}, std::move(recording.steps)});
  const bool whole = !all->steps.empty() && run_whole(shared->model.scene, all->steps.back().time);
  all->summary.end = whole ? "done" : "unfinished";
  all->summary.warnings = runs::warnings_before(shared->model);
  return all;
}

/// The same run of a model that was built before.
std::shared_ptr<Run> run_of(ModelPointer model, std::shared_ptr<Run> own) {
  own->model = std::move(model);
  return own;
}

std::size_t number_in(const Run& own, long i) {
  const auto size = static_cast<long>(own.steps.size());
  if (i < -size || i >= size) throw nb::index_error("the run has no such step");
  return static_cast<std::size_t>(i < 0 ? i + size : i);
}

LiveState state_of(const Run& own, long i) {
  return LiveState::of(own.model, unpack(own.model->model, own.steps[number_in(own, i)].state));
}

template <class Of>
Numbers over_time(const Run& own, const Of& of) {
  std::vector<double> all;
  all.reserve(own.steps.size());
  for (const io::RecordedStep& step : own.steps) all.push_back(of(step));
  return vector_of(std::move(all));
}

template <class Of>
std::vector<std::string> words_over_time(const Run& own, const Of& of) {
  std::vector<std::string> all;
  for (const io::RecordedStep& step : own.steps) all.push_back(of(step));
  return all;
}

nb::dict signals_of(const Run& own) {
  nb::dict all;
  std::size_t i = 0;
  for (const Column& column : signal_columns(own.model->model)) {
    all[column.name.c_str()] = over_time(own, [i](const io::RecordedStep& step) { return step.signals[i]; });
    ++i;
  }
  return all;
}

nb::list tuples_of(const std::vector<Warning>& warnings) {
  nb::list all;
  for (const Warning& own : warnings)
    all.append(nb::make_tuple(own.code, own.where, own.message, own.remedy, own.time, own.value, own.limit, own.unit,
                              own.steps, own.latest));
  return all;
}

std::vector<Warning> restored_warnings(nb::handle all) {
  std::vector<Warning> warnings;
  for (const nb::handle own : nb::iter(all)) {
    const auto text = [&](int i) { return nb::cast<std::string>(own[i]); };
    const auto number = [&](int i) { return nb::cast<double>(own[i]); };
    warnings.push_back({text(0), text(1), text(2), text(3), number(4), number(5), number(6), text(7),
                        nb::cast<long>(own[8]), nb::cast<bool>(own[9])});
  }
  return warnings;
}

nb::tuple reduced(const Run& own) {
  nb::list steps;
  for (const io::RecordedStep& step : own.steps) {
    const std::string bytes = io::encode(step);
    steps.append(nb::bytes(bytes.data(), bytes.size()));
  }
  const StepReport& failure = own.summary.failure;
  return nb::make_tuple(nb::module_::import_("sinew.running").attr("_run_again"),
                        nb::make_tuple(own.model, own.summary.end, tuples_of(own.summary.warnings), own.summary.threads,
                                       nb::make_tuple(static_cast<int>(failure.status), failure.detail, failure.newton,
                                                      failure.halvings, failure.residual, failure.violation),
                                       steps));
}

std::shared_ptr<Run> restored(ModelPointer model, const std::string& end,
                              const nb::typed<nb::list, nb::object>& warnings, int threads,
                              const nb::typed<nb::tuple, nb::object, nb::ellipsis>& failure,
                              const nb::typed<nb::list, nb::object>& steps) {
  auto all = std::make_shared<Run>(Run{model, {}, {}});
  StepReport& failed = all->summary.failure;
  failed.status = static_cast<Status>(nb::cast<int>(failure[0]));
  failed.detail = nb::cast<std::string>(failure[1]);
  failed.newton = nb::cast<int>(failure[2]);
  failed.halvings = nb::cast<int>(failure[3]);
  failed.residual = nb::cast<double>(failure[4]);
  failed.violation = nb::cast<double>(failure[5]);
  all->summary.end = end;
  all->summary.warnings = restored_warnings(warnings);
  all->summary.threads = threads;
  const std::size_t signals = signal_names(model->model).size();
  for (const nb::handle own : steps) {
    const auto bytes = nb::cast<nb::bytes>(own);
    std::optional<io::RecordedStep> step = io::decode_step({bytes.c_str(), bytes.size()}, signals);
    if (!step) throw nb::value_error("a run of another model");
    all->steps.push_back(std::move(*step));
  }
  if (all->steps.empty()) throw nb::value_error("a run has at least its start");
  return all;
}

void save(Run& own, const std::filesystem::path& folder, bool replace) {
  const nb::gil_scoped_release release;
  const State first = unpack(own.model->model, own.steps.at(0).state);
  io::RecordingWriter writer = runs::begin_recording(own.model->loaded, first, folder, replace);
  for (std::size_t i = 1; i < own.steps.size(); ++i) writer.append(own.steps[i]);
  write_views_of(own, folder);
}

/// Keeps the steps of a loop of one's own.
class Recorder {
 public:
  Recorder(const LiveState& start, const std::optional<std::filesystem::path>& folder, bool replace)
      : run_(std::make_shared<Run>(Run{start.model, runs::begin_summary(start.model->model, 1), {}})),
        watch_(start.model->model),
        folder_(folder) {
    if (folder_) writer_ = runs::begin_recording(start.model->loaded, start.state(), *folder_, replace);
    keep(start.state(), StepReport{});
  }

  void add(const LiveState& state, const FullReport& report) {
    if (state.model != run_->model) throw nb::value_error("this is a state of another model");
    if (!accepted(report.status)) {
      run_->summary.failure = report;
      return;
    }
    StepReport own = report;
    watch_.look(state.state(), own);
    runs::add(own, run_->summary);
    keep(state.state(), own);
    if (writer_) writer_->append(run_->steps.back());
  }

  /// Writes the results, and goes on.
  std::shared_ptr<Run> run() const {
    auto all = std::make_shared<Run>(*run_);
    const bool stopped = !accepted(all->summary.failure.status);
    const State last = unpack(all->model->model, all->steps.back().state);
    runs::conclude(all->model->model, last, stopped ? RunEnd::stopped : RunEnd::done, all->summary);
    if (folder_) write_views_of(*all, *folder_);
    return all;
  }

 private:
  void keep(const State& state, const StepReport& report) {
    run_->steps.push_back(runs::recorded(run_->model->model, state, report));
  }
  std::shared_ptr<Run> run_;
  runs::RunWatch watch_;
  std::optional<std::filesystem::path> folder_;
  std::optional<io::RecordingWriter> writer_;
};

/// Equilibria all over the limits of the sought motors, as rows of numbers.
nb::tuple workspace(SharedModel& shared, int samples, nb::handle progress, int threads) {
  require_threads(threads, 1);
  if (samples < 1)
    throw InputError({.path = "samples", .value = std::to_string(samples), .rule = "must be at least 1"});
  const Model& model = shared.model;
  std::vector<ReachSample> found;
  Watch watch(progress);
  {
    const nb::gil_scoped_release release;
    int tried = 0;
    const threads::Interruption interruption([&watch] { return watch.signals().thrown(); });
    const auto take = [&](const ReachSample& sample) {
      found.push_back(sample);
      return watch.goes_on(++tried, std::string(to_string(sample.status)));
    };
    try {
      sample_reach(model, spread_commands(model, samples), take, threads);
    } catch (const threads::Interrupted&) {
    }
  }
  const auto rows = static_cast<Eigen::Index>(found.size()), motors = static_cast<Eigen::Index>(model.sought.size());
  Eigen::MatrixXd forces(rows, motors), positions(rows, motors), values(rows, effector_size(model));
  forces.setConstant(NAN);
  positions.setConstant(NAN);
  values.setConstant(NAN);
  std::vector<bool> within;
  std::vector<std::string> status;
  for (Eigen::Index i = 0; i < rows; ++i) {
    const ReachSample& own = found[static_cast<std::size_t>(i)];
    within.push_back(own.within);
    status.emplace_back(to_string(own.status));
    for (Eigen::Index a = 0; a < motors; ++a) {
      const auto at = static_cast<std::size_t>(a);
      const bool known = accepted(own.status);
      const bool force = model.actuators[model.sought[at]].told_force();
      if (known || force) forces(i, a) = known ? own.forces[at] : own.commands[at];
      if (known || !force) positions(i, a) = known ? own.positions[at] : own.commands[at];
    }
    if (!accepted(own.status)) continue;
    for (const EffectorModel& effector : model.effectors)
      values.row(i).segment(effector.first, effector.size) = effector_value(model, own.state, effector);
  }
  std::vector<std::string> columns;
  for (const EffectorModel& effector : model.effectors) {
    for (const Column& column : effector_columns(model, effector)) columns.push_back(column.name);
  }
  std::vector<std::string> names;
  for (const int sought : model.sought) names.push_back(model.actuators[sought].name);
  return nb::make_tuple(names, columns, status, within, matrix_of(forces), matrix_of(positions), matrix_of(values),
                        watch.interrupted());
}

}  // namespace

void bind_runs(nb::module_& module) {
  nb::class_<Run>(module, "Run", "A run: every accepted step, with its state, in memory.")
      .def(
          "__len__", [](const Run& own) { return own.steps.size(); }, "The states it has: one more than steps.")
      .def(
          "output",
          [](const Run& own, const std::string& name) {
            const Model& model = own.model->model;
            const OutputModel& output = model.outputs[place_of(name, names_of(model.outputs), "outputs")];
            Eigen::MatrixXd all;
            for (std::size_t k = 0; k < own.steps.size(); ++k) {
              const std::vector<double> now = kind_of(output).values(model, unpack(model, own.steps[k].state), output);
              if (k == 0)
                all.resize(static_cast<Eigen::Index>(own.steps.size()), static_cast<Eigen::Index>(now.size()));
              all.row(static_cast<Eigen::Index>(k)) =
                  Eigen::Map<const Eigen::RowVectorXd>(now.data(), static_cast<Eigen::Index>(now.size()));
            }
            return matrix_of(all);
          },
          "name"_a, "The numbers of an output over time, in SI: (states, 3) of a position.")
      .def_ro("model", &Run::model, "What was run.")
      .def("state", &state_of, "number"_a = -1, "The state after a step; 0: the start, -1: the end.")
      .def_prop_ro(
          "time", [](const Run& own) { return over_time(own, [](const auto& step) { return step.time; }); },
          "[s] of each step, the start first.")
      .def_prop_ro("signals", &signals_of,
                   nb::sig("def signals(self) -> dict[str, numpy.typing.NDArray[numpy.float64]]"),
                   "All signals over time by their names, in SI: {'tip.x': (steps,), ...}.")
      .def_prop_ro(
          "newton",
          [](const Run& own) {
            std::vector<std::int32_t> all;
            for (const io::RecordedStep& step : own.steps) all.push_back(static_cast<std::int32_t>(step.newton));
            return vector_of(std::move(all));
          },
          "Linearisations of each step.")
      .def_prop_ro(
          "residual", [](const Run& own) { return over_time(own, [](const auto& step) { return step.residual; }); },
          doc::StepReport_residual)
      .def_prop_ro(
          "violation", [](const Run& own) { return over_time(own, [](const auto& step) { return step.violation; }); },
          doc::StepReport_violation)
      .def_prop_ro(
          "status", [](const Run& own) { return words_over_time(own, [](const auto& step) { return step.status; }); },
          "How each step ended.")
      .def_prop_ro(
          "targets", [](const Run& own) { return words_over_time(own, [](const auto& step) { return step.targets; }); },
          "What came of the targets in each step.")
      .def_prop_ro(
          "end", [](const Run& own) { return own.summary.end; },
          "How it ended: done, numerical_stop, interrupted or unfinished.")
      .def_prop_ro(
          "failure",
          [](const Run& own) {
            return own.summary.end == "numerical_stop" ? std::string(to_string(own.summary.failure.status)) : "";
          },
          "The status of the step that stopped it; empty if none did.")
      .def_prop_ro(
          "failure_detail",
          [](const Run& own) {
            if (own.summary.end != "numerical_stop") return std::string();
            const StepReport& failure = own.summary.failure;
            return (failure.detail.empty() ? "" : failure.detail + ". ") + std::string(explain(failure.status));
          },
          "What failed in it, and what to try.")
      .def_prop_ro(
          "warnings", [](const Run& own) { return runs::all_warnings(own.model->model, own.summary, own.steps); },
          "What a user should know of it: of the scene, of all its steps and of how it ended.")
      .def("save", &save, "folder"_a, nb::kw_only(), "replace"_a = false,
           nb::sig("def save(self, folder: str | os.PathLike[str], *, replace: bool = False) -> None"),
           "Writes a results folder, as `sinew run` does: recording, tables, ParaView files, picture, report.")
      .def("__reduce__", &reduced, nb::sig("def __reduce__(self) -> tuple[typing.Any, ...]"))
      .def("__repr__", [](const Run& own) {
        return "<sinew.Run of " + std::to_string(own.steps.size() - 1) + " steps, " + own.summary.end + ">";
      });
  nb::class_<Recorder>(module, "Recorder",
                       "Keeps the steps of a loop of one's own, as a run: `add` each, take `run` at the end.")
      .def(nb::init<const LiveState&, const std::optional<std::filesystem::path>&, bool>(), "state"_a,
           "output"_a = nb::none(), nb::kw_only(), "replace"_a = false,
           nb::sig("def __init__(self, state: State, output: str | os.PathLike[str] | None = None, *, replace: bool = "
                   "False) -> None"),
           "Begins with a state. output: a results folder, written as steps are added.")
      .def("add", &Recorder::add, "state"_a, "report"_a,
           nb::sig("def add(self, state: State, report: StepReport) -> None"),
           "The state after a step, and what the step told. Of one that was not accepted the report alone is kept.")
      .def("run", &Recorder::run, "All of it so far; writes tables and pictures, if there is a results folder.");
  module.def("simulate", &simulate, "model"_a, "state"_a, "folder"_a.none(), "replace"_a, "progress"_a.none(),
             "threads"_a, "Runs from a state to the end of the scene.");
  module.def("read_run", &read_run, "folder"_a, "A run from its results folder, or its recording.");
  module.def("run_of", &run_of, "model"_a, "run"_a, "The run, of a model that is the same as its own.");
  module.def("workspace", &workspace, "model"_a, "samples"_a, "progress"_a.none(), "threads"_a,
             nb::sig("def workspace(model: Model, samples: int, progress: object | None, threads: int) -> "
                     "tuple[list[str], list[str], list[str], list[bool], numpy.typing.NDArray[numpy.float64], "
                     "numpy.typing.NDArray[numpy.float64], numpy.typing.NDArray[numpy.float64], bool]"),
             doc::sample_reach);
  module.def("restored", &restored, "The run of a pickle.");
}

}  // namespace sinew::python
