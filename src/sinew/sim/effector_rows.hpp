// How a linearised step changes what targets are about.
#pragma once

#include "sinew/sim/linearization.hpp"
#include "sinew/sim/targets.hpp"

namespace sinew {

/// How errors change with what a step solves for, d error = J (dx of watched points, dz, dq of rods, contact forces).
/// Keeps its memory from one linearisation to the next.
class EffectorRows {
 public:
  void look(const StepContext& context, const State& iterate, Linearization& here, const Goal& goal,
            const Eigen::VectorXd& errors);
  /// A force (or moment, or what works on a strain) of 1 on one component: on unknowns of volumes, and in a right side.
  void force_on(const Model& model, int component, std::vector<Eigen::VectorXd>& solids, solve::RightSide& side) const;
  /// Of what is apart, the contact that commands close first: they move contacts by the columns of B.
  void choose_gaps(Linearization& here, const Eigen::MatrixXd& B);
  /// The errors of forces, by contacts as the linearisation has found them.
  void force_errors(Linearization& here, const Goal& goal, Eigen::Ref<Eigen::VectorXd> errors) const;
  /// By a solution of the reduced problem, volumes included, and, while the last forces on volumes still stand
  /// (`pushed`), these.
  void motion(Linearization& here, const solve::CoupledSolution& solution, bool pushed,
              Eigen::Ref<Eigen::VectorXd> change);
  /// By forces at contacts alone: through watched points, and those that are told. `u`: how they move the contacts.
  void pressed(Linearization& here, const Eigen::VectorXd& forces, const Eigen::VectorXd& u,
               const solve::CoupledSolution& response, Eigen::Ref<Eigen::VectorXd> change);
  /// What moves contacts apart by u changes of errors in force: added.
  void add_gaps(const Eigen::VectorXd& u, Eigen::Ref<Eigen::VectorXd> change) const;

 private:
  struct Own {
    int first = 0;       ///< component
    int watched = -1;    ///< first watched point
    int unknown = -1;    ///< first z
    int rod = -1;        ///< whose strains
    int pair = -1;       ///< whose normal force
    bool apart = false;  ///< but is to press: it is to come nearer
    int nearest = -1;    ///< by this contact of those that the linearisation solves for
    Eigen::MatrixXd over_points, over_z, over_strains;
  };
  void add_forces(const Linearization& here, const Eigen::VectorXd& forces, Eigen::Ref<Eigen::VectorXd> change) const;
  void change_by(const solve::CoupledSolution& solution, Eigen::Ref<Eigen::VectorXd> change) const;

  std::vector<Own> own_;
  const State* iterate_ = nullptr;
  Eigen::VectorXd points_;
};

}  // namespace sinew
