#include "sinew/sim/modal.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "sinew/rod/dynamics.hpp"
#include "sinew/sim/places.hpp"

namespace sinew {

namespace {

/// M over (z, strains of all rods).
Eigen::MatrixXd mass_matrix(const Model& model, const State& state) {
  Eigen::Index size = model.unknowns;
  for (const RodModel& rod : model.rods) size += rod.rod.strain_coordinates();
  Eigen::MatrixXd M = Eigen::MatrixXd::Zero(size, size);
  Eigen::Index at = model.unknowns;
  for (std::size_t i = 0; i < model.rods.size(); ++i) {
    const rod::Configuration shape = rod_shape(model, state, static_cast<int>(i));
    const Eigen::MatrixXd own = rod::dense_tangent(shape, rod::mass_matrix(shape));
    const Eigen::Index nb = shape.base.cols(), n = own.cols() - nb, base = model.rods[i].unknown;
    M.block(base, base, nb, nb) = own.topLeftCorner(nb, nb);
    M.block(base, at, nb, n) = own.topRightCorner(nb, n);
    M.block(at, base, n, nb) = own.bottomLeftCorner(n, nb);
    M.block(at, at, n, n) = own.bottomRightCorner(n, n);
    at += n;
  }
  return M;
}

/// Coordinates that leave all rows G v = 0: an orthonormal basis.
Eigen::MatrixXd free_directions(const Eigen::MatrixXd& G) {
  if (G.rows() == 0) return Eigen::MatrixXd::Identity(G.cols(), G.cols());
  Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(G.transpose());
  qr.setThreshold(1e-11);
  const Eigen::MatrixXd Q = qr.householderQ();
  return Q.rightCols(G.cols() - qr.rank());
}

/// Largest motion of a section's end per unit of the shape [m].
double largest_motion(const Model& model, const StepContext& context, const State& state, const Increment& shape) {
  State moved = state;
  const double e = 1e-6 / std::max(1e-12, largest_turn(context, shape.reduced));
  advance_by(context, shape, e, moved);
  double largest = 0.0;
  for (std::size_t i = 0; i < model.rods.size(); ++i) {
    const auto a = rod_shape(model, state, static_cast<int>(i)), b = rod_shape(model, moved, static_cast<int>(i));
    for (std::size_t k = 0; k < a.p.size(); ++k) largest = std::max(largest, (b.p[k] - a.p[k]).norm() / e);
  }
  return largest;
}

}  // namespace

std::vector<NaturalMode> natural_modes(const Model& model, Workspace& workspace, const State& equilibrium, int count,
                                       std::string& failed) {
  StageTimes times;
  const StepContext context = make_context(model, equilibrium, command_at(model, 0.0), 0.0);
  const Linearization here(context, workspace, equilibrium, times);
  const solve::CoupledProblem& problem = here.reduced().problem;
  const Eigen::MatrixXd K = solve::written_out(problem);
  if (!(K - K.transpose()).isZero(1e-9 * K.cwiseAbs().maxCoeff())) {
    failed = "follower forces and moments have no potential: modes about them need not vibrate; leave those loads out";
    return {};
  }
  // Without the multipliers: what the rows say, and the stiffness of the rest.
  const Eigen::Index nz = model.unknowns, rows = model.rows, n = K.rows() - nz - rows;
  Eigen::MatrixXd stiffness(nz + n, nz + n), G(rows, nz + n);
  stiffness << K.topLeftCorner(nz, nz), K.topRightCorner(nz, n), K.bottomLeftCorner(n, nz), K.bottomRightCorner(n, n);
  G << K.block(nz, 0, rows, nz), K.block(nz, nz + rows, rows, n);
  const Eigen::MatrixXd Z = free_directions(G);
  const Eigen::MatrixXd M = Z.transpose() * mass_matrix(model, equilibrium) * Z;
  Eigen::MatrixXd k = Z.transpose() * stiffness * Z;
  const Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd> solver(k, M);
  if (Z.cols() == 0 || solver.info() != Eigen::Success || !solver.eigenvalues().allFinite()) {
    failed = "the mass matrix is not positive definite: rods need a density";
    return {};
  }
  std::vector<NaturalMode> modes;
  for (Eigen::Index i = 0; i < std::min<Eigen::Index>(count, Z.cols()); ++i) {
    NaturalMode& mode = modes.emplace_back();
    const double square = solver.eigenvalues()[i];
    mode.frequency = std::copysign(std::sqrt(std::abs(square)), square) / (2.0 * std::numbers::pi);
    const Eigen::VectorXd v = Z * solver.eigenvectors().col(i);
    mode.shape.reduced.dz = v.head(nz);
    mode.shape.reduced.dlambda = Eigen::VectorXd::Zero(rows);
    Eigen::Index at = nz;
    for (const RodModel& rod : model.rods) {
      mode.shape.reduced.dq.emplace_back(v.segment(at, rod.rod.strain_coordinates()));
      at += rod.rod.strain_coordinates();
    }
    mode.shape.reduced.ok = true;
  }
  return modes;
}

StepResult modal_step(const Model& model, Workspace& workspace, const State& state) {
  StepResult result = step(model, workspace, command_at(model, 0.0), initial_state(model), 0.0);
  if (!accepted(result.report.status)) return {state, result.report};
  State equilibrium = result.next;
  std::vector<NaturalMode> modes =
      natural_modes(model, workspace, equilibrium, model.scene.modes, result.report.detail);
  const auto number = static_cast<std::size_t>(state.grid);
  if (number >= modes.size()) {
    result.report.status = Status::singular;
    if (!modes.empty()) result.report.detail = "the scene has " + std::to_string(modes.size()) + " modes only";
    return {state, result.report};
  }
  const StepContext context = make_context(model, equilibrium, command_at(model, 0.0), 0.0);
  const double motion = largest_motion(model, context, equilibrium, modes[number].shape);
  const double turn = largest_turn(context, modes[number].shape.reduced);
  const double amplitude = motion > 0.0 ? 0.1 * model.size / motion : turn > 0.0 ? 0.5 / turn : 0.0;
  advance_by(context, modes[number].shape, amplitude, equilibrium);
  equilibrium.grid = state.grid + 1;
  equilibrium.time = static_cast<double>(equilibrium.grid);
  equilibrium.frequency = modes[number].frequency;
  return {std::move(equilibrium), result.report};
}

}  // namespace sinew
