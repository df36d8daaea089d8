#include "sinew/sim/contact_folds.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <vector>

namespace sinew {

namespace {

using Kind = Collider::Kind;

/// Bounds of the derivatives of an axis x within a section by its abscissa, x' = R v and x'' = R (k x v + v'): Legendre
/// polynomials are at most 1, their derivatives d (d + 1) / 2.
struct Bounds {
  double first = 0.0, second = 0.0;  ///< [-], [1/m]
};
Bounds bounds_of(const rod::Configuration& shape, int section) {
  const rod::Coefficients& strains = shape.strains[section];
  double turn = 0.0, stretch = 0.0, change = 0.0;
  for (Eigen::Index d = 0; d < strains.cols(); ++d) {
    const double part = strains.col(d).tail<3>().norm();
    turn += strains.col(d).head<3>().norm();
    stretch += part;
    change += 0.5 * static_cast<double>(d * (d + 1)) * part;
  }
  return {stretch, turn * stretch + 2.0 / shape.rod->sections[section].length() * change};
}

/// The axis of a rod on its way past a rigid shape, as that sees it.
class Axis {
 public:
  Axis(const StepMotion& motion, const Collider& bent, const Collider& hard, double thin)
      : rod_(motion.end.model.rods[bent.number]),
        shape_(shape_of(motion.end.model, hard)),
        from_(motion.start.rods[bent.number]),
        to_(motion.end.rods[bent.number]),
        start_(motion.start.pose(hard)),
        end_(motion.end.pose(hard)),
        reach_(contact::reach(shape_, Eigen::Matrix3d::Identity())),
        enough_(0.05 * thin),
        aimed_(0.02 * thin) {
    for (int i = 0; i < rod_.rod.count(); ++i) {
      bounds_from_.push_back(bounds_of(from_, i));
      bounds_to_.push_back(bounds_of(to_, i));
    }
  }

  /// By how much more any of its places moves than the farthest of the points by which it touches [m] at most.
  double moves_more() const {
    double most = 0.0;
    for (std::size_t i = 0; i + 1 < rod_.touching.size(); ++i) {
      const double piece = rod_.touching[i + 1] - rod_.touching[i];
      const int section = rod_.rod.section_at(0.5 * (rod_.touching[i] + rod_.touching[i + 1]));
      most = std::max(most, 0.125 * piece * piece * (bounds_from_[section].second + bounds_to_[section].second));
    }
    return most;
  }

  /// The deepest place found at a part `t` of the way [m], and a bound of all; negative where they are outside.
  struct Depth {
    double found = -INFINITY, most = -INFINITY;
  };
  Depth at(double t) {
    t_ = t;
    pose_ = pose_between(start_, end_, t);
    depth_ = {};
    int section = -1;
    double within = 0.0;  // a bound of the depth of that section, less its thickness
    for (std::size_t i = 0; i + 1 < rod_.touching.size(); ++i) {
      const double a = rod_.touching[i], b = rod_.touching[i + 1];
      if (const int number = rod_.rod.section_at(0.5 * (a + b)); number != section) {
        section = number;
        bounds_ = {std::lerp(bounds_from_[number].first, bounds_to_[number].first, t),
                   std::lerp(bounds_from_[number].second, bounds_to_[number].second, t)};
        within = rod_.rod.sections[number].length() * bounds_.first - outside(local(from_.p[number], to_.p[number]));
      }
      const double most = within + std::max(rod::radius_at(rod_.rod.profile, a), rod::radius_at(rod_.rod.profile, b));
      if (most > enough()) {
        look(a, b);
      } else {
        depth_.most = std::max(depth_.most, most);
      }
    }
    return depth_;
  }

 private:
  double enough() const { return std::max(enough_, depth_.found + aimed_); }

  Vec3 local(const Vec3& from, const Vec3& to) const {
    return pose_.R.transpose() * (from + t_ * (to - from) - pose_.p);
  }

  /// How far a place is outside the box of the shape along the axis where that is most; negative inside.
  double outside(const Vec3& place) const { return (place.cwiseAbs() - reach_).maxCoeff(); }

  double depth_at(double s) const {
    const Vec3 to = rod::position(to_, s);  // (where it ends it is looked at at each step)
    const Vec3 place = local(t_ < 1.0 ? rod::position(from_, s) : to, to);
    return -gap_to_shape(shape_, place, rod::radius_at(rod_.rod.profile, s));
  }

  void look(double a, double b) {
    const double s = 0.5 * (a + b), half = 0.5 * (b - a), depth = depth_at(s);
    depth_.found = std::max(depth_.found, depth);
    double most = depth + half * bounds_.first;
    if (most > enough()) {
      const double near = 1e-3 * half, slope = std::max({0.0, depth - depth_at(s - near), depth - depth_at(s + near)});
      most = std::min(most, depth + half * slope / near + 0.5 * half * (half + near) * bounds_.second);
    }
    if (most > enough() && half * bounds_.first > 0.5 * aimed_) {
      look(a, s);
      look(s, b);
    } else {
      depth_.most = std::max(depth_.most, most);
    }
  }

  const RodModel& rod_;
  const contact::Shape& shape_;
  const rod::Configuration &from_, &to_;
  contact::Pose start_, end_, pose_;
  Vec3 reach_;
  double enough_, aimed_;                        ///< [m] what need not be known, and how well the rest is to be
  std::vector<Bounds> bounds_from_, bounds_to_;  ///< of each section
  double t_ = 0.0;
  Bounds bounds_;  ///< there, of the section that is looked at
  Depth depth_;
};

}  // namespace

FoldDepth depth_of_fold(const StepMotion& motion, const PairModel& pair, double speed, double thin) {
  FoldDepth deepest;
  const bool first = pair.a.kind == Kind::rod;
  const Collider &bent = first ? pair.a : pair.b, &hard = first ? pair.b : pair.a;
  if (bent.kind != Kind::rod || !is_shape(motion.end.model, hard)) return deepest;
  Axis axis(motion, bent, hard, thin);
  deepest.end = std::max(0.0, axis.at(1.0).found);
  speed += axis.moves_more();
  if (!(speed > 0.5 * thin)) return deepest;
  const double shortest = shortest_look(speed, thin);
  for (double t = 0.0; t < 1.0;) {
    const Axis::Depth depth = axis.at(t);
    deepest.way = std::max(deepest.way, depth.found);
    t += std::max(-depth.most / speed, shortest);
  }
  return deepest;
}

}  // namespace sinew
