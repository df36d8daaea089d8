#include "sinew/rod/tendon.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

namespace sinew::rod {

namespace {

struct Polar {
  double distance, angle, distance_slope, angle_slope;
};

Polar polar(const Tendon& tendon, double s) {
  const double length = tendon.to - tendon.from, t = (s - tendon.from) / length;
  return {tendon.start_distance + t * (tendon.end_distance - tendon.start_distance),
          tendon.start_angle + t * (tendon.end_angle - tendon.start_angle),
          (tendon.end_distance - tendon.start_distance) / length, (tendon.end_angle - tendon.start_angle) / length};
}

}  // namespace

Vec3 Tendon::offset(double s) const {
  const Polar at = polar(*this, s);
  return at.distance * Vec3(0.0, std::cos(at.angle), std::sin(at.angle));
}

Vec3 Tendon::slope(double s) const {
  const Polar at = polar(*this, s);
  const double c = std::cos(at.angle), v = std::sin(at.angle);
  return at.distance_slope * Vec3(0.0, c, v) + at.distance * at.angle_slope * Vec3(0.0, -v, c);
}

namespace {

/// Derivative of the tendon's position with respect to s, in the axes of the cross-section there.
Vec3 tangent(const Tendon& tendon, const Vec6& xi, double s) {
  return Vec3(xi.tail<3>()) + Vec3(xi.head<3>()).cross(tendon.offset(s)) + tendon.slope(s);
}

}  // namespace

Vec6 tendon_wrench(const Rod& rod, const Tendon& tendon, const Eigen::VectorXd& q, int number, double s) {
  Vec6 wrench = Vec6::Zero();
  if (s < tendon.from || s > tendon.to) return wrench;
  const Section& section = rod.sections[number];
  Coefficients strains = strain_coefficients(section, rod.of_section(q, number));
  strains(3, 0) += 1.0;
  const auto P = legendre(section.local(s));
  const Vec3 t = tangent(tendon, strains * P.head(strains.cols()), s).normalized();
  wrench << tendon.offset(s).cross(t), t;
  return wrench;
}

TendonLength tendon_length(const Rod& rod, const Tendon& tendon, const Eigen::VectorXd& q) {
  TendonLength length;
  length.gradient.setZero(rod.strain_coordinates());
  Eigen::Index largest = 0;
  for (const Section& section : rod.sections)
    largest = std::max(largest, static_cast<Eigen::Index>(section.modes.size()));
  length.hessian.setZero(largest, rod.strain_coordinates());
  for (int i = 0; i < rod.count(); ++i) {
    const Section& section = rod.sections[i];
    const double from = std::max(section.begin, tendon.from), to = std::min(section.end, tendon.to);
    if (!(to > from)) continue;
    const auto m = static_cast<Eigen::Index>(section.modes.size());
    Coefficients strains = strain_coefficients(section, rod.of_section(q, i));
    strains(3, 0) += 1.0;
    // A tendon that winds about the rod needs more points the further it turns.
    const double turn = std::abs(tendon.end_angle - tendon.start_angle) * (to - from) / (tendon.to - tendon.from);
    const int panels = 1 + static_cast<int>(turn);  // of at most a radian
    const GaussRule& rule = gauss_rule(static_cast<int>(strains.cols()) + 4);
    const double panel = (to - from) / panels;
    for (std::size_t g = 0; g < rule.node.size() * static_cast<std::size_t>(panels); ++g) {
      const std::size_t node = g % rule.node.size();
      const std::size_t before = g / rule.node.size();  // panels
      const double s = from + panel * (static_cast<double>(before) + rule.node[node]);
      const double weight = panel * rule.weight[node];
      const auto P = legendre(section.local(s));
      const Vec6 xi = strains * P.head(strains.cols());
      const Vec3 d = tendon.offset(s);
      const Vec3 v = tangent(tendon, xi, s);
      const double speed = v.norm();
      const Vec3 t = v / speed;
      Eigen::Matrix<double, 3, Eigen::Dynamic> J(3, m);
      for (Eigen::Index c = 0; c < m; ++c) {
        const Mode& mode = section.modes[c];
        J.col(c) = P[mode.degree] *
                   (mode.strain < 3 ? Vec3(Vec3::Unit(mode.strain).cross(d)) : Vec3(Vec3::Unit(mode.strain - 3)));
      }
      length.value += weight * speed;
      length.gradient.segment(rod.first[i], m) += weight * (J.transpose() * t);
      length.hessian.block(0, rod.first[i], m, m) +=
          weight / speed * (J.transpose() * J - (J.transpose() * t) * (t.transpose() * J));
    }
  }
  return length;
}

}  // namespace sinew::rod
