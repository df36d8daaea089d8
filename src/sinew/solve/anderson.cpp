#include "sinew/solve/anderson.hpp"

#include <Eigen/QR>
#include <algorithm>

namespace sinew::solve {

void AndersonAcceleration::next(const Eigen::VectorXd& image, Eigen::VectorXd& x) {
  const Eigen::VectorXd residual = image - x;
  if (known_ > 0) {
    images_.resize(image.size(), depth_);
    residuals_.resize(image.size(), depth_);
    const int column = (known_ - 1) % depth_;
    images_.col(column) = image - last_image_;
    residuals_.col(column) = residual - last_residual_;
  }
  const int columns = std::min(known_, depth_);
  x = image;
  if (columns > 0) {
    // Differences shrink from iterate to iterate: each is scaled to length 1, so that the latest count like the others.
    // What is left of one beside the others, and is below this part of it, says nothing new.
    constexpr double kDependent = 1e-10;
    Eigen::VectorXd lengths = residuals_.leftCols(columns).colwise().norm();
    for (double& length : lengths) length = length > 0.0 ? length : 1.0;
    Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd> factor;
    factor.setThreshold(kDependent);
    factor.compute(residuals_.leftCols(columns) * lengths.cwiseInverse().asDiagonal());
    x -= images_.leftCols(columns) * factor.solve(residual).cwiseQuotient(lengths);
  }
  last_image_ = image;
  last_residual_ = residual;
  ++known_;
}

}  // namespace sinew::solve
