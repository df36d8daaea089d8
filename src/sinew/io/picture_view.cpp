#include "sinew/io/picture_view.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

namespace sinew::io {
namespace {

using Vec3 = Eigen::Vector3d;
using Mat3 = Eigen::Matrix3d;

constexpr double kTurn = 22 * std::numbers::pi / 180, kTilt = 17 * std::numbers::pi / 180;
constexpr double kSnap = 0.866;  ///< cosine of the angle within which a world axis is taken instead

struct Bounds {
  Vec3 lower = Vec3::Constant(INFINITY), upper = Vec3::Constant(-INFINITY);
  void add(const Vec3& point, double radius) {
    lower = lower.cwiseMin(Vec3(point.array() - radius));
    upper = upper.cwiseMax(Vec3(point.array() + radius));
  }
  Vec3 centre() const { return 0.5 * lower + 0.5 * upper; }
  Vec3 extent() const { return upper - lower; }
};

/// World axis that is most across `direction`; of equals y, then x, then z.
Vec3 axis_across(const Vec3& direction) {
  Vec3 best = Vec3::UnitY();
  for (const Vec3& axis : {Vec3(Vec3::UnitX()), Vec3(Vec3::UnitZ())})
    if (std::abs(axis.dot(direction)) < std::abs(best.dot(direction)) - 1e-3) best = axis;
  return best;
}

/// Direction of least extent, of points given about their centre and of size 1.
Vec3 shortest_axis(const Mat3& covariance) {
  const Eigen::SelfAdjointEigenSolver<Mat3> principal(covariance);
  const Vec3& spread = principal.eigenvalues();
  const Vec3 longest = principal.eigenvectors().col(2);
  if (!(spread(2) > 0.0)) return Vec3::UnitZ();
  Vec3 normal = principal.eigenvectors().col(0);
  if (spread(0) > 0.7 * spread(1)) {  // as deep as wide: nothing to choose from but the world's axes
    const Vec3 across = axis_across(longest);
    normal = (across - across.dot(longest) * longest).normalized();
  }
  for (int i = 0; i < 3; ++i)
    if (std::abs(normal(i)) > kSnap) return Vec3::Unit(i);
  return normal;
}

/// Rows right, up, towards the viewer for a look along -normal.
Mat3 upright(Vec3 normal, Vec3 up) {
  const bool given = up.allFinite() && up.norm() > 0.0;
  if (given) up.normalize();
  if (!given || std::abs(up.dot(normal)) > 0.8) up = std::abs(normal.z()) < 0.7 ? Vec3::UnitZ() : Vec3::UnitY();
  if (std::abs(up.dot(normal)) > 0.99) up = Vec3::UnitX();
  Vec3 right = up.cross(normal).normalized();
  Eigen::Index main = 0;
  right.cwiseAbs().maxCoeff(&main);
  if (right(main) < 0.0) {  // the world's axes run to the right
    right = -right;
    normal = -normal;
  }
  const Vec3 screen_up = normal.cross(right);
  const Vec3 toward =
      std::cos(kTilt) * (std::cos(kTurn) * normal + std::sin(kTurn) * right) + std::sin(kTilt) * screen_up;
  Mat3 axes;
  axes.row(0) = screen_up.cross(toward).normalized();
  axes.row(2) = toward;
  axes.row(1) = toward.cross(axes.row(0).transpose());
  return axes;
}

}  // namespace

bool drawable(const Vec3& point) { return point.allFinite() && point.cwiseAbs().maxCoeff() < 1e30; }

PictureView choose_view(const std::vector<Sight>& sights, const Vec3& up, const Area& area) {
  PictureView view;
  view.middle = {(area.left + area.right) / 2, (area.top + area.bottom) / 2};
  Bounds bounds;
  for (const Sight& sight : sights)
    if (drawable(sight.point)) bounds.add(sight.point, sight.radius);
  if (!(bounds.lower.x() <= bounds.upper.x())) {  // nothing at all
    view.axes = upright(Vec3::UnitZ(), up);
    view.scale = (area.right - area.left) / 2;
    return view;
  }
  view.centre = bounds.centre();
  double size = bounds.extent().maxCoeff();
  const double roundoff = 1e-12 * bounds.lower.cwiseAbs().cwiseMax(bounds.upper.cwiseAbs()).maxCoeff();
  Mat3 covariance = Mat3::Zero();
  if (size > roundoff && size > 1e-100) {
    for (const Sight& sight : sights) {
      if (!drawable(sight.point)) continue;
      const Vec3 arm = (sight.point - view.centre) / size;
      covariance += arm * arm.transpose() / static_cast<double>(sights.size());
    }
  } else {
    size = std::max(roundoff, 1e-100);
    if (roundoff == 0.0) size = 1.0;
  }
  view.axes = upright(shortest_axis(covariance), up);

  Bounds seen;  // in sizes, on the page
  for (const Sight& sight : sights)
    if (drawable(sight.point)) seen.add(view.axes * ((sight.point - view.centre) / size), sight.radius / size);
  const Vec3 extent = seen.extent();
  const double across = std::max(extent.x(), 1e-3) / (area.right - area.left);
  const double high = std::max(extent.y(), 1e-3) / (area.bottom - area.top);
  view.scale = 1.0 / (size * std::max(across, high));
  view.centre += view.axes.transpose() * (size * seen.centre());
  return view;
}

}  // namespace sinew::io
