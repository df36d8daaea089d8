#include "sinew/sim/contact_merging.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

namespace sinew {

namespace {

using Kind = Collider::Kind;
using contact::Simplex;

/// Where a rod is touched by something else.
struct Spot {
  bool on_a = false;           ///< the rod is the contact's first side
  bool on_piece = false;       ///< else at a point
  bool at_end = false;         ///< of its piece
  double s = 0.0;              ///< [m] abscissa
  double length = 0.0;         ///< [m] of the piece
  double gap = 0.0;            ///< [m]
  Vec3 normal = Vec3::Zero();  ///< towards the rod
};

const ContactSide& rod_side(const ContactState& own) { return own.a.on.kind == Kind::rod ? own.a : own.b; }

Spot spot_of(const Moment& start, const ContactState& own) {
  const Simplex a = start.placed(own.a), b = start.placed(own.b);
  contact::Nearest nearest = contact::nearest(a, b);
  follow_curves(start, own, a, b, nearest);
  Spot spot;
  spot.on_a = own.a.on.kind == Kind::rod;
  const ContactSide& side = rod_side(own);
  const std::array<double, 3>& weights = spot.on_a ? nearest.a : nearest.b;
  spot.on_piece = side.local.corners() == 2;
  spot.at_end = weights[1] <= 0.0 || weights[1] >= 1.0;
  spot.s = abscissa_of(side, weights);
  if (spot.on_piece) spot.length = side.abscissae[1] - side.abscissae[0];
  spot.gap = nearest.gap;
  spot.normal = spot.on_a ? nearest.normal : Vec3(-nearest.normal);
  return spot;
}

const ContactSide& other_side(const ContactState& own, const Spot& spot) { return spot.on_a ? own.b : own.a; }

bool same_part(const ContactSide& a, const ContactSide& b) {
  if (!(a.on == b.on) || a.nodes != b.nodes || a.abscissae != b.abscissae || a.local.kind != b.local.kind) return false;
  if (!is_rigid(a.on)) return true;  // (places are those of nodes and abscissae)
  const auto &x = a.local.x, &y = b.local.x;
  if (a.local.corners() < 2) return x[0] == y[0];
  return (x[0] == y[0] && x[1] == y[1]) || (x[0] == y[1] && x[1] == y[0]);  // (an axis may be told from either end)
}

/// A contact of one rod with something else. (Two rods touch with pieces alone.)
bool of_one_rod(const ContactState& own) { return (own.a.on.kind == Kind::rod) != (own.b.on.kind == Kind::rod); }

/// Whether two of them are of parts of one rod that overlap or follow each other.
bool adjoin(const ContactState& one, const ContactState& other) {
  const auto last = [](const ContactSide& own) { return own.abscissae[own.local.corners() == 2 ? 1 : 0]; };
  const ContactSide &a = rod_side(one), &b = rod_side(other);
  return a.on == b.on && a.abscissae[0] <= last(b) && b.abscissae[0] <= last(a);
}

/// Whether two pieces of one rod touch the same part at the same place.
bool meet_there(const ContactState& one, const Spot& p, const ContactState& other, const Spot& q) {
  constexpr double kSame = 0.1;  // of a piece
  if (!p.on_piece || !q.on_piece || p.on_a != q.on_a) return false;
  return same_part(other_side(one, p), other_side(other, q)) &&
         std::abs(p.s - q.s) <= kSame * std::min(p.length, q.length);
}

/// Whether a piece and a point of the rod beside it touch the same part at the same place.
bool beside(const ContactState& piece, const Spot& p, const ContactState& point, const Spot& q) {
  constexpr double kBeside = 0.25;  // of the piece
  constexpr double kAlike = 0.9;    // cosine of the angle between the normals
  return p.on_piece && !q.on_piece && same_part(other_side(piece, p), other_side(point, q)) &&
         std::abs(p.s - q.s) <= kBeside * p.length && p.normal.dot(q.normal) > kAlike;
}

/// The force of one that goes, to one that stays.
void hand_over(const ContactState& from, const Spot& by, ContactState& to, const Spot& at) {
  if (!to.force.isZero(0.0)) return;
  const double sign = by.on_a == at.on_a ? 1.0 : -1.0;
  to.force = sign * from.force;
  to.normal = sign * from.normal;
}

}  // namespace

void merge_rod_contacts(const Moment& start, const std::vector<double>& thin, std::vector<ContactState>& found) {
  constexpr double kAsNear = 0.01;  // of the thickness
  std::vector<std::optional<Spot>> spots(found.size());
  std::vector<bool> goes(found.size(), false);
  const auto drop = [&](std::size_t gone, std::size_t kept) {
    goes[gone] = true;
    hand_over(found[gone], *spots[gone], found[kept], *spots[kept]);
  };
  const auto each_of_pair = [&](const auto& visit) {
    for (std::size_t i = 0; i < found.size(); ++i) {
      if (!of_one_rod(found[i])) continue;
      for (std::size_t j = i + 1; j < found.size() && found[j].pair == found[i].pair; ++j) {
        if (goes[i] || goes[j] || !of_one_rod(found[j]) || !adjoin(found[i], found[j])) continue;
        for (const std::size_t k : {i, j}) {
          if (!spots[k]) spots[k] = spot_of(start, found[k]);
        }
        visit(i, j, *spots[i], *spots[j]);
      }
    }
  };
  each_of_pair([&](std::size_t i, std::size_t j, const Spot& p, const Spot& q) {
    if (!meet_there(found[i], p, found[j], q)) return;
    const bool first = p.at_end != q.at_end ? q.at_end : !found[i].force.isZero(0.0) || found[j].force.isZero(0.0);
    drop(first ? j : i, first ? i : j);
  });
  each_of_pair([&](std::size_t i, std::size_t j, const Spot& p, const Spot& q) {
    const bool point_last = beside(found[i], p, found[j], q);
    if (!point_last && !beside(found[j], q, found[i], p)) return;
    const std::size_t piece = point_last ? i : j, point = point_last ? j : i;
    const double as_near = kAsNear * thin[static_cast<std::size_t>(found[i].pair)];
    const bool piece_stays = spots[piece]->gap <= spots[point]->gap + as_near;
    drop(piece_stays ? point : piece, piece_stays ? piece : point);
  });
  std::size_t kept = 0;
  for (std::size_t i = 0; i < found.size(); ++i) {
    if (!goes[i]) found[kept++] = found[i];
  }
  found.resize(kept);
}

}  // namespace sinew
