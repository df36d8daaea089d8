#include "sinew/io/samples.hpp"

#include <fmt/format.h>
#include <muParser.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "sinew/io/csv_table.hpp"
#include "sinew/io/scene_values.hpp"

namespace sinew::io {
namespace {

using enum Need;

constexpr std::size_t kMostSteps = 1'000'000, kLongestFormula = 2000;

struct FileTable {
  std::string file, time = "time";
  std::vector<std::string> columns;
};

struct Formula {
  std::vector<std::string> text;
};

/// One text, or one for each component.
Type<std::vector<std::string>> texts(std::size_t components, const std::string& what) {
  const Type<std::string> one = text();
  if (components > 1) return list<std::string>(what, one, {components, components});
  return {[=](const At& at) { return std::vector<std::string>{one.read(at)}; }, one.schema};
}

Type<FileTable> file_table(std::size_t components) {
  const bool several = components > 1;
  return map<FileTable>(
      {"a table in a file",
       {field<FileTable>({"file", required, "a CSV file whose first row names its columns, from the scene's folder",
                          "out/signals.csv"},
                         &FileTable::file, text()),
        field<FileTable>({several ? "columns" : "column", required,
                          several ? "the columns of x, y and z, in SI units" : "the column of the values, in SI units",
                          several ? "[tip.x, tip.y, tip.z]" : "pull.force"},
                         &FileTable::columns, texts(components, "names of columns")),
        field<FileTable>(
            {"time", optional, "the column of the times [s]", "time"}, &FileTable::time,
            Type<std::string>{text().read, text().schema, [](const std::string& t) { return Json(t); }})}});
}

Type<Formula> formula(std::size_t components) {
  return map<Formula>(
      {"a formula",
       {field<Formula>({"formula", required,
                        components > 1 ? "the values [x, y, z] in SI units, as formulas of the time t [s]"
                                       : "the value in SI units as a formula of the time t [s]",
                        components > 1 ? "[0.1, 0.02 * sin(2 * pi * t), 0]" : "0.01 * sin(2 * pi * t)"},
                       &Formula::text, texts(components, "formulas [x, y, z]"))}});
}

Samples from_file(const At& at, std::size_t components) {
  const FileTable table = file_table(components).read(at);
  std::vector<std::string> columns = {table.time};
  columns.insert(columns.end(), table.columns.begin(), table.columns.end());
  const std::filesystem::path path = at.use(table.file);
  if (std::error_code unknown; !std::filesystem::exists(path, unknown))
    at.child("file").refuse("does not exist as " + path.string(), "paths are relative to the folder of the scene");
  auto values = read_csv(path, columns);
  Samples own{std::move(values[0]),
              {std::make_move_iterator(values.begin() + 1), std::make_move_iterator(values.end())}};
  if (own.times.empty()) at.child("file").refuse("has no row of numbers", "add one for each time");
  for (std::size_t i = 1; i < own.times.size(); ++i) {
    if (!(own.times[i] > own.times[i - 1]))
      at.child("file").refuse(fmt::format("has times that do not ascend: {} s after {} s, in row {} of numbers",
                                          own.times[i], own.times[i - 1], i + 1),
                              "sort its rows by time, one for each");
  }
  return own;
}

/// The times of the scene's steps, and of quarters of them: what a formula does within a step is known then.
std::vector<double> grid(const At& at) {
  constexpr double kParts = 4.0;  // a power of two, so that every fourth time is that of a step to the bit
  const Time time = time_of_run(at);
  const double steps = std::ceil(time.duration / time.step - 1e-6);
  if (!(steps < static_cast<double>(kMostSteps)))
    at.refuse("needs too many values over the run's time", "take a longer `time.step` or a shorter duration");
  std::vector<double> times;
  for (double i = 0.0; i <= kParts * steps; ++i) times.push_back(i * (time.step / kParts));
  return times;
}

Samples from_formula(const At& at, std::size_t components) {
  const Formula own = formula(components).read(at);
  Samples result{grid(at), {}};
  for (std::size_t k = 0; k < components; ++k) {
    const At place = components > 1 ? at.child("formula").item(k) : at.child("formula");
    if (own.text[k].size() > kLongestFormula) place.refuse("is too long", "give a table in a file");
    std::vector<double>& values = result.values.emplace_back();
    try {
      double t = 0.0;
      mu::Parser parser;
      parser.DefineConst("pi", std::numbers::pi);
      parser.DefineVar("t", &t);
      parser.SetExpr(own.text[k]);
      for (const double time : result.times) {
        t = time;
        values.push_back(parser.Eval());
      }
    } catch (const mu::Parser::exception_type& error) {
      place.refuse("is not a formula of t: " + error.GetMsg(),
                   "for example `0.01 * sin(2 * pi * t)`; known are + - * / ^, pi, min, max, abs, sign, sqrt, exp, ln, "
                   "log10, sin, cos, tan, asin, acos, atan, sinh, cosh, tanh, and `t < 1 ? a : b`");
    }
    const auto bad = std::find_if_not(values.begin(), values.end(), [](double v) { return std::isfinite(v); });
    if (bad != values.end())
      place.refuse(fmt::format("has no finite value at t = {} s", result.times[bad - values.begin()]),
                   "look for divisions by 0 and roots of negative numbers");
  }
  return result;
}

}  // namespace

std::optional<Samples> samples(const At& at, std::size_t components) {
  if (!at.is(Node::Kind::map)) return {};
  if (at.has("file")) return from_file(at, components);
  if (at.has("formula")) return from_formula(at, components);
  return {};
}

Json samples_schema(std::size_t components) {
  return any_of({file_table(components).schema(), formula(components).schema()});
}

}  // namespace sinew::io
