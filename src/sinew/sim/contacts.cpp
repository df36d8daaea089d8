#include "sinew/sim/contacts.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numeric>

#include "sinew/sim/contact_search.hpp"
#include "sinew/sim/places.hpp"

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

/// A contact takes part from now on, if it does not yet.
void play(ContactRoom& room, int contact) {
  const auto place = std::lower_bound(room.playing.begin(), room.playing.end(), contact);
  if (place == room.playing.end() || *place != contact) room.playing.insert(place, contact);
}

/// The point of a part with these weights, on its true curve if it is a piece of a rod, and the tangent there of what
/// the contact may slide along: zero of a point, at the end of a straight part and at the tips of a rod.
struct LinePoint {
  Vec3 x, tangent = Vec3::Zero();
  double speed = 0.0;        ///< [m] of x per unit of the second weight
  Vec3 bend = Vec3::Zero();  ///< [1/m] how the tangent turns along it
};
LinePoint line_point(const Moment& now, const ContactSide& side, const Simplex& placed,
                     const std::array<double, 3>& weights) {
  const bool inside = weights[1] > 0.0 && weights[1] < 1.0;
  if (placed.corners() != 2) {
    Vec3 x = Vec3::Zero();
    for (std::size_t i = 0; i < static_cast<std::size_t>(placed.corners()); ++i) x += weights[i] * placed.x[i];
    return {x};
  }
  if (side.on.kind == Kind::rod) {
    const rod::Configuration& shape = now.rods[side.on.number];
    const double s = abscissa_of(side, weights);
    const rod::CentrePoint point = rod::centre_point(shape, s);
    const bool tip = s <= 0.0 || s >= shape.rod->length();
    return {point.position, tip ? Vec3(Vec3::Zero()) : Vec3(point.derivative.normalized()),
            (side.abscissae[1] - side.abscissae[0]) * point.derivative.norm(), point.second};
  }
  const Vec3 along = placed.x[1] - placed.x[0];
  return {placed.x[0] + weights[1] * along, inside ? Vec3(along.normalized()) : Vec3(Vec3::Zero()), along.norm()};
}

/// The points of two parts where they touch, on their axes.
struct Feet {
  Vec3 a, b;
};

bool is_piece_of_rod(const ContactSide& side, const Simplex& placed) {
  return side.on.kind == Kind::rod && placed.corners() == 2;
}

/// The second weights that a contact of a line may have: a rod goes on beyond its piece, up to its ends; an edge ends.
struct WeightRange {
  double from = 0.0, to = 1.0;
  bool has(double weight) const { return weight >= from && weight <= to; }
};
WeightRange weight_range(const Moment& now, const ContactSide& side, const Simplex& placed) {
  constexpr double kBeyond = 0.5;  // of the piece: further away another one touches
  if (!is_piece_of_rod(side, placed)) return {};
  const double begin = side.abscissae[0], length = side.abscissae[1] - begin;
  return {std::max(-kBeyond, -begin / length),
          std::min(1.0 + kBeyond, (now.rods[side.on.number].rod->length() - begin) / length)};
}

/// Where two parts are nearest within these ranges, one of them a piece of a rod, from where their chords are: Gauss
/// and Newton's method for min |x_a - x_b|^2. False where a rod lies along a drum of about its own curvature and is
/// equally near all along.
bool nearest_on_curves(const Moment& now, const ContactState& own, const Simplex& a, const Simplex& b,
                       const WeightRange& range_a, const WeightRange& range_b, contact::Nearest& found) {
  constexpr double kLiesAlong = 0.3;  // of the distance of the axes times the curvature
  constexpr int kMostIterations = 20;
  std::array<double, 3>&s = found.a, &t = found.b;
  std::array<double, 3> s_before = s, t_before = t;
  double distance = INFINITY;
  const auto move = [](std::array<double, 3>& weights, const WeightRange& range, double by) {
    const double before = weights[1];
    weights[1] = std::clamp(before + by, range.from, range.to);
    weights[0] = 1.0 - weights[1];
    return weights[1] - before;
  };
  for (int i = 0; i < kMostIterations; ++i) {
    const LinePoint first = line_point(now, own.a, a, s), second = line_point(now, own.b, b, t);
    const Vec3 apart = first.x - second.x, dx = first.speed * first.tangent, dy = second.speed * second.tangent;
    if (std::max(std::abs(apart.dot(first.bend)), std::abs(apart.dot(second.bend))) > kLiesAlong) return false;
    // Where curvature jumps, between two sections, whole steps may go to and fro.
    if (!(apart.norm() <= distance * (1.0 + 1e-12))) {
      for (std::size_t k = 0; k < 2; ++k) {
        s[k] = std::midpoint(s[k], s_before[k]);
        t[k] = std::midpoint(t[k], t_before[k]);
      }
      continue;
    }
    distance = apart.norm();
    s_before = s;
    t_before = t;
    const double aa = dx.squaredNorm(), bb = dy.squaredNorm(), ab = dx.dot(dy), fa = apart.dot(dx), fb = -apart.dot(dy),
                 determinant = aa * bb - ab * ab;
    double moved = 0.0;
    if (determinant > 1e-3 * aa * bb) {
      moved = std::abs(move(s, range_a, -(bb * fa + ab * fb) / determinant)) +
              std::abs(move(t, range_b, -(aa * fb + ab * fa) / determinant));
    } else if (aa > 0.0) {
      moved = std::abs(move(s, range_a, -fa / aa));
    } else if (bb > 0.0) {
      moved = std::abs(move(t, range_b, -fb / bb));
    }
    if (moved < 1e-14) break;
  }
  return true;
}

/// Brings the places of a contact from the chords to the curves of rods, also where these go on beyond its pieces. A
/// place that then comes to the end of its range or of the other part is not the nearest, which another contact has: it
/// stays on its pieces. Where a rod lies along, the places on chords stay, which are unique.
void refine_place(const Moment& now, const ContactState& own, const Simplex& a, const Simplex& b,
                  contact::Nearest& found) {
  const auto leaves = [&now](const ContactSide& side, const Simplex& placed, double on_chord, double weight) {
    if (placed.corners() != 2) return false;
    const auto inside = [](double value, double from, double to) { return from < value && value < to; };
    const bool within_piece = inside(weight, 0.0, 1.0);
    if (!is_piece_of_rod(side, placed)) return inside(on_chord, 0.0, 1.0) && !within_piece;
    const WeightRange range = weight_range(now, side, placed);
    return !within_piece && !inside(weight, range.from, range.to);
  };
  const contact::Nearest on_chords = found;
  const bool one_place =
      nearest_on_curves(now, own, a, b, weight_range(now, own.a, a), weight_range(now, own.b, b), found);
  if (one_place && !leaves(own.a, a, on_chords.a[1], found.a[1]) && !leaves(own.b, b, on_chords.b[1], found.b[1]))
    return;
  found = on_chords;
  if (!nearest_on_curves(now, own, a, b, {}, {}, found)) found = on_chords;
}

/// The normal of a rod's point on a face, perpendicular to the rod. A smooth rod touches a flat face with its tangent
/// in it; a point that does not is one beside an edge, round which the rod bends, and no normal force pulls along a
/// rod.
void face_across(const Moment& now, const ContactSide& side, double radius, const Simplex& face,
                 contact::Nearest& found) {
  constexpr double kSteepest = 0.5;  // sine of the angle of rod and face beyond which its end hits, not its side
  const rod::Configuration& shape = now.rods[side.on.number];
  const double s = side.abscissae[0];
  if (s <= 0.0 || s >= shape.rod->length()) return;
  const rod::CentrePoint point = rod::centre_point(shape, s);
  const Vec3 tangent = point.derivative.normalized();
  const double along = tangent.dot(found.normal);
  if (std::abs(along) > kSteepest) return;
  const double cosine = std::sqrt(1.0 - along * along);
  const Vec3 normal = (found.normal - along * tangent) / cosine;
  const double distance = (found.gap + radius) / cosine;
  if (face.kind == Simplex::Kind::triangle) {  // where the line along the normal meets it, if it does
    const Vec3 d = face.x[1] - face.x[0], e = face.x[2] - face.x[0], up = d.cross(e),
               to = point.position - distance * normal - face.x[0];
    const double size = up.squaredNorm(), u = to.cross(e).dot(up) / size, v = d.cross(to).dot(up) / size;
    if (!(std::min({u, v, 1.0 - u - v}) >= 0.0)) return;
    found.b = {1.0 - u - v, u, v};
  }
  found.normal = normal;
  found.gap = distance - radius;
}

/// Brings a contact of a rod's piece from its chord to its true curve (`refine_place`). There the tangent of the curve
/// stands for it, a line that is carried by the cross-section: the normal is perpendicular to it (and to the other
/// line, if that is none that ends there), so that no normal force pulls along a rod; the feet are where the two lines
/// are nearest. So normals and gaps are off by second order in the section's length, where those of chords are off by l
/// kappa / 2.
Feet follow_curves(const Moment& now, const ContactState& own, const Simplex& a, const Simplex& b,
                   contact::Nearest& found) {
  const bool curved_a = is_piece_of_rod(own.a, a), curved_b = is_piece_of_rod(own.b, b);
  if (curved_a || curved_b) refine_place(now, own, a, b, found);
  const LinePoint first = line_point(now, own.a, a, found.a), second = line_point(now, own.b, b, found.b);
  if (!curved_a && !curved_b) {
    if (own.a.on.kind == Kind::rod && (b.kind == Simplex::Kind::plane || b.kind == Simplex::Kind::triangle))
      face_across(now, own.a, a.radius, b, found);
    return {first.x, second.x};
  }
  constexpr double kParallel = 0.05;  // sine of the angle below which two lines are side by side
  const Vec3 &t = first.tangent, &u = second.tangent, apart = first.x - second.x, both = t.cross(u);
  Vec3 n = found.normal;
  if (const double distance = apart.norm(); distance > 1e-9 * now.model.size)
    n = apart.dot(n) < 0.0 ? Vec3(-apart / distance) : Vec3(apart / distance);
  found.normal = n;
  found.gap = n.dot(apart) - a.radius - b.radius;
  Feet feet{first.x, second.x};
  if (both.norm() > kParallel) {
    n = both.dot(n) < 0.0 ? Vec3(-both.normalized()) : Vec3(both.normalized());
    const double along = t.dot(u), d = apart.dot(t), e = apart.dot(u), determinant = 1.0 - along * along;
    feet.a -= (d - along * e) / determinant * t;
    feet.b += (e - along * d) / determinant * u;
  } else {
    for (const Vec3& line : {t, u}) n -= line.dot(n) * line;
    if (!(n.norm() > 1e-6)) return feet;
    n.normalize();
    if (!t.isZero()) {
      feet.a -= apart.dot(t) * t;
    } else {
      feet.b += apart.dot(u) * u;
    }
  }
  // The tangent stands for the curve near its point alone, and edges and rods end: a foot beyond that is none.
  if (!weight_range(now, own.a, a).has(found.a[1] + t.dot(feet.a - first.x) / std::max(first.speed, 1e-300)) ||
      !weight_range(now, own.b, b).has(found.b[1] + u.dot(feet.b - second.x) / std::max(second.speed, 1e-300)))
    return {first.x, second.x};
  found.normal = n;
  found.gap = n.dot(feet.a - feet.b) - a.radius - b.radius;
  return feet;
}

/// Of two pieces of a rod that follow each other and touch the same part next to where they meet, one is enough: that
/// on which the nearest point lies or, if neither or both have it, that which carries a force. (Both would be as good
/// as the same row twice.)
void drop_neighbours(const Moment& start, std::vector<ContactState>& found) {
  constexpr double kSame = 0.1;  // of a piece
  struct Place {
    double s = 0.0, length = 0.0;
    bool at_end = false;
  };
  const auto place_of = [&start](const ContactState& own) {
    const Simplex a = start.placed(own.a), b = start.placed(own.b);
    contact::Nearest nearest = contact::nearest(a, b);
    const bool first = is_piece_of_rod(own.a, a);
    if (first || is_piece_of_rod(own.b, b)) refine_place(start, own, a, b, nearest);
    const ContactSide& side = first ? own.a : own.b;
    const std::array<double, 3>& weights = first ? nearest.a : nearest.b;
    return Place{abscissa_of(side, weights), side.abscissae[1] - side.abscissae[0],
                 weights[1] <= 0.0 || weights[1] >= 1.0};
  };
  const auto same_part = [](const ContactSide& a, const ContactSide& b) {
    return a.on == b.on && a.nodes == b.nodes && a.abscissae == b.abscissae && a.local.kind == b.local.kind &&
           a.local.x[0] == b.local.x[0] && (a.local.corners() < 2 || a.local.x[1] == b.local.x[1]);
  };
  std::vector<bool> dropped(found.size(), false);
  for (std::size_t i = 0; i < found.size(); ++i) {
    for (std::size_t j = i + 1; j < found.size() && found[j].pair == found[i].pair && !dropped[i]; ++j) {
      const ContactState &one = found[i], &other = found[j];
      const bool on_a = is_piece_of_rod(one.a, one.a.local) && one.a.on == other.a.on && same_part(one.b, other.b),
                 on_b = is_piece_of_rod(one.b, one.b.local) && one.b.on == other.b.on && same_part(one.a, other.a);
      if (dropped[j]) continue;
      if ((!on_a && !on_b) || (is_piece_of_rod(one.a, one.a.local) && is_piece_of_rod(one.b, one.b.local))) continue;
      const Place p = place_of(one), q = place_of(other);
      if (std::abs(p.s - q.s) > kSame * std::min(p.length, q.length)) continue;
      const bool keep_first = p.at_end != q.at_end ? q.at_end : !one.force.isZero(0.0) || other.force.isZero(0.0);
      dropped[keep_first ? j : i] = true;
      ContactState &kept = found[keep_first ? i : j], &gone = found[keep_first ? j : i];
      if (kept.force.isZero(0.0)) {  // the contact goes on from one piece to the next, with its force
        kept.force = gone.force;
        kept.normal = gone.normal;
      }
    }
  }
  std::size_t kept = 0;
  for (std::size_t i = 0; i < found.size(); ++i) {
    if (!dropped[i]) found[kept++] = found[i];
  }
  found.resize(kept);
}

/// A contact as it is at the start of the step.
struct Beginning {
  double gap = 0.0;       ///< [m]
  double approach = 0.0;  ///< [m/s] of the gap
};
Beginning beginning(const StepContext& context, const ContactState& own, const Moment& start) {
  const Simplex a = start.placed(own.a), b = start.placed(own.b);
  contact::Nearest nearest = contact::nearest(a, b);
  const Feet feet = follow_curves(start, own, a, b, nearest);
  const Vec3& n = nearest.normal;
  const Vec3 pa = point_on(own.a, a, nearest.a, feet.a, -n), pb = pa - nearest.gap * n;
  return {nearest.gap, n.dot(velocity(own.a, nearest.a, pa, context, start.frames) -
                             velocity(own.b, nearest.b, pb, context, start.frames))};
}

/// The gap that a contact must have at the end of the step.
double least_gap(const StepContext& context, double restitution, const Beginning& now) {
  if (context.rate == 0.0) return 0.0;
  const double gravity = context.gravity.norm();
  if (now.gap < 0.0) {
    // Bodies that overlap are lifted no faster than a fall from that height, or in some fifty steps without gravity.
    const double lift = std::max(std::sqrt(gravity * -now.gap) * context.h, -0.02 * now.gap);
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

contact::GapHessian tangent_of(const Touch& touch, const Simplex& a, const Simplex& b, const contact::Facing& facing) {
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

void find_contacts(const StepContext& context, State& iterate, ContactRoom& room, double alarm) {
  if (context.model.pairs.empty()) return;
  configure_touching(context.model, rod_bases(context.model, context.start), context.start, room.start);
  const std::vector<Placement> frames = frames_at(context.model, context.start.time);
  const Moment start{context.model, context.start, frames, room.start};
  std::vector<ContactState> found;
  room.surfaces.fit(start);
  const double fall = context.rate > 0.0 ? context.gravity.norm() * context.h * context.h : 0.0;
  const double depth = 2.0 * fall + 2e-3 * context.model.size;
  const double far = std::max(alarm, kSoughtWithin * context.model.size);
  for (std::size_t i = 0; i < context.model.pairs.size(); ++i)
    search(start, context.model.pairs[i].sought ? far : alarm, depth, room.surfaces, static_cast<int>(i), found);
  std::stable_sort(found.begin(), found.end(), earlier);
  // What was there keeps its force.
  auto old = iterate.contacts.begin();
  for (ContactState& own : found) {
    while (old != iterate.contacts.end() && earlier(*old, own)) ++old;
    if (old == iterate.contacts.end() || earlier(own, *old)) continue;
    own.force = old->force;
    own.normal = old->normal;
  }
  room.found.clear();
  for (const ContactState& own : found) room.found.emplace_back(own.pair, own.part);
  drop_neighbours(start, found);
  iterate.contacts = std::move(found);
  if (room.thin.empty()) {
    for (const PairModel& pair : context.model.pairs)
      room.thin.push_back(std::min(thickness_of(context.model, pair.a), thickness_of(context.model, pair.b)));
  }
  room.least.clear();
  room.gaps.clear();
  room.facings.clear();
  room.playing.clear();
  std::vector<std::vector<std::pair<double, int>>> sought(context.model.pairs.size());
  for (std::size_t i = 0; i < iterate.contacts.size(); ++i) {
    const ContactState& own = iterate.contacts[i];
    const Beginning now = beginning(context, own, start);
    room.gaps.push_back(now.gap);
    room.least.push_back(least_gap(context, context.model.pairs[own.pair].restitution, now));
    room.facings.push_back(contact::facing(start.placed(own.a), start.placed(own.b)));
    const auto number = static_cast<int>(i);
    if (!own.force.isZero() || now.gap + now.approach * context.h < fall) room.playing.push_back(number);
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
    touch.of_rod_point.setZero();
    const bool on_rod = own.a.on.kind == Kind::rod && own.b.on.kind == Kind::obstacle;
    if (on_rod && turns(own, a, b) && touch.force.dot(n) > 0.0)
      touch.of_rod_point = tangent_of(touch, a, b, room.facings[i]).topLeftCorner<3, 3>();
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
    if (turns(own, a, b)) touch.stiffness = tangent_of(touch, a, b, room.facings[i]);
  }
}

}  // namespace sinew
