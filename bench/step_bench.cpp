// What a whole time step costs, beside one numeric factorisation of its matrix by CHOLMOD in the same process.
// README.md of this folder says how to run it and what was measured.
#include <fmt/format.h>
#include <malloc.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <functional>
#include <limits>
#include <numbers>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "cholmod.hpp"
#include "sinew/io/mesh_file.hpp"
#include "sinew/linalg/kernels.hpp"
#include "sinew/sim/free_motion.hpp"
#include "sinew/sim/run.hpp"
#include "sinew/sim/solid_matrix.hpp"
#include "support/robots.hpp"

namespace sinew {
namespace {

using test::block;
using test::block_of;
using test::finger;
using test::trunk;

double now() {
  return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

struct Measured {
  int cells = 0, unknowns = 0, rows = 0;
  double step = std::numeric_limits<double>::infinity(), two = step, reference = step;  ///< [ms], smallest
  StageTimes stages;                                                                    ///< [s] of the fastest step
};

/// Whole steps from the same few states and factorisations of their matrix, in turns.
Measured measure(const Model& model, int turns) {
  Measured result;
  Workspace workspace = make_workspace(model), shared = make_workspace(model, 2);
  State state = initial_state(model);
  for (int i = 0; i < 10; ++i) {  // away from rest
    if (!accepted(advance(model, workspace, state).status)) throw std::runtime_error("the run stopped");
  }
  const StepContext context = make_context(model, state, command_at(model, state.time), model.scene.time.step);
  linalg::SparseFactor factor(model.solids[0].fronts);
  assemble(model.solids[0], context.solids[0], state.solids[0].x, solid::Tangent::definite, factor.values());
  const linalg::SparseFactor::Matrix A = factor.assembled();
  Cholmod reference(A, Cholmod::Ordering::metis);
  result.cells = model.solids[0].body.elements();
  result.unknowns = model.solids[0].body.unknowns;
  result.rows = model.rows;
  State again = state;
  for (int i = 0; i < turns; ++i) {
    again = state;
    const double start = now();
    const StepReport report = advance(model, workspace, again, Evaluation::motion);
    const double middle = now();
    if (!accepted(report.status)) throw std::runtime_error("the run stopped");
    if (!reference.factor()) throw std::runtime_error("not positive definite");
    const double end = now();
    if (middle - start < result.step) result.stages = report.times;
    result.step = std::min(result.step, middle - start);
    result.reference = std::min(result.reference, end - middle);
  }
  for (int i = 0; i < turns; ++i) {
    again = state;
    const double before = now();
    advance(model, shared, again, Evaluation::motion);
    result.two = std::min(result.two, now() - before);
  }
  return result;
}

void print(const std::string& name, const Measured& own) {
  const StageTimes& t = own.stages;
  fmt::print(
      "| {} | {} | {} | {} | {:.3f} | {:.3f} | {:.2f} | {:.3f} | {:.2f} | {:.3f} | {:.3f} | {:.3f} | {:.3f} | {:.3f} | "
      "{:.3f} |\n",
      name, own.cells, own.unknowns, own.rows, own.step, own.reference, own.step / own.reference, own.two,
      own.step / own.two, 1e3 * t.forces, 1e3 * t.assembly, 1e3 * t.factor, 1e3 * t.compliance, 1e3 * t.rods,
      1e3 * t.solve);
  std::fflush(stdout);
}

int run_all(const std::filesystem::path& meshes, const std::string& wanted, int turns) {
  fmt::print("Registers: {}. Smallest of {} turns, ms.\n\n", linalg::kernels().name, turns);
  fmt::print(
      "| scene | cells | unknowns | rows | step | R | step / R | 2 threads | faster | forces | assembly | factor | W | "
      "rods | border |\n");
  fmt::print("|---|---|---|---|---|---|---|---|---|---|---|---|---|---|---|\n");
  const auto go = [&](const std::string& name, const auto& model, int count) {
    if (name.find(wanted) == std::string::npos) return;
    print(name, measure(model(), count));
  };
  if (std::filesystem::exists(meshes / "trunk.vtk")) {
    go(
        "finger, 7 points", [&] { return build(finger(meshes, 6, 7, Cable::cosserat), io::read_mesh); }, turns);
    go(
        "finger, 15 points", [&] { return build(finger(meshes, 15, 15, Cable::cosserat), io::read_mesh); }, turns);
    go(
        "finger, geometric", [&] { return build(finger(meshes, 1, 15, Cable::geometric), io::read_mesh); }, turns);
    go(
        "trunk, 10 points", [&] { return build(trunk(meshes, 10), io::read_mesh); }, turns);
    go(
        "trunk, 21 points", [&] { return build(trunk(meshes, 21), io::read_mesh); }, turns);
  } else {
    fmt::print(stderr, "No finger.vtk and trunk.vtk in {}: give their folder\n", meshes.string());
  }
  for (const int thousands : {8, 32, 128})
    go(
        fmt::format("block, {} k", thousands), [&] { return build(block(), block_of(1000 * thousands)); },
        std::max(5, turns * 4 / thousands));
  return 0;
}

}  // namespace
}  // namespace sinew

int main(int argc, char** argv) {
  sinew::one_thread(argv);
  // Memory that is given back stays in the process: neither side pays for fresh pages in every turn.
  mallopt(M_MMAP_THRESHOLD, 1 << 30);
  mallopt(M_TRIM_THRESHOLD, std::numeric_limits<int>::max());
  const std::string meshes = argc > 1 ? argv[1] : SINEW_SHARED_MESHES, wanted = argc > 2 ? argv[2] : "";
  try {
    return sinew::run_all(meshes, wanted, argc > 3 ? std::atoi(argv[3]) : 200);
  } catch (const std::exception& error) {
    fmt::print(stderr, "step_bench: {}\n", error.what());
    return 1;
  }
}
