#include "sinew/solid/principal.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

namespace sinew::solid {
namespace {

/// Flatter than this, fourth powers of stretches, which Jacobi compares, come near the smallest number.
constexpr double kFlat = 1e-60;

}  // namespace

// One-sided Jacobi: turn the columns of F by pairs until they are perpendicular. Stretches keep all their digits,
// however small, equal or close to each other (Demmel, Veselic, SIAM J. Matrix Anal. Appl. 13, 1992).
Principal principal(const Mat3& F) {
  constexpr int kMostSweeps = 20;
  Mat3 A = F, V = Mat3::Identity();
  bool turned = true;
  for (int sweep = 0; turned && sweep < kMostSweeps; ++sweep) {
    turned = false;
    for (int k = 0; k < 3; ++k) {
      const int i = k, j = (k + 1) % 3;
      const double a = A.col(i).squaredNorm(), b = A.col(j).squaredNorm(), c = A.col(i).dot(A.col(j));
      if (!(c * c > 1e-31 * a * b)) continue;
      turned = true;
      const double z = 0.5 * (b - a) / c, t = std::copysign(1.0, z) / (std::abs(z) + std::sqrt(1.0 + z * z));
      const double cosine = 1.0 / std::sqrt(1.0 + t * t), sine = cosine * t;
      for (Mat3* M : {&A, &V}) {
        const Vec3 x = M->col(i), y = M->col(j);
        M->col(i) = cosine * x - sine * y;
        M->col(j) = sine * x + cosine * y;
      }
    }
  }
  const Vec3 stretch = A.colwise().norm();
  return {A * stretch.cwiseInverse().asDiagonal(), V, stretch};
}

Mat9 unit_changes(const Principal& frame) {
  const auto& [U, V, l] = frame;
  Mat9 changes;
  for (int k = 0; k < 3; ++k) {
    const int i = (k + 1) % 3, j = (k + 2) % 3;
    const Mat3 ij = std::sqrt(0.5) * U.col(i) * V.col(j).transpose();
    const Mat3 ji = std::sqrt(0.5) * U.col(j) * V.col(i).transpose();
    changes.col(k) = (U.col(k) * V.col(k).transpose()).reshaped();
    changes.col(3 + k) = (ij + ji).reshaped();
    changes.col(6 + k) = (ij - ji).reshaped();
  }
  return changes;
}

Mat9 positive_semidefinite(const Mat9& C) {
  const Eigen::SelfAdjointEigenSolver<Mat9> eigen(C);
  const Mat9& Q = eigen.eigenvectors();
  return Q * eigen.eigenvalues().cwiseMax(0.0).asDiagonal() * Q.transpose();
}

Mat9 positive_semidefinite(const Mat9& C, const Mat3& F) {
  const Principal frame = principal(F / F.cwiseAbs().maxCoeff());
  if (!(frame.stretch.minCoeff() > kFlat)) return positive_semidefinite(C);
  const Mat9 changes = unit_changes(frame), stress = C.lazyProduct(changes);
  Mat9 root;  // what is positive of C is root root^T
  bool positive = true;

  const auto stretches = changes.leftCols<3>();
  const Mat3 between = stretches.transpose().lazyProduct(stress.leftCols<3>());
  if (const Eigen::LLT<Mat3> factor(between); factor.info() == Eigen::Success) {
    root.leftCols<3>() = stretches.lazyProduct(Mat3(factor.matrixL()));
  } else {
    const Eigen::SelfAdjointEigenSolver<Mat3> eigen(between);
    const Mat3 axes = eigen.eigenvectors() * eigen.eigenvalues().cwiseMax(0.0).cwiseSqrt().asDiagonal();
    root.leftCols<3>() = stretches.lazyProduct(axes);
    positive = false;
  }
  for (int k = 3; k < 9; ++k) {
    const double eigenvalue = changes.col(k).dot(stress.col(k));
    root.col(k) = std::sqrt(std::max(0.0, eigenvalue)) * changes.col(k);
    positive = positive && eigenvalue >= 0.0;
  }
  if (positive) return C;
  return root.lazyProduct(root.transpose());
}

}  // namespace sinew::solid
