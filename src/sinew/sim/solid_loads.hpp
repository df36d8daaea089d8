// Forces of loads and springs on the nodes of a volume.
#pragma once

#include "sinew/sim/free_motion.hpp"

namespace sinew {

/// [N] per node for a factor of 1, the volume's nodes at x.
Eigen::Matrix3Xd load_forces(const SolidLoadModel& load, const Eigen::Matrix3Xd& x);

/// What the springs of a volume that has some add to the left side of the equation of motion [N]: k (x - where their
/// solid's frame carries its rest).
Eigen::Matrix3Xd spring_forces(const StepContext& context, const SolidModel& model, const Eigen::Matrix3Xd& x);

}  // namespace sinew
