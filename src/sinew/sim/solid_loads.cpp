#include "sinew/sim/solid_loads.hpp"

#include "sinew/solid/pressure.hpp"

namespace sinew {

Eigen::Matrix3Xd load_forces(const SolidLoadModel& load, const Eigen::Matrix3Xd& x) {
  Eigen::Matrix3Xd force = load.force.size() > 0 ? load.force : Eigen::Matrix3Xd::Zero(3, x.cols());
  for (const solid::CellFace& face : load.faces) {
    const Eigen::Matrix3Xd own = solid::pressure_force(face, load.pressure, x);
    for (int i = 0; i < face.count; ++i) force.col(face.node[static_cast<std::size_t>(i)]) += own.col(i);
  }
  return force;
}

Eigen::Matrix3Xd spring_stretch(const SolidModel& model, const Placement& moved, const Eigen::Matrix3Xd& x) {
  return (x - moved.R * model.body.rest).colwise() - moved.p;
}

}  // namespace sinew
