// From where a picture looks, chosen from what there is to see.
#pragma once

#include <Eigen/Core>
#include <vector>

namespace sinew::io {

/// A region of the page [px], y downwards.
struct Area {
  double left = 0.0, top = 0.0, right = 0.0, bottom = 0.0;
  bool holds(const Area& other) const {
    return left <= other.left && top <= other.top && other.right <= right && other.bottom <= bottom;
  }
  bool meets(const Area& other) const {
    return left < other.right && other.left < right && top < other.bottom && other.top < bottom;
  }
};

/// A thing to be kept in sight: a point, or a ball around it.
struct Sight {
  Eigen::Vector3d point;  ///< [m]
  double radius = 0.0;    ///< [m]
};

/// Parallel projection.
struct PictureView {
  Eigen::Matrix3d axes = Eigen::Matrix3d::Identity();  ///< rows: right, up, towards the viewer
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();    ///< [m] what is in the middle
  Eigen::Vector2d middle = Eigen::Vector2d::Zero();    ///< [px] where that is
  double scale = 1.0;                                  ///< [px/m]

  /// x [px], y [px] downwards, depth [px] towards the viewer.
  Eigen::Vector3d project(const Eigen::Vector3d& point) const {
    const Eigen::Vector3d seen = scale * (axes * (point - centre));
    return {middle.x() + seen.x(), middle.y() - seen.y(), seen.z()};
  }
};

/// Whether a point can be drawn: finite, and of a size with which one can reckon.
bool drawable(const Eigen::Vector3d& point);

/// Looks along the shortest of the three principal axes of all sights (from a world axis when that is near), turned and
/// tilted a little so that depth is seen, and fills the area. `up` is upright on the page if it is given (not zero) and
/// does not point at the viewer; else it is z, or y when one looks along z. Any input gives a finite view.
PictureView choose_view(const std::vector<Sight>& sights, const Eigen::Vector3d& up, const Area& area);

}  // namespace sinew::io
