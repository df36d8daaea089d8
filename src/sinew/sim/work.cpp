#include "sinew/sim/work.hpp"

#include <Eigen/Dense>
#include <algorithm>

#include "sinew/lie/rotation.hpp"
#include "sinew/sim/motors.hpp"
#include "sinew/sim/places.hpp"
#include "sinew/sim/rod_rows.hpp"
#include "sinew/sim/solid_loads.hpp"

namespace sinew {

namespace {

/// Work of a load whose factor goes from one value to another.
Work work_of(const RodLoadModel& load, const StepContext& context, const State& next, double before, double after) {
  const Model& model = context.model;
  const rod::Rod& rod = model.rods[load.rod].rod;
  const Placement base = rod_base(model, context.start, load.rod);
  const auto start = rod::configure(rod, {base, context.start.rods[load.rod].turned}, context.start.rods[load.rod].q);
  const auto end = rod::configure(rod, base_of(context, next, load.rod), next.rods[load.rod].q);
  double first = 0.0, last = 0.0;  // of the whole load, as it lies at the start and at the end
  for (const RodLoadModel::At& at : load.at) {
    const rod::Branch a = rod::branch(start, at.s), b = rod::branch(end, at.s);
    const Vec3 along = b.p - a.p, about = lie::log(b.R * a.R.transpose());
    const auto of = [&](const rod::Mat3& axes) {
      return at.weight * ((axes * load.force).dot(along) + (axes * load.moment).dot(about));
    };
    first += of(load.follower ? a.R : rod::Mat3::Identity());
    last += of(load.follower ? b.R : rod::Mat3::Identity());
  }
  return Work{before * first, after * last};
}

Work work_of(const SolidLoadModel& load, const StepContext& context, const State& next, double before, double after) {
  const Eigen::Matrix3Xd &from = context.start.solids[load.solid].x, &to = next.solids[load.solid].x;
  return Work{before * load_forces(load, from).cwiseProduct(to - from).sum(),
              after * load_forces(load, to).cwiseProduct(to - from).sum()};
}

/// Work of what holds a solid where it is held to move, and of the frame that its springs pull at.
Work work_of_supports(const StepContext& context, const State& next, int number) {
  const SolidModel& model = context.model.solids[number];
  const SolidState &from = context.start.solids[number], &to = next.solids[number];
  Work sum;
  Eigen::Index held = 0;
  solid::each_held(model.body, [&](int axis, int node) {
    const double way = to.x(axis, node) - from.x(axis, node);
    sum += Work{from.reaction[held] * way, to.reaction[held] * way};
    ++held;
  });
  if (model.springs.size() == 0) return sum;
  const Placement before = moved(context.model, context.start, model.frame), after = context.moved(model.frame);
  const Eigen::Matrix3Xd carried = ((after.R - before.R) * model.body.rest).colwise() + Vec3(after.p - before.p);
  const auto of = [&](const Eigen::Matrix3Xd& stretch) {
    return -model.springs.cwiseProduct(stretch).cwiseProduct(carried).sum();
  };
  return sum += Work{of(spring_stretch(model, before, from.x)), of(spring_stretch(model, after, to.x))};
}

/// A force and a moment about a point.
struct Wrench {
  Vec3 force = Vec3::Zero(), moment = Vec3::Zero();
};

/// A frame's motion over the step, as one of the world: x -> carried x.
struct Carry {
  Placement carried;

  Carry(const StepContext& context, int frame)
      : carried(compose(context.moved(frame), inverse(moved(context.model, context.start, frame)))) {}
  /// Work of a wrench as the frame carries its point from p.
  double work_from(const Wrench& own, const Vec3& p) const { return of(own, apply(carried, p) - p); }
  /// As it carries its point to p.
  double work_to(const Wrench& own, const Vec3& p) const { return of(own, p - apply(inverse(carried), p)); }

 private:
  double of(const Wrench& own, const Vec3& way) const {
    return own.force.dot(way) + own.moment.dot(lie::log(carried.R));
  }
};

/// With which a rod's base is held, which is turned by R: the opposite of what the rod exerts on it.
Wrench held_by_base(const rod::Mat3& R, const RodState& state) {
  Eigen::Index first = 0;
  while (first + 1 < state.internal.cols() && state.internal(0, first) < 0.0) ++first;
  return {R * -state.internal.block<3, 1>(4, first), R * -state.internal.block<3, 1>(1, first)};
}

/// With which a frame holds a rod by an attachment, whose rows are along and about its axes; the rod's cross-section
/// there is turned by R.
Wrench held_by_attachment(const TieModel& tie, const rod::Mat3& axes, const rod::Mat3& R,
                          const Eigen::VectorXd& lambda) {
  Wrench own;
  int row = tie.row;
  for (const int a : tie.along) own.force -= lambda[row++] * axes.col(a);
  for (const int a : tie.about) {
    const HeldTurn turn = held_turn(tie, a);
    const Vec3 carried = turn.sign * R * tie.own_axes.col(turn.carried);
    own.moment += lambda[row++] * tie.length * carried.cross(axes.col(turn.held));
  }
  return own;
}

/// Work of frames that move bases of rods and cables, attachments and obstacles.
Work work_of_frames(const StepContext& context, const State& next, const std::vector<Touch>& touches) {
  const Model& model = context.model;
  const auto moves = [&model](int frame) { return frame >= 0 && model.scene.frames[frame].second.motion.has_value(); };
  Work sum;
  // Of wrenches at a point that the frame carries from p.
  const auto add = [&](const Wrench& before, const Wrench& after, int frame, const Vec3& p) {
    const Carry carry(context, frame);
    sum += Work{carry.work_from(before, p), carry.work_from(after, p)};
  };
  for (std::size_t i = 0; i < model.rods.size(); ++i) {
    if (!moves(model.rods[i].frame)) continue;
    const auto number = static_cast<int>(i);
    const rod::Rod& rod = model.rods[i].rod;
    const RodState &from = context.start.rods[i], &to = next.rods[i];
    const Placement before = rod::first_frame(rod, {rod_base(model, context.start, number), from.turned}, from.q),
                    after = rod::first_frame(rod, base_of(context, next, number), to.q);
    add(held_by_base(before.R, from), held_by_base(after.R, to), model.rods[i].frame, before.p);
  }
  for (std::size_t i = 0; i < model.cables.size(); ++i) {
    const GeometricCableModel& cable = model.cables[i];
    if (!moves(cable.frame) || cable.cable.points == 0) continue;
    const auto held = [&](const State& state, const Placement& base) {
      const Eigen::VectorXd& z = state.cables[i].z;
      const Vec3 start = apply(base, Vec3(-z[0], 0.0, 0.0));
      return Wrench{-state.lambda[cable.length_row] * (z.segment<3>(1) - start).normalized(), Vec3::Zero()};
    };
    const Placement before = cable_base(model, context.start, static_cast<int>(i));
    add(held(context.start, before), held(next, context.cable_bases[i]), cable.frame, before.p);
  }
  for (const TieModel& tie : model.ties) {
    if (tie.body() || !moves(tie.frame)) continue;
    const Placement before = compose(moved(model, context.start, tie.frame), tie.holder),
                    after = compose(context.moved(tie.frame), tie.holder);
    const rod::Rod& rod = model.rods[tie.rod].rod;
    const auto turned = [&](const rod::Base& base, const RodState& state) -> rod::Mat3 {
      if (tie.about.empty()) return rod::Mat3::Identity();  // its rows are of forces alone
      return rod::branch(rod::configure(rod, base, state.q), tie.s).R;
    };
    const RodState& start = context.start.rods[tie.rod];
    const rod::Mat3 from = turned({rod_base(model, context.start, tie.rod), start.turned}, start),
                    to = turned(base_of(context, next, tie.rod), next.rods[tie.rod]);
    add(held_by_attachment(tie, before.R, from, context.start.lambda),
        held_by_attachment(tie, after.R, to, next.lambda), tie.frame, before.p);
  }
  // What an obstacle presses with, where it presses: at the start of its way there, or at the end.
  const auto pressed = [&](const ContactState& contact, const Vec3& force, const Vec3& point, bool at_end) {
    const PairModel& pair = model.pairs[contact.pair];
    for (const Collider& own : {pair.a, pair.b}) {
      if (own.kind != Collider::Kind::obstacle || !moves(model.obstacles[own.number].frame)) continue;
      const bool is_a = own == (contact.on_second ? pair.b : pair.a);
      const Wrench by_it{is_a ? Vec3(-force) : force, Vec3::Zero()};
      const Carry carry(context, model.obstacles[own.number].frame);
      sum += at_end ? Work{0.0, carry.work_to(by_it, point)} : Work{carry.work_from(by_it, point), 0.0};
    }
  };
  for (const ContactState& own : context.start.contacts) pressed(own, own.force, own.point, false);
  const bool at_iterate = touches.size() == next.contacts.size();
  for (std::size_t i = 0; i < next.contacts.size(); ++i) {
    const ContactState& own = next.contacts[i];
    pressed(own, at_iterate ? touches[i].force : own.force, at_iterate ? touches[i].point_b : own.point, true);
  }
  return sum;
}

}  // namespace

Work work(const StepContext& context, const State& next, const std::vector<Touch>& touches) {
  const Model& model = context.model;
  Work sum;
  // What is applied from the start acts in full over the first step in time. Parts of one, and equilibria, begin with
  // nothing.
  const bool whole = model.scene.analysis == Analysis::dynamic && context.h > 0.999 * model.scene.time.step;
  const bool first = context.start.time == 0.0 && whole;
  for (std::size_t i = 0; i < model.actuators.size(); ++i) {
    const ActuatorModel& actuator = model.actuators[i];
    const double force =
        first && actuator.told_force() ? told_at(actuator.drive, context.start.time) : context.start.actuators[i];
    const double way = motor_position(model, next, actuator) - motor_position(model, context.start, actuator);
    sum += Work{force * way, next.actuators[i] * way};
  }
  for (std::size_t i = 0; i < model.loads.size(); ++i) {
    const double before = first ? told_at(model.loads[i].factor, context.start.time) : context.start.loads[i];
    const double after = context.command.loads[i];
    sum += std::visit([&](const auto& load) { return work_of(load, context, next, before, after); }, model.loads[i].on);
  }
  if (std::any_of(model.scene.frames.begin(), model.scene.frames.end(),
                  [](const auto& frame) { return frame.second.motion.has_value(); }))
    sum += work_of_frames(context, next, touches);
  for (std::size_t i = 0; i < model.solids.size(); ++i) sum += work_of_supports(context, next, static_cast<int>(i));
  for (const Grip& grip : context.command.grips) {
    const Vec3 from = context.start.solids[grip.solid].x.col(grip.node), to = next.solids[grip.solid].x.col(grip.node);
    sum += Work{grip.stiffness * (grip.to - from).dot(to - from), grip.stiffness * (grip.to - to).dot(to - from)};
  }
  return sum;
}

Work work_of_lifting(const Model& model, const State& next, const ContactRoom& room) {
  Work sum;
  if (room.touches.size() != next.contacts.size()) return sum;
  for (std::size_t i = 0; i < next.contacts.size(); ++i) {
    if (!overlaps_since_the_start(model, next.contacts[i], room.gaps[i])) continue;
    const Touch& touch = room.touches[i];
    const double way = std::min(touch.u[0], 0.0) - room.gaps[i], force = touch.force.dot(touch.nearest.normal);
    if (force > 0.0 && way > 0.0) sum += Work{force * way, force * way};
  }
  return sum;
}

}  // namespace sinew
