#include "sinew/sim/first_guess.hpp"

namespace sinew {

void place_held(const StepContext& context, State& iterate) {
  for (std::size_t i = 0; i < iterate.solids.size(); ++i) {
    const SolidModel& model = context.model.solids[i];
    for (const int node : model.body.held_nodes) {
      for (int axis = 0; axis < 3; ++axis) {
        if (model.body.unknown(axis, node) < 0)
          iterate.solids[i].x(axis, node) =
              apply(context.moved(model.carrier(axis, node)), model.body.rest.col(node))[axis];
      }
    }
  }
}

void first_guess(const StepContext& context, State& guess) {
  guess = context.start;
  for (std::size_t i = 0; i < guess.solids.size(); ++i) {
    const int frame = context.model.solids[i].frame;
    if (frame < 0 || !context.model.scene.frames[frame].second.motion) continue;
    const Placement before = frame_displacement(context.model.scene.frames[frame].second, context.start.time);
    const Placement carry = compose(context.moved(frame), inverse(before));
    Eigen::Matrix3Xd& x = guess.solids[i].x;
    for (auto node : x.colwise()) node = (carry.R * node + carry.p).eval();
  }
  place_held(context, guess);
}

void move_by(const StepContext& context, double time, State& guess) {
  for (std::size_t i = 0; i < guess.solids.size(); ++i) {
    const int frame = context.model.solids[i].frame;
    if (frame < 0 || !context.model.scene.frames[frame].second.motion)
      guess.solids[i].x += time * context.start.solids[i].v;
  }
  place_held(context, guess);
  for (std::size_t i = 0; i < guess.rods.size(); ++i) guess.rods[i].q += time * context.start.rods[i].q_rate;
  for (std::size_t i = 0; i < guess.bodies.size(); ++i) rigid::move_on(context.start.bodies[i], time, guess.bodies[i]);
}

void move_on(const StepContext& context, double part, State& guess) {
  double time = part * context.h;
  for (const rigid::Motion& own : context.start.bodies) {
    if (time * own.w.norm() > kMostTurn) time = kMostTurn / own.w.norm();
  }
  move_by(context, time, guess);
}

}  // namespace sinew
