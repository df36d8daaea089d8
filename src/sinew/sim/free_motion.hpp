// (10): how a volume moves in a step when the multipliers keep their values, and what their change adds.
#pragma once

#include <optional>
#include <vector>

#include "sinew/linalg/sparse_factor.hpp"
#include "sinew/sim/contacts.hpp"
#include "sinew/solve/direct.hpp"

namespace sinew {

/// Unbalanced force of one volume at an iterate, multipliers included.
struct SolidForces {
  Eigen::VectorXd r;         ///< over the volume's unknowns [N]: left minus right side of (7)
  Eigen::VectorXd reaction;  ///< of what is held, as in SolidState
  double largest = 0.0;      ///< [N] largest at a node
  double scale = 0.0;        ///< [N] largest single contribution at a node
  solid::Deformation deformation;
  solid::Residual nodal;
};
/// Memory of earlier forces is used again.
void solid_forces(const StepContext& context, const State& iterate, const std::vector<Touch>& touches, int number,
                  SolidForces& forces);

/// The volume's linear response, A dx = f + H^T dlambda, half solved (linalg/sparse_factor): A^-1 = R^T S R, and with
/// X = R H^T and y = R f
///     H dx = X^T S y + W dlambda,   W = X^T S X,   dx = R^T S (y + X dlambda).
/// Follower pressure on a surface with a free rim adds P N P^T to A, N antisymmetric over the rim's unknowns. By
/// Woodbury's formula S then becomes S V, V = 1 - Y N (1 + Y^T S Y N)^-1 Y^T S with Y = R P.
class FreeMotion {
 public:
  /// Puts A together, at the iterate that these are the forces of, and factors it; `volume` receives W. What the forces
  /// leave unbalanced is half solved on the way, as one more row. False where A cannot be factored.
  bool factor(const StepContext& context, const State& iterate, const std::vector<Touch>& touches, int number,
              const SolidForces& forces, solid::Tangent kind, threads::Crew& crew, StageTimes& times,
              solve::VolumePart& volume);
  double stiffness() const { return factor_->largest_diagonal(); }  ///< [N/m] largest diagonal entry of A
  int negative() const { return factor_->negative(); }  ///< eigenvalues of A: 0 where the volume by itself is stable

  /// Takes the first half for what the forces that `factor` was given leave unbalanced, or solves it for a force over
  /// the unknowns. H dx, without dlambda, is added to the violations c.
  void push_own(const SolidModel& model, const Model& whole, Eigen::VectorXd& c);
  void push(const SolidModel& model, const Model& whole, const Eigen::VectorXd& force, Eigen::VectorXd& c);
  /// Motion [m] of the volume's watched points, three numbers each: that of the push, and what multipliers add.
  void watched_motion(const SolidModel& model, const Model& whole, const Eigen::VectorXd& dlambda, bool pushed,
                      Eigen::Ref<Eigen::VectorXd> motion);
  /// Rows of contacts over the unknowns, beside those of the plan, until the next factor. Skew tangents of pressures
  /// are left out of what they feel.
  void set_contact_rows(const linalg::SparseFactor::Rows& rows);
  /// H_c A^-1 H_c^T.
  Eigen::MatrixXd contact_compliance() const;
  /// How multipliers move these rows, and with the force that was pushed.
  Eigen::VectorXd coupled_motion(const SolidModel& model, const Model& whole, const Eigen::VectorXd& dlambda);
  Eigen::VectorXd contact_motion(const SolidModel& model, const Model& whole, const Eigen::VectorXd& dlambda);
  /// How forces on them move the rows of couplings: added to the violations c.
  void push_contacts(const SolidModel& model, const Model& whole, const Eigen::VectorXd& forces,
                     Eigen::VectorXd& c) const;
  /// How they move watched points: added.
  void add_watched_motion(const SolidModel& model, const Eigen::VectorXd& forces,
                          Eigen::Ref<Eigen::VectorXd> motion) const;
  /// Adds such forces to what was pushed.
  void add_contact_forces(const Eigen::VectorXd& forces);
  /// And the second: 3 x nodes displacement of the volume (zero where it is held).
  void correct(const SolidModel& model, const Model& whole, const Eigen::VectorXd& dlambda, Eigen::Matrix3Xd& dx);
  /// What a factor in single precision leaves of the force that was pushed, once (corrected) by dlambda and dx:
  ///     f <- f + H^T dlambda - A dx,      c <- H dx - (what `push` and W dlambda took it for)
  /// Returns the size of f [N].
  double leave(const SolidModel& model, const Model& whole, const solve::VolumePart& volume,
               const Eigen::VectorXd& dlambda, const Eigen::Matrix3Xd& dx, Eigen::VectorXd& force, Eigen::VectorXd& c);

 private:
  void plan(const SolidModel& model);
  void take_push(const SolidModel& model, const Model& whole, Eigen::VectorXd& c);
  /// The row of the scene that is a border row, not a watched point's.
  static int row_of(const SolidModel& model, const Model& whole, int border_row);
  /// Forces of the model's rows, zeros for watched points.
  void gather(const SolidModel& model, const Model& whole, const Eigen::VectorXd& dlambda);
  void add_rim(const StepContext& context, const State& iterate, int number, Eigen::MatrixXd& W);
  /// V y.
  const Eigen::VectorXd& with_rim(const Eigen::VectorXd& y);

  // Border rows are those of the model's couplings, three each, then of watched points: so stand rows_, free_, W and
  // watched_. The factor keeps them in an order of its own, Fronts::border. c and dlambda are the scene's.
  std::optional<linalg::SparseFactor> factor_;
  std::vector<linalg::Run> runs_;  ///< where it keeps those of couplings, each run of one of them
  Eigen::MatrixXd watched_;        ///< how far a force on each of them moves a watched row, a column per watched row
  Eigen::VectorXd free_;           ///< motion of the border rows by the push
  std::vector<int> rim_;           ///< unknowns of P
  Eigen::MatrixXd N_, Y_, Z_;      ///< V = 1 - Y Z Y^T S; empty where A is symmetric
  Eigen::VectorXd y_, turned_, rows_, x_;
  Eigen::VectorXd push_, pushed_, moved_;  ///< what the forces left unbalanced, half solved
  std::vector<int> reach_;                 ///< where rows of contacts may have entries
  Eigen::MatrixXd contacts_, coupled_;     ///< R H_c^T there, and H A^-1 H_c^T
  Eigen::VectorXd half_, column_;          ///< room
};

}  // namespace sinew
