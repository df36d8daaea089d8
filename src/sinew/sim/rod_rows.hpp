// One rod while its equations are put together: loads on its points, and what its rows and shared unknowns do to its
// strains.
#pragma once

#include "sinew/sim/reduced.hpp"

namespace sinew {

class RodRows {
 public:
  RodRows(const StepContext& context, const State& iterate, int number, Reduced& reduced);

  int number() const { return number_; }
  const rod::Configuration& shape() const { return own_.shape; }
  Reduced& reduced() { return reduced_; }
  solve::CoupledProblem& problem() { return reduced_.problem; }
  const StepContext& context() const { return context_; }
  const State& iterate() const { return iterate_; }

  /// A force on a material point; loads may come in any order.
  void load(const rod::PointLoad& load) { own_.loads.push_back(load); }
  /// An abscissa that is the unknown z, under the force of its load: f . gamma_qs and f . gamma_ss.
  void slide(const rod::CurvePoint& point, double s, const Vec3& force, int unknown);
  /// Couples a border entry (an unknown z, or row(i)) to the strains and the base by f . dX/dq of the point at
  /// `offset`.
  void attach(int border, const rod::CurvePoint& point, const Vec3& offset, const Vec3& f);
  /// Three entries from `first` on: x, y and z of the centreline's point. (As `attach`, at a third of its products.)
  void attach_centre(int first, const rod::CurvePoint& point);
  int row(int number) const { return static_cast<int>(reduced_.problem.r.size()) + number; }

  /// Adds mass, elasticity, tendons and all the above to the coupled problem.
  void finish();

 private:
  void add_slide(const rod::Slide& slide, int unknown);
  void add_forces();
  void add_tendons(solve::ChainPart& part);
  void measure();

  const StepContext& context_;
  const State& iterate_;
  int number_;
  Reduced& reduced_;
  RodParts& own_;
};

/// [m], [m^2]: what a generalised force of each strain of a rod is divided by to compare it with forces.
Eigen::VectorXd strain_levers(const rod::Rod& rod);

/// Axes of what holds a tie, at an iterate, as columns `TieModel::length` long.
rod::Mat3 holder_axes(const StepContext& context, const State& iterate, const TieModel& tie);

/// The row that holds a turn about an axis of a tie: `sign` times the holder's axis `held` by the rod's axis `carried`.
struct HeldTurn {
  int carried = 0, held = 0;
  double sign = 1.0;
};
HeldTurn held_turn(const TieModel& tie, int about);

/// Rows of ties in which a rod is held, or holds.
void add_ties(RodRows& rod);

}  // namespace sinew
