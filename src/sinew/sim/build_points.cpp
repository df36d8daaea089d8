#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "sinew/constraint/independent.hpp"
#include "sinew/rod/kinematics.hpp"
#include "sinew/rod/path.hpp"
#include "sinew/sim/building.hpp"

namespace sinew::building {

solid::EmbeddedPoint embed_within(const SolidModel& solid, const Vec3& x, const std::optional<double>& reach,
                                  const std::string& path, const std::string& what) {
  solid::EmbeddedPoint point = solid::embed(solid.body.rest, solid.body.tetrahedra, x);
  const double diagonal = (solid.body.rest.rowwise().maxCoeff() - solid.body.rest.rowwise().minCoeff()).norm();
  const double limit = reach.value_or(0.1 * diagonal);
  if (point.distance > limit) {
    reject(path, text(x) + " m (world)",
           what + " lies " + text(point.distance) + " m outside solids." + solid.name + ", beyond the reach of " +
               text(limit) + " m",
           "check pose, scale and units, or raise `reach`");
  }
  return point;
}

namespace {

bool all_clamped(const SolidModel& solid, const solid::EmbeddedPoint& point) {
  for (int c = 0; c < 4; ++c) {
    if (std::abs(point.weights[c]) > 1e-9 && solid.body.unknown[solid.body.tetrahedra[point.element][c]] >= 0)
      return false;
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
  Eigen::MatrixXd weights = Eigen::MatrixXd::Zero(n, solid.body.free_nodes);
  for (Eigen::Index i = 0; i < n; ++i) {
    for (int c = 0; c < 4; ++c) {
      const int node = solid.body.unknown[solid.body.tetrahedra[points[i].where.element][c]];
      if (node >= 0) weights(i, node) += points[i].where.weights[c];
    }
  }
  return weights * weights.transpose();
}

/// Gram matrix of points that the body holds still: what the rod's own coordinates can do there, across it, and along
/// it at an anchor.
Eigen::MatrixXd reach_gram(const RodModel& rod, const std::vector<PointModel>& points) {
  const auto shape = rod::configure(rod.rod, rod.base, rod::rest_coordinates(rod.rod));
  std::vector<Eigen::MatrixXd> rows;
  for (const PointModel& point : points) {
    Eigen::MatrixXd J = rod::position_jacobian(shape, point.abscissa);
    J.leftCols(rod.rod.base_coordinates()).setZero();
    rows.emplace_back(rod::curve_point(shape, point.abscissa).R.transpose() * J);
    if (!point.anchor) rows.back().row(0).setZero();
  }
  const auto n = static_cast<Eigen::Index>(points.size());
  Eigen::MatrixXd gram(n, n);
  for (Eigen::Index i = 0; i < n; ++i) {
    for (Eigen::Index j = 0; j < n; ++j) gram(i, j) = (rows[i].array() * rows[j].array()).sum();
  }
  return gram;
}

/// Keeps the points that say something new: none that touches no free unknown, and of those that a volume's elements
/// carry only as many as are independent (a linear element follows a straight line: two points of it say all). Points
/// of earlier couplings of the same rod and solid count as there already; anchors always stay.
std::vector<PointModel> independent_points(Model& model, const std::vector<PointModel>& candidates,
                                           CouplingFacts& facts) {
  const RodModel& rod = model.rods[candidates[0].rod];
  const SolidModel& solid = model.solids[candidates[0].solid];
  std::vector<PointModel> kept;
  const auto keep = [&](bool held) {
    const auto of_this_kind = [&](const PointModel& point) { return all_clamped(solid, point.where) == held; };
    std::vector<PointModel> points;
    for (const PointModel& point : model.points) {
      if (point.rod == candidates[0].rod && point.solid == candidates[0].solid && of_this_kind(point))
        points.push_back(point);
    }
    const auto earlier = static_cast<int>(points.size());
    std::vector<PointModel> others;
    for (const PointModel& point : candidates) {
      if (!of_this_kind(point)) continue;
      if (held && !rod.geometric && !point.anchor && point.abscissa <= 1e-9 * rod.length()) {
        facts.no_unknown.push_back(point.abscissa);
      } else {
        (point.anchor ? points : others).push_back(point);
      }
    }
    const auto forced = static_cast<int>(points.size());
    points.insert(points.end(), others.begin(), others.end());
    if (points.empty()) return;
    std::vector<int> numbers;
    if (held && rod.geometric) {  // its points are free to be anywhere
      for (int i = 0; i < static_cast<int>(points.size()); ++i) numbers.push_back(i);
    } else {
      numbers =
          constraint::independent_rows(held ? reach_gram(rod, points) : weight_gram(solid, points), kNewPart, forced);
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

void build_coupling(Model& model, int number, const Slide& slide) {
  const std::string path = "couplings." + std::to_string(number) + ".slide";
  const int rod = find(model.scene.rods, slide.rod, path + ".rod", "rod");
  const int solid = find(model.scene.solids, slide.solid, path + ".solid", "solid");
  const RodModel& rod_model = model.rods[rod];
  const double length = rod_model.length();
  std::vector<double> abscissae;
  if (const int* count = std::get_if<int>(&slide.points)) {
    if (*count < 1)
      reject(path + ".points", std::to_string(*count), "must be at least 1",
             "one point per 5 mm of cable is a good start");
    for (int i = 0; i < *count; ++i) abscissae.push_back(*count == 1 ? length : length * i / (*count - 1));
  } else {
    abscissae = std::get<std::vector<double>>(slide.points);
  }
  if (abscissae.empty())
    reject(path + ".points", "", "needs at least one point", "give a count or a list of abscissae");
  const bool anchored = slide.anchor_tip == AnchorTip::position;
  if (anchored) {
    if (std::abs(abscissae.back() - length) > 1e-6 * length) {
      reject(path + ".points", text(abscissae.back()) + " m",
             "the last point holds the tip, so it must be the rod's length, " + text(length) + " m",
             "end the list with the length, or write `anchor_tip: none`");
    }
    abscissae.back() = length;
  } else if (rod_model.geometric) {
    reject(path + ".anchor_tip", "none", "a geometric cable must be anchored", "write `anchor_tip: position`");
  }

  CouplingFacts facts;
  facts.asked = static_cast<int>(abscissae.size());
  const rod::Placement base = rod_model.base;
  std::vector<PointModel> candidates;
  std::vector<Vec3> positions;
  if (rod_model.geometric) {  // on the path itself
    const rod::Path curve(path_in_world(model.scene, rod_model.frame, model.scene.rods[rod].second));
    for (double s : abscissae) positions.push_back(curve.position(s));
  } else {
    const auto shape = rod::configure(rod_model.rod, base, rod::rest_coordinates(rod_model.rod));
    for (double s : abscissae) positions.push_back(rod::position(shape, s));
  }
  for (std::size_t i = 0; i < abscissae.size(); ++i) {
    if (abscissae[i] < 0.0 || abscissae[i] > length * (1.0 + 1e-12)) {
      reject(path + ".points", text(abscissae[i]) + " m", "must lie on the rod, from 0 to " + text(length) + " m",
             "measure along the rod from its base");
    }
    PointModel& point = candidates.emplace_back();
    point.rod = rod;
    point.solid = solid;
    point.coupling = number;
    point.abscissa = abscissae[i];
    point.anchor = anchored && i + 1 == abscissae.size();
    point.where = embed_within(model.solids[solid], positions[i], slide.reach, path + ".points",
                               "the point at " + text(abscissae[i]) + " m of the rod");
    if (point.where.distance > 0.0) ++facts.outside;
    facts.farthest = std::max(facts.farthest, point.where.distance);
  }
  const std::vector<PointModel> kept = independent_points(model, candidates, facts);
  facts.kept = static_cast<int>(kept.size());
  model.points.insert(model.points.end(), kept.begin(), kept.end());
  model.couplings.push_back(facts);
}

}  // namespace sinew::building
