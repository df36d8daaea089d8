#include "sinew/sim/reduced.hpp"

#include <Eigen/Dense>
#include <algorithm>

#include "sinew/constraint/sliding.hpp"
#include "sinew/lie/rotation.hpp"
#include "sinew/sim/motors.hpp"
#include "sinew/sim/places.hpp"
#include "sinew/sim/rod_rows.hpp"

namespace sinew {

namespace {

/// Sliding points and anchors of a rod: c = P - gamma, and lambda . gamma_s = f where the abscissa is free, with f the
/// friction in the channel.
void add_points(RodRows& rod) {
  solve::CoupledProblem& problem = rod.problem();
  const State& iterate = rod.iterate();
  for (std::size_t k = 0; k < iterate.points.size(); ++k) {
    const PointModel& point = rod.context().model.points[k];
    if (point.line.rod != rod.number()) continue;
    if (!iterate.points[k].on) {  // beyond the tip: lambda = 0, and the abscissa stays
      if (point.unknown >= 0) problem.B.add(point.unknown, point.unknown, 1.0);
      for (int i = 0; i < 3; ++i) problem.W.add(point.row + i, point.row + i, 1.0);
      continue;
    }
    const double s = iterate.points[k].s;
    const Vec3 lambda = iterate.lambda.segment<3>(point.row);
    const rod::CurvePoint on_curve = rod::curve_point(rod.shape(), s);
    const Vec3 P = solid_point(rod.context().model, iterate, point.solid, point.where), gap = P - on_curve.position;
    problem.c.segment<3>(point.row) = gap;
    rod.attach_centre(rod.row(point.row), on_curve);
    Reduced& reduced = rod.reduced();
    reduced.scale = std::max(reduced.scale, lambda.norm());
    if (point.unknown < 0) {
      rod::PointLoad load{s, Vec3::Zero(), lambda};
      load.at = on_curve;
      rod.load(load);
      reduced.violation = std::max(reduced.violation, gap.norm());
      continue;
    }
    rod.slide(on_curve, s, lambda, point.unknown);
    reduced.violation = std::max(reduced.violation, constraint::violation(on_curve, P));
    problem.G.add(point.row, point.unknown, on_curve.derivative);
    problem.r[point.unknown] = lambda.dot(on_curve.derivative) - iterate.points[k].friction;
    reduced.largest = std::max(reduced.largest, std::abs(problem.r[point.unknown]));
  }
}

/// The massless cable: constant length with the tension as its multiplier, points held by rows with G = I.
void add_cable(const StepContext& context, const State& iterate, int number, Reduced& reduced) {
  const GeometricCableModel& model = context.model.cables[number];
  const Eigen::VectorXd& z = iterate.cables[number].z;
  solve::CoupledProblem& problem = reduced.problem;
  rod::CableLength& length = reduced.cables[number];
  rod::cable_length(model.cable, context.cable_bases[number], z, length);
  const double tension = iterate.lambda[model.length_row];
  const int n = model.cable.coordinates();
  for (int j = 0; j < n; ++j) {
    for (int i = std::max(0, j - rod::kCableBand); i <= std::min(n - 1, j + rod::kCableBand); ++i)
      problem.B.add(model.unknown + i, model.unknown + j, tension * length.hessian(i, j));
  }
  problem.r.segment(model.unknown, n) = tension * length.gradient;
  problem.G.add(model.length_row, model.unknown, length.gradient.transpose());
  problem.c[model.length_row] = model.cable.length - length.value;
  reduced.scale = std::max(reduced.scale, std::abs(tension));
  reduced.violation = std::max(reduced.violation, std::abs(model.cable.length - length.value));
  for (const PointModel& point : context.model.points) {
    if (point.line.cable != number) continue;
    const int at = 1 + 3 * point.cable_point;
    const Vec3 gap = solid_point(context.model, iterate, point.solid, point.where) - z.segment<3>(at);
    problem.c.segment<3>(point.row) = gap;
    for (int i = 0; i < 3; ++i) problem.G.add(point.row + i, model.unknown + at + i, 1.0);
    problem.r.segment<3>(model.unknown + at) += iterate.lambda.segment<3>(point.row);
    reduced.violation = std::max(reduced.violation, gap.norm());
  }
}

/// Motors of bases: a known force, or a row delta_a = base coordinate - target with the force as its multiplier.
void add_actuator(const StepContext& context, const State& iterate, std::size_t number, Reduced& reduced) {
  const ActuatorModel& actuator = context.model.actuators[number];
  if (actuator.tendon) return;  // with its rod
  const double arm = actuator.turns() ? context.model.rods[actuator.line.rod].rod.length() : 1.0;
  solve::CoupledProblem& problem = reduced.problem;
  const double force = motor_force(context.model, context.command, iterate, static_cast<int>(number));
  problem.r[actuator.unknown] -= force;
  reduced.scale = std::max(reduced.scale, std::abs(force) / arm);
  if (actuator.told_force()) return;
  const double off = motor_position(context.model, iterate, actuator) - context.command.actuators[number];
  problem.G.add(actuator.row, actuator.unknown, -1.0);
  problem.c[actuator.row] = off;
  reduced.violation = std::max(reduced.violation, std::abs(off) * arm);
}

/// Forces of contacts on a rod: what presses it acts through its axis, friction at its surface.
void add_touches(RodRows& rod, const std::vector<Touch>& touches) {
  for (std::size_t i = 0; i < touches.size(); ++i) {
    const Vec3 &force = touches[i].force, &n = touches[i].nearest.normal;
    const Vec3 normal = n * n.dot(force), friction = force - normal;
    each_side(rod.iterate().contacts[i], touches[i],
              [&](const ContactSide& side, const std::array<double, 3>& weights, const Vec3& point, double sign) {
                if (side.on != Collider{Collider::Kind::rod, rod.number()} || force.isZero(0.0)) return;
                const double s = abscissa_of(side, weights);
                const rod::Branch section = rod::branch(rod.shape(), s);
                const Vec3 surface = section.R.transpose() * (point - section.p),
                           out = section.R.transpose() * (sign * -n * side.local.radius);
                const bool lone = side.local.corners() == 1;
                rod::PointLoad pressed{s, lone ? Vec3(Vec3::Zero()) : Vec3(surface - out), -sign * normal};
                if (!touches[i].of_rod.isZero(0.0)) pressed.stiffness = &touches[i].of_rod;
                rod.load(pressed);
                rod.load({s, surface, -sign * friction});
                rod.reduced().scale = std::max(rod.reduced().scale, force.norm());
              });
  }
}

/// Three rows that a rigid body takes part in: `sign` times a point at r from its centre of mass or, without
/// `displaced`, a vector r carried with it. With P = p + exp(theta) r the second variation of lambda . P is
/// (lambda . theta) (r . theta) - (lambda . r) |theta|^2.
void add_body_rows(const BodyModel& body, int row, const Vec3& r, double sign, bool displaced, const Vec3& lambda,
                   Reduced& reduced) {
  solve::CoupledProblem& problem = reduced.problem;
  const rod::Mat3 turned = sign * lie::hat(r);  // -sign dP / dtheta
  if (displaced) {
    for (int i = 0; i < 3; ++i) problem.G.add(row + i, body.unknown + i, -sign);
    problem.r.segment<3>(body.unknown) -= sign * lambda;
  }
  problem.G.add(row, body.unknown + 3, turned);
  problem.r.segment<3>(body.unknown + 3) += turned.transpose() * lambda;
  const rod::Mat3 half = 0.5 * sign * lambda * r.transpose();
  problem.B.add(body.unknown + 3, body.unknown + 3,
                rod::Mat3(sign * lambda.dot(r) * rod::Mat3::Identity() - half - half.transpose()));
  reduced.scale = std::max(reduced.scale, displaced ? lambda.norm() : 0.0);
}

/// What rigid bodies carry: points and axes that ties follow, nodes of solids.
void add_carried(const StepContext& context, const State& iterate, Reduced& reduced) {
  const Model& model = context.model;
  solve::CoupledProblem& problem = reduced.problem;
  for (const TieModel& tie : model.ties) {
    if (tie.rigid < 0) continue;
    const BodyModel& body = model.bodies[tie.rigid];
    const rigid::Motion& now = iterate.bodies[tie.rigid];
    const auto follow = [&](int k, const Vec3& r, bool displaced) {
      const int row = tie.body_row + 3 * k;
      hold_followed(model, iterate, row, tie.unknown + 3 * k, displaced ? Vec3(now.p + r) : r, reduced);
      add_body_rows(body, row, r, 1.0, displaced, iterate.lambda.segment<3>(row), reduced);
    };
    follow(0, now.R * tie.other_offset, true);
    for (int i = 0; tie.directors && i < 3; ++i) follow(1 + i, tie.length * now.R.col(i), false);
  }
  for (const SolidRow& row : model.solid_rows) {
    if (row.body < 0) continue;
    const rigid::Motion& now = iterate.bodies[row.body];
    const Vec3 r = now.R * row.arm, gap = solid_point(model, iterate, row.solid, row.where) - (now.p + r);
    problem.c.segment<3>(row.row) = gap;
    add_body_rows(model.bodies[row.body], row.row, r, -1.0, true, iterate.lambda.segment<3>(row.row), reduced);
    reduced.violation = std::max(reduced.violation, gap.norm());
  }
}

/// Inertia, weight and contacts of rigid bodies.
void add_bodies(const StepContext& context, const State& iterate, const std::vector<Touch>& touches, Reduced& reduced) {
  const Model& model = context.model;
  solve::CoupledProblem& problem = reduced.problem;
  for (std::size_t i = 0; i < model.bodies.size(); ++i) {
    const BodyModel& own = model.bodies[i];
    const rigid::Equations equations =
        rigid::equations(own.body, context.start.bodies[i], iterate.bodies[i], context.rate, context.gravity);
    problem.r.segment<6>(own.unknown) += equations.r;
    problem.B.add(own.unknown, own.unknown, equations.tangent);
    reduced.scale = std::max(
        reduced.scale, own.body.mass * (context.gravity.norm() + (context.start.bodies[i].v * context.rate).norm()));
    const double spin = (own.body.inertia * context.start.bodies[i].w).norm() * context.rate;
    reduced.scale = std::max(reduced.scale, spin / model.arms[own.unknown + 3]);
  }
  for (std::size_t i = 0; i < touches.size(); ++i) {
    each_side(iterate.contacts[i], touches[i],
              [&](const ContactSide& side, const std::array<double, 3>&, const Vec3& at, double sign) {
                if (side.on.kind != Collider::Kind::body) return;
                const Vec3 force = sign * touches[i].force;
                auto r = problem.r.segment<6>(model.bodies[side.on.number].unknown);
                r.head<3>() -= force;
                r.tail<3>() -= (at - iterate.bodies[side.on.number].p).cross(force);
                reduced.scale = std::max(reduced.scale, force.norm());
              });
  }
}

/// Unknowns that a tie follows on a solid: c = sum w x - z.
void add_followed(const StepContext& context, const State& iterate, Reduced& reduced) {
  for (const SolidRow& row : context.model.solid_rows) {
    if (row.unknown < 0) continue;
    hold_followed(context.model, iterate, row.row, row.unknown,
                  solid_point(context.model, iterate, row.solid, row.where), reduced);
  }
}

}  // namespace

void hold_followed(const Model& model, const State& iterate, int row, int unknown, const Vec3& is, Reduced& reduced) {
  solve::CoupledProblem& problem = reduced.problem;
  const Vec3 gap = is - iterate.followed.segment<3>(unknown - model.first_followed);
  problem.c.segment<3>(row) = gap;
  for (int i = 0; i < 3; ++i) problem.G.add(row + i, unknown + i, 1.0);
  problem.r.segment<3>(unknown) += iterate.lambda.segment<3>(row);
  reduced.violation = std::max(reduced.violation, gap.norm());
}

void linearize(const StepContext& context, const State& iterate, const std::vector<Touch>& touches, Reduced& reduced) {
  const Model& model = context.model;
  solve::CoupledProblem& problem = reduced.problem;
  problem.B.clear();
  problem.G.clear();
  problem.W.clear();
  problem.r.setZero(model.unknowns);
  problem.c.setZero(model.rows);
  problem.chains.resize(model.rods.size());
  reduced.internal.resize(model.rods.size());
  reduced.rods.resize(model.rods.size());
  reduced.cables.resize(model.cables.size());
  reduced.largest = reduced.scale = reduced.violation = 0.0;
  for (std::size_t i = 0; i < model.rods.size(); ++i) {
    RodRows rod(context, iterate, static_cast<int>(i), reduced);
    add_points(rod);
    add_ties(rod);
    add_touches(rod, touches);
    rod.finish();
  }
  for (std::size_t i = 0; i < model.cables.size(); ++i) add_cable(context, iterate, static_cast<int>(i), reduced);
  for (std::size_t i = 0; i < model.actuators.size(); ++i) add_actuator(context, iterate, i, reduced);
  add_bodies(context, iterate, touches, reduced);
  add_followed(context, iterate, reduced);
  add_carried(context, iterate, reduced);
  if (model.unknowns > 0)
    reduced.largest = std::max(reduced.largest, (problem.r.array() / model.arms.array()).abs().maxCoeff());
}

void set_references(const StepContext& context, double force, Reduced& reduced) {
  constexpr double kOfTolerance = 10.0, kOfBending = 1e-12, kCountsAsNone = 1e-10;
  const Model& model = context.model;
  Eigen::VectorXd& reference = reduced.problem.reference;
  reference.setZero(context.rate == 0.0 ? model.unknowns : 0);
  if (context.rate > 0.0) return;
  const double unbalanced = kOfTolerance * model.scene.newton.tolerance * force;
  for (const RodModel& own : model.rods) {
    const rod::Mat6 stiffness = rod::stiffness_at(own.rod.profile, 0.0);
    const double length = own.rod.length(), bending = std::max(stiffness(1, 1), stiffness(2, 2)) / length,
                 turns = std::max(unbalanced * length, kOfBending * bending) / kCountsAsNone;
    for (int k = 0; k < own.rod.base_coordinates(); ++k)
      reference[own.unknown + k] = own.rod.base[k].turns ? turns : turns / (length * length);
  }
  for (const BodyModel& own : model.bodies) {
    const double turns = unbalanced * model.size / kCountsAsNone;
    reference.segment<3>(own.unknown).setConstant(turns / (model.size * model.size));
    reference.segment<3>(own.unknown + 3).setConstant(turns);
  }
}

void clear(const Model& model, solve::RightSide& side) {
  side.r.setZero(model.unknowns);
  side.c.setZero(model.rows);
  side.chains.resize(model.rods.size());
  for (std::size_t n = 0; n < model.rods.size(); ++n) side.chains[n].setZero(model.rods[n].rod.strain_coordinates());
}

void advance_reduced(const StepContext& context, const solve::CoupledSolution& solution, double fraction,
                     State& iterate) {
  const Model& model = context.model;
  for (std::size_t i = 0; i < model.rods.size(); ++i) {
    const RodModel& rod = model.rods[i];
    Eigen::VectorXd& q = iterate.rods[i].q;
    const int nb = rod.rod.base_coordinates();
    q.head(nb) += fraction * solution.dz.segment(rod.unknown, nb);
    q.tail(rod.rod.strain_coordinates()) += fraction * solution.dq[i];
  }
  for (std::size_t i = 0; i < model.cables.size(); ++i)
    iterate.cables[i].z += fraction * solution.dz.segment(model.cables[i].unknown, model.cables[i].cable.coordinates());
  for (std::size_t i = 0; i < model.bodies.size(); ++i) {
    const auto own = solution.dz.segment<6>(model.bodies[i].unknown);
    iterate.bodies[i].p += fraction * own.head<3>();
    iterate.bodies[i].R = lie::exp(fraction * own.tail<3>()) * iterate.bodies[i].R;
  }
  for (std::size_t k = 0; k < model.points.size(); ++k) {
    if (model.points[k].unknown >= 0) iterate.points[k].s += fraction * solution.dz[model.points[k].unknown];
  }
  iterate.followed += fraction * solution.dz.segment(model.first_followed, model.followed);
  iterate.lambda += fraction * solution.dlambda;
}

Bend largest_bend(const StepContext& context, const solve::CoupledSolution& solution) {
  Bend largest;
  for (std::size_t n = 0; n < context.model.rods.size(); ++n) {
    const rod::Rod& rod = context.model.rods[n].rod;
    for (int i = 0; i < rod.count(); ++i) {
      for (std::size_t c = 0; c < rod.sections[i].modes.size(); ++c) {
        if (rod.sections[i].modes[c].strain >= 3) continue;
        const double dq = solution.dq[n][rod.first[i] + static_cast<int>(c)];
        const double angle = std::abs(dq) * rod.sections[i].length();
        if (angle > largest.angle) largest = {angle, static_cast<int>(n)};
      }
    }
  }
  return largest;
}

double largest_turn(const StepContext& context, const solve::CoupledSolution& solution) {
  double turn = largest_bend(context, solution).angle;
  for (const BodyModel& body : context.model.bodies)
    turn = std::max(turn, solution.dz.segment<3>(body.unknown + 3).norm());
  for (const RodModel& model : context.model.rods) {
    const rod::Rod& rod = model.rod;
    for (int i = 0; i < rod.base_coordinates(); ++i) {
      if (rod.base[i].turns) turn = std::max(turn, std::abs(solution.dz[model.unknown + i]));
    }
  }
  return turn;
}

}  // namespace sinew
