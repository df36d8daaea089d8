#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "sinew/rod/path.hpp"
#include "sinew/rod/section.hpp"
#include "sinew/sim/building.hpp"

namespace sinew::building {

namespace {

/// Ascending ends from 0 to the length, from a count or a list.
std::vector<double> section_ends(const Rod& rod, double length, const std::string& path) {
  std::vector<double> ends;
  if (const int* count = std::get_if<int>(&rod.sections)) {
    if (*count < 1)
      reject(path, std::to_string(*count), "must be at least 1", "start with one section per 5 mm of cable");
    for (int i = 0; i <= *count; ++i) ends.push_back(length * i / *count);
    return ends;
  }
  ends = std::get<std::vector<double>>(rod.sections);
  if (ends.size() < 2)
    reject(path, "", "needs at least two abscissae", "list the section ends from 0 to the rod's length");
  if (std::abs(ends.front()) > 1e-6 * length || std::abs(ends.back() - length) > 1e-6 * length) {
    reject(path, text(ends.front()) + " .. " + text(ends.back()) + " m",
           "must run from 0 to the rod's length, " + text(length) + " m",
           "list every section end, the first 0 and the last the length");
  }
  ends.front() = 0.0;
  ends.back() = length;
  for (std::size_t i = 1; i < ends.size(); ++i) {
    if (!(ends[i] > ends[i - 1]))
      reject(path, text(ends[i]) + " m", "must be greater than the one before", "sort the list");
  }
  return ends;
}

}  // namespace

std::vector<Vec3> path_in_world(const Scene& scene, int frame, const Rod& rod) {
  const Placement pose = stand(scene, frame, rod.pose);
  std::vector<Vec3> points;
  for (const Vec3& p : rod.path) points.push_back(rod.path_in == In::world ? p : apply(pose, p));
  return points;
}

RodModel build_rod(const Scene& scene, const std::string& name, const Rod& rod) {
  const std::string path = "rods." + name;
  RodModel model;
  model.name = name;
  model.frame = find_frame(scene, rod.frame, path);
  model.geometric = rod.cable == Cable::geometric;
  const Placement pose = stand(scene, model.frame, rod.pose);
  const std::vector<Vec3> points = path_in_world(scene, model.frame, rod);
  if (points.size() < 2)
    reject(path + ".path", std::to_string(points.size()) + " points", "needs at least two points",
           "list them from base to tip");
  for (std::size_t i = 1; i < points.size(); ++i) {
    if ((points[i] - points[i - 1]).norm() < 1e-9) {
      reject(path + ".path", text(rod.path[i]), "two neighbours are the same point", "remove one of them");
    }
  }
  double extent = 0.0;
  for (const Vec3& p : points) extent = std::max(extent, p.cwiseAbs().maxCoeff());
  if (!(extent < kLargest)) {
    reject(path + ".path", text(extent) + " m", "a coordinate is beyond 1e6 m",
           "check the units of the path and the pose");
  }
  const rod::Path curve(points);
  const Vec3 up = rod.up ? Vec3(rod.path_in == In::world ? *rod.up : pose.R * *rod.up) : Vec3(Vec3::UnitZ());
  const std::vector<double> ends = section_ends(rod, curve.length(), path + ".sections");
  const rod::Layout layout = rod::lay_along(curve, ends, up);
  model.base = layout.base;
  model.path_deviation = layout.deviation;
  model.cable.length = curve.length();
  if (model.geometric) return model;

  require_positive(rod.section.radius, path + ".section.circle.radius", "give the radius, for example 0.5 mm");
  require_positive(rod.material.young, path + ".material.young", "give Young's modulus, for example 5 GPa");
  if (!(rod.material.poisson > -1.0 && rod.material.poisson <= 0.5)) {
    reject(path + ".material.poisson", text(rod.material.poisson), "must lie between -1 and 0.5",
           "0.4 for nylon, 0.3 for steel");
  }
  model.rod.ends = ends;
  model.rod.radius = rod.section.radius;
  for (const Strain strain : rod.strains) model.rod.basis.push_back(static_cast<int>(strain));
  std::sort(model.rod.basis.begin(), model.rod.basis.end());
  model.rod.fixed = layout.strains;
  model.rod.rest.resize(static_cast<Eigen::Index>(model.rod.sections()) * model.rod.strains());
  for (int i = 0; i < model.rod.sections(); ++i) {
    for (int c = 0; c < model.rod.strains(); ++c) {
      model.rod.rest[i * model.rod.strains() + c] = layout.strains(model.rod.basis[c], i);
      model.rod.fixed(model.rod.basis[c], i) = 0.0;
    }
    model.rod.stiffness.push_back(
        rod::round_section_stiffness(rod.section.radius, rod.material.young, rod.material.poisson));
  }
  model.rod.masses = rod::round_rod_masses(ends, rod.section.radius, rod.material.density);
  return model;
}

}  // namespace sinew::building
