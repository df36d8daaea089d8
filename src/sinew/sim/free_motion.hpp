// (10): how a volume moves in a step when the multipliers keep their values, and what one more newton would change.
#pragma once

#include "sinew/rod/kinematics.hpp"
#include "sinew/sim/step.hpp"

namespace sinew {

/// Where a step starts from and what is prescribed at its end; the same for all its iterations.
struct StepContext {
  const Model& model;
  const State& start;
  double h = 0.0;     ///< [s]
  double rate = 0.0;  ///< 1 / h [1/s]; 0: equilibrium, without inertia and damping
  Command command;    ///< at the end of the step
  Vec3 gravity;       ///< [m/s^2] then
  /// The iterate is where the step starts: the forces that would stop a moving rod there are no forces that act along
  /// the step, and stay out of its geometric stiffness, where they would count as compression.
  bool first_guess = false;
  std::vector<Placement> displacement;  ///< of each frame, at the end of the step
  std::vector<solid::StepStart> solids;
  std::vector<Placement> bases, cable_bases;  ///< of each rod and cable, at the end of the step

  Placement moved(int frame) const { return frame < 0 ? Placement{} : displacement[frame]; }
};
StepContext make_context(const Model& model, const State& start, const Command& command, double h);

/// What a rod stands on at the end of the step.
inline rod::Base base_of(const StepContext& context, const State& iterate, int rod) {
  return {context.bases[rod], iterate.rods[rod].turned};
}

/// Unbalanced force of one volume at an iterate, multipliers included.
struct SolidForces {
  Eigen::VectorXd r;         ///< over the volume's unknowns [N]: left minus right side of (7)
  Eigen::VectorXd reaction;  ///< of what is held, as in SolidState
  double largest = 0.0;      ///< [N] largest at a node
  double scale = 0.0;        ///< [N] largest single contribution at a node
};
SolidForces solid_forces(const StepContext& context, const State& iterate, int number);

/// The volume's linear response, A dx = -r + H^T dlambda, half solved (linalg/sparse_factor): A^-1 = R^T S R, and with
/// X = R H^T and y = -R r
///     H dx = X^T S y + W dlambda,   W = X^T S X,   dx = R^T S (y + X dlambda).
/// Follower pressure on a surface with a free rim adds P N P^T to A, N antisymmetric over the rim's unknowns. By
/// Woodbury's formula S then becomes S V, V = 1 - Y N (1 + Y^T S Y N)^-1 Y^T S with Y = R P.
struct FreeMotion {
  Eigen::MatrixXd W;       ///< H A^-1 H^T: three rows and columns per solid row, in the order of SolidModel::rows
  Eigen::MatrixXd Y, Z;    ///< V = 1 - Y Z Y^T S; empty where A is symmetric
  double stiffness = 0.0;  ///< [N/m] largest diagonal entry of A
  int negative = 0;        ///< negative eigenvalues of A: 0 where the volume by itself is stable
  bool ok = false;
};
FreeMotion free_motion(const StepContext& context, Workspace& workspace, const State& iterate, int number,
                       solid::Tangent kind, StageTimes& times);

/// R b with the factor of a volume.
Eigen::VectorXd half_solved(const Workspace& workspace, int number, const Eigen::VectorXd& b);

/// H dx of a free motion.
Eigen::VectorXd border_motion(const Workspace& workspace, const FreeMotion& free, int number, const Eigen::VectorXd& y);

/// Correction: 3 x nodes displacement of the volume (zero where it is held) once the multipliers' increments are known.
Eigen::Matrix3Xd corrected_motion(const StepContext& context, const Workspace& workspace, const FreeMotion& free,
                                  Eigen::VectorXd y, int number, const Eigen::VectorXd& dlambda);

}  // namespace sinew
