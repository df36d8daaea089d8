#include "sinew/sim/contact_folds.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <optional>

namespace sinew {

namespace {

using Kind = Collider::Kind;

constexpr int kPlacesOfPiece = 4;  ///< that are looked at, its first end among them

/// The axis of a rod on its way past a rigid shape, as that sees it.
class Axis {
 public:
  Axis(const StepMotion& motion, const Collider& bent, const Collider& hard)
      : rod_(motion.end.model.rods[bent.number]),
        shape_(shape_of(motion.end.model, hard)),
        from_(motion.start.rods[bent.number]),
        to_(motion.end.rods[bent.number]),
        start_(motion.start.pose(hard)),
        end_(motion.end.pose(hard)),
        reach_(contact::reach(shape_, Eigen::Matrix3d::Identity())) {}

  /// How deep it lies in the shape between the points by which it touches [m], at a part `t` of the way; negative where
  /// it is outside by at least as much.
  double depth(double t) {
    go_to(t);
    double deepest = -INFINITY;
    for (std::size_t i = 0; i + 1 < rod_.touching.size(); ++i) {
      const double between = (rod_.touching[i + 1] - rod_.touching[i]) / kPlacesOfPiece;
      double deepest_here = -INFINITY, there = 0.0;
      for (int k = 1; k < kPlacesOfPiece; ++k) {
        const double s = rod_.touching[i] + k * between;
        const double own = depth_at(s, deepest_here);
        if (own > deepest_here) {
          deepest_here = own;
          there = s;
        }
      }
      if (deepest_here > 0.0) deepest_here = std::max(deepest_here, depth_at_vertex(there, between, deepest_here));
      deepest = std::max(deepest, deepest_here);
    }
    return deepest;
  }

 private:
  void go_to(double t) {
    t_ = t;
    pose_ = pose_between(start_, end_, t);
    section_ = -1;
  }

  Vec3 local(const Vec3& from, const Vec3& to) const {
    return pose_.R.transpose() * (from + t_ * (to - from) - pose_.p);
  }
  /// (Where it ends it is looked at at each step.)
  Vec3 local(double s) const {
    const Vec3 to = rod::position(to_, s);
    return local(t_ < 1.0 ? rod::position(from_, s) : to, to);
  }

  /// How far a place is outside the box of the shape along the axis where that is most; negative inside.
  double outside(const Vec3& local) const { return (local.cwiseAbs() - reach_).maxCoeff(); }

  /// What the axis of a section may be long at most [m]: Legendre polynomials are at most 1.
  static double longest(const rod::Configuration& shape, int section) {
    const rod::Section& own = shape.rod->sections[section];
    return own.length() * shape.strains[section].bottomRows<3>().colwise().norm().sum();
  }

  /// A place that is no deeper than `least` need not be looked at closely.
  double depth_at(double s, double least) {
    const double radius = rod::radius_at(rod_.rod.profile, s);
    if (const int own = rod_.rod.section_at(s); own != section_) {
      section_ = own;
      const double reached = (1.0 - t_) * longest(from_, own) + t_ * longest(to_, own);
      away_ = outside(local(from_.p[own], to_.p[own])) - reached;
    }
    if (away_ >= radius || away_ - radius > -least) return radius - away_;
    const Vec3 place = local(s);
    if (const double far = outside(place); far >= radius) return radius - far;
    return -gap_to_shape(shape_, place, radius);
  }

  /// The lowest place of a sharp fold lies between those looked at: at the vertex of the parabola through three.
  double depth_at_vertex(double s, double between, double depth) const {
    const auto depth_of = [&](double place) {
      return -gap_to_shape(shape_, local(place), rod::radius_at(rod_.rod.profile, place));
    };
    const double before = depth_of(s - between), after = depth_of(s + between);
    const double bend = 2.0 * depth - before - after, lean = after - before;
    return std::abs(lean) < bend ? depth_of(s + 0.5 * between * lean / bend) : depth;
  }

  const RodModel& rod_;
  const contact::Shape& shape_;
  const rod::Configuration &from_, &to_;
  contact::Pose start_, end_, pose_;
  Vec3 reach_;
  double t_ = 0.0;
  int section_ = -1;
  double away_ = 0.0;  ///< at least so far outside, along one axis of the shape's box, is the axis of that section
};

/// The axis of the rod and the shape that a pair may be of.
std::optional<Axis> axis_of(const StepMotion& motion, const PairModel& pair) {
  const bool first = pair.a.kind == Kind::rod;
  const Collider &bent = first ? pair.a : pair.b, &hard = first ? pair.b : pair.a;
  if (bent.kind != Kind::rod || !is_shape(motion.end.model, hard)) return std::nullopt;
  return Axis(motion, bent, hard);
}

}  // namespace

double deepest_between(const StepMotion& motion, const PairModel& pair) {
  std::optional<Axis> axis = axis_of(motion, pair);
  return axis ? std::max(0.0, axis->depth(1.0)) : 0.0;
}

double deepest_between_on_way(const StepMotion& motion, const PairModel& pair, double speed, double thin) {
  std::optional<Axis> axis = axis_of(motion, pair);
  double deepest = 0.0;
  if (!axis) return deepest;
  const double shortest = shortest_look(speed, thin);
  for (double t = 0.0; t < 1.0;) {
    const double depth = axis->depth(t);
    deepest = std::max(deepest, depth);
    t += std::max(-depth / speed, shortest);
  }
  return deepest;
}

}  // namespace sinew
