#include "sinew/sim/linearization.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "sinew/sim/clock.hpp"

namespace sinew {

Linearization::Linearization(const StepContext& context, Workspace& workspace, const State& iterate, StageTimes& times)
    : context_(context), workspace_(workspace), iterate_(iterate), times_(times) {
  {
    const Clock clock(times.forces);
    for (std::size_t i = 0; i < context.model.solids.size(); ++i) {
      forces_.push_back(solid_forces(context, iterate, static_cast<int>(i)));
      largest_ = std::max(largest_, forces_.back().largest);
      scale_ = std::max(scale_, forces_.back().scale);
    }
  }
  const Clock clock(times.rods);
  reduced_ = linearize(context, iterate);
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
  if (wanted == Wanted::any || kind == solid::Tangent::definite || negative_ == 0) {
    couple();
    return true;
  }
  const Eigen::MatrixXd W = reduced_.problem.W;  // without the volumes, whose share may have to change
  couple();
  if (conservative() && negative_ + coupled_->negative() <= context_.model.rows) return true;
  rotated_ = true;
  if (!factor_solids(solid::Tangent::definite, failed)) return false;
  reduced_.problem.W = W;
  couple();
  return true;
}

bool Linearization::factor_solids(solid::Tangent kind, std::string& failed) {
  free_.clear();
  negative_ = 0;
  for (std::size_t i = 0; i < context_.model.solids.size(); ++i) {
    const auto number = static_cast<int>(i);
    FreeMotion own = free_motion(context_, workspace_, iterate_, number, kind, times_);
    if (!own.ok && kind == solid::Tangent::exact) {
      rotated_ = true;
      own = free_motion(context_, workspace_, iterate_, number, solid::Tangent::definite, times_);
    }
    if (!own.ok) {
      failed = "solids." + context_.model.solids[i].name;
      return false;
    }
    stiffness_ = std::max(stiffness_, own.stiffness);
    negative_ += own.negative;
    free_.push_back(std::move(own));
  }
  return true;
}

void Linearization::couple() {
  const Clock clock(times_.solve);
  add_compliance(context_, free_, reduced_.problem);
  coupled_.emplace(reduced_.problem);
}

void Linearization::stiffen() {
  constexpr double kPart = 1e-6;
  for (solve::ChainPart& chain : reduced_.problem.chains) {
    for (int k = 0; k < chain.chain.links(); ++k) chain.chain.block(k).diagonal() *= 1.0 + kPart;
  }
  coupled_.emplace(reduced_.problem);
}

bool Linearization::conservative() const {
  const auto& loads = context_.model.loads;
  const auto& chains = reduced_.problem.chains;
  return std::all_of(chains.begin(), chains.end(),
                     [](const solve::ChainPart& part) { return part.chain.symmetric(); }) &&
         std::equal(loads.begin(), loads.end(), context_.command.loads.begin(),
                    [](const LoadModel& load, double factor) {
                      const SolidLoadModel* own = std::get_if<SolidLoadModel>(&load.on);
                      return !own || own->conservative() || factor == 0.0;
                    });
}

bool Linearization::unstable() const {
  return !rotated_ && coupled_ && conservative() && negative_ + coupled_->negative() > context_.model.rows;
}

Increment Linearization::solve(const Linearization& right) {
  std::vector<Eigen::VectorXd> forces;
  for (const SolidForces& own : right.forces_) forces.emplace_back(-own.r);
  return respond(forces, solve::right_side(right.reduced_.problem));
}

Increment Linearization::respond(const std::vector<Eigen::VectorXd>& solids, solve::RightSide side) {
  const Clock clock(times_.solve);
  std::vector<Eigen::VectorXd> y;
  for (std::size_t i = 0; i < free_.size(); ++i) {
    const auto number = static_cast<int>(i);
    y.push_back(half_solved(workspace_, number, solids[i]));
    add_free_motion(context_, context_.model.solids[i].rows, border_motion(workspace_, free_[i], number, y.back()),
                    side.c);
  }
  Increment increment;
  increment.reduced = coupled_->solve(side);
  if (!increment.reduced.ok) return increment;
  for (std::size_t i = 0; i < free_.size(); ++i)
    increment.dx.push_back(
        corrected_motion(context_, workspace_, free_[i], y[i], static_cast<int>(i), increment.reduced.dlambda));
  return increment;
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
