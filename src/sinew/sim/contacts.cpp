#include "sinew/sim/contacts.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "sinew/sim/contact_merging.hpp"
#include "sinew/sim/contact_patches.hpp"
#include "sinew/sim/contact_search.hpp"
#include "sinew/sim/contact_way.hpp"
#include "sinew/sim/curve_contact.hpp"
#include "sinew/sim/first_guess.hpp"
#include "sinew/sim/places.hpp"
#include "sinew/threads/interruption.hpp"

namespace sinew {

namespace {

using Kind = Collider::Kind;
using contact::Simplex;

/// A point of the surface: that of the axis or core moved out along the normal.
Vec3 surface_point(const Simplex& own, const std::array<double, 3>& weights, const Vec3& out) {
  Vec3 p = own.radius * out + contact::lowest_on_rim(own, -out);
  for (std::size_t i = 0; i < static_cast<std::size_t>(own.corners()); ++i) p += weights[i] * own.x[i];
  return p;
}

/// The same of a side that may be a rod, whose axis is touched at `foot`.
Vec3 point_on(const ContactSide& side, const Simplex& own, const std::array<double, 3>& weights, const Vec3& foot,
              const Vec3& out) {
  return side.on.kind == Kind::rod ? Vec3(foot + own.radius * out) : surface_point(own, weights, out);
}

/// Where the material point p of a side, at an iterate, was at the start of the step.
Vec3 was(const ContactSide& side, const std::array<double, 3>& weights, const Vec3& p, const Moment& start,
         const Moment& now) {
  if (is_rigid(side.on)) {
    const contact::Pose from = start.pose(side.on), to = now.pose(side.on);
    return from * (to.R.transpose() * (p - to.p));
  }
  if (side.on.kind == Kind::rod) {  // the surface turns with the cross-section
    const double s = abscissa_of(side, weights);
    const rod::Branch from = rod::branch(start.rods[side.on.number], s), to = rod::branch(now.rods[side.on.number], s);
    return from.p + from.R * (to.R.transpose() * (p - to.p));
  }
  const Simplex before = start.placed(side), after = now.placed(side);
  Vec3 moved = Vec3::Zero();
  for (std::size_t i = 0; i < static_cast<std::size_t>(before.corners()); ++i)
    moved += weights[i] * (after.x[i] - before.x[i]);
  return p - moved;
}

/// Part of the model's size within which a pair that is to be pressed together is watched.
constexpr double kSoughtWithin = 0.1;
/// And within which all are, in a step from one equilibrium to the next.
constexpr double kStillWithin = 0.1;
/// What moves on with its velocities stays clear of others but for this part of a thickness.
constexpr double kClear = 0.1;
/// Contacts that a fall would close take part from the start, of those within this part of the model's size.
constexpr double kMostFall = 0.02;
/// Of such a pair so many of the nearest contacts take part, closed or not.
constexpr std::size_t kSoughtContacts = 40;

bool earlier(const ContactState& a, const ContactState& b) {
  return a.pair < b.pair || (a.pair == b.pair && a.part < b.part);
}

std::vector<Placement> rod_bases(const Model& model, const State& state) {
  std::vector<Placement> bases;
  for (std::size_t i = 0; i < model.rods.size(); ++i) bases.push_back(rod_base(model, state, static_cast<int>(i)));
  return bases;
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

/// The force of a contact, which keeps its place about the normal, as that is n.
Vec3 turned(const ContactState& own, const Vec3& n) {
  if (own.normal.isZero()) return own.force;
  return Eigen::Quaterniond::FromTwoVectors(own.normal, n) * own.force;
}

/// What a frame does to the world over the step.
Placement carried(const StepContext& context, const std::vector<Placement>& before, int frame) {
  return frame < 0 ? Placement{} : compose(context.moved(frame), inverse(before[static_cast<std::size_t>(frame)]));
}

/// Velocity of the material point p of a side: at the start of the step, of an obstacle over it; points of rods count
/// as at rest.
Vec3 velocity(const ContactSide& side, const std::array<double, 3>& weights, const Vec3& p, const StepContext& context,
              const std::vector<Placement>& frames) {
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
      return (apply(carried(context, frames, context.model.obstacles[side.on.number].frame), p) - p) / context.h;
    case Kind::rod:
      break;
  }
  return Vec3::Zero();
}

/// Velocity at the start of the step of the mass point of a rod that is nearest to a place; zero of rods without mass.
Vec3 rod_velocity(const StepContext& context, int rod, double s) {
  const std::vector<rod::MassPoint>& masses = context.model.rods[rod].rod.masses;
  if (masses.empty()) return Vec3::Zero();
  const auto nearer = [s](const rod::MassPoint& a, const rod::MassPoint& b) {
    return std::abs(a.s - s) < std::abs(b.s - s);
  };
  return context.start.rods[rod].velocity.col(std::min_element(masses.begin(), masses.end(), nearer) - masses.begin());
}

/// A contact takes part from now on, if it does not yet.
void play(ContactRoom& room, int contact) {
  const auto place = std::lower_bound(room.playing.begin(), room.playing.end(), contact);
  if (place == room.playing.end() || *place != contact) room.playing.insert(place, contact);
}

/// Of what lies in the plane of a face beside it: by less than this part of a thickness in a step it slides on in it.
constexpr double kSlides = 1e-3;
/// [m/s] of one side of a contact past the other, along a direction, at the start of the step.
double speed_along(const StepContext& context, const ContactState& own, const Moment& start, const Vec3& direction) {
  const Simplex a = start.placed(own.a), b = start.placed(own.b);
  const contact::Nearest nearest = contact::nearest(a, b);
  const Vec3 pa = surface_point(a, nearest.a, -nearest.normal), pb = pa - nearest.gap * nearest.normal;
  return direction.dot(velocity(own.a, nearest.a, pa, context, start.frames) -
                       velocity(own.b, nearest.b, pb, context, start.frames));
}

/// A contact as it is at the start of the step.
struct Beginning {
  double gap = 0.0;       ///< [m]
  double approach = 0.0;  ///< [m/s] of the gap, points of rods at rest
  double opens = 0.0;     ///< [m/s] of the gap, with the motion of rods
  contact::Facing facing;
  bool closes = false;  ///< within the step, along the direction that is kept in it
};
Beginning beginning(const StepContext& context, const ContactState& own, const Moment& start) {
  const Simplex a = start.placed(own.a), b = start.placed(own.b);
  contact::Nearest nearest = contact::nearest(a, b);
  const Feet feet = follow_curves(start, own, a, b, nearest);
  const Vec3& n = nearest.normal;
  const Vec3 pa = point_on(own.a, a, nearest.a, feet.a, -n), pb = pa - nearest.gap * n;
  const Vec3 past =
      velocity(own.a, nearest.a, pa, context, start.frames) - velocity(own.b, nearest.b, pb, context, start.frames);
  const double approach = n.dot(past);
  const auto along = [&](const ContactSide& side, const std::array<double, 3>& weights) {
    return side.on.kind == Kind::rod ? n.dot(rod_velocity(context, side.on.number, abscissa_of(side, weights))) : 0.0;
  };
  const contact::Facing facing = contact::facing(a, b);
  bool closes = nearest.gap + approach * context.h < 0.0;
  if (facing.kind == contact::Facing::Kind::face && b.kind == Simplex::Kind::triangle) {  // it goes on past its rim
    const contact::Nearest kept = contact::nearest(a, b, facing);
    closes = closes || kept.gap + kept.normal.dot(past) * context.h < 0.0;
  }
  return {nearest.gap, approach, approach + along(own.a, nearest.a) - along(own.b, nearest.b), facing, closes};
}

/// Whether a contact is one of a corner or of two edges, of two different solids or rigid shapes.
bool of_corner_or_edges(const ContactState& candidate) {
  const Collider &first = candidate.a.on, &second = candidate.b.on;
  if (first.kind == Kind::rod || second.kind == Kind::rod || first == second) return false;
  const Simplex &a = candidate.a.local, &b = candidate.b.local;
  return (a.kind == Simplex::Kind::point && a.radius == 0.0) ||
         (a.kind == Simplex::Kind::segment && b.kind == Simplex::Kind::segment);
}

/// Takes out of the contacts, and of what is known of each, what the velocities of the start lead past the other
/// object, clear of it on all of its way, and what presses on nothing there; but not of pairs that have `met`. The
/// iterate is the first guess of the step.
void let_pass(const StepContext& context, const Moment& start, const std::vector<int>& met, State& iterate,
              std::vector<Beginning>& began, ContactRoom& room) {
  const Model& model = context.model;
  std::vector<ContactState>& all = iterate.contacts;
  // Of two rigid shapes either all contacts are met or none.
  enum class Way : char { apart, near, meets, passes };
  std::vector<Way> shapes(model.pairs.size(), Way::apart);
  std::vector<char> may_pass(all.size(), 0);
  bool one_may = false;
  for (std::size_t i = 0; i < all.size(); ++i) {
    const ContactState& own = all[i];
    const PairModel& pair = model.pairs[own.pair];
    if (std::find(met.begin(), met.end(), own.pair) != met.end()) continue;
    const bool is_free = !pair.sought && own.force.isZero() && began[i].gap > 0.0;
    if (are_shapes(model, pair)) {
      Way& way = shapes[own.pair];
      if (!is_free) way = Way::meets;
      if (way == Way::apart && began[i].closes) way = Way::near;
      one_may = one_may || way == Way::near;
    } else if (is_free && of_corner_or_edges(own)) {
      may_pass[i] = began[i].closes;
      one_may = one_may || may_pass[i];
    }
  }
  if (!one_may) return;
  State there = iterate;
  move_by(context, context.h, there);
  const Moment end{model, there, context.displacement, room.start};
  const StepMotion motion{start, end};
  const auto turns_far = [&](const Collider& object) {
    return object.kind == Kind::body && context.h * context.start.bodies[object.number].w.norm() > kMostTurn;
  };
  struct Known {
    double speed = -1.0;
    Way edges = Way::near;
  };
  std::vector<Known> known(model.pairs.size());
  for (std::size_t i = 0; i < model.pairs.size(); ++i) {
    threads::Interruption::check();
    const PairModel& pair = model.pairs[i];
    if (turns_far(pair.a) || turns_far(pair.b)) {
      shapes[i] = known[i].edges = Way::meets;
    } else if (shapes[i] == Way::near) {
      shapes[i] = shapes_stay_clear(motion, pair, kClearance * room.thin[i]) ? Way::passes : Way::meets;
    }
  }
  const auto passes = [&](const ContactState& own) {
    const auto number = static_cast<std::size_t>(own.pair);
    const PairModel& pair = model.pairs[number];
    auto& [speed, edges] = known[number];
    if (edges == Way::meets) return false;
    if (speed < 0.0) speed = farthest(motion, room.surfaces, pair.a) + farthest(motion, room.surfaces, pair.b);
    const double margin = kClearance * room.thin[number];
    if (!point_stays_clear(motion, own, room.surfaces, speed, margin)) return false;
    if (edges == Way::near)
      edges = edges_stay_clear(motion, room.surfaces, own.pair, speed, margin) ? Way::passes : Way::meets;
    return edges == Way::passes;
  };
  std::size_t kept = 0;
  for (std::size_t i = 0; i < all.size(); ++i) {
    const ContactState& own = all[i];
    if (shapes[own.pair] == Way::passes || (may_pass[i] && passes(own))) {
      room.passing.push_back(own);
      continue;
    }
    if (kept != i) {
      all[kept] = std::move(all[i]);
      began[kept] = began[i];
    }
    ++kept;
  }
  all.resize(kept);
  began.resize(kept);
}

/// The gap that a contact must have at the end of the step.
double least_gap(const StepContext& context, double restitution, const Beginning& now) {
  if (context.rate == 0.0) return 0.0;
  const double gravity = context.gravity.norm();
  if (now.gap < 0.0) {
    // Bodies that overlap are lifted no faster than a fall from that height, or in some fifty steps without gravity; in
    // parts of steps at the same speed.
    const double part = std::min(1.0, context.h / context.model.scene.time.step);
    const double lift = std::max(std::sqrt(gravity * -now.gap) * context.h, -0.02 * now.gap * part);
    return std::min(0.0, now.gap + lift);
  }
  // What rests on the ground falls by g h in every step, and is not to bounce.
  const bool hits = now.gap + now.approach * context.h < 0.0 && -now.approach > 2.0 * gravity * context.h;
  return restitution > 0.0 && hits ? now.gap - restitution * now.approach * context.h : 0.0;
}

/// Whether the normal of a contact turns as its parts move; pieces of rods leave it out.
bool turns(const ContactState& own, const Simplex& a, const Simplex& b) {
  return b.kind != Simplex::Kind::plane && !is_piece_of_rod(own.a, a) && !is_piece_of_rod(own.b, b);
}

contact::GapHessian contact_stiffness(const Touch& touch, const Simplex& a, const Simplex& b,
                                      const contact::Facing& facing) {
  return -touch.force.dot(touch.nearest.normal) * contact::gap_hessian(a, b, touch.nearest, facing);
}

}  // namespace

double alarm_distance(const StepContext& context) {
  if (context.model.pairs.empty()) return 0.0;
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
  const std::vector<Placement> frames = frames_at(context.model, context.start.time);
  for (const ObstacleModel& obstacle : context.model.obstacles) {
    const Placement moved = carried(context, frames, obstacle.frame);
    const Vec3& middle = context.model.middle;
    const double far = (apply(moved, middle) - middle).norm() + lie::log(moved.R).norm() * context.model.size;
    fastest = std::max(fastest, far / context.h);
  }
  const bool moves = context.rate > 0.0;
  const double fall = moves ? context.gravity.norm() * context.h : 0.0;
  return 2.0 * context.h * (fastest + fall) + (moves ? 2e-3 : kStillWithin) * context.model.size;
}

void find_contacts(const StepContext& context, State& iterate, ContactRoom& room, double alarm,
                   const EarlierLooks& earlier_looks) {
  if (context.model.pairs.empty()) return;
  std::swap(room.start, room.now);  // (most steps start as the last one ended)
  configure_touching(context.model, rod_bases(context.model, context.start), context.start, room.start);
  const std::vector<Placement> frames = frames_at(context.model, context.start.time);
  const Moment start{context.model, context.start, frames, room.start};
  std::vector<ContactState> found;
  room.surfaces.fit(start);
  const double fall = context.rate > 0.0 ? context.gravity.norm() * context.h * context.h : 0.0;
  const double depth = 2.0 * fall + 2e-3 * context.model.size;
  const double far = std::max(alarm, kSoughtWithin * context.model.size);
  for (std::size_t i = 0; i < context.model.pairs.size(); ++i) {
    threads::Interruption::check();
    search(start, context.model.pairs[i].sought ? far : alarm, depth, room.surfaces, static_cast<int>(i), found);
  }
  std::stable_sort(found.begin(), found.end(), earlier);
  // What was there keeps its force.
  auto old = iterate.contacts.begin();
  for (ContactState& own : found) {
    while (old != iterate.contacts.end() && earlier(*old, own)) ++old;
    if (old == iterate.contacts.end() || earlier(own, *old)) continue;
    own.force = old->force;
    own.normal = old->normal;
  }
  room.left_out.clear();
  std::erase_if(found, [&](const ContactState& own) {
    const ContactKey key(own.pair, own.part);
    const auto& behind = earlier_looks.left_behind;
    const bool left_out = std::find(behind.begin(), behind.end(), key) != behind.end();
    if (left_out) room.left_out.push_back(own.pair);
    return left_out;
  });
  room.found.clear();
  for (const ContactState& own : found) room.found.emplace_back(own.pair, own.part);
  if (room.thin.empty()) {
    for (const PairModel& pair : context.model.pairs)
      room.thin.push_back(std::min(thickness_of(context.model, pair.a), thickness_of(context.model, pair.b)));
  }
  std::erase_if(found, [&](const ContactState& own) {
    return !own.grazed.isZero(0.0) &&
           std::abs(speed_along(context, own, start, own.grazed)) * context.h < kSlides * room.thin[own.pair];
  });
  merge_rod_contacts(start, room.thin, found);
  reduce_patches(start, found);
  iterate.contacts = std::move(found);
  std::vector<Beginning> began;
  began.reserve(iterate.contacts.size());
  for (const ContactState& own : iterate.contacts) began.push_back(beginning(context, own, start));
  room.passing.clear();
  if (context.rate > 0.0 && !earlier_looks.nothing_passes)
    let_pass(context, start, earlier_looks.met, iterate, began, room);
  room.least.clear();
  room.gaps.clear();
  room.facings.clear();
  room.playing.clear();
  room.clear = 1.0;
  const double reached = std::min(fall, kMostFall * context.model.size);  // [m] by a fall
  std::vector<std::vector<std::pair<double, int>>> sought(context.model.pairs.size());
  for (std::size_t i = 0; i < iterate.contacts.size(); ++i) {
    const ContactState& own = iterate.contacts[i];
    const Beginning& now = began[i];
    room.gaps.push_back(now.gap);
    room.least.push_back(least_gap(context, context.model.pairs[own.pair].restitution, now));
    room.facings.push_back(now.facing);
    const double into = -now.opens * context.h, until = std::max(0.0, now.gap + kClear * room.thin[own.pair]);
    if (into > until) room.clear = std::min(room.clear, until / into);
    const auto number = static_cast<int>(i);
    if (!own.force.isZero() || now.gap + now.approach * context.h < reached) room.playing.push_back(number);
    if (context.model.pairs[own.pair].sought) sought[own.pair].emplace_back(now.gap, number);
  }
  for (auto& near : sought) {
    std::sort(near.begin(), near.end());
    if (near.size() > kSoughtContacts) near.resize(kSoughtContacts);
    for (const auto& [gap, number] : near) {
      play(room, number);
    }
  }
}

std::vector<Overlap> overlaps(const Model& model, const State& start) {
  std::vector<Overlap> found;
  if (model.pairs.empty()) return found;
  std::vector<rod::Configuration> rods;
  configure_touching(model, rod_bases(model, start), start, rods);
  const std::vector<Placement> frames = frames_at(model, start.time);
  const Moment now{model, start, frames, rods};
  Surfaces surfaces;
  surfaces.fit(now);
  for (std::size_t i = 0; i < model.pairs.size(); ++i) {
    const double depth = overlap(now, surfaces, static_cast<int>(i));
    if (depth > 1e-6 * model.size) found.push_back({static_cast<int>(i), depth});
  }
  return found;
}

void finish_contacts(const StepContext& context, const ContactRoom& room, State& next) {
  for (std::size_t i = 0; i < next.contacts.size(); ++i) {
    ContactState& own = next.contacts[i];
    const Touch& touch = room.touches[i];
    own.point = touch.point_b;
    own.force = turned(own, touch.nearest.normal);
    own.normal = touch.nearest.normal;
    own.gap = touch.nearest.gap;
    own.slip = touch.u.tail<2>().norm();
  }
  // What the solver left of forces that went is not a contact.
  double largest = 0.0;
  for (const ContactState& own : next.contacts) largest = std::max(largest, own.force.dot(own.normal));
  // Of what is sought and does not touch yet, the nearest is kept.
  std::vector<const ContactState*> kept(context.model.pairs.size(), nullptr);
  for (ContactState& own : next.contacts) {
    if (own.force.dot(own.normal) > 1e-12 * largest) continue;
    own.force.setZero();
    if (context.model.pairs[own.pair].sought && (!kept[own.pair] || own.gap < kept[own.pair]->gap))
      kept[own.pair] = &own;
  }
  for (const ContactState& own : next.contacts) {
    if (!own.force.isZero()) kept[own.pair] = nullptr;
  }
  std::vector<ContactState> near;
  for (const ContactState* own : kept) {
    if (own) near.push_back(*own);
  }
  std::erase_if(next.contacts, [](const ContactState& own) { return own.force.isZero(); });
  if (near.empty()) return;
  next.contacts.insert(next.contacts.end(), near.begin(), near.end());
  std::stable_sort(next.contacts.begin(), next.contacts.end(), earlier);
}

void evaluate_contacts(const StepContext& context, const State& iterate, ContactRoom& room) {
  room.touches.resize(iterate.contacts.size());
  if (iterate.contacts.empty()) return;
  configure_touching(context.model, context.bases, iterate, room.now);
  const std::vector<Placement> frames = frames_at(context.model, context.start.time);
  const Moment start{context.model, context.start, frames, room.start};
  const Moment now{context.model, iterate, context.displacement, room.now};
  for (std::size_t i = 0; i < room.touches.size(); ++i) {
    const ContactState& own = iterate.contacts[i];
    Touch& touch = room.touches[i];
    const Simplex a = now.placed(own.a), b = now.placed(own.b);
    touch.nearest = contact::nearest(a, b, room.facings[i]);
    const Feet feet = follow_curves(now, own, a, b, touch.nearest);
    const Vec3& n = touch.nearest.normal;
    touch.frame = frame_of(n);
    touch.force = turned(own, n);
    touch.stiffness.resize(0, 0);
    touch.of_rod.setZero();
    const bool of_a = own.a.on.kind == Kind::rod && own.b.on.kind == Kind::obstacle,
               of_b = own.b.on.kind == Kind::rod && own.a.on.kind == Kind::obstacle;
    if ((of_a || of_b) && touch.force.dot(n) > 0.0) {
      if (is_piece_of_rod(own.a, a) || is_piece_of_rod(own.b, b)) {
        touch.of_rod = -touch.force.dot(n) * curve_gap_hessian(now, own, a, b, touch.nearest);
      } else if (of_a && turns(own, a, b)) {
        touch.of_rod.bottomRightCorner<3, 3>() = contact_stiffness(touch, a, b, room.facings[i]).topLeftCorner<3, 3>();
      }
    }
    touch.point_a = point_on(own.a, a, touch.nearest.a, feet.a, -n);
    touch.point_b = b.kind == Simplex::Kind::plane ? Vec3(touch.point_a - touch.nearest.gap * n)
                                                   : point_on(own.b, b, touch.nearest.b, feet.b, n);
    const Vec3 slip = (touch.point_a - was(own.a, touch.nearest.a, touch.point_a, start, now)) -
                      (touch.point_b - was(own.b, touch.nearest.b, touch.point_b, start, now));
    touch.u = Vec3(touch.nearest.gap, slip.dot(touch.frame.col(1)), slip.dot(touch.frame.col(2)));
    if (touch.u[0] < room.least[i]) play(room, static_cast<int>(i));
  }
}

void add_contact_curvature(const StepContext& context, const State& iterate, ContactRoom& room) {
  const Moment now{context.model, iterate, context.displacement, room.now};
  for (std::size_t i = 0; i < room.touches.size(); ++i) {
    const ContactState& own = iterate.contacts[i];
    Touch& touch = room.touches[i];
    const bool on_solid = own.a.on.kind == Kind::solid || own.b.on.kind == Kind::solid;
    if (!on_solid || !(touch.force.dot(touch.nearest.normal) > 0.0)) continue;
    const Simplex a = now.placed(own.a), b = now.placed(own.b);
    if (turns(own, a, b)) touch.stiffness = contact_stiffness(touch, a, b, room.facings[i]);
  }
}

}  // namespace sinew
