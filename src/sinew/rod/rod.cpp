#include "sinew/rod/rod.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace sinew::rod {

int Rod::section_at(double s) const {
  const auto after = std::upper_bound(ends.begin(), ends.end(), s);
  return std::clamp(static_cast<int>(after - ends.begin()) - 1, 0, sections() - 1);
}

Vec6 strain(const Rod& rod, const Eigen::VectorXd& q, int section) {
  Vec6 xi = rod.fixed.col(section);
  for (int i = 0; i < rod.strains(); ++i) xi[rod.basis[i]] += q[rod.first_coordinate(section) + i];
  return xi;
}

Eigen::VectorXd rest_coordinates(const Rod& rod) {
  Eigen::VectorXd q = Eigen::VectorXd::Zero(rod.coordinates());
  q.tail(rod.rest.size()) = rod.rest;
  return q;
}

std::vector<MassPoint> round_rod_masses(const std::vector<double>& ends, double radius, double density) {
  std::vector<MassPoint> masses;
  if (density <= 0.0) return masses;
  const double line_density = density * std::numbers::pi * radius * radius;
  const double off = radius / std::sqrt(2.0);
  const double gauss = std::sqrt(0.6);
  const double at[] = {0.5 * (1.0 - gauss), 0.5, 0.5 * (1.0 + gauss)};
  const double weight[] = {5.0 / 18.0, 8.0 / 18.0, 5.0 / 18.0};
  const Vec3 offsets[] = {{0, off, 0}, {0, -off, 0}, {0, 0, off}, {0, 0, -off}};
  for (std::size_t i = 0; i + 1 < ends.size(); ++i) {
    const double length = ends[i + 1] - ends[i];
    for (int g = 0; g < 3; ++g) {
      for (const Vec3& offset : offsets) {
        masses.push_back({ends[i] + at[g] * length, offset, 0.25 * weight[g] * length * line_density});
      }
    }
  }
  return masses;
}

}  // namespace sinew::rod
