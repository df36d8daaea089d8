#include "sinew/sim/contact_way.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <variant>
#include <vector>

#include "sinew/lie/rotation.hpp"
#include "sinew/threads/interruption.hpp"

namespace sinew {

namespace {

using Kind = Collider::Kind;
using contact::Simplex;

constexpr int kPlaces = 64;        ///< on the way are looked at at least where parts are near
constexpr int kMostPlaces = 4096;  ///< and at most: a motion of a thousand times the thinner of the two

/// By how much a body or an obstacle turns on its way [rad].
double turn_of(const StepMotion& motion, const Collider& rigid) {
  return lie::log(motion.start.pose(rigid).R.transpose() * motion.end.pose(rigid).R).norm();
}

/// A part of an object on its way.
Simplex placed(const StepMotion& motion, const ContactSide& side, double t) {
  if (is_rigid(side.on))
    return contact::moved(pose_between(motion.start.pose(side.on), motion.end.pose(side.on), t), side.local);
  Simplex own = motion.start.placed(side);
  const Simplex to = motion.end.placed(side);
  for (std::size_t i = 0; i < static_cast<std::size_t>(own.corners()); ++i) own.x[i] += t * (to.x[i] - own.x[i]);
  return own;
}

}  // namespace

contact::Pose pose_between(const contact::Pose& from, const contact::Pose& to, double t) {
  return {from.R * lie::exp(t * lie::log(from.R.transpose() * to.R)), from.p + t * (to.p - from.p)};
}

double shortest_look(double speed, double thin) { return std::clamp(0.25 * thin / speed, 1.0 / kMostPlaces, 1.0); }

double separation(const StepMotion& motion, const ContactState& own, double t) {
  const Simplex a = placed(motion, own.a, t);
  const Model& model = motion.start.model;
  if (a.kind == Simplex::Kind::point && is_shape(model, own.b.on)) {
    const contact::Pose pose = pose_between(motion.start.pose(own.b.on), motion.end.pose(own.b.on), t);
    return gap_to_shape(shape_of(model, own.b.on), pose.R.transpose() * (a.x[0] - pose.p), a.radius);
  }
  const Simplex b = placed(motion, own.b, t);
  const contact::Nearest found = contact::nearest(a, b);
  if (b.kind == Simplex::Kind::triangle && std::min({found.b[0], found.b[1], found.b[2]}) > 1e-9) return found.gap;
  Vec3 apart = Vec3::Zero();
  for (std::size_t i = 0; i < static_cast<std::size_t>(a.corners()); ++i) apart += found.a[i] * a.x[i];
  for (std::size_t i = 0; i < static_cast<std::size_t>(b.corners()); ++i) apart -= found.b[i] * b.x[i];
  return apart.norm() - a.radius - b.radius;
}

namespace {

/// The nearest of two rigid shapes on their way: gap [m], infinite from `alarm` on, and normal, from the second to the
/// first.
struct Apart {
  double gap = INFINITY;
  Vec3 normal = Vec3::Zero();
};
Apart apart_on_way(const StepMotion& motion, const PairModel& pair, double t, double alarm) {
  std::vector<contact::Meeting> meetings;
  const Model& model = motion.start.model;
  const contact::Pose a = pose_between(motion.start.pose(pair.a), motion.end.pose(pair.a), t),
                      b = pose_between(motion.start.pose(pair.b), motion.end.pose(pair.b), t);
  contact::meet(shape_of(model, pair.a), a, shape_of(model, pair.b), b, alarm, meetings);
  Apart least;
  for (const contact::Meeting& own : meetings) {
    const contact::Pose &of_a = own.swapped ? b : a, &of_b = own.swapped ? a : b;
    const contact::Nearest found = contact::nearest(contact::moved(of_a, own.a), contact::moved(of_b, own.b));
    if (found.gap < std::min(alarm, least.gap)) least = {found.gap, own.swapped ? Vec3(-found.normal) : found.normal};
  }
  return least;
}

}  // namespace

double gap_of_shapes(const StepMotion& motion, const PairModel& pair, double t, double alarm) {
  return apart_on_way(motion, pair, t, alarm).gap;
}

double overlap_of_shapes(const StepMotion& motion, const PairModel& pair, double t) {
  return std::max(0.0, -gap_of_shapes(motion, pair, t, 0.0));
}

namespace {

/// [m] of anything that moves from a place.
double farthest_from(const Moment& now, const Vec3& place) {
  double far = 0.0;
  for (const SolidState& solid : now.state.solids)
    far = std::max(far, (solid.x.colwise() - place).colwise().norm().maxCoeff());
  Eigen::Matrix3Xd points;
  for (std::size_t i = 0; i < now.model.rods.size(); ++i) {
    if (now.model.rods[i].touching.empty()) continue;
    touching_points(now, static_cast<int>(i), points);
    far = std::max(far, (points.colwise() - place).colwise().norm().maxCoeff());
  }
  for (std::size_t i = 0; i < now.state.bodies.size(); ++i) {
    const double reach = contact::reach(now.model.bodies[i].shape, Eigen::Matrix3d::Identity()).norm();
    far = std::max(far, (now.state.bodies[i].p - place).norm() + reach);
  }
  return far;
}

/// The furthest that anything of a body or an obstacle moves as this turns [m]; of a half-space, where something is.
double farthest_by_turning(const StepMotion& motion, const Collider& rigid) {
  const double turn = turn_of(motion, rigid);
  if (turn == 0.0) return 0.0;
  const double reach = contact::reach(shape_of(motion.start.model, rigid), Eigen::Matrix3d::Identity()).norm();
  if (!std::isinf(reach)) return turn * reach;
  return turn * std::max(farthest_from(motion.start, motion.start.pose(rigid).p),
                         farthest_from(motion.end, motion.end.pose(rigid).p));
}

}  // namespace

double farthest(const StepMotion& motion, const Surfaces& surfaces, const Collider& own) {
  double most = 0.0;
  switch (own.kind) {
    case Kind::solid:
      most =
          (motion.end.state.solids[own.number].x - motion.start.state.solids[own.number].x).colwise().norm().maxCoeff();
      break;
    case Kind::rod: {
      Eigen::Matrix3Xd ends;
      touching_points(motion.end, own.number, ends);
      most = (ends - surfaces.points_of_rod(own.number)).colwise().norm().maxCoeff();
      break;
    }
    case Kind::body:
    case Kind::obstacle:
      most = (motion.end.pose(own).p - motion.start.pose(own).p).norm() + farthest_by_turning(motion, own);
      break;
  }
  return most;
}

double deepest_of_parts(const StepMotion& motion, const ContactState& own, double speed, double thin) {
  const double before = std::min(0.0, separation(motion, own, 0.0));
  // (No thin thing is stepped over, up to what a motion may cost at all.)
  const double shortest = std::min(shortest_look(speed, thin), 1.0 / kPlaces);
  double deepest = 0.0;
  for (double t = 0.0;;) {
    threads::Interruption::check();
    const double gap = separation(motion, own, t);
    deepest = std::max(deepest, before - gap);
    if (t >= 1.0) return deepest;
    t = std::min(1.0, t + std::max(gap / speed, shortest));
  }
}

double deepest_of_shapes(const StepMotion& motion, const PairModel& pair, double speed, double thin) {
  const double shortest = shortest_look(speed, thin);
  const double before = pair.depth > 0.0 ? overlap_of_shapes(motion, pair, 0.0) : 0.0;
  double deepest = 0.0;
  for (double t = 0.0;;) {
    threads::Interruption::check();
    const double gap = gap_of_shapes(motion, pair, t, speed);
    deepest = std::max(deepest, -gap - before);
    if (t >= 1.0) return deepest;
    t = std::min(1.0, t + std::max(gap / speed, shortest));
  }
}

namespace {

/// How far a part is beyond an end of an axis, along that [m]; negative beside it.
double beyond_ends(const Simplex& axis, const Simplex& part) {
  const Vec3 d = (axis.x[1] - axis.x[0]).normalized();
  double before = INFINITY, behind = INFINITY;
  for (std::size_t i = 0; i < static_cast<std::size_t>(part.corners()); ++i) {
    before = std::min(before, d.dot(axis.x[0] - part.x[i]));
    behind = std::min(behind, d.dot(part.x[i] - axis.x[1]));
  }
  return std::max(before, behind) - part.radius;
}

/// A lower bound of the distance of two parts: `separation`, but that ends of cylinders are flat.
double least_distance(const StepMotion& motion, const ContactState& own, double t) {
  double least = separation(motion, own, t);
  const auto is_flat = [&motion](const ContactSide& side) {
    return side.local.kind == Simplex::Kind::segment && is_rigid(side.on) &&
           std::holds_alternative<contact::Cylinder>(shape_of(motion.start.model, side.on)) && side.local.radius > 0.0;
  };
  if (is_flat(own.a)) least = std::max(least, beyond_ends(placed(motion, own.a, t), placed(motion, own.b, t)));
  if (is_flat(own.b)) least = std::max(least, beyond_ends(placed(motion, own.b, t), placed(motion, own.a, t)));
  return least;
}

}  // namespace

bool parts_stay_clear(const StepMotion& motion, const ContactState& own, double speed, double margin) {
  double t = 0.0;
  for (int place = 0; place < kMostPlaces; ++place) {
    threads::Interruption::check();
    const double gap = least_distance(motion, own, t);
    if (!(gap > margin)) return false;
    if (t >= 1.0) return true;
    t = std::min(1.0, t + gap / speed);
  }
  return false;
}

// Two shapes stay apart as long as they do along the normal n between their nearest points, in which
// - n . (motion of a - motion of b) and what points far from the middles move as these turn bring them together.
bool shapes_stay_clear(const StepMotion& motion, const PairModel& pair, double margin) {
  constexpr int kMost = 200;
  Vec3 shift = Vec3::Zero();
  double turning = 0.0;
  for (const auto& [object, sign] : {std::pair(pair.a, 1.0), std::pair(pair.b, -1.0)}) {
    turning += farthest_by_turning(motion, object);
    shift += sign * (motion.end.pose(object).p - motion.start.pose(object).p);
  }
  const double speed = shift.norm() + turning;
  double t = 0.0;
  for (int place = 0; place < kMost; ++place) {
    threads::Interruption::check();
    const Apart apart = apart_on_way(motion, pair, t, speed + 2.0 * margin);
    if (!(apart.gap > margin)) return false;
    if (std::isinf(apart.gap)) return true;
    const double closing = std::max(0.0, -apart.normal.dot(shift)) + turning;
    if (closing * (1.0 - t) < apart.gap - margin) return true;
    t += (apart.gap - 0.5 * margin) / closing;
  }
  return false;
}

bool point_stays_clear(const StepMotion& motion, const ContactState& own, const Surfaces& surfaces, double speed,
                       double margin) {
  if (own.a.local.kind != Simplex::Kind::point) return true;
  const Model& model = motion.start.model;
  if (is_shape(model, own.b.on)) return parts_stay_clear(motion, own, speed, margin);
  constexpr double kTurnOfPiece = 0.05;  // [rad] on which a point goes straight, as the other one sees it
  const Surface& surface = *surfaces.of(own.b.on);
  const bool rigid = is_rigid(own.b.on);
  // A point r from the middle of what turns by w in the step goes on an arc beside its chord, and what goes straight at
  // v does so as seen from there: by (w^2 r + 2 w v) / (8 n^2) on each of n pieces of the way at most.
  double turn = 0.0, bends = 0.0;
  const Vec3 start = placed(motion, own.a, 0.0).x[0];
  for (const Collider& object : {own.a.on, own.b.on}) {
    if (!is_rigid(object)) continue;
    const double angle = turn_of(motion, object);
    turn += angle;
    bends += angle * angle * ((start - motion.start.pose(object).p).norm() + speed) + 2.0 * angle * speed;
  }
  const int pieces = static_cast<int>(std::ceil(turn / kTurnOfPiece)) + 1;
  const double beside = 0.125 * bends / (pieces * pieces);
  const contact::Pose before = rigid ? motion.start.pose(own.b.on) : contact::Pose{};
  const auto seen = [&](double t) -> Vec3 {
    Vec3 x = placed(motion, own.a, t).x[0];
    if (!rigid) return x;
    const contact::Pose now = pose_between(before, motion.end.pose(own.b.on), t);
    return before * (now.R.transpose() * (x - now.p));
  };
  const auto& mesh = *surface.mesh;
  const double around = margin + beside + (rigid ? 0.0 : speed);
  bool clear = true;
  Vec3 from = seen(0.0);
  for (int i = 1; i <= pieces && clear; ++i) {
    const double before_piece = (i - 1.0) / pieces, after_piece = static_cast<double>(i) / pieces;
    const Vec3 to = seen(after_piece);
    contact::Box where;
    for (const Vec3& end : {from, to}) {
      where.extend(Vec3(end.array() - around));
      where.extend(Vec3(end.array() + around));
    }
    surface.faces.each_near(where, [&](int number) {
      if (!clear) return;
      std::array<Vec3, 3> x;
      Vec3 shift = Vec3::Zero();
      std::array<Vec3, 3> moves = {Vec3::Zero(), Vec3::Zero(), Vec3::Zero()};
      for (std::size_t k = 0; k < 3; ++k) {
        const int node = mesh.triangles[static_cast<std::size_t>(number)][k];
        x[k] = surface.x.col(node);
        if (!rigid) moves[k] = motion.end.state.solids[own.b.on.number].x.col(node) - x[k];
        shift += moves[k] / 3.0;
      }
      double differ = 0.0;  // what bends moves by the mean of a triangle's corners, but for this
      for (const Vec3& move : moves) differ = std::max(differ, (move - shift).norm());
      clear = distance_to_line(from - before_piece * shift, to - after_piece * shift, x) > margin + beside + differ;
    });
    from = to;
  }
  return clear;
}

}  // namespace sinew
