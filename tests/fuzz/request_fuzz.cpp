// libFuzzer target: whatever a page says, read_request makes a request of it that can be taken, or throws InputError
// with a rule. scripts/fuzz runs it.
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>

#include "sinew/error/input_error.hpp"
#include "sinew/live/stage.hpp"
#include "sinew/runs/loaded_scene.hpp"

namespace {

using namespace sinew;

[[noreturn]] void fail(const char* what, const std::string& text) {
  std::fprintf(stderr, "%s: %s\n", what, text.c_str());
  std::abort();
}

const Model& robot() {
  static const runs::LoadedScene loaded = runs::load(io::read_scene(SINEW_SOURCE_DIR "/examples/reach.yaml"));
  return loaded.model;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string text(reinterpret_cast<const char*>(data), size);
  static live::Wishes wishes;  // what everyone before has wished for is still there
  try {
    live::take(live::read_request(text, robot()), wishes);
  } catch (const InputError& error) {
    if (error.fault().rule.empty()) fail("no rule", error.what());
    return 0;
  }
  for (const auto& [actuator, value] : wishes.told) {
    if (actuator < 0 || actuator >= 4 || !std::isfinite(value)) fail("told", text);
  }
  for (const auto& [effector, at] : wishes.aimed) {
    if (effector != 0 || at.size() != 3 || !at.allFinite()) fail("aimed", text);
  }
  if (wishes.grip && (wishes.grip->node >= robot().solids[0].body.nodes() || !wishes.grip->to.allFinite()))
    fail("grip", text);
  if (!(wishes.speed > 0.0 && wishes.steps <= 100)) fail("speed or steps", text);
  return 0;
}
