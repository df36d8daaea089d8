// Ties: material points of rods held, position and axes, by the ground, frames, solids, rigid bodies or other rods.
//
// With y the point held and d_a its axes, `length` long (of a body unknowns that rows hold to it, else given), X the
// rod's point, and e_b the holder's axes as the rod's cross-section carries them:
//     along a:   c = d_a . (y - X) / length
//     about a:   c = d_c . R e_b  or  c = - d_b . R e_c,             (a, b, c) in cyclic order
//
// Both hold the turn about d_a where the axes agree. Of two that are held, both say where the third axis k goes (b or c
// is k), R e_k = d_k, which they do however far the rod has turned about it; with others they would become the same row
// at 90 degrees. One alone is a universal joint with the axes d_c and e_b, at right angles whatever it turns.
// All curvature is between the rod and (y, d): none reaches into the nodes of a solid.
#include <Eigen/Dense>
#include <algorithm>

#include "sinew/sim/rod_rows.hpp"

namespace sinew {

namespace {

/// Point held and axes, as columns `length` long.
struct Holder {
  Vec3 y;
  rod::Mat3 d;
};

Holder holder(const StepContext& context, const State& iterate, const TieModel& tie) {
  if (!tie.body()) {
    const Placement now = compose(context.moved(tie.frame), tie.holder);
    return {now.p, tie.length * now.R};
  }
  const int at = tie.unknown - context.model.first_followed;
  Holder own{iterate.followed.segment<3>(at), tie.length * tie.holder.R};
  if (tie.directors) own.d = Eigen::Map<const rod::Mat3>(iterate.followed.data() + at + 3);
  return own;
}

}  // namespace

HeldTurn held_turn(const TieModel& tie, int about) {
  const int b = (about + 1) % 3, c = (about + 2) % 3;
  const bool free_c = tie.about.size() == 2 && std::find(tie.about.begin(), tie.about.end(), c) == tie.about.end();
  return free_c ? HeldTurn{c, b, -1.0} : HeldTurn{b, c, 1.0};
}

namespace {

/// The rows of a tie, seen from the rod that is held.
void add_held(RodRows& rod, const TieModel& tie) {
  solve::CoupledProblem& problem = rod.problem();
  const Holder held = holder(rod.context(), rod.iterate(), tie);
  const rod::CurvePoint point = rod::curve_point(rod.shape(), tie.s);
  const Vec3 gap = held.y - point.position;
  const double l = tie.length;
  int row = tie.row;
  const auto director = [&](int a) { return tie.unknown + 3 + 3 * a; };
  const auto count = [&](double c) {
    problem.c[row] = c;
    rod.reduced().violation = std::max(rod.reduced().violation, std::abs(c));
    rod.reduced().scale = std::max(rod.reduced().scale, std::abs(rod.iterate().lambda[row]));
  };
  for (const int a : tie.along) {
    const double lambda = rod.iterate().lambda[row];
    const Vec3 direction = held.d.col(a) / l;
    count(direction.dot(gap));
    rod.load({tie.s, Vec3::Zero(), lambda * direction});
    rod.attach(rod.row(row), point, Vec3::Zero(), direction);
    if (tie.body()) {
      problem.G.add(row, tie.unknown, -direction.transpose());
      problem.r.segment<3>(tie.unknown) -= lambda * direction;
    }
    if (tie.directors) {
      const int d = director(a);
      problem.G.add(row, d, -gap.transpose() / l);
      problem.r.segment<3>(d) -= lambda * gap / l;
      for (int i = 0; i < 3; ++i) {
        problem.B.add(tie.unknown + i, d + i, -lambda / l);
        problem.B.add(d + i, tie.unknown + i, -lambda / l);
        rod.attach(d + i, point, Vec3::Zero(), lambda / l * Vec3::Unit(i));
      }
    }
    ++row;
  }
  for (const int a : tie.about) {
    const HeldTurn turn = held_turn(tie, a);
    const double lambda = rod.iterate().lambda[row];
    const Vec3 axis = turn.sign * tie.own_axes.col(turn.carried), carried = point.R * axis;
    const Vec3 offset = l * axis, direction = held.d.col(turn.held) / l;
    count(held.d.col(turn.held).dot(carried));
    // The vector that the rod carries as a difference of two material points.
    rod.load({tie.s, offset, -lambda * direction});
    rod.load({tie.s, Vec3::Zero(), lambda * direction});
    rod.attach(rod.row(row), point, offset, -direction);
    rod.attach(rod.row(row), point, Vec3::Zero(), direction);
    if (tie.directors) {
      const int d = director(turn.held);
      problem.G.add(row, d, -carried.transpose());
      problem.r.segment<3>(d) -= lambda * carried;
      for (int i = 0; i < 3; ++i) {
        rod.attach(d + i, point, offset, -lambda / l * Vec3::Unit(i));
        rod.attach(d + i, point, Vec3::Zero(), lambda / l * Vec3::Unit(i));
      }
    }
    ++row;
  }
}

/// The rows that hold what a tie follows to the rod that holds.
void add_holding(RodRows& rod, const TieModel& tie) {
  const rod::CurvePoint point = rod::curve_point(rod.shape(), tie.other_s);
  const auto follow = [&](int k, const Vec3& is, const Vec3& offset, bool vector) {
    const int row = tie.body_row + 3 * k;
    const Vec3 lambda = rod.iterate().lambda.segment<3>(row);
    hold_followed(rod.context().model, rod.iterate(), row, tie.unknown + 3 * k, is, rod.reduced());
    rod.load({tie.other_s, offset, -lambda});
    if (vector) rod.load({tie.other_s, Vec3::Zero(), lambda});
    for (int i = 0; i < 3; ++i) {
      rod.attach(rod.row(row + i), point, offset, -Vec3::Unit(i));
      if (vector) rod.attach(rod.row(row + i), point, Vec3::Zero(), Vec3::Unit(i));
    }
  };
  follow(0, point.position + point.R * tie.other_offset, tie.other_offset, false);
  if (!tie.directors) return;
  for (int i = 0; i < 3; ++i) {
    const Vec3 offset = tie.length * tie.other_axes.col(i);
    follow(1 + i, point.R * offset, offset, true);
  }
}

}  // namespace

rod::Mat3 holder_axes(const StepContext& context, const State& iterate, const TieModel& tie) {
  return holder(context, iterate, tie).d;
}

void add_ties(RodRows& rod) {
  for (const TieModel& tie : rod.context().model.ties) {
    if (tie.rod == rod.number()) add_held(rod, tie);
    if (tie.other == rod.number()) add_holding(rod, tie);
  }
}

}  // namespace sinew
