// One linearisation of a whole scene: unbalanced forces, factors, and the correction they ask for. Time steps and
// statics iterate with it.
#pragma once

#include <functional>
#include <optional>
#include <string>

#include "sinew/sim/contact_correction.hpp"
#include "sinew/sim/contact_forces.hpp"
#include "sinew/sim/free_motion.hpp"
#include "sinew/sim/reduced.hpp"
#include "sinew/solve/anderson.hpp"

namespace sinew {

/// A change of everything a step solves for.
struct Increment {
  std::vector<Eigen::Matrix3Xd> dx;  ///< [m] of each solid
  solve::CoupledSolution reduced;
  ContactChange forces;  ///< of contacts and friction
};

/// Keeps its memory from one iterate to the next.
class Linearization {
 public:
  explicit Linearization(threads::Crew& crew = threads::Crew::none()) : crew_(crew) {}

  /// Evaluates forces and rows at an iterate. Context, iterate and times must outlive what is done here. Where it is
  /// known that `factor` will follow, it may as well be told how: volumes are then factored beside the rods.
  void evaluate(const StepContext& context, const State& iterate, StageTimes& times,
                std::optional<solid::Tangent> then = {});

  double largest() const { return largest_; }  ///< [N] largest unbalanced force
  double scale() const { return scale_; }      ///< [N] largest force that acts anywhere
  double violation() const { return reduced_.violation; }
  bool finite() const;
  const Reduced& reduced() const { return reduced_; }
  /// Of a rod, for whoever looks at it before or after this does.
  rod::Configuration& shape(int rod);
  const std::vector<SolidForces>& forces() const { return forces_; }
  ContactRoom& contacts() { return contacts_; }
  /// [m] how far the forces of contacts are from what their laws ask for.
  double contact_error() const { return contact_forces_.error(*context_, *iterate_, contacts_); }
  const ContactRoom& contacts() const { return contacts_; }
  ContactForces::Worst worst_contact() const { return contact_forces_.worst(*context_, *iterate_, contacts_); }
  /// Of contacts at the iterate, and of all that was solved for them since they were last `forgotten`.
  ContactReport contact_report() const;
  void forget() {
    contact_forces_.forget();
    redundant_.clear();
  }
  /// Looks for rows that depend on each other at the iterate beside those that are known (Model::redundant), as they do
  /// in some postures. True if there are any: they are known from now on, and forces must be `evaluate`d again. They
  /// are `forgotten` with the contacts.
  bool find_redundant();
  /// Rows that contradict each other by more than `limit` [m] at the iterate, no motion can answer them all; null:
  /// none.
  const RedundantRows* contradicting(double limit) const;
  /// The last problem of contacts that was solved.
  const solve::CoulombProblem& contact_problem() const { return contact_forces_.problem(); }

  /// (10), (11): factors the volumes and the coupled problem. False with the name of what could not be. A volume by
  /// itself may be unstable where its couplings hold it (a compressed finger without its cable). Where the whole is,
  /// too, or cannot be judged (forces without a potential), an iteration that looks for the nearest minimum (`descent`)
  /// takes definite tangents instead; one that follows a path of equilibria (`any`) does not.
  enum class Wanted { descent, any };
  bool factor(solid::Tangent kind, Wanted wanted, std::string& failed);
  /// Factors the coupled problem again with the rods' own stiffness raised by a millionth: next to a limit
  /// point, where it is singular, the solution is as large as it must be and still has the right direction.
  void stiffen();
  /// All forces have a potential here: the tangent is symmetric, and its negative eigenvalues tell of stability.
  bool conservative() const;
  bool rotated() const { return rotated_; }  ///< a definite tangent stood in for the exact one
  /// Whether the number of negative eigenvalues says if the equilibrium is stable: the tangent is symmetric, and the
  /// exact one.
  bool stability_known() const;
  /// The tangent has more negative eigenvalues than there are rows. False where that is not known.
  bool unstable();
  /// The same in motions that leave contacts which press where they are, as a body makes that they hold. None where
  /// that is not known: contacts of two things that move, of rigid bodies, that hardly press, or touch without, or with
  /// friction; but what would leave the equilibrium although all of these stick is unstable.
  std::optional<bool> unstable_between_contacts();
  /// Numbers of unknowns z that nothing resists, where `unstable` has looked.
  const std::vector<int>& unresisted() const { return unresisted_; }
  /// What was last solved in single precision could not be refined to what double precision gives.
  bool stalled() const { return stalled_; }
  double stiffness() const { return stiffness_; }  ///< [N/m] largest diagonal entry of the volumes' matrices

  /// (12): the correction for the unbalanced forces here or, with the same factors, for those of another evaluation.
  /// Whoever steers may change the reduced solution and the forces at contacts, before volumes follow them.
  using Steer = std::function<void(Increment& increment)>;
  /// One that polishes may be given a `rough` solution, and so much of it; with contacts it is given a good one.
  void solve(Increment& increment, const Steer& steer = {}, std::optional<solve::CoupledFactor::Part> rough = {}) {
    solve(*this, increment, steer, rough);
  }
  void solve(const Linearization& right, Increment& increment, const Steer& steer = {},
             std::optional<solve::CoupledFactor::Part> rough = {});
  /// The same for forces [N] on each volume's unknowns and another right side of the rest.
  void respond(const std::vector<Eigen::VectorXd>& solids, solve::RightSide& side, Increment& increment);
  /// Corrects an increment that was solved for here, with what contacts do beyond the tangent (sim/contact_correction),
  /// until no more than `enough` of forces and rows would be left of it, for six turns at most. Of all turns the one
  /// counts that left least.
  void correct_contacts(double enough, Increment& increment);
  /// The reduced solution alone for another right side, volumes without forces.
  void couple(const solve::RightSide& side, solve::CoupledSolution& solution) { factor_.solve(side, solution); }
  /// The same with forces [N] on each volume's unknowns, which then stand in place of those that `solve` has pushed.
  void couple(const std::vector<Eigen::VectorXd>& solids, solve::RightSide& side, solve::CoupledSolution& solution);
  /// How multipliers move watched points [m], and, while the last forces on volumes still stand (`pushed`), these.
  void watched_motion(const Eigen::VectorXd& dlambda, bool pushed, Eigen::Ref<Eigen::VectorXd> motion);

  /// What was last solved for, and what is answered without looking at what is left of its equations; increments that
  /// are sums of both are then polished as one, for the sum of their right sides.
  const solve::RightSide& side() const { return side_; }
  void answer(const solve::RightSide& side, solve::CoupledSolution& solution, solve::CoupledFactor::Part part) {
    factor_.answer(side, solution, part);
  }
  void polish(const solve::RightSide& side, Increment& increment) {
    polished_ = factor_.polish(side, increment.reduced);
  }

  /// Contacts and rubbing points are part of what is solved here.
  bool touched() const { return contacts_ready_; }
  const ContactForces& contact_forces() const { return contact_forces_; }
  /// "ball and r ...": names a contact that nothing answers; empty if there is none.
  std::string unanswered_contact() const;
  /// How a reduced solution, and the last forces on volumes if they still stand (`pushed`), move their rows [m]; how
  /// forces on these change the reduced solution, and watched points (added).
  void contact_motion(const solve::CoupledSolution& solution, bool pushed, Eigen::Ref<Eigen::VectorXd> u) {
    contact_forces_.motion_of(*context_, free_, solution, pushed, u);
  }
  const solve::CoupledSolution& press(const Eigen::VectorXd& forces) {
    return contact_forces_.response_to(*context_, free_, factor_, forces);
  }
  void pressed_motion(const Eigen::VectorXd& forces, Eigen::Ref<Eigen::VectorXd> motion) const {
    contact_forces_.watched_motion(*context_, free_, forces, motion);
  }
  /// Other forces than were found, where an increment has been changed by what moves the rows by `moved`.
  void change_contacts(const Eigen::VectorXd& moved, const Eigen::VectorXd& lambda, Increment& increment) {
    contact_forces_.change(*context_, contacts_, free_, factor_, moved, lambda, increment.reduced, increment.forces);
  }

 private:
  /// Tasks that know nothing of each other: each volume, and all rods.
  template <class OfSolid, class OfRods>
  void beside(const OfSolid& of_solid, const OfRods& of_rods);
  void factor_solid(std::size_t number, solid::Tangent kind, StageTimes& times);
  bool solids_factored(std::string& failed);
  void factor_border();
  /// How many directions neither rows nor contacts hold in which the tangent is negative.
  int loose();
  void prepare_contacts();
  void push(const std::vector<Eigen::VectorXd>& solids, solve::RightSide& side);
  /// What comes after volumes have been pushed.
  void follow(const std::vector<Eigen::VectorXd>& solids, const solve::RightSide& side, Increment& increment,
              const Steer& steer, std::optional<solve::CoupledFactor::Part> rough = {},
              const Eigen::VectorXd* beyond = nullptr);
  /// Finds E and e of an increment (`found_`); by how much they differ from those that it was solved with (`solved_`;
  /// no entries: none), of the largest force and of the scene's size. Infinite where they are not finite.
  double beyond_tangent(const Increment& increment);
  /// Corrects what was solved in single precision for what it left of the pushes, until nothing is left of them.
  void refine(const std::vector<Eigen::VectorXd>& solids, Increment& increment);

  threads::Crew& crew_;
  const StepContext* context_ = nullptr;
  const State* iterate_ = nullptr;
  StageTimes* times_ = nullptr;
  std::vector<std::vector<int>> redundant_;  ///< groups of rows found beside the model's
  std::vector<SolidForces> forces_;
  Reduced reduced_;
  double largest_ = 0.0, scale_ = 0.0, stiffness_ = 0.0;
  std::optional<solid::Tangent> ahead_;  ///< volumes and chains are factored, with this one
  bool rotated_ = false, coupled_ = false, stalled_ = false;
  int negative_ = 0;  ///< eigenvalues of the volumes' tangents
  std::vector<int> unresisted_;
  enum class Factored { failed, as_told, definite };
  std::vector<Factored> factored_;  ///< each volume
  std::vector<char> exact_;         ///< of each, whether A is the exact tangent
  std::vector<FreeMotion> free_;
  std::vector<StageTimes> spent_;  ///< by each task
  solve::CoupledFactor factor_;
  ContactRoom contacts_;
  ContactForces contact_forces_;
  bool polished_ = true;         ///< the last sum of answers was near
  bool contacts_ready_ = false;  ///< their compliance is that of these factors
  std::vector<Eigen::VectorXd> pushes_;
  solve::RightSide side_;
  State trial_;  ///< where an increment leads, and contacts there
  ContactRoom trial_room_;
  std::vector<Vec3> forces_here_, forces_more_, forces_there_;
  ContactsBeyond beyond_;
  Eigen::VectorXd solved_, found_;  ///< E and e without units
  solve::AndersonAcceleration acceleration_{4};
  Increment best_;
  std::vector<Eigen::VectorXd> left_;  ///< by a refinement, of which these are the rest and a part
  solve::RightSide rest_;
  Increment part_;
};

/// Moves an iterate by `fraction` of an increment.
void advance_by(const StepContext& context, const Increment& increment, double fraction, State& iterate);

/// How far a linearisation may be trusted: the part of an increment that turns nothing by more than 0.8 rad and moves
/// nothing by more than 0.3 of the scene's size.
double trusted_fraction(const StepContext& context, const Increment& increment);

/// What an increment bends or deforms by more than that, for people; empty if there is none. What rigid bodies, bases
/// and whole solids do does not count: their motions are exact, or nearly.
std::string beyond_trust(const StepContext& context, const Increment& increment);

}  // namespace sinew
