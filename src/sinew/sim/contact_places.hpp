// Where the parts of bodies, obstacles, solids and rods are at one time: at the start of a step or at an iterate.
#pragma once

#include <string>
#include <vector>

#include "sinew/contact/meeting.hpp"
#include "sinew/sim/step_context.hpp"

namespace sinew {

/// A time at which parts are placed; it refers to what it was made from.
struct Moment {
  const Model& model;
  const State& state;
  const std::vector<Placement>& frames;         ///< how far each has moved
  const std::vector<rod::Configuration>& rods;  ///< of those that touch something

  /// Of a body or an obstacle.
  contact::Pose pose(const Collider& own) const;
  contact::Simplex placed(const ContactSide& side) const;
};

/// Bodies and obstacles.
bool is_rigid(const Collider& own);

/// Whether it may touch anything.
bool in_a_pair(const Model& model, const Collider& own);

/// Of what is rigid.
const contact::Shape& shape_of(const Model& model, const Collider& own);

/// The parts by which it presses into surfaces.
const std::vector<contact::Simplex>& prongs_of(const Model& model, const Collider& own);

/// The surface of a solid, or of a rigid mesh; null of all else.
const contact::Mesh* mesh_of(const Model& model, const Collider& own);

/// The name it has in the scene.
const std::string& name_of(const Model& model, const Collider& own);

}  // namespace sinew
