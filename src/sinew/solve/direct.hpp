// The coupled linear problem of a step, (11) and (12): volumes seen through their compliance, rods through their
// chains.
#pragma once

#include <Eigen/Core>
#include <Eigen/LU>
#include <memory>
#include <vector>

#include "sinew/linalg/chain.hpp"
#include "sinew/linalg/symmetric_factor.hpp"

namespace sinew::solve {

/// The few numbers of a matrix that has few; those of one place add up.
class Entries {
 public:
  struct Entry {
    int row = 0, column = 0;
    double value = 0.0;
  };
  void add(int row, int column, double value) { all_.push_back({row, column, value}); }
  /// A block with its first entry there.
  template <class Block>
  void add(int row, int column, const Eigen::MatrixBase<Block>& block) {
    for (int j = 0; j < block.cols(); ++j) {
      for (int i = 0; i < block.rows(); ++i) add(row + i, column + j, block(i, j));
    }
  }
  void clear() { all_.clear(); }
  auto begin() const { return all_.begin(); }
  auto end() const { return all_.end(); }

 private:
  std::vector<Entry> all_;
};

/// A volume as its rows feel it.
struct VolumePart {
  std::vector<int> at;    ///< the rows it takes part in
  Eigen::MatrixXd W;      ///< H A_x^-1 H^T over them
  bool symmetric = true;  ///< only the lower triangle of W counts
};

/// The strains of one rod: A x + U^T T y_b + R^T y = -r, where y_b are its base's coordinates, y all border unknowns.
struct ChainPart {
  linalg::Chain chain;    ///< A
  linalg::Matrix6X base;  ///< T: twists of the base's coordinates
  int first_base = 0;     ///< their place in z
  Eigen::VectorXd r;
  std::vector<linalg::Attachment> attachments;  ///< rows of R, sorted by link ...
  std::vector<int> at;                          ///< ... and what each belongs to: z's number, or z's size + row
  Eigen::MatrixXd whole;                        ///< rows of R that reach along the whole chain, as columns
  std::vector<int> whole_at;
};

/// Unknowns: z (coordinates of bases, cables and rigid bodies, abscissae, what ties follow), multipliers lambda
/// (forces) and the strains of all chains.
///     B dz + G^T dlambda + (chains) = -r        equilibrium
///     G dz - W dlambda   + (chains) =  c        constraints: c + H dx = G dz + ..., with volumes moving by
///                                               dx = dx_free + A_x^-1 H^T dlambda
/// so W = H A_x^-1 H^T and c is the violation after the free motion. Whoever puts the problem together leaves c before
/// it; the motion is added to a RightSide (`sim/free_motion` `push`). Eliminating the chains adds the rods' share to W:
/// the paper's (11), (12). What remains, the border, needs no inverse of B, which is singular for a straight cable
/// whose abscissae are unknown, and indefinite under tension.
struct CoupledProblem {
  Entries B, G;
  std::vector<VolumePart> volumes;  ///< W: the sum of theirs ...
  Entries W;                        ///< ... and of these
  Eigen::VectorXd r, c;             ///< as long as z and lambda
  std::vector<ChainPart> chains;
};

/// The whole matrix over (z, lambda, strains of all chains): for checks, and the solver of last resort.
Eigen::MatrixXd written_out(const CoupledProblem& problem);

/// What changes from one solve to the next with the same matrix.
struct RightSide {
  Eigen::VectorXd r, c;
  std::vector<Eigen::VectorXd> chains;
};
void right_side(const CoupledProblem& problem, RightSide& right);

struct CoupledSolution {
  Eigen::VectorXd dz, dlambda;
  std::vector<Eigen::VectorXd> dq;  ///< strains of each chain
  bool ok = false;                  ///< finite, and the equations hold to rounding
  bool redundant = false;           ///< rows depended on each other; the multipliers returned are the smallest that do
  double residual = 0.0;            ///< largest relative residual of the scaled equations

  /// Adds the unknowns of another solution.
  CoupledSolution& operator+=(const CoupledSolution& other);
};

/// Factors once, solves often, and keeps its memory for the next problem. Chains are eliminated in time proportional to
/// their length. The border is dense; solutions are refined. A symmetric one is factored as such, the rows that feel a
/// compliance first, then z; a compliance that vanishes in some direction (a point of which all nodes are held) is
/// given a ten-billionth of the others' and refined away. Where that is not good enough, an LU serves. Where a
/// chain has no good pivots (strains that nothing but the constraints hold), it joins the border; where the border is
/// singular, a complete orthogonal decomposition takes over.
class CoupledFactor {
 public:
  /// First what needs no volumes. The problem must outlive its solutions.
  void eliminate_chains(const CoupledProblem& problem);
  /// And the border.
  void factor();
  void solve(const RightSide& right, CoupledSolution& solution);
  /// How much of a solution is wanted; strains that are not are zero.
  enum class Part { all, without_strains };
  /// One of several solutions that are put together, and then polished as one: what is left of its equations is neither
  /// looked at, nor told in `residual`.
  void answer(const RightSide& right, CoupledSolution& solution, Part part = Part::all);
  /// Finds the strains of a solution that is near, and refines it; where that does not help, solves again. False where
  /// it was not that near: what has been made of its parts is not good for much either.
  bool polish(const RightSide& right, CoupledSolution& solution);

  /// Negative eigenvalues of the whole matrix (Sylvester), if it is symmetric. An equilibrium is stable where there are
  /// no more of them than rows. Costs an eigenvalue problem of the border where that has no symmetric factor.
  int negative() const;

 private:
  enum class Kind { symmetric, general, singular };

  void place();
  bool factor_symmetric();
  void factor_general(bool join_chains);
  template <class Border>
  void fill(Border& border);
  void weigh();
  void solve_once(const RightSide& right, CoupledSolution& solution, Part part = Part::all);
  void find_strains(const RightSide& right, CoupledSolution& solution);
  double refine(const RightSide& right, CoupledSolution& solution);
  /// What a residual is measured against.
  double size_of(const RightSide& right, const CoupledSolution& solution) const;
  /// Right side minus matrix times solution, and its largest entry beside the right side's and the solution's, as the
  /// border weighs them.
  double residual(const RightSide& right, const CoupledSolution& solution, RightSide& rest);

  const CoupledProblem* problem_ = nullptr;
  Kind kind_ = Kind::general;
  bool chains_ = false;  ///< all of them have pivots
  bool joined_ = false;  ///< chains are written out in the border
  std::vector<linalg::ChainFactor> factors_;
  std::vector<linalg::ChainFactor::Condensed> condensed_;

  // Of a symmetric border: its order of elimination and what it is.
  std::vector<int> place_, begin_;
  int yielding_ = 0;  ///< so many rows feel a compliance
  std::vector<double> least_;
  linalg::SymmetricFactor symmetric_;
  // Of any other, chains perhaps included.
  Eigen::MatrixXd K_;
  std::unique_ptr<Eigen::PartialPivLU<Eigen::MatrixXd>> lu_;

  Eigen::VectorXd scale_;  ///< D: D K D has entries near one
  Eigen::VectorXd diagonal_, largest_, y_, left_, forces_, moved_;
  std::vector<int> places_;
  struct ChainRoom {
    Eigen::VectorXd attached, answer;
  };
  std::vector<ChainRoom> rooms_;
  std::vector<double> ordered_;
  RightSide rest_;
  CoupledSolution correction_;
};

CoupledSolution solve_direct(const CoupledProblem& problem);

}  // namespace sinew::solve
