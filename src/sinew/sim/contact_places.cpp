#include "sinew/sim/contact_places.hpp"

#include <algorithm>

#include "sinew/sim/places.hpp"

namespace sinew {

using Kind = Collider::Kind;

contact::Pose Moment::pose(const Collider& own) const {
  if (own.kind == Kind::body) return {state.bodies[own.number].R, state.bodies[own.number].p};
  const ObstacleModel& obstacle = model.obstacles[own.number];
  const Placement now =
      obstacle.frame < 0 ? obstacle.pose : compose(frames[static_cast<std::size_t>(obstacle.frame)], obstacle.pose);
  return {now.R, now.p};
}

contact::Simplex Moment::placed(const ContactSide& side) const {
  contact::Simplex own = side.local;
  for (std::size_t i = 0; i < static_cast<std::size_t>(own.corners()); ++i) {
    switch (side.on.kind) {
      case Kind::solid:
        own.x[i] = state.solids[side.on.number].x.col(side.nodes[i]);
        break;
      case Kind::rod:
        own.x[i] = rod::position(rods[side.on.number], side.abscissae[i]);
        break;
      case Kind::obstacle:
      case Kind::body:
        own.x[i] = pose(side.on) * own.x[i];
        break;
    }
  }
  if (is_rigid(side.on)) own.normal = pose(side.on).R * own.normal;
  return own;
}

bool is_rigid(const Collider& own) { return own.kind == Kind::body || own.kind == Kind::obstacle; }

bool in_a_pair(const Model& model, const Collider& own) {
  return std::any_of(model.pairs.begin(), model.pairs.end(),
                     [&own](const PairModel& pair) { return pair.a == own || pair.b == own; });
}

const contact::Shape& shape_of(const Model& model, const Collider& own) {
  return own.kind == Kind::body ? model.bodies[own.number].shape : model.obstacles[own.number].shape;
}

const std::vector<contact::Simplex>& prongs_of(const Model& model, const Collider& own) {
  return own.kind == Kind::body ? model.bodies[own.number].prongs : model.obstacles[own.number].prongs;
}

const contact::Mesh* mesh_of(const Model& model, const Collider& own) {
  if (own.kind == Kind::rod) return nullptr;
  if (own.kind == Kind::solid) return &model.solids[own.number].skin;
  return std::get_if<contact::Mesh>(&shape_of(model, own));
}

const std::string& name_of(const Model& model, const Collider& own) {
  switch (own.kind) {
    case Kind::obstacle:
      return model.obstacles[own.number].name;
    case Kind::body:
      return model.bodies[own.number].name;
    case Kind::solid:
      return model.solids[own.number].name;
    case Kind::rod:
      break;
  }
  return model.rods[own.number].name;
}

}  // namespace sinew
