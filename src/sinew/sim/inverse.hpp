// The inverse problem, (15): a step in which forces of actuators are what is looked for.
#pragma once

#include <vector>

#include "sinew/sim/step.hpp"

namespace sinew {

/// Where effectors are to be at the end of a step, and what their actuators can do.
struct Goal {
  std::vector<Vec3> positions;      ///< [m] of each of Scene::effectors
  std::vector<double> least, most;  ///< [N] of each actuator; pulling only: least 0. They may be infinite
};

struct InverseReport {
  StepReport step;
  double distance = 0.0;  ///< [m] from the goals, root of the sum of squares, as the linearisation sees it; NaN: failed
};

/// A step as `step` makes with one linearisation, whatever the scene's `newton`, with the forces that bring the
/// effectors nearest to their goals within their bounds; they stand in State::actuators. All rows are eliminated first,
/// then a problem of as many unknowns as there are actuators is left. All actuators must be driven by forces on bases
/// of rods; throws std::invalid_argument where they are not, where sizes do not match, a goal or bound is not a number,
/// or a bound above the other.
InverseReport inverse_step(const Model& model, Workspace& workspace, const Goal& goal, double h, State& state,
                           Evaluation evaluation = Evaluation::full);

}  // namespace sinew
