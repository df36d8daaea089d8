#include "sinew/sim/newton.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "sinew/error/digits.hpp"
#include "sinew/sim/assessment.hpp"
#include "sinew/sim/first_guess.hpp"
#include "sinew/sim/rolling.hpp"
#include "sinew/sim/step_ends.hpp"
#include "sinew/sim/unbalanced.hpp"
#include "sinew/threads/interruption.hpp"

namespace sinew {

namespace {

/// a <- (a - b) factor.
void scale_difference(Increment& a, const Increment& b, double factor) {
  for (std::size_t i = 0; i < a.dx.size(); ++i) a.dx[i] = (a.dx[i] - b.dx[i]) * factor;
  a.reduced.dz = (a.reduced.dz - b.reduced.dz) * factor;
  a.reduced.dlambda = (a.reduced.dlambda - b.reduced.dlambda) * factor;
  for (std::size_t i = 0; i < a.reduced.dq.size(); ++i) a.reduced.dq[i] = (a.reduced.dq[i] - b.reduced.dq[i]) * factor;
}

/// What an accepted iterate must be, beyond balanced.
void judge(const StepContext& context, bool fixed, const State& state, StepReport& report) {
  if (!finite(state)) {
    report.status = Status::diverged;
    report.detail = "the new state is not finite";
  } else if (!fixed && turned_over(context, state)) {
    report.status = Status::max_iterations;
    report.detail = "a tie turned over";
  } else if (const RodModel* spun = fixed ? nullptr : spun_round(context, state)) {
    report.status = Status::max_iterations;
    report.detail = "rods." + spun->name + " turned by more than a right angle in a step";
  } else if (const RodModel* rod = exhausted(context.model, state)) {
    report.status = Status::rod_exhausted;
    report.detail = "rods." + rod->name;
  } else if (std::string beyond = beyond_bearing(context.model, state); !beyond.empty()) {
    report.status = Status::inconsistent;
    report.detail = std::move(beyond);
  } else {
    report.status = fixed ? Status::linearized : Status::converged;
    report.detail.clear();
  }
}

}  // namespace

void LineSearch::take(const State& from, const Increment& increment, double fraction, const Linearization& there) {
  taken_ = true;
  from_ = from;
  increment_ = increment;
  fraction_ = fraction;
  force_ = there.largest();
  judged_ = there.violation();
  halvings_ = 0;
}

bool LineSearch::too_far(const StepContext& context, const Linearization& here) const {
  constexpr int kMostHalvings = 4, kMostRescues = 12;
  if (taken_ && !here.finite()) return halvings_ < kMostRescues;
  return context.rate == 0.0 && taken_ && judged_ <= 1e-6 * context.model.size && halvings_ < kMostHalvings &&
         !(here.largest() <= force_) && here.largest() > 1e-6 * here.scale();
}

double LineSearch::shorten(const StepContext& context, State& iterate) {
  iterate = from_;
  fraction_ *= 0.5;
  ++halvings_;
  advance_by(context, increment_, fraction_, iterate);
  return fraction_;
}

void ComingAndGoing::look(const std::vector<ContactState>& contacts) {
  const bool first = pressed_.size() != contacts.size();
  if (first) {
    pressed_.assign(contacts.size(), 0);
    turns_.assign(contacts.size(), 0);
  }
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    const char now = contacts[i].force.isZero(0.0) ? 0 : 1;
    if (!first && now != pressed_[i]) ++turns_[i];
    pressed_[i] = now;
  }
}

Eigen::VectorXd measured(const Model& model, const Increment& increment) {
  Eigen::Index size = increment.reduced.dz.size();
  for (const auto& dx : increment.dx) size += dx.size();
  for (const auto& dq : increment.reduced.dq) size += dq.size();
  Eigen::VectorXd u(size);
  Eigen::Index at = 0;
  for (const auto& dx : increment.dx) {
    u.segment(at, dx.size()) = dx.reshaped() / (model.size * std::sqrt(static_cast<double>(dx.cols())));
    at += dx.size();
  }
  for (std::size_t n = 0; n < model.rods.size(); ++n) {
    const rod::Rod& rod = model.rods[n].rod;
    for (int i = 0; i < rod.count(); ++i) {
      // A section's turn counts by its share of the rod, so that the measure does not depend on their number.
      const double weight = std::sqrt(rod.sections[i].length() * rod.length());
      for (int c = rod.first[i]; c < rod.first[i + 1]; ++c) u[at + c] = weight * increment.reduced.dq[n][c];
    }
    at += rod.strain_coordinates();
  }
  u.tail(increment.reduced.dz.size()) = increment.reduced.dz / model.size;
  for (const RodModel& rod : model.rods) {
    for (int i = 0; i < rod.rod.base_coordinates(); ++i) {
      if (rod.rod.base[i].turns) u[at + rod.unknown + i] *= model.size;
    }
  }
  return u;
}

// By a difference in t, exact where all loads are linear in it.
void change_along(const ContextAt& at, Memory& memory, const Iterate& iterate, StageTimes& times) {
  const double e = 1e-6;
  at(iterate.t + e, memory.ahead);
  State carried = iterate.state;
  place_held(memory.ahead, carried);
  memory.there.evaluate(memory.ahead, carried, times);
  memory.here.solve(memory.there, memory.change);
  if (!memory.increment.reduced.ok) memory.change.reduced.ok = false;
  if (!memory.change.reduced.ok) return;
  scale_difference(memory.change, memory.increment, 1.0 / e);
  Eigen::VectorXd& dlambda = memory.change.reduced.dlambda;
  for (const RedundantRows& own : memory.here.reduced().redundant)
    own.make_smallest(Eigen::VectorXd::Zero(dlambda.size()), dlambda);
}

StepReport newton(const ContextAt& at, Memory& memory, const NewtonRules& rules, Iterate& iterate) {
  const bool descent = rules.wanted == Linearization::Wanted::descent && !rules.fixed;
  StepReport report;
  StepContext& context = memory.context;
  Linearization& here = memory.here;
  Increment& increment = memory.increment;
  double stiffness = 0.0;
  const double met = context.model.scene.newton.tolerance * context.model.size;  // [m] rows with less are met
  // Where more than `left` [m] of the rows is what no motion can answer, that is the reason.
  const auto contradicts = [&](double left) {
    const RedundantRows* const rows = here.contradicting(left);
    if (!rows) return false;
    report.status = Status::inconsistent;
    report.detail = describe_contradiction(context.model, *rows, here.reduced().as_told());
    return true;
  };
  const auto fail = [&](Status status, std::string detail) {
    report.contact = here.contact_report();
    report.status = status;
    report.detail = std::move(detail);
    if (contradicts(std::max(0.5 * report.violation, 10.0 * met))) return report;
    // Rows that once depended on each other may do so no longer by a hair: no force is large enough then.
    if (const std::string known = known_contradiction(context.model); !known.empty())
      report.detail = known + (report.detail.empty() ? "" : "; ") + report.detail;
    return report;
  };
  const auto nothing_holds = [&] {
    const bool by_contact = context.rate == 0.0 && !here.contacts().playing.empty();
    return fail(Status::singular, std::string("constraint rows and rods") +
                                      (by_contact ? "; what nothing but contact holds at rest is found with `analysis: "
                                                    "dynamic` and damping"
                                                  : ""));
  };
  const auto complete = [&] {
    finish(context, iterate.state, here);
    const bool evaluated = !rules.fixed || rules.evaluation == Evaluation::full;
    memory.passage = look_again(context, iterate.state, here.contacts(), evaluated, memory.alarm);
    report.contact = here.contact_report();
    if (memory.passage.overlap > report.contact.penetration) {
      report.contact.penetration = memory.passage.overlap;
      report.contact.deepest_pair = memory.passage.overlapping;
      report.contact.between_nodes = memory.passage.between_nodes;
    }
    const bool lifts = lifts_apart(context.model, iterate.state, here.contacts());
    const std::vector<Warning> rolling =
        evaluated ? assess_rolling(context, iterate.state, here.contacts()) : std::vector<Warning>();
    finish_contacts(context, here.contacts(), iterate.state);
    judge(context, rules.fixed, iterate.state, report);
    if (rules.fixed) contradicts(std::max(0.5 * report.violation, 1e-4 * context.model.size));
    if (!context.model.pairs.empty() && !lifts && !rules.settles && accepted(report.status)) {
      if (std::string gained = contact_adds_energy(context, iterate.state); !gained.empty()) {
        report.status = Status::max_iterations;
        report.detail = std::move(gained);
      }
    }
    if (memory.passage.kind != Passage::Kind::none && accepted(report.status)) {
      const std::string depth = three_digits(1e3 * memory.passage.depth) + " mm";
      report.status = Status::passed_through;
      report.detail = name_of_pair(context.model, memory.passage.pair);
      if (memory.passage.kind == Passage::Kind::folded) {
        report.detail += ": " + depth + " of the rod lies in it between two points; give the rod more sections";
      } else if (memory.passage.kind == Passage::Kind::cut) {
        report.detail += ": an edge lies " + depth +
                         " deep between the nodes of a surface; give the mesh smaller triangles there, or a round edge";
      } else if (memory.passage.kind == Passage::Kind::left_behind) {
        report.detail += " press on each other " + depth + " apart";
      } else {
        report.detail += " by " + depth + " on the way";
      }
    }
    report.redundant |= !here.reduced().redundant.empty();
    if (accepted(report.status) && rules.evaluation == Evaluation::full) {
      assess(context, here, iterate.state, report);
      report.warnings.insert(report.warnings.end(), rolling.begin(), rolling.end());
      report.judged = true;
    }
    return report;
  };
  memory.search.begin();
  memory.contacts.begin();
  here.forget();
  memory.passage = {};
  double contradiction = 0.0, left_off = INFINITY, least_off = INFINITY;
  bool again = false;  // an iteration is made once more
  int steady = 0;      // iterations that have made what is off smaller, one after the other
  int idle = 0;        // iterations since what is off was made smaller than it had ever been
  constexpr double kContracts = 0.8, kHelps = 0.9;
  constexpr int kIdle = 8, kStuck = 2;
  constexpr double kCorrected = 1e-4;  // contacts are corrected to this at least, and as Newton contracts
  constexpr int kSteady = 4, kPatience = 3, kTrial = 2;
  for (;; ++report.newton) {
    threads::Interruption::check();
    if (report.newton == 0 || rules.across) {
      at(iterate.t, context);
      place_held(context, iterate.state);
      stiffness = std::max(stiffness, inertia_of(context));
    }
    if (rules.fixed && report.newton == rules.limit && rules.evaluation == Evaluation::motion) return complete();
    // (A linearised step is that of the exact tangent there, and has no second round to make up for what is left out.)
    context.at_start = report.newton == 0 && context.rate > 0.0 && !rules.fixed;
    // The paper's step is not looked at before it is made.
    const bool blind = rules.fixed && report.newton < rules.limit;
    here.evaluate(context, iterate.state, report.times, blind ? std::optional(solid::Tangent::definite) : std::nullopt);
    while (memory.search.too_far(context, here)) {
      const double back = memory.search.shorten(context, iterate.state);
      if (rules.inverse) rules.inverse->take(-back, context.model, context.command);
      here.evaluate(context, iterate.state, report.times);
    }
    if (!rules.fixed) memory.contacts.look(iterate.state.contacts);
    report.residual = here.scale() > 0.0 ? here.largest() / here.scale() : 0.0;
    memory.residuals = {memory.residuals[1], memory.residuals[2], report.residual};
    report.violation = here.violation();
    if (!here.finite() || !std::isfinite(iterate.t)) {
      const std::string where = broken_cell(context.model, iterate.state);
      return where.empty() ? fail(Status::diverged, "forces are not finite") : fail(Status::inverted, where);
    }
    const Convergence converged = convergence_of(context.model, here, stiffness);
    const double contact_error = rules.fixed ? 0.0 : here.contact_error();
    if (rules.fixed ? report.newton == rules.limit : report.newton > 0 && converged.met && contact_error <= met) {
      if (!rules.fixed && contradicts(10.0 * met)) {
        report.contact = here.contact_report();
        return report;
      }
      report.at_floor = !rules.fixed && converged.at_floor;
      if (context.rate == 0.0 && !rules.fixed) {
        // (The last factors are those of the iterate before, where soft motions may not have been at rest yet.)
        std::string unknown;
        report.stability_known =
            here.factor(solid::Tangent::exact, Linearization::Wanted::any, unknown) && here.stability_known();
        report.unstable = report.stability_known && here.unstable();
        // What is stable without contacts is so with them; of the rest they may hold what would buckle.
        if (report.unstable && !iterate.state.contacts.empty()) {
          const std::optional<bool> held = here.unstable_between_contacts();
          report.stability_known = held.has_value();
          report.unstable = held.value_or(false);
        }
      }
      write_forces(here, iterate.state);
      return complete();
    }
    // With contacts, whose parts come and go, an iteration that contracts steadily is let go on beyond its limit: to
    // begin again with half the step costs more.
    const double size = context.model.size,
                 off = std::max({report.residual, report.violation / size, contact_error / size});
    const bool contracts = off < kContracts * left_off || again;
    if (!again) steady = contracts ? steady + 1 : 0;
    again = false;
    left_off = off;
    idle = off < kHelps * least_off ? 0 : idle + 1;
    if (idle == 0) least_off = off;
    if (rules.on_trial && report.newton >= kTrial && !contracts)
      return fail(Status::max_iterations, "the guess that velocities have moved on leads nowhere");
    if (rules.inverse && context.rate > 0.0 && !rules.fixed && idle >= kIdle)
      return fail(Status::max_iterations, "commands and motion together lead nowhere");
    const int limit = steady >= kSteady && !context.model.pairs.empty() ? kPatience * rules.limit : rules.limit;
    if (!rules.fixed && report.newton >= limit)
      return fail(Status::max_iterations,
                  most_unbalanced(context, here, iterate.state, converged.allowed, memory.contacts.turns()));
    if (!here.reduced().redundant.empty() && report.newton > 1) {  // forces are balanced, and rows do not get nearer
      const bool balanced_forces = here.largest() <= 1e-6 * here.scale();
      const bool stays = contradiction > 0.0 && report.violation > 0.999 * contradiction;
      if (balanced_forces && stays && contradicts(std::max(0.9 * report.violation, met))) {
        report.contact = here.contact_report();
        return report;
      }
      contradiction = report.violation;
    }
    std::string failed;
    const char* const single =
        context.model.scene.newton.precision == linalg::Precision::float32 ? ", in `newton: {precision: single}`" : "";
    if (!here.factor(rules.fixed ? solid::Tangent::definite : solid::Tangent::exact, rules.wanted, failed))
      return fail(Status::singular, failed + single);
    report.rotated |= here.rotated();
    stiffness = std::max(stiffness, here.stiffness());
    if (rules.inverse) {
      const auto steer = [&](Increment& step) { rules.inverse->steer(context, iterate.state, here, step); };
      here.solve(increment, std::cref(steer), rules.inverse->part());  // (a copy would ask for memory)
      if (!rules.fixed && rules.inverse->cut_short())
        return fail(Status::max_iterations, "commands together with " + std::to_string(here.contacts().playing.size()) +
                                                " contacts are too much work");
    } else {
      here.solve(increment);
    }
    if (!increment.reduced.ok && !descent && !rules.fixed) {
      here.stiffen();
      here.solve(increment);
    }
    if (contacts_cost_too_much(here.contact_report()))
      return fail(Status::max_iterations, too_many_contacts(context.model, iterate.state));
    if (std::string contact = here.unanswered_contact(); !contact.empty())
      return fail(Status::inconsistent, std::move(contact));
    if ((!increment.reduced.ok || increment.reduced.redundant) && here.find_redundant()) {
      --report.newton;  // the same iteration once more, with the compliance of these rows
      again = true;
      continue;
    }
    report.redundant |= increment.reduced.redundant;
    if (here.stalled()) return fail(Status::singular, std::string("solids") + single);
    if (!increment.reduced.ok) return nothing_holds();
    // (The corrected step may end where it began, a minimum of what is off that is not 0; Newton's leaves it.)
    const bool corrects = idle < kStuck || idle % 2 == 1;
    if (corrects && !rules.fixed && !rules.inverse && !rules.across && !context.model.pairs.empty() &&
        trusted_fraction(context, increment) == 1.0)
      here.correct_contacts(std::max(0.25 * context.model.scene.newton.tolerance, std::min(kCorrected, off * off)),
                            increment);
    // (Of both before anything is made smallest: a difference of multipliers that nothing answers means nothing.)
    if (rules.across) change_along(at, memory, iterate, report.times);
    for (const RedundantRows& own : here.reduced().redundant)
      own.make_smallest(iterate.state.lambda, increment.reduced.dlambda);
    if (rules.across) {
      const Increment& change = memory.change;
      if (!change.reduced.ok) return nothing_holds();
      const Eigen::VectorXd& n = rules.across->direction;
      const Model& model = context.model;
      const double dt = -n.dot(measured(model, increment)) / (n.dot(measured(model, change)) + rules.across->rate);
      if (!std::isfinite(dt)) return fail(Status::singular, "the path has no direction");
      advance_by(context, change, dt, iterate.state);
      advance_by(context, increment, 1.0, iterate.state);
      iterate.t += dt;
      continue;
    }
    double fraction = 1.0;
    if (!rules.fixed) {
      fraction = trusted_fraction(context, increment);
    } else if (std::string lost = beyond_trust(context, increment); !lost.empty()) {
      return fail(Status::diverged, std::move(lost));
    }
    if (descent) memory.search.take(iterate.state, increment, fraction, here);
    advance_by(context, increment, fraction, iterate.state);
    if (rules.inverse) rules.inverse->take(fraction, context.model, context.command);
  }
}

}  // namespace sinew
