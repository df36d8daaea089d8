#include <Eigen/Dense>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "sinew/rod/path.hpp"
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

/// The shapes at both ends of a part; every dimension positive.
std::pair<rod::Shape, rod::Shape> shapes(const CrossSection& section, const std::string& path) {
  const auto dimension = [&path](const Taper& taper, const std::string& name) {
    for (const double value : {taper.start, taper.end}) require_size(value, path + "." + name);
  };
  if (const auto* circle = std::get_if<Circle>(&section)) {
    dimension(circle->radius, "circle.radius");
    return {rod::Circle{circle->radius.start}, rod::Circle{circle->radius.end}};
  }
  if (const auto* tube = std::get_if<Tube>(&section)) {
    dimension(tube->outer, "tube.outer");
    dimension(tube->inner, "tube.inner");
    for (const auto& [outer, inner] :
         {std::pair(tube->outer.start, tube->inner.start), std::pair(tube->outer.end, tube->inner.end)}) {
      if (!(inner < outer))
        reject(path + ".tube.inner", text(inner) + " m", "must be smaller than the outer radius, " + text(outer) + " m",
               "exchange the two, or use `circle` for a full rod");
    }
    return {rod::Tube{tube->outer.start, tube->inner.start}, rod::Tube{tube->outer.end, tube->inner.end}};
  }
  if (const auto* ellipse = std::get_if<Ellipse>(&section)) {
    dimension(ellipse->y, "ellipse.y");
    dimension(ellipse->z, "ellipse.z");
    return {rod::Ellipse{ellipse->y.start, ellipse->z.start}, rod::Ellipse{ellipse->y.end, ellipse->z.end}};
  }
  const auto& rectangle = std::get<Rectangle>(section);
  dimension(rectangle.y, "rectangle.y");
  dimension(rectangle.z, "rectangle.z");
  return {rod::Rectangle{rectangle.y.start, rectangle.z.start}, rod::Rectangle{rectangle.y.end, rectangle.z.end}};
}

rod::Part make_part(double begin, double end, const CrossSection& section, const RodMaterial& material,
                    const std::string& path) {
  rod::Part part{begin, end, rod::SolidPart{}, material.damping};
  if (const auto* given = std::get_if<GivenSection>(&section)) {
    const Eigen::LLT<Eigen::Matrix<double, 6, 6>> llt(given->stiffness);
    if (!given->stiffness.isApprox(given->stiffness.transpose(), 1e-9) || llt.info() != Eigen::Success)
      reject(path + ".section.stiffness.matrix", "", "must be symmetric and positive definite",
             "the order is torsion, bending_y, bending_z, elongation, shear_y, shear_z");
    require_size(given->radius, path + ".section.stiffness.radius");
    require_not_negative(given->line_density, path + ".section.stiffness.line_density", "0 for a massless rod");
    part.made = rod::GivenPart{given->stiffness, given->line_density, given->radius};
    return part;
  }
  const auto [start, finish] = shapes(section, path + ".section");
  require_positive(material.young, path + ".material.young", "give Young's modulus, for example 5 GPa");
  if (!(material.poisson > -1.0 && material.poisson <= 0.5))
    reject(path + ".material.poisson", text(material.poisson), "must lie between -1 and 0.5",
           "0.4 for nylon, 0.3 for steel");
  for (const auto& [value, name] : {std::pair(material.density, "density"), std::pair(material.viscosity, "viscosity"),
                                    std::pair(material.damping, "damping")}) {
    require_not_negative(value, path + ".material." + name, "0 leaves it out");
  }
  part.made = rod::SolidPart{start, finish, material.young, material.poisson, material.density, material.viscosity};
  if ((rod::stiffness_at({part}, begin).diagonal().array() <= 0.0).any() ||
      (rod::stiffness_at({part}, end).diagonal().array() <= 0.0).any())
    reject(path + ".section", "",
           "has a shear stiffness below zero by Cowper's formula, which ends for so flat a "
           "section with so negative a Poisson's ratio",
           "give its stiffness as a matrix");
  return part;
}

rod::Profile make_profile(const Rod& rod, double length, const std::string& path) {
  rod::Profile profile;
  if (rod.parts.empty()) {
    profile.push_back(make_part(0.0, length, rod.section, rod.material, path));
    return profile;
  }
  double begin = 0.0;
  for (std::size_t i = 0; i < rod.parts.size(); ++i) {
    const RodPart& part = rod.parts[i];
    const std::string own = path + ".parts." + std::to_string(i);
    const bool last = i + 1 == rod.parts.size();
    if (!(part.to > begin) || (last && std::abs(part.to - length) > 1e-6 * length) || (!last && part.to >= length))
      reject(own + ".to", text(part.to) + " m",
             "must be greater than the one before, and that of the last part the rod's length, " + text(length) + " m",
             "list the parts from base to tip");
    const double end = last ? length : part.to;
    profile.push_back(make_part(begin, end, part.section, part.material, own));
    begin = end;
  }
  return profile;
}

/// The stress-free strains of each section as Legendre coefficients, from values over the arc length.
std::vector<rod::Coefficients> rest_of(const RestStrains& rest, const std::vector<double>& ends, int degree,
                                       const std::string& path) {
  if (rest.at.empty() || rest.at.size() != rest.strains.size())
    reject(path + ".rest", std::to_string(rest.at.size()) + " abscissae", "needs as many strains as abscissae",
           "give `at: [..]` and lists of the same length");
  const auto value = [&rest](double s) -> rod::Vec6 {
    if (rest.at.size() == 1 || s <= rest.at.front()) return rest.strains.front();
    if (s >= rest.at.back()) return rest.strains.back();
    const auto i = static_cast<std::size_t>(std::upper_bound(rest.at.begin(), rest.at.end(), s) - rest.at.begin());
    const double t = (s - rest.at[i - 1]) / (rest.at[i] - rest.at[i - 1]);
    return (1.0 - t) * rest.strains[i - 1] + t * rest.strains[i];
  };
  std::vector<rod::Coefficients> coefficients;
  const rod::GaussRule& rule = rod::gauss_rule(10);
  for (std::size_t i = 0; i + 1 < ends.size(); ++i) {  // the best polynomial in the mean square
    rod::Coefficients& Z = coefficients.emplace_back(rod::Coefficients::Zero(6, degree + 1));
    for (std::size_t g = 0; g < rule.node.size(); ++g) {
      const auto P = rod::legendre(2.0 * rule.node[g] - 1.0);
      const rod::Vec6 xi = value(ends[i] + (ends[i + 1] - ends[i]) * rule.node[g]);
      for (int d = 0; d <= degree; ++d) Z.col(d) += (2 * d + 1) * rule.weight[g] * P[d] * xi;
    }
  }
  return coefficients;
}

}  // namespace

/// Of its length: it starts beside its path; of the path's size: it has nothing to do with it.
constexpr double kOffPath = 0.01, kBesidePath = 0.2;

std::vector<Vec3> path_in_world(const Scene& scene, int frame, const Rod& rod, const std::string& path) {
  const Placement pose = stand(scene, frame, rod.pose);
  std::vector<Vec3> points;
  for (const Vec3& p : rod.path) points.push_back(rod.path_in == In::world ? p : apply(pose, p));
  if (points.size() < 2)
    reject(path + ".path", std::to_string(points.size()) + " points", "needs at least two points",
           "list them from base to tip");
  double extent = 0.0;
  for (const Vec3& p : points) extent = std::max(extent, p.cwiseAbs().maxCoeff());
  if (!(extent < kLargest)) {
    reject(path + ".path", text(extent) + " m", "a coordinate is beyond 1e6 m",
           "check the units of the path and the pose");
  }
  for (std::size_t i = 1; i < points.size(); ++i) {
    if ((points[i] - points[i - 1]).norm() < 1e-9) {
      reject(path + ".path", text(rod.path[i]), "two neighbours are the same point", "remove one of them");
    }
  }
  return points;
}

GeometricCableModel build_cable(const Scene& scene, const std::string& name, const Rod& rod) {
  GeometricCableModel model;
  model.name = name;
  model.frame = find_frame(scene, rod.frame, "rods." + name);
  model.path = path_in_world(scene, model.frame, rod, "rods." + name);
  const rod::Path curve(model.path);
  model.base = {rod::frame_along(curve.tangent(0.0), Vec3::UnitZ()), curve.position(0.0)};
  model.cable.length = curve.length();
  return model;
}

RodModel build_rod(const Scene& scene, const std::string& name, const Rod& rod) {
  const std::string path = "rods." + name;
  RodModel model;
  model.name = name;
  model.frame = find_frame(scene, rod.frame, path);
  const Placement pose = stand(scene, model.frame, rod.pose);
  const rod::Path curve(path_in_world(scene, model.frame, rod, path));
  const Vec3 up = rod.up ? Vec3(rod.path_in == In::world ? *rod.up : pose.R * *rod.up) : Vec3(Vec3::UnitZ());
  rod::Discretisation cut;
  cut.ends = section_ends(rod, curve.length(), path + ".sections");
  std::vector<int> strains;
  for (const Strain strain : rod.strains) strains.push_back(static_cast<int>(strain));
  std::sort(strains.begin(), strains.end());
  for (int i = 0; i < 6; ++i) {
    const int order = rod.order[static_cast<std::size_t>(i)];
    if (order < 0 || order > rod::kHighestDegree)
      reject(path + ".order", std::to_string(order), "must lie between 0 and " + std::to_string(rod::kHighestDegree),
             "0 is constant in each section, 2 quadratic");
  }
  cut.modes = rod::modes_of(strains, rod.order);
  int degree = 0, bending = 0;
  for (const rod::Mode& mode : cut.modes) {
    degree = std::max(degree, mode.degree);
    if (mode.strain == 1 || mode.strain == 2) bending = std::max(bending, mode.degree);
  }
  const rod::Layout layout = rod::lay_along(curve, cut.ends, up, bending);
  model.base = layout.base;
  const auto* given = std::get_if<RestStrains>(&rod.rest);
  if (given) {
    cut.rest = rest_of(*given, cut.ends, given->at.size() > 1 ? std::max(degree, 1) : degree, path);
  } else if (std::get<Rest>(rod.rest) == Rest::path) {
    cut.rest = layout.strains;
  }
  model.rod = rod::make_rod(cut, make_profile(rod, curve.length(), path));
  const Start start = rod.start.value_or(given ? Start::rest : Start::path);
  model.start = start == Start::path ? rod::coordinates_of(model.rod, layout.strains)
                                     : Eigen::VectorXd(Eigen::VectorXd::Zero(model.rod.coordinates()));
  if (start == Start::path) {  // as it lies, whatever its strains can follow
    const rod::Configuration shape = start_shape(model);
    for (int i = 0; i <= model.rod.count(); ++i)
      model.path_deviation =
          std::max(model.path_deviation, (shape.p[i] - curve.position(cut.ends[static_cast<std::size_t>(i)])).norm());
  }
  for (const BaseAxis axis : rod.base) {
    if (!add_base_motion(model, {axis >= BaseAxis::turn_x, static_cast<int>(axis) % 3, 1.0}))
      reject(path + ".base", std::to_string(static_cast<int>(axis)), "names a motion twice", "list each motion once");
  }
  return model;
}

namespace {

/// Twice as many sections as it has, or four times as many, and so on, until it follows its path; 0: none do.
int sections_that_follow(const Scene& scene, const std::string& name, Rod rod, const RodModel& built) {
  for (int count = 2 * built.rod.count(); count <= 10000; count *= 2) {
    rod.sections = count;
    const RodModel finer = build_rod(scene, name, rod);
    if (finer.path_deviation <= kOffPath * finer.rod.length()) return count;
  }
  return 0;
}

}  // namespace

void check_path(const Scene& scene, const std::string& name, const Rod& rod, const RodModel& built,
                std::vector<Warning>& warnings) {
  const double off = built.path_deviation;
  if (!(off > kOffPath * built.rod.length())) return;
  const int enough = rod.parts.empty() ? sections_that_follow(scene, name, rod, built) : 0;
  const std::string path = "rods." + name,
                    remedy = enough > 0 ? "`sections: " + std::to_string(enough) + "` follow it"
                                        : "give it more sections, or the strains that the path asks for";
  Eigen::AlignedBox3d box;
  for (const Vec3& point : rod.path) box.extend(point);
  if (off > kBesidePath * box.diagonal().norm())
    reject(path, text(off) + " m off its path",
           "its sections and strains cannot follow the path, which is " + text(box.diagonal().norm()) + " m large",
           remedy + "; `start: rest` if it is to start in another shape");
  warnings.push_back(
      {.code = "rod_off_path",
       .where = path,
       .message = "it starts " + text(off) + " m off its path, which its sections and strains cannot follow",
       .remedy = remedy,
       .value = off,
       .limit = kOffPath * built.rod.length(),
       .unit = "m"});
}

bool add_base_motion(RodModel& model, const rod::BaseMotion& motion) {
  std::vector<rod::BaseMotion>& base = model.rod.base;
  for (const rod::BaseMotion& own : base) {
    if (own.turns == motion.turns && own.axis == motion.axis) return false;
  }
  base.push_back(motion);
  std::stable_sort(base.begin(), base.end(), [](const auto& a, const auto& b) {
    return std::pair(a.turns, a.axis) < std::pair(b.turns, b.axis);
  });
  const Eigen::VectorXd strains = model.start.tail(model.rod.strain_coordinates());
  model.start.setZero(model.rod.coordinates());
  model.start.tail(strains.size()) = strains;
  return true;
}

}  // namespace sinew::building
