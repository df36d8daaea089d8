// What a rod is made of along its length: parts of one material and a cross-section that may taper.
#pragma once

#include <Eigen/Core>
#include <variant>
#include <vector>

#include "sinew/rod/section.hpp"

namespace sinew::rod {

/// A homogeneous part.
struct SolidPart {
  Shape start = Circle{}, end = Circle{};  ///< of the same kind
  double young = 0.0, poisson = 0.0;       ///< [Pa], -
  double density = 0.0;                    ///< [kg/m^3]
  double viscosity = 0.0;                  ///< [Pa s]
};

/// A part known by its numbers.
struct GivenPart {
  Mat6 stiffness = Mat6::Zero();  ///< [N m^2, N m, N]
  double line_density = 0.0;      ///< [kg/m]
  double radius = 0.0;            ///< [m]
};

struct Part {
  double begin = 0.0, end = 0.0;  ///< [m]
  std::variant<SolidPart, GivenPart> made;
  double damping = 0.0;  ///< [s] viscous over elastic force
};

/// Parts in order, without gaps.
using Profile = std::vector<Part>;

const Part& part_at(const Profile& profile, double s);

Mat6 stiffness_at(const Profile& profile, double s);
Mat6 damping_at(const Profile& profile, double s);
LineInertia inertia_at(const Profile& profile, double s);
/// Of the circle about a cross-section, and of the one within it [m].
double radius_at(const Profile& profile, double s);
double inner_radius_at(const Profile& profile, double s);

/// Stresses under internal moments and forces; of a given part, those of a circle of its radius.
SectionStress stress_at(const Profile& profile, double s, const Vec6& internal);

/// int over begin .. end of f(s) ds by Gauss points, cut at the parts' ends: calls visit(s, weight).
template <class Visit>
void each_gauss_point(const Profile& profile, double begin, double end, int points, const Visit& visit);

/// Nodes in [0, 1] and weights of the Gauss rule with 1 to 10 points.
struct GaussRule {
  std::vector<double> node, weight;
};
const GaussRule& gauss_rule(int points);

template <class Visit>
void each_gauss_point(const Profile& profile, double begin, double end, int points, const Visit& visit) {
  const GaussRule& rule = gauss_rule(points);
  for (const Part& part : profile) {
    const double from = std::max(begin, part.begin), to = std::min(end, part.end);
    if (!(to > from)) continue;
    for (std::size_t g = 0; g < rule.node.size(); ++g)
      visit(from + (to - from) * rule.node[g], (to - from) * rule.weight[g]);
  }
}

}  // namespace sinew::rod
