// Anderson acceleration of a fixed-point iteration x <- G(x) (D. G. Anderson, J. ACM 12, 1965; the notation is that of
// H. F. Walker and P. Ni, SIAM J. Numer. Anal. 49, 2011). With residuals f_i = G(x_i) - x_i of the latest iterates,
//
//     x_{k+1} = G(x_k) - sum_j gamma_j (G(x_{j+1}) - G(x_j)),    gamma = argmin |f_k - sum_j gamma_j (f_{j+1} - f_j)|.
//
// Where G is linear and diagonalisable this does what GMRES does on x - G(x) = 0, as long as no difference is dropped:
// it ends after as many images, and one, as G has distinct eigenvalues, and G need not contract.
#pragma once

#include <Eigen/Core>

namespace sinew::solve {

class AndersonAcceleration {
 public:
  /// Keeps `depth` differences, one at least, of the depth + 1 latest iterates.
  explicit AndersonAcceleration(int depth) : depth_(depth) {}
  /// Forgets all iterates.
  void begin() { known_ = 0; }
  /// From an iterate x and its image G(x), both in units that make their entries comparable, finds the next iterate,
  /// which replaces x.
  void next(const Eigen::VectorXd& image, Eigen::VectorXd& x);

 private:
  int depth_, known_ = 0;  ///< iterates since the first one
  Eigen::VectorXd last_image_, last_residual_;
  Eigen::MatrixXd images_, residuals_;  ///< differences G(x_{j+1}) - G(x_j) and f_{j+1} - f_j, the oldest one replaced
};

}  // namespace sinew::solve
