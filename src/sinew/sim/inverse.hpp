// The inverse problem, (1) and (13) to (15): steps and equilibria in which commands of motors are what is looked for.
#pragma once

#include <string>
#include <vector>

#include "sinew/sim/effector_rows.hpp"
#include "sinew/solve/steering.hpp"

namespace sinew {

/// What is looked for at one linearisation: increments p of the sought commands that bring effectors nearest to their
/// goals within the motors' limits, while contacts answer (solve/steering); where these leave a choice, forces nearest
/// to the preferred ones. Keeps its memory.
class Inverse {
 public:
  /// [mm, deg, ...] increments that move effectors no more than this end a search; goals are then met to about that.
  static constexpr double kSettled = 1e-5;
  /// For a step of h [s] from a state; h = 0: rates do not matter.
  /// `on_the_way`: what is made for instead of the goal, by which `aim` judges.
  void begin(const Model& model, const State& start, const Goal& goal, double h, const Goal* on_the_way = nullptr);
  /// Adds to an increment what the best commands change.
  void steer(const StepContext& context, const State& iterate, Linearization& here, Increment& increment);
  /// What it takes of solutions that are not yet polished.
  solve::CoupledFactor::Part part() const { return part_; }
  /// A part of them becomes the command.
  void take(double fraction, const Model& model, Command& command) const;
  /// No increment would change a command, or what it does to the effectors, by anything to speak of.
  bool settled(const Command& command, const Model& model) const;
  /// The best commands of a linearisation were looked for in vain: with many contacts that is too much work.
  bool cut_short() const { return steering_.cut_short(); }
  /// How far the linearisation's increments would move the effectors, weighed.
  double motion() const { return (steering_.left() - problem_.e).norm(); }
  /// What searches make small: half the square of weighed errors, and what it costs to be beyond limits. `weigh_limits`
  /// raises that to what the last increments have shown; `promised` is what they leave of it, by the linearisation.
  double cost(const Model& model, const State& state);
  double promised() const;
  void weigh_limits();
  /// What came of it, at the state that the step has ended in.
  Aim aim(const Model& model, const State& state);
  /// The longest increment, in the measure of `reach`.
  double moved() const { return steering_.p().cwiseAbs().cwiseProduct(lengths_).maxCoeff(); }
  /// Increments no longer than this [mm, deg, ...] of what they move effectors, or motors, by; none: any.
  double reach = INFINITY;

  /// Responses to one more unit of each sought command, and of forces at contacts, at `here`, factored.
  /// `polished`: what is made of it will be.
  void look(const StepContext& context, const State& iterate, Linearization& here, const Increment& increment,
            bool polished = false);
  /// How effectors give way to forces on them, contacts going on as they are. What was pushed no longer stands then.
  Eigen::MatrixXd compliance(const Model& model, Linearization& here);
  /// How forces at contacts follow the commands, for what is asked next.
  void follow_contacts();
  /// Responses of effectors, of the motors' forces and of their places, contacts going on as they are.
  Eigen::MatrixXd jacobian() const { return J_ + L_ * S_; }
  Eigen::MatrixXd weighed_jacobian() const { return weights_.asDiagonal() * jacobian(); }
  Eigen::MatrixXd force_change() const { return F_ + F_pressed_ * S_; }
  Eigen::MatrixXd position_change() const { return X_ + X_pressed_ * S_; }

 private:
  /// Of a row of limits: between what, what of the motor, and in what it is told.
  Span span_of(const ActuatorModel& motor, Eigen::Index row) const;
  double value_of(const Model& model, const State& state, Eigen::Index row) const;
  double unit_of(const Model& model, Eigen::Index row) const;
  void set_limits(const StepContext& context, const State& iterate, const solve::CoupledSolution& solution);
  /// Commands of rows that depend on each other must agree: N^T (c - p) = 0.
  void add_agreement(const Model& model, const Reduced& reduced);

  Goal asked_, goal_;  ///< what was asked for, and what is made for
  bool on_the_way_ = false;
  solve::CoupledFactor::Part part_ = solve::CoupledFactor::Part::all;
  double h_ = 0.0;
  std::vector<double> start_force_, start_position_;
  EffectorRows rows_;
  solve::RightSide unit_, told_;
  std::vector<solve::CoupledSolution> responses_;
  Eigen::VectorXd error_, base_, weights_, forces_, moved_, lengths_, preferred_, penalty_;
  Eigen::MatrixXd J_, F_, X_;                  ///< d(errors, forces of motors, their places) / d commands
  Eigen::MatrixXd L_, F_pressed_, X_pressed_;  ///< and by forces at contacts
  Eigen::MatrixXd S_;                          ///< which follow commands by this
  solve::SteeringProblem problem_;
  solve::Steering steering_;
  std::vector<Bound> bounds_, binding_, dropped_;
};

/// What is made of a step that may be halved; by itself, all of it.
struct PartOfStep {
  const Goal* on_the_way = nullptr;  ///< it may make for another place than the goal by which it is judged
  bool begins = true;                ///< nothing of the step is behind it
  bool at_once = true;               ///< nothing longer was tried from here
};

/// A step as `step` makes, whose sought motors bring the effectors nearest to their goals within their limits. With
/// `newton: n` of the scene in so many linearisations (1: the paper's one problem a step), else until it has converged.
/// Where commands and motion together do not converge, in motion, and something presses, commands are looked for from
/// those of the state on, in a region of trust, as far towards the goals as steps converge; else, and where that leads
/// nowhere, they are changed a little towards what would bring the effectors to their goals at rest, so that a goal
/// which is too far for a step is come to in many (`Aim::short_of`). Of the command the sought actuators do not count.
/// What came of it is in StepReport::aim. Throws std::invalid_argument where the goal has another size or is not
/// finite, or the model has no targets.
StepReport inverse_step(const Model& model, Workspace& workspace, const Goal& goal, const Command& command, double h,
                        State& state, Effort effort = {}, const PartOfStep& part = {});

/// The equilibrium under what is prescribed at `time`, as `equilibrium_step` finds it, with the commands that bring the
/// effectors nearest to their goals within their limits: Gauss and Newton's method on the exact tangents of equilibria,
/// each of them found, in a region of trust, until no increment helps. On failure the state stays.
StepReport inverse_equilibrium(const Model& model, Workspace& workspace, const Goal& goal, const Command& command,
                               double time, State& state);

/// Derivatives with respect to the commands of the sought actuators; contacts go on as they are, open, sticking or
/// slipping.
struct ActuatorJacobian {
  Eigen::MatrixXd effectors;               ///< of the components of all effectors, a row each [SI]
  Eigen::MatrixXd compliance;              ///< of the same by forces on them: m/N, rad/(N m), ... motors go on as told
  Eigen::MatrixXd forces, positions;       ///< of the motors themselves [N or N m], [m or rad]
  std::vector<std::string> rows, columns;  ///< "tip.x [m]", "pull.force [N]"
};

/// In how many independent directions a Jacobian's effectors can be moved, and how well.
struct Manipulability {
  Eigen::VectorXd gains;       ///< of effectors by a unit of commands, descending: the half axes of an ellipsoid
  Eigen::MatrixXd directions;  ///< of effectors, a column each
  Eigen::MatrixXd commands;    ///< that move them there, a column each, of length 1
  double measure = 0.0;        ///< product of the gains (Yoshikawa): 0 in a singular posture
};
Manipulability manipulability(const Eigen::MatrixXd& jacobian);

/// `step`: of where one linearisation takes the effectors in a step of h from a state, (14); what a controller of that
/// rate sees. `equilibrium`: of where they come to rest, by the exact tangent of an equilibrium; h does not matter.
enum class JacobianOf { step, equilibrium };
/// Throws std::invalid_argument where the model has no targets, and std::runtime_error where a matrix is singular.
ActuatorJacobian actuator_jacobian(const Model& model, Workspace& workspace, const State& state, JacobianOf of,
                                   double h);

/// W = H A^-1 H^T of (11): how solids give way [m/N] where they are coupled, a row and a column for each of the model's
/// constraint rows (zero for those that no solid takes part in); rods are not part of it. As above: of a step of h, or
/// at rest. Throws std::runtime_error where a matrix is singular.
Eigen::MatrixXd volume_compliance(const Model& model, Workspace& workspace, const State& state, JacobianOf of,
                                  double h);

}  // namespace sinew
