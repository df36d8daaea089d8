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
  if (is_rigid(side.on)) return contact::moved(pose(side.on), side.local);
  contact::Simplex own = side.local;
  for (std::size_t i = 0; i < static_cast<std::size_t>(own.corners()); ++i) {
    own.x[i] = side.on.kind == Kind::solid ? Vec3(state.solids[side.on.number].x.col(side.nodes[i]))
                                           : rod::position(rods[side.on.number], side.abscissae[i]);
  }
  return own;
}

void touching_points(const Moment& now, int rod, Eigen::Matrix3Xd& points) {
  const std::vector<double>& abscissae = now.model.rods[rod].touching;
  points.resize(3, static_cast<Eigen::Index>(abscissae.size()));
  for (Eigen::Index i = 0; i < points.cols(); ++i)
    points.col(i) = rod::position(now.rods[rod], abscissae[static_cast<std::size_t>(i)]);
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

double gap_to_shape(const contact::Shape& shape, const Vec3& local, double radius) {
  return contact::nearest(contact::point_at(local, radius), contact::nearest_part(shape, local)).gap;
}

double stands_out(const Model& model, const Collider& object) {
  const auto* cylinder = is_rigid(object) ? std::get_if<contact::Cylinder>(&shape_of(model, object)) : nullptr;
  return cylinder ? contact::kPrismStandsOut * cylinder->radius : 0.0;
}

double thickness_of(const Model& model, const Collider& own) {
  struct OfShape {
    double operator()(const contact::HalfSpace&) const { return INFINITY; }
    double operator()(const contact::Ball& ball) const { return 2.0 * ball.radius; }
    double operator()(const contact::Capsule& capsule) const { return 2.0 * capsule.radius; }
    double operator()(const contact::Cylinder& cylinder) const {
      return std::min(2.0 * cylinder.radius, cylinder.length);
    }
    double operator()(const contact::Convex& convex) const {
      double thin = INFINITY;
      for (const Vec3& n : convex.surface.normals) {
        double least = INFINITY, most = -INFINITY;
        for (const Vec3& x : convex.surface.corners) {
          least = std::min(least, n.dot(x));
          most = std::max(most, n.dot(x));
        }
        thin = std::min(thin, most - least);
      }
      return thin;
    }
    double operator()(const contact::Mesh& mesh) const {
      return (mesh.points.rowwise().maxCoeff() - mesh.points.rowwise().minCoeff()).minCoeff();
    }
  };
  switch (own.kind) {
    case Kind::rod: {
      const RodModel& rod = model.rods[own.number];
      double thin = INFINITY;
      for (const double s : rod.touching) thin = std::min(thin, 2.0 * rod::radius_at(rod.rod.profile, s));
      return thin;
    }
    case Kind::solid:
      return (model.solids[own.number].body.rest.rowwise().maxCoeff() -
              model.solids[own.number].body.rest.rowwise().minCoeff())
          .minCoeff();
    case Kind::body:
    case Kind::obstacle:
      break;
  }
  return std::visit(OfShape{}, shape_of(model, own));
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

void configure_touching(const Model& model, const std::vector<Placement>& bases, const State& state,
                        std::vector<rod::Configuration>& rods) {
  rods.resize(model.rods.size());
  for (std::size_t i = 0; i < rods.size(); ++i) {
    if (in_a_pair(model, {Kind::rod, static_cast<int>(i)}))
      rod::reconfigure(model.rods[i].rod, {bases[i], state.rods[i].turned}, state.rods[i].q, rods[i]);
  }
}

std::vector<Placement> frames_at(const Model& model, double time) {
  std::vector<Placement> frames;
  for (const auto& [name, frame] : model.scene.frames) frames.push_back(frame_displacement(frame, time));
  return frames;
}

bool is_shape(const Model& model, const Collider& own) { return is_rigid(own) && !mesh_of(model, own); }

bool are_shapes(const Model& model, const PairModel& pair) {
  return is_shape(model, pair.a) && is_shape(model, pair.b);
}

std::string name_of_pair(const Model& model, int pair) {
  return name_of(model, model.pairs[pair].a) + " and " + name_of(model, model.pairs[pair].b);
}

}  // namespace sinew
