// Redundant constraint rows: rows that say the same, or contradict each other, because too few strains and motions can
// answer them.
//
// With J = dc/du the Jacobian of all rows by every free coordinate u (strains, bases, bodies, abscissae, nodes), rows
// are redundant where combinations N of them are answered by no coordinate, J^T N = 0 (the null space of J^T). Forces
// along N move nothing, so equilibrium leaves the multipliers open by lambda + N a; and N^T c is what no motion can
// change: zero where the rows agree, else they contradict each other. Of all multipliers that do the same, a step takes
// the smallest: least sum of squares in newtons, S the weights of rows (`RedundantRows::weight`),
//
//     lambda <- lambda - N (N^T S N)^-1 N^T S lambda.
//
// So that the linear system has one solution, rows get a compliance along N alone, W <- W + alpha S N (S N)^T: by
// J^T N = 0 it yields N^T S dlambda = -N^T c / (alpha N^T S N), which is zero where the rows agree, and changes nothing
// else; each combination counts as one negative eigenvalue, so that inertia tells of stability as without it.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "sinew/sim/state.hpp"
#include "sinew/solve/coupled_problem.hpp"

namespace sinew {

/// Some rows at a linearisation, and the combinations of them that nothing answers.
struct RedundantRows {
  std::vector<int> rows;   ///< of lambda, ascending
  Eigen::MatrixXd null;    ///< N: a row for each of `rows`, a column for each combination; none: they are independent
  Eigen::VectorXd weight;  ///< S: 1 of rows in metres, 1 / length^2 of angles, 0 of those that hold auxiliary unknowns

  /// [m] N^T c, of combinations with S-norm 1: by how much the rows contradict each other.
  double contradiction(const Eigen::VectorXd& c) const;
  /// Those of the rows that do, ascending: what no motion can change of c, N (N^T N)^-1 N^T c, is theirs.
  std::vector<int> contradicting(const Eigen::VectorXd& c) const;
  /// Takes out of a change of multipliers what no coordinate answers, in it and in what they were: their sum is the
  /// smallest that does the same.
  void make_smallest(const Eigen::VectorXd& lambda, Eigen::VectorXd& dlambda) const;
};

/// Groups of rows that depend on each other at a linearisation, each ascending; independent rows are in none. A rank is
/// that of rows scaled to length 1, columns by their lever arms; singular values below 1e-8 are zero.
std::vector<std::vector<int>> find_redundant_rows(const Model& model, const State& iterate,
                                                  const solve::CoupledProblem& problem);

/// The same groups, those that share a rod as one, with all rows of actuators and attachments on their rods: in other
/// postures other combinations of these are redundant.
std::vector<std::vector<int>> join_by_rods(const Model& model, const std::vector<std::vector<int>>& groups);

/// The combinations of these rows that nothing answers, at a linearisation.
RedundantRows redundant_rows(const Model& model, const State& iterate, const solve::CoupledProblem& problem,
                             const std::vector<int>& rows);

/// Adds the compliance along N to W. `alpha` [m/N]: any that is not small beside that of the bodies.
void add_compliance(const RedundantRows& redundant, double alpha, solve::CoupledProblem& problem);

/// Of which objects these rows are: "actuators.a, actuators.b"; and what a user can do about it.
std::string name_of_rows(const Model& model, const std::vector<int>& rows);
std::string remedy_of_rows(const Model& model, const std::vector<int>& rows);

}  // namespace sinew
