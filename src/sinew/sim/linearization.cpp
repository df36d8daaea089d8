#include "sinew/sim/linearization.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <utility>

#include "sinew/error/digits.hpp"
#include "sinew/linalg/finite.hpp"
#include "sinew/sim/clock.hpp"
#include "sinew/sim/contact_passage.hpp"
#include "sinew/sim/rod_rows.hpp"

namespace sinew {

namespace {

/// [m] by how much rows that agree in this posture may have been told to contradict each other at the start, as a
/// replay tells them. Rods in solids bend in many ways at once: of these it is not known.
double slack_of_posture(const Model& model, const RedundantRows& redundant) {
  const bool in_solid = std::any_of(model.points.begin(), model.points.end(), [&](const PointModel& point) {
    return std::binary_search(redundant.rows.begin(), redundant.rows.end(), point.row);
  });
  return in_solid ? 0.0 : redundant.slack_of_strains.maxCoeff();
}

/// The compliance of rows that depend on each other, of the model's groups and others.
void add_redundant(const StepContext& context, const State& iterate, const std::vector<std::vector<int>>& more,
                   Reduced& reduced) {
  const Model& model = context.model;
  reduced.redundant.clear();
  reduced.given.resize(0);
  const auto add = [&reduced](RedundantRows own) {
    if (own.null.cols() > 0) reduced.redundant.push_back(std::move(own));
  };
  for (const RedundantGroup& group : model.redundant) {
    RedundantRows own = redundant_rows(model, iterate, reduced.problem, group);
    // What is told to contradict is no matter of posture, and nothing gives way.
    if (own.give.size() > 0 && contradiction_of(model, group, context.command.actuators) >
                                   kContradiction * model.size + slack_of_posture(model, own))
      own = redundant_rows(model, iterate, reduced.problem, group.rows);
    add(std::move(own));
  }
  for (const std::vector<int>& rows : more) add(redundant_rows(model, iterate, reduced.problem, rows));
  if (reduced.redundant.empty()) return;
  Eigen::VectorXd given = Eigen::VectorXd::Zero(model.rows);
  bool gives = false;
  for (const RedundantRows& own : reduced.redundant) {
    add_compliance(own, model.size / model.bearing, iterate.lambda, reduced.problem, given);
    gives |= own.give.size() > 0;
  }
  if (!gives) return;
  reduced.problem.c += given;
  reduced.given = std::move(given);
  reduced.violation = 0.0;
  for (int row = 0; row < model.rows; ++row)
    reduced.violation = std::max(reduced.violation, std::abs(reduced.problem.c[row]) * arm_of(model, row));
}

}  // namespace

template <class OfSolid, class OfRods>
void Linearization::beside(const OfSolid& of_solid, const OfRods& of_rods) {
  const std::size_t solids = context_->model.solids.size();
  spent_.assign(solids + 1, {});
  crew_.each(static_cast<int>(solids) + 1, [&](int i) {
    const auto number = static_cast<std::size_t>(i);
    if (number < solids) {
      of_solid(number, spent_[number]);
    } else {
      of_rods(spent_[number]);
    }
  });
  for (const StageTimes& own : spent_) *times_ += own;
}

void Linearization::evaluate(const StepContext& context, const State& iterate, StageTimes& times,
                             std::optional<solid::Tangent> then) {
  context_ = &context;
  iterate_ = &iterate;
  times_ = &times;
  rotated_ = coupled_ = stalled_ = false;
  ahead_ = then;
  const std::size_t solids = context.model.solids.size();
  forces_.resize(solids);
  free_.resize(solids);
  factored_.assign(solids, Factored::failed);
  exact_.assign(solids, false);
  reduced_.problem.volumes.resize(solids);
  if (!context.model.pairs.empty()) {
    const Clock clock(times.contact);
    evaluate_contacts(context, iterate, contacts_);
    if (then == solid::Tangent::exact) add_contact_curvature(context, iterate, contacts_);
  }
  contacts_ready_ = false;
  beside(
      [&](std::size_t i, StageTimes& own) {
        {
          const Clock clock(own.forces);
          solid_forces(context, iterate, contacts_.touches, static_cast<int>(i), forces_[i]);
        }
        if (then) factor_solid(i, *then, own);
      },
      [&](StageTimes& own) {
        Clock clock(own.rods);
        linearize(context, iterate, contacts_.touches, reduced_);
        add_redundant(context, iterate, redundant_, reduced_);
        if (!then) return;
        clock.next(own.solve);
        factor_.eliminate_chains(reduced_.problem);
      });
  largest_ = reduced_.largest;
  scale_ = reduced_.scale;
  for (const SolidForces& own : forces_) {
    largest_ = std::max(largest_, own.largest);
    scale_ = std::max(scale_, own.scale);
  }
  set_references(context, scale_, reduced_);
}

rod::Configuration& Linearization::shape(int rod) {
  const auto number = static_cast<std::size_t>(rod);
  if (reduced_.rods.size() <= number) reduced_.rods.resize(number + 1);
  return reduced_.rods[number].shape;
}

ContactReport Linearization::contact_report() const {
  ContactReport report = contact_forces_.report();
  report.contacts = static_cast<int>(contacts_.playing.size() + context_->model.rubbing.size());
  for (std::size_t i = 0; i < std::min(contacts_.touches.size(), iterate_->contacts.size()); ++i) {
    if (const double own = overlap_of(context_->model, *iterate_, contacts_, i); own > report.penetration) {
      report.penetration = own;
      report.deepest_pair = iterate_->contacts[i].pair;
    }
  }
  return report;
}

bool Linearization::finite() const {
  const solve::CoupledProblem& problem = reduced_.problem;
  return std::isfinite(largest_) && std::isfinite(reduced_.violation) && linalg::finite(problem.r) &&
         linalg::finite(problem.c) &&
         std::all_of(forces_.begin(), forces_.end(), [](const SolidForces& own) { return linalg::finite(own.r); }) &&
         std::all_of(problem.chains.begin(), problem.chains.end(),
                     [](const solve::ChainPart& part) { return linalg::finite(part.r); });
}

bool Linearization::find_redundant() {
  const auto known = [this](const std::vector<int>& rows) {
    const auto holds = [&rows](const std::vector<int>& own) {
      return std::includes(own.begin(), own.end(), rows.begin(), rows.end());
    };
    const auto& all = context_->model.redundant;
    return std::any_of(all.begin(), all.end(), [&holds](const RedundantGroup& own) { return holds(own.rows); }) ||
           std::any_of(redundant_.begin(), redundant_.end(), holds);
  };
  bool more = false;
  for (std::vector<int>& rows : find_redundant_rows(context_->model, *iterate_, reduced_.problem)) {
    if (known(rows)) continue;
    redundant_.push_back(std::move(rows));
    more = true;
  }
  return more;
}

const RedundantRows* Linearization::contradicting(double limit) const {
  if (reduced_.redundant.empty()) return nullptr;
  const Eigen::VectorXd c = reduced_.as_told();
  for (const RedundantRows& own : reduced_.redundant) {
    if (own.contradiction(c) > limit) return &own;
  }
  return nullptr;
}

std::string Linearization::unanswered_contact() const {
  if (!contacts_ready_ || contact_forces_.unanswered() < 0) return {};
  const Model& model = context_->model;
  const ContactState& own = iterate_->contacts[contact_forces_.unanswered()];
  std::string rods;
  for (const Collider& side : {own.a.on, own.b.on}) {
    if (side.kind == Collider::Kind::rod) rods += (rods.empty() ? "rods." : " and rods.") + name_of(model, side);
  }
  return name_of_pair(model, own.pair) + " press along a direction that no strain and no motion answers" +
         (rods.empty() ? "" : "; add `elongation` to the strains of " + rods);
}

bool Linearization::factor(solid::Tangent kind, Wanted wanted, std::string& failed) {
  if (ahead_ != kind) {
    if (kind == solid::Tangent::exact) {
      const Clock clock(times_->contact);
      add_contact_curvature(*context_, *iterate_, contacts_);
    }
    beside([&](std::size_t i, StageTimes& own) { factor_solid(i, kind, own); },
           [&](StageTimes& own) {
             const Clock clock(own.solve);
             factor_.eliminate_chains(reduced_.problem);
           });
  }
  if (!solids_factored(failed)) return false;
  factor_border();
  if (wanted == Wanted::any || kind == solid::Tangent::definite || negative_ == 0) return true;
  if (conservative() && loose() <= 0) return true;
  rotated_ = true;
  beside([&](std::size_t i, StageTimes& own) { factor_solid(i, solid::Tangent::definite, own); }, [](StageTimes&) {});
  if (!solids_factored(failed)) return false;
  factor_border();
  return true;
}

int Linearization::loose() {
  const int loose = negative_ + factor_.inertia().negative - context_->model.rows;
  if (loose <= 0 || !ContactForces::wanted(context_->model, contacts_)) return loose;
  const Clock clock(times_->contact);
  prepare_contacts();
  return loose - contact_forces_.held(contacts_);
}

void Linearization::prepare_contacts() {
  if (!contacts_ready_) contact_forces_.prepare(*context_, *iterate_, contacts_, reduced_, free_, factor_);
  contacts_ready_ = true;
}

void Linearization::factor_solid(std::size_t number, solid::Tangent kind, StageTimes& times) {
  const auto factored = [&](solid::Tangent wanted) {
    return free_[number].factor(*context_, *iterate_, contacts_.touches, static_cast<int>(number), forces_[number],
                                wanted, crew_, times, reduced_.problem.volumes[number]);
  };
  Factored& own = factored_[number];
  own = factored(kind) ? Factored::as_told : Factored::failed;
  exact_[number] = own == Factored::as_told && kind == solid::Tangent::exact;
  if (own == Factored::failed && kind == solid::Tangent::exact && factored(solid::Tangent::definite))
    own = Factored::definite;
}

bool Linearization::solids_factored(std::string& failed) {
  negative_ = 0;
  stiffness_ = 0.0;
  for (std::size_t i = 0; i < free_.size(); ++i) {
    if (factored_[i] == Factored::failed) {
      failed = "solids." + context_->model.solids[i].name;
      return false;
    }
    rotated_ |= factored_[i] == Factored::definite;
    stiffness_ = std::max(stiffness_, free_[i].stiffness());
    negative_ += free_[i].negative();
  }
  return true;
}

void Linearization::factor_border() {
  const Clock clock(times_->solve);
  factor_.factor();
  coupled_ = true;
  contacts_ready_ = false;
}

void Linearization::stiffen() {
  constexpr double kPart = 1e-6;
  for (solve::ChainPart& chain : reduced_.problem.chains) {
    for (int k = 0; k < chain.chain.links(); ++k) chain.chain.block(k).diagonal() *= 1.0 + kPart;
  }
  factor_.eliminate_chains(reduced_.problem);
  factor_border();
}

bool Linearization::conservative() const {
  const auto& loads = context_->model.loads;
  const auto& chains = reduced_.problem.chains;
  return std::all_of(chains.begin(), chains.end(),
                     [](const solve::ChainPart& part) { return part.chain.symmetric(); }) &&
         std::equal(loads.begin(), loads.end(), context_->command.loads.begin(),
                    [](const LoadModel& load, double factor) {
                      const SolidLoadModel* own = std::get_if<SolidLoadModel>(&load.on);
                      return !own || own->conservative() || factor == 0.0;
                    });
}

bool Linearization::stability_known() const { return !rotated_ && coupled_ && conservative(); }

bool Linearization::unstable() {
  unresisted_.clear();
  if (!stability_known()) return false;
  solve::MatrixInertia border = factor_.inertia();
  unresisted_ = std::move(border.null_unknowns);
  return negative_ + border.negative > context_->model.rows;
}

std::optional<bool> Linearization::unstable_between_contacts() {
  if (!stability_known()) return {};
  if (ContactForces::conserve(*context_, *iterate_, contacts_, scale_)) return loose() > 0;
  // Friction holds what sticks, at most. (How it holds what rolls on it is not in the tangent to second order.)
  if (ContactForces::stick_on_obstacles(*context_, *iterate_, contacts_) && loose() > 0) return true;
  return {};
}

void Linearization::solve(const Linearization& right, Increment& increment, const Steer& steer,
                          std::optional<solve::CoupledFactor::Part> rough) {
  const Clock clock(times_->solve);
  const Model& model = context_->model;
  const bool own = &right == this;
  pushes_.resize(right.forces_.size());
  for (std::size_t i = 0; i < pushes_.size(); ++i) {
    if (!own || model.scene.newton.precision == linalg::Precision::float32) pushes_[i] = -right.forces_[i].r;
  }
  solve::right_side(right.reduced_.problem, side_);
  for (std::size_t i = 0; i < free_.size(); ++i) {
    if (own) {
      free_[i].push_own(model.solids[i], model, side_.c);
    } else {
      free_[i].push(model.solids[i], model, pushes_[i], side_.c);
    }
  }
  follow(pushes_, side_, increment, steer, rough);
}

void Linearization::push(const std::vector<Eigen::VectorXd>& solids, solve::RightSide& side) {
  const Model& model = context_->model;
  for (std::size_t i = 0; i < free_.size(); ++i) free_[i].push(model.solids[i], model, solids[i], side.c);
}

void Linearization::couple(const std::vector<Eigen::VectorXd>& solids, solve::RightSide& side,
                           solve::CoupledSolution& solution) {
  push(solids, side);
  factor_.solve(side, solution);
}

void Linearization::respond(const std::vector<Eigen::VectorXd>& solids, solve::RightSide& side, Increment& increment) {
  const Clock clock(times_->solve);
  push(solids, side);
  follow(solids, side, increment, {});
}

void Linearization::follow(const std::vector<Eigen::VectorXd>& solids, const solve::RightSide& side,
                           Increment& increment, const Steer& steer, std::optional<solve::CoupledFactor::Part> rough,
                           const Eigen::VectorXd* beyond) {
  const Model& model = context_->model;
  if (rough && !ContactForces::wanted(model, contacts_)) {
    factor_.answer(side, increment.reduced, *rough);
  } else {
    rough.reset();
    factor_.solve(side, increment.reduced);
  }
  if (ContactForces::wanted(model, contacts_) && increment.reduced.ok) {
    double spent = 0.0;
    {
      const Clock clock(spent);
      prepare_contacts();
      contact_forces_.solve(*context_, *iterate_, contacts_, free_, factor_, increment.reduced, increment.forces,
                            beyond);
    }
    times_->contact += spent;
    times_->solve -= spent;  // whose clock runs
  } else {
    increment.forces = {};
  }
  polished_ = true;
  if (steer && increment.reduced.ok) steer(increment);
  if (rough && !polished_) {  // once more, from a good one
    factor_.solve(side, increment.reduced);
    if (increment.reduced.ok) steer(increment);
  }
  increment.dx.resize(free_.size());
  if (!increment.reduced.ok) return;
  for (std::size_t i = 0; i < free_.size(); ++i)
    free_[i].correct(model.solids[i], model, increment.reduced.dlambda, increment.dx[i]);
  if (model.scene.newton.precision == linalg::Precision::float32) refine(solids, increment);
}

double Linearization::beyond_tangent(const Increment& increment) {
  const Clock clock(times_->contact);
  const StepContext& context = *context_;
  const Model& model = context.model;
  trial_ = *iterate_;
  advance_by(context, increment, 1.0, trial_);
  trial_room_.start = contacts_.start;
  trial_room_.facings = contacts_.facings;
  trial_room_.least = contacts_.least;
  trial_room_.playing.clear();
  evaluate_contacts(context, trial_, trial_room_);
  forces_here_.clear();
  forces_more_.clear();
  forces_there_.clear();
  for (std::size_t i = 0; i < contacts_.touches.size(); ++i) {
    forces_here_.push_back(increment.forces.contacts[i].from);
    forces_more_.push_back(increment.forces.contacts[i].more);
    forces_there_.push_back(trial_room_.touches[i].force);
  }
  contacts_beyond_tangent(model, {*iterate_, contacts_, forces_here_}, forces_more_,
                          {trial_, trial_room_, forces_there_}, exact_, increment.dx, increment.reduced, beyond_);
  const std::vector<int>& touching = contact_forces_.touching();
  const Eigen::VectorXd& moved = contact_forces_.moved();
  beyond_.u.setZero(moved.size());  // and stays so of rods that rub, and of what nothing answers
  for (int i = 0; i < static_cast<int>(touching.size()); ++i) {
    if (!contact_forces_.answered(i)) continue;
    const auto at = static_cast<std::size_t>(touching[static_cast<std::size_t>(i)]);
    beyond_.u.segment<3>(3 * i) =
        contact_beyond_rows(contacts_.touches[at], trial_room_.touches[at], moved.segment<3>(3 * i));
  }
  without_units(model, scale_, beyond_, found_);
  if (solved_.size() == 0) solved_.setZero(found_.size());
  const Eigen::Index rows = beyond_.u.size(), forces = found_.size() - rows;
  const Eigen::VectorXd off = found_ - solved_;
  if (!off.allFinite()) return INFINITY;
  return (forces > 0 ? off.head(forces).lpNorm<Eigen::Infinity>() : 0.0) +
         (rows > 0 ? off.tail(rows).lpNorm<Eigen::Infinity>() : 0.0);
}

void Linearization::correct_contacts(double enough, Increment& increment) {
  constexpr int kMostTurns = 6;
  constexpr double kLost = 4.0;  // an accelerated turn that leaves so many times the least of all leads nowhere
  const Model& model = context_->model;
  const auto presses = [](const ContactChange::Force& own) { return !(own.from + own.more).isZero(0.0); };
  if (!increment.reduced.ok || !(scale_ > 0.0) ||
      std::none_of(increment.forces.contacts.begin(), increment.forces.contacts.end(), presses))
    return;
  solved_.resize(0);
  double least = beyond_tangent(increment), left = least;
  if (!(least > enough) || std::isinf(least)) return;
  acceleration_.begin();
  best_ = increment;
  bool last_is_best = true;
  for (int turn = 0; turn < kMostTurns && least > enough && std::isfinite(left); ++turn) {
    if (turn > 1 && left > kLost * least) break;
    acceleration_.next(found_, solved_);
    with_units(model, scale_, solved_, beyond_);
    solve::right_side(reduced_.problem, side_);
    side_.r += beyond_.z;
    for (std::size_t i = 0; i < beyond_.rods.size(); ++i) side_.chains[i] += beyond_.rods[i];
    for (std::size_t i = 0; i < free_.size(); ++i) {
      solid::at_unknowns(model.solids[i].body, beyond_.nodes[i], pushes_[i]);
      pushes_[i] = -forces_[i].r - pushes_[i];
    }
    {
      const Clock clock(times_->solve);
      push(pushes_, side_);
      follow(pushes_, side_, increment, {}, {}, &beyond_.u);
    }
    left = increment.reduced.ok ? beyond_tangent(increment) : INFINITY;
    last_is_best = left < least && trusted_fraction(*context_, increment) == 1.0;
    if (!last_is_best) continue;
    least = left;
    best_ = increment;
  }
  if (!last_is_best) std::swap(increment, best_);
}

void Linearization::refine(const std::vector<Eigen::VectorXd>& solids, Increment& increment) {
  constexpr int kMost = 20;
  constexpr double kAimed = 1e-15, kEnough = 1e-12;
  const Model& model = context_->model;
  left_ = solids;
  part_ = increment;
  double left = INFINITY;
  for (int turn = 0;; ++turn) {
    clear(model, rest_);
    const double before = std::exchange(left, 0.0);
    for (std::size_t i = 0; i < free_.size(); ++i) {
      const double size = free_[i].stiffness() * increment.dx[i].cwiseAbs().maxCoeff();
      const double own = free_[i].leave(model.solids[i], model, reduced_.problem.volumes[i], part_.reduced.dlambda,
                                        part_.dx[i], left_[i], rest_.c);
      const double relative = own == 0.0 ? 0.0 : own / size;
      left = relative <= left || std::isnan(left) ? left : relative;  // NaN stays
    }
    if (left < kAimed || !(left < 0.5 * before) || turn == kMost) break;
    push(left_, rest_);
    factor_.solve(rest_, part_.reduced);
    if (!part_.reduced.ok) break;
    for (std::size_t i = 0; i < free_.size(); ++i) {
      free_[i].correct(model.solids[i], model, part_.reduced.dlambda, part_.dx[i]);
      increment.dx[i] += part_.dx[i];
    }
    increment.reduced += part_.reduced;
  }
  stalled_ = !(left < kEnough);
  increment.reduced.ok = !stalled_;
}

void Linearization::watched_motion(const Eigen::VectorXd& dlambda, bool pushed, Eigen::Ref<Eigen::VectorXd> motion) {
  for (std::size_t i = 0; i < free_.size(); ++i)
    free_[i].watched_motion(context_->model.solids[i], context_->model, dlambda, pushed, motion);
}

void advance_by(const StepContext& context, const Increment& increment, double fraction, State& iterate) {
  for (std::size_t i = 0; i < increment.dx.size(); ++i) iterate.solids[i].x += fraction * increment.dx[i];
  for (std::size_t i = 0; i < increment.forces.contacts.size(); ++i) {
    const ContactChange::Force& own = increment.forces.contacts[i];
    iterate.contacts[i].force = own.from + fraction * own.more;
    iterate.contacts[i].normal = own.normal;
  }
  for (std::size_t i = 0; i < increment.forces.frictions.size(); ++i)
    iterate.points[context.model.rubbing[i]].friction += fraction * increment.forces.frictions[i];
  advance_reduced(context, increment.reduced, fraction, iterate);
}

namespace {

constexpr double kTrustedTurn = 0.8;   ///< [rad]
constexpr double kTrustedShare = 0.3;  ///< of the scene's size

}  // namespace

double trusted_fraction(const StepContext& context, const Increment& increment) {
  double fraction = 1.0, farthest = 0.0;
  for (const Eigen::Matrix3Xd& dx : increment.dx) farthest = std::max(farthest, dx.cwiseAbs().maxCoeff());
  const double turn = largest_turn(context, increment.reduced), trusted = kTrustedShare * context.model.size;
  if (turn > kTrustedTurn) fraction = kTrustedTurn / turn;
  if (farthest > trusted) fraction = std::min(fraction, trusted / farthest);
  return fraction;
}

std::string beyond_trust(const StepContext& context, const Increment& increment) {
  const Model& model = context.model;
  const Bend bend = largest_bend(context, increment.reduced);
  if (bend.angle > kTrustedTurn) {
    return "rods." + model.rods[bend.rod].name + ", a section bent by " + three_digits(bend.angle) +
           " rad in one linearisation";
  }
  for (std::size_t i = 0; i < increment.dx.size(); ++i) {
    const Eigen::Matrix3Xd& dx = increment.dx[i];
    if (!(dx.cwiseAbs().maxCoeff() > kTrustedShare * model.size)) continue;
    const Vec3 along = dx.rowwise().mean();  // of it, any distance is exact
    const double moved = (dx.colwise() - along).cwiseAbs().maxCoeff();
    if (!(moved > kTrustedShare * model.size)) continue;
    return "solids." + model.solids[i].name + ", a node moved by " + three_digits(moved) + " m in one linearisation";
  }
  return {};
}

}  // namespace sinew
