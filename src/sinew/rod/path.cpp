#include "sinew/rod/path.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "sinew/lie/rotation.hpp"
#include "sinew/rod/kinematics.hpp"

namespace sinew::rod {

Path::Path(const std::vector<Vec3>& points) {
  const int n = static_cast<int>(points.size());
  std::vector<double> chord(n, 0.0);
  for (int i = 1; i < n; ++i) chord[i] = chord[i - 1] + (points[i] - points[i - 1]).norm();
  std::vector<Vec3> slope(n);  // dx / dchord at the points
  const auto secant = [&](int a, int b) -> Vec3 { return (points[b] - points[a]) / (chord[b] - chord[a]); };
  for (int i = 1; i + 1 < n; ++i) {  // the parabola through three neighbours
    const double before = chord[i] - chord[i - 1], after = chord[i + 1] - chord[i];
    slope[i] = (after * secant(i - 1, i) + before * secant(i, i + 1)) / (before + after);
  }
  // At the ends, no curvature change: straight if the rod has two points.
  slope[0] = n > 2 ? Vec3(2.0 * secant(0, 1) - slope[1]) : secant(0, 1);
  slope[n - 1] = n > 2 ? Vec3(2.0 * secant(n - 2, n - 1) - slope[n - 2]) : secant(0, 1);
  constexpr int kSamples = 64;  // per piece; the arc length's error falls with their fourth power
  for (int i = 0; i + 1 < n; ++i) {
    const double h = chord[i + 1] - chord[i];
    for (int k = i == 0 ? 0 : 1; k <= kSamples; ++k) {
      const double t = static_cast<double>(k) / kSamples, t2 = t * t, t3 = t2 * t;
      const Vec3 x = (2 * t3 - 3 * t2 + 1) * points[i] + (t3 - 2 * t2 + t) * h * slope[i] +
                     (3 * t2 - 2 * t3) * points[i + 1] + (t3 - t2) * h * slope[i + 1];
      const Vec3 d = (6 * t2 - 6 * t) / h * (points[i] - points[i + 1]) + (3 * t2 - 4 * t + 1) * slope[i] +
                     (3 * t2 - 2 * t) * slope[i + 1];
      const Vec3 unit = d.normalized();
      if (!x_.empty()) {  // chord corrected for its bend: exact for a circular arc to fourth order
        const double c = (x - x_.back()).norm();
        const double turn = std::atan2(t_.back().cross(unit).norm(), t_.back().dot(unit));
        arc_.push_back(arc_.back() + c * (1.0 + turn * turn / 24.0));
      } else {
        arc_.push_back(0.0);
      }
      x_.push_back(x);
      t_.push_back(unit);
    }
  }
}

namespace {
/// Index of the sample before s, and the fraction to the next.
std::pair<std::size_t, double> bracket(const std::vector<double>& arc, double s) {
  const auto after = std::upper_bound(arc.begin() + 1, arc.end() - 1, s);
  const std::size_t i = static_cast<std::size_t>(after - arc.begin()) - 1;
  return {i, (s - arc[i]) / (arc[i + 1] - arc[i])};
}
}  // namespace

Vec3 Path::position(double s) const {
  const auto [i, t] = bracket(arc_, s);
  return (1.0 - t) * x_[i] + t * x_[i + 1];
}

Vec3 Path::tangent(double s) const {
  const auto [i, t] = bracket(arc_, s);
  return ((1.0 - t) * t_[i] + t * t_[i + 1]).normalized();
}

Mat3 frame_along(const Vec3& tangent, const Vec3& up) {
  const Vec3 x = tangent.normalized();
  for (const Vec3& candidate : {up, Vec3(Vec3::UnitY()), Vec3(Vec3::UnitZ())}) {
    const Vec3 across = candidate - candidate.dot(x) * x;
    if (across.norm() < 1e-6 * candidate.norm()) continue;
    Mat3 R;
    R.col(0) = x;
    R.col(1) = across.normalized();
    R.col(2) = R.col(0).cross(R.col(1));
    return R;
  }
  return Mat3::Identity();  // not reached: y and z are not both parallel to x
}

Layout lay_along(const Path& path, const std::vector<double>& ends, const Vec3& up) {
  const int N = static_cast<int>(ends.size()) - 1;
  Layout layout;
  layout.base = {frame_along(path.tangent(0.0), up), path.position(0.0)};

  // Mean curvature of each section: the rotation from its first to its last tangent, carried along in small steps.
  layout.strains.setZero(6, N);
  Mat3 R = layout.base.R;
  for (int i = 0; i < N; ++i) {
    const Mat3 start = R;
    constexpr int kSteps = 16;
    for (int k = 1; k <= kSteps; ++k) {
      const Vec3 t = path.tangent(ends[i] + (ends[i + 1] - ends[i]) * k / kSteps);
      R = lie::exp(lie::shortest_rotation(R.col(0), t)) * R;
    }
    layout.strains.col(i).head<3>() = lie::log(start.transpose() * R) / (ends[i + 1] - ends[i]);
    layout.strains(0, i) = 0.0;
  }

  // Levenberg-Marquardt on the two bendings: section ends onto the path.
  Rod rod;
  rod.ends = ends;
  rod.basis = {1, 2};
  rod.fixed.setZero(6, N);
  Eigen::VectorXd q(2 * N);
  for (int i = 0; i < N; ++i) q.segment<2>(2 * i) = layout.strains.block<2, 1>(1, i);
  const auto residual = [&](const Eigen::VectorXd& trial) {
    const Configuration shape = configure(rod, layout.base, trial);
    Eigen::VectorXd r(3 * N);
    for (int i = 1; i <= N; ++i) r.segment<3>(3 * i - 3) = shape.p[i] - path.position(ends[i]);
    return r;
  };
  Eigen::VectorXd r = residual(q);
  // Positions are met only as far as the curvatures stay near those of the path: one section length of displacement
  // weighs as much as one unit of turning, so that fitted rods do not wave between their section ends.
  const double stay = 1e-2;
  const Eigen::VectorXd q0 = q;
  for (int iteration = 0; iteration < 10 && r.norm() > 1e-12 * path.length(); ++iteration) {
    const Configuration shape = configure(rod, layout.base, q);
    Eigen::MatrixXd J(3 * N, 2 * N);
    for (int i = 1; i <= N; ++i) J.middleRows<3>(3 * i - 3) = position_jacobian(shape, ends[i]);
    Eigen::VectorXd weight(2 * N);
    for (int i = 0; i < N; ++i) {
      const double l = ends[i + 1] - ends[i];
      weight.segment<2>(2 * i).setConstant(stay * stay * l * l * l * l);
    }
    Eigen::MatrixXd normal = J.transpose() * J;
    normal.diagonal() += weight;
    const Eigen::VectorXd dq = -normal.ldlt().solve(J.transpose() * r + weight.cwiseProduct(q - q0));
    q += dq;
    r = residual(q);
    if (dq.norm() <= 1e-12 * (1.0 + q.norm())) break;
  }
  for (int i = 0; i < N; ++i) layout.strains.block<2, 1>(1, i) = q.segment<2>(2 * i);
  for (int i = 0; i < N; ++i) layout.deviation = std::max(layout.deviation, r.segment<3>(3 * i).norm());
  return layout;
}

}  // namespace sinew::rod
