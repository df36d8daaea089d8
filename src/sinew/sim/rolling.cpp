#include "sinew/sim/rolling.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "sinew/error/digits.hpp"
#include "sinew/lie/rotation.hpp"
#include "sinew/sim/curve_contact.hpp"

namespace sinew {

using Kind = Collider::Kind;
using contact::Simplex;

namespace {

constexpr double kCoarse = 0.01;   ///< of the way rolled in a step
constexpr double kMatters = 1e-7;  ///< of the scene's size: less in a step is nothing in ten thousand steps
constexpr double kRolls = 1e-3;    ///< of how far the surfaces turn: what comes with them does not roll
constexpr double kSticks = 0.999;  ///< of the friction there is
constexpr double kStands = 1e-3;   ///< sine of the tilt below which the lowest point of a rim is chance

/// How far a surface moves past a contact beyond its core, by how much the chord is off, and how far it would move past
/// something that stands still.
struct Rolled {
  Vec3 way = Vec3::Zero(), off = Vec3::Zero();  ///< [m]
  double turned = 0.0;                          ///< [m]
};
Rolled rolled(const Eigen::Matrix3d& R, const Eigen::Matrix3d& Q, const Vec3& arm) {
  const Vec3 way = lie::log(R * Q.transpose()).cross(arm);
  return {way, R.transpose() * arm - Q.transpose() * arm + way, lie::log(R).cross(arm).norm()};
}

/// Whether a side has a surface beyond its core that stands still in it.
bool has_arm(const ContactSide& side) {
  return side.on.kind == Kind::rod || (is_rigid(side.on) && (side.local.radius > 0.0 || !side.local.rim.isZero(0.0)));
}

/// Of one side with the surface's point p, whose outward normal was `before` and is `out`.
Rolled rolled(const ContactSide& side, const Simplex& placed, const std::array<double, 3>& weights, const Vec3& p,
              const Vec3& before, const Vec3& out, const Moment& start, const Moment& now) {
  const auto with_normal = [&] { return Eigen::Quaterniond::FromTwoVectors(before, out).toRotationMatrix(); };
  if (!has_arm(side)) return {};
  if (side.on.kind == Kind::rod) {
    const double s = abscissa_of(side, weights);
    const rod::Branch from = rod::branch(start.rods[side.on.number], s), to = rod::branch(now.rods[side.on.number], s);
    return rolled(to.R * from.R.transpose(), with_normal(), p - to.p);
  }
  const Eigen::Matrix3d R = now.pose(side.on).R * start.pose(side.on).R.transpose();
  if (placed.rim.isZero(0.0)) return rolled(R, with_normal(), placed.radius * out);
  const Simplex earlier = start.placed(side);
  const Vec3 axis = placed.rim.normalized(), axis_before = earlier.rim.normalized();
  if (axis.cross(out).norm() < kStands || axis_before.cross(before).norm() < kStands) return {};
  const auto axes = [](const Vec3& along, const Vec3& arm) {
    Eigen::Matrix3d own;
    own << along, arm.normalized(), along.cross(arm.normalized());
    return own;
  };
  const Vec3 arm = contact::lowest_on_rim(placed, -out), arm_before = contact::lowest_on_rim(earlier, -before);
  return rolled(R, axes(axis, arm) * axes(axis_before, arm_before).transpose(), arm);
}

}  // namespace

std::vector<Warning> assess_rolling(const StepContext& context, const State& next, const ContactRoom& room) {
  if (room.touches.size() != next.contacts.size() || next.contacts.empty()) return {};
  const std::vector<Placement> frames = frames_at(context.model, context.start.time);
  const Moment start{context.model, context.start, frames, room.start};
  const Moment now{context.model, next, context.displacement, room.now};
  double worst = kCoarse;
  int pair = -1;
  for (std::size_t i = 0; i < next.contacts.size(); ++i) {
    const ContactState& own = next.contacts[i];
    if (!has_arm(own.a) && !has_arm(own.b)) continue;
    const Touch& touch = room.touches[i];
    const Vec3& n = touch.nearest.normal;
    const double pressed = touch.force.dot(n), friction = context.model.pairs[own.pair].friction;
    if (!(pressed > 0.0) || !((touch.force - pressed * n).norm() < kSticks * friction * pressed)) continue;
    const Simplex a = start.placed(own.a), b = start.placed(own.b);
    contact::Nearest before = contact::nearest(a, b, room.facings[i]);
    follow_curves(start, own, a, b, before);
    const Rolled of_a =
                     rolled(own.a, now.placed(own.a), touch.nearest.a, touch.point_a, -before.normal, -n, start, now),
                 of_b = rolled(own.b, now.placed(own.b), touch.nearest.b, touch.point_b, before.normal, n, start, now);
    const auto along = [&n](const Vec3& v) { return (v - v.dot(n) * n).norm(); };
    const double way = along(of_a.way - of_b.way), off = along(of_a.off - of_b.off);
    if (!(way > kRolls * std::max(of_a.turned, of_b.turned)) ||
        !(off > std::max(worst * way, kMatters * context.model.size)))
      continue;
    worst = off / way;
    pair = own.pair;
  }
  if (pair < 0) return {};
  return {{.code = "coarse_rolling",
           .where = "contact",
           .message = name_of_pair(context.model, pair) + " roll on each other " + three_digits(100.0 * worst) +
                      " % off: they turn by too much in a step",
           .remedy = "take steps of " + three_digits(1e3 * context.h * std::sqrt(kCoarse / worst)) + " ms or less",
           .time = next.time,
           .value = worst,
           .limit = kCoarse,
           .steps = 1}};
}

}  // namespace sinew
