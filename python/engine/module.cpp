// sinew._engine: the engine as the package `sinew` sees it.
#include <nanobind/stl/string.h>

#include "engine.hpp"
#include "sinew/error/input_error.hpp"
#include "sinew/io/append_file.hpp"

namespace {

namespace nb = nanobind;

/// `sinew.errors.InputError` with the message's parts.
void raise(const sinew::InputFault& fault, const char* what) {
  const nb::object type = nb::module_::import_("sinew.errors").attr("InputError");
  const nb::object error = type(what, fault.file, fault.line, fault.path, fault.value, fault.rule, fault.remedy);
  PyErr_SetObject(type.ptr(), error.ptr());
}

}  // namespace

NB_MODULE(_engine, module) {
  module.doc() = "The engine, in C++. Use the package `sinew`.";
  module.attr("version") = SINEW_VERSION;
  nb::register_exception_translator([](const std::exception_ptr& thrown, void*) {
    try {
      std::rethrow_exception(thrown);
    } catch (const sinew::InputError& error) {
      raise(error.fault(), error.what());
    } catch (const sinew::io::WriteError& error) {
      PyErr_SetString(PyExc_OSError, error.what());
    }
  });
  sinew::python::bind_snapshots(module);
  sinew::python::bind_models(module);
  sinew::python::bind_states(module);
  sinew::python::bind_steps(module);
  sinew::python::bind_runs(module);
  sinew::python::bind_inverse(module);
}
