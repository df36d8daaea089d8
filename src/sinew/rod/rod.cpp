#include "sinew/rod/rod.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

namespace sinew::rod {

bool Section::stretches() const {
  return std::any_of(modes.begin(), modes.end(), [](const Mode& mode) { return mode.strain >= 3; });
}

int Rod::section_at(double s) const {
  const auto after =
      std::upper_bound(sections.begin(), sections.end(), s, [](double at, const Section& own) { return at < own.end; });
  return std::min(static_cast<int>(after - sections.begin()), count() - 1);
}

std::vector<Mode> modes_of(const std::vector<int>& strains, const std::array<int, 6>& order) {
  std::vector<Mode> modes;
  for (const int strain : strains) {
    for (int degree = 0; degree <= order[static_cast<std::size_t>(strain)]; ++degree) modes.push_back({strain, degree});
  }
  return modes;
}

namespace {

int degree_of(const Section& section) {
  auto degree = static_cast<int>(section.rest.cols()) - 1;
  for (const Mode& mode : section.modes) degree = std::max(degree, mode.degree);
  return degree;
}

/// int B^T K B ds for K(s).
template <class Matrix>
Eigen::MatrixXd over_modes(const Section& section, const Profile& profile, const Matrix& K) {
  const auto m = static_cast<Eigen::Index>(section.modes.size());
  Eigen::MatrixXd sum = Eigen::MatrixXd::Zero(m, m);
  // Exact for constant and linearly tapering circles (degree four in s).
  each_gauss_point(profile, section.begin, section.end, degree_of(section) + 3, [&](double s, double weight) {
    const Mat6 at = K(profile, s);
    const auto P = legendre(section.local(s));
    for (Eigen::Index i = 0; i < m; ++i) {
      for (Eigen::Index j = 0; j < m; ++j) {
        const Mode &a = section.modes[i], &b = section.modes[j];
        sum(i, j) += weight * P[a.degree] * P[b.degree] * at(a.strain, b.strain);
      }
    }
  });
  return sum;
}

/// Per Gauss point four points on the axes of the cross-section that share its mass and stand off so far that they have
/// its rotary inertia. The rule is exact for the kinetic energy of a section whose points move quadratically along it.
void add_masses(const Section& section, const Profile& profile, std::vector<MassPoint>& masses) {
  const int degree = degree_of(section);
  each_gauss_point(profile, section.begin, section.end, degree == 0 ? 3 : degree + 4, [&](double s, double weight) {
    const LineInertia inertia = inertia_at(profile, s);
    if (!(inertia.mass > 0.0)) return;
    const double y = std::sqrt(2.0 * inertia.about_z / inertia.mass);
    const double z = std::sqrt(2.0 * inertia.about_y / inertia.mass);
    for (const Vec3& offset : {Vec3(0, y, 0), Vec3(0, -y, 0), Vec3(0, 0, z), Vec3(0, 0, -z)})
      masses.push_back({s, offset, 0.25 * weight * inertia.mass});
  });
}

std::vector<Station> stations_of(const std::vector<Section>& sections, const std::vector<MassPoint>& masses) {
  std::vector<Station> stations;
  int section = 0, step = 0;
  for (std::size_t i = 0; i < masses.size(); ++i) {
    const double s = masses[i].s;
    const Vec3 o(1.0, masses[i].offset.y(), masses[i].offset.z());
    const Mat3 spread = masses[i].mass * o * o.transpose();
    if (!stations.empty() && stations.back().s == s) {
      ++stations.back().masses;
      stations.back().spread += spread;
      continue;
    }
    const auto at = [&]() -> const Section& { return sections[static_cast<std::size_t>(section)]; };
    for (; s >= at().end && section + 1 < static_cast<int>(sections.size()); ++section) step = 0;
    const std::vector<Step>& steps = at().steps;
    while (step + 1 < static_cast<int>(steps.size()) && s >= steps[static_cast<std::size_t>(step)].end) ++step;
    const double from = steps[static_cast<std::size_t>(step)].begin;
    stations.push_back({s, section, step, static_cast<int>(i), 1,
                        partial_weights(at().begin, at().end, degree_of(at()), from, s).value, spread});
  }
  return stations;
}

}  // namespace

Rod make_rod(const Discretisation& discretisation, const Profile& profile) {
  Rod rod;
  rod.profile = profile;
  rod.first.push_back(0);
  for (std::size_t i = 0; i + 1 < discretisation.ends.size(); ++i) {
    Section& section = rod.sections.emplace_back();
    section.begin = discretisation.ends[i];
    section.end = discretisation.ends[i + 1];
    section.modes = discretisation.modes;
    section.rest = discretisation.rest.empty() ? Coefficients(Coefficients::Zero(6, 1)) : discretisation.rest[i];
    section.stiffness = over_modes(section, profile, stiffness_at);
    section.damping = over_modes(section, profile, damping_at);
    section.steps = integration_steps(section.begin, section.end, degree_of(section));
    add_masses(section, profile, rod.masses);
    rod.first.push_back(rod.first.back() + static_cast<int>(section.modes.size()));
  }
  rod.stations = stations_of(rod.sections, rod.masses);
  return rod;
}

Coefficients strain_coefficients(const Section& section, const Eigen::Ref<const Eigen::VectorXd>& q) {
  Coefficients Z = Coefficients::Zero(6, degree_of(section) + 1);
  Z.leftCols(section.rest.cols()) = section.rest;
  for (std::size_t c = 0; c < section.modes.size(); ++c)
    Z(section.modes[c].strain, section.modes[c].degree) += q[static_cast<Eigen::Index>(c)];
  return Z;
}

Vec6 strain(const Rod& rod, const Eigen::VectorXd& q, double s) {
  const int i = rod.section_at(s);
  const Section& section = rod.sections[i];
  const Coefficients Z = strain_coefficients(section, rod.of_section(q, i));
  return Z * legendre(section.local(s)).head(Z.cols());
}

Vec6 deviation(const Rod& rod, const Eigen::VectorXd& q, double s) {
  const int i = rod.section_at(s);
  const Section& section = rod.sections[i];
  const auto P = legendre(section.local(s));
  const auto own = rod.of_section(q, i);
  Vec6 sum = Vec6::Zero();
  for (std::size_t c = 0; c < section.modes.size(); ++c)
    sum[section.modes[c].strain] += P[section.modes[c].degree] * own[static_cast<Eigen::Index>(c)];
  return sum;
}

Eigen::VectorXd coordinates_of(const Rod& rod, const std::vector<Coefficients>& strains) {
  Eigen::VectorXd q = Eigen::VectorXd::Zero(rod.coordinates());
  for (int i = 0; i < rod.count(); ++i) {
    const Section& section = rod.sections[i];
    for (std::size_t c = 0; c < section.modes.size(); ++c) {  // Legendre polynomials are orthogonal: degree by degree
      const Mode& mode = section.modes[c];
      double value = mode.degree < strains[i].cols() ? strains[i](mode.strain, mode.degree) : 0.0;
      if (mode.degree < section.rest.cols()) value -= section.rest(mode.strain, mode.degree);
      q[rod.base_coordinates() + rod.first[i] + static_cast<int>(c)] = value;
    }
  }
  return q;
}

}  // namespace sinew::rod
