#include "sinew/sim/held_contact.hpp"

#include <algorithm>
#include <cmath>

#include "sinew/contact/mesh.hpp"
#include "sinew/sim/contact_places.hpp"

namespace sinew {

namespace {

using Kind = Collider::Kind;

/// How deep a point, in the axes of a rigid shape, lies in it [m]; 0 outside.
double depth_in(const contact::Shape& shape, const Vec3& local) {
  const auto* mesh = std::get_if<contact::Mesh>(&shape);
  if (!mesh) return std::max(0.0, -gap_to_shape(shape, local, 0.0));
  if (!contact::inside(*mesh, mesh->points, mesh->faces, local)) return 0.0;
  double least = INFINITY;
  for (const std::array<int, 3>& t : mesh->triangles) {
    const std::array<Vec3, 3> x = {mesh->points.col(t[0]), mesh->points.col(t[1]), mesh->points.col(t[2])};
    const std::array<double, 3> weights = contact::on_triangle(local, x[0], x[1], x[2]);
    least = std::min(least, (local - weights[0] * x[0] - weights[1] * x[1] - weights[2] * x[2]).norm());
  }
  return least;
}

}  // namespace

HeldInside held_inside(const StepContext& context, const ContactRoom& room, const State& next) {
  const Model& model = context.model;
  const auto moves = [&model](int frame) { return frame >= 0 && model.scene.frames[frame].second.motion.has_value(); };
  HeldInside deepest;
  std::vector<Placement> frames;
  for (std::size_t i = 0; i < model.pairs.size(); ++i) {
    const bool first = model.pairs[i].a.kind == Kind::solid;
    const Collider& solid = first ? model.pairs[i].a : model.pairs[i].b;
    const Collider& obstacle = first ? model.pairs[i].b : model.pairs[i].a;
    if (solid.kind != Kind::solid || obstacle.kind != Kind::obstacle) continue;
    const SolidModel& own = model.solids[solid.number];
    const int frame = model.obstacles[obstacle.number].frame;
    const auto carried = [&](int node) {
      return (own.carrier.col(node) != frame &&
              own.carrier.col(node).unaryExpr([&](int carrier) { return moves(carrier) || moves(frame); }))
          .any();
    };
    const auto meets = [&](int node) { return own.body.unknown.col(node).maxCoeff() < 0 && carried(node); };
    if (std::none_of(own.skin.used.begin(), own.skin.used.end(), meets)) continue;
    if (frames.empty()) frames = frames_at(model, context.start.time + context.h);
    const contact::Pose pose = Moment{model, next, frames, room.now}.pose(obstacle);
    for (const int node : own.skin.used) {
      if (!meets(node)) continue;
      const Vec3 local = pose.R.transpose() * (next.solids[solid.number].x.col(node) - pose.p);
      const double depth = depth_in(shape_of(model, obstacle), local);
      if (depth > deepest.depth) deepest = {static_cast<int>(i), depth};
    }
  }
  return deepest;
}

}  // namespace sinew
