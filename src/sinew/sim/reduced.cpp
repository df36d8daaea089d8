#include "sinew/sim/reduced.hpp"

#include <Eigen/Dense>
#include <algorithm>

#include "sinew/constraint/sliding.hpp"
#include "sinew/rod/kinematics.hpp"
#include "sinew/solid/embedding.hpp"

namespace sinew {

namespace {

Vec3 position_on_solid(const StepContext& context, const State& iterate, const PointModel& point) {
  return solid::position(point.where, context.model.solids[point.solid].body.tetrahedra, iterate.solids[point.solid].x);
}

/// What a generalised force is divided by to compare it with forces: the lever arm of its coordinate.
Eigen::VectorXd lever_arms(const rod::Rod& rod) {
  Eigen::VectorXd lever(rod.coordinates());
  for (int i = 0; i < rod.base_coordinates(); ++i)
    lever[i] = rod.base[i] == rod::BaseAxis::translation ? 1.0 : rod.length();
  for (int i = 0; i < rod.sections(); ++i) {
    for (int c = 0; c < rod.strains(); ++c) {
      lever[rod.first_coordinate(i) + c] = rod.section_length(i) * (rod.basis[c] < 3 ? rod.length() : 1.0);
    }
  }
  return lever;
}

/// (9) of one Cosserat rod, and its rows of sliding points and anchors.
void add_rod(const StepContext& context, const State& iterate, int number, Reduced& reduced) {
  const RodModel& model = context.model.rods[number];
  const rod::Rod& rod = model.rod;
  const RodState& now = iterate.rods[number];
  const RodState& start = context.start.rods[number];
  const rod::Configuration shape = rod::configure(rod, context.bases[number], now.q);
  solve::CoupledProblem& problem = reduced.problem;
  const int n = rod.coordinates();
  auto r = problem.r.segment(model.offset, n);
  auto B = problem.B.block(model.offset, model.offset, n, n);

  // Hooke: F(q) = K (q - q_rest).
  for (int i = 0; i < rod.sections(); ++i) {
    for (int c = 0; c < rod.strains(); ++c) {
      const int j = rod.first_coordinate(i) + c;
      const double k = rod.section_length(i) * rod.stiffness[i][rod.basis[c]];
      r[j] = k * (now.q[j] - rod.rest[j - rod.base_coordinates()]);
      B(j, j) = k;
    }
  }

  if (n > 0) reduced.scale = std::max(reduced.scale, (r.array() / lever_arms(rod).array()).abs().maxCoeff());

  // Inertia of the mass points by backward Euler on their positions, and their weight.
  std::vector<rod::PointLoad> loads;
  const double h = context.h;
  double acting = 0.0;  // inertia and weight each by themselves: in free fall they cancel
  for (std::size_t i = 0; i < rod.masses.size(); ++i) {
    const rod::MassPoint& mass = rod.masses[i];
    const auto column = static_cast<Eigen::Index>(i);
    const Vec3 X = rod::position(shape, mass.s, mass.offset);
    const Vec3 acceleration = ((X - start.masses.col(column)) / h - start.velocity.col(column)) / h;
    loads.push_back(
        {mass.s, mass.offset, mass.mass * (acceleration - context.model.scene.gravity), mass.mass / (h * h)});
    acting += mass.mass * (acceleration.norm() + context.model.scene.gravity.norm());
  }
  reduced.scale = std::max(reduced.scale, acting);

  // Sliding points and anchors: c = P - gamma, G = (gamma_q, gamma_s), and the curvature of lambda . gamma.
  for (std::size_t k = 0; k < context.model.points.size(); ++k) {
    const PointModel& point = context.model.points[k];
    if (point.rod != number) continue;
    const PointState& state = iterate.points[k];
    if (!state.on) {  // beyond the tip: lambda = 0, and the abscissa stays
      if (point.unknown >= 0) problem.B(point.unknown, point.unknown) = 1.0;
      problem.W.block<3, 3>(point.row, point.row) = Eigen::Matrix3d::Identity();
      continue;
    }
    const rod::CurvePoint on_curve = rod::curve_point(shape, state.s);
    const Vec3 P = position_on_solid(context, iterate, point);
    const Vec3 gap = P - on_curve.position;
    problem.c.segment<3>(point.row) = gap;
    problem.G.block(point.row, model.offset, 3, n) = rod::position_jacobian(shape, state.s);
    loads.push_back({state.s, Vec3::Zero(), state.lambda, 0.0});
    reduced.scale = std::max(reduced.scale, state.lambda.norm());
    if (point.unknown < 0) {
      reduced.violation = std::max(reduced.violation, gap.norm());
      continue;
    }
    reduced.violation = std::max(reduced.violation, constraint::violation(shape, state.s, P));
    const int s = point.unknown;
    problem.G.block<3, 1>(point.row, s) = on_curve.derivative;
    const Eigen::VectorXd coupling = rod::tangent_gradient(shape, state.s, state.lambda);
    problem.B.block(model.offset, s, n, 1) = coupling;
    problem.B.block(s, model.offset, 1, n) = coupling.transpose();
    problem.B(s, s) = state.lambda.dot(on_curve.second);
    problem.r[s] = state.lambda.dot(on_curve.derivative);
    reduced.largest = std::max(reduced.largest, std::abs(problem.r[s]));
  }
  std::stable_sort(loads.begin(), loads.end(), [](const auto& a, const auto& b) { return a.s < b.s; });
  rod::add_loads(shape, loads, r, B);
}

/// The massless cable: constant length with the tension as its multiplier, points held by rows with G = I.
void add_cable(const StepContext& context, const State& iterate, int number, Reduced& reduced) {
  const RodModel& model = context.model.rods[number];
  const RodState& now = iterate.rods[number];
  solve::CoupledProblem& problem = reduced.problem;
  const rod::CableLength length = rod::cable_length(model.cable, context.bases[number], now.q);
  const double tension = iterate.tensions[number];
  const int n = model.cable.coordinates();
  problem.B.block(model.offset, model.offset, n, n) = tension * length.hessian;
  problem.r.segment(model.offset, n) = tension * length.gradient;
  problem.G.block(model.length_row, model.offset, 1, n) = length.gradient.transpose();
  problem.c[model.length_row] = model.cable.length - length.value;
  reduced.scale = std::max(reduced.scale, std::abs(tension));
  reduced.violation = std::max(reduced.violation, std::abs(model.cable.length - length.value));
  for (std::size_t k = 0; k < context.model.points.size(); ++k) {
    const PointModel& point = context.model.points[k];
    if (point.rod != number) continue;
    const int z = 1 + 3 * point.cable_point;
    const Vec3 gap = position_on_solid(context, iterate, point) - now.q.segment<3>(z);
    problem.c.segment<3>(point.row) = gap;
    problem.G.block<3, 3>(point.row, model.offset + z) = Eigen::Matrix3d::Identity();
    problem.r.segment<3>(model.offset + z) += iterate.points[k].lambda;
    reduced.violation = std::max(reduced.violation, gap.norm());
  }
}

/// Motors: a known force, or a row delta_a = base coordinate - target with the force as its multiplier.
void add_actuator(const StepContext& context, const State& iterate, std::size_t number, Reduced& reduced) {
  const ActuatorModel& actuator = context.model.actuators[number];
  const RodModel& rod = context.model.rods[actuator.rod];
  solve::CoupledProblem& problem = reduced.problem;
  const double force = actuator.row < 0 ? context.command[number] : iterate.actuators[number];
  problem.r[actuator.unknown] -= force;
  reduced.scale = std::max(reduced.scale, std::abs(force) / (actuator.motion == Motion::rotation ? rod.length() : 1.0));
  if (actuator.row < 0) return;
  const double off = iterate.rods[actuator.rod].q[actuator.unknown - rod.offset] - context.command[number];
  problem.G(actuator.row, actuator.unknown) = -1.0;
  problem.c[actuator.row] = off;
  reduced.violation =
      std::max(reduced.violation, std::abs(off) * (actuator.motion == Motion::rotation ? rod.length() : 1.0));
}

}  // namespace

Reduced linearize(const StepContext& context, const State& iterate) {
  Reduced reduced;
  const int nz = context.model.reduced, rows = context.model.rows;
  reduced.problem.B.setZero(nz, nz);
  reduced.problem.G.setZero(rows, nz);
  reduced.problem.W.setZero(rows, rows);
  reduced.problem.r.setZero(nz);
  reduced.problem.c.setZero(rows);
  for (std::size_t i = 0; i < context.model.rods.size(); ++i) {
    const auto add = context.model.rods[i].geometric ? add_cable : add_rod;
    add(context, iterate, static_cast<int>(i), reduced);
  }
  for (std::size_t i = 0; i < context.model.actuators.size(); ++i) add_actuator(context, iterate, i, reduced);
  for (const RodModel& model : context.model.rods) {
    Eigen::VectorXd r = reduced.problem.r.segment(model.offset, model.coordinates());
    if (!model.geometric) r.array() /= lever_arms(model.rod).array();
    if (r.size() > 0) reduced.largest = std::max(reduced.largest, r.lpNorm<Eigen::Infinity>());
  }
  return reduced;
}

void add_compliance(const StepContext& context, const std::vector<FreeMotion>& free, solve::CoupledProblem& problem) {
  for (const FreeMotion& motion : free) {
    const Eigen::MatrixXd W = motion.X.transpose() * motion.X;
    const Eigen::VectorXd Hdx = motion.X.transpose() * motion.y;
    for (std::size_t a = 0; a < motion.points.size(); ++a) {
      const int row = context.model.points[motion.points[a]].row;
      const auto ia = static_cast<Eigen::Index>(3 * a);
      problem.c.segment<3>(row) += Hdx.segment<3>(ia);
      for (std::size_t b = 0; b < motion.points.size(); ++b) {
        const int column = context.model.points[motion.points[b]].row;
        problem.W.block<3, 3>(row, column) += W.block<3, 3>(ia, static_cast<Eigen::Index>(3 * b));
      }
    }
  }
}

void advance_reduced(const StepContext& context, const solve::CoupledSolution& solution, double fraction,
                     State& iterate) {
  for (std::size_t i = 0; i < context.model.rods.size(); ++i) {
    const RodModel& rod = context.model.rods[i];
    iterate.rods[i].q += fraction * solution.dz.segment(rod.offset, rod.coordinates());
    if (rod.geometric) iterate.tensions[i] += fraction * solution.dlambda[rod.length_row];
  }
  for (std::size_t k = 0; k < context.model.points.size(); ++k) {
    const PointModel& point = context.model.points[k];
    if (point.unknown >= 0) iterate.points[k].s += fraction * solution.dz[point.unknown];
    iterate.points[k].lambda += fraction * solution.dlambda.segment<3>(point.row);
  }
  for (std::size_t i = 0; i < context.model.actuators.size(); ++i) {
    const int row = context.model.actuators[i].row;
    if (row >= 0) iterate.actuators[i] += fraction * solution.dlambda[row];
  }
}

double largest_turn(const StepContext& context, const Eigen::VectorXd& dz) {
  double turn = 0.0;
  for (const RodModel& model : context.model.rods) {
    if (model.geometric) continue;
    for (int i = 0; i < model.rod.base_coordinates(); ++i) {
      if (model.rod.base[i] == rod::BaseAxis::rotation) turn = std::max(turn, std::abs(dz[model.offset + i]));
    }
    for (int i = 0; i < model.rod.sections(); ++i) {
      for (int c = 0; c < model.rod.strains(); ++c) {
        if (model.rod.basis[c] >= 3) continue;
        turn = std::max(turn,
                        std::abs(dz[model.offset + model.rod.first_coordinate(i) + c]) * model.rod.section_length(i));
      }
    }
  }
  return turn;
}

}  // namespace sinew
