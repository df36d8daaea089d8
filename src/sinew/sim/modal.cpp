#include "sinew/sim/modal.hpp"

#include <Spectra/SymGEigsShiftSolver.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "sinew/rod/dynamics.hpp"
#include "sinew/sim/newton.hpp"
#include "sinew/sim/places.hpp"
#include "sinew/sim/statics.hpp"
#include "sinew/threads/interruption.hpp"

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
  for (std::size_t i = 0; i < model.bodies.size(); ++i) {
    const BodyModel& own = model.bodies[i];
    const Eigen::Matrix3d& R = state.bodies[i].R;
    M.block<3, 3>(own.unknown, own.unknown).diagonal().setConstant(own.body.mass);
    M.block<3, 3>(own.unknown + 3, own.unknown + 3) = R * own.body.inertia * R.transpose();
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

/// Modes as coordinates of the whole scene: unknowns of all volumes, z, strains of all rods.
struct Coordinates {
  explicit Coordinates(const Model& own) : model(own) {
    for (const SolidModel& solid : model.solids) {
      solids.push_back(size);
      size += solid.body.unknowns;
    }
    border = size;
    size += model.unknowns;
    for (const RodModel& rod : model.rods) {
      strains.push_back(size);
      size += rod.rod.strain_coordinates();
    }
  }
  const Model& model;
  std::vector<Eigen::Index> solids, strains;
  Eigen::Index border = 0, size = 0;
};

/// (K with its rows)^-1, as Spectra wants it.
class Stiffness {
 public:
  using Scalar = double;
  Stiffness(const Coordinates& at, Linearization& factored) : at_(&at), factored_(&factored) {}
  Eigen::Index rows() const { return at_->size; }
  Eigen::Index cols() const { return at_->size; }
  void set_shift(double) {}  // 0
  void perform_op(const double* in, double* out) const {
    threads::Interruption::check();
    const Model& model = at_->model;
    const Eigen::Map<const Eigen::VectorXd> f(in, at_->size);
    Eigen::Map<Eigen::VectorXd> u(out, at_->size);
    std::vector<Eigen::VectorXd> solids;
    for (std::size_t i = 0; i < model.solids.size(); ++i)
      solids.emplace_back(f.segment(at_->solids[i], model.solids[i].body.unknowns));
    solve::RightSide side;
    side.r = -f.segment(at_->border, model.unknowns);
    side.c = Eigen::VectorXd::Zero(model.rows);
    for (std::size_t i = 0; i < model.rods.size(); ++i)
      side.chains.emplace_back(-f.segment(at_->strains[i], model.rods[i].rod.strain_coordinates()));
    Increment answer;
    factored_->respond(solids, side, answer);
    if (!answer.reduced.ok) {
      u.setConstant(NAN);
      return;
    }
    Eigen::VectorXd own;
    for (std::size_t i = 0; i < model.solids.size(); ++i) {
      solid::at_unknowns(model.solids[i].body, answer.dx[i], own);
      u.segment(at_->solids[i], own.size()) = own;
    }
    u.segment(at_->border, model.unknowns) = answer.reduced.dz;
    for (std::size_t i = 0; i < model.rods.size(); ++i)
      u.segment(at_->strains[i], model.rods[i].rod.strain_coordinates()) = answer.reduced.dq[i];
  }

 private:
  const Coordinates* at_;
  Linearization* factored_;
};

/// M of the whole scene.
class Mass {
 public:
  using Scalar = double;
  Mass(const Coordinates& at, const State& state) : at_(&at), rods_(mass_matrix(at.model, state)) {}
  Eigen::Index rows() const { return at_->size; }
  Eigen::Index cols() const { return at_->size; }
  void perform_op(const double* in, double* out) const {
    const Eigen::Map<const Eigen::VectorXd> u(in, at_->size);
    Eigen::Map<Eigen::VectorXd> f(out, at_->size);
    for (std::size_t i = 0; i < at_->model.solids.size(); ++i) {
      const solid::Body& body = at_->model.solids[i].body;
      Eigen::Matrix3Xd v;
      Eigen::VectorXd own;
      solid::from_unknowns(body, u.segment(at_->solids[i], body.unknowns), v);
      solid::at_unknowns(body, v * body.mass, own);
      f.segment(at_->solids[i], body.unknowns) = own;
    }
    f.tail(rods_.rows()) = rods_ * u.tail(rods_.rows());
  }

 private:
  const Coordinates* at_;
  Eigen::MatrixXd rods_;
};

Increment shape_of(const Coordinates& at, const Eigen::VectorXd& v) {
  Increment shape;
  for (std::size_t i = 0; i < at.model.solids.size(); ++i) {
    const solid::Body& body = at.model.solids[i].body;
    solid::from_unknowns(body, v.segment(at.solids[i], body.unknowns), shape.dx.emplace_back());
  }
  shape.reduced.dz = v.segment(at.border, at.model.unknowns);
  shape.reduced.dlambda = Eigen::VectorXd::Zero(at.model.rows);
  for (std::size_t i = 0; i < at.model.rods.size(); ++i)
    shape.reduced.dq.emplace_back(v.segment(at.strains[i], at.model.rods[i].rod.strain_coordinates()));
  shape.reduced.ok = true;
  return shape;
}

double frequency_of(double square) {
  return std::copysign(std::sqrt(std::abs(square)), square) / (2.0 * std::numbers::pi);
}

/// Largest motion of a node or a section's end per unit of the shape [m].
double largest_motion(const Model& model, const StepContext& context, const State& state, const Increment& shape) {
  double largest = 0.0;
  for (const Eigen::Matrix3Xd& dx : shape.dx) largest = std::max(largest, dx.colwise().norm().maxCoeff());
  State moved = state;
  const double e = 1e-6 / std::max(1e-12, largest_turn(context, shape.reduced));
  advance_by(context, shape, e, moved);
  for (std::size_t i = 0; i < model.rods.size(); ++i) {
    const auto a = rod_shape(model, state, static_cast<int>(i)), b = rod_shape(model, moved, static_cast<int>(i));
    for (std::size_t k = 0; k < a.p.size(); ++k) largest = std::max(largest, (b.p[k] - a.p[k]).norm() / e);
  }
  for (const BodyModel& body : model.bodies)
    largest = std::max(largest, shape.reduced.dz.segment<3>(body.unknown).norm());
  return largest;
}

/// Few coordinates, and K may be singular (free rods), M too (rods without mass): all modes at once, on a basis of what
/// the rows leave free, as
///     M v = mu (K + sigma M) v,    omega^2 = 1 / mu - sigma.
/// So the slowest modes are the largest mu, known to rounding however stiff the rest is, and motions without inertia,
/// which follow at once, have mu = 0.
std::vector<NaturalMode> dense_modes(const Coordinates& at, const Linearization& here, const State& equilibrium,
                                     int count, std::string& failed) {
  const Model& model = at.model;
  const Eigen::MatrixXd K = solve::written_out(here.reduced().problem);
  // Without the multipliers: what the rows say, and the stiffness of the rest.
  const Eigen::Index nz = model.unknowns, rows = model.rows, n = K.rows() - nz - rows;
  Eigen::MatrixXd stiffness(nz + n, nz + n), G(rows, nz + n);
  stiffness << K.topLeftCorner(nz, nz), K.topRightCorner(nz, n), K.bottomLeftCorner(n, nz), K.bottomRightCorner(n, n);
  G << K.block(nz, 0, rows, nz), K.block(nz, nz + rows, rows, n);
  const Eigen::MatrixXd mass = mass_matrix(model, equilibrium);
  const Eigen::MatrixXd Z = free_directions(G);
  const Eigen::MatrixXd M = Z.transpose() * mass * Z;
  const Eigen::MatrixXd k = Z.transpose() * stiffness * Z;
  // Of a motion without inertia v^T M v is what rounding has left of its terms.
  constexpr double kRounding = 1e-13;
  const Eigen::MatrixXd terms = Z.cwiseAbs().transpose() * mass.cwiseAbs() * Z.cwiseAbs();
  for (double sigma = 1e6; Z.cols() > 0 && sigma < 1e18; sigma *= 1e3) {  // [rad^2/s^2]
    const Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd> solver(M, k + sigma * M);
    if (solver.info() != Eigen::Success) continue;  // (unstable: omega^2 < -sigma)
    std::vector<NaturalMode> modes;
    for (Eigen::Index i = Z.cols() - 1; i >= 0 && static_cast<int>(modes.size()) < count; --i) {
      const Eigen::VectorXd v = solver.eigenvectors().col(i);
      const double mu = solver.eigenvalues()[i];
      if (!(v.dot(M * v) > kRounding * v.cwiseAbs().dot(terms * v.cwiseAbs()))) break;
      modes.push_back({frequency_of(1.0 / mu - sigma), shape_of(at, Z * v)});
    }
    if (!modes.empty()) return modes;
  }
  failed = "the mass matrix is not positive definite: rods need a density";
  return {};
}

/// Lanczos with K^-1 (Spectra): the modes nearest to zero frequency.
std::vector<NaturalMode> lanczos_modes(const Coordinates& at, Linearization& here, const State& equilibrium, int count,
                                       std::string& failed) {
  if (!here.factor(solid::Tangent::exact, Linearization::Wanted::any, failed)) return {};
  if (here.rotated()) {
    failed = "the tangent at the equilibrium is singular: a body is free to move, or about to buckle";
    return {};
  }
  Stiffness stiffness(at, here);
  Mass mass(at, equilibrium);
  const int n = static_cast<int>(at.size), wanted = std::min(count, n - 1);
  if (wanted < 1) {
    failed = "the scene has a single unknown, too few for the eigenvalue solver";
    return {};
  }
  Spectra::SymGEigsShiftSolver<Stiffness, Mass, Spectra::GEigsMode::ShiftInvert> solver(
      stiffness, mass, wanted, std::min(n, 2 * wanted + 20), 0.0);
  try {
    solver.init();
    solver.compute(Spectra::SortRule::LargestMagn, 1000, 1e-10);
  } catch (const threads::Interrupted&) {
    throw;
  } catch (const std::exception&) {  // (of numbers that are none)
    failed = "the equations about the equilibrium cannot be solved";
    return {};
  }
  if (solver.info() != Spectra::CompInfo::Successful || !solver.eigenvalues().allFinite()) {
    failed = "no modes were found: is a body free to move? hold it, or tie it";
    return {};
  }
  std::vector<NaturalMode> modes;
  for (int i = 0; i < wanted; ++i)
    modes.push_back({frequency_of(solver.eigenvalues()[i]), shape_of(at, solver.eigenvectors().col(i))});
  std::sort(modes.begin(), modes.end(),
            [](const NaturalMode& a, const NaturalMode& b) { return a.frequency < b.frequency; });
  return modes;
}

}  // namespace

/// What an analysis finds: the equilibrium under the loads of t = 0, and the modes about it.
struct Modes {
  StepResult equilibrium;
  std::vector<NaturalMode> modes;
};

std::vector<NaturalMode> natural_modes(const Model& model, Workspace& workspace, const State& equilibrium, int count,
                                       std::string& failed) {
  StageTimes times;
  const StepContext context = make_context(model, equilibrium, command_at(model, 0.0), 0.0);
  Linearization& here = workspace.memory().here;
  here.forget();
  here.evaluate(context, equilibrium, times);
  if (!here.conservative()) {
    failed =
        "follower forces, moments, and pressure on a surface with a free rim have no potential: modes about them need "
        "not vibrate; leave those loads out";
    return {};
  }
  const Coordinates at(model);
  return model.solids.empty() ? dense_modes(at, here, equilibrium, count, failed)
                              : lanczos_modes(at, here, equilibrium, count, failed);
}

namespace {

Modes find_modes(const Model& model, Workspace& workspace) {
  Modes found{equilibrium_step(model, workspace, command_at(model, 0.0), initial_state(model), 0.0), {}};
  StepReport& report = found.equilibrium.report;
  if (accepted(report.status))
    found.modes = natural_modes(model, workspace, found.equilibrium.next, model.scene.modes, report.detail);
  return found;
}

}  // namespace

StepResult modal_step(const Model& model, Workspace& workspace, const State& state) {
  std::shared_ptr<const Modes>& kept = workspace.memory().modes;
  if (!kept) kept = std::make_shared<const Modes>(find_modes(model, workspace));
  const auto& [found, modes] = *kept;
  StepReport report = found.report;
  if (!accepted(report.status)) return {state, report};
  const auto number = static_cast<std::size_t>(state.grid);
  if (number >= modes.size()) {
    report.status = Status::singular;
    if (!modes.empty()) report.detail = "the scene has " + std::to_string(modes.size()) + " modes only";
    return {state, report};
  }
  State shown = found.next;
  const StepContext context = make_context(model, found.next, command_at(model, 0.0), 0.0);
  const double motion = largest_motion(model, context, shown, modes[number].shape);
  const double turn = largest_turn(context, modes[number].shape.reduced);
  const double amplitude = motion > 0.0 ? 0.1 * model.size / motion : turn > 0.0 ? 0.5 / turn : 0.0;
  advance_by(context, modes[number].shape, amplitude, shown);
  shown.grid = state.grid + 1;
  shown.time = static_cast<double>(shown.grid);
  shown.frequency = modes[number].frequency;
  return {std::move(shown), report};
}

}  // namespace sinew
