#include "sinew/sim/contact_search.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "sinew/threads/interruption.hpp"

namespace sinew {

using Kind = Collider::Kind;
using contact::Simplex;

namespace {

class Search {
 public:
  Search(const Moment& start, double alarm, double depth, const Surfaces& surfaces, std::vector<ContactState>& found)
      : start_(start), alarm_(alarm), depth_(depth), surfaces_(surfaces), found_(found) {}

  void pair(int number) {
    pair_ = number;
    const PairModel& own = start_.model.pairs[number];
    shallow_ = depth_;
    depth_ = std::max(depth_, own.depth);
    if (are_shapes(start_.model, own)) {
      each_meeting(own, alarm_, [this](const ContactSide& a, const ContactSide& b, const contact::Meeting& met) {
        add(a, b, met.key, met.grazed);
      });
      return;
    }
    if (!whole_pieces && !around(own.a).intersects(around(own.b))) return;
    points_and_faces(own.a, own.b, Part::point_of_first);
    if (own.a != own.b) points_and_faces(own.b, own.a, Part::point_of_second);
    const auto bent = [this](const ContactSide& side, double thick) {
      return whole_pieces && rod_piece(side) ? thick : 0.0;
    };
    const auto on_piece = [&](const ContactSide& a, const Edge& b, const contact::Nearest& found, std::uint64_t part) {
      if (matters(found.gap, std::max(depth_, bent(b.side, a.local.radius + b.placed.radius)))) add(a, b.side, part);
    };
    each_point_on_piece(own.a, own.b, on_piece);
    each_point_on_piece(own.b, own.a, on_piece);
    each_crossing(own.a, own.b, [&](const Edge& a, const Edge& b, const contact::Nearest& found, std::uint64_t part) {
      const double thick = a.placed.radius + b.placed.radius, deep = std::max(bent(a.side, thick), bent(b.side, thick));
      if (matters(found.gap, std::max(depth_, deep)) && crosses_inside(a, b, found)) add(a.side, b.side, part);
    });
  }

  /// Whether pieces of rods count however deep their chords lie in what they bend round.
  bool whole_pieces = false;

  /// How deep points of one are in the other or, where none are, edges beside or through it.
  double overlap(int number) {
    const PairModel& own = start_.model.pairs[number];
    if (own.a == own.b) return 0.0;
    double deepest = 0.0;
    if (are_shapes(start_.model, own)) {
      each_meeting(own, 0.0, [&](const ContactSide& a, const ContactSide& b, const contact::Meeting&) {
        deepest = std::max(deepest, -contact::nearest(start_.placed(a), start_.placed(b)).gap);
      });
      return deepest;
    }
    const auto look = [&](const Collider& poking, const Collider& faced) {
      if (faced.kind == Kind::rod) return;
      each_prong(poking, Simplex::Kind::point, around(faced), [&](const ContactSide& side, int prong) {
        deepest = std::max(deepest, depth_in(faced, placed(side, prong)));
      });
    };
    look(own.a, own.b);
    look(own.b, own.a);
    if (deepest > 0.0) return deepest;
    const auto on_piece = [&](const ContactSide&, const Edge&, const contact::Nearest& found, std::uint64_t) {
      deepest = std::max(deepest, -found.gap);
    };
    each_point_on_piece(own.a, own.b, on_piece);
    each_point_on_piece(own.b, own.a, on_piece);
    each_crossing(own.a, own.b, [&](const Edge& a, const Edge& b, const contact::Nearest& found, std::uint64_t) {
      if (found.gap < 0.0 && crosses_inside(a, b, found))
        deepest =
            std::max(deepest, -found.gap - stands_out(start_.model, a.side.on) - stands_out(start_.model, b.side.on));
    });
    if (deepest > 0.0) return deepest;
    return depth_between_triangles(number);
  }

  bool edges_stay_clear(const StepMotion& motion, int number, double speed, double margin) const {
    const PairModel& own = start_.model.pairs[static_cast<std::size_t>(number)];
    bool clear = true;
    each_near(edges_of(own.a, around(own.b)), edges_of(own.b, around(own.a)), [&](const Edge& one, const Edge& other) {
      if (!clear) return;
      ContactState both;
      both.a = one.side;
      both.b = other.side;
      clear = parts_stay_clear(motion, both, speed, margin);
    });
    return clear;
  }

  double depth_between_triangles(int number) const {
    const PairModel& own = start_.model.pairs[static_cast<std::size_t>(number)];
    if (own.a == own.b || !around(own.a).intersects(around(own.b))) return 0.0;
    return std::max(depth_of_edges(own.a, own.b), depth_of_edges(own.b, own.a));
  }

 private:
  /// How deep a point is in an object, with its thickness; 0 outside.
  double depth_in(const Collider& own, const Simplex& point) const {
    const Surface* surface = surfaces_.of(own);
    if (!surface) {
      const contact::Pose pose = start_.pose(own);
      const Vec3 there = pose.R.transpose() * (point.x[0] - pose.p);
      return std::max(0.0, -gap_to_shape(shape_of(start_.model, own), there, point.radius));
    }
    return sinew::depth_in(*surface, point, std::max(alarm_, depth_));
  }

  /// How deep edges, axes and pieces of one are in the other in the middle between the triangles that they pass through
  /// and, where they are thin, their ends.
  double depth_of_edges(const Collider& poking, const Collider& faced) const {
    const Surface* surface = surfaces_.of(faced);
    if (!surface) return 0.0;
    double deepest = 0.0;
    for (const Edge& edge : edges_of(poking, around(faced)))
      deepest = std::max(deepest, depth_of_line(*surface, edge.placed, std::max(alarm_, depth_)));
    return deepest;
  }

  /// By which a contact of a pair is known again: what it is, and the numbers of its two parts.
  enum class Part : std::uint64_t { point_of_first, point_of_second, edges, point_on_piece };
  static std::uint64_t key(Part part, int i, int j) {
    constexpr int kBits = 25;  // in all what a double holds exactly
    return (static_cast<std::uint64_t>(part) << (2 * kBits)) | (static_cast<std::uint64_t>(i) << kBits) |
           static_cast<std::uint64_t>(j);
  }

  /// Whether anything of a side can move: where nothing of either can, no force would do anything.
  bool moves(const ContactSide& side) const {
    if (side.on.kind == Kind::body) return true;
    if (side.on.kind == Kind::obstacle) return false;
    if (side.on.kind == Kind::rod) {
      const rod::Rod& rod = start_.model.rods[side.on.number].rod;
      return rod.base_coordinates() > 0 || side.abscissae[0] > 0.0 || side.local.corners() > 1;
    }
    const Eigen::Matrix3Xi& unknown = start_.model.solids[side.on.number].body.unknown;
    for (int k = 0; k < side.local.corners(); ++k) {
      if (unknown.col(side.nodes[k]).maxCoeff() >= 0) return true;
    }
    return false;
  }

  /// `grazed`: normal of the plane in which the two lie beside each other, if they do.
  void add(const ContactSide& a, const ContactSide& b, std::uint64_t part, const Vec3& grazed = Vec3::Zero()) {
    if (!moves(a) && !moves(b)) return;
    ContactState& own = found_.emplace_back();
    own.grazed = grazed;
    own.pair = pair_;
    own.on_second = a.on != start_.model.pairs[pair_].a;
    own.part = part;
    own.a = a;
    own.b = b;
  }

  template <class Visit>
  void each_meeting(const PairModel& pair, double alarm, const Visit& visit) {
    meetings_.clear();
    contact::meet(shape_of(start_.model, pair.a), start_.pose(pair.a), shape_of(start_.model, pair.b),
                  start_.pose(pair.b), alarm, meetings_);
    for (const contact::Meeting& met : meetings_) {
      ContactSide a, b;
      a.on = met.swapped ? pair.b : pair.a;
      b.on = met.swapped ? pair.a : pair.b;
      a.local = met.a;
      b.local = met.b;
      visit(a, b, met);
    }
  }

  /// Visits the parts of an object with which it pokes into others, of one kind, with their numbers: points and ridges
  /// of a surface near `where`, points and pieces of a rod, corners and edges of a shape.
  template <class Visit>
  void each_prong(const Collider& own, Simplex::Kind kind, const contact::Box& where, const Visit& visit) const {
    if (const Surface* surface = surfaces_.of(own)) {
      if (kind == Simplex::Kind::point) {
        each_point(own, *surface, where, visit);
      } else {
        each_ridge(own, *surface, where, visit);
      }
    } else if (is_rigid(own)) {
      const std::vector<Simplex>& all = prongs_of(start_.model, own);
      for (std::size_t i = 0; i < all.size(); ++i) {
        if (all[i].kind != kind) continue;
        ContactSide side;
        side.on = own;
        side.local = all[i];
        visit(side, static_cast<int>(i));
      }
    } else {
      const RodModel& rod = start_.model.rods[own.number];
      ContactSide side;
      side.on = own;
      side.local.kind = kind;
      const std::size_t count = rod.touching.size(), used = kind == Simplex::Kind::point ? 1 : 2;
      for (std::size_t i = 0; i + used <= count; ++i) {
        side.local.radius = 0.0;
        for (std::size_t k = 0; k < used; ++k) {
          side.abscissae[k] = rod.touching[i + k];
          side.local.radius = std::max(side.local.radius, rod::radius_at(rod.rod.profile, rod.touching[i + k]));
        }
        visit(side, static_cast<int>(i));
      }
    }
  }

  /// A part of a surface, by the numbers of its corners.
  ContactSide part_of(const Collider& own, const Surface& surface, Simplex::Kind kind,
                      const std::array<int, 3>& corners) const {
    ContactSide side;
    side.on = own;
    side.nodes = corners;
    side.local.kind = kind;
    if (is_rigid(own)) {
      for (int k = 0; k < side.local.corners(); ++k) side.local.x[k] = surface.mesh->points.col(corners[k]);
    }
    return side;
  }

  /// Gives a side a direction of the world, which what is rigid carries with it.
  void point_outward(ContactSide& side, const Vec3& outward) const {
    side.local.normal = is_rigid(side.on) ? Vec3(start_.pose(side.on).R.transpose() * outward) : outward;
  }

  template <class Visit>
  void each_point(const Collider& own, const Surface& surface, const contact::Box& where, const Visit& visit) const {
    for (const int point : surface.mesh->used) {
      if (where.contains(Vec3(surface.x.col(point))))
        visit(part_of(own, surface, Simplex::Kind::point, {point, 0, 0}), point);
    }
  }

  template <class Visit>
  void each_ridge(const Collider& own, const Surface& surface, const contact::Box& where, const Visit& visit) const {
    surface.edges.each_near(where, [&](int number) {
      const contact::Ridge& ridge = surface.mesh->ridges[number];
      const std::optional<Vec3> outward = outward_of_ridge(surface, ridge);
      if (!outward) return;
      ContactSide side = part_of(own, surface, Simplex::Kind::segment, {ridge.ends[0], ridge.ends[1], 0});
      point_outward(side, *outward);
      visit(side, number);
    });
  }

  /// Of all of an object, and the alarm distance around.
  contact::Box around(const Collider& own) const {
    const auto known =
        std::find_if(around_.begin(), around_.end(), [&own](const auto& one) { return one.first == own; });
    if (known != around_.end()) return known->second;
    contact::Box box;
    if (const Surface* surface = surfaces_.of(own)) {
      box = surface->faces.whole();
    } else if (is_rigid(own)) {
      const contact::Pose pose = start_.pose(own);
      const Vec3 reach = contact::reach(shape_of(start_.model, own), pose.R.transpose());
      box = contact::Box(Vec3(pose.p - reach), Vec3(pose.p + reach));
    } else {
      const RodModel& rod = start_.model.rods[own.number];
      double thick = 0.0;  // (pieces are as thick as the thicker of their ends)
      for (const double s : rod.touching) thick = std::max(thick, rod::radius_at(rod.rod.profile, s));
      const Eigen::Matrix3Xd& points = surfaces_.points_of_rod(own.number);
      box = contact::Box(Vec3(points.rowwise().minCoeff().array() - thick),
                         Vec3(points.rowwise().maxCoeff().array() + thick));
    }
    return around_.emplace_back(own, grown(box)).second;
  }

  contact::Box grown(contact::Box box, double radius = 0.0) const {
    const double far = std::max(alarm_, depth_) + radius;
    box.min().array() -= far;
    box.max().array() += far;
    return box;
  }

  /// Whether a gap is one that may close, or has just closed.
  bool matters(double gap) const { return matters(gap, depth_); }
  bool matters(double gap, double depth) const { return gap < alarm_ && gap > -depth; }

  /// Of a prong, by its number: rods are placed once a step.
  Simplex placed(const ContactSide& side, int number) const {
    if (side.on.kind != Kind::rod) return start_.placed(side);
    Simplex own = side.local;
    const Eigen::Matrix3Xd& points = surfaces_.points_of_rod(side.on.number);
    for (int k = 0; k < own.corners(); ++k) own.x[static_cast<std::size_t>(k)] = points.col(number + k);
    return own;
  }

  void points_and_faces(const Collider& poking, const Collider& faced, Part part) {
    if (faced.kind == Kind::rod) return;  // thin: its pieces are met
    each_prong(poking, Simplex::Kind::point, around(faced), [&](const ContactSide& a, int number) {
      const Simplex point = placed(a, number);
      if (const Surface* surface = surfaces_.of(faced)) {
        add_faces(a, point, faced, *surface, number, part);
      } else {
        add_shape(a, point, faced, key(part, number, 0));
      }
    });
  }

  /// Visits the corners of an object, the middle of a ball and the ends of a capsule beside the pieces of a rod,
  /// between whose ends they would pass otherwise.
  template <class Visit>
  void each_point_on_piece(const Collider& poking, const Collider& rod, const Visit& visit) {
    if (rod.kind != Kind::rod || poking.kind == Kind::rod) return;
    const std::vector<Edge> pieces = edges_of(rod, around(poking));
    if (pieces.empty()) return;
    each_prong(poking, Simplex::Kind::point, around(rod), [&](const ContactSide& a, int number) {
      const Simplex point = placed(a, number);
      const contact::Box where = grown(contact::Box(point.x[0]), point.radius);
      for (const Edge& piece : pieces) {
        if (!where.intersects(piece.box)) continue;
        const contact::Nearest found = contact::nearest(point, piece.placed);
        if (!(found.gap < alarm_) || !(found.b[0] > kSame && found.b[1] > kSame)) continue;
        if (found.normal.dot(outward_of(a)) > 0.0 || !out_of_corner(a, -found.normal)) continue;
        visit(a, piece, found, key(Part::point_on_piece, number, piece.number));
      }
    });
  }

  /// Whether no edge of a surface that leaves one of its points does so towards `d`, so that the point is nearest to
  /// what is there, or nearly so: a rod that all but lies along an edge comes to lie on both of its ends within the
  /// step, and bends from its chords, by which it is looked for. True of points of shapes.
  bool out_of_corner(const ContactSide& point, const Vec3& d) const {
    constexpr double kNearly = 0.1;  // the sine of an angle
    const Surface* surface = surfaces_.of(point.on);
    return !surface || steepest_edge(*surface, point.nodes[0], d) <= kNearly;
  }

  /// Whether a part can press on a point; both in axes that R turns into the world. The side of what slides over a
  /// surface stops at no point before it that lies flat in it: from there the surface goes on towards that side, and
  /// something else is nearer.
  bool can_press(const ContactSide& a, const Simplex& point, const Simplex& part, const Vec3& outward,
                 const Eigen::Matrix3d& R = Eigen::Matrix3d::Identity()) const {
    constexpr double kGoesOn = 0.5;  // the cosine of 60 degrees
    const Surface* surface = surfaces_.of(a.on);
    if (!surface) return true;
    const Vec3 n = R * contact::nearest(point, part, contact::facing(point, part)).normal;
    return n.dot(outward) < contact::kAgainst || steepest_edge(*surface, a.nodes[0], -n) < kGoesOn;
  }

  /// Out of what a point is a corner of; zero of points of rods and of middles of what is round.
  Vec3 outward_of(const ContactSide& point) const {
    const Surface* surface = surfaces_.of(point.on);
    if (surface) return surface->outward.points.col(point.nodes[0]);
    return is_rigid(point.on) ? start_.pose(point.on).R * point.local.normal : Vec3(Vec3::Zero());
  }

  void add_shape(const ContactSide& a, const Simplex& point, const Collider& hard, std::uint64_t part) {
    const contact::Pose pose = start_.pose(hard);
    const Vec3 own = pose.R.transpose() * (point.x[0] - pose.p);
    ContactSide b;
    b.on = hard;
    const contact::Shape& shape = shape_of(start_.model, hard);
    const Vec3 outward = outward_of(a), there = pose.R.transpose() * outward;
    b.local = contact::nearest_part(shape, own, there);
    const Simplex tip = contact::point_at(own, point.radius);
    const double gap = contact::nearest(tip, b.local).gap;
    if (gap >= alarm_ || (gap > 0.0 && !can_press(a, tip, b.local, outward, pose.R))) return;
    add(a, b, part,
        point.radius == 0.0 ? Vec3(pose.R * contact::grazed_plane(shape, own, b.local, there)) : Vec3(Vec3::Zero()));
  }

  /// A thin point meets the nearest face. A thick one may lie in a hollow and touch many, so it meets all that it is in
  /// front of: each with its own nearest point, which may lie on an edge that others share.
  void add_faces(const ContactSide& a, const Simplex& point, const Collider& faced, const Surface& surface, int prong,
                 Part part) {
    const contact::Mesh& mesh = *surface.mesh;
    const Vec3 outward = outward_of(a);
    const bool itself = a.on == faced, thick = point.radius > 0.0;
    std::optional<ContactSide> nearest;
    int nearest_face = -1;
    std::optional<bool> in;
    double least = INFINITY, against = INFINITY;
    bool in_front = false;
    const contact::Box where = grown(contact::Box(point.x[0]), point.radius);
    surface.faces.each_near(where, [&](int number) {
      const std::array<int, 3>& corners = mesh.triangles[number];
      if (itself && near_at_rest(mesh, a.nodes[0], corners)) return;
      ContactSide b = part_of(faced, surface, Simplex::Kind::triangle, corners);
      Simplex face = start_.placed(b);
      contact::Nearest found = contact::nearest(point, face);
      // Past an edge of the surface, the two faces tell together what is outside.
      face.normal = contact::outward_at(mesh, surface.outward, number, found.b);
      point_outward(b, face.normal);
      found = contact::nearest(point, face);
      const bool corner = std::max({found.b[0], found.b[1], found.b[2]}) > 1.0 - kSame;
      // Corners are the business of the nodes, and so is all of a fine mesh: between nodes on a ball of radius r its
      // edges e lie e^2 / 8 r deep in it.
      const bool of_nodes = thick
                                ? corner || longest_edge(face) < 0.5 * point.radius
                                : corner && faced.kind == Kind::solid;  // those of two rigid meshes may all be corners
      if ((is_rigid(a.on) && of_nodes) || !matters(found.gap)) return;
      // Far behind the plane of one triangle of many is not yet inside.
      if (!itself && found.gap + point.radius < -shallow_) {
        if (!in) in = contact::inside(mesh, surface.x, surface.faces, point.x[0]);
        if (!*in) return;
      }
      const Vec3 n = (face.x[1] - face.x[0]).cross(face.x[2] - face.x[0]);
      if (thick && n.dot(point.x[0] - face.x[0]) > 0.0) {
        add(a, b, key(part, prong, number));
        in_front = true;
      }
      // Of faces that are equally near the one that looks most against the point's own outside, as at a rim.
      const double distance = std::abs(found.gap), same = 1e-6 * longest_edge(face),
                   facing = n.normalized().dot(outward);
      if (distance >= least + same || (distance >= least - same && facing >= against)) return;
      // The far side of something thin, or round the corner of what the point is above.
      if (!outward.isZero() && (facing >= 0.0 || (found.gap > 0.0 && !can_press(a, point, face, outward)))) return;
      least = std::min(least, distance);
      against = facing;
      nearest = b;
      nearest_face = number;
    });
    if (!nearest || in_front) return;
    add(a, *nearest, key(part, prong, 0),
        thick ? Vec3(Vec3::Zero()) : grazed_plane(surface, nearest_face, point.x[0], outward));
    if (!thick) add_valley(a, point, faced, surface, nearest_face, prong, part);
  }

  /// In a valley a thin point touches both sides. Of the triangles across the edges of the one that it is over, it also
  /// meets those that rise from there above it, and not by rounding alone.
  void add_valley(const ContactSide& a, const Simplex& point, const Collider& faced, const Surface& surface, int face,
                  int prong, Part part) {
    constexpr double kSteep = 1e-3;  // the least sine of the angle between both sides
    constexpr double kNear = 0.5;    // the farthest from the edge, in longest edges
    const contact::Mesh& mesh = *surface.mesh;
    const auto number = static_cast<std::size_t>(face);
    const std::array<int, 3>& corners = mesh.triangles[number];
    const Simplex here = start_.placed(part_of(faced, surface, Simplex::Kind::triangle, corners));
    const Vec3 &x = point.x[0], up = surface.outward.faces.col(face);
    for (std::size_t i = 0; i < 3; ++i) {
      const int other = mesh.beside[number][i];
      if (other < 0) continue;
      const std::array<int, 3>& across = mesh.triangles[static_cast<std::size_t>(other)];
      const auto shared = std::find(across.begin(), across.end(), corners[(i + 1) % 3]) - across.begin();
      const Vec3 &from = here.x[i], &to = here.x[(i + 1) % 3], n = surface.outward.faces.col(other);
      const double rise = up.dot(surface.x.col(across[static_cast<std::size_t>(shared + 2) % 3]) - from);
      if (rise <= contact::kSamePlane * start_.model.size || up.dot(x - from) >= rise) continue;
      const Vec3 side = here.x[(i + 2) % 3] - from;
      const auto [s, t] = contact::on_segment(x, from, to);
      if (n.dot(side) <= kSteep * side.norm() || (x - s * from - t * to).norm() > kNear * longest_edge(here)) continue;
      if (a.on == faced && near_at_rest(mesh, a.nodes[0], across)) continue;
      ContactSide b = part_of(faced, surface, Simplex::Kind::triangle, across);
      b.local.valley = static_cast<int>(shared);
      if (contact::over_face(start_.placed(b), x) && matters(n.dot(x - from))) add(a, b, key(part, prong, other + 1));
    }
  }

  struct Edge {
    ContactSide side;
    Simplex placed;
    contact::Box box;
    int number = 0;
  };
  std::vector<Edge> edges_of(const Collider& own, const contact::Box& where) const {
    std::vector<Edge> all;
    each_prong(own, Simplex::Kind::segment, where, [&](const ContactSide& side, int number) {
      Edge edge{side, placed(side, number), {}, number};
      edge.box.extend(edge.placed.x[0]);
      edge.box.extend(edge.placed.x[1]);
      edge.box.min().array() -= edge.placed.radius;
      edge.box.max().array() += edge.placed.radius;
      if (edge.box.intersects(where)) all.push_back(edge);
    });
    return all;
  }

  /// Visits the edges of two objects, and the pieces of rods, that pass each other between their ends within the alarm
  /// distance: the one that has an outside, if only one has, comes second.
  template <class Visit>
  void each_crossing(const Collider& first, const Collider& second, const Visit& visit) {
    const std::vector<Edge> all = edges_of(first, around(second));
    if (all.empty()) return;
    each_near(all, first == second ? all : edges_of(second, around(first)), [&](const Edge& one, const Edge& other) {
      if (first == second && (one.number >= other.number || neighbours(one.side, other.side))) return;
      const bool turned = other.placed.normal.isZero() && !one.placed.normal.isZero();
      const Edge &a = turned ? other : one, &b = turned ? one : other;
      if (side_by_side(a, b)) return;
      const contact::Nearest found = contact::nearest(a.placed, b.placed);
      if (!(found.gap < alarm_) || !within(found, a.side, b.side)) return;
      if (found.normal.dot(b.placed.normal) < 0.0 || found.normal.dot(a.placed.normal) > 0.0) return;
      visit(a, b, found, key(Part::edges, one.number, other.number));
    });
  }

  /// Visits the edges of two lists whose boxes come within the alarm distance of each other.
  template <class Visit>
  void each_near(const std::vector<Edge>& all, std::vector<Edge> others, const Visit& visit) const {
    std::sort(others.begin(), others.end(),
              [](const Edge& a, const Edge& b) { return a.box.min().x() < b.box.min().x(); });
    double widest = 0.0;
    for (const Edge& other : others) widest = std::max(widest, other.box.sizes().x());
    for (const Edge& one : all) {
      threads::Interruption::check();
      const contact::Box where = grown(one.box);
      auto other = std::partition_point(others.begin(), others.end(), [&](const Edge& edge) {
        return edge.box.min().x() < where.min().x() - widest;
      });
      for (; other != others.end() && other->box.min().x() <= where.max().x(); ++other) {
        if (where.intersects(other->box)) visit(one, *other);
      }
    }
  }

  /// Whether an edge that lies behind another one, as their normal has it, lies in the other's body: far from the two
  /// faces beside it there is no inside.
  bool crosses_inside(const Edge& a, const Edge& b, const contact::Nearest& found) const {
    const double gap = found.gap + a.placed.radius + b.placed.radius;            // of the axes
    if (gap > -1e-6 * start_.model.size || a.side.on == b.side.on) return true;  // (a body is not in itself)
    const auto at = [](const Edge& own, const std::array<double, 3>& weights) {
      return Vec3(weights[0] * own.placed.x[0] + weights[1] * own.placed.x[1]);
    };
    const auto in = [this](const Collider& body, const Vec3& point) {
      return body.kind == Kind::rod || depth_in(body, contact::point_at(point, stands_out(start_.model, body))) > 0.0;
    };
    return in(b.side.on, at(a, found.a)) && in(a.side.on, at(b, found.b));
  }

  /// Whether two edges are as good as parallel: the plane through thin ones is no normal then, and the axis of a
  /// capsule is as near at one place as at another. Ends of edges meet what they lie beside; of thick ones only points
  /// do, so all of an edge has to lie along the axis. (Rods bend between their ends.)
  bool side_by_side(const Edge& a, const Edge& b) const {
    if (a.side.on.kind == Kind::rod || b.side.on.kind == Kind::rod) return false;
    const bool a_thick = a.placed.radius > 0.0;
    const Simplex &axis = a_thick ? a.placed : b.placed, &edge = a_thick ? b.placed : a.placed;
    const Vec3 d = axis.x[1] - axis.x[0], e = edge.x[1] - edge.x[0];
    const double sine2 = d.cross(e).squaredNorm() / std::max(d.squaredNorm() * e.squaredNorm(), 1e-300);
    if (axis.radius == 0.0) return sine2 < 1e-4;
    const double from = d.dot(edge.x[0] - axis.x[0]), to = d.dot(edge.x[1] - axis.x[0]);
    const bool beside = std::min(from, to) >= 0.0 && std::max(from, to) <= d.squaredNorm();
    // By how much it may be nearer between its ends, if they cross in the middle.
    const double nearer = e.squaredNorm() * sine2 / (8.0 * axis.radius);
    return beside && nearer < kSideBySide * start_.model.size;
  }

  static bool rod_piece(const ContactSide& side) { return side.on.kind == Kind::rod && side.local.corners() == 2; }

  /// Whether two edges meet between their ends: there, points do. Pieces of rods follow each other.
  static bool within(const contact::Nearest& found, const ContactSide& a, const ContactSide& b) {
    const auto inside = [](const ContactSide& side, double t) {
      return side.on.kind == Kind::rod || (t > kSame && t < 1.0 - kSame);
    };
    return inside(a, found.a[1]) && inside(b, found.b[1]);
  }

  static bool neighbours(const ContactSide& a, const ContactSide& b) {
    const auto of_b = [&b](int node) { return node == b.nodes[0] || node == b.nodes[1]; };
    return of_b(a.nodes[0]) || of_b(a.nodes[1]);
  }

  static constexpr double kSame = 1e-9;        ///< part of an edge at whose ends two points are one
  static constexpr double kSideBySide = 1e-8;  ///< of the scene's size: how much nearer edges may be than their ends
  const Moment& start_;
  double alarm_, depth_, shallow_ = 0.0;
  const Surfaces& surfaces_;
  std::vector<ContactState>& found_;
  int pair_ = 0;
  std::vector<contact::Meeting> meetings_;
  mutable std::vector<std::pair<Collider, contact::Box>> around_;  ///< of the pair's two, once they were asked for
};

}  // namespace

void search(const Moment& start, double alarm, double depth, const Surfaces& surfaces, int number,
            std::vector<ContactState>& found) {
  Search(start, alarm, depth, surfaces, found).pair(number);
}

void search_whole(const Moment& start, double alarm, double depth, const Surfaces& surfaces, int number,
                  std::vector<ContactState>& found) {
  Search search(start, alarm, depth, surfaces, found);
  search.whole_pieces = true;
  search.pair(number);
}

double depth_between_triangles(const Moment& now, const Surfaces& surfaces, int number) {
  std::vector<ContactState> none;
  return Search(now, 0.0, 0.0, surfaces, none).depth_between_triangles(number);
}

bool edges_stay_clear(const StepMotion& motion, const Surfaces& surfaces, int number, double speed, double margin) {
  std::vector<ContactState> none;
  return Search(motion.start, speed + margin, 0.0, surfaces, none).edges_stay_clear(motion, number, speed, margin);
}

double overlap(const Moment& now, const Surfaces& surfaces, int number) {
  std::vector<ContactState> none;
  return Search(now, 0.0, 0.0, surfaces, none).overlap(number);
}

}  // namespace sinew
