// Where effectors can be brought: equilibria under commands from all over the limits of the sought motors.
#pragma once

#include <functional>
#include <vector>

#include "sinew/sim/step.hpp"

namespace sinew {

/// One equilibrium.
struct ReachSample {
  std::vector<double> commands;           ///< of each sought actuator, in the unit of what it is told
  Status status = Status::rest;           ///< of what could not be found nothing else is known
  State state;                            ///< [SI]
  std::vector<double> forces, positions;  ///< of each sought actuator [N or N m], [m or rad]
  bool within = false;                    ///< its forces and places keep all limits
};

/// Commands spread evenly over the limits: their corners first, as far as there are no more than half of `count`, then
/// Halton's points; of a single actuator one after the other. Throws InputError where a limit is missing.
std::vector<std::vector<double>> spread_commands(const Model& model, int count);

/// Finds the equilibrium of each, from that of the nearest before it, by halves of the way where it is far. The visitor
/// may end it by returning false.
void sample_reach(const Model& model, const std::vector<std::vector<double>>& commands,
                  const std::function<bool(const ReachSample&)>& visit, int threads = 1);

}  // namespace sinew
