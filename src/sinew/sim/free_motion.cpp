#include "sinew/sim/free_motion.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <utility>

#include "sinew/sim/clock.hpp"
#include "sinew/sim/solid_loads.hpp"
#include "sinew/sim/solid_matrix.hpp"

namespace sinew {

StepContext make_context(const Model& model, const State& start, const Command& command, double h) {
  const double rate = model.scene.analysis == Analysis::dynamic ? 1.0 / h : 0.0;
  StepContext context{model, start, h, rate, command, model.scene.gravity, false, {}, {}, {}, {}};
  for (const auto& [name, frame] : model.scene.frames)
    context.displacement.push_back(frame_displacement(frame, start.time + h));
  for (const SolidState& solid : start.solids) context.solids.push_back({solid.x, solid.v, rate});
  for (const RodModel& rod : model.rods) context.bases.push_back(compose(context.moved(rod.frame), rod.base));
  for (const CableModel& cable : model.cables)
    context.cable_bases.push_back(compose(context.moved(cable.frame), cable.base));
  return context;
}

namespace {

/// Loads of one volume, each with its factor at the end of the step.
template <class Visit>
void each_load(const StepContext& context, int number, const Visit& visit) {
  for (std::size_t i = 0; i < context.model.loads.size(); ++i) {
    const SolidLoadModel* load = std::get_if<SolidLoadModel>(&context.model.loads[i].on);
    if (load && load->solid == number) visit(*load, context.command.loads[i]);
  }
}

bool is_on(const State& iterate, const SolidRow& row) { return row.point < 0 || iterate.points[row.point].on; }

/// The antisymmetric part of the pressures' tangents.
void add_rim(const StepContext& context, const Workspace::Solid& memory, const State& iterate, int number,
             FreeMotion& free) {
  const SolidModel& model = context.model.solids[number];
  std::vector<int> unknowns;
  Eigen::MatrixXd N;
  each_load(context, number, [&](const SolidLoadModel& load, double factor) {
    if (load.conservative() || factor == 0.0) return;
    const auto before = static_cast<Eigen::Index>(unknowns.size()), more = static_cast<Eigen::Index>(load.rim.size());
    unknowns.insert(unknowns.end(), load.rim.begin(), load.rim.end());
    N.conservativeResizeLike(Eigen::MatrixXd::Zero(before + more, before + more));
    N.bottomRightCorner(more, more) = pressure_skew(model, load, factor, iterate.solids[number].x);
  });
  if (unknowns.empty()) return;
  Eigen::MatrixXd P = Eigen::MatrixXd::Zero(model.body.unknowns, N.cols());
  for (std::size_t i = 0; i < unknowns.size(); ++i) P(unknowns[i], static_cast<Eigen::Index>(i)) = 1.0;
  free.Y = memory.factor.half_solve(P);
  const Eigen::MatrixXd C = free.Y.transpose() * memory.factor.signs().asDiagonal() * free.Y;
  // N (1 + C N)^-1 = (1 + N C)^-1 N
  free.Z = (Eigen::MatrixXd::Identity(N.rows(), N.cols()) + N * C).partialPivLu().solve(N);
  const Eigen::MatrixXd HY = memory.factor.border_times(free.Y);
  free.W -= HY * free.Z * HY.transpose();
}

/// V y.
Eigen::VectorXd with_rim(const linalg::SparseFactor& factor, const FreeMotion& free, const Eigen::VectorXd& y) {
  if (free.Y.size() == 0) return y;
  return y - free.Y * (free.Z * (free.Y.transpose() * factor.signs().cwiseProduct(y)));
}

}  // namespace

SolidForces solid_forces(const StepContext& context, const State& iterate, int number) {
  const solid::Body& body = context.model.solids[number].body;
  SolidForces forces;
  Eigen::Matrix3Xd r =
      solid::residual(body, context.solids[number], iterate.solids[number].x, context.gravity, &forces.scale);
  const SolidModel& model = context.model.solids[number];
  const Eigen::Matrix3Xd& x = iterate.solids[number].x;
  const auto count = [&forces](const Eigen::Matrix3Xd& acting) {
    forces.scale = std::max(forces.scale, acting.colwise().norm().maxCoeff());
  };
  if (model.springs.size() > 0) {
    const Eigen::Matrix3Xd acting = model.springs.cwiseProduct(spring_stretch(model, context.moved(model.frame), x));
    r += acting;
    count(acting);
  }
  each_load(context, number, [&](const SolidLoadModel& load, double factor) {
    const Eigen::Matrix3Xd acting = factor * load_forces(load, x);
    r -= acting;
    count(acting);
  });
  for (const SolidRow& row : context.model.solid_rows) {
    if (row.solid != number || !is_on(iterate, row)) continue;
    const std::span<const int> nodes = body.cells[row.where.element].nodes();
    for (std::size_t c = 0; c < nodes.size(); ++c)
      r.col(nodes[c]) -= row.where.weights[static_cast<Eigen::Index>(c)] * iterate.lambda.segment<3>(row.row);  // H^T
  }
  forces.r = solid::at_unknowns(body, r);
  forces.reaction.resize(model.held());
  Eigen::Index held = 0;
  for (Eigen::Index i = 0; i < r.size(); ++i) {
    if (body.unknown(i) < 0) forces.reaction[held++] = std::exchange(r(i), 0.0);
  }
  forces.largest = r.colwise().norm().maxCoeff();
  return forces;
}

FreeMotion free_motion(const StepContext& context, Workspace& workspace, const State& iterate, int number,
                       solid::Tangent kind, StageTimes& times) {
  const SolidModel& model = context.model.solids[number];
  Workspace::Solid& memory = workspace.solids[number];
  {
    const Clock clock(times.assembly);
    memory.factor.clear();
    double* values = memory.factor.values();
    for (std::size_t k = 0; k < model.rows.size(); ++k) {
      if (!is_on(iterate, context.model.solid_rows[model.rows[k]])) continue;
      const int* first = model.border.outerIndexPtr() + 3 * k;
      for (int at = first[0]; at < first[3]; ++at) values[model.border_places[at]] = model.border.valuePtr()[at];
    }
    assemble(model, context.solids[number], iterate.solids[number].x, kind, values);
    if (kind == solid::Tangent::exact) {
      each_load(context, number, [&](const SolidLoadModel& load, double factor) {
        add_pressure_tangent(model, load, factor, iterate.solids[number].x, values);
      });
    }
  }
  FreeMotion free;
  {
    const Clock clock(times.factor);
    free.ok = memory.factor.factor();
  }
  if (!free.ok) return free;
  free.negative = memory.factor.negative();

  const Clock clock(times.compliance);
  free.stiffness = memory.factor.largest_diagonal();
  free.W = memory.factor.compliance();
  if (kind == solid::Tangent::exact) add_rim(context, memory, iterate, number, free);
  free.ok = free.Z.allFinite();
  return free;
}

Eigen::VectorXd half_solved(const Workspace& workspace, int number, const Eigen::VectorXd& b) {
  return workspace.solids[number].factor.half_solve(b);
}

Eigen::VectorXd border_motion(const Workspace& workspace, const FreeMotion& free, int number,
                              const Eigen::VectorXd& y) {
  const linalg::SparseFactor& factor = workspace.solids[number].factor;
  return factor.border_times(with_rim(factor, free, y));
}

Eigen::Matrix3Xd corrected_motion(const StepContext& context, const Workspace& workspace, const FreeMotion& free,
                                  Eigen::VectorXd y, int number, const Eigen::VectorXd& dlambda) {
  const SolidModel& model = context.model.solids[number];
  const linalg::SparseFactor& factor = workspace.solids[number].factor;
  Eigen::VectorXd own(model.border.rows());
  for (std::size_t k = 0; k < model.rows.size(); ++k)
    own.segment<3>(static_cast<Eigen::Index>(3 * k)) = dlambda.segment<3>(context.model.solid_rows[model.rows[k]].row);
  y += factor.border_transposed_times(own);
  return solid::from_unknowns(model.body, factor.back_solve(with_rim(factor, free, y)));
}

}  // namespace sinew
