#include "sinew/sim/contacts.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "sinew/contact/meeting.hpp"
#include "sinew/sim/places.hpp"

namespace sinew {

namespace {

using Kind = Collider::Kind;
using contact::Simplex;

/// Where everything is at one time: at the start of a step or at an iterate.
struct Moment {
  const Model& model;
  const State& state;
  const std::vector<Placement>& frames;  ///< how far each has moved
  const std::vector<rod::Configuration>& rods;

  contact::Pose pose(const Collider& own) const {
    if (own.kind == Kind::body) return {state.bodies[own.number].R, state.bodies[own.number].p};
    const ObstacleModel& obstacle = model.obstacles[own.number];
    const Placement now =
        obstacle.frame < 0 ? obstacle.pose : compose(frames[static_cast<std::size_t>(obstacle.frame)], obstacle.pose);
    return {now.R, now.p};
  }

  Simplex placed(const ContactSide& side) const {
    Simplex own = side.local;
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
    if (side.on.kind == Kind::obstacle || side.on.kind == Kind::body) own.normal = pose(side.on).R * own.normal;
    return own;
  }
};

bool rigid(const Collider& own) { return own.kind == Kind::body || own.kind == Kind::obstacle; }

const contact::Shape& shape_of(const Model& model, const Collider& own) {
  return own.kind == Kind::body ? model.bodies[own.number].shape : model.obstacles[own.number].shape;
}

/// A point of the surface: that of the axis or core moved out along the normal.
Vec3 surface_point(const Simplex& own, const std::array<double, 3>& weights, const Vec3& out) {
  Vec3 p = own.radius * out;
  for (std::size_t i = 0; i < static_cast<std::size_t>(own.corners()); ++i) p += weights[i] * own.x[i];
  return p;
}

/// Where the material point p of a side, at an iterate, was at the start of the step.
Vec3 was(const ContactSide& side, const std::array<double, 3>& weights, const Vec3& p, const Moment& start,
         const Moment& now) {
  if (rigid(side.on)) {
    const contact::Pose from = start.pose(side.on), to = now.pose(side.on);
    return from * (to.R.transpose() * (p - to.p));
  }
  const Simplex before = start.placed(side), after = now.placed(side);
  Vec3 moved = Vec3::Zero();
  for (std::size_t i = 0; i < static_cast<std::size_t>(before.corners()); ++i)
    moved += weights[i] * (after.x[i] - before.x[i]);
  if (side.on.kind == Kind::rod && after.radius > 0.0) {
    // The surface turns with the cross-section.
    const std::size_t near = weights[1] > weights[0] ? 1 : 0;
    const rod::Mat3 R = rod::branch(start.rods[side.on.number], side.abscissae[near]).R *
                        rod::branch(now.rods[side.on.number], side.abscissae[near]).R.transpose();
    Vec3 axis = Vec3::Zero();
    for (std::size_t i = 0; i < static_cast<std::size_t>(after.corners()); ++i) axis += weights[i] * after.x[i];
    moved += (p - axis) - R * (p - axis);
  }
  return p - moved;
}

bool earlier(const ContactState& a, const ContactState& b) {
  return a.pair < b.pair || (a.pair == b.pair && a.part < b.part);
}

/// Boxes and outward directions of a surface where its nodes are now.
void fit(const SolidModel& model, const Eigen::Matrix3Xd& x, ContactRoom::Surface& own) {
  own.outward.setZero(3, x.cols());
  own.boxes.clear();
  for (const solid::Triangle& t : model.surface) {
    const Vec3 area = (x.col(t[1]) - x.col(t[0])).cross(x.col(t[2]) - x.col(t[0]));
    contact::Box& box = own.boxes.emplace_back();
    for (const int node : t) {
      own.outward.col(node) += area;
      box.extend(Vec3(x.col(node)));
    }
  }
  if (own.boxes.empty()) return;
  own.outward.colwise().normalize();
  if (own.faces.whole().isEmpty()) {
    own.faces = model.faces;
    own.edges = model.edges;
  }
  own.faces.fit(own.boxes);
  own.boxes.clear();
  for (const Ridge& ridge : model.ridges) {
    contact::Box& box = own.boxes.emplace_back();
    for (const int node : ridge.ends) box.extend(Vec3(x.col(node)));
  }
  own.edges.fit(own.boxes);
}

/// Finds the pairs of parts that are nearer than the alarm distance at the start of a step. Surfaces meet as points of
/// one and faces of the other, and as edges of both; a point meets only the nearest face.
class Search {
 public:
  Search(const Moment& start, double alarm, const std::vector<ContactRoom::Surface>& surfaces,
         std::vector<ContactState>& found)
      : start_(start), alarm_(alarm), surfaces_(surfaces), found_(found) {}

  void pair(int number) {
    pair_ = number;
    const PairModel& own = start_.model.pairs[number];
    if (rigid(own.a) && rigid(own.b)) {
      shapes(own.a, own.b);
      return;
    }
    points_and_faces(own.a, own.b, Part::point_of_first);
    if (own.a != own.b) points_and_faces(own.b, own.a, Part::point_of_second);
    edges(own.a, own.b);
  }

 private:
  /// By which a contact of a pair is known again: what it is, and the numbers of its two parts.
  enum class Part : std::uint64_t { point_of_first, point_of_second, edges };
  static std::uint64_t key(Part part, int i, int j) {
    constexpr int kBits = 25;  // in all what a double holds exactly
    return (static_cast<std::uint64_t>(part) << (2 * kBits)) | (static_cast<std::uint64_t>(i) << kBits) |
           static_cast<std::uint64_t>(j);
  }

  void add(const ContactSide& a, const ContactSide& b, std::uint64_t part) {
    ContactState& own = found_.emplace_back();
    own.pair = pair_;
    own.part = part;
    own.a = a;
    own.b = b;
  }

  void shapes(const Collider& first, const Collider& second) {
    meetings_.clear();
    contact::meet(shape_of(start_.model, first), start_.pose(first), shape_of(start_.model, second),
                  start_.pose(second), alarm_, meetings_);
    for (const contact::Meeting& met : meetings_) {
      ContactSide a, b;
      a.on = met.swapped ? second : first;
      b.on = met.swapped ? first : second;
      a.local = met.a;
      b.local = met.b;
      add(a, b, met.key);
    }
  }

  /// Visits the parts of an object with which it pokes into others, of one kind, with their numbers: nodes and ridges
  /// of a solid near `where`, points and pieces of a rod, corners and edges of a shape.
  template <class Visit>
  void each_prong(const Collider& own, Simplex::Kind kind, const contact::Box& where, const Visit& visit) const {
    ContactSide side;
    side.on = own;
    side.local.kind = kind;
    if (rigid(own)) {
      const std::vector<Simplex> all = contact::prongs(shape_of(start_.model, own));
      for (std::size_t i = 0; i < all.size(); ++i) {
        if (all[i].kind != kind) continue;
        side.local = all[i];
        visit(side, static_cast<int>(i));
      }
    } else if (own.kind == Kind::rod) {
      const RodModel& rod = start_.model.rods[own.number];
      const std::size_t count = rod.touching.size(), used = kind == Simplex::Kind::point ? 1 : 2;
      for (std::size_t i = 0; i + used <= count; ++i) {
        side.local.radius = 0.0;
        for (std::size_t k = 0; k < used; ++k) {
          side.abscissae[k] = rod.touching[i + k];
          side.local.radius = std::max(side.local.radius, rod::radius_at(rod.rod.profile, rod.touching[i + k]));
        }
        visit(side, static_cast<int>(i));
      }
    } else {
      const SolidModel& solid = start_.model.solids[own.number];
      const Eigen::Matrix3Xd& x = start_.state.solids[own.number].x;
      if (kind == Simplex::Kind::point) {
        for (const int node : solid.surface_nodes) {
          if (!where.contains(Vec3(x.col(node)))) continue;
          side.nodes[0] = node;
          visit(side, node);
        }
        return;
      }
      surfaces_[own.number].edges.each_near(where, [&](int number) {
        const Ridge& ridge = solid.ridges[number];
        const auto normal = [&](int third) {
          return (x.col(ridge.ends[1]) - x.col(ridge.ends[0])).cross(x.col(third) - x.col(ridge.ends[0])).normalized();
        };
        // One of the two is turned the other way; which does not matter for how much they differ.
        const Vec3 one = normal(ridge.sides[0]), other = -normal(ridge.sides[1]);
        const Vec3 outward =
            (surfaces_[own.number].outward.col(ridge.ends[0]) + surfaces_[own.number].outward.col(ridge.ends[1]))
                .normalized();
        if (ridge.sides[0] != ridge.sides[1]) {
          const Vec3 inward = 0.5 * (x.col(ridge.sides[0]) + x.col(ridge.sides[1])) - x.col(ridge.ends[0]);
          if (one.dot(other) > kFlat || inward.dot(outward) > 0.0) return;  // flat or a valley: points meet it
        }
        side.nodes = {ridge.ends[0], ridge.ends[1], 0};
        side.local.normal = outward;
        visit(side, number);
      });
    }
  }

  /// Of all of an object, and the alarm distance around.
  contact::Box around(const Collider& own) const {
    contact::Box box;
    if (rigid(own)) {
      const contact::Pose pose = start_.pose(own);
      const Vec3 reach = contact::reach(shape_of(start_.model, own), pose.R.transpose());
      box = contact::Box(Vec3(pose.p - reach), Vec3(pose.p + reach));
    } else if (own.kind == Kind::solid) {
      box = surfaces_[own.number].faces.whole();
    } else {
      const RodModel& rod = start_.model.rods[own.number];
      for (const double s : rod.touching) {
        const Vec3 p = rod::position(start_.rods[own.number], s),
                   r = Vec3::Constant(rod::radius_at(rod.rod.profile, s));
        box.extend(contact::Box(Vec3(p - r), Vec3(p + r)));
      }
    }
    return grown(box);
  }

  contact::Box grown(contact::Box box, double radius = 0.0) const {
    box.min().array() -= alarm_ + radius;
    box.max().array() += alarm_ + radius;
    return box;
  }

  void points_and_faces(const Collider& poking, const Collider& faced, Part part) {
    if (faced.kind == Kind::rod) return;  // thin: edges meet it
    each_prong(poking, Simplex::Kind::point, around(faced), [&](const ContactSide& a, int number) {
      const Simplex point = start_.placed(a);
      if (rigid(faced)) {
        add_shape(a, point, faced, key(part, number, 0));
      } else {
        add_nearest_face(a, point, faced, key(part, number, 0));
      }
    });
  }

  void add_shape(const ContactSide& a, const Simplex& point, const Collider& hard, std::uint64_t part) {
    const contact::Pose pose = start_.pose(hard);
    const Vec3 own = pose.R.transpose() * (point.x[0] - pose.p);
    ContactSide b;
    b.on = hard;
    b.local = contact::nearest_part(shape_of(start_.model, hard), own);
    if (contact::nearest(contact::point_at(own, point.radius), b.local).gap < alarm_) add(a, b, part);
  }

  void add_nearest_face(const ContactSide& a, const Simplex& point, const Collider& soft, std::uint64_t part) {
    const SolidModel& solid = start_.model.solids[soft.number];
    const bool itself = a.on == soft;
    ContactSide b;
    b.on = soft;
    b.local.kind = Simplex::Kind::triangle;
    double nearest = alarm_;
    std::array<int, 3> best{};
    const contact::Box where = grown(contact::Box(point.x[0]), point.radius);
    surfaces_[soft.number].faces.each_near(where, [&](int number) {
      b.nodes = solid.surface[number];
      if (itself && (near_at_rest(solid, a.nodes[0], b.nodes))) return;
      const contact::Nearest found = contact::nearest(point, start_.placed(b));
      const bool inside = std::min({found.b[0], found.b[1], found.b[2]}) > 0.0;
      if (point.radius > 0.0 && rigid(a.on) && !inside) return;  // that is the business of the nodes
      if (std::abs(found.gap) >= nearest) return;
      if (a.on.kind == Kind::solid && found.normal.dot(surfaces_[a.on.number].outward.col(a.nodes[0])) >= 0.0)
        return;  // the far side of something thin
      nearest = std::abs(found.gap);
      best = b.nodes;
    });
    if (nearest == alarm_) return;
    b.nodes = best;
    add(a, b, part);
  }

  /// Whether a node and a triangle of the same solid are neighbours.
  bool near_at_rest(const SolidModel& solid, int node, const std::array<int, 3>& face) const {
    const auto at = [&](int n) { return Vec3(solid.body.rest.col(n)); };
    const contact::Nearest found =
        contact::nearest(contact::point_at(at(node), 0.0),
                         Simplex{Simplex::Kind::triangle, {at(face[0]), at(face[1]), at(face[2])}, Vec3::Zero(), 0.0});
    double edge = 0.0;
    for (std::size_t i = 0; i < 3; ++i) edge = std::max(edge, (at(face[i]) - at(face[(i + 1) % 3])).norm());
    return std::abs(found.gap) < 0.5 * edge;
  }

  struct Edge {
    ContactSide side;
    Simplex placed;
    contact::Box box;
    int number = 0;
  };
  std::vector<Edge> edges_of(const Collider& own, const contact::Box& where) const {
    std::vector<Edge> all;
    each_prong(own, Simplex::Kind::segment, where, [&](const ContactSide& side, int number) {
      Edge edge{side, start_.placed(side), {}, number};
      edge.box.extend(edge.placed.x[0]);
      edge.box.extend(edge.placed.x[1]);
      edge.box.min().array() -= edge.placed.radius;
      edge.box.max().array() += edge.placed.radius;
      if (edge.box.intersects(where)) all.push_back(edge);
    });
    return all;
  }

  void edges(const Collider& first, const Collider& second) {
    const std::vector<Edge> all = edges_of(first, around(second));
    if (all.empty()) return;
    std::vector<Edge> others = first == second ? all : edges_of(second, around(first));
    std::sort(others.begin(), others.end(),
              [](const Edge& a, const Edge& b) { return a.box.min().x() < b.box.min().x(); });
    double widest = 0.0;
    for (const Edge& other : others) widest = std::max(widest, other.box.sizes().x());
    for (const Edge& one : all) {
      const contact::Box where = grown(one.box);
      auto other = std::partition_point(others.begin(), others.end(), [&](const Edge& edge) {
        return edge.box.min().x() < where.min().x() - widest;
      });
      for (; other != others.end() && other->box.min().x() <= where.max().x(); ++other) {
        if (!where.intersects(other->box)) continue;
        if (first == second && (one.number >= other->number || neighbours(one.side, other->side))) continue;
        // What has an outside comes second.
        const bool turned = other->placed.normal.isZero() && !one.placed.normal.isZero();
        const Edge &a = turned ? *other : one, &b = turned ? one : *other;
        const contact::Nearest found = contact::nearest(a.placed, b.placed);
        if (std::abs(found.gap) >= alarm_ || !within(found, a.side, b.side)) continue;
        if (found.normal.dot(b.placed.normal) < 0.0 || found.normal.dot(a.placed.normal) > 0.0) continue;
        add(a.side, b.side, key(Part::edges, one.number, other->number));
      }
    }
  }

  /// Whether two segments meet between their ends: there, points do. Pieces of rods share theirs.
  bool within(const contact::Nearest& found, const ContactSide& a, const ContactSide& b) const {
    const auto inside = [&](const ContactSide& side, double t) {
      if (side.on.kind != Kind::rod) return t > 0.0 && t < 1.0;
      const std::vector<double>& all = start_.model.rods[side.on.number].touching;
      return t < 1.0 || side.abscissae[1] == all.back();
    };
    return inside(a, found.a[1]) && inside(b, found.b[1]);
  }

  static bool neighbours(const ContactSide& a, const ContactSide& b) {
    for (std::size_t i = 0; i < 2; ++i) {
      for (std::size_t j = 0; j < 2; ++j) {
        if (a.nodes[i] == b.nodes[j]) return true;
      }
    }
    return false;
  }

  static constexpr double kFlat = 0.985;  ///< cosine of 10 degrees
  const Moment& start_;
  double alarm_;
  const std::vector<ContactRoom::Surface>& surfaces_;
  std::vector<ContactState>& found_;
  int pair_ = 0;
  std::vector<contact::Meeting> meetings_;
};

void configure_touching(const Model& model, const std::vector<Placement>& bases, const State& state,
                        std::vector<rod::Configuration>& rods) {
  rods.resize(model.rods.size());
  for (const PairModel& pair : model.pairs) {
    for (const Collider& own : {pair.a, pair.b}) {
      if (own.kind != Kind::rod) continue;
      rod::configure(model.rods[own.number].rod, {bases[own.number], state.rods[own.number].turned},
                     state.rods[own.number].q, rods[own.number]);
    }
  }
}

std::vector<Placement> frames_at_start(const StepContext& context) {
  std::vector<Placement> frames;
  for (const auto& [name, frame] : context.model.scene.frames)
    frames.push_back(frame_displacement(frame, context.start.time));
  return frames;
}

/// Tangents that turn little while the normal turns little.
Eigen::Matrix3d frame_of(const Vec3& n) {
  Eigen::Index least = 0;
  n.cwiseAbs().minCoeff(&least);
  Eigen::Matrix3d frame;
  frame.col(0) = n;
  frame.col(1) = n.cross(Vec3::Unit(least)).normalized();
  frame.col(2) = n.cross(frame.col(1));
  return frame;
}

/// Velocity of the material point p of a side at the start of the step; points of rods count as at rest.
Vec3 velocity(const ContactSide& side, const std::array<double, 3>& weights, const Vec3& p,
              const StepContext& context) {
  switch (side.on.kind) {
    case Kind::body: {
      const rigid::Motion& own = context.start.bodies[side.on.number];
      return own.v + (own.R * own.w).cross(p - own.p);
    }
    case Kind::solid: {
      Vec3 v = Vec3::Zero();
      for (std::size_t i = 0; i < static_cast<std::size_t>(side.local.corners()); ++i)
        v += weights[i] * context.start.solids[side.on.number].v.col(side.nodes[i]);
      return v;
    }
    case Kind::obstacle:
    case Kind::rod:
      break;
  }
  return Vec3::Zero();
}

/// The gap that a contact must have at the end of the step.
double least_gap(const StepContext& context, const ContactState& own, const Moment& start) {
  const Simplex a = start.placed(own.a), b = start.placed(own.b);
  const contact::Nearest nearest = contact::nearest(a, b);
  const double gravity = context.gravity.norm();
  if (nearest.gap < 0.0) {
    // Bodies that overlap are lifted no faster than a fall from that height, or in some fifty steps without gravity.
    const double lift = std::max(std::sqrt(gravity * -nearest.gap) * context.h, -0.02 * nearest.gap);
    return std::min(0.0, nearest.gap + lift);
  }
  const double restitution = context.model.pairs[own.pair].restitution;
  if (restitution == 0.0) return 0.0;
  const Vec3& n = nearest.normal;
  const Vec3 pa = surface_point(a, nearest.a, -n), pb = pa - nearest.gap * n;
  const double approach = n.dot(velocity(own.a, nearest.a, pa, context) - velocity(own.b, nearest.b, pb, context));
  // What rests on the ground falls by g h in every step, and is not to bounce.
  const bool hits = nearest.gap + approach * context.h < 0.0 && -approach > 2.0 * gravity * context.h;
  return hits ? nearest.gap - restitution * approach * context.h : 0.0;
}

}  // namespace

double alarm_distance(const StepContext& context) {
  double fastest = 0.0;
  for (const SolidState& solid : context.start.solids) fastest = std::max(fastest, solid.v.colwise().norm().maxCoeff());
  for (const RodState& rod : context.start.rods) {
    if (rod.velocity.cols() > 0) fastest = std::max(fastest, rod.velocity.colwise().norm().maxCoeff());
  }
  for (std::size_t i = 0; i < context.start.bodies.size(); ++i) {
    const rigid::Motion& own = context.start.bodies[i];
    const double far = contact::reach(context.model.bodies[i].shape, Eigen::Matrix3d::Identity()).norm();
    fastest = std::max(fastest, own.v.norm() + own.w.norm() * far);
  }
  return 2.0 * context.h * (fastest + context.gravity.norm() * context.h) + 2e-3 * context.model.size;
}

void find_contacts(const StepContext& context, State& iterate, ContactRoom& room) {
  if (context.model.pairs.empty()) return;
  std::vector<Placement> bases;
  for (std::size_t i = 0; i < context.model.rods.size(); ++i)
    bases.push_back(rod_base(context.model, context.start, static_cast<int>(i)));
  configure_touching(context.model, bases, context.start, room.start);
  const std::vector<Placement> frames = frames_at_start(context);
  const Moment start{context.model, context.start, frames, room.start};
  std::vector<ContactState> found;
  room.surfaces.resize(context.model.solids.size());
  for (const PairModel& pair : context.model.pairs) {
    for (const Collider& own : {pair.a, pair.b}) {
      if (own.kind == Kind::solid)
        fit(context.model.solids[own.number], context.start.solids[own.number].x, room.surfaces[own.number]);
    }
  }
  Search search(start, alarm_distance(context), room.surfaces, found);
  for (std::size_t i = 0; i < context.model.pairs.size(); ++i) search.pair(static_cast<int>(i));
  std::sort(found.begin(), found.end(), earlier);
  // What was there keeps its force.
  auto old = context.start.contacts.begin();
  for (ContactState& own : found) {
    while (old != context.start.contacts.end() && earlier(*old, own)) ++old;
    if (old != context.start.contacts.end() && !earlier(own, *old)) own.force = old->force;
  }
  iterate.contacts = std::move(found);
  room.least.clear();
  room.facings.clear();
  for (const ContactState& own : iterate.contacts) {
    room.least.push_back(least_gap(context, own, start));
    room.facings.push_back(contact::facing(start.placed(own.a), start.placed(own.b)));
  }
}

void finish_contacts(const ContactRoom& room, State& next) {
  for (std::size_t i = 0; i < next.contacts.size(); ++i) {
    ContactState& own = next.contacts[i];
    const Touch& touch = room.touches[i];
    own.point = touch.point_b;
    own.normal = touch.nearest.normal;
    own.gap = touch.nearest.gap;
    own.slip = touch.u.tail<2>().norm();
  }
  std::erase_if(next.contacts, [](const ContactState& own) { return !(own.force.dot(own.normal) > 0.0); });
}

void evaluate_contacts(const StepContext& context, const State& iterate, ContactRoom& room) {
  room.touches.resize(iterate.contacts.size());
  if (iterate.contacts.empty()) return;
  configure_touching(context.model, context.bases, iterate, room.now);
  const std::vector<Placement> frames = frames_at_start(context);
  const Moment start{context.model, context.start, frames, room.start};
  const Moment now{context.model, iterate, context.displacement, room.now};
  for (std::size_t i = 0; i < room.touches.size(); ++i) {
    const ContactState& own = iterate.contacts[i];
    Touch& touch = room.touches[i];
    const Simplex a = now.placed(own.a), b = now.placed(own.b);
    touch.nearest = contact::nearest(a, b, room.facings[i]);
    const Vec3& n = touch.nearest.normal;
    touch.frame = frame_of(n);
    touch.point_a = surface_point(a, touch.nearest.a, -n);
    touch.point_b = b.kind == Simplex::Kind::plane ? Vec3(touch.point_a - touch.nearest.gap * n)
                                                   : surface_point(b, touch.nearest.b, n);
    const Vec3 slip = (touch.point_a - was(own.a, touch.nearest.a, touch.point_a, start, now)) -
                      (touch.point_b - was(own.b, touch.nearest.b, touch.point_b, start, now));
    touch.u = Vec3(touch.nearest.gap, slip.dot(touch.frame.col(1)), slip.dot(touch.frame.col(2)));
  }
}

}  // namespace sinew
