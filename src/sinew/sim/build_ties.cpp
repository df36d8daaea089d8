#include <Eigen/Dense>
#include <algorithm>

#include "sinew/sim/building.hpp"

namespace sinew::building {

namespace {

std::vector<int> chosen(const std::array<bool, 3>& axes) {
  std::vector<int> numbers;
  for (int i = 0; i < 3; ++i) {
    if (axes[static_cast<std::size_t>(i)]) numbers.push_back(i);
  }
  return numbers;
}

/// A tie of the rod's point at s to axes that stand in the world as `holder` at t = 0.
TieModel& add_tie(Model& model, int coupling, int rod, double s, const rod::Mat3& axes, const std::vector<int>& along,
                  const std::vector<int>& about) {
  TieModel& tie = model.ties.emplace_back();
  tie.rod = rod;
  tie.coupling = coupling;
  tie.s = s;
  const rod::CurvePoint point = rod::curve_point(start_shape(model.rods[rod]), s);
  tie.holder = {axes, point.position};
  tie.own_axes = point.R.transpose() * axes;
  tie.length = model.rods[rod].rod.length();
  tie.along = along;
  tie.about = about;
  return tie;
}

/// Warns of axes held fast along or about which no coordinate of the rod moves its point at the start: such a row says
/// nothing there, its force is arbitrary, and a straight rod of fixed length is locked by it.
void warn_of_idle_rows(Model& model, const TieModel& tie, const std::string& path) {
  const rod::Configuration shape = start_shape(model.rods[tie.rod]);
  const rod::Matrix6X twists = rod::twists_at(shape, tie.s);
  if (tie.s <= 0.0 || twists.cols() == 0) return;
  const Eigen::Matrix3Xd moves = rod::position_jacobian(shape, tie.s), turns = twists.topRows<3>();
  const auto warn = [&](const Eigen::Matrix3Xd& by, int axis, const char* how, const char* remedy) {
    const double most = by.cwiseAbs().maxCoeff();
    if (most > 0.0 && (tie.holder.R.col(axis).transpose() * by).cwiseAbs().maxCoeff() > 1e-9 * most) return;
    model.warnings.push_back({.code = "row_unanswered",
                              .where = path,
                              .message = "at the start no strain of rods." + model.rods[tie.rod].name +
                                         " and no motion of its base moves the point " + how + " the " +
                                         std::string(1, "xyz"[axis]) +
                                         " axis that holds it, so its force there is arbitrary",
                              .remedy = remedy});
  };
  for (const int axis : tie.along)
    warn(moves, axis, "along", "add `elongation` to the rod's strains, or leave this axis out");
  for (const int axis : tie.about)
    warn(turns, axis, "about", "let the rod bend and twist that way, or leave this axis out");
}

/// Whether the holder's axes move and matter: about any, or along some but not all.
bool needs_directors(const TieModel& tie) {
  return tie.body() && (!tie.about.empty() || tie.along.size() == 1 || tie.along.size() == 2);
}

}  // namespace

void tie_axes(Model& model, int coupling, int rod, double s, int solid, const Vec3& point,
              const solid::EmbeddedPoint& where, const std::vector<int>& along, const std::vector<int>& about) {
  TieModel& tie = add_tie(model, coupling, rod, s, rod::Mat3::Identity(), along, about);
  tie.solid = solid;
  tie.holder.p = point;
  tie.directors = needs_directors(tie);
  SolidRow row;
  row.solid = solid;
  row.where = where;
  model.solid_rows.push_back(row);  // the point held
  if (!tie.directors) return;
  const solid::Body& body = model.solids[solid].body;
  for (int i = 0; i < 3; ++i) {
    row.where = solid::embed_vector(body.rest, body.cells, where, tie.length * Vec3::Unit(i));
    model.solid_rows.push_back(row);
  }
}

void build_coupling(Model& model, int number, const Tie& tie) {
  const std::string path = "couplings." + std::to_string(number) + ".tie";
  const int rod = find_rod(model, tie.rod, path + ".rod");
  const double s = abscissa_on(model, rod, tie.at, path + ".at");
  const std::vector<int> along = chosen(tie.along), about = chosen(tie.about);
  if (along.empty() && about.empty()) reject(path, tie.rod, "holds nothing", "name axes in `along` or `about`");
  if (tie.frame.has_value() + tie.solid.has_value() + tie.body.has_value() + tie.other.has_value() > 1)
    reject(path, tie.rod, "can be held by one of frame, solid, body and other", "write one tie for each");
  const Vec3 position = rod::position(start_shape(model.rods[rod]), s);
  CouplingFacts facts;
  facts.rod = rod;
  if (tie.solid) {
    const int solid = find(model.scene.solids, *tie.solid, path + ".solid", "solid");
    const solid::EmbeddedPoint where =
        embed_within(model.solids[solid], position, tie.reach, path + ".at", "the point of the rod");
    facts.outside = lies_outside(model.solids[solid], where) ? 1 : 0;
    facts.farthest = where.distance;
    model.couplings.push_back(facts);
    if (along.size() == 3 && about.empty()) {  // an anchor, wherever on the rod
      PointModel point;
      point.line = {rod, -1};
      point.solid = solid;
      point.coupling = number;
      point.where = where;
      point.abscissa = s;
      point.fixed = true;
      model.points.push_back(point);
      return;
    }
    // The point held is the one that the element's weights make of its nodes.
    tie_axes(model, number, rod, s, solid, position, where, along, about);
    return;
  }
  model.couplings.push_back(facts);
  const int frame = find_frame(model.scene, tie.frame, path);
  if (tie.other) {
    const int other = find_rod(model, *tie.other, path + ".other");
    if (other == rod) reject(path + ".other", *tie.other, "is the rod itself", "name another rod");
    const double other_s = abscissa_on(model, other, tie.other_at, path + ".other_at");
    const rod::CurvePoint holder = rod::curve_point(start_shape(model.rods[other]), other_s);
    TieModel& own = add_tie(model, number, rod, s, holder.R, along, about);
    own.other = other;
    own.other_s = other_s;
    own.other_offset = holder.R.transpose() * (position - holder.position);
    own.directors = needs_directors(own);
    return;
  }
  if (tie.body) {
    const int body = find(model.scene.bodies, *tie.body, path + ".body", "body");
    const rigid::Motion& start = model.bodies[body].start;
    TieModel& own = add_tie(model, number, rod, s, start.R, along, about);
    own.rigid = body;
    own.other_offset = start.R.transpose() * (position - start.p);
    own.directors = needs_directors(own);
    return;
  }
  const rod::Mat3 axes = frame < 0 ? rod::Mat3::Identity() : frame_at(model.scene.frames[frame].second, 0.0).R;
  TieModel& own = add_tie(model, number, rod, s, axes, along, about);
  own.frame = frame;
  warn_of_idle_rows(model, own, path);
}

void build_coupling(Model& model, int number, const Glue& glue) {
  const std::string path = "couplings." + std::to_string(number) + ".glue";
  const int solid = find(model.scene.solids, glue.solid, path + ".solid", "solid"),
            number_of_body = find(model.scene.bodies, glue.body, path + ".body", "body");
  const SolidModel& own = model.solids[solid];
  const rigid::Motion& start = model.bodies[number_of_body].start;
  CouplingFacts facts;
  for (const int node : select(own, glue.region, path).nodes) {
    ++facts.asked;
    SolidRow row;
    row.solid = solid;
    row.where = solid::at_node(own.body.rest, own.body.cells, node);
    const bool again = std::any_of(model.solid_rows.begin(), model.solid_rows.end(), [&](const SolidRow& earlier) {
      return earlier.body >= 0 && earlier.solid == solid && earlier.where.element == row.where.element &&
             earlier.where.weights == row.where.weights;
    });
    if (again) {
      reject(path, "node " + std::to_string(node), "is glued already",
             "let the regions of one solid's glues not overlap");
    }
    if (own.body.unknown.col(node).minCoeff() < 0) continue;
    ++facts.kept;
    row.body = number_of_body;
    row.arm = start.R.transpose() * (own.body.rest.col(node) - start.p);
    model.solid_rows.push_back(row);
  }
  if (facts.kept < facts.asked) {
    reject(path, glue.solid,
           std::to_string(facts.asked - facts.kept) +
               " of its nodes are held by `fixed` already, along some axis at least",
           "glue nodes that are free, or leave them out of `fixed`");
  }
  model.couplings.push_back(facts);
}

}  // namespace sinew::building
