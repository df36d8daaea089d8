#include "sinew/sim/step_context.hpp"

namespace sinew {

void StepContext::set(const State& from, const Command& wanted, double duration) {
  start = from;
  set(wanted, duration);
}

void StepContext::set(const Command& wanted, double duration) {
  h = duration;
  rate = model.scene.analysis == Analysis::dynamic ? 1.0 / duration : 0.0;
  command = wanted;
  gravity = model.scene.gravity;
  at_start = false;
  displacement.clear();
  for (const auto& [name, frame] : model.scene.frames)
    displacement.push_back(frame_displacement(frame, start.time + h));
  bases.clear();
  for (const RodModel& rod : model.rods) bases.push_back(compose(moved(rod.frame), rod.base));
  cable_bases.clear();
  for (const GeometricCableModel& cable : model.cables) cable_bases.push_back(compose(moved(cable.frame), cable.base));
}

StepContext make_context(const Model& model, const State& start, const Command& command, double h) {
  StepContext context(model);
  context.set(start, command, h);
  return context;
}

}  // namespace sinew
