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
};

/// Fits all to where the nodes x are.
void fit(const SolidModel& model, const Eigen::Matrix3Xd& x, Surface& own);

/// Adds the pairs of parts of pair `number` that are nearer than `alarm` [m] at `start`, with surfaces of all solids
/// that are in a pair, fitted there. Surfaces meet as points of one and faces of the other, and as edges of both.
void search(const Moment& start, double alarm, const std::vector<Surface>& surfaces, int number,
            std::vector<ContactState>& found);

}  // namespace sinew
