// The reduced side of a step: rods in their coordinates, (9), and the rows that tie them to volumes, each other and
// motors, II-C.
#pragma once

#include "sinew/rod/forces.hpp"
#include "sinew/rod/geometric_cable.hpp"
#include "sinew/sim/contacts.hpp"
#include "sinew/sim/redundancy.hpp"
#include "sinew/solve/direct.hpp"

namespace sinew {

/// What one rod's equations are put together from; memory of the last time.
struct RodParts {
  rod::Configuration shape;
  std::vector<rod::PointLoad> loads;
  std::vector<rod::StationInertia> inertia;
  std::vector<linalg::Attachment> attachments;
  std::vector<int> border, order;  ///< of attachments: what each belongs to; sorted by link
  std::vector<int> slides;         ///< unknown of each
  rod::Equations equations;
  double largest = 0.0;  ///< [N] largest unbalanced force of its strains, by their lever arms
  int largest_at = 0;    ///< section
};

/// Rods at an iterate: the coupled problem, but for the volumes' compliance and free motion. With rows c(z, q, x) = 0
/// the multipliers stand as L = E - lambda . c, so G = -dc/d(z, q), r += G^T lambda, B -= lambda . c''.
struct Reduced {
  solve::CoupledProblem problem;                    ///< its volumes are left as they are
  std::vector<std::vector<rod::Balance>> internal;  ///< of each rod
  std::vector<RodParts> rods;
  std::vector<rod::CableLength> cables;
  std::vector<RedundantRows> redundant;  ///< rows that depend on each other here; W has their compliance already
  Eigen::VectorXd given;   ///< [m] what rows that come apart by a little give way: part of c (sim/redundancy), or empty
  double largest = 0.0;    ///< [N] largest unbalanced generalised force, by its lever arm
  double scale = 0.0;      ///< [N] what residuals are measured against: the largest of elastic, sliding and motor
                           ///< forces, and of the sums of inertia and weight of a rod
  double violation = 0.0;  ///< [m] largest violation of a row

  /// c without what rows give way.
  Eigen::VectorXd as_told() const { return given.size() == 0 ? problem.c : Eigen::VectorXd(problem.c - given); }
};

/// Linearises rods, cables, rigid bodies, sliding points, ties, motors, loads and forces of contacts at an iterate.
/// Memory of an earlier one is used again.
void linearize(const StepContext& context, const State& iterate, const std::vector<Touch>& touches, Reduced& reduced);

/// CoupledProblem::reference of an equilibrium, for bases of rods. Where forces as large as `force` [N] are balanced to
/// Newton's tolerance, stiffnesses are known no better: against turns ten times tolerance x force x length L counts as
/// none, or 1e-12 E I / L if that is more; against displacements the same over L^2.
void set_references(const StepContext& context, double force, Reduced& reduced);

/// Three rows, from `row`, that hold what a tie follows, three unknowns z from `unknown`, to where it is: c = is - z.
void hold_followed(const Model& model, const State& iterate, int row, int unknown, const Vec3& is, Reduced& reduced);

/// Zeros for every reduced unknown, row and strain, in the memory of an earlier one.
void clear(const Model& model, solve::RightSide& side);

/// Moves every reduced unknown and multiplier of an iterate by `fraction` of a solution.
void advance_reduced(const StepContext& context, const solve::CoupledSolution& solution, double fraction,
                     State& iterate);

/// By how much a rod's section bends or twists [rad] from its one end to the other.
struct Bend {
  double angle = 0.0;
  int rod = -1;
};

/// The largest that a solution asks for, of one strain by itself; `rod` is -1 without any.
Bend largest_bend(const StepContext& context, const solve::CoupledSolution& solution);

/// The largest rotation [rad] of a rigid body or of a rod's section or base that a solution asks for.
double largest_turn(const StepContext& context, const solve::CoupledSolution& solution);

}  // namespace sinew
