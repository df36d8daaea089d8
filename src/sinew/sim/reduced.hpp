// The reduced side of a step: rods in their coordinates, (9), and the rows that tie them to volumes, each other and
// motors, II-C.
#pragma once

#include "sinew/rod/forces.hpp"
#include "sinew/sim/free_motion.hpp"
#include "sinew/solve/direct.hpp"

namespace sinew {

/// Rods at an iterate: the coupled problem, but for the volumes' compliance and free motion. With rows c(z, q, x) = 0
/// the multipliers stand as L = E - lambda . c, so G = -dc/d(z, q), r += G^T lambda, B -= lambda . c''.
struct Reduced {
  solve::CoupledProblem problem;                    ///< W still zero
  std::vector<std::vector<rod::Balance>> internal;  ///< of each rod
  double largest = 0.0;                             ///< [N] largest unbalanced generalised force, by its lever arm
  double scale = 0.0;      ///< [N] what residuals are measured against: the largest of elastic, sliding and motor
                           ///< forces, and of the sums of inertia and weight of a rod
  double violation = 0.0;  ///< [m] largest violation of a row
};

/// Linearises rods, cables, sliding points, ties, motors and loads at an iterate.
Reduced linearize(const StepContext& context, const State& iterate);

/// (11): adds W = H A_x^-1 H^T of all volumes.
void add_compliance(const StepContext& context, const std::vector<FreeMotion>& free, solve::CoupledProblem& problem);

/// Adds the free motion H dx of a volume to the violations c.
void add_free_motion(const StepContext& context, const std::vector<int>& solid_rows, const Eigen::VectorXd& motion,
                     Eigen::VectorXd& c);

/// Moves every reduced unknown and multiplier of an iterate by `fraction` of a solution.
void advance_reduced(const StepContext& context, const solve::CoupledSolution& solution, double fraction,
                     State& iterate);

/// Largest rotation [rad] of a rod's section or base that a solution asks for.
double largest_turn(const StepContext& context, const solve::CoupledSolution& solution);

}  // namespace sinew
