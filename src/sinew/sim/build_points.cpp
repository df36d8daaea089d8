#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "sinew/constraint/independent.hpp"
#include "sinew/constraint/sliding.hpp"
#include "sinew/rod/path.hpp"
#include "sinew/sim/building.hpp"
#include "sinew/sim/sliding_rods.hpp"

namespace sinew::building {

solid::EmbeddedPoint embed_within(const SolidModel& solid, const Vec3& x, const std::optional<double>& reach,
                                  const std::string& path, const std::string& what) {
  solid::EmbeddedPoint point = solid::embed(solid.body.rest, solid.body.cells, x);
  const double limit = reach.value_or(0.1 * solid.mesh.diagonal);
  if (point.distance > limit) {
    reject(path, text(x) + " m (world)",
           what + " lies " + text(point.distance) + " m outside solids." + solid.name + ", beyond the reach of " +
               text(limit) + " m",
           "check pose, scale and units, or raise `reach`");
  }
  return point;
}

namespace {

bool free_anywhere(const SolidModel& solid, int node) { return solid.body.unknown.col(node).maxCoeff() >= 0; }

bool all_clamped(const SolidModel& solid, const solid::EmbeddedPoint& point) {
  const std::span<const int> nodes = solid.body.cells[point.element].nodes();
  for (std::size_t c = 0; c < nodes.size(); ++c) {
    if (std::abs(point.weights[static_cast<Eigen::Index>(c)]) > 1e-9 && free_anywhere(solid, nodes[c])) return false;
  }
  return true;
}

/// A sliding point is dropped when the others already determine all but this part of it. With two points of an element
/// kept and a third between them nothing new is left (0); points of neighbouring elements are at 0.3 and more.
/// docs/points.md has the measurements.
constexpr double kNewPart = 0.2;

/// Gram matrix of points on free nodes: products of their shape function weights.
Eigen::MatrixXd weight_gram(const SolidModel& solid, const std::vector<PointModel>& points) {
  const auto n = static_cast<Eigen::Index>(points.size());
  Eigen::MatrixXd weights = Eigen::MatrixXd::Zero(n, solid.body.nodes());
  for (Eigen::Index i = 0; i < n; ++i) {
    const solid::EmbeddedPoint& where = points[i].where;
    const std::span<const int> nodes = solid.body.cells[where.element].nodes();
    for (std::size_t c = 0; c < nodes.size(); ++c) {
      if (free_anywhere(solid, nodes[c])) weights(i, nodes[c]) += where.weights[static_cast<Eigen::Index>(c)];
    }
  }
  return weights * weights.transpose();
}

/// Of points that the body holds still: what the rod's own coordinates can do there, across it, and along it at an
/// anchor.
struct Reach {
  Eigen::MatrixXd gram;
  Eigen::VectorXd
      lengths;  ///< of each, what sections since the point before can do: those nearer the base have long arms
};
Reach reach_of(const RodModel& rod, const std::vector<PointModel>& points) {
  const auto shape = start_shape(rod);
  const auto n = static_cast<Eigen::Index>(points.size());
  Reach reach{Eigen::MatrixXd(n, n), Eigen::VectorXd(n)};
  std::vector<Eigen::MatrixXd> rows;
  for (const PointModel& point : points) {
    const double s = std::min(point.abscissa, rod.rod.length());
    double before = 0.0;
    for (const PointModel& other : points) {
      if (other.abscissa < point.abscissa) before = std::max(before, other.abscissa);
    }
    Eigen::MatrixXd J = rod::position_jacobian(shape, s);
    J.leftCols(rod.rod.base_coordinates()).setZero();
    rows.emplace_back(rod::curve_point(shape, s).R.transpose() * J);
    if (!point.fixed) rows.back().row(0).setZero();
    int first = 0;
    while (first + 1 < rod.rod.count() && rod.rod.sections[first].end <= before) ++first;
    const Eigen::Index columns = rod.rod.base_coordinates() + rod.rod.first[first];
    reach.lengths[static_cast<Eigen::Index>(rows.size()) - 1] = rows.back().rightCols(J.cols() - columns).norm();
  }
  for (Eigen::Index i = 0; i < n; ++i) {
    for (Eigen::Index j = 0; j < n; ++j) reach.gram(i, j) = (rows[i].array() * rows[j].array()).sum();
  }
  return reach;
}

/// Keeps the points that say something new: none that touches no free unknown, and of those that a volume's elements
/// carry only as many as are independent (a linear element follows a straight line: two points of it say all). Points
/// of earlier couplings of the same rod and solid count as there already; anchors always stay.
std::vector<PointModel> independent_points(Model& model, const std::vector<PointModel>& candidates,
                                           CouplingFacts& facts) {
  const Line line = candidates[0].line;
  const SolidModel& solid = model.solids[candidates[0].solid];
  std::vector<PointModel> kept;
  const auto keep = [&](bool held) {
    const auto of_this_kind = [&](const PointModel& point) { return all_clamped(solid, point.where) == held; };
    std::vector<PointModel> points;
    for (const PointModel& point : model.points) {
      if (point.line == line && point.solid == candidates[0].solid && of_this_kind(point)) points.push_back(point);
    }
    const auto earlier = static_cast<int>(points.size());
    std::vector<PointModel> others;
    for (const PointModel& point : candidates) {
      if (!of_this_kind(point)) continue;
      if (held && !point.fixed && point.abscissa <= 1e-9 * length_of(model, line)) {
        facts.no_unknown.push_back(point.abscissa);
        model.dropped.push_back(point);  // pulled out, the rod would be led there
      } else {
        (point.fixed ? points : others).push_back(point);
      }
    }
    const auto forced = static_cast<int>(points.size());
    points.insert(points.end(), others.begin(), others.end());
    if (points.empty()) return;
    std::vector<int> numbers;
    if (held && line.cable >= 0) {  // its points are free to be anywhere
      for (int i = 0; i < static_cast<int>(points.size()); ++i) numbers.push_back(i);
    } else {
      const Reach reach = held ? reach_of(model.rods[line.rod], points) : Reach{weight_gram(solid, points), {}};
      numbers = constraint::independent_rows(reach.gram, kNewPart, forced, reach.lengths);
      std::sort(numbers.begin(), numbers.end());
    }
    for (int i = earlier; i < static_cast<int>(points.size()); ++i) {
      if (std::binary_search(numbers.begin(), numbers.end(), i)) {
        kept.push_back(points[i]);
      } else {
        facts.redundant.push_back(points[i].abscissa);
        model.dropped.push_back(points[i]);
      }
    }
  };
  keep(false);
  keep(true);
  std::sort(kept.begin(), kept.end(), [](const auto& a, const auto& b) { return a.abscissa < b.abscissa; });
  std::sort(facts.redundant.begin(), facts.redundant.end());
  return kept;
}

}  // namespace

namespace {

/// Where the points of a slide are asked for: abscissae and positions in the world at t = 0.
struct Asked {
  std::vector<double> abscissae;
  std::vector<Vec3> positions;
};

Asked points_on_rod(const Model& model, const Line& line, const Slide& slide, const std::string& path) {
  const double length = length_of(model, line);
  Asked asked;
  if (const int* count = std::get_if<int>(&slide.points)) {
    if (*count < 1)
      reject(path + ".points", std::to_string(*count), "must be at least 1",
             "one point per 5 mm of cable is a good start");
    for (int i = 0; i < *count; ++i) asked.abscissae.push_back(*count == 1 ? length : length * i / (*count - 1));
  } else {
    asked.abscissae = std::get<std::vector<double>>(slide.points);
  }
  if (asked.abscissae.empty())
    reject(path + ".points", "", "needs at least one point", "give a count or a list of abscissae");
  for (const double s : asked.abscissae) {
    if (!(s >= 0.0 && s <= length * (1.0 + 1e-6)))
      reject(path + ".points", text(s) + " m", "must lie on the rod, from 0 to " + text(length) + " m",
             "measure along the rod from its base");
  }
  if (slide.anchor_tip != AnchorTip::none) {
    if (std::abs(asked.abscissae.back() - length) > 1e-6 * length) {
      reject(path + ".points", text(asked.abscissae.back()) + " m",
             "the last point holds the tip, so it must be the rod's length, " + text(length) + " m",
             "end the list with the length, or write `anchor_tip: none`");
    }
    asked.abscissae.back() = length;
  }
  if (line.cable >= 0) {  // on the path itself
    const rod::Path curve(model.cables[line.cable].path);
    for (const double s : asked.abscissae) asked.positions.push_back(curve.position(s));
  } else {
    const auto shape = start_shape(model.rods[line.rod]);
    for (double& s : asked.abscissae) asked.positions.push_back(rod::position(shape, s = std::min(s, length)));
  }
  return asked;
}

/// Points given in the solid; where the rod does not reach them yet, their abscissae lie beyond its tip.
Asked points_in_channel(const Model& model, const Line& line, int solid, const Slide& slide, const std::string& path) {
  if (line.cable >= 0)
    reject(path + ".channel", "", "a geometric cable runs through points of its path", "give `points`");
  if (slide.anchor_tip != AnchorTip::none)
    reject(path + ".anchor_tip", slide.anchor_tip == AnchorTip::pose ? "pose" : "position",
           "a rod that slides in a channel has a free tip", "write `anchor_tip: none`");
  const auto shape = start_shape(model.rods[line.rod]);
  const Placement pose = stand(model.scene, model.solids[solid].frame, model.scene.solids[solid].second.pose);
  Asked asked;
  double s = 0.0;
  for (const Vec3& x : slide.channel) {
    asked.positions.push_back(apply(pose, x));
    s = constraint::project(shape, s, asked.positions.back());
    if (s < 0.0)
      reject(path + ".channel", text(x) + " m", "lies behind the base of the rod",
             "list the points in the order in which the rod reaches them, the first ahead of its base");
    asked.abscissae.push_back(s);
  }
  return asked;
}

}  // namespace

void build_coupling(Model& model, int number, const Slide& slide) {
  const std::string path = "couplings." + std::to_string(number) + ".slide";
  const Line line = find_line(model, slide.rod, path + ".rod");
  const int solid = find(model.scene.solids, slide.solid, path + ".solid", "solid");
  if (line.cable >= 0 && slide.anchor_tip != AnchorTip::position)
    reject(path + ".anchor_tip", slide.anchor_tip == AnchorTip::none ? "none" : "pose",
           "a geometric cable must be anchored by its position", "write `anchor_tip: position`");
  require_not_negative(slide.friction, path + ".friction", "0 for none, 0.1 for a coated cable");
  if (slide.friction > 0.0) {
    if (line.cable >= 0)
      reject(path + ".friction", text(slide.friction), "a geometric cable slides without", "use `cable: cosserat`");
    if (model.scene.analysis != Analysis::dynamic)
      reject(path + ".friction", text(slide.friction), "friction is a matter of motion", "write `analysis: dynamic`");
  }
  const Asked asked = slide.channel.empty() ? points_on_rod(model, line, slide, path)
                                            : points_in_channel(model, line, solid, slide, path);
  CouplingFacts facts;
  facts.rod = line.rod;
  facts.cable = line.cable;
  facts.asked = static_cast<int>(asked.abscissae.size());
  std::vector<PointModel> candidates;
  for (std::size_t i = 0; i < asked.abscissae.size(); ++i) {
    PointModel& point = candidates.emplace_back();
    point.line = line;
    point.solid = solid;
    point.coupling = number;
    point.abscissa = asked.abscissae[i];
    point.friction = slide.friction;
    point.fixed = slide.anchor_tip != AnchorTip::none && i + 1 == asked.abscissae.size();
    const std::string what = slide.channel.empty() ? "the point at " + text(asked.abscissae[i]) + " m of the rod"
                                                   : "point " + std::to_string(i) + " of the channel";
    point.where = embed_within(model.solids[solid], asked.positions[i], slide.reach,
                               path + (slide.channel.empty() ? ".points" : ".channel"), what);
    if (lies_outside(model.solids[solid], point.where)) ++facts.outside;
    facts.farthest = std::max(facts.farthest, point.where.distance);
  }
  const std::vector<PointModel> kept = independent_points(model, candidates, facts);
  facts.kept = static_cast<int>(kept.size());
  model.points.insert(model.points.end(), kept.begin(), kept.end());
  model.couplings.push_back(facts);
  if (2 * facts.outside > facts.asked)
    model.warnings.push_back({.code = "points_outside",
                              .where = path,
                              .message = std::to_string(facts.outside) + " of " + std::to_string(facts.asked) +
                                         " points lie outside solids." + slide.solid + ", up to " +
                                         text(facts.farthest) + " m, and are tied to the nearest elements",
                              .remedy = "is the rod where it should be?",
                              .value = facts.farthest,
                              .unit = "m"});
  else if (const PointModel& tip = candidates.back();
           tip.fixed && tip.where.distance > 0.02 * model.solids[solid].mesh.diagonal)
    model.warnings.push_back({.code = "tip_outside",
                              .where = path,
                              .message = "the rod's tip, which is anchored, lies " + text(tip.where.distance) +
                                         " m outside solids." + slide.solid,
                              .remedy = "should the rod end in the body?",
                              .value = tip.where.distance,
                              .limit = 0.02 * model.solids[solid].mesh.diagonal,
                              .unit = "m"});
  if (slide.anchor_tip == AnchorTip::pose)
    tie_axes(model, number, line.rod, candidates.back().abscissa, solid, asked.positions.back(),
             candidates.back().where, {}, {0, 1, 2});
}

void arrange_slides(Model& model) {
  for (std::size_t k = 0; k < model.points.size(); ++k) {
    const PointModel& point = model.points[k];
    if (point.line.rod >= 0 && !point.fixed) model.rods[point.line.rod].slides.push_back(static_cast<int>(k));
  }
  for (RodModel& rod : model.rods) {
    std::stable_sort(rod.slides.begin(), rod.slides.end(),
                     [&](int a, int b) { return model.points[a].abscissa < model.points[b].abscissa; });
    std::vector<double> abscissae;
    for (const int k : rod.slides) abscissae.push_back(model.points[k].abscissa);
    const SlideResolution coarsest = slide_resolution(rod.rod, abscissae);
    for (const int k : rod.slides) {
      CouplingFacts& facts = model.couplings[model.points[k].coupling];
      facts.spacing = coarsest.spacing;
      facts.sections = coarsest.sections;
      facts.order = coarsest.order;
    }
  }
}

}  // namespace sinew::building
