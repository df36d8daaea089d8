#include "sinew/sim/contact_patches.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <map>
#include <optional>

namespace sinew {

namespace {

using contact::Simplex;
using Vec2 = Eigen::Vector2d;

constexpr double kSameNormal = 1e-7;  ///< sine of the angle between two that are one
constexpr double kSamePlane = 1e-7;   ///< of the scene's size
constexpr double kStraight = 1e-9;    ///< sine of the turn at a corner that is none
constexpr int kMostTurns = 100;       ///< of a plane, until it lies

/// A point that faces a plane.
struct Foot {
  std::size_t contact = 0;  ///< its number
  Vec3 normal, place;       ///< place: on the plane [m]
  double gap = 0.0;         ///< [m]
  Vec2 at = Vec2::Zero();   ///< the place in axes of the plane [m]
};

bool is_face(const Simplex& own) {
  return (own.kind == Simplex::Kind::triangle && own.valley < 0) || own.kind == Simplex::Kind::plane;
}

bool is_point(const Simplex& own) { return own.kind == Simplex::Kind::point && own.rim.isZero(0.0); }

/// Which plane it is, but for rounding: its normal in millionths, its distance from the scene's middle in millionths of
/// the scene's size, and whose it is. (What rounding parts gives two patches.)
using PlaneKey = std::array<std::int64_t, 5>;
PlaneKey key_of(const Vec3& normal, const Vec3& place, const Model& model, bool of_first) {
  constexpr double kMillion = 1e6;
  const double away = normal.dot(place - model.middle) / model.size;
  return {std::llround(kMillion * normal.x()), std::llround(kMillion * normal.y()), std::llround(kMillion * normal.z()),
          std::llround(kMillion * std::clamp(away, -kMillion, kMillion)), of_first ? 1 : 0};
}

double cross(const Vec2& d, const Vec2& e) { return d.x() * e.y() - d.y() * e.x(); }

double sine_between(const Vec2& d, const Vec2& e) { return cross(d, e) / (d.norm() * e.norm()); }

/// The corners of the convex hull of feet, to the left (Andrew's monotone chain), without those along its edges.
std::vector<Foot> corners_of(std::vector<Foot> feet) {
  std::sort(feet.begin(), feet.end(), [](const Foot& one, const Foot& other) {
    return one.at.x() != other.at.x() ? one.at.x() < other.at.x() : one.at.y() < other.at.y();
  });
  std::vector<Foot> hull;
  for (int half = 0; half < 2; ++half) {
    const std::size_t first = hull.size();
    for (const Foot& next : feet) {
      while (hull.size() >= first + 2 &&
             !(cross(hull.back().at - hull[hull.size() - 2].at, next.at - hull.back().at) > 0.0))
        hull.pop_back();
      hull.push_back(next);
    }
    hull.pop_back();  // the other half begins with it
    std::reverse(feet.begin(), feet.end());
  }
  // (A corner is dropped against the one before it that stays, so that many small turns are not lost.)
  for (std::size_t i = 0; i < hull.size() && hull.size() > 3;) {
    const Vec2 &before = hull[(i + hull.size() - 1) % hull.size()].at, &after = hull[(i + 1) % hull.size()].at;
    if (sine_between(hull[i].at - before, after - hull[i].at) > kStraight)
      ++i;
    else
      hull.erase(hull.begin() + static_cast<std::ptrdiff_t>(i));
  }
  return hull;
}

bool is_within(const std::vector<Foot>& corners, const Vec2& at) {
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Vec2 edge = corners[(i + 1) % corners.size()].at - corners[i].at, way = at - corners[i].at;
    if (sine_between(edge, way) < -kStraight) return false;  // (at the corner itself it is no number)
  }
  return corners.size() > 2;
}

/// gap = at_zero + slope . at.
struct Plane {
  double at_zero = 0.0;
  Vec2 slope = Vec2::Zero();
  double operator()(const Vec2& at) const { return at_zero + slope.dot(at); }
};

/// The plane below all gaps that is highest in the middle of the patch: on three feet with the middle between them, as
/// a table that is let down on them comes to lie. From the lowest foot it is tilted up towards the middle until it
/// meets the next one, and from then on about the edge beyond which the middle is. Feet nearer than `fine` [m] are met.
/// Empty where the feet lie in a line.
std::optional<Plane> resting_plane(const std::vector<Foot>& patch, double fine) {
  Vec2 middle = Vec2::Zero();
  for (const Foot& foot : patch) middle += foot.at / static_cast<double>(patch.size());
  const Foot lowest = *std::min_element(patch.begin(), patch.end(),
                                        [](const Foot& one, const Foot& other) { return one.gap < other.gap; });
  Vec2 from = lowest.at;
  Plane plane{lowest.gap, Vec2::Zero()};
  double risen = 0.0;  // [m] by the last tilt, at the foot that it met
  // Tilts it about a line through `from` up along `along` until it meets a foot; returns the farthest that it meets.
  const auto tilt = [&](const Vec2& along) -> const Foot* {
    const auto way = [&](const Foot& foot) { return along.dot(foot.at - from); };
    const auto is_ahead = [&](const Foot& foot) {
      return way(foot) > kStraight * along.norm() * (foot.at - from).norm();
    };
    double slope = INFINITY;
    for (const Foot& foot : patch)
      if (is_ahead(foot)) slope = std::min(slope, (foot.gap - plane(foot.at)) / way(foot));
    if (std::isinf(slope)) return nullptr;
    plane.slope += slope * along;
    plane.at_zero -= slope * along.dot(from);
    const Foot* met = nullptr;
    for (const Foot& foot : patch)
      if (is_ahead(foot) && foot.gap - plane(foot.at) <= fine && (!met || way(foot) > way(*met))) met = &foot;
    risen = met ? slope * way(*met) : 0.0;
    return met;
  };
  if (middle == from) return plane;
  const Foot* met = tilt(middle - from);
  if (!met) return std::nullopt;
  Vec2 to = met->at;
  for (int turn = 0; turn < kMostTurns; ++turn) {
    const Vec2 edge = to - from;
    const double side = cross(edge, middle - from) < 0.0 ? -1.0 : 1.0;
    met = tilt(side * Vec2(-edge.y(), edge.x()));
    if (!met) return std::nullopt;
    if (risen <= fine) return plane;
    // Beyond which of the two new edges the middle is, if any.
    const auto is_beyond = [&](const Vec2& a, const Vec2& b, const Vec2& third) {
      return cross(b - a, middle - a) * cross(b - a, third - a) < 0.0;
    };
    if (is_beyond(from, met->at, to))
      to = met->at;
    else if (is_beyond(to, met->at, from))
      from = met->at;
    else
      return plane;
  }
  return std::nullopt;
}

/// Marks what goes of a patch.
void reduce(std::vector<Foot>& patch, double fine, std::vector<bool>& goes) {
  if (patch.size() <= kWholePatch) return;
  const Vec3 normal = patch.front().normal, u = normal.unitOrthogonal(), v = normal.cross(u);
  for (Foot& foot : patch) {
    if ((foot.normal - normal).norm() > kSameNormal) return;
    const Vec3 from = foot.place - patch.front().place;  // for the sake of the digits
    foot.at = {u.dot(from), v.dot(from)};
  }
  const std::optional<Plane> plane = resting_plane(patch, fine);
  if (!plane) return;
  std::vector<Foot> low;
  std::copy_if(patch.begin(), patch.end(), std::back_inserter(low),
               [&](const Foot& foot) { return foot.gap - (*plane)(foot.at) <= fine; });
  const std::vector<Foot> corners = corners_of(low);
  for (const Foot& foot : patch)
    if (is_within(corners, foot.at)) goes[foot.contact] = true;
  for (const Foot& corner : corners) goes[corner.contact] = false;
}

}  // namespace

void reduce_patches(const Moment& start, std::vector<ContactState>& found) {
  const double fine = kSamePlane * start.model.size;
  std::vector<bool> goes(found.size(), false);
  for (std::size_t first = 0, last = 0; first < found.size(); first = last) {
    while (last < found.size() && found[last].pair == found[first].pair) ++last;
    if (last - first <= kWholePatch || !is_rigid(found[first].a.on) || !is_rigid(found[first].b.on)) continue;
    std::map<PlaneKey, std::vector<Foot>> patches;
    for (std::size_t i = first; i < last; ++i) {
      const Simplex a = start.placed(found[i].a), b = start.placed(found[i].b);
      if (!is_point(a) || !is_face(b)) continue;
      const contact::Nearest near = contact::nearest(a, b);
      const Vec3 place = a.x[0] - (near.gap + a.radius) * near.normal;
      patches[key_of(near.normal, place, start.model, found[i].on_second)].push_back({i, near.normal, place, near.gap});
    }
    for (auto& [key, patch] : patches) reduce(patch, fine, goes);
  }
  std::size_t kept = 0;
  for (std::size_t i = 0; i < found.size(); ++i) {
    if (!goes[i]) found[kept++] = found[i];
  }
  found.resize(kept);
}

}  // namespace sinew
