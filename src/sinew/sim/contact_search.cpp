#include "sinew/sim/contact_search.hpp"

#include <algorithm>
#include <cmath>

namespace sinew {

using Kind = Collider::Kind;
using contact::Simplex;

void fit(const SolidModel& model, const Eigen::Matrix3Xd& x, Surface& own) {
  own.outward.setZero(3, x.cols());
  own.boxes.clear();
  for (const solid::Triangle& t : model.surface) {
    const Vec3 area = (x.col(t[1]) - x.col(t[0])).cross(x.col(t[2]) - x.col(t[0]));
    contact::Box& box = own.boxes.emplace_back();
    for (const int node : t) {
      own.outward.col(node) += area;
      box.extend(Vec3(x.col(node)));
    }
  }
  if (own.boxes.empty()) return;
  own.outward.colwise().normalize();
  if (own.faces.whole().isEmpty()) {
    own.faces = model.faces;
    own.edges = model.edges;
  }
  own.faces.fit(own.boxes);
  own.boxes.clear();
  for (const Ridge& ridge : model.ridges) {
    contact::Box& box = own.boxes.emplace_back();
    for (const int node : ridge.ends) box.extend(Vec3(x.col(node)));
  }
  own.edges.fit(own.boxes);
}

namespace {

class Search {
 public:
  Search(const Moment& start, double alarm, const std::vector<Surface>& surfaces, std::vector<ContactState>& found)
      : start_(start), alarm_(alarm), surfaces_(surfaces), found_(found) {}

  void pair(int number) {
    pair_ = number;
    const PairModel& own = start_.model.pairs[number];
    if (is_rigid(own.a) && is_rigid(own.b)) {
      shapes(own.a, own.b);
      return;
    }
    points_and_faces(own.a, own.b, Part::point_of_first);
    if (own.a != own.b) points_and_faces(own.b, own.a, Part::point_of_second);
    edges(own.a, own.b);
  }

 private:
  /// By which a contact of a pair is known again: what it is, and the numbers of its two parts.
  enum class Part : std::uint64_t { point_of_first, point_of_second, edges };
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

  void add(const ContactSide& a, const ContactSide& b, std::uint64_t part) {
    if (!moves(a) && !moves(b)) return;
    ContactState& own = found_.emplace_back();
    own.pair = pair_;
    own.part = part;
    own.a = a;
    own.b = b;
  }

  void shapes(const Collider& first, const Collider& second) {
    meetings_.clear();
    contact::meet(shape_of(start_.model, first), start_.pose(first), shape_of(start_.model, second),
                  start_.pose(second), alarm_, meetings_);
    for (const contact::Meeting& met : meetings_) {
      ContactSide a, b;
      a.on = met.swapped ? second : first;
      b.on = met.swapped ? first : second;
      a.local = met.a;
      b.local = met.b;
      add(a, b, met.key);
    }
  }

  /// Visits the parts of an object with which it pokes into others, of one kind, with their numbers: nodes and ridges
  /// of a solid near `where`, points and pieces of a rod, corners and edges of a shape.
  template <class Visit>
  void each_prong(const Collider& own, Simplex::Kind kind, const contact::Box& where, const Visit& visit) const {
    ContactSide side;
    side.on = own;
    side.local.kind = kind;
    if (is_rigid(own)) {
      const std::vector<Simplex> all = contact::prongs(shape_of(start_.model, own));
      for (std::size_t i = 0; i < all.size(); ++i) {
        if (all[i].kind != kind) continue;
        side.local = all[i];
        visit(side, static_cast<int>(i));
      }
    } else if (own.kind == Kind::rod) {
      const RodModel& rod = start_.model.rods[own.number];
      const std::size_t count = rod.touching.size(), used = kind == Simplex::Kind::point ? 1 : 2;
      for (std::size_t i = 0; i + used <= count; ++i) {
        side.local.radius = 0.0;
        for (std::size_t k = 0; k < used; ++k) {
          side.abscissae[k] = rod.touching[i + k];
          side.local.radius = std::max(side.local.radius, rod::radius_at(rod.rod.profile, rod.touching[i + k]));
        }
        visit(side, static_cast<int>(i));
      }
    } else {
      const SolidModel& solid = start_.model.solids[own.number];
      const Eigen::Matrix3Xd& x = start_.state.solids[own.number].x;
      if (kind == Simplex::Kind::point) {
        for (const int node : solid.surface_nodes) {
          if (!where.contains(Vec3(x.col(node)))) continue;
          side.nodes[0] = node;
          visit(side, node);
        }
        return;
      }
      surfaces_[own.number].edges.each_near(where, [&](int number) {
        const Ridge& ridge = solid.ridges[number];
        const auto normal = [&](int third) {
          return (x.col(ridge.ends[1]) - x.col(ridge.ends[0])).cross(x.col(third) - x.col(ridge.ends[0])).normalized();
        };
        // One of the two is turned the other way; which does not matter for how much they differ.
        const Vec3 one = normal(ridge.sides[0]), other = -normal(ridge.sides[1]);
        const Vec3 outward =
            (surfaces_[own.number].outward.col(ridge.ends[0]) + surfaces_[own.number].outward.col(ridge.ends[1]))
                .normalized();
        if (ridge.sides[0] != ridge.sides[1]) {
          const Vec3 inward = 0.5 * (x.col(ridge.sides[0]) + x.col(ridge.sides[1])) - x.col(ridge.ends[0]);
          if (one.dot(other) > kFlat || inward.dot(outward) > 0.0) return;  // flat or a valley: points meet it
        }
        side.nodes = {ridge.ends[0], ridge.ends[1], 0};
        side.local.normal = outward;
        visit(side, number);
      });
    }
  }

  /// Of all of an object, and the alarm distance around.
  contact::Box around(const Collider& own) const {
    contact::Box box;
    if (is_rigid(own)) {
      const contact::Pose pose = start_.pose(own);
      const Vec3 reach = contact::reach(shape_of(start_.model, own), pose.R.transpose());
      box = contact::Box(Vec3(pose.p - reach), Vec3(pose.p + reach));
    } else if (own.kind == Kind::solid) {
      box = surfaces_[own.number].faces.whole();
    } else {
      const RodModel& rod = start_.model.rods[own.number];
      for (const double s : rod.touching) {
        const Vec3 p = rod::position(start_.rods[own.number], s),
                   r = Vec3::Constant(rod::radius_at(rod.rod.profile, s));
        box.extend(contact::Box(Vec3(p - r), Vec3(p + r)));
      }
    }
    return grown(box);
  }

  contact::Box grown(contact::Box box, double radius = 0.0) const {
    box.min().array() -= alarm_ + radius;
    box.max().array() += alarm_ + radius;
    return box;
  }

  void points_and_faces(const Collider& poking, const Collider& faced, Part part) {
    if (faced.kind == Kind::rod) return;  // thin: edges meet it
    each_prong(poking, Simplex::Kind::point, around(faced), [&](const ContactSide& a, int number) {
      const Simplex point = start_.placed(a);
      if (is_rigid(faced)) {
        add_shape(a, point, faced, key(part, number, 0));
      } else {
        add_faces(a, point, faced, number, part);
      }
    });
  }

  void add_shape(const ContactSide& a, const Simplex& point, const Collider& hard, std::uint64_t part) {
    const contact::Pose pose = start_.pose(hard);
    const Vec3 own = pose.R.transpose() * (point.x[0] - pose.p);
    ContactSide b;
    b.on = hard;
    b.local = contact::nearest_part(shape_of(start_.model, hard), own);
    if (contact::nearest(contact::point_at(own, point.radius), b.local).gap < alarm_) add(a, b, part);
  }

  /// A thin point meets the nearest face. A thick one may lie in a hollow and touch many, so it meets all that it is in
  /// front of: each with its own nearest point, which may lie on an edge that others share.
  void add_faces(const ContactSide& a, const Simplex& point, const Collider& soft, int prong, Part part) {
    const SolidModel& solid = start_.model.solids[soft.number];
    const bool itself = a.on == soft, thick = point.radius > 0.0;
    ContactSide b;
    b.on = soft;
    b.local.kind = Simplex::Kind::triangle;
    double nearest = alarm_;
    bool in_front = false;
    std::array<int, 3> nodes{};
    contact::Vec3 outward = contact::Vec3::Zero();
    const contact::Box where = grown(contact::Box(point.x[0]), point.radius);
    surfaces_[soft.number].faces.each_near(where, [&](int number) {
      b.nodes = solid.surface[number];
      if (itself && near_at_rest(solid, a.nodes[0], b.nodes)) return;
      b.local.normal.setZero();
      Simplex face = start_.placed(b);
      contact::Nearest found = contact::nearest(point, face);
      // Past an edge of the surface, the two faces tell together what is outside.
      for (std::size_t i = 0; i < 3; ++i) b.local.normal += found.b[i] * surfaces_[soft.number].outward.col(b.nodes[i]);
      face.normal = b.local.normal;
      found = contact::nearest(point, face);
      const bool corner = std::max({found.b[0], found.b[1], found.b[2]}) >= 1.0;
      // Corners are the business of the nodes, and so is all of a fine mesh: between nodes on a ball of radius r its
      // edges e lie e^2 / 8 r deep in it.
      if (thick && is_rigid(a.on) && (corner || longest_edge(face) < 0.5 * point.radius)) return;
      if (std::abs(found.gap) >= alarm_) return;
      const Vec3 n = (face.x[1] - face.x[0]).cross(face.x[2] - face.x[0]);
      if (thick && n.dot(point.x[0] - face.x[0]) > 0.0) {
        add(a, b, key(part, prong, number));
        in_front = true;
      }
      if (std::abs(found.gap) >= nearest) return;
      // The far side of something thin, or round the corner of what the point is above.
      if (a.on.kind == Kind::solid && n.dot(surfaces_[a.on.number].outward.col(a.nodes[0])) >= 0.0) return;
      nearest = std::abs(found.gap);
      nodes = b.nodes;
      outward = b.local.normal;
    });
    if (nearest == alarm_ || in_front) return;
    b.nodes = nodes;
    b.local.normal = outward;
    add(a, b, key(part, prong, 0));
  }

  static double longest_edge(const Simplex& face) {
    double edge = 0.0;
    for (std::size_t i = 0; i < 3; ++i) edge = std::max(edge, (face.x[i] - face.x[(i + 1) % 3]).norm());
    return edge;
  }

  /// Whether a node and a triangle of the same solid are neighbours.
  bool near_at_rest(const SolidModel& solid, int node, const std::array<int, 3>& face) const {
    const auto at = [&](int n) { return Vec3(solid.body.rest.col(n)); };
    const Simplex rest{Simplex::Kind::triangle, {at(face[0]), at(face[1]), at(face[2])}, Vec3::Zero(), 0.0};
    return std::abs(contact::nearest(contact::point_at(at(node), 0.0), rest).gap) < 0.5 * longest_edge(rest);
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
      Edge edge{side, start_.placed(side), {}, number};
      edge.box.extend(edge.placed.x[0]);
      edge.box.extend(edge.placed.x[1]);
      edge.box.min().array() -= edge.placed.radius;
      edge.box.max().array() += edge.placed.radius;
      if (edge.box.intersects(where)) all.push_back(edge);
    });
    return all;
  }

  void edges(const Collider& first, const Collider& second) {
    const std::vector<Edge> all = edges_of(first, around(second));
    if (all.empty()) return;
    std::vector<Edge> others = first == second ? all : edges_of(second, around(first));
    std::sort(others.begin(), others.end(),
              [](const Edge& a, const Edge& b) { return a.box.min().x() < b.box.min().x(); });
    double widest = 0.0;
    for (const Edge& other : others) widest = std::max(widest, other.box.sizes().x());
    for (const Edge& one : all) {
      const contact::Box where = grown(one.box);
      auto other = std::partition_point(others.begin(), others.end(), [&](const Edge& edge) {
        return edge.box.min().x() < where.min().x() - widest;
      });
      for (; other != others.end() && other->box.min().x() <= where.max().x(); ++other) {
        if (!where.intersects(other->box)) continue;
        if (first == second && (one.number >= other->number || neighbours(one.side, other->side))) continue;
        // What has an outside comes second.
        const bool turned = other->placed.normal.isZero() && !one.placed.normal.isZero();
        const Edge &a = turned ? *other : one, &b = turned ? one : *other;
        const contact::Nearest found = contact::nearest(a.placed, b.placed);
        if (std::abs(found.gap) >= alarm_ || !within(found, a.side, b.side)) continue;
        if (found.normal.dot(b.placed.normal) < 0.0 || found.normal.dot(a.placed.normal) > 0.0) continue;
        add(a.side, b.side, key(Part::edges, one.number, other->number));
      }
    }
  }

  /// Whether two edges meet between their ends: there, points do. Pieces of rods follow each other.
  static bool within(const contact::Nearest& found, const ContactSide& a, const ContactSide& b) {
    const auto inside = [](const ContactSide& side, double t) {
      return side.on.kind == Kind::rod || (t > 0.0 && t < 1.0);
    };
    return inside(a, found.a[1]) && inside(b, found.b[1]);
  }

  static bool neighbours(const ContactSide& a, const ContactSide& b) {
    for (std::size_t i = 0; i < 2; ++i) {
      for (std::size_t j = 0; j < 2; ++j) {
        if (a.nodes[i] == b.nodes[j]) return true;
      }
    }
    return false;
  }

  static constexpr double kFlat = 0.985;  ///< cosine of 10 degrees
  const Moment& start_;
  double alarm_;
  const std::vector<Surface>& surfaces_;
  std::vector<ContactState>& found_;
  int pair_ = 0;
  std::vector<contact::Meeting> meetings_;
};

}  // namespace

void search(const Moment& start, double alarm, const std::vector<Surface>& surfaces, int number,
            std::vector<ContactState>& found) {
  Search(start, alarm, surfaces, found).pair(number);
}

}  // namespace sinew
