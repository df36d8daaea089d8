#include "sinew/sim/contact_way.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <vector>

#include "sinew/lie/rotation.hpp"

namespace sinew {

namespace {

using Kind = Collider::Kind;
using contact::Simplex;

constexpr int kPlaces = 64;        ///< on the way are looked at at least where parts are near
constexpr int kMostPlaces = 4096;  ///< and at most: a motion of a thousand times the thinner of the two

contact::Pose between(const contact::Pose& from, const contact::Pose& to, double t) {
  return {from.R * lie::exp(t * lie::log(from.R.transpose() * to.R)), from.p + t * (to.p - from.p)};
}

/// A part of an object on its way.
Simplex placed(const StepMotion& motion, const ContactSide& side, double t) {
  if (is_rigid(side.on))
    return contact::moved(between(motion.start.pose(side.on), motion.end.pose(side.on), t), side.local);
  Simplex own = motion.start.placed(side);
  const Simplex to = motion.end.placed(side);
  for (std::size_t i = 0; i < static_cast<std::size_t>(own.corners()); ++i) own.x[i] += t * (to.x[i] - own.x[i]);
  return own;
}

}  // namespace

double separation(const StepMotion& motion, const ContactState& own, double t) {
  const Simplex a = placed(motion, own.a, t);
  const Model& model = motion.start.model;
  if (a.kind == Simplex::Kind::point && is_shape(model, own.b.on)) {
    const contact::Pose pose = between(motion.start.pose(own.b.on), motion.end.pose(own.b.on), t);
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

double gap_of_shapes(const StepMotion& motion, const PairModel& pair, double t, double alarm) {
  std::vector<contact::Meeting> meetings;
  const Model& model = motion.start.model;
  const contact::Pose a = between(motion.start.pose(pair.a), motion.end.pose(pair.a), t),
                      b = between(motion.start.pose(pair.b), motion.end.pose(pair.b), t);
  contact::meet(shape_of(model, pair.a), a, shape_of(model, pair.b), b, alarm, meetings);
  double least = INFINITY;
  for (const contact::Meeting& own : meetings) {
    const contact::Pose &of_a = own.swapped ? b : a, &of_b = own.swapped ? a : b;
    const double gap = contact::nearest(contact::moved(of_a, own.a), contact::moved(of_b, own.b)).gap;
    if (gap < std::min(alarm, least)) least = gap;
  }
  return least;
}

double overlap_of_shapes(const StepMotion& motion, const PairModel& pair, double t) {
  return std::max(0.0, -gap_of_shapes(motion, pair, t, 0.0));
}

double farthest(const StepMotion& motion, const Surfaces& surfaces, const Collider& own) {
  const Model& model = motion.start.model;
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
    case Kind::obstacle: {
      const contact::Pose from = motion.start.pose(own), to = motion.end.pose(own);
      const double turn = lie::log(from.R.transpose() * to.R).norm();
      const double far = contact::reach(shape_of(model, own), Eigen::Matrix3d::Identity()).norm();
      most = (to.p - from.p).norm() + (turn > 0.0 ? turn * std::min(far, model.size) : 0.0);
      break;
    }
  }
  return most;
}

double deepest_of_parts(const StepMotion& motion, const ContactState& own, double speed, double thin, double enough) {
  const double before = std::min(0.0, separation(motion, own, 0.0));
  // (No thin thing is stepped over, up to what a motion may cost at all.)
  const double shortest = std::clamp(0.25 * thin / speed, 1.0 / kMostPlaces, 1.0 / kPlaces);
  double deepest = 0.0;
  for (double t = 0.0;;) {
    const double gap = separation(motion, own, t);
    deepest = std::max(deepest, before - gap);
    if (t >= 1.0 || deepest > enough) return deepest;
    t = std::min(1.0, t + std::max(gap / speed, shortest));
  }
}

// Where they overlap already, a part of the thickness is a part of the way that oversteps nothing.
double deepest_of_shapes(const StepMotion& motion, const PairModel& pair, double speed, double thin, double enough) {
  const double shortest = std::clamp(0.25 * thin / speed, 1.0 / kMostPlaces, 1.0);
  const double before = pair.depth > 0.0 ? overlap_of_shapes(motion, pair, 0.0) : 0.0;
  double deepest = 0.0;
  for (double t = 0.0;;) {
    const double gap = gap_of_shapes(motion, pair, t, speed);
    deepest = std::max(deepest, -gap - before);
    if (t >= 1.0 || deepest > enough) return deepest;
    t = std::min(1.0, t + std::max(gap / speed, shortest));
  }
}

double deepest_of_point(const StepMotion& motion, const ContactState& own, const Surfaces& surfaces, double speed,
                        double thin, double enough) {
  const Model& model = motion.start.model;
  if (is_shape(model, own.b.on)) return deepest_of_parts(motion, own, speed, thin, enough);
  constexpr double kTurnOfPiece = 0.05;  // [rad] on which a point goes straight, as the other one sees it
  constexpr int kMostPieces = 64;
  const Surface& surface = *surfaces.of(own.b.on);
  double turn = 0.0;
  for (const Collider& object : {own.a.on, own.b.on}) {
    if (!is_rigid(object)) continue;
    turn += lie::log(motion.start.pose(object).R.transpose() * motion.end.pose(object).R).norm();
  }
  const bool rigid = is_rigid(own.b.on);
  const contact::Pose before = rigid ? motion.start.pose(own.b.on) : contact::Pose{};
  Vec3 shift = Vec3::Zero();
  if (!rigid) {
    const Simplex there = motion.start.placed(own.b), later = motion.end.placed(own.b);
    const contact::Nearest found = contact::nearest(motion.start.placed(own.a), there);
    for (std::size_t i = 0; i < static_cast<std::size_t>(there.corners()); ++i)
      shift += found.b[i] * (later.x[i] - there.x[i]);
  }
  const auto seen = [&](double t) -> Vec3 {
    const Vec3 x = placed(motion, own.a, t).x[0];
    if (!rigid) return x - t * shift;
    const contact::Pose now = between(before, motion.end.pose(own.b.on), t);
    return before * (now.R.transpose() * (x - now.p));
  };
  const int pieces = std::clamp(static_cast<int>(std::ceil(turn / kTurnOfPiece)), 1, kMostPieces);
  double deepest = 0.0;
  Vec3 from = seen(0.0);
  for (int i = 1; i <= pieces && !(deepest > enough); ++i) {
    const Vec3 to = seen(static_cast<double>(i) / pieces);
    deepest = std::max(deepest, depth_of_line(surface, contact::segment_at(from, to, Vec3::Zero(), 0.0), 0.0));
    from = to;
  }
  return deepest;
}

}  // namespace sinew
