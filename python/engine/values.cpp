// Python's values and the engine's.
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include <algorithm>
#include <charconv>
#include <cmath>

#include "engine.hpp"
#include "sinew/error/input_error.hpp"
#include "sinew/io/fields.hpp"
#include "sinew/io/nearest.hpp"
#include "sinew/threads/crew.hpp"

namespace sinew::python {

std::string text_of(nb::handle value) {
  Py_ssize_t size = 0;
  const char* text = PyUnicode_AsUTF8AndSize(value.ptr(), &size);
  if (!text) throw nb::python_error();
  return {text, static_cast<std::size_t>(size)};
}

void require_threads(int threads, int least) {
  if (threads < least || threads > threads::Crew::kMost)
    throw InputError({.path = "threads",
                      .value = std::to_string(threads),
                      .rule = fmt::format("must be from {} to {}", least, threads::Crew::kMost)});
}

io::Node node_of(nb::handle value, int depth) {
  if (depth > io::deepest_document)
    throw InputError({.rule = fmt::format("the scene is nested more than {} levels deep", io::deepest_document)});
  io::Node node;
  if (value.is_none()) return node;
  if (nb::isinstance<nb::dict>(value)) {
    node.kind = io::Node::Kind::map;
    for (const auto& [key, own] : nb::borrow<nb::dict>(value))
      node.entries.push_back({text_of(nb::str(key)), 0, node_of(own, depth + 1)});
    return node;
  }
  if (nb::isinstance<nb::list>(value) || nb::isinstance<nb::tuple>(value)) {
    node.kind = io::Node::Kind::list;
    for (const nb::handle own : nb::borrow(value)) node.items.push_back(node_of(own, depth + 1));
    return node;
  }
  node.kind = io::Node::Kind::scalar;
  node.text = nb::isinstance<nb::bool_>(value)    ? (nb::cast<bool>(value) ? "true" : "false")
              : nb::isinstance<nb::float_>(value) ? text_of(nb::repr(value))
                                                  : text_of(nb::str(value));
  return node;
}

nb::object object_of(const io::Node& node) {
  switch (node.kind) {
    case io::Node::Kind::empty:
      return nb::none();
    case io::Node::Kind::map: {
      nb::dict all;
      for (const io::Entry& entry : node.entries) all[entry.key.c_str()] = object_of(entry.value);
      return all;
    }
    case io::Node::Kind::list: {
      nb::list all;
      for (const io::Node& item : node.items) all.append(object_of(item));
      return all;
    }
    case io::Node::Kind::scalar:
      break;
  }
  // Numbers only where Python writes them the same: a name such as 007 or 1e5 stays what it is.
  if (node.text == "true" || node.text == "false") return nb::cast(node.text == "true");
  const char* const end = node.text.data() + node.text.size();
  const auto same = [&node](const nb::object& value) { return text_of(nb::repr(value)) == node.text; };
  std::int64_t whole = 0;
  if (const auto read = std::from_chars(node.text.data(), end, whole); read.ec == std::errc() && read.ptr == end) {
    if (nb::object value = nb::cast(whole); same(value)) return value;
  }
  double real = 0.0;
  if (const auto read = std::from_chars(node.text.data(), end, real); read.ec == std::errc() && read.ptr == end) {
    if (nb::object value = nb::cast(real); same(value)) return value;
  }
  return nb::cast(node.text);
}

Rows matrix_of(const Eigen::MatrixXd& matrix) {
  using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  auto own = std::make_shared<const RowMajor>(matrix);
  return {{own->data(), {static_cast<std::size_t>(own->rows()), static_cast<std::size_t>(own->cols())}, keep(own)}};
}

Numbers vector_of(std::vector<double> numbers) {
  auto own = std::make_shared<const std::vector<double>>(std::move(numbers));
  return numbers_of(own->data(), static_cast<Eigen::Index>(own->size()), own);
}
WholeNumbers vector_of(std::vector<std::int32_t> numbers) {
  auto own = std::make_shared<const std::vector<std::int32_t>>(std::move(numbers));
  return {{own->data(), {own->size()}, keep(own)}};
}
Numbers vector_of(const Eigen::VectorXd& numbers) {
  return vector_of(std::vector<double>(numbers.begin(), numbers.end()));
}

double number_of(nb::handle value, io::Dimension dimension, const std::string& path) {
  double number = 0.0;
  if (nb::isinstance<nb::str>(value)) {
    try {
      number = io::parse_quantity(text_of(value), dimension);
    } catch (const InputError& error) {
      InputFault fault = error.fault();
      fault.path = path;
      throw InputError(fault);
    }
  } else {
    if (PyComplex_Check(value.ptr())) throw nb::type_error((path + ": must be a real number").c_str());
    number = PyFloat_AsDouble(value.ptr());
    if (number == -1.0 && PyErr_Occurred()) {
      PyErr_Clear();
      throw nb::type_error(
          fmt::format("{}: must be a number, or text with a unit, not {}", path, text_of(nb::repr(value))).c_str());
    }
  }
  if (!std::isfinite(number))
    throw InputError({.path = path, .value = fmt::format("{}", number), .rule = "must be finite"});
  return number;
}

std::size_t place_of(const std::string& name, const std::vector<std::string>& known, const std::string& group) {
  const auto found = std::find(known.begin(), known.end(), name);
  if (found != known.end()) return static_cast<std::size_t>(found - known.begin());
  const std::string near = io::nearest(name, known);
  throw InputError(
      {.path = group + "." + io::show(name),
       .rule = "does not exist in this scene",
       .remedy = (near.empty() ? "" : "did you mean `" + near + "`? ") +
                 (known.empty() ? "it has no " + group : fmt::format("known: {}", fmt::join(known, ", ")))});
}

std::vector<std::string> effector_names(const Model& model) {
  std::vector<std::string> names;
  for (const EffectorModel& own : model.effectors) names.push_back(model.outputs[own.output].name);
  return names;
}

}  // namespace sinew::python
