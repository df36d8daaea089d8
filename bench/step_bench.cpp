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
#include <list>
#include <numbers>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "cholmod.hpp"
#include "sinew/io/mesh_file.hpp"
#include "sinew/io/scene_file.hpp"
#include "sinew/linalg/kernels.hpp"
#include "sinew/sim/inverse.hpp"
#include "sinew/sim/places.hpp"
#include "sinew/sim/run.hpp"
#include "sinew/sim/solid_matrix.hpp"
#include "sinew/sim/step_context.hpp"
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

constexpr double kNever = std::numeric_limits<double>::infinity();

struct Measured {
  int cells = 0, unknowns = 0, rows = 0;
  int turns = 0;
  double step = kNever, two = kNever, single = kNever, inverse = kNever, reference = kNever;  ///< [ms], smallest
  StageTimes stages;  ///< [s] of the fastest step
};

/// A state away from rest.
State under_way(const Model& model, Workspace& workspace, int steps = 10) {
  State state = initial_state(model);
  for (int i = 0; i < steps; ++i) {
    if (!accepted(advance(model, workspace, state).status)) throw std::runtime_error("the run stopped");
  }
  return state;
}

/// Times the second of two steps, which starts where the first ended, as in a run; something else comes between them.
template <class Between, class Work>
double timed(const State& from, State& state, const Between& between, const Work& work) {
  const auto go = [&] {
    if (!accepted(work(state).status)) throw std::runtime_error("the run stopped");
  };
  state = from;
  go();
  between();
  const double start = now();
  go();
  return now() - start;
}
void nothing() {}

linalg::SparseFactor::Matrix matrix_of(const Model& model, const State& state, int solid = 0) {
  const StepContext context = make_context(model, state, command_at(model, state.time), model.scene.time.step);
  linalg::SparseFactor factor(model.solids[solid].fronts);
  assemble(model.solids[solid], context.start_of(solid), state.solids[solid].x, solid::Tangent::definite,
           factor.values());
  return factor.assembled();
}

/// Of this many tetrahedra factors in single precision are worth a try.
constexpr int kLarge = 5000;

/// Whole steps from the same state and factorisations of its matrix, in turns; then steps of two threads, in single
/// precision and inverse ones.
Measured measure(const Scene& scene, const Vec3& tip, const MeshReader& meshes, int turns) {
  Measured result;
  const Model model = build(scene, meshes);
  Workspace workspace = make_workspace(model);
  const State state = under_way(model, workspace);
  State again = state;
  const linalg::SparseFactor::Matrix A = matrix_of(model, state);
  Cholmod reference(A, Cholmod::Ordering::metis);
  result.cells = model.solids[0].body.elements();
  result.unknowns = model.solids[0].body.unknowns;
  result.rows = model.rows;
  result.turns = turns;
  const auto factor = [&] {
    const double start = now();
    if (!reference.factor()) throw std::runtime_error("not positive definite");
    result.reference = std::min(result.reference, now() - start);
  };
  for (int i = 0; i < turns; ++i) {
    StepReport report;
    const double own = timed(state, again, factor,
                             [&](State& at) { return report = advance(model, workspace, at, {Evaluation::motion}); });
    if (own < result.step) result.stages = report.times;
    result.step = std::min(result.step, own);
  }
  Workspace shared = make_workspace(model, 2);
  for (int i = 0; i < turns; ++i)
    result.two = std::min(result.two, timed(state, again, nothing, [&](State& at) {
                            return advance(model, shared, at, {Evaluation::motion});
                          }));
  if (result.cells >= kLarge) {
    Scene floats = scene;
    floats.newton.precision = linalg::Precision::float32;
    const Model small = build(floats, meshes);
    Workspace own = make_workspace(small);
    for (int i = 0; i < turns; ++i)
      result.single = std::min(result.single, timed(state, again, nothing, [&](State& at) {
                                 return advance(small, own, at, {Evaluation::motion});
                               }));
  }
  if (scene.rods[0].second.cable == Cable::geometric) return result;
  Scene pulled = scene;
  test::add_target(pulled, tip, 10.0);
  const Model inverse = build(pulled, meshes);
  Workspace own = make_workspace(inverse);
  State start = initial_state(inverse);
  const Command hold{std::vector<double>(inverse.actuators.size(), 0.1), {}};
  for (int i = 0; i < 10; ++i) {
    if (!accepted(step(inverse, own, hold, scene.time.step, start).status)) throw std::runtime_error("the run stopped");
  }
  const Goal goal = {output_position(inverse, start, inverse.outputs[0]) + Vec3(0, 0.1e-3, -0.1e-3)};
  for (int i = 0; i < turns; ++i)
    result.inverse =
        std::min(result.inverse, timed(start, again, factor, [&](State& at) {
                   return inverse_step(inverse, own, goal, hold, scene.time.step, at, {Evaluation::motion});
                 }));
  return result;
}

void print(const std::string& name, const Measured& own) {
  const StageTimes& t = own.stages;
  const auto beside = [&own](double time) {
    return time < kNever ? fmt::format("{:.3f} | {:.2f}", time, time / own.reference) : std::string(" | ");
  };
  fmt::print(
      "| {} | {} | {} | {} | {} | {:.3f} | {} | {} | {:.3f} | {:.2f} | {} | {:.3f} | {:.3f} | {:.3f} | {:.3f} | "
      "{:.3f} |\n",
      name, own.cells, own.unknowns, own.rows, own.turns, own.reference, beside(own.step), beside(own.inverse), own.two,
      own.step / own.two, beside(own.single), 1e3 * t.forces, 1e3 * t.assembly, 1e3 * (t.factor + t.compliance),
      1e3 * t.rods, 1e3 * t.solve);
  std::fflush(stdout);
}

/// The example's grasper while it holds the cube, beside the factorisations of its three fingers.
void grasper(int turns) {
  const Model model =
      build(io::read_scene(std::filesystem::path(SINEW_EXAMPLES) / "grasper.yaml").scene, io::read_mesh);
  Workspace workspace = make_workspace(model);
  const State state = under_way(model, workspace, 400);
  State again = state;
  std::list<linalg::SparseFactor::Matrix> matrices;
  std::list<Cholmod> references;
  for (int i = 0; i < static_cast<int>(model.solids.size()); ++i)
    references.emplace_back(matrices.emplace_back(matrix_of(model, state, i)), Cholmod::Ordering::metis);
  double step = kNever, two = kNever, reference = kNever;
  std::vector<double> all;
  StepReport report;
  Workspace shared = make_workspace(model, 2);
  for (int i = 0; i < turns; ++i) {
    all.push_back(timed(state, again, nothing, [&](State& at) { return report = advance(model, workspace, at); }));
    step = std::min(step, all.back());
    two = std::min(two, timed(state, again, nothing, [&](State& at) { return advance(model, shared, at); }));
    const double start = now();
    for (Cholmod& own : references) {
      if (!own.factor()) throw std::runtime_error("not positive definite");
    }
    reference = std::min(reference, now() - start);
  }
  std::nth_element(all.begin(), all.begin() + turns / 2, all.end());
  fmt::print(
      "\nThe example's grasper at 4 s, holding its cube: {} contacts, {} sections, {} rows. Step {:.2f} ms (median "
      "{:.2f}; "
      "contact {:.2f}), on two threads {:.2f} ms; the three factorisations {:.2f} ms. The paper's grasper took 35.97 "
      "ms, "
      "SOFA's 14.9 to 19 ms.\n",
      report.contact.contacts, 45, model.rows, step, all[static_cast<std::size_t>(turns / 2)],
      1e3 * report.times.contact, two, reference);
}

/// `most`: turns of the largest.
int run_all(const std::filesystem::path& meshes, const std::string& wanted, int turns, int most) {
  fmt::print("Registers: {}. Smallest of all turns, ms.\n\n", linalg::kernels().name);
  fmt::print(
      "| scene | cells | unknowns | rows | turns | R | step | step / R | inverse | inverse / R | 2 threads | faster | "
      "single | single / R | forces | assembly | factor, W | rods | border |\n");
  fmt::print("|---|---|---|---|---|---|---|---|---|---|---|---|---|---|---|---|---|---|---|\n");
  const auto go = [&](const std::string& name, const Scene& scene, const Vec3& tip, const MeshReader& reader,
                      int count) {
    if (name.find(wanted) != std::string::npos) print(name, measure(scene, tip, reader, count));
  };
  if (std::filesystem::exists(meshes / "trunk.vtk")) {
    const Vec3 finger_tip(-103e-3, 7e-3, 7e-3), trunk_tip(0, 0, 195e-3);
    go("finger, 7 points", finger(meshes, 6, 7, Cable::cosserat), finger_tip, io::read_mesh, turns);
    go("finger, 15 points", finger(meshes, 15, 15, Cable::cosserat), finger_tip, io::read_mesh, turns);
    go("finger, geometric", finger(meshes, 1, 15, Cable::geometric), finger_tip, io::read_mesh, turns);
    Scene rubber = finger(meshes, 6, 7, Cable::cosserat);
    for (auto& [name, solid] : rubber.solids) solid.material.law = solid::neo_hookean(600e3, 0.45);
    go("finger, neo-Hookean", rubber, finger_tip, io::read_mesh, turns);
    go("trunk, 10 points", trunk(meshes, 10), trunk_tip, io::read_mesh, turns);
    go("trunk, 21 points", trunk(meshes, 21), trunk_tip, io::read_mesh, turns);
  } else {
    fmt::print(stderr, "No finger.vtk and trunk.vtk in {}: give their folder\n", meshes.string());
  }
  for (const int thousands : {8, 32, 128})
    go(fmt::format("block, {} k", thousands), block(), Vec3(50e-3, 5e-3, 5e-3), block_of(1000 * thousands),
       thousands > 100 ? std::max(5, most) : turns);
  if (std::string("grasper").find(wanted) != std::string::npos) grasper(turns);
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
    const int turns = argc > 3 ? std::atoi(argv[3]) : 200;
    return sinew::run_all(meshes, wanted, turns, argc > 4 ? std::atoi(argv[4]) : turns / 20);
  } catch (const std::exception& error) {
    fmt::print(stderr, "step_bench: {}\n", error.what());
    return 1;
  }
}
