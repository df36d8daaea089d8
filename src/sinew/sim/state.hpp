// The state: everything that changes, as a value. A copy is a checkpoint; a step from it gives the same bits every
// time.
#pragma once

#include <vector>

#include "sinew/sim/model.hpp"

namespace sinew {

struct SolidState {
  Eigen::Matrix3Xd x, v;  ///< [m], [m/s], 3 x nodes
};

struct RodState {
  Eigen::VectorXd q;          ///< coordinates (strains, base); of a geometric cable (d, points)
  Eigen::Matrix3Xd masses;    ///< [m] where the mass points are
  Eigen::Matrix3Xd velocity;  ///< [m/s] of the mass points
};

struct PointState {
  double s = 0.0;              ///< [m] abscissa
  bool on = true;              ///< false: the rod's end has passed it, the row is off
  Vec3 lambda = Vec3::Zero();  ///< [N] force of the rod on the solid
};

struct State {
  long grid = 0;      ///< steps of the scene's time grid that are behind it
  double time = 0.0;  ///< [s]
  std::vector<SolidState> solids;
  std::vector<RodState> rods;
  std::vector<PointState> points;
  std::vector<double> actuators;  ///< [N] or [N m] force of each motor
  std::vector<double> tensions;   ///< [N] per rod: of a geometric cable, else 0
};

State initial_state(const Model& model);

/// The state as plain numbers in a fixed order, and back. unpack throws std::invalid_argument if the size is not this
/// model's.
std::vector<double> pack(const State& state);
State unpack(const Model& model, const std::vector<double>& numbers);

}  // namespace sinew
