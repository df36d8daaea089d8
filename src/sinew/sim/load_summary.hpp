// What loads come to: for `sinew check`, and for the message of an analysis that fails under them.
#pragma once

#include <string>
#include <vector>

#include "sinew/sim/model.hpp"

namespace sinew {

/// A load at its full size, the largest factor of its table, at the place where its object starts.
struct LoadSummary {
  std::string name;           ///< "loads.air"
  std::string on;             ///< "solids.bar"
  double factor = 1.0;        ///< largest in size of its table; 1 where it is set from outside
  Vec3 force = Vec3::Zero();  ///< [N] sum
  double pressure = 0.0;      ///< [Pa] on faces
  int faces = 0;              ///< under pressure
  double area = 0.0;          ///< [m^2] of these
  double young = 0.0;         ///< [Pa] of the softest material of the solid, at small strains
};

LoadSummary summary_of(const Model& model, const LoadModel& load);

/// "pressure 80 kPa on 312 faces of solids.bar (1250 mm^2), 0.8 of its Young's modulus", or "force (0, 0, -2) N".
std::string describe(const LoadSummary& load);

/// The pressure that is largest beside the stiffness of its solid, described; empty where there is none.
std::string largest_pressure(const Model& model);

}  // namespace sinew
