// What Python holds: models that states share, states that arrays share, runs.
#pragma once

#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>

#include <Eigen/Core>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "sinew/io/document.hpp"
#include "sinew/io/units.hpp"
#include "sinew/runs/loaded_scene.hpp"
#include "sinew/runs/record.hpp"
#include "sinew/sim/step.hpp"
#include "sinew/sim/targets.hpp"
#include "sinew/sim/workspaces.hpp"

namespace sinew::python {

namespace nb = nanobind;
using namespace nb::literals;

/// What handlers of signals throw in Python, such as KeyboardInterrupt after Ctrl-C, while the engine works without the
/// GIL. Python runs them in its main thread alone.
class PythonSignals {
 public:
  /// Whether one has thrown; takes the GIL.
  bool thrown() {
    if (error_) return true;
    const nb::gil_scoped_acquire acquire;
    if (PyErr_CheckSignals() != 0) error_.emplace();
    return error_.has_value();
  }
  /// Once the work has ended, with the GIL: throws it again, but a KeyboardInterrupt only where it is not taken: then
  /// says whether there was one.
  bool rethrow(bool takes_keyboard = false) {
    if (!error_) return false;
    if (!takes_keyboard || !error_->matches(PyExc_KeyboardInterrupt)) throw nb::python_error(std::move(*error_));
    error_.reset();
    return true;
  }

 private:
  std::optional<nb::python_error> error_;
};

/// A model and the memory of its steps.
class SharedModel {
 public:
  explicit SharedModel(runs::LoadedScene scene) : loaded(std::move(scene)), model(loaded.model), workspaces(model) {}

  const runs::LoadedScene loaded;
  const Model& model;
  Workspaces workspaces;
};
using ModelPointer = std::shared_ptr<SharedModel>;

/// A state of a model. Arrays that Python holds look at `now` and keep it; a step then goes on with a copy, so that
/// they never change. While a step works on it, other threads are refused.
struct LiveState {
  ModelPointer model;
  std::shared_ptr<State> now;
  /// What motors, loads and targets that are driven from outside were last told.
  Command command = {};
  Goal goal = {};
  bool busy = false;

  /// One that obeys what it obeyed when it was recorded.
  static LiveState of(ModelPointer model, State state);

  /// Throws where another thread is stepping it.
  const State& state() const;
  /// To be changed: nobody else looks at it.
  State& own();
};

/// What a step tells, and its targets in words.
struct FullReport : StepReport {
  std::string targets;
};

/// A run in memory.
struct Run {
  ModelPointer model;
  runs::RunSummary summary;
  std::vector<io::RecordedStep> steps;
};

/// UTF-8 of a str. Throws Python's error where it has none.
std::string text_of(nb::handle value);
/// Threads that are asked for.
void require_threads(int threads, int least);

/// Makes a scene's tree from dicts, lists and plain values, and the other way round.
io::Node node_of(nb::handle value, int depth = 0);
nb::object object_of(const io::Node& node);

/// An array that keeps what it looks at, wherever it is returned from.
template <class Array>
struct Kept {
  Array array;
};
/// Rows as Python has them: (n, 3), (n,), read only.
using Rows = Kept<nb::ndarray<nb::numpy, const double, nb::ndim<2>>>;
using Numbers = Kept<nb::ndarray<nb::numpy, const double, nb::ndim<1>>>;
using Whole = Kept<nb::ndarray<nb::numpy, const std::int32_t, nb::ndim<2>>>;
using WholeNumbers = Kept<nb::ndarray<nb::numpy, const std::int32_t, nb::ndim<1>>>;

template <class T>
nb::capsule keep(std::shared_ptr<T> owner) {
  return nb::capsule(new std::shared_ptr<T>(std::move(owner)),
                     [](void* own) noexcept { delete static_cast<std::shared_ptr<T>*>(own); });
}
/// The columns of a matrix are rows here.
template <class Matrix, class T>
Rows columns_of(const Matrix& matrix, std::shared_ptr<T> owner) {
  return {{matrix.data(),
           {static_cast<std::size_t>(matrix.cols()), static_cast<std::size_t>(matrix.rows())},
           keep(std::move(owner))}};
}
template <class T>
Numbers numbers_of(const double* data, Eigen::Index size, std::shared_ptr<T> owner) {
  return {{data, {static_cast<std::size_t>(size)}, keep(std::move(owner))}};
}
/// Arrays of their own.
Rows matrix_of(const Eigen::MatrixXd& matrix);
Numbers vector_of(std::vector<double> numbers);
WholeNumbers vector_of(std::vector<std::int32_t> numbers);
Numbers vector_of(const Eigen::VectorXd& numbers);

/// A number, or text with a unit.
double number_of(nb::handle value, io::Dimension dimension, const std::string& path);
/// Throws InputError with the nearest of the known names.
std::size_t place_of(const std::string& name, const std::vector<std::string>& known, const std::string& group);

std::vector<std::string> names_of(const auto& objects) {
  std::vector<std::string> names;
  for (const auto& own : objects) names.push_back(own.name);
  return names;
}
std::vector<std::string> effector_names(const Model& model);

void bind_models(nb::module_& module);
void bind_states(nb::module_& module);
void bind_steps(nb::module_& module);
void bind_runs(nb::module_& module);
void bind_inverse(nb::module_& module);
void bind_snapshots(nb::module_& module);

}  // namespace sinew::python

/// Arrays that have an owner need no other, whatever the policy of what returns them.
template <class Array>
struct nanobind::detail::type_caster<sinew::python::Kept<Array>> {
  NB_TYPE_CASTER(sinew::python::Kept<Array>, make_caster<Array>::Name)
  bool from_python(handle, std::uint8_t, cleanup_list*) { return false; }
  static handle from_cpp(const sinew::python::Kept<Array>& value, rv_policy, cleanup_list* cleanup) {
    return make_caster<Array>::from_cpp(value.array, rv_policy::automatic, cleanup);
  }
};
