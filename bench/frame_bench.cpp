// What a frame of the page costs the simulation: made once for all pages, at most 120 times a second.
#include <benchmark/benchmark.h>

#include <nlohmann/json.hpp>

#include "sinew/live/scenery.hpp"
#include "sinew/runs/loaded_scene.hpp"
#include "sinew/sim/run.hpp"
#include "sinew/sim/signals.hpp"

namespace sinew {
namespace {

struct Watched {
  runs::LoadedScene loaded;
  State state;
  explicit Watched(const std::string& name)
      : loaded(runs::load(io::read_scene(SINEW_SOURCE_DIR "/examples/" + name + ".yaml"))),
        state(initial_state(loaded.model)) {
    Workspace workspace(loaded.model);
    while (state.grid < 5) advance(loaded.model, workspace, state);
  }
};

void frames(benchmark::State& run, const std::string& name, const live::Show& show) {
  Watched watched(name);
  live::Scenery scenery(watched.loaded.model);
  const Goal goal = goal_at(watched.loaded.model, watched.state.time);
  std::size_t bytes = 0;
  for (auto _ : run) {
    const std::string frame = scenery.frame(watched.state, show, goal, {});
    benchmark::DoNotOptimize(bytes = frame.size());
  }
  run.counters["bytes"] = static_cast<double>(bytes);
}

void signals(benchmark::State& run, const std::string& name) {
  Watched watched(name);
  for (auto _ : run) benchmark::DoNotOptimize(signal_values(watched.loaded.model, watched.state));
}

/// What it is to be measured by: a step of the same scene.
void steps(benchmark::State& run, const std::string& name) {
  Watched watched(name);
  Workspace workspace(watched.loaded.model);
  for (auto _ : run) advance(watched.loaded.model, workspace, watched.state);
}

BENCHMARK_CAPTURE(steps, trunk, "reach")->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(frames, trunk, "reach", {})->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(frames, trunk_stress, "reach", {{"von_mises"}, {"bending"}, false})->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(frames, trunk_energies, "reach", {{}, {}, true})->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(signals, trunk, "reach")->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(steps, grasper, "grasper")->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(frames, grasper, "grasper", {})->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace sinew

BENCHMARK_MAIN();
