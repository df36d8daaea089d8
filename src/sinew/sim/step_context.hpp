// What a step is given: where it starts from and what is prescribed at its end.
#pragma once

#include "sinew/rod/kinematics.hpp"
#include "sinew/sim/step.hpp"

namespace sinew {

/// The same for all iterations of a step, but for `at_start` and commands that are looked for.
struct StepContext {
  explicit StepContext(const Model& of) : model(of) {}
  /// Memory of an earlier step is used again.
  void set(const State& from, const Command& wanted, double duration);
  /// The same of a start that is there already.
  void set(const Command& wanted, double duration);

  const Model& model;
  State start;
  double h = 0.0;     ///< [s]
  double rate = 0.0;  ///< 1 / h [1/s]; 0: equilibrium, without inertia and damping
  Command command;    ///< at the end of the step
  Vec3 gravity;       ///< [m/s^2] then
  /// The iterate is a step's first one: the forces that would stop a moving rod there, or drive it on, are no forces
  /// that act along the step, and stay out of its geometric stiffness, where they would count as compression.
  bool at_start = false;
  std::vector<Placement> displacement;        ///< of each frame, at the end of the step
  std::vector<Placement> bases, cable_bases;  ///< of each rod and cable, at the end of the step

  solid::StepStart start_of(int solid) const { return {start.solids[solid].x, start.solids[solid].v, rate}; }
  Placement moved(int frame) const { return frame < 0 ? Placement{} : displacement[frame]; }
};
StepContext make_context(const Model& model, const State& start, const Command& command, double h);

/// What a rod stands on at the end of the step.
inline rod::Base base_of(const StepContext& context, const State& iterate, int rod) {
  return {context.bases[rod], iterate.rods[rod].turned};
}

}  // namespace sinew
