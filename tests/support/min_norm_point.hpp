// The distance of convex bodies by another way than the engine's: Wolfe's point of least norm in their Minkowski
// difference, from support functions alone (P. Wolfe, "Finding the nearest point in a polytope", Math. Programming 11,
// 1976).
#pragma once

#include <Eigen/Dense>
#include <cmath>
#include <functional>
#include <vector>

namespace sinew::test {

/// The farthest point of a body along a direction.
using Support = std::function<Eigen::Vector3d(const Eigen::Vector3d& direction)>;

/// The farthest of some points.
inline Support hull_of(std::vector<Eigen::Vector3d> points) {
  return [points = std::move(points)](const Eigen::Vector3d& d) {
    Eigen::Vector3d best = points.front();
    for (const Eigen::Vector3d& p : points) {
      if (p.dot(d) > best.dot(d)) best = p;
    }
    return best;
  };
}

/// Distance of two polytopes; 0 where they overlap.
inline double distance_of(const Support& a, const Support& b) {
  const auto farthest = [&](const Eigen::Vector3d& d) -> Eigen::Vector3d { return a(d) - b(-d); };
  std::vector<Eigen::Vector3d> points = {farthest(Eigen::Vector3d::UnitX())};
  Eigen::VectorXd weights = Eigen::VectorXd::Ones(1);
  Eigen::Vector3d x = points[0];
  for (int i = 0; i < 200; ++i) {
    const Eigen::Vector3d q = farthest(-x);
    if (x.squaredNorm() - x.dot(q) <= 1e-14 * x.norm() * (q.norm() + x.norm()) || x.norm() < 1e-14) break;
    bool known = false;
    for (const Eigen::Vector3d& p : points) known |= p == q;
    if (known) break;
    points.push_back(q);
    weights.conservativeResize(weights.size() + 1);
    weights[weights.size() - 1] = 0.0;
    for (;;) {  // the least point of the affine hull, as long as it is not in the hull itself
      const auto n = static_cast<Eigen::Index>(points.size());
      Eigen::MatrixXd K = Eigen::MatrixXd::Zero(n + 1, n + 1);
      for (Eigen::Index r = 0; r < n; ++r) {
        for (Eigen::Index c = 0; c < n; ++c)
          K(r, c) = points[static_cast<std::size_t>(r)].dot(points[static_cast<std::size_t>(c)]);
        K(r, n) = K(n, r) = 1.0;
      }
      const Eigen::VectorXd alpha = K.completeOrthogonalDecomposition().solve(Eigen::VectorXd::Unit(n + 1, n)).head(n);
      if (alpha.minCoeff() > 1e-12 || n == 1) {
        weights = alpha;
        break;
      }
      double step = 1.0;
      for (Eigen::Index k = 0; k < n; ++k) {
        if (alpha[k] <= 1e-12 && weights[k] > alpha[k]) step = std::min(step, weights[k] / (weights[k] - alpha[k]));
      }
      weights = (1.0 - step) * weights + step * alpha;
      std::vector<Eigen::Vector3d> kept;
      std::vector<double> values;
      for (Eigen::Index k = 0; k < n; ++k) {
        if (weights[k] <= 1e-12) continue;
        kept.push_back(points[static_cast<std::size_t>(k)]);
        values.push_back(weights[k]);
      }
      points = kept;
      weights = Eigen::Map<Eigen::VectorXd>(values.data(), static_cast<Eigen::Index>(values.size()));
    }
    x.setZero();
    for (std::size_t k = 0; k < points.size(); ++k) x += weights[static_cast<Eigen::Index>(k)] * points[k];
  }
  return x.norm();
}

}  // namespace sinew::test
