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
constexpr double kDamped = 0.1;    ///< of the moments about a rod's axis
constexpr double kSpins = 0.01;    ///< [rad] in a step: a tenth of the energy of spin in a revolution

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

/// About a rod's axis, what turns it where it is touched, and how far it spins there in the step.
struct Spin {
  double moment = 0.0;  ///< [N m] sum of their sizes
  double turn = 0.0;    ///< [rad] >= 0
};

std::vector<Warning> assess_spin(const StepContext& context, const State& next, const ContactRoom& room) {
  const Model& model = context.model;
  std::vector<Spin> spins(model.rods.size());
  for (std::size_t i = 0; i < next.contacts.size(); ++i) {
    const Touch& touch = room.touches[i];
    if (touch.force.isZero(0.0)) continue;
    each_side(next.contacts[i], touch,
              [&](const ContactSide& side, const std::array<double, 3>& weights, const Vec3& point, double) {
                if (side.on.kind != Kind::rod) return;
                const double s = abscissa_of(side, weights);
                const rod::Branch from = rod::branch(room.start[side.on.number], s),
                                  to = rod::branch(room.now[side.on.number], s);
                const Vec3 axis = to.R.col(0);
                Spin& own = spins[static_cast<std::size_t>(side.on.number)];
                own.moment += std::abs(axis.dot((point - to.p).cross(touch.force)));
                own.turn = std::max(own.turn, std::abs(axis.dot(lie::log(to.R * from.R.transpose()))));
              });
  }
  double worst = kDamped, step = 0.0;
  int damped = -1;
  for (std::size_t n = 0; n < spins.size(); ++n) {
    const auto [moment, turn] = spins[n];
    if (turn <= kSpins) continue;
    double inertia = 0.0;  // polar, of the whole rod
    for (const rod::MassPoint& point : model.rods[n].rod.masses) inertia += point.mass * point.offset.squaredNorm();
    const double drag = 2.0 * inertia * std::sin(turn) * (1.0 - std::cos(turn)) * context.rate * context.rate;
    const double share = drag / (drag + moment);
    if (!(share > worst)) continue;
    worst = share;
    // (Where the contacts' moment is not much besides, it is there for the drag, and shrinks with it.)
    // The drag is as h, and share = drag / all. What is braked less spins faster: half of it is aimed at.
    constexpr double kAim = 0.5 * kDamped;
    const double shorter = kAim / (1.0 - kAim) * (1.0 - share) / share;
    step = context.h * (share > 0.5 ? kSpins / turn : std::max(shorter, kSpins / turn));
    damped = static_cast<int>(n);
  }
  if (damped < 0) return {};
  return {{.code = "spin_damped",
           .where = "rods." + model.rods[static_cast<std::size_t>(damped)].name,
           .message = "the time step brakes its spin with " + three_digits(100.0 * worst) +
                      " % of the moments about its axis, its own and those of contacts",
           .remedy = "take steps of " + three_digits(1e3 * step) + " ms or less, or make a `body` of what is stiff",
           .time = next.time,
           .value = worst,
           .limit = kDamped,
           .steps = 1}};
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
  std::vector<Warning> warnings = assess_spin(context, next, room);
  if (pair < 0) return warnings;
  warnings.push_back(
      {.code = "coarse_rolling",
       .where = "contact",
       .message = name_of_pair(context.model, pair) + " roll on each other " + three_digits(100.0 * worst) +
                  " % off: they turn by too much in a step",
       .remedy = "take steps of " + three_digits(1e3 * context.h * std::sqrt(kCoarse / worst)) + " ms or less",
       .time = next.time,
       .value = worst,
       .limit = kCoarse,
       .steps = 1});
  return warnings;
}

}  // namespace sinew
