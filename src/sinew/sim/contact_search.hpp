// The search for contacts: which parts of a pair of bodies, solids or rods are near each other at the start of a step.
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

/// Adds the pairs of parts of pair `number` that are nearer than `alarm` [m] at `start`, with surfaces fitted there.
/// Surfaces meet as points of one and faces of the other, and as edges of both.
///
/// What overlaps is met up to a depth of `depth` [m], or of the pair's own: the far sides of thin things, and edges
/// that have passed each other long ago, are no contacts.
void search(const Moment& start, double alarm, double depth, const Surfaces& surfaces, int number,
            std::vector<ContactState>& found);

/// The same, with all pieces of rods, however deep their chords lie in what the rod bends round and its curve only
/// touches: what goes through must not be overlooked.
void search_whole(const Moment& start, double alarm, double depth, const Surfaces& surfaces, int number,
                  std::vector<ContactState>& found);

/// How deep [m] points of one object of a pair are inside the other; 0 where none is.
double overlap(const Moment& now, const Surfaces& surfaces, int number);

}  // namespace sinew
