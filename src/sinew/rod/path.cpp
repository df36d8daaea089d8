#include "sinew/rod/path.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "sinew/lie/rotation.hpp"
#include "sinew/rod/forces.hpp"

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

namespace {

/// Mean curvature of each section: the rotation from its first to its last tangent, carried along in small steps.
std::vector<Vec3> mean_curvatures(const Path& path, const std::vector<double>& ends, Mat3 R) {
  std::vector<Vec3> curvatures;
  for (std::size_t i = 0; i + 1 < ends.size(); ++i) {
    const Mat3 start = R;
    constexpr int kSteps = 16;
    for (int k = 1; k <= kSteps; ++k) {
      const Vec3 t = path.tangent(ends[i] + (ends[i + 1] - ends[i]) * k / kSteps);
      R = lie::exp(lie::shortest_rotation(R.col(0), t)) * R;
    }
    curvatures.emplace_back(lie::log(start.transpose() * R) / (ends[i + 1] - ends[i]));
  }
  return curvatures;
}

/// A rod that may only bend, and points on it that shall lie on the path: as many a section as it has degrees of
/// freedom.
struct Fit {
  Rod rod;
  Placement base;
  std::vector<double> at;
  std::vector<Vec3> goal;
  Eigen::VectorXd stay;  ///< weight of the change of each coordinate

  Fit(const Path& path, const std::vector<double>& ends, int degree, const Placement& start) : base(start) {
    Discretisation cut;
    cut.ends = ends;
    cut.modes = modes_of({1, 2}, {0, degree, degree, 0, 0, 0});
    rod = make_rod(cut, {});
    stay.resize(rod.strain_coordinates());
    for (int i = 0; i < rod.count(); ++i) {
      const double l = rod.sections[i].length();
      // Positions are met only as far as the curvatures stay near those of the path: one section length of
      // displacement weighs as much as one unit of turning, so that fitted rods do not wave between their section ends.
      stay.segment(rod.first[i], rod.first[i + 1] - rod.first[i]).setConstant(1e-4 * l * l * l * l);
      for (int k = 1; k <= degree + 1; ++k) {
        at.push_back(rod.sections[i].begin + l * k / (degree + 1));
        goal.push_back(path.position(at.back()));
      }
    }
  }

  /// Gradient and Gauss-Newton matrix of 1/2 |gaps|^2 + 1/2 |q - q0|^2_stay, and the largest gap.
  double linearize(const Eigen::VectorXd& q, const Eigen::VectorXd& q0, Eigen::VectorXd& gradient,
                   linalg::Chain& matrix) const {
    const Configuration shape = configure(rod, base, q);
    std::vector<PointLoad> pulls, weights;
    double largest = 0.0;
    for (std::size_t i = 0; i < at.size(); ++i) {
      const Vec3 gap = position(shape, at[i]) - goal[i];
      largest = std::max(largest, gap.norm());
      pulls.push_back({at[i], Vec3::Zero(), gap});
      weights.push_back({at[i], Vec3::Zero(), Vec3::Zero(), 1.0});
    }
    Equations forces = make_equations(shape, true), inertia = make_equations(shape, true);
    add_loads(shape, pulls, forces);
    add_loads(shape, weights, inertia);
    gradient = forces.r + stay.cwiseProduct(q - q0);
    matrix = inertia.chain;
    for (int i = 0; i < rod.count(); ++i)
      matrix.block(i).diagonal() += stay.segment(rod.first[i], rod.first[i + 1] - rod.first[i]);
    return largest;
  }
};

}  // namespace

Layout lay_along(const Path& path, const std::vector<double>& ends, const Vec3& up, int degree) {
  Layout layout;
  layout.base = {frame_along(path.tangent(0.0), up), path.position(0.0)};
  const Fit fit(path, ends, degree, layout.base);
  const std::vector<Vec3> curvatures = mean_curvatures(path, ends, layout.base.R);
  Eigen::VectorXd q = Eigen::VectorXd::Zero(fit.rod.strain_coordinates());
  for (int i = 0; i < fit.rod.count(); ++i) {
    for (std::size_t c = 0; c < fit.rod.sections[i].modes.size(); ++c) {
      const Mode& mode = fit.rod.sections[i].modes[c];
      if (mode.degree == 0) q[fit.rod.first[i] + static_cast<int>(c)] = curvatures[i][mode.strain];
    }
  }
  const Eigen::VectorXd q0 = q;
  Eigen::VectorXd gradient;
  linalg::Chain matrix;
  for (int iteration = 0; iteration < 10; ++iteration) {
    layout.deviation = fit.linearize(q, q0, gradient, matrix);
    linalg::ChainFactor factor;
    if (layout.deviation <= 1e-12 * path.length() || !factor.factor(matrix)) break;
    Eigen::VectorXd dq = gradient;
    factor.solve(dq);
    q -= dq;
    if (dq.norm() <= 1e-12 * (1.0 + q.norm())) break;
  }
  layout.deviation = fit.linearize(q, q0, gradient, matrix);
  for (int i = 0; i < fit.rod.count(); ++i)
    layout.strains.push_back(strain_coefficients(fit.rod.sections[i], fit.rod.of_section(q, i)));
  return layout;
}

}  // namespace sinew::rod
