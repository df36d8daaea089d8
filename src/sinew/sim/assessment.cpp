#include "sinew/sim/assessment.hpp"

#include <algorithm>
#include <cmath>

#include "sinew/error/digits.hpp"
#include "sinew/sim/coarse_rods.hpp"
#include "sinew/sim/contact_places.hpp"
#include "sinew/sim/held_contact.hpp"
#include "sinew/sim/internal.hpp"
#include "sinew/sim/motors.hpp"
#include "sinew/sim/places.hpp"
#include "sinew/sim/signals.hpp"
#include "sinew/sim/sliding_rods.hpp"
#include "sinew/sim/step_ends.hpp"
#include "sinew/sim/strained_rods.hpp"
#include "sinew/sim/touched_rods.hpp"
#include "sinew/sim/unbalanced.hpp"
#include "sinew/sim/unresisted.hpp"
#include "sinew/sim/work.hpp"

namespace sinew {

namespace {

constexpr double kBeyondBearing = 1e6;         ///< times Model::bearing
constexpr double kLinearisedResidual = 0.05;   ///< of the largest force: of a step of `newton: n`
constexpr double kLinearisedViolation = 1e-3;  ///< of the scene's size: the same
constexpr double kMissedLaws = 1e-9;           ///< of the largest force: the same, of laws of contact
constexpr double kLinearisedOff = 0.05;        ///< of the motion: how far it may end beside a converged step

/// Collects the warnings of one step.
class Warnings {
 public:
  Warnings(double time, std::vector<Warning>& list) : time_(time), list_(list) {}
  void add(Warning warning) {
    warning.time = time_;
    warning.steps = 1;
    list_.push_back(std::move(warning));
  }

 private:
  double time_;
  std::vector<Warning>& list_;
};

/// A thin rod that slides in a body cannot push to speak of.
bool is_thread(const RodModel& rod) {
  return !rod.slides.empty() && rod::radius_at(rod.rod.profile, 0.0) <= 0.02 * rod.rod.length();
}

void warn_of_thread(const Model& model, int number, const std::string& where, double push, Warnings& warnings) {
  const RodModel& rod = model.rods[number];
  if (!(push > 0.0) || !is_thread(rod)) return;
  const double limit = 1e-3 * buckling_load(rod.rod);
  if (push < limit) return;
  warnings.add({.code = "thread_pushes",
                .where = where,
                .message = "rods." + rod.name + " is as thin as a thread and pushes with " + three_digits(push) +
                           " N; a real one would go slack",
                .remedy = "pull it, by force instead of displacement if need be",
                .value = push,
                .limit = limit,
                .unit = "N"});
}

void assess_cables(const Model& model, const State& state, Warnings& warnings) {
  // A push by rounding is none: beside the largest force of a motor or cable, and what a soft body bears at all.
  double largest = 0.0;
  for (const double force : state.actuators) largest = std::max(largest, std::abs(force));
  for (const GeometricCableModel& cable : model.cables)
    largest = std::max(largest, std::abs(state.lambda[cable.length_row]));
  const double rounding = std::max(1e-9 * largest, std::min(1e-9 * model.bearing, 1e-6));
  for (std::size_t i = 0; i < model.actuators.size(); ++i) {
    const ActuatorModel& own = model.actuators[i];
    const double force = state.actuators[i];
    if (own.tendon && force < -rounding) {
      warnings.add({.code = "tendon_pushes",
                    .where = "actuators." + own.name,
                    .message = "the tendon pushes with " + three_digits(-force) + " N; a real one would go slack",
                    .remedy = "drive it by `tension`, or draw in more of it",
                    .value = -force,
                    .limit = rounding,
                    .unit = "N"});
    }
    if (own.tendon || own.turns() || own.line.rod < 0 || own.told_force() || own.axis != 0) continue;
    // What is pushed in, or told to push, is meant to.
    const double inwards = model.scene.actuators[i].second.axis ? 1.0 : -1.0;
    if (inwards * motor_position(model, state, own) > 1e-9 * model.size) continue;
    warn_of_thread(model, own.line.rod, "actuators." + own.name, inwards * force, warnings);
  }
  for (int i = 0; i < static_cast<int>(model.rods.size()); ++i) {
    const RodModel& rod = model.rods[i];
    const bool carried = rod.frame >= 0 && model.scene.frames[rod.frame].second.motion.has_value();
    if (rod.rod.base_coordinates() > 0 || carried || !is_thread(rod)) continue;
    warn_of_thread(model, i, "rods." + rod.name, -internal_wrench(model, state, i, 0.0)[3], warnings);
  }
  for (const GeometricCableModel& cable : model.cables) {
    const double tension = state.lambda[cable.length_row];
    if (!(tension < -rounding)) continue;
    warnings.add(
        {.code = "cable_pushes",
         .where = "rods." + cable.name,
         .message = "the geometric cable pushes with " + three_digits(-tension) + " N; a real one would go slack",
         .remedy = "pull it, by force instead of displacement if need be",
         .value = -tension,
         .limit = rounding,
         .unit = "N"});
  }
}

void assess_couplings(const Model& model, const State& state, Warnings& warnings) {
  for (std::size_t i = 0; i < model.couplings.size(); ++i) {
    bool any = false, on = false;
    for (std::size_t k = 0; k < model.points.size(); ++k) {
      if (model.points[k].coupling != static_cast<int>(i)) continue;
      any = true;
      on |= state.points[k].on;
    }
    if (any && !on) {
      warnings.add({.code = "rod_left_body",
                    .where = "couplings." + std::to_string(i),
                    .message = "the rod has left the body, none of its points is on it any more",
                    .remedy = "draw it out less, or anchor its tip"});
    }
  }
}

void assess_contacts(const Model& model, bool fixed, const StepReport& step, Warnings& warnings) {
  const ContactReport& contact = step.contact;
  const double limit = (fixed ? 1e-4 : 1e-6) * model.size;
  const auto bends = [&model](int pair) {
    return model.pairs[pair].a.kind == Collider::Kind::rod || model.pairs[pair].b.kind == Collider::Kind::rod;
  };
  const auto* finer_mesh =
      "an edge lies between nodes of the mesh that it bends: give this smaller triangles there, or take a round edge";
  const auto shorter_steps = [&](int pair) {
    return std::string("take shorter steps") + (bends(pair) ? ", give the rod more sections" : "") +
           (fixed ? ", or leave `newton` out" : "");
  };
  if (contact.deepest_pair >= 0 && contact.penetration > limit) {
    warnings.add({.code = "penetration",
                  .where = "contact",
                  .message = name_of_pair(model, contact.deepest_pair) + " overlap by " +
                             three_digits(1e3 * contact.penetration) + " mm",
                  .remedy = contact.between_nodes ? std::string(finer_mesh) : shorter_steps(contact.deepest_pair),
                  .value = contact.penetration,
                  .limit = limit,
                  .unit = "m"});
  }
  const double left = std::max({contact.left.complementarity, contact.left.cone, contact.left.dissipation});
  if (fixed && contact.unsolved > 0 && left > kMissedLaws) {
    warnings.add({.code = "contact_unsolved",
                  .where = "contact",
                  .message = "forces of contacts miss Signorini's and Coulomb's laws by " + three_digits(left) +
                             " of the largest",
                  .remedy = "take shorter steps, or leave `newton` out",
                  .value = left,
                  .limit = kMissedLaws});
  }
}

void assess_held(const StepContext& context, const ContactRoom& room, const State& next, Warnings& warnings) {
  const Model& model = context.model;
  const double limit = 1e-6 * model.size;
  const HeldInside found = held_inside(context, room, next);
  if (!(found.depth > limit)) return;
  warnings.add({.code = "held_in_obstacle",
                .where = "contact",
                .message = name_of_pair(model, found.pair) + ": nodes that are held lie up to " +
                           three_digits(1e3 * found.depth) + " mm in the obstacle, and no contact stops them",
                .remedy = "move what holds them less far, or hold fewer nodes",
                .value = found.depth,
                .limit = limit,
                .unit = "m"});
}

/// "take shorter steps, or leave `newton: 1` out".
std::string remedy_of_linearisation(const Model& model) {
  return "take shorter steps, or leave `newton: " + std::to_string(model.scene.newton.iterations) + "` out";
}

void assess_linearisation(const Model& model, const StepReport& step, Warnings& warnings) {
  if (step.residual > kLinearisedResidual) {
    warnings.add(
        {.code = "linearisation_off",
         .where = "newton",
         .message = "the step leaves " + three_digits(100.0 * step.residual) + " % of the largest force unbalanced",
         .remedy = remedy_of_linearisation(model),
         .value = step.residual,
         .limit = kLinearisedResidual});
  }
  if (step.violation > kLinearisedViolation * model.size) {
    warnings.add({.code = "constraints_off",
                  .where = "newton",
                  .message = "constraints are missed by " + three_digits(1e3 * step.violation) + " mm",
                  .remedy = remedy_of_linearisation(model),
                  .value = step.violation,
                  .limit = kLinearisedViolation * model.size,
                  .unit = "m"});
  }
}

void assess_redundancy(const Model& model, const Linearization& here, Warnings& warnings) {
  for (const RedundantRows& own : here.reduced().redundant) {
    // Those of the start are told by the model, whatever posture adds to them.
    std::vector<int> dependent;
    for (std::size_t i = 0; i < own.rows.size(); ++i) {
      const auto at = static_cast<Eigen::Index>(i);
      if (own.weight[at] > 0.0 && own.null.leftCols(own.exact).row(at).norm() > 1e-6) dependent.push_back(own.rows[i]);
    }
    const bool known = std::any_of(model.redundant.begin(), model.redundant.end(), [&](const RedundantGroup& group) {
      return std::includes(group.rows.begin(), group.rows.end(), dependent.begin(), dependent.end());
    });
    if (known) continue;
    warnings.add({.code = "redundant_constraints",
                  .where = name_of_rows(model, own.rows),
                  .message = "constraint rows have come to depend on each other in this posture; of the forces that do "
                             "the same, the smallest are taken",
                  .remedy = remedy_of_rows(model, own.rows),
                  .value = static_cast<double>(own.exact)});
  }
}

/// How far rows give way that nothing answered at the start and something does here.
void assess_give(const Model& model, const Reduced& reduced, Warnings& warnings) {
  constexpr double kGive = 1e-4;  // of the scene's size
  for (const RedundantRows& own : reduced.redundant) {
    if (own.give.size() == 0) continue;
    double most = 0.0;
    for (const int row : own.rows) most = std::max(most, std::abs(reduced.given[row]) * arm_of(model, row));
    if (!(most > kGive * model.size)) continue;
    warnings.add({.code = "constraints_give_way",
                  .where = name_of_rows(model, own.rows),
                  .message = "constraints that no strain could answer at the start ask for some in this posture; "
                             "instead they give way by " +
                             three_digits(1e3 * most) + " mm, about as much as real rods would",
                  .remedy = remedy_of_rows(model, own.rows),
                  .value = most,
                  .limit = kGive * model.size,
                  .unit = "m"});
  }
}

/// Bases of rods and bodies that an equilibrium leaves free: they stand where they came by chance. (Those that contacts
/// press on may be held by these.)
void assess_free(const Model& model, const Linearization& here, const State& state, Warnings& warnings) {
  if (here.unresisted().empty()) return;
  for (const Unresisted& free : unresisted_motions(model, here.unresisted())) {
    if (is_pressed(state, free.object)) continue;
    const bool is_rod = free.object.kind == Collider::Kind::rod;
    warnings.add({.code = "free_motion",
                  .where = free.where,
                  .message = std::string("nothing resists a motion of ") + (is_rod ? "its base (" : "it (") +
                             free.motions + "): where it rests is chance",
                  .remedy = is_rod ? "leave that out of its `base`, or hold it by a tie that has this axis"
                                   : "hold it by a tie that has this axis"});
  }
}

}  // namespace

void assess(const StepContext& context, const Linearization& here, const State& next, StepReport& report) {
  const Model& model = context.model;
  const bool fixed = report.status == Status::linearized;
  Warnings warnings(next.time, report.warnings);
  assess_cables(model, next, warnings);
  assess_couplings(model, next, warnings);
  assess_contacts(model, fixed, report, warnings);
  assess_held(context, here.contacts(), next, warnings);
  if (fixed) assess_linearisation(model, report, warnings);
  assess_redundancy(model, here, warnings);
  assess_give(model, here.reduced(), warnings);
  for (Warning& own : assess_sliding_rods(model, next)) warnings.add(std::move(own));
  for (Warning& own : assess_touched_rods(model, next)) warnings.add(std::move(own));
  // (Where a path of equilibria begins, nothing acts yet.)
  const bool begins = model.scene.analysis == Analysis::statics && next.time == 0.0;
  if (report.stability_known && !begins) assess_free(model, here, next, warnings);
  if (report.unstable) {
    warnings.add({.code = "unstable",
                  .where = "",
                  .message = "the equilibrium is unstable, a real body would have buckled",
                  .remedy = "a small side load shows where it goes; shorter steps do not if the shape is perfect"});
  }
  if (model.scene.analysis == Analysis::modal) return;  // (what a mode's picture does is no state)
  for (Warning& own : assess_coarse_rods(model, next)) warnings.add(std::move(own));
  for (Warning& own : assess_strained_rods(model, next)) warnings.add(std::move(own));
  if (const int folded = count_folded(model, next); folded > 0) {
    warnings.add(
        {.code = "elements_inverted",
         .where = "solids",
         .message = describe_folded(model, next) + ": this is no state of a real body",
         .remedy =
             "look at least_volume_ratio in ParaView; load it less or slower, or give a finer mesh or another law",
         .value = static_cast<double>(folded),
         .limit = 0.0});
  }
}

bool leaves_much(const Model& model, const StepReport& step) {
  return step.residual > kLinearisedResidual || step.violation > kLinearisedViolation * model.size;
}

void warn_of_linearisation(const Model& model, double time, StepReport& report) {
  if (!(report.off > kLinearisedOff) || std::isinf(report.off)) return;  // (that it left much stands there already)
  Warnings(time, report.warnings)
      .add({.code = "linearised_step_off",
            .where = "newton",
            .message = "the last linearised step beyond a limit is " + three_digits(100.0 * report.off) +
                       " % off: so far beside it, as a part of the way from the start, ends a converged one",
            .remedy = remedy_of_linearisation(model),
            .value = report.off,
            .limit = kLinearisedOff,
            .latest = true});
}

std::string beyond_bearing(const Model& model, const State& state) {
  const double limit = kBeyondBearing * model.bearing;
  for (const ContactState& contact : state.contacts) {
    if (contact.force.norm() > limit) {
      return name_of_pair(model, contact.pair) + " press with " + three_digits(contact.force.norm()) +
             " N, more than anything here could bear: no strain and no motion answers";
    }
  }
  if (state.lambda.size() == 0 || !(state.lambda.cwiseAbs().maxCoeff() > limit)) return {};
  std::vector<int> rows;
  for (Eigen::Index row = 0; row < state.lambda.size(); ++row) {
    if (std::abs(state.lambda[row]) > limit) rows.push_back(static_cast<int>(row));
  }
  return name_of_rows(model, rows) + ": forces of " + three_digits(state.lambda.cwiseAbs().maxCoeff()) +
         " N, more than anything here could bear; " + remedy_of_rows(model, rows);
}

namespace {

/// Energies of rods and rigid bodies, which contacts move at once.
struct Loose {
  double kinetic = 0.0, elastic = 0.0, weight = 0.0;
  double total() const { return kinetic + elastic + weight; }
};
Loose loose_energy(const Model& model, const State& state) {
  Loose own;
  const Vec3& g = model.scene.gravity;
  for (std::size_t i = 0; i < model.bodies.size(); ++i) {
    own.kinetic += rigid::kinetic_energy(model.bodies[i].body, state.bodies[i]);
    own.weight -= model.bodies[i].body.mass * g.dot(state.bodies[i].p);
  }
  for (std::size_t i = 0; i < model.rods.size(); ++i) {
    const rod::Rod& rod = model.rods[i].rod;
    own.elastic += elastic_energy(rod, state.rods[i]);
    own.kinetic += kinetic_energy(rod, state.rods[i]);
    for (std::size_t m = 0; m < rod.masses.size(); ++m)
      own.weight -= rod.masses[m].mass * g.dot(state.rods[i].masses.col(static_cast<Eigen::Index>(m)));
  }
  return own;
}

}  // namespace

bool lifts_apart(const Model& model, const State& iterate, const ContactRoom& room) {
  for (std::size_t i = 0; i < iterate.contacts.size(); ++i)
    if (overlaps_since_the_start(model, iterate.contacts[i], room.gaps[i])) return true;
  return false;
}

std::string contact_adds_energy(const StepContext& context, const State& next) {
  constexpr double kGain = 1e-3;
  constexpr double kAtRest = 1e-6;  // of weight times size: what all but rests has next to no energy to gain from
  const Model& model = context.model;
  if (context.rate == 0.0 || next.contacts.empty()) return {};
  // Most steps are done with here: what is loose has no more energy than falling, or all that works on it, gives.
  const Loose before = loose_energy(model, context.start), after = loose_energy(model, next);
  const double done = next.energies.work_bound - context.start.energies.work_bound;
  const double faster = after.kinetic - before.kinetic - std::max(0.0, before.weight - after.weight);
  const double more = std::max(faster, after.total() - before.total() - std::max(0.0, done));
  if (more <= kGain * std::max(before.kinetic + before.elastic, after.kinetic + after.elastic)) return {};
  const EnergyBalance from = energy_balance(model, context.start), to = energy_balance(model, next);
  const double gain = to.total() - from.total() - done;
  const double size = std::max(from.kinetic + from.elastic, to.kinetic + to.elastic);
  const double weight = inertia_of(context) / context.rate / context.rate * context.gravity.norm();
  if (!(gain > std::max(kGain * size, kAtRest * weight * model.size)) || !(size > 1e-14 * model.bearing * model.size))
    return {};
  return "contacts have added " + three_digits(gain) + " J, " + three_digits(gain / size) +
         " of the kinetic and elastic energy; the hardest is that of " + hardest_contact(model, next);
}

std::string known_contradiction(const Model& model) {
  const Warning* told = find_warning(model.warnings, "contradicting_commands");
  return told ? told->where + ": " + told->message : "";
}

std::string describe_contradiction(const Model& model, const RedundantRows& rows, const Eigen::VectorXd& c) {
  const std::vector<int> which = rows.contradicting(c);
  const std::string names = name_of_rows(model, which);
  const bool several = names.find(", ") != std::string::npos;
  return (several ? names : "the rows of " + names) + " contradict each other by " +
         three_digits(1e3 * rows.contradiction(c)) + " mm; " + remedy_of_rows(model, which);
}

}  // namespace sinew
