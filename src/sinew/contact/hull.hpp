// The smallest convex body around points.
#pragma once

#include <vector>

#include "sinew/contact/polyhedron.hpp"

namespace sinew::contact {

/// Its faces are polygons where points lie in one plane but for rounding. Throws std::invalid_argument where the points
/// are fewer than four, not finite, or lie in one plane.
Polyhedron hull(const std::vector<Vec3>& points);

}  // namespace sinew::contact
