#include "sinew/sim/linearization.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "sinew/sim/clock.hpp"

namespace sinew {

void Linearization::evaluate(const StepContext& context, const State& iterate, StageTimes& times) {
  context_ = &context;
  iterate_ = &iterate;
  times_ = &times;
  largest_ = scale_ = stiffness_ = 0.0;
  rotated_ = coupled_ = false;
  negative_ = 0;
  {
    const Clock clock(times.forces);
    forces_.resize(context.model.solids.size());
    for (std::size_t i = 0; i < forces_.size(); ++i) {
      solid_forces(context, iterate, static_cast<int>(i), forces_[i]);
      largest_ = std::max(largest_, forces_[i].largest);
      scale_ = std::max(scale_, forces_[i].scale);
    }
  }
  const Clock clock(times.rods);
  linearize(context, iterate, reduced_);
  largest_ = std::max(largest_, reduced_.largest);
  scale_ = std::max(scale_, reduced_.scale);
}

bool Linearization::finite() const {
  const solve::CoupledProblem& problem = reduced_.problem;
  return std::isfinite(largest_) && std::isfinite(reduced_.violation) && problem.r.allFinite() &&
         problem.c.allFinite() &&
         std::all_of(forces_.begin(), forces_.end(), [](const SolidForces& f) { return f.r.allFinite(); }) &&
         std::all_of(problem.chains.begin(), problem.chains.end(),
                     [](const solve::ChainPart& part) { return part.r.allFinite(); });
}

bool Linearization::factor(solid::Tangent kind, Wanted wanted, std::string& failed) {
  if (!factor_solids(kind, failed)) return false;
  couple();
  if (wanted == Wanted::any || kind == solid::Tangent::definite || negative_ == 0) return true;
  if (conservative() && negative_ + factor_.negative() <= context_->model.rows) return true;
  rotated_ = true;
  if (!factor_solids(solid::Tangent::definite, failed)) return false;
  couple();
  return true;
}

bool Linearization::factor_solids(solid::Tangent kind, std::string& failed) {
  const std::vector<SolidModel>& solids = context_->model.solids;
  free_.resize(solids.size());
  reduced_.problem.volumes.resize(solids.size());
  negative_ = 0;
  for (std::size_t i = 0; i < solids.size(); ++i) {
    FreeMotion& own = free_[i];
    const auto factored = [&](solid::Tangent wanted) {
      return own.factor(*context_, *iterate_, static_cast<int>(i), wanted, *times_, reduced_.problem.volumes[i]);
    };
    bool ok = factored(kind);
    if (!ok && kind == solid::Tangent::exact) {
      rotated_ = true;
      ok = factored(solid::Tangent::definite);
    }
    if (!ok) {
      failed = "solids." + solids[i].name;
      return false;
    }
    stiffness_ = std::max(stiffness_, own.stiffness());
    negative_ += own.negative();
  }
  return true;
}

void Linearization::couple() {
  const Clock clock(times_->solve);
  factor_.factor(reduced_.problem);
  coupled_ = true;
}

void Linearization::stiffen() {
  constexpr double kPart = 1e-6;
  for (solve::ChainPart& chain : reduced_.problem.chains) {
    for (int k = 0; k < chain.chain.links(); ++k) chain.chain.block(k).diagonal() *= 1.0 + kPart;
  }
  couple();
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

bool Linearization::unstable() const {
  return !rotated_ && coupled_ && conservative() && negative_ + factor_.negative() > context_->model.rows;
}

void Linearization::solve(const Linearization& right, Increment& increment) {
  pushes_.resize(right.forces_.size());
  for (std::size_t i = 0; i < pushes_.size(); ++i) pushes_[i] = -right.forces_[i].r;
  solve::right_side(right.reduced_.problem, side_);
  respond(pushes_, side_, increment);
}

void Linearization::respond(const std::vector<Eigen::VectorXd>& solids, solve::RightSide& side, Increment& increment) {
  const Clock clock(times_->solve);
  const Model& model = context_->model;
  for (std::size_t i = 0; i < free_.size(); ++i) free_[i].push(model.solids[i], model, solids[i], side.c);
  factor_.solve(side, increment.reduced);
  increment.dx.resize(free_.size());
  if (!increment.reduced.ok) return;
  for (std::size_t i = 0; i < free_.size(); ++i)
    free_[i].correct(model.solids[i], model, increment.reduced.dlambda, increment.dx[i]);
}

void advance_by(const StepContext& context, const Increment& increment, double fraction, State& iterate) {
  for (std::size_t i = 0; i < increment.dx.size(); ++i) iterate.solids[i].x += fraction * increment.dx[i];
  advance_reduced(context, increment.reduced, fraction, iterate);
}

double trusted_fraction(const StepContext& context, const Increment& increment) {
  double fraction = 1.0, farthest = 0.0;
  for (const Eigen::Matrix3Xd& dx : increment.dx) farthest = std::max(farthest, dx.cwiseAbs().maxCoeff());
  const double turn = largest_turn(context, increment.reduced);
  if (turn > 0.8) fraction = 0.8 / turn;
  if (farthest > 0.3 * context.model.size) fraction = std::min(fraction, 0.3 * context.model.size / farthest);
  return fraction;
}

}  // namespace sinew
