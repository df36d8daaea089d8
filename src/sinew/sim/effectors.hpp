// What targets are about: numbers of outputs, how far off they are, and how a linearised step changes them.
#pragma once

#include "sinew/sim/linearization.hpp"
#include "sinew/sim/quantities.hpp"

namespace sinew {

/// Where effectors are to be at the end of a step: their components one after the other, in the order of the model's
/// effectors. Positions [m], turns since the start as rotation vectors [rad] in the axes of the world, strains [1/m] or
/// 1, normal forces between two [N].
struct Goal {
  Eigen::VectorXd at;
};

/// What the scene's targets ask for at a time; where effectors are at the start, of targets set from outside.
Goal goal_at(const Model& model, double time);
void goal_at(const Model& model, double time, Goal& goal);

/// An effector's components: what counts as much as 1 mm of a position [SI]; in what a person speaks of them, and how
/// much that is; the name of the SI unit.
struct Measure {
  double unit = 1e-3;
  const char* name = "mm";
  double shown = 1e-3;
  const char* si = "m";
};
Measure measure_of(const Model& model, const EffectorModel& effector);

/// Name and SI unit of each of its components: "tip.x", "m".
std::vector<Column> effector_columns(const Model& model, const EffectorModel& effector);

/// How many components all effectors have.
int effector_size(const Model& model);

/// What an output of such a quantity has for a target.
Eigen::VectorXd effector_value(const Model& model, const State& state, const EffectorModel& effector);

/// How far effectors are off their goals: position, strain and force by their difference, turns by the rotation vector
/// from the goal to where they are. Two that are to be pressed together and are still apart lack 0.1 N more for every
/// mm between them, so that what is to press comes nearer.
void effector_errors(const Model& model, const State& state, const Goal& goal, Eigen::VectorXd& errors);

/// How far off one is in the components that matter [SI].
double error_of(const EffectorModel& own, const Eigen::VectorXd& errors);

/// Errors in units of tolerances, the largest of all effectors: reached if not above 1.
double farthest(const Model& model, const Eigen::VectorXd& errors);

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
