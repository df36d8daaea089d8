// What the static bend of a block costs, size by size, against one sparse factorisation of the matrices it is made of.
// README.md of this folder says how to run it and what was measured.
#include <fmt/format.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "cholmod.hpp"
#include "sinew/sim/free_motion.hpp"
#include "sinew/sim/run.hpp"
#include "sinew/sim/solid_matrix.hpp"
#include "support/meshes.hpp"

namespace sinew {
namespace {

using Matrix = linalg::SparseFactor::Matrix;
using solid::Kind;

const Vec3 kSize(0.05, 0.01, 0.01);  ///< [m]
constexpr double kForce = 0.16;      ///< [N] bends it by about a quarter of its length
constexpr int kThreads = 2;          ///< of the run; factorisations are timed on one
constexpr double kLimit = 1.5;       ///< how much a ratio may grow from the smallest block to the largest

/// Everything measured of one block.
struct Row {
  int cells = 0, unknowns = 0, steps = 0, factorisations = 0;
  double bend = 0.0;                                ///< of the tip over the length
  double build = 0.0, run = 0.0;                    ///< [s]
  double built = 0.0, peak = 0.0;                   ///< [MB] largest resident memory until then
  double own = 0.0, cholmod = 0.0;                  ///< [s] one numeric factorisation
  double own_entries = 0.0, cholmod_entries = 0.0;  ///< of the factor
  double own_memory = 0.0, cholmod_memory = 0.0;    ///< [MB] of the factor
  double time_ratio() const { return run / (factorisations * own); }
  double reference_ratio() const { return run / (factorisations * cholmod); }
  double memory_ratio() const { return peak / own_memory; }
};

double now() { return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count(); }

double peak_memory() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) * 1024e-6;
}

double median(std::vector<double> values) {
  std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2), values.end());
  return values[values.size() / 2];
}

/// About so many tetrahedra, as thick as they are long.
solid::Mesh block(Kind kind, int cells) {
  const auto n = static_cast<int>(std::lround(std::cbrt(cells / 30.0)));
  const auto nx = static_cast<int>(std::lround(cells / (6.0 * n * n)));
  return test::block_mesh(nx, n, n, kSize, kind);
}

Scene bent_block() {
  Scene scene;
  scene.analysis = Analysis::statics;
  Solid solid;
  solid.mesh = "block";
  solid.material.law = solid::corotational(600e3, 0.45);
  solid.density = 1000.0;
  solid.fixed.push_back({Plane{Vec3::Zero(), Vec3::UnitX()}});
  scene.solids.emplace_back("block", solid);
  scene.loads.emplace_back("tip", SolidLoad{"block", Plane{kSize, Vec3::UnitX()}, Vec3(0, 0, kForce)});
  return scene;
}

/// One numeric factorisation of a matrix as it was put together, by the engine and by CHOLMOD, in turns.
void factorise(linalg::SparseFactor& own, Row& row) {
  const Matrix A = own.assembled();
  Cholmod cholmod(A);
  std::vector<double> ours, theirs;
  double spent = 0.0;
  while (ours.size() < 3 || (ours.size() < 25 && spent < 2.0)) {
    const double start = now();
    if (!own.factor()) throw std::runtime_error("singular");
    const double middle = now();
    if (!cholmod.factor()) throw std::runtime_error("not positive definite");
    const double end = now();
    ours.push_back(middle - start);
    theirs.push_back(end - middle);
    spent += end - start;
  }
  row.own = median(ours);
  row.cholmod = median(theirs);
  row.own_entries = static_cast<double>(own.entries());
  row.own_memory = 1e-6 * sizeof(double) * static_cast<double>(own.plan().panels);
  row.cholmod_entries = cholmod.entries();
  row.cholmod_memory = 1e-6 * cholmod.memory();
}

Row measure(Kind kind, int cells) {
  Row row;
  double start = now();
  const Model model = build(bent_block(), [&](const auto&) { return block(kind, cells); });
  row.build = now() - start;
  row.built = peak_memory();
  const solid::Body& body = model.solids[0].body;
  row.cells = body.elements();
  row.unknowns = body.unknowns;

  State last = initial_state(model);
  start = now();
  const RunEnd end = run(
      model, last,
      [&](const State& state, const StepReport& report) {
        last = state;
        row.factorisations += report.newton + (row.steps > 0 ? 1 : 0);  // one more for the direction of the path
        ++row.steps;
        return true;
      },
      nullptr, kThreads);
  row.run = now() - start;
  row.peak = peak_memory();
  if (end != RunEnd::done) throw std::runtime_error("the run stopped");
  const Eigen::Matrix3Xd moved = last.solids[0].x - body.rest;
  row.bend = moved.row(2).maxCoeff() / kSize.x();

  linalg::SparseFactor factor(model.solids[0].fronts);
  const StepContext context = make_context(model, last, command_at(model, last.time), 1.0);
  assemble(model.solids[0], context.start_of(0), last.solids[0].x, solid::Tangent::exact, factor.values());
  factorise(factor, row);
  return row;
}

/// In a process of its own, so that memory is that of this block alone.
std::optional<Row> measure_apart(Kind kind, int cells) {
  int ends[2];
  if (pipe(ends) != 0) return {};
  const pid_t child = fork();
  if (child < 0) return {};
  if (child == 0) {
    try {
      const Row row = measure(kind, cells);
      _exit(write(ends[1], &row, sizeof row) == sizeof row ? 0 : 1);
    } catch (const std::exception& error) {
      fmt::print(stderr, "{}\n", error.what());
      _exit(1);
    }
  }
  close(ends[1]);
  Row row;
  const bool whole = read(ends[0], &row, sizeof row) == sizeof row;
  close(ends[0]);
  int status = 0;
  waitpid(child, &status, 0);
  if (!whole || status != 0) return {};
  return row;
}

struct Column {
  const char* name;
  std::string (*text)(const Row&);
};

const Column kColumns[] = {
    {"cells", [](const Row& row) { return std::to_string(row.cells); }},
    {"unknowns", [](const Row& row) { return std::to_string(row.unknowns); }},
    {"bend / length", [](const Row& row) { return fmt::format("{:.2f}", row.bend); }},
    {"steps", [](const Row& row) { return std::to_string(row.steps); }},
    {"factorisations", [](const Row& row) { return std::to_string(row.factorisations); }},
    {"build [s]", [](const Row& row) { return fmt::format("{:.2f}", row.build); }},
    {"run [s]", [](const Row& row) { return fmt::format("{:.2f}", row.run); }},
    {"one factorisation [s]", [](const Row& row) { return fmt::format("{:.4f}", row.own); }},
    {"CHOLMOD [s]", [](const Row& row) { return fmt::format("{:.4f}", row.cholmod); }},
    {"run / all factorisations", [](const Row& row) { return fmt::format("{:.2f}", row.time_ratio()); }},
    {"run / CHOLMOD's", [](const Row& row) { return fmt::format("{:.2f}", row.reference_ratio()); }},
    {"factor [M entries]", [](const Row& row) { return fmt::format("{:.2f}", 1e-6 * row.own_entries); }},
    {"CHOLMOD's", [](const Row& row) { return fmt::format("{:.2f}", 1e-6 * row.cholmod_entries); }},
    {"factor [MB]", [](const Row& row) { return fmt::format("{:.1f}", row.own_memory); }},
    {"CHOLMOD's [MB]", [](const Row& row) { return fmt::format("{:.1f}", row.cholmod_memory); }},
    {"built [MB]", [](const Row& row) { return fmt::format("{:.0f}", row.built); }},
    {"peak [MB]", [](const Row& row) { return fmt::format("{:.0f}", row.peak); }},
    {"peak / factor", [](const Row& row) { return fmt::format("{:.2f}", row.memory_ratio()); }},
    {"peak / CHOLMOD's factor", [](const Row& row) { return fmt::format("{:.2f}", row.peak / row.cholmod_memory); }},
};

/// Measures and prints blocks of one kind; false where a ratio grows, or a run fails.
bool report(Kind kind, const std::vector<int>& sizes, int most) {
  fmt::print("\n### {}\n\n", solid::plural(kind));
  for (const Column& column : kColumns) fmt::print("| {} ", column.name);
  fmt::print("|\n");
  for ([[maybe_unused]] const Column& column : kColumns) fmt::print("|---");
  fmt::print("|\n");
  std::vector<Row> rows;
  for (const int cells : sizes) {
    if (cells > most) continue;
    const std::optional<Row> measured = measure_apart(kind, cells);
    if (!measured) return false;
    rows.push_back(*measured);
    for (const Column& column : kColumns) fmt::print("| {} ", column.text(rows.back()));
    fmt::print("|\n");
    std::fflush(stdout);
  }
  if (rows.size() < 2) return true;
  const double time = rows.back().time_ratio() / rows.front().time_ratio();
  const double memory = rows.back().memory_ratio() / rows.front().memory_ratio();
  const double reference = rows.back().reference_ratio() / rows.front().reference_ratio();
  const bool kept = time <= kLimit && memory <= kLimit;
  fmt::print(
      "\nFrom the smallest to the largest, run / all factorisations grows by {:.2f} and peak / factor by {:.2f}: at "
      "most {} {}. Against CHOLMOD's factorisations the run grows by {:.2f}.\n",
      time, memory, kLimit, kept ? "kept" : "BROKEN", reference);
  return kept;
}

}  // namespace
}  // namespace sinew

/// solid_bench [N]: blocks of at most N cells.
int main(int argc, char** argv) {
  sinew::one_thread(argv);
  const int most = argc > 1 ? std::atoi(argv[1]) : 200000;
  const bool tet4 = sinew::report(sinew::Kind::tet4, {2000, 5000, 10000, 20000, 40000, 60000, 200000}, most);
  const bool tet10 = sinew::report(sinew::Kind::tet10, {2000, 10000}, most);
  return tet4 && tet10 ? 0 : 1;
}
