#include "sinew/contact/meeting.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <optional>
#include <stdexcept>
#include <utility>

namespace sinew::contact {

namespace {

Vec3 into(const Pose& pose, const Vec3& x) { return pose.R.transpose() * (x - pose.p); }

/// A cylinder's rims, each with its lowest point along -n as it rolls, and the points across and opposite, on which it
/// stands. Where all directions are as low but for rounding, it stands on four fixed points, and the lowest comes
/// beside them: within a step the cylinder may tip towards any direction.
void add_rims(const Cylinder& cylinder, const Vec3& n, std::vector<Simplex>& points) {
  Vec3 down(-n.x(), -n.y(), 0.0);
  const bool stands = down.norm() <= kFlatRim;
  down = down.norm() <= 1e-12 ? Vec3(Vec3::UnitX()) : Vec3(down.normalized());
  const Vec3 across(-down.y(), down.x(), 0.0);
  std::vector<Simplex> lowest;
  for (const double end : {-0.5, 0.5}) {
    const Vec3 cap(0.0, 0.0, end * cylinder.length);
    const Simplex rolls = circle_at(cap, Vec3::UnitZ(), cylinder.radius, down);
    points.push_back(stands ? point_at(cap + cylinder.radius * down, 0.0) : rolls);
    for (const Vec3& direction : {across, Vec3(-down), Vec3(-across)})
      points.push_back(point_at(cap + cylinder.radius * direction, 0.0));
    if (stands) lowest.push_back(rolls);
  }
  points.insert(points.end(), lowest.begin(), lowest.end());
}

/// What a meeting is between, and the numbers of the two parts; in all what a double holds exactly.
enum class Kind : std::uint64_t { point, axis, edges, face_of_first, face_of_second };
std::uint64_t key(Kind kind, std::size_t i, std::size_t j = 0) {
  return (static_cast<std::uint64_t>(kind) << 50U) | (static_cast<std::uint64_t>(i) << 25U) | j;
}

bool round(const Shape& shape) { return std::holds_alternative<Ball>(shape) || std::holds_alternative<Capsule>(shape); }

/// The part of a segment from p to q that is in a polyhedron: none where `from` is not before `to`.
struct Stretch {
  double from = 0.0, to = 1.0;
};
Stretch inner_part(const Polyhedron& own, const Vec3& p, const Vec3& q) {
  Stretch part;
  for (std::size_t f = 0; f < own.faces.size(); ++f) {
    const Vec3 &n = own.normals[f], &x = own.corners[own.faces[f][0]];
    const double a = n.dot(p - x), b = n.dot(q - x);
    if (a > 0.0 && b > 0.0) return {1.0, 0.0};
    if (a > 0.0) part.from = std::max(part.from, a / (a - b));
    if (b > 0.0) part.to = std::min(part.to, a / (a - b));
  }
  return part;
}

bool passes(const Polyhedron& own, const Vec3& p, const Vec3& q) {
  const Stretch part = inner_part(own, p, q);
  return part.from < part.to;
}

/// The direction in a face's plane, across one of its edges, into the face.
Vec3 into_face(const Polyhedron& own, int face, std::size_t edge) {
  const Vec3 &x = own.corners[own.edges[edge][0]], &y = own.corners[own.edges[edge][1]];
  Vec3 middle = Vec3::Zero();
  for (const int corner : own.faces[face]) middle += own.corners[corner];
  const Vec3 across = own.normals[face].cross(y - x).normalized();
  return across.dot(middle / static_cast<double>(own.faces[face].size()) - x) < 0.0 ? Vec3(-across) : across;
}

/// Whether a direction out of an edge lies between the normals of its two faces.
bool between_faces(const Polyhedron& own, std::size_t edge, const Vec3& d) {
  const double some = 1e-9 * d.norm();
  return d.dot(into_face(own, own.sides[edge][0], edge)) <= some &&
         d.dot(into_face(own, own.sides[edge][1], edge)) <= some;
}

/// Whether a direction out of a corner lies between the normals of its faces: against all edges that leave it.
bool out_of_corner(const Polyhedron& own, int corner, const Vec3& d) {
  return std::all_of(own.edges.begin(), own.edges.end(), [&](const std::array<int, 2>& edge) {
    if (edge[0] != corner && edge[1] != corner) return true;
    const Vec3 away = own.corners[edge[0] == corner ? edge[1] : edge[0]] - own.corners[corner];
    return d.dot(away) <= 1e-9 * d.norm() * away.norm();
  });
}

/// One shape while it meets another one.
class Meet {
 public:
  Meet(double alarm, std::vector<Meeting>& found) : alarm_(alarm), found_(found) {}

  /// Points of a against the nearest parts of b.
  void points(const std::vector<Simplex>& of_a, const Pose& at, const Shape& b, const Pose& there, bool swapped) {
    for (std::size_t i = 0; i < of_a.size(); ++i) {
      const Simplex part = nearest_part(b, into(there, at * of_a[i].x[0]));
      add(of_a[i], at, part, there, key(Kind::point, i, swapped ? 1 : 0), swapped);
    }
  }

  void add(const Simplex& a, const Pose& at, const Simplex& b, const Pose& there, std::uint64_t part, bool swapped) {
    if (nearest(moved(at, a), moved(there, b)).gap >= alarm_) return;
    found_.push_back({a, b, part, swapped});
  }

  /// A round shape against any other.
  void round_shape(const Shape& a, const Pose& at, const Shape& b, const Pose& there, bool swapped) {
    if (const Ball* ball = std::get_if<Ball>(&a)) {
      points({point_at(Vec3::Zero(), ball->radius)}, at, b, there, swapped);
      return;
    }
    const Capsule& capsule = std::get<Capsule>(a);
    const Vec3 end(0.0, 0.0, 0.5 * capsule.length);
    const Simplex axis = segment_at(-end, end, Vec3::Zero(), capsule.radius);
    const Vec3 from = into(there, at * Vec3(-end)), to = into(there, at * end);
    if (const Convex* convex = std::get_if<Convex>(&b); convex && passes(convex->surface, from, to))
      return axis_inside(axis, at, convex->surface, there, swapped);
    const Cylinder* const barrel = std::get_if<Cylinder>(&b);
    const Polyhedron sides = barrel ? prism(*barrel) : Polyhedron{};
    if (barrel && passes(sides, from, to)) return axis_inside(axis, at, sides, there, swapped);
    points({point_at(-end, capsule.radius), point_at(end, capsule.radius)}, at, b, there, swapped);
    if (const Convex* convex = std::get_if<Convex>(&b)) {
      axis_outside(axis, at, convex->surface, there, swapped, [](std::size_t) { return true; });
    } else if (const Capsule* other = std::get_if<Capsule>(&b)) {
      const Vec3 tip(0.0, 0.0, 0.5 * other->length);
      add(axis, at, segment_at(-tip, tip, Vec3::Zero(), other->radius), there, key(Kind::axis, 0), swapped);
      points({point_at(-tip, other->radius), point_at(tip, other->radius)}, there, a, at, !swapped);
    } else if (barrel) {
      const Vec3 tip(0.0, 0.0, 0.5 * barrel->length);
      const Simplex side = segment_at(-tip, tip, Vec3::Zero(), barrel->radius);
      const Nearest there_is = nearest(moved(at, axis), moved(there, side));
      const bool beside = there_is.b[1] > 0.0 && there_is.b[1] < 1.0;
      if (beside) add(axis, at, side, there, key(Kind::axis, 0), swapped);
      // The rims and, where no part of the barrel is nearest, the prism's sides next to them.
      axis_outside(axis, at, sides, there, swapped, [&](std::size_t e) { return !beside || sides.sides[e][0] < 2; });
    }
  }

  /// Two of Convex.
  void polyhedra(const Shape& first, const Pose& at, const Shape& second, const Pose& there);

  /// Meeting::grazed of those that `polyhedra` has found, from one on.
  void find_grazed(const Pose& at, const Pose& there, std::size_t from) {
    if (!touched_) return;
    for (std::size_t k = from; k < found_.size(); ++k) {
      Meeting& own = found_[k];
      const Simplex a = moved(own.swapped ? there : at, own.a), b = moved(own.swapped ? at : there, own.b);
      const Nearest found = nearest(a, b);
      Vec3 p = Vec3::Zero();
      for (std::size_t i = 0; i < static_cast<std::size_t>(a.corners()); ++i) p += found.a[i] * a.x[i];
      const auto height = [&](const Vec3& x) { return touched_->normal.dot(x - touched_->x[0]); };
      const Vec3 foot = p - found.gap * found.normal;
      if (std::abs(height(p)) <= same_ && std::abs(height(foot)) <= same_) own.grazed = touched_->normal;
    }
  }

 private:
  /// Adds the corners of both that are as near to the other one as any, or as `least`, but for `some` [m], with the
  /// parts that they are near to.
  void nearest_corners(const Shape& first, const Pose& at, const Shape& second, const Pose& there, double some,
                       double least);
  /// The axis of a capsule, in the polyhedron's axes, against its edges and corners. While it is outside, an edge meets
  /// it where the line between their nearest points leaves the edge between its two faces, so that no other part of the
  /// polyhedron is nearer there; likewise a corner. `wanted` chooses edges.
  template <class Wanted>
  void axis_outside(const Simplex& axis, const Pose& at, const Polyhedron& own, const Pose& there, bool swapped,
                    const Wanted& wanted);
  /// Where the axis is in the polyhedron: along the direction in which they are apart soonest, a face's normal or
  /// across axis and an edge.
  void axis_inside(const Simplex& axis, const Pose& at, const Polyhedron& own, const Pose& there, bool swapped);
  double alarm_;
  std::vector<Meeting>& found_;
  std::optional<Simplex> touched_;  ///< plane in the world in which two polyhedra lie beside each other
  double same_ = 0.0;               ///< [m] within which what lies in a plane is in it
};

template <class Wanted>
void Meet::axis_outside(const Simplex& axis, const Pose& at, const Polyhedron& own, const Pose& there, bool swapped,
                        const Wanted& wanted) {
  const Simplex local = segment_at(into(there, at * axis.x[0]), into(there, at * axis.x[1]), Vec3::Zero(), axis.radius);
  std::vector<bool> corners(own.corners.size(), false);
  for (std::size_t e = 0; e < own.edges.size(); ++e) {
    if (!wanted(e)) continue;
    for (const int corner : own.edges[e]) corners[corner] = true;
    const Simplex edge = segment_at(own.corners[own.edges[e][0]], own.corners[own.edges[e][1]], Vec3::Zero(), 0.0);
    const Nearest found = nearest(local, edge);
    const auto within = [](double t) { return t > 0.0 && t < 1.0; };
    if (found.gap >= alarm_ || !within(found.a[1]) || !within(found.b[1])) continue;
    if (between_faces(own, e, found.normal)) add(axis, at, edge_of(own, e), there, key(Kind::axis, 1 + e), swapped);
  }
  for (std::size_t c = 0; c < own.corners.size(); ++c) {
    if (!corners[c]) continue;
    const Nearest found = nearest(point_at(own.corners[c], 0.0), local);
    if (found.gap >= alarm_ || !(found.b[1] > 0.0 && found.b[1] < 1.0)) continue;
    if (out_of_corner(own, static_cast<int>(c), -found.normal))
      add(point_at(own.corners[c], 0.0), there, axis, at, key(Kind::axis, 1 + own.edges.size() + c), !swapped);
  }
}

void Meet::axis_inside(const Simplex& axis, const Pose& at, const Polyhedron& own, const Pose& there, bool swapped) {
  const Vec3 p = into(there, at * axis.x[0]), q = into(there, at * axis.x[1]);
  double of_faces = -INFINITY, of_edges = -INFINITY, size = 0.0;
  std::size_t face = 0, edge = 0;
  for (std::size_t f = 0; f < own.faces.size(); ++f) {
    const Vec3 &n = own.normals[f], &x = own.corners[own.faces[f][0]];
    const double apart = std::min(n.dot(p - x), n.dot(q - x));
    if (apart <= of_faces) continue;
    of_faces = apart;
    face = f;
  }
  for (std::size_t e = 0; e < own.edges.size(); ++e) {
    const Vec3& x = own.corners[own.edges[e][0]];
    const Vec3 along = own.corners[own.edges[e][1]] - x;
    size = std::max(size, along.norm());
    Vec3 across = (q - p).cross(along);
    if (across.norm() < 1e-6 * (q - p).norm() * along.norm()) continue;
    across.normalize();
    if (across.dot(own.normals[own.sides[e][0]] + own.normals[own.sides[e][1]]) < 0.0) across = -across;
    const double apart = across.dot(p - x);
    if (apart <= of_edges || !between_faces(own, e, across)) continue;
    of_edges = apart;
    edge = e;
  }
  // Faces where they say about the same: their patch does not flicker.
  if (of_edges > of_faces + 1e-3 * size) {
    add(axis, at, edge_of(own, edge), there, key(Kind::axis, 1 + edge), swapped);
    return;
  }
  // What of the axis is over the face, its two ends.
  const Vec3 &n = own.normals[face], &x = own.corners[own.faces[face][0]];
  Stretch over;
  const std::vector<int>& around = own.faces[face];
  for (std::size_t i = 0; i < around.size(); ++i) {
    const Vec3 &from = own.corners[around[i]], &to = own.corners[around[(i + 1) % around.size()]];
    const Vec3 outward = (to - from).cross(n);
    const double a = outward.dot(p - from), b = outward.dot(q - from);
    if (a > 0.0 && b > 0.0) over.to = -1.0;
    if (a > 0.0 && b <= 0.0) over.from = std::max(over.from, a / (a - b));
    if (b > 0.0 && a <= 0.0) over.to = std::min(over.to, a / (a - b));
  }
  if (over.from > over.to) over = inner_part(own, p, q);
  std::size_t number = 0;
  for (const double t : {over.from, over.to})
    add(point_at(axis.x[0] + t * (axis.x[1] - axis.x[0]), axis.radius), at, plane_at(x, n), there,
        key(swapped ? Kind::face_of_first : Kind::face_of_second, face, number++), swapped);
}

/// Largest distance of Q from the plane of a face of P, over all faces; and a face in whose plane Q begins, but for
/// `same`.
struct FaceAxis {
  double separation = -INFINITY;
  std::size_t face = 0;
  std::optional<std::size_t> touched;
};
FaceAxis best_face(const Polyhedron& P, const std::vector<Vec3>& Q_in_P, double same) {
  FaceAxis best;
  for (std::size_t f = 0; f < P.faces.size(); ++f) {
    const Vec3 &n = P.normals[f], &x = P.corners[P.faces[f][0]];
    double least = INFINITY;
    for (const Vec3& corner : Q_in_P) least = std::min(least, n.dot(corner - x));
    if (std::abs(least) <= same) best.touched = f;
    if (least <= best.separation) continue;
    best.separation = least;
    best.face = f;
  }
  return best;
}

struct EdgeAxis {
  double separation = -INFINITY;
  std::size_t of_P = 0, of_Q = 0;
};
EdgeAxis best_edges(const Polyhedron& P, const Polyhedron& Q, const std::vector<Vec3>& Q_in_P, const Pose& Q_to_P) {
  EdgeAxis best;
  for (std::size_t i = 0; i < P.edges.size(); ++i) {
    const Vec3& x = P.corners[P.edges[i][0]];
    const Vec3 d = P.corners[P.edges[i][1]] - x;
    const Vec3 &n1 = P.normals[P.sides[i][0]], &n2 = P.normals[P.sides[i][1]];
    for (std::size_t j = 0; j < Q.edges.size(); ++j) {
      const Vec3& y = Q_in_P[Q.edges[j][0]];
      const Vec3 e = Q_in_P[Q.edges[j][1]] - y;
      // On the sphere of normals an edge is an arc; the two edges meet only where these cross (Gauss map).
      const Vec3 m1 = -(Q_to_P.R * Q.normals[Q.sides[j][0]]), m2 = -(Q_to_P.R * Q.normals[Q.sides[j][1]]);
      const Vec3 n12 = n2.cross(n1), m12 = m2.cross(m1);
      const double m1_side = m1.dot(n12), m2_side = m2.dot(n12), n1_side = n1.dot(m12), n2_side = n2.dot(m12);
      if (!(m1_side * m2_side < 0.0 && n1_side * n2_side < 0.0 && m1_side * n2_side > 0.0)) continue;
      Vec3 axis = d.cross(e);
      if (axis.squaredNorm() < 1e-12 * d.squaredNorm() * e.squaredNorm()) continue;
      axis.normalize();
      if (axis.dot(n1 + n2) < 0.0) axis = -axis;
      const double separation = axis.dot(y - x);
      if (separation > best.separation) best = {separation, i, j};
    }
  }
  return best;
}

/// What of a polygon is on the inner side of a plane.
void clip(std::vector<Vec3>& polygon, const Vec3& x, const Vec3& outward) {
  std::vector<Vec3> kept;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vec3 &from = polygon[i], &to = polygon[(i + 1) % polygon.size()];
    const double a = outward.dot(from - x), b = outward.dot(to - x);
    if (a <= 0.0) kept.push_back(from);
    if ((a < 0.0 && b > 0.0) || (a > 0.0 && b < 0.0)) kept.push_back(from + a / (a - b) * (to - from));
  }
  polygon = std::move(kept);
}

/// At most nine of many corners: the lowest, and the farthest along eight directions in the plane.
void thin(std::vector<Vec3>& polygon, const Vec3& n) {
  constexpr std::size_t kMost = 8;
  if (polygon.size() <= kMost + 1) return;
  const Vec3 x = n.unitOrthogonal(), y = n.cross(x);
  const auto lowest = std::min_element(polygon.begin(), polygon.end(),
                                       [&](const Vec3& a, const Vec3& b) { return n.dot(a) < n.dot(b); });
  std::vector<Vec3> kept = {*lowest};
  polygon.erase(lowest);
  for (std::size_t k = 0; k < kMost; ++k) {
    const double angle = 2.0 * M_PI * static_cast<double>(k) / kMost;
    const Vec3 way = std::cos(angle) * x + std::sin(angle) * y;
    const auto farthest = std::max_element(polygon.begin(), polygon.end(),
                                           [&](const Vec3& a, const Vec3& b) { return way.dot(a) < way.dot(b); });
    kept.push_back(*farthest);
    polygon.erase(farthest);
  }
  polygon = std::move(kept);
}

void Meet::nearest_corners(const Shape& first, const Pose& at, const Shape& second, const Pose& there, double some,
                           double least) {
  std::vector<std::pair<double, Meeting>> near;
  const auto look = [&](const Shape& a, const Pose& of_a, const Shape& b, const Pose& of_b, bool swapped) {
    const std::vector<Vec3>& all = std::get<Convex>(a).surface.corners;
    for (std::size_t i = 0; i < all.size(); ++i) {
      const Vec3 p = into(of_b, of_a * all[i]);
      const Simplex part = nearest_part(b, p);
      const double gap = nearest(point_at(p, 0.0), part).gap;
      if (swapped && part.kind == Simplex::Kind::point) continue;  // two corners meet once
      if (gap >= std::min(least + some, alarm_)) continue;
      least = std::min(least, gap);
      near.push_back({gap, {point_at(all[i], 0.0), part, key(Kind::point, i, swapped ? 1 : 0), swapped}});
    }
  };
  look(first, at, second, there, false);
  look(second, there, first, at, true);
  for (const auto& [gap, own] : near) {
    if (gap <= least + some) found_.push_back(own);
  }
}

// The largest separation s along normals of faces and across edges is how deep the two overlap, where s < 0. Where they
// are apart it is their distance if a corner is over a face or two edges cross nearest, else less: a corner then is
// nearest to a corner or an edge.
void Meet::polyhedra(const Shape& first, const Pose& at, const Shape& second, const Pose& there) {
  const Polyhedron &P = std::get<Convex>(first).surface, &Q = std::get<Convex>(second).surface;
  const Pose Q_to_P{at.R.transpose() * there.R, into(at, there.p)};
  const Pose P_to_Q{Q_to_P.R.transpose(), into(there, at.p)};
  std::vector<Vec3> Q_in_P, P_in_Q;
  for (const Vec3& corner : Q.corners) Q_in_P.push_back(Q_to_P * corner);
  for (const Vec3& corner : P.corners) P_in_Q.push_back(P_to_Q * corner);
  double size = 0.0;
  for (const Vec3& corner : P.corners) size = std::max(size, corner.norm());
  same_ = kSamePlane * size;
  const FaceAxis of_P = best_face(P, Q_in_P, same_);
  if (of_P.separation >= alarm_) return;
  const FaceAxis of_Q = best_face(Q, P_in_Q, same_);
  if (of_Q.separation >= alarm_) return;
  const EdgeAxis edges = best_edges(P, Q, Q_in_P, Q_to_P);
  if (edges.separation >= alarm_) return;
  if (std::max(of_P.separation, of_Q.separation) > same_ && (of_P.touched || of_Q.touched)) {
    const bool of_first = of_P.touched.has_value();
    const Polyhedron& own = of_first ? P : Q;
    const Pose& pose = of_first ? at : there;
    const std::size_t f = of_first ? *of_P.touched : *of_Q.touched;
    touched_ = plane_at(pose * own.corners[own.faces[f][0]], pose.R * own.normals[f]);
  }
  // Faces where they say about the same: their patch does not flicker.
  const double clearly = 1e-3 * size;
  const auto add_edges = [&] {
    found_.push_back({edge_of(Q, edges.of_Q), edge_of(P, edges.of_P), key(Kind::edges, edges.of_P, edges.of_Q), true});
  };
  // Two edges meet between their ends; where they do not, they are not what is nearest.
  const bool edges_meet = std::isfinite(edges.separation) &&
                          nearest(moved(there, edge_of(Q, edges.of_Q)), moved(at, edge_of(P, edges.of_P))).gap <
                              edges.separation + 1e-9 * size;
  if (edges_meet && edges.separation > std::max(of_P.separation, of_Q.separation) + clearly) return add_edges();
  const bool on_Q = of_Q.separation > of_P.separation + clearly;
  const Polyhedron &reference = on_Q ? Q : P, &incident = on_Q ? P : Q;
  const std::vector<Vec3>& corners = on_Q ? P_in_Q : Q_in_P;
  const Pose& back = on_Q ? Q_to_P : P_to_Q;
  const Eigen::Matrix3d& turn = on_Q ? P_to_Q.R : Q_to_P.R;
  const std::size_t face = on_Q ? of_Q.face : of_P.face;
  const Vec3 &n = reference.normals[face], &x = reference.corners[reference.faces[face][0]];
  std::size_t facing = 0;
  for (std::size_t f = 1; f < incident.faces.size(); ++f) {
    if (n.dot(turn * incident.normals[f]) < n.dot(turn * incident.normals[facing])) facing = f;
  }
  std::vector<Vec3> polygon;
  for (const int corner : incident.faces[facing]) polygon.push_back(corners[corner]);
  const std::vector<int>& around = reference.faces[face];
  for (std::size_t i = 0; i < around.size() && !polygon.empty(); ++i) {
    const Vec3 &from = reference.corners[around[i]], &to = reference.corners[around[(i + 1) % around.size()]];
    clip(polygon, from, (to - from).cross(n));
  }
  std::erase_if(polygon, [&](const Vec3& p) { return n.dot(p - x) >= alarm_; });
  const double separation = std::max({of_P.separation, of_Q.separation, edges.separation});
  const bool overlap = separation <= 0.0, apart = separation > 1e-7 * size;
  double least = INFINITY;
  for (const Vec3& p : polygon) least = std::min(least, n.dot(p - x));
  if (apart && least > separation + 1e-9 * size) {  // something beside the face is nearer
    if (edges_meet && edges.separation > separation - 1e-9 * size) {
      add_edges();
    } else {
      nearest_corners(first, at, second, there, clearly, least);
    }
    if (polygon.empty()) return;
  }
  const bool above =  // by more than rounding: what lies on the face at several points keeps them all
      std::all_of(polygon.begin(), polygon.end(), [&](const Vec3& p) { return n.dot(p - x) > 1e-9 * size; });
  if (polygon.empty() || (overlap && above)) {  // beside the face: two edges, or else the corner that is deepest
    if (edges_meet) return add_edges();
    polygon.push_back(*std::min_element(corners.begin(), corners.end(),
                                        [&](const Vec3& a, const Vec3& b) { return n.dot(a) < n.dot(b); }));
  }
  thin(polygon, n);
  for (std::size_t i = 0; i < polygon.size(); ++i)
    found_.push_back({point_at(back * polygon[i], 0.0), plane_at(x, n),
                      key(on_Q ? Kind::face_of_second : Kind::face_of_first, face, i), !on_Q});
}

}  // namespace

Simplex moved(const Pose& pose, Simplex own) {
  for (int i = 0; i < own.corners(); ++i) own.x[i] = pose * own.x[i];
  own.normal = pose.R * own.normal;
  own.rim = pose.R * own.rim;
  own.low = pose.R * own.low;
  return own;
}

void meet(const Shape& first, const Pose& at, const Shape& second, const Pose& there, double alarm,
          std::vector<Meeting>& found) {
  if (std::holds_alternative<Mesh>(first) || std::holds_alternative<Mesh>(second))
    throw std::invalid_argument("contact::meet: a mesh is met part by part");
  Meet meeting(alarm, found);
  const auto ball = [](const Shape& shape) { return std::holds_alternative<Ball>(shape); };
  if (round(first) && (ball(first) || !ball(second))) return meeting.round_shape(first, at, second, there, false);
  if (round(second)) return meeting.round_shape(second, there, first, at, true);
  if (std::holds_alternative<HalfSpace>(first) || std::holds_alternative<HalfSpace>(second)) {
    const bool swapped = std::holds_alternative<HalfSpace>(first);
    const Shape &body = swapped ? second : first, &space = swapped ? first : second;
    const Pose &of_body = swapped ? there : at, &of_space = swapped ? at : there;
    std::vector<Simplex> points;
    if (const Convex* convex = std::get_if<Convex>(&body)) {
      for (const Vec3& corner : convex->surface.corners) points.push_back(point_at(corner, 0.0));
    } else if (const Cylinder* cylinder = std::get_if<Cylinder>(&body)) {
      add_rims(*cylinder, of_body.R.transpose() * of_space.R.col(2), points);
    }
    return meeting.points(points, of_body, space, of_space, swapped);
  }
  std::array<Shape, 2> prisms;
  const auto flat = [](const Shape& shape, Shape& room) -> const Shape& {
    const Cylinder* const cylinder = std::get_if<Cylinder>(&shape);
    if (!cylinder) return shape;
    return room = Convex{prism(*cylinder)};
  };
  const std::size_t before = found.size();
  meeting.polyhedra(flat(first, prisms[0]), at, flat(second, prisms[1]), there);
  meeting.find_grazed(at, there, before);
}

}  // namespace sinew::contact
