// A surface of thickness t is the closed one through the points p +- d of its corners p, with walls across along its
// rims. Each plane of a triangle with the normal n_f shall be moved by t / 2, so d . n_f = t / 2 for all triangles at
// p. With the normal n of the corner, the mean of the n_f by the triangles' angles there,
//
//     d = (t / 2) n / max(min_f n . n_f, 1 / 2)
//
// moves the plane that leans farthest from n by t / 2, and all others by more; of folds by more than 120 degrees it
// cuts the point off, as a bevel does. Where fans of triangles touch in a corner alone, each fan has a corner of its
// own.
#include "sinew/contact/sheet.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <string>
#include <utility>

#include "sinew/contact/mesh.hpp"

namespace sinew::contact {

namespace {

using Vec3 = Eigen::Vector3d;
using Triangle = std::array<int, 3>;

constexpr double kBevel = 0.5;       ///< how much farther than t / 2 a corner is moved: twice
constexpr double kFoldsBack = 0.05;  ///< n . n_f of a triangle that lies all but on its neighbour
constexpr double kOutside = 1e-2;    ///< of the thickness: how far out a point is looked at

/// Turns triangles the same way as the first of their part.
void turn_alike(std::vector<Triangle>& triangles) {
  std::map<std::pair<int, int>, std::vector<std::size_t>> meet;  // in an edge, its lower end first
  for (std::size_t f = 0; f < triangles.size(); ++f)
    for (std::size_t i = 0; i < 3; ++i) {
      const auto [low, high] = std::minmax(triangles[f][i], triangles[f][(i + 1) % 3]);
      meet[{low, high}].push_back(f);
    }
  const auto crowded = std::count_if(meet.begin(), meet.end(), [](const auto& edge) { return edge.second.size() > 2; });
  if (crowded > 0) throw NoSheet("has " + std::to_string(crowded) + " edges where more than two triangles meet");
  const auto runs = [&](std::size_t f, int from, int to) {
    for (std::size_t i = 0; i < 3; ++i)
      if (triangles[f][i] == from && triangles[f][(i + 1) % 3] == to) return true;
    return false;
  };
  std::vector<char> done(triangles.size(), 0);
  for (std::size_t first = 0; first < triangles.size(); ++first) {
    if (done[first]) continue;
    done[first] = 1;
    std::vector<std::size_t> waiting{first};
    while (!waiting.empty()) {
      const std::size_t f = waiting.back();
      waiting.pop_back();
      for (std::size_t i = 0; i < 3; ++i) {
        const int from = triangles[f][i], to = triangles[f][(i + 1) % 3];
        for (const std::size_t other : meet[{std::min(from, to), std::max(from, to)}]) {
          if (other == f) continue;
          const bool against = runs(other, from, to);
          if (against && done[other]) throw NoSheet("has one side only, as a Moebius strip");
          if (against) std::swap(triangles[other][1], triangles[other][2]);
          if (done[other]) continue;
          done[other] = 1;
          waiting.push_back(other);
        }
      }
    }
  }
}

/// Gives each fan of triangles around a corner a corner of its own.
Eigen::Matrix3Xd part_fans(const Eigen::Matrix3Xd& points, std::vector<Triangle>& triangles) {
  // Corners of triangles (3 f + i) that are the same corner: those on both sides of an edge.
  std::vector<int> same(3 * triangles.size());
  std::iota(same.begin(), same.end(), 0);
  const auto root = [&](int own) {
    while (same[own] != own) own = same[own] = same[same[own]];
    return own;
  };
  std::map<std::pair<int, int>, std::pair<int, int>> passed;  // edges as a triangle runs along: its corners there
  for (std::size_t f = 0; f < triangles.size(); ++f)
    for (std::size_t i = 0; i < 3; ++i) {
      const int from = triangles[f][i], to = triangles[f][(i + 1) % 3];
      const int at_from = static_cast<int>(3 * f + i), at_to = static_cast<int>(3 * f + (i + 1) % 3);
      passed[{from, to}] = {at_from, at_to};
      if (const auto back = passed.find({to, from}); back != passed.end()) {
        same[root(at_from)] = root(back->second.second);
        same[root(at_to)] = root(back->second.first);
      }
    }
  std::map<int, int> number;  // of fans
  std::vector<Vec3> parted;
  for (std::size_t f = 0; f < triangles.size(); ++f)
    for (std::size_t i = 0; i < 3; ++i) {
      const auto [entry, fresh] = number.try_emplace(root(static_cast<int>(3 * f + i)), std::ssize(parted));
      if (fresh) parted.emplace_back(points.col(triangles[f][i]));
      triangles[f][i] = entry->second;
    }
  Eigen::Matrix3Xd out(3, std::ssize(parted));
  for (Eigen::Index i = 0; i < out.cols(); ++i) out.col(i) = parted[static_cast<std::size_t>(i)];
  return out;
}

Vec3 across(const Eigen::Matrix3Xd& x, const Triangle& t) {
  return Vec3(x.col(t[1]) - x.col(t[0])).cross(Vec3(x.col(t[2]) - x.col(t[0])));
}

}  // namespace

Sheet thicken(const Eigen::Matrix3Xd& given, std::vector<Triangle> triangles, double thickness) {
  turn_alike(triangles);
  const Eigen::Matrix3Xd points = part_fans(given, triangles);
  const Mesh middle = make_mesh(points, triangles);
  Outward outward;
  find_outward(middle, points, outward);
  Eigen::VectorXd least = Eigen::VectorXd::Ones(points.cols());
  for (std::size_t f = 0; f < triangles.size(); ++f) {
    const Vec3 n = outward.faces.col(static_cast<Eigen::Index>(f));
    if (!n.allFinite()) throw NoSheet("has a triangle without area", points.col(triangles[f][0]));
    for (const int corner : triangles[f]) least[corner] = std::min(least[corner], n.dot(outward.points.col(corner)));
  }
  const int corners = static_cast<int>(points.cols());
  Sheet sheet;
  sheet.points.resize(3, 2 * corners);
  for (int i = 0; i < corners; ++i) {
    if (!(least[i] > kFoldsBack)) throw NoSheet("folds back onto itself", points.col(i));
    const Vec3 d = 0.5 * thickness / std::max(least[i], kBevel) * outward.points.col(i);
    sheet.points.col(i) = points.col(i) + d;
    sheet.points.col(corners + i) = points.col(i) - d;
  }
  for (std::size_t f = 0; f < triangles.size(); ++f) {
    const Triangle& t = triangles[f];
    const Triangle below{corners + t[0], corners + t[2], corners + t[1]};
    const Vec3 n = outward.faces.col(static_cast<Eigen::Index>(f));
    if (!(across(sheet.points, t).dot(n) > 0.0) || !(across(sheet.points, below).dot(n) < 0.0))
      throw NoSheet("bends more sharply than half that thickness", points.col(t[0]));
    sheet.triangles.push_back(t);
    sheet.triangles.push_back(below);
    for (std::size_t i = 0; i < 3; ++i) {
      if (middle.beside[f][i] >= 0) continue;
      const int from = t[i], to = t[(i + 1) % 3];
      sheet.triangles.push_back({to, from, corners + from});
      sheet.triangles.push_back({to, corners + from, corners + to});
    }
  }
  // What is nearer to itself than its thickness has points of its outside within.
  const Mesh closed = make_mesh(sheet.points, sheet.triangles);
  find_outward(closed, sheet.points, outward);
  for (int i = 0; i < 2 * corners; ++i) {
    const Vec3 beside = sheet.points.col(i) + kOutside * thickness * outward.points.col(i);
    if (inside(closed, sheet.points, closed.faces, beside))
      throw NoSheet("comes nearer to itself than that thickness", points.col(i % corners));
  }
  return sheet;
}

}  // namespace sinew::contact
