#include "sinew/rod/section.hpp"

#include <cmath>
#include <numbers>

namespace sinew::rod {

Vec6 round_section_stiffness(double radius, double young, double poisson) {
  const double r2 = radius * radius;
  const double A = std::numbers::pi * r2, I = 0.25 * A * r2, J = 2.0 * I;
  const double G = young / (2.0 * (1.0 + poisson));
  const double k = 6.0 * (1.0 + poisson) / (7.0 + 6.0 * poisson);
  Vec6 stiffness;
  stiffness << G * J, young * I, young * I, young * A, k * G * A, k * G * A;
  return stiffness;
}

double round_section_von_mises(double radius, const Vec6& stress) {
  const double r2 = radius * radius;
  const double A = std::numbers::pi * r2, I = 0.25 * A * r2, J = 2.0 * I;
  const double normal = std::abs(stress[3]) / A + std::hypot(stress[1], stress[2]) * radius / I;
  const double shear = std::abs(stress[0]) * radius / J + std::hypot(stress[4], stress[5]) / A;
  return std::sqrt(normal * normal + 3.0 * shear * shear);
}

}  // namespace sinew::rod
