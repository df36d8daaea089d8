// Newton's iteration on a whole scene, of time steps and statics alike.
#pragma once

#include <algorithm>
#include <array>
#include <functional>
#include <memory>

#include "sinew/sim/contact_passage.hpp"
#include "sinew/sim/inverse.hpp"

namespace sinew {

/// Where Newton starts, and ends: a state and how far what is prescribed has come (1: all of it).
struct Iterate {
  State state;
  double t = 1.0;
};

/// The plane across a path of equilibria that an arc length step stays in: direction . du + rate dt = 0, du `measured`.
struct AcrossPath {
  Eigen::VectorXd direction;
  double rate = 0.0;
};

/// How Newton is to go.
struct NewtonRules {
  int limit = 0;       ///< most rounds
  bool fixed = false;  ///< so many rounds with definite tangents, whatever is left (`newton: 1` of the paper), none of
                       ///< which goes `beyond_trust`
  /// Which equilibrium is looked for: the nearest minimum, by steps that are shortened where they lead away from it, or
  /// any at all, by steps that are only limited to what a linearisation can be trusted for.
  Linearization::Wanted wanted = Linearization::Wanted::descent;
  const AcrossPath* across = nullptr;  ///< t is looked for, too
  /// It begins where velocities have led, and is given up once an iteration after the second helps by less than a
  /// fifth.
  bool on_trial = false;
  bool settles = false;  ///< on its way to an equilibrium: contacts that move apart what overlaps may add energy
  Evaluation evaluation = Evaluation::full;  ///< of fixed rounds
  bool compared = false;                     ///< with a converged step, where they leave much
  Inverse* inverse = nullptr;                ///< commands are looked for, too: it has begun
};

/// Whether contact problems of a step have cost too much: three of them took all the work that one may take
/// (solve/coulomb) and were not solved, or all together some twenty seconds of a processor. It is given up then, as no
/// shorter part of it has fewer contacts.
inline bool contacts_cost_too_much(const ContactReport& spent) {
  constexpr int kMostCut = 3;
  constexpr double kMostWork = 8e10;  // multiplications
  return spent.cut >= kMostCut || spent.work > kMostWork;
}

/// Says what is prescribed at t.
using ContextAt = std::function<void(double t, StepContext& context)>;

/// Halves the last increment while it leads where a law ends (an element turned inside out), and that of a static
/// equilibrium while the unbalanced force grows. Motion of rows is not judged: a motor that has moved must load the
/// rods before anything can be balanced.
class LineSearch {
 public:
  void begin() { taken_ = false; }
  void take(const State& from, const Increment& increment, double fraction, const Linearization& there);
  bool too_far(const StepContext& context, const Linearization& here) const;
  /// By how much of the increment the iterate is then nearer to where it came from.
  double shorten(const StepContext& context, State& iterate);

 private:
  bool taken_ = false;
  State from_;
  Increment increment_;
  double fraction_ = 1.0, force_ = 0.0, judged_ = 0.0;
  int halvings_ = 0;
};

struct Modes;

/// Which contacts come and go from one iterate to the next.
class ComingAndGoing {
 public:
  void begin() { pressed_.clear(); }
  void look(const std::vector<ContactState>& contacts);
  /// How often each has come or gone.
  const std::vector<int>& turns() const { return turns_; }

 private:
  std::vector<char> pressed_;
  std::vector<int> turns_;
};

/// What a Workspace keeps.
struct Memory {
  Memory(const Model& model, int threads) : crew(threads), context(model), ahead(model), here(crew), there(crew) {}
  threads::Crew crew;
  StepContext context, ahead;
  Linearization here, there;
  Increment increment, change;
  LineSearch search;
  ComingAndGoing contacts;
  Iterate iterate;
  /// Unbalanced force over the largest that acts, of Newton's last three iterates, the newest last: they tell how it
  /// contracts.
  std::array<double, 3> residuals = {};
  Command command;
  Inverse inverse;
  double alarm = 0.0;                  ///< [m] within which contacts are looked for
  Passage passage;                     ///< what the second look at them has found
  EarlierLooks looks;                  ///< at this step
  std::shared_ptr<const Modes> modes;  ///< of a modal analysis, once they are known
};

/// Iterates until forces and rows are balanced and completes the state (`finish`). On failure the report names it and
/// the iterate is where it ended.
StepReport newton(const ContextAt& at, Memory& memory, const NewtonRules& rules, Iterate& iterate);

// Of time steps (step.cpp):

/// How the scene wants its steps made, or whoever makes them.
NewtonRules step_rules(const Model& model, const Effort& effort);
/// Whether a step of so many linearisations failed, and might go through if it converges.
inline bool may_converge(const NewtonRules& rules, const StepReport& report) {
  return rules.fixed && !accepted(report.status) && report.status != Status::inconsistent;
}
/// What such a step cost, and why it failed where the same step, made until it converges, fails as well. (Its status
/// is that of the linearisations then, whose remedy is to leave them out, unless the other one knows better.)
void add_linearised(const StepReport& linearised, StepReport& report);

/// Repeats a step as long as its second look finds contacts that were not looked for, each time within a longer
/// distance, or something that was taken to fly past and has not, or some that press where nothing is, without them; a
/// few times at most. `make` makes it with Memory::alarm, which begins as `alarm`, and Memory::looks.
template <class Make>
StepReport look_until_found(Memory& memory, double alarm, const Make& make) {
  constexpr int kLooks = 4;
  const auto look_better = [&memory](bool last) {
    const Passage& passage = memory.passage;
    if (passage.kind == Passage::Kind::missed) memory.alarm = std::max(2.0 * memory.alarm, 1.5 * passage.alarm);
    std::vector<int>& met = memory.looks.met;
    met.insert(met.end(), passage.met.begin(), passage.met.end());
    if (passage.kind == Passage::Kind::missed) met.push_back(passage.pair);
    memory.looks.nothing_passes = last && !met.empty();
    std::vector<ContactKey>& behind = memory.looks.left_behind;
    behind.insert(behind.end(), passage.left_behind.begin(), passage.left_behind.end());
    return passage.kind == Passage::Kind::missed || passage.kind == Passage::Kind::met ||
           passage.kind == Passage::Kind::left_behind;
  };
  memory.alarm = alarm;
  memory.looks = {};
  StepReport report = make();
  for (int looks = 1; looks < kLooks && look_better(looks + 1 == kLooks); ++looks) {
    const StepReport earlier = std::move(report);
    report = make();
    add_effort(earlier, report);
  }
  return report;
}

/// What a step begins with: where it starts, or where velocities carry that, as far as nothing is in the way.
enum class Guess { start, moved_on };
/// First guess of a step that Memory::context describes, and the contacts looked for in it; returns the seconds that
/// finding them took.
double begin_step(Memory& memory, Guess guess = Guess::start);

/// One step of h from a state to a command, by these rules: `step`, `inverse_step`. On failure the state stays.
StepReport step_by(const NewtonRules& rules, Memory& memory, const Command& command, double h, State& state);

// And of paths:

/// What changes of an equilibrium as t grows: the tangent K u' = -dr/dt of the path, into Memory::change. Memory::here
/// stands there and is factored, and `increment` is what it gives.
void change_along(const ContextAt& at, Memory& memory, const Iterate& iterate, StageTimes& times);

/// An increment as one vector: what each number turns [rad], or moves in units of the scene's size.
Eigen::VectorXd measured(const Model& model, const Increment& increment);

}  // namespace sinew
