// Surfaces of triangles that may touch something, where they are at the start of a step.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "sinew/sim/contact_places.hpp"

namespace sinew {

/// The surface of a solid, or of a rigid mesh, in the world: its points, directions out of it, and boxes around
/// triangles and ridges.
struct Surface {
  const contact::Mesh* mesh = nullptr;  ///< null of what has none, or touches nothing
  std::optional<contact::Pose> pose;    ///< of what is rigid, when it was fitted
  Eigen::Matrix3Xd x;
  contact::Outward outward;
  contact::Tree faces, edges;
  std::vector<contact::Box> boxes;
};

/// Of all obstacles, bodies and solids.
class Surfaces {
 public:
  /// Fits those that are in a pair to where they are.
  void fit(const Moment& now);
  /// Null of what has none.
  const Surface* of(const Collider& own) const;

 private:
  void fit(const Collider& own, const Moment& now);
  std::array<std::vector<Surface>, 3> of_kind_;
};

/// Between the normals of the two triangles beside a ridge; none where they lie in one plane, but for 10 degrees, or in
/// a valley: points meet these.
std::optional<Vec3> outward_of_ridge(const Surface& surface, const contact::Ridge& ridge);

}  // namespace sinew
