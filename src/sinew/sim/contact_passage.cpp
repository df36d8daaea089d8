#include "sinew/sim/contact_passage.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <span>
#include <utility>

#include "sinew/sim/contact_folds.hpp"
#include "sinew/sim/contact_way.hpp"
#include "sinew/threads/interruption.hpp"

namespace sinew {

namespace {

using Kind = Collider::Kind;

/// Part of the thinner of two by which they may overlap.
constexpr double kDeepest = 0.25;
/// And by which a rod may lie in what it touches between the places where it does, or an edge in a surface between its
/// nodes, unsaid.
constexpr double kDeepestBetween = 0.1;
/// And that parts of rigid shapes may come to overlap in a step by which these were not near each other.
constexpr double kDeepestMade = 0.02;
/// And by which what presses may be apart.
constexpr double kFarthest = 0.02;

/// How far a point is outside a surface [m], if that is less than `far`, or else infinite; 0 inside.
double gap_to_surface(const Surface& surface, const Vec3& point, double far) {
  if (contact::inside(*surface.mesh, surface.x, surface.faces, point)) return 0.0;
  const double least = distance_to_triangles(surface, point, far);
  return least < far ? least : INFINITY;
}

/// By how much more a contact is open at the end of a step than its two parts have it [m], where that is more than
/// `most`; else 0. `surfaces` of the end are fitted once they are needed.
double beyond_its_parts(const StepMotion& motion, const ContactState& own, const Touch& touch, double most,
                        std::optional<Surfaces>& surfaces) {
  const Moment& end = motion.end;
  const double gap = std::max(0.0, touch.u[0]);
  const auto gap_to = [&end](const Collider& hard, const Vec3& point) {
    const contact::Pose pose = end.pose(hard);
    return gap_to_shape(shape_of(end.model, hard), pose.R.transpose() * (point - pose.p), 0.0);
  };
  double more = 0.0;  // (flat parts meet a cylinder at edges that stand out of it)
  if (is_shape(end.model, own.b.on)) {
    more = gap_to(own.b.on, touch.point_a) - stands_out(end.model, own.b.on) - gap;
  } else if (is_shape(end.model, own.a.on)) {
    more = gap_to(own.a.on, touch.point_b) - stands_out(end.model, own.a.on) - gap;
  } else {
    more = separation(motion, own, 1.0) - gap;
  }
  if (!(more > most)) return 0.0;
  // Other parts may be near: corners of what is clipped to a face stand for the edges there.
  const PairModel& pair = end.model.pairs[static_cast<std::size_t>(own.pair)];
  if (are_shapes(end.model, pair)) {
    more = std::min(more, gap_of_shapes(motion, pair, 1.0, gap + more) - gap);
  } else if (!is_shape(end.model, own.b.on)) {  // corners go from one triangle to the next
    if (!surfaces) surfaces.emplace().fit(end);
    const Surface *of_a = surfaces->of(own.a.on), *of_b = surfaces->of(own.b.on);
    if (!of_a && !of_b) return is_shape(end.model, own.a.on) ? more : 0.0;  // pieces of rods end where they do
    const double there =
        of_b ? gap_to_surface(*of_b, touch.point_a, gap + more) : gap_to_surface(*of_a, touch.point_b, gap + more);
    more = std::min(more, there - gap);
  }
  return more > most ? more : 0.0;
}

/// What of a pair was taken to fly past (`ContactRoom::passing` goes by pairs).
std::span<const ContactState> passing_of(const ContactRoom& room, int pair) {
  const auto end = room.passing.end();
  const auto first = std::partition_point(room.passing.begin(), end, [&](const auto& one) { return one.pair < pair; });
  return {first, std::partition_point(first, end, [&](const auto& one) { return one.pair == pair; })};
}

/// Whether what was taken to fly past has stayed clear of the other object, if by half as much.
bool all_stay_clear(const StepMotion& motion, const ContactRoom& room, std::span<const ContactState> passing,
                    int number, double speed) {
  const Model& model = motion.start.model;
  const double margin = 0.5 * kClearance * room.thin[static_cast<std::size_t>(number)];
  const PairModel& pair = model.pairs[static_cast<std::size_t>(number)];
  if (are_shapes(model, pair)) return shapes_stay_clear(motion, pair, margin);
  return std::all_of(passing.begin(), passing.end(),
                     [&](const ContactState& candidate) {
                       return point_stays_clear(motion, candidate, room.surfaces, speed, margin);
                     }) &&
         edges_stay_clear(motion, room.surfaces, number, speed, margin);
}

}  // namespace

Passage look_again(const StepContext& context, const State& next, const ContactRoom& room, bool evaluated,
                   double alarm) {
  Passage found;
  const Model& model = context.model;
  if (model.pairs.empty()) return found;
  // Of what is deeper than it may be, the deepest counts; but what doing the step again may mend goes before what makes
  // it be refused.
  const auto may_be_mended = [](Passage::Kind kind) {
    return kind == Passage::Kind::missed || kind == Passage::Kind::met || kind == Passage::Kind::left_behind;
  };
  const auto note = [&](Passage::Kind kind, std::size_t pair, double depth, double most) {
    if (!(depth > most)) return;
    if (may_be_mended(kind) == may_be_mended(found.kind) ? !(depth > found.depth) : may_be_mended(found.kind)) return;
    found.kind = kind;
    found.pair = static_cast<int>(pair);
    found.depth = depth;
  };
  const auto note_overlap = [&found](std::size_t pair, double depth, double least, bool between_nodes = false) {
    if (!(depth > std::max(least, found.overlap))) return;
    found.overlap = depth;
    found.between_nodes = between_nodes;
    found.overlapping = static_cast<int>(pair);
  };
  if (room.touches.size() == next.contacts.size()) {
    for (std::size_t i = 0; i < room.touches.size(); ++i) {
      const auto pair = static_cast<std::size_t>(next.contacts[i].pair);
      note(Passage::Kind::passed, pair, overlap_of(model, next, room, i), kDeepest * room.thin[pair]);
    }
  }
  std::vector<rod::Configuration> configured;
  const bool there = evaluated && !next.contacts.empty();  // (without contacts nothing is evaluated)
  if (!there) configure_touching(model, context.bases, next, configured);
  const std::vector<rod::Configuration>& rods = there ? room.now : configured;
  const std::vector<Placement> frames = frames_at(model, context.start.time);
  const Moment start{model, context.start, frames, room.start};
  const Moment end{model, next, context.displacement, rods};
  const StepMotion motion{start, end};
  std::optional<Surfaces> ended;
  if (evaluated && room.touches.size() == next.contacts.size()) {
    for (std::size_t i = 0; i < room.touches.size(); ++i) {
      const ContactState& own = next.contacts[i];
      if (!(own.force.dot(room.touches[i].nearest.normal) > 0.0)) continue;
      const double beyond = beyond_its_parts(motion, own, room.touches[i], kFarthest * room.thin[own.pair], ended);
      if (beyond > 0.0) found.left_behind.emplace_back(own.pair, own.part);
      note(Passage::Kind::left_behind, static_cast<std::size_t>(own.pair), beyond, 0.0);
    }
  }
  std::map<std::pair<Kind, int>, double> moved;
  const auto motion_of = [&](const Collider& own) {
    const auto [place, fresh] = moved.try_emplace({own.kind, own.number}, 0.0);
    if (fresh) place->second = farthest(motion, room.surfaces, own);
    return place->second;
  };
  const auto was_near = [&room](std::size_t pair) {
    return std::any_of(room.found.begin(), room.found.end(),
                       [pair](const ContactKey& own) { return own.first == static_cast<int>(pair); });
  };
  std::vector<ContactState> candidates;
  for (std::size_t i = 0; i < model.pairs.size(); ++i) {
    threads::Interruption::check();
    const PairModel& pair = model.pairs[i];
    const auto number = static_cast<int>(i);
    const double speed = motion_of(pair.a) + motion_of(pair.b);
    found.alarm = std::max(found.alarm, speed);
    const double thin = room.thin[i];
    // (Whatever was found: chords of what has folded may lie too deep to be met.)
    const FoldDepth fold = depth_of_fold(motion, pair, speed, thin);
    note_overlap(i, fold.end - pair.depth, kDeepestBetween * thin);
    note(Passage::Kind::folded, i, std::max(fold.end, fold.way) - pair.depth, kDeepest * thin);
    const bool rods_meet = pair.a.kind == Kind::rod || pair.b.kind == Kind::rod;  // (their chords may lie too deep)
    const auto cut_at = [&](const Moment& now, const Surfaces& surfaces) {
      return depth_between_triangles(now, surfaces, number) - pair.depth;
    };
    const std::span<const ContactState> passing = passing_of(room, number);
    const bool shapes = are_shapes(model, pair), some_pass = !passing.empty();
    const auto note_met = [&](double depth, double most) {
      if (depth > most) found.met.push_back(number);
      note(Passage::Kind::met, i, depth, most);
    };
    if (!rods_meet && (mesh_of(model, pair.a) || mesh_of(model, pair.b))) {
      const double before = cut_at(start, room.surfaces);
      // (No deeper at the end than at the start and what the two have moved.)
      if (some_pass || before + speed > kDeepestBetween * thin) {
        if (!ended) ended.emplace().fit(end);
        const double cut = cut_at(end, *ended);
        if (some_pass) note_met(cut - before, kClearance * thin);
        note_overlap(i, cut, kDeepestBetween * thin, true);
        note(Passage::Kind::cut, i, cut, kDeepest * thin);
      }
    }
    const bool known = shapes && was_near(i);
    if (known) {  // parts that were not listed may have come in
      const double depth = overlap_of_shapes(motion, pair, 1.0) - pair.depth;
      note_overlap(i, depth, 0.0);
      note(Passage::Kind::passed, i, depth, kDeepest * thin);
      if (context.rate > 0.0 && depth > kDeepestMade * thin) {
        const double made = depth + pair.depth - std::max(pair.depth, overlap_of_shapes(motion, pair, 0.0));
        note(Passage::Kind::passed, i, made, kDeepestMade * thin);
      }
    }
    // Two that were apart have to move by the thickness of both to get to each other's other side. (What is not met may
    // come in however little it moves.)
    const bool all_are_met = std::find(room.left_out.begin(), room.left_out.end(), number) == room.left_out.end();
    if (some_pass && !all_stay_clear(motion, room, passing, number, speed)) note_met(kClearance * thin, 0.0);
    if (all_are_met && speed <= std::min(alarm, 0.5 * thin)) continue;
    const auto meets = [&](bool was_found, double depth) {
      if (was_found) {
        note(Passage::Kind::passed, i, depth, kDeepest * thin);
      } else {
        note(Passage::Kind::missed, i, depth, 1e-6 * model.size);
      }
    };
    if (shapes) {
      meets(known, deepest_of_shapes(motion, pair, speed, thin));
      continue;
    }
    candidates.clear();
    search_whole(start, speed, std::max(pair.depth, 1e-3 * model.size), room.surfaces, number, candidates);
    for (const ContactState& own : candidates) {
      const std::pair<int, std::uint64_t> key(own.pair, own.part);
      // (What the chord of a bent rod overlaps at the start would not be found with any other alarm distance either.)
      const bool was_found =
          std::binary_search(room.found.begin(), room.found.end(), key) || separation(motion, own, 0.0) < 0.0;
      meets(was_found, deepest_of_parts(motion, own, speed, thin));
    }
  }
  return found;
}

}  // namespace sinew
