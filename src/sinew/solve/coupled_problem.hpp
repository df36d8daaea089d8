// The coupled linear problem of a step, (11) and (12): volumes seen through their compliance, rods through their
// chains.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "sinew/linalg/chain.hpp"

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
/// it; the motion is added to a RightSide (`sim/free_motion` `push_own`). Eliminating the chains adds the rods' share
/// to W: the paper's (11), (12). What remains, the border, needs no inverse of B, which is singular for a straight
/// cable whose abscissae are unknown, and indefinite under tension.
struct CoupledProblem {
  Entries B, G;
  std::vector<VolumePart> volumes;  ///< W: the sum of theirs ...
  Entries W;                        ///< ... and of these
  Eigen::VectorXd r, c;             ///< as long as z and lambda
  /// Per z a stiffness [N/m], [N m] of which 1e-10 counts as none, 0 where there is no such; or empty. It tells motions
  /// that nothing resists from those that little resists, where all that is left of their own is rounding.
  Eigen::VectorXd reference;
  std::vector<ChainPart> chains;
};

}  // namespace sinew::solve
