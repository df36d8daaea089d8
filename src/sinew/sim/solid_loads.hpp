// Forces of loads and springs on the nodes of a volume.
#pragma once

#include "sinew/sim/free_motion.hpp"

namespace sinew {

/// [N] per node for a factor of 1, the volume's nodes at x.
Eigen::Matrix3Xd load_forces(const SolidLoadModel& load, const Eigen::Matrix3Xd& x);

/// How far the springs of a volume that has some are drawn [m]: x - where their solid's frame has carried its rest.
/// They add k times that to the left side of the equation of motion.
Eigen::Matrix3Xd spring_stretch(const SolidModel& model, const Placement& moved, const Eigen::Matrix3Xd& x);

}  // namespace sinew
