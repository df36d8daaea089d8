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
//
// Rows that depend on each other at the start of a run may come apart by a little in other postures. Opposite tendons
// at the distance d of an axis that cannot stretch grow longer together by d^2 tau^2 / 2 a unit of length where the rod
// is twisted by tau: J^T N = O(tau), and forces of O(1 / tau) would keep all torsion out. A real axis gives way first:
// it is a little shorter, by its forces over its stiffness E A. So such rows are met but for a give of that order, for
// rods of length L (`RedundantGroup::give`, L / E A),
//
//     c + alpha S N N^T S lambda = 0,      alpha = (1 - (sigma / sigma_1)^2)^2 give,
//
// with sigma the singular value of N in the scaled rows: the smallest multipliers again where nothing comes apart
// (N^T c = 0), and rows as told where they are independent in earnest (sigma_1 = 0.1 and beyond). A row alone does the
// same, scaled by its lever arm: that of a straight rod held at both ends, which comes to be answered as the rod bends.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "sinew/sim/state.hpp"
#include "sinew/solve/coupled_problem.hpp"

namespace sinew {

/// Some rows at a linearisation, and the combinations of them that nothing answers, or next to nothing.
struct RedundantRows {
  std::vector<int> rows;   ///< of lambda, ascending
  Eigen::MatrixXd null;    ///< N: a row for each of `rows`, a column for each combination; none: they are independent
  Eigen::VectorXd weight;  ///< S: 1 of rows in metres, 1 / length^2 of angles, 0 of those that hold auxiliary unknowns
  Eigen::Index exact = 0;  ///< combinations that nothing answers; the others come after them
  Eigen::VectorXd give;    ///< [m/N] alpha of each of these
  /// [m] by how much of N^T c these may come apart: what answers them, times what moves it, at most; and the part of it
  /// that is due to strains.
  Eigen::VectorXd slack, slack_of_strains;

  /// [m] N^T c, of combinations with S-norm 1: by how much the rows contradict each other, c as told, without give.
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
/// And those that nothing answered at the start, and little does here.
RedundantRows redundant_rows(const Model& model, const State& iterate, const solve::CoupledProblem& problem,
                             const RedundantGroup& group);

/// Whether a motor that these rows hold chooses its command; whether they hold to a frame that moves.
bool is_chosen(const Model& model, const std::vector<int>& rows);
bool is_carried(const Model& model, const std::vector<int>& rows);

/// Commands that contradict each other by more than this part of the scene's size are told so.
inline constexpr double kContradiction = 1e-6;

/// [m] by how much commands of the model's actuators contradict what a group asks of them at the start.
double contradiction_of(const Model& model, const RedundantGroup& group, const std::vector<double>& commands);

/// Rows as a group, where nothing answers some combination of them.
RedundantGroup redundant_group(const Model& model, const State& iterate, const solve::CoupledProblem& problem,
                               const std::vector<int>& rows);

/// Adds the compliance along N to W: `alpha` [m/N] where nothing answers, any that is not small beside that of the
/// bodies; elsewhere the rows' own give, whose part of c, alpha S N N^T S lambda, is added to `given`.
void add_compliance(const RedundantRows& redundant, double alpha, const Eigen::VectorXd& lambda,
                    solve::CoupledProblem& problem, Eigen::VectorXd& given);

/// [m] the lever arm of a row's violation: 1 of rows in metres.
double arm_of(const Model& model, int row);

/// Of which objects these rows are: "actuators.a, actuators.b"; and what a user can do about it.
std::string name_of_rows(const Model& model, const std::vector<int>& rows);
std::string remedy_of_rows(const Model& model, const std::vector<int>& rows);

}  // namespace sinew
