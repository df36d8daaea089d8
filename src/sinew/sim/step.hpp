// One time step: backward Euler of (6) and (7) with their couplings.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "sinew/error/warning.hpp"
#include "sinew/sim/state.hpp"
#include "sinew/sim/status.hpp"
#include "sinew/solve/coulomb.hpp"

namespace sinew {

/// A spring that draws a node of a solid to a point of the world, as a hand does.
struct Grip {
  int solid = 0, node = 0;
  double stiffness = 0.0;  ///< [N/m] >= 0
  Vec3 to = Vec3::Zero();  ///< [m]
};

/// What motors and loads are told for the end of a step, and who else pulls.
struct Command {
  std::vector<double> actuators;  ///< one each, in the unit of what drives it (N, m, N m, rad)
  std::vector<double> loads;      ///< factor of each [-]
  std::vector<Grip> grips = {};   ///< of no scene: of whoever steps it by hand
};

/// The value of a table at a time; 0 where it is driven from outside.
double told_at(const Drive& drive, double time);
/// All of them.
Command command_at(const Model& model, double time);
void command_at(const Model& model, double time, Command& command);
/// What a state obeys: the forces and factors it was told, and where its motors are.
Command command_of(const Model& model, const State& state);
/// The command that is a part of the way from one to another.
Command between(Command from, const Command& to, double part);

/// Seconds spent, summed over the iterations of a step and over what runs side by side: each volume, and the rods.
struct StageTimes {
  double forces = 0.0, assembly = 0.0, factor = 0.0, compliance = 0.0, rods = 0.0, solve = 0.0, contact = 0.0;
  double step = 0.0;  ///< from its beginning to its end, halved attempts included: all stages and what is between them

  StageTimes& operator+=(const StageTimes& other);
};

/// What takes the time of a step.
struct Stage {
  const char* name;
  double StageTimes::*seconds;
  const char* what;
};
inline constexpr Stage kStages[] = {
    {"forces", &StageTimes::forces, "elastic and viscous forces of volumes"},
    {"assembly", &StageTimes::assembly, "tangents of their elements"},
    {"factor", &StageTimes::factor, "their factorisation, rows of couplings included"},
    {"compliance", &StageTimes::compliance, "how they give way where they are coupled, W"},
    {"rods", &StageTimes::rods, "forces, tangents and rows of rods"},
    {"solve", &StageTimes::solve, "rods and couplings solved together, volumes corrected"},
    {"contact", &StageTimes::contact, "what is near what, and the forces where it touches"},
    {"step", &StageTimes::step, "the whole step"},
};

inline StageTimes& StageTimes::operator+=(const StageTimes& other) {
  for (const Stage& stage : kStages) this->*stage.seconds += other.*stage.seconds;
  return *this;
}

/// What came of contacts and of friction in channels, at the last iterate that was looked at.
struct ContactReport {
  int contacts = 0;             ///< near enough to matter, and points that rub
  double penetration = 0.0;     ///< [m] of the deepest, in a pair that was apart when the run began
  int deepest_pair = -1;        ///< of the model's
  bool between_nodes = false;   ///< there: an edge in a surface, between its nodes
  int sweeps = 0, newton = 0;   ///< of solve/coulomb in the whole step
  double work = 0.0;            ///< of it in the whole step, multiplications
  int cut = 0;                  ///< of its problems in the step, those that took all the work that one may take
  int unsolved = 0;             ///< of its problems in the step, those not solved to its tolerance
  solve::CoulombResidual left;  ///< of the last one
};

/// What keeps a motor from doing more.
enum class Limit { least_force, most_force, least_position, most_position, speed, force_rate };
struct Bound {
  int actuator = 0;  ///< of the model's
  Limit limit = Limit::most_force;
};

/// What came of the scene's targets in a step.
struct Aim {
  enum class Outcome {
    none,       ///< it had none
    reached,    ///< all, within their tolerances
    limited,    ///< limits of motors are in the way
    nearest,    ///< none is: this is the nearest that these motors can do, or have done so far in one step
    on_the_way  ///< of a part of a step, which made for a place on the way
  };
  Outcome outcome = Outcome::none;
  double farthest = 0.0;       ///< [-] largest error of a target over its tolerance
  std::vector<Bound> binding;  ///< limits that are in the way
  std::vector<Bound> dropped;  ///< limits that others exclude, and that are broken as little as can be
  std::vector<Bound> broken;   ///< limits that are not kept although nothing excludes them: motors that hold each other
  /// No other commands within the limits would have done better in the last linearisation. Not known with friction, or
  /// more than a dozen contacts: none around it would have.
  bool certain = false;
  int apart = -1;  ///< effector whose two are to press and are not near each other
  /// Other commands may come nearer: no step with them converged, or there was too much work to look for them.
  bool short_of = false;
  /// [-] by how much the linearisation that says so is off (`StepReport::off`); 0 where it is not known to be.
  double off = 0.0;
};

/// What came of a step: how it ended, how well, and what it cost.
struct StepReport {
  Status status = Status::rest;
  int newton = 0;          ///< linearisations made
  int halvings = 0;        ///< of the scene's step until it could be made
  double residual = 0.0;   ///< largest unbalanced force over the largest force that acts anywhere
  double violation = 0.0;  ///< [m] largest of all constraints: sliding points, ties, glue, motors, lengths of cables
  bool rotated = false;    ///< a definite tangent stood in for the exact one somewhere
  bool unstable = false;   ///< of statics: the equilibrium is one that a real rod would leave (it has buckled)
  /// Of statics: whether that could be told. Not of loads without a potential (follower forces, pressure on a surface
  /// with a free rim), where contacts may hold what would buckle, of `newton: n` or a definite tangent in its stead.
  bool stability_known = false;
  bool redundant = false;  ///< constraint rows depended on each other
  bool at_floor = false;   ///< forces were balanced to their rounding, not to the tolerance (`convergence_of`)
  /// [-] of an accepted step of `newton: n` that left much: how far a converged step from the same start ends beside
  /// it, as a part of the way that things have moved since the run began; infinite where none was found, 0 where
  /// nothing was left, or none was made (Effort::compared).
  double off = 0.0;
  bool judged = false;            ///< it was looked for what a user should be warned of (not with Evaluation::motion)
  std::vector<Warning> warnings;  ///< of an accepted step
  std::string detail;             ///< names what failed, for people
  ContactReport contact;
  Aim aim;
  StageTimes times;
};

/// Counts what an attempt or a part has cost in what the whole has.
void add_effort(const StepReport& part, StepReport& whole);

struct Memory;

/// Memory that steps of one model reuse, which must outlive it; holds nothing between them that they would not find
/// again. One per thread that steps. Results are the same to the last bit for any number of `threads` that share the
/// work of a step.
class Workspace {
 public:
  explicit Workspace(const Model& model, int threads = 1);
  ~Workspace();
  Workspace(Workspace&&) noexcept;
  Workspace& operator=(Workspace&&) noexcept;
  Memory& memory() { return *memory_; }

 private:
  std::unique_ptr<Memory> memory_;
};
inline Workspace make_workspace(const Model& model, int threads = 1) { return Workspace(model, threads); }

/// What a step with a fixed number of linearisations (`newton: 1`) evaluates at its end.
enum class Evaluation {
  full,
  /// Only what the next step needs, for controllers that need no more: reactions and internal forces stay those of the
  /// last full step, residual and violation are those before the last linearisation, and nothing is warned of
  /// (`StepReport::judged`). Half the forces, half the rods.
  motion
};

/// How a step is made.
struct Effort {
  Evaluation evaluation = Evaluation::full;
  bool converged = false;  ///< until the tolerance is met, whatever the scene's `newton` says
  bool compared = false;   ///< where a step of `newton: n` leaves much, a converged one tells how far it is off
};

/// Advances a state by h [s]. On failure it stays as it is; while the step runs nobody may read it, as it stands
/// elsewhere then. After the first step of a model no memory is asked for where Newton's steps need no fallback.
StepReport step(const Model& model, Workspace& workspace, const Command& command, double h, State& state,
                Effort effort = {});

/// The same by value.
struct StepResult {
  State next;
  StepReport report;
};
StepResult step(const Model& model, Workspace& workspace, const Command& command, const State& state, double h);

}  // namespace sinew
