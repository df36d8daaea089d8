// Contacts and rods that rub in their channels, in the linear problem of a step: their compliance D, once everything
// else is eliminated, and the forces that Signorini's and Coulomb's laws ask for.
#pragma once

#include "sinew/sim/contacts.hpp"
#include "sinew/sim/free_motion.hpp"
#include "sinew/sim/reduced.hpp"
#include "sinew/solve/coulomb.hpp"

namespace sinew {

/// To which the problem of all contacts is solved, beside the largest force (solve/coulomb).
inline constexpr double kCoulombTolerance = 1e-12;

/// What forces change by: of each contact, in the world, and of friction at each of the model's rubbing points [N].
struct ContactChange {
  struct Force {
    Vec3 from, more;  ///< [N]
    Vec3 normal;      ///< where both are told
  };
  std::vector<Force> contacts;
  std::vector<double> frictions;
};

/// Keeps its memory from one linearisation to the next.
class ContactForces {
 public:
  /// Whether there is anything to do.
  static bool wanted(const Model& model, const ContactRoom& room) {
    return !room.playing.empty() || !model.rubbing.empty();
  }
  /// Rows J of all contacts, in their frames, and D = J A^-1 J^T with A the matrix of the whole step, coupling rows
  /// included. `factor` and `free` must be factored. Where a rod rubs in its channel, J is the point's abscissa.
  void prepare(const StepContext& context, const State& iterate, const ContactRoom& room, const Reduced& reduced,
               std::vector<FreeMotion>& free, solve::CoupledFactor& factor);
  /// How many directions in which the step's matrix A is negative are held by contacts that press and stick: the
  /// negative eigenvalues of their part of D. `prepare` must have gone before.
  int held(const ContactRoom& room) const;
  /// Whether the tangent has all that contacts which press do, and each of them holds: frictionless, on obstacles, by
  /// rods or solids, with forces that are no rounding beside `scale` [N].
  static bool conserve(const StepContext& context, const State& iterate, const ContactRoom& room, double scale);
  /// Whether contacts which press do so on obstacles, by rods or solids, and those with friction stick.
  static bool stick_on_obstacles(const StepContext& context, const State& iterate, const ContactRoom& room);
  /// Finds the forces that go with the solution so far, and adds to it what they change. Where the rows are known to
  /// move by e [m] `beyond` J dx (sim/contact_correction), it begins with the forces that it found last.
  void solve(const StepContext& context, const State& iterate, const ContactRoom& room, std::vector<FreeMotion>& free,
             solve::CoupledFactor& factor, solve::CoupledSolution& solution, ContactChange& change,
             const Eigen::VectorXd* beyond = nullptr);
  /// Other forces, where the solution has been changed since by what moves the rows by `moved` [m].
  void change(const StepContext& context, const ContactRoom& room, std::vector<FreeMotion>& free,
              solve::CoupledFactor& factor, const Eigen::VectorXd& moved, const Eigen::VectorXd& lambda,
              solve::CoupledSolution& solution, ContactChange& change);
  /// How a solution of the reduced problem, volumes included and, if they still stand (`pushed`), forces on them, moves
  /// the rows [m].
  void motion_of(const StepContext& context, std::vector<FreeMotion>& free, const solve::CoupledSolution& solution,
                 bool pushed, Eigen::Ref<Eigen::VectorXd> u);
  /// What forces at the rows change of the reduced solution, and of watched points (added) by themselves.
  const solve::CoupledSolution& response_to(const StepContext& context, std::vector<FreeMotion>& free,
                                            solve::CoupledFactor& factor, const Eigen::VectorXd& forces);
  void watched_motion(const StepContext& context, const std::vector<FreeMotion>& free, const Eigen::VectorXd& forces,
                      Eigen::Ref<Eigen::VectorXd> motion) const;
  /// [m] how far the forces of an iterate are from what the laws ask for, told as displacements by the D of the last
  /// `prepare`; that of the first is not known, and infinite.
  double error(const StepContext& context, const State& iterate, const ContactRoom& room) const {
    return worst(context, iterate, room).error;
  }
  /// The one whose force is furthest from that, of the iterate's contacts, or of its points that rub in a channel;
  /// -1: none, or it is not known.
  struct Worst {
    double error = 0.0;
    int contact = -1, rubbing = -1;
  };
  Worst worst(const StepContext& context, const State& iterate, const ContactRoom& room) const;

  /// The contact of the iterate that closes although nothing answers along its normal, no strain, node or body; -1:
  /// none.
  int unanswered() const { return unanswered_; }
  /// Of the problems since they were last forgotten, without their contacts.
  const ContactReport& report() const { return report_; }
  void forget() { report_ = {}; }
  /// Of the step's contacts and, after them, rods that rub; its forces `found`, and those of the iterate it `had`.
  const solve::CoulombProblem& problem() const { return problem_; }
  const Eigen::VectorXd& found() const { return lambda_; }
  const Eigen::VectorXd& had() const { return old_; }
  /// [m] J dx of what `solve` has found; not of rows that nothing answers, and of rods that rub.
  const Eigen::VectorXd& moved() const { return moved_rows_; }
  bool answered(int contact) const { return answered_[static_cast<std::size_t>(contact)]; }
  /// Which contacts of the iterate these are.
  const std::vector<int>& touching() const { return touching_; }

 private:
  /// What moves one contact, in its frame: three rows over some unknowns.
  struct OnBody {
    int contact = 0, unknown = 0;  ///< first of as many in z as J has columns
    Eigen::Matrix3Xd J;
  };
  struct OnRod {
    int contact = 0, rod = 0;
    Eigen::Matrix3Xd J;  ///< over its strains
  };
  /// A rod in its channel. Its friction is the first tangent of a contact of its own, whose normal force is known: what
  /// presses the rod against the channel. So both kinds are one problem.
  struct Rubbing {
    int point = 0, row = 0;
    Vec3 tangent = Vec3::Zero();
    double friction = 0.0;
    double limit(const Eigen::VectorXd& lambda) const {
      const Vec3 force = lambda.segment<3>(row);
      return friction * (force - tangent * tangent.dot(force)).norm();
    }
  };
  /// Force and u of a contact at an iterate, in its frame.
  struct At {
    Vec3 force, u;
  };
  At at(const StepContext& context, const State& iterate, const ContactRoom& room, int contact) const;
  int contacts() const { return static_cast<int>(touching_.size() + rubbing_.size()); }
  void add_rows(const StepContext& context, const State& iterate, const ContactRoom& room, const Reduced& reduced);
  void respond(const StepContext& context, std::vector<FreeMotion>& free, solve::CoupledFactor& factor,
               const Eigen::VectorXd& lambda);
  void add(const ContactRoom& room, std::vector<FreeMotion>& free, const Eigen::VectorXd& more,
           solve::CoupledSolution& solution, ContactChange& change);
  void push(const StepContext& context, const Eigen::VectorXd& lambda, const std::vector<FreeMotion>& free,
            solve::RightSide& side);
  void motion(const solve::CoupledSolution& solution, Eigen::Ref<Eigen::VectorXd> u) const;
  void bodies_motion(const solve::CoupledSolution& solution, Eigen::Ref<Eigen::VectorXd> u) const;

  std::vector<int> touching_;  ///< contacts that play; those that rub come after them
  std::vector<Rubbing> rubbing_;
  std::vector<OnBody> on_bodies_;
  std::vector<OnRod> on_rods_;
  std::vector<linalg::SparseFactor::Rows> on_solids_;  ///< rows of each, all contacts
  std::vector<std::vector<int>> rows_of_;              ///< which rows those are
  solve::RightSide side_;
  solve::CoupledSolution answer_;
  solve::CoulombProblem problem_;
  std::vector<bool> answered_;  ///< of each contact, along its normal
  int unanswered_ = -1;
  solve::Coulomb coulomb_;
  ContactReport report_;
  std::vector<Eigen::MatrixXd> moved_;  ///< of each rod, its coordinates by each row
  Eigen::VectorXd lambda_, old_, own_, rows_, moved_rows_;
};

}  // namespace sinew
