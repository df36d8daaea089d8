// The reduced side of a step: rods in their coordinates, (9), and the rows that tie them to volumes and motors, II-C.
#pragma once

#include "sinew/sim/free_motion.hpp"
#include "sinew/solve/direct.hpp"

namespace sinew {

/// Rods at an iterate: the coupled problem's B, G and r, and c without the volumes' free motion.
struct Reduced {
  solve::CoupledProblem problem;  ///< W still zero
  double largest = 0.0;           ///< [N] largest unbalanced generalised force, by its lever arm
  double scale = 0.0;      ///< [N] what residuals are measured against: the largest of elastic, sliding and motor
                           ///< forces, and of the sums of inertia and weight of a rod
  double violation = 0.0;  ///< [m] largest violation of a row
};

/// Linearises rods, sliding points, anchors, motors and cable lengths at an iterate.
Reduced linearize(const StepContext& context, const State& iterate);

/// (11): W = H A_x^-1 H^T of all volumes, and their free motion H dx added to c.
void add_compliance(const StepContext& context, const std::vector<FreeMotion>& free, solve::CoupledProblem& problem);

/// Moves every reduced unknown and multiplier of an iterate by `fraction` of a solution.
void advance_reduced(const StepContext& context, const solve::CoupledSolution& solution, double fraction,
                     State& iterate);

/// Largest rotation [rad] of a rod's section or base that a solution asks for.
double largest_turn(const StepContext& context, const Eigen::VectorXd& dz);

}  // namespace sinew
