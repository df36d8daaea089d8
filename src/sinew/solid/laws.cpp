#include "sinew/solid/laws.hpp"

#include <Eigen/Dense>
#include <cmath>

namespace sinew::solid {

Parts parts(const Law& law, const Mat3& F, Derivatives wanted) {
  return std::visit([&](const auto& l) { return parts(l, F, wanted); }, law);
}

Part density(const Law& law, const Mat3& F, Derivatives wanted) {
  return std::visit([&](const auto& l) { return density(l, F, wanted); }, law);
}

double dilatation(const Law& law, const Mat3& F) {
  return std::visit([&](const auto& l) { return l.dilatation(F, Derivatives::none).value; }, law);
}

Volumetric volumetric(const Law& law, double v) {
  return std::visit([&](const auto& l) { return l.volumetric(v); }, law);
}

Lame lame(const Law& law) {
  return std::visit([](const auto& l) { return l.lame(); }, law);
}

bool invertible(const Law& law) {
  return std::visit([](const auto& l) { return l.kInvertible; }, law);
}

Mat3 cauchy_stress(const Mat3& P, const Mat3& F) { return P * F.transpose() / F.determinant(); }

double von_mises(const Mat3& cauchy) {
  const Mat3 deviator = cauchy - cauchy.trace() / 3.0 * Mat3::Identity();
  return std::sqrt(1.5) * deviator.norm();
}

}  // namespace sinew::solid
