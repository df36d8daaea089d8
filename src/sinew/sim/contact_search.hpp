// The search for contacts: which parts of a pair of bodies, solids or rods are near each other at the start of a step.
#pragma once

#include <vector>

#include "sinew/sim/contact_places.hpp"

namespace sinew {

/// Of a solid that touches another, a rod or itself: boxes around triangles and ridges, and outward directions at its
/// nodes.
struct Surface {
  contact::Tree faces, edges;
  std::vector<contact::Box> boxes;
  Eigen::Matrix3Xd outward;
  std::vector<std::vector<int>> at_node;  ///< triangles
};

/// Fits all to where the nodes x are.
void fit(const SolidModel& model, const Eigen::Matrix3Xd& x, Surface& own);

/// Moves a side, a triangle of this surface, on to the one that is nearest to a point; nodes are at x.
void follow(const SolidModel& model, const Surface& own, const Eigen::Matrix3Xd& x, const contact::Vec3& point,
            ContactSide& side);

/// Adds the pairs of parts of pair `number` that are nearer than `alarm` [m] at `start`, with surfaces of all solids
/// that are in a pair, fitted there. Surfaces meet as points of one and faces of the other, and as edges of both; a
/// point meets only the nearest face.
void search(const Moment& start, double alarm, const std::vector<Surface>& surfaces, int number,
            std::vector<ContactState>& found);

}  // namespace sinew
