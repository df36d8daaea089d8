// Matrices of open chains, factored in time proportional to their length.
//
// Everything beyond a link feels the link only as a rigid motion, so the coordinates x_k of the links of a chain (here:
// the sections of a rod) meet each other through six numbers: the twist of what lies beyond,
//
//     A_kk = D_k,     A_jk = T_j^T V_k,     A_kj = U_k^T T_j        (link j nearer to the base than k)
//
// with T_k the twists that x_k gives to everything beyond, and V_k, U_k wrenches. README.md of this folder derives the
// recursions.
#pragma once

#include <Eigen/Core>
#include <memory>
#include <vector>

#include "sinew/linalg/sized.hpp"

namespace sinew::linalg {

using Vec6 = Eigen::Matrix<double, 6, 1>;
using Mat6 = Eigen::Matrix<double, 6, 6>;
using Matrix6X = Eigen::Matrix<double, 6, Eigen::Dynamic>;

/// A chain matrix: the blocks above, those of all links side by side.
struct Chain {
  std::vector<int> first;  ///< first coordinate of each link, and the number of all at the end
  Matrix6X T, V;           ///< 6 x n
  Matrix6X U;              ///< 6 x n; empty if the matrix is symmetric, when U = V
  Eigen::MatrixXd D;       ///< (largest link) x n: block k in columns first[k] .. of it, its rows on top

  int links() const { return static_cast<int>(first.size()) - 1; }
  int coordinates() const { return first.back(); }
  int size(int k) const { return first[k + 1] - first[k]; }
  bool symmetric() const { return U.cols() == 0; }
  auto block(int k) { return D.block(0, first[k], size(k), size(k)); }
  auto block(int k) const { return D.block(0, first[k], size(k), size(k)); }
  /// U, symmetric or not.
  const Matrix6X& left() const { return symmetric() ? V : U; }
};

/// All zeros, for links of the given sizes.
Chain make_chain(const std::vector<int>& sizes, bool symmetric);
/// The same in the memory of an earlier one, for links that begin at `first`.
void make_chain(const std::vector<int>& first, bool symmetric, Chain& chain);

/// The matrix written out, for tests and for the solver of last resort.
Eigen::MatrixXd dense(const Chain& chain);

/// y = A x + U^T tau: what all links answer to x when the base moves by the twist tau. Returns the largest number
/// on the way to y, beside which rounding in y has to be seen. `wrench` is V x, which the base feels.
double multiply(const Chain& chain, const Eigen::VectorXd& x, const Vec6& tau, Eigen::VectorXd& y, Vec6& wrench);

/// What couples one outside unknown to a chain: for every link nearer to the base than `link` the wrench `g`, as
/// T_j^T g, and for the link itself the vector `b`.
struct Attachment {
  int link = 0;
  Vec6 g = Vec6::Zero();
  Vector<Eigen::Dynamic> b;
};

/// The vector of an attachment over all coordinates.
Eigen::VectorXd dense(const Chain& chain, const Attachment& attachment);

/// y = R x + tau . g for attachments sorted by link, when the base moves by the twist tau.
void along(const Chain& chain, const std::vector<Attachment>& attachments, const Eigen::VectorXd& x, const Vec6& tau,
           Eigen::VectorXd& y);
/// x = R^T y; returns the sum of y_i g_i, the wrench at the base.
Vec6 across(const Chain& chain, const std::vector<Attachment>& attachments, const Eigen::VectorXd& y,
            Eigen::VectorXd& x);

/// A = L S R factored from the tip to the base; no pivoting between links.
class ChainFactor {
 public:
  /// False where a link's pivot is singular or not finite. The chain must outlive the factor.
  bool factor(const Chain& chain);
  /// Negative eigenvalues of a symmetric A (Sylvester): 0 exactly where it is positive definite.
  int negative() const { return negative_; }

  /// x <- A^-1 (x - U^T tau). `base`, if given, receives sum_k V_k x_k: the wrench that the base feels.
  void solve(Eigen::VectorXd& x, const Vec6& tau = Vec6::Zero(), Vec6* base = nullptr) const;

  /// x <- A^-T x, and U of it as the base feels it.
  void solve_transposed(Eigen::VectorXd& x, Vec6* base = nullptr) const;

  /// The wrench the base feels per twist of the base, -V A^-1 U^T.
  const Mat6& base_response() const { return base_; }

  /// What attachments sorted by link see of each other and of the base through the chain.
  struct Condensed {
    Eigen::MatrixXd W;   ///< R A^-1 R^T; of a symmetric one only the lower triangle counts
    Matrix6X arriving;   ///< 6 x count: g_i - V A^-1 R_i^T, the wrench that the base feels
    Matrix6X answering;  ///< 6 x count: g_i - U A^-T R_i^T, what an attachment feels of a twist of the base

   private:
    friend class ChainFactor;
    Matrix6X alpha, gamma;  // room to work in
    Eigen::MatrixXd moving, above;
  };
  /// Memory of an earlier result is used again.
  void condense(const std::vector<Attachment>& attachments, Condensed& condensed) const;

 private:
  bool factor_only(const Chain& chain);
  /// The upper triangle of W, turned: below the diagonal of `turned_W`. Above stands anything.
  void condense_upper(const std::vector<Attachment>& attachments, Condensed& room, Eigen::MatrixXd& turned_W,
                      Matrix6X& arriving) const;

  const Chain* chain_ = nullptr;
  /// Of an unsymmetric matrix its transposed, in which U and V change places.
  std::shared_ptr<const Chain> turned_chain_;
  std::shared_ptr<const ChainFactor> turned_;
  Matrix6X Y_;         ///< 6 x n: (P T + V) S^-1
  Matrix6X C_;         ///< 6 x n: (U^T + T^T P)^T
  Eigen::MatrixXd S_;  ///< inverses of the pivots, as D
  Mat6 base_ = Mat6::Zero();
  int negative_ = 0;
};

}  // namespace sinew::linalg
