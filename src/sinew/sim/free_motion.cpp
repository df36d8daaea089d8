#include "sinew/sim/free_motion.hpp"

#include <Eigen/Dense>
#include <algorithm>

#include "sinew/sim/clock.hpp"

namespace sinew {

StepContext make_context(const Model& model, const State& start, const Command& command, double h) {
  const double rate = model.scene.analysis == Analysis::dynamic ? 1.0 / h : 0.0;
  StepContext context{model, start, h, rate, command, model.scene.gravity, false, {}, {}, {}, {}};
  for (const auto& [name, frame] : model.scene.frames)
    context.displacement.push_back(frame_displacement(frame, start.time + h));
  for (std::size_t i = 0; i < model.solids.size(); ++i) {
    const SolidState& state = start.solids[i];
    context.solids.push_back({state.x, state.v, solid::rotations(model.solids[i].body, state.x), rate});
  }
  for (const RodModel& rod : model.rods) context.bases.push_back(compose(context.moved(rod.frame), rod.base));
  for (const CableModel& cable : model.cables)
    context.cable_bases.push_back(compose(context.moved(cable.frame), cable.base));
  return context;
}

namespace {

bool is_on(const State& iterate, const SolidRow& row) { return row.point < 0 || iterate.points[row.point].on; }

}  // namespace

SolidForces solid_forces(const StepContext& context, const State& iterate, int number) {
  const solid::Body& body = context.model.solids[number].body;
  SolidForces forces;
  Eigen::Matrix3Xd r =
      solid::residual(body, context.solids[number], iterate.solids[number].x, context.gravity, &forces.scale);
  for (const SolidRow& row : context.model.solid_rows) {
    if (row.solid != number || !is_on(iterate, row)) continue;
    for (int c = 0; c < 4; ++c)
      r.col(body.tetrahedra[row.where.element][c]) -= row.where.weights[c] * iterate.lambda.segment<3>(row.row);  // H^T
  }
  forces.r.resize(3 * body.free_nodes);
  for (int i = 0; i < body.nodes(); ++i) {
    if (body.unknown[i] < 0) continue;
    forces.r.segment<3>(3 * body.unknown[i]) = r.col(i);
    forces.largest = std::max(forces.largest, r.col(i).norm());
  }
  return forces;
}

namespace {

/// A of (10), straight into the values of the sparse lower triangle.
void assemble(const StepContext& context, const SolidModel& model, const solid::StepStart& start,
              const Eigen::Matrix3Xd& x, solid::Tangent kind, linalg::SparseCholesky::Matrix& A) {
  double* values = A.valuePtr();
  std::fill(values, values + A.nonZeros(), 0.0);
  solid::assemble_tangent(model.body, start, x, kind, [&](int e, int a, int b, const solid::Mat3& block) {
    const std::array<int, 9>& at = model.block[16 * e + 4 * a + b];
    for (int i = 0; i < 9; ++i) {
      if (at[i] >= 0) values[at[i]] += block(i % 3, i / 3);
    }
  });
  const Eigen::VectorXd mass = solid::mass_diagonal(model.body, context.rate);
  for (int i = 0; i < model.body.nodes(); ++i) {
    if (model.body.unknown[i] < 0) continue;
    for (int c = 0; c < 3; ++c) values[model.diagonal[3 * model.body.unknown[i] + c]] += mass[i];
  }
}

}  // namespace

FreeMotion free_motion(const StepContext& context, Workspace& workspace, const State& iterate, int number,
                       solid::Tangent kind, StageTimes& times) {
  const SolidModel& model = context.model.solids[number];
  Workspace::Solid& memory = workspace.solids[number];
  const auto factor = [&](solid::Tangent tangent) {
    {
      const Clock clock(times.assembly);
      assemble(context, model, context.solids[number], iterate.solids[number].x, tangent, memory.matrix);
    }
    const Clock clock(times.factor);
    return memory.cholesky.factor(memory.matrix);
  };
  FreeMotion free;
  free.ok = factor(kind);
  if (!free.ok && kind == solid::Tangent::exact) {
    free.rotated = true;
    free.ok = factor(solid::Tangent::rotated);
  }
  if (!free.ok) return free;

  const Clock clock(times.compliance);
  free.stiffness = memory.matrix.diagonal().maxCoeff();
  const std::vector<SolidRow>& all = context.model.solid_rows;
  for (std::size_t k = 0; k < all.size(); ++k) {
    if (all[k].solid == number) free.rows.push_back(static_cast<int>(k));
  }
  const auto columns = static_cast<Eigen::Index>(3 * free.rows.size());
  Eigen::MatrixXd right = Eigen::MatrixXd::Zero(3 * model.body.free_nodes, columns);
  for (std::size_t k = 0; k < free.rows.size(); ++k) {
    const SolidRow& row = all[free.rows[k]];
    if (!is_on(iterate, row)) continue;
    for (int c = 0; c < 4; ++c) {
      const int node = model.body.unknown[model.body.tetrahedra[row.where.element][c]];
      if (node < 0) continue;
      for (int i = 0; i < 3; ++i) right(3 * node + i, static_cast<Eigen::Index>(3 * k) + i) = row.where.weights[c];
    }
  }
  free.X = memory.cholesky.half_solve(right);
  return free;
}

Eigen::VectorXd half_solved(const Workspace& workspace, int number, const Eigen::VectorXd& b) {
  return workspace.solids[number].cholesky.half_solve(b);
}

Eigen::Matrix3Xd corrected_motion(const StepContext& context, const Workspace& workspace, const FreeMotion& free,
                                  Eigen::VectorXd y, int number, const Eigen::VectorXd& dlambda) {
  const solid::Body& body = context.model.solids[number].body;
  for (std::size_t k = 0; k < free.rows.size(); ++k) {
    y += free.X.middleCols<3>(static_cast<Eigen::Index>(3 * k)) *
         dlambda.segment<3>(context.model.solid_rows[free.rows[k]].row);
  }
  const Eigen::VectorXd dx = workspace.solids[number].cholesky.back_solve(y);
  Eigen::Matrix3Xd motion = Eigen::Matrix3Xd::Zero(3, body.nodes());
  for (int i = 0; i < body.nodes(); ++i) {
    if (body.unknown[i] >= 0) motion.col(i) = dx.segment<3>(3 * body.unknown[i]);
  }
  return motion;
}

}  // namespace sinew
