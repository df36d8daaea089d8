#include "sinew/sim/internal.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>

namespace sinew {

namespace {

/// Linear between the places where the wrench is known.
rod::Vec6 needed(const Eigen::MatrixXd& internal, double s) {
  Eigen::Index next = 0;
  while (next < internal.cols() && internal(0, next) <= s) ++next;
  if (next == 0 || next == internal.cols()) return internal.block<6, 1>(1, std::max<Eigen::Index>(next, 1) - 1);
  const double from = internal(0, next - 1), t = (s - from) / (internal(0, next) - from);
  return (1.0 - t) * internal.block<6, 1>(7, next - 1) + t * internal.block<6, 1>(1, next);
}

}  // namespace

Eigen::MatrixXd no_internal(const RodModel& rod) {
  Eigen::MatrixXd internal = Eigen::MatrixXd::Zero(13, rod.rod.count() + 1 + rod.jumps);
  internal.row(0).setConstant(-1.0);
  return internal;
}

void write_internal(const std::vector<rod::Balance>& along, RodState& state) {
  Eigen::MatrixXd& internal = state.internal;
  if (std::ssize(along) > internal.cols()) {  // more contacts than there is room for: the smallest jumps are left out
    // (None of the base, of sections' ends and of the tip, which have none or are the last.)
    const auto kept = static_cast<std::size_t>(internal.cols());
    std::vector<std::size_t> inner;
    for (std::size_t i = 1; i + 1 < along.size(); ++i) {
      if (along[i].beyond != along[i].before) inner.push_back(i);
    }
    const std::size_t excess = std::min(along.size() - kept, inner.size());
    std::stable_sort(inner.begin(), inner.end(), [&along](std::size_t a, std::size_t b) {
      return (along[a].beyond - along[a].before).squaredNorm() < (along[b].beyond - along[b].before).squaredNorm();
    });
    std::vector<bool> left_out(along.size(), false);
    for (std::size_t i = 0; i < excess; ++i) left_out[inner[i]] = true;
    std::vector<rod::Balance> large;
    for (std::size_t i = 0; i < along.size() && large.size() < kept; ++i) {
      if (!left_out[i]) large.push_back(along[i]);
    }
    return write_internal(large, state);
  }
  auto column = internal.cols() - static_cast<Eigen::Index>(along.size());
  internal.leftCols(column).setZero();
  internal.row(0).head(column).setConstant(-1.0);
  for (const rod::Balance& at : along) internal.col(column++) << at.s, at.before, at.beyond;
}

rod::Vec6 internal_wrench(const Model& model, const State& state, int number, double s) {
  const rod::Rod& rod = model.rods[number].rod;
  const RodState& own = state.rods[number];
  rod::Vec6 wrench = needed(own.internal, s);
  const rod::Vec6 elastic = rod::stiffness_at(rod.profile, s) * rod::deviation(rod, own.q, s);
  for (const rod::Mode& mode : rod.sections[rod.section_at(s)].modes) wrench[mode.strain] = elastic[mode.strain];
  return wrench;
}

double tautness(const Model& model, const State& state, int number) {
  const rod::Rod& rod = model.rods[number].rod;
  double most = 0.0;
  for (const rod::Section& section : rod.sections) {
    const double s = 0.5 * (section.begin + section.end), l = section.length();
    const Eigen::Matrix<double, 6, 6> stiffness = rod::stiffness_at(rod.profile, s);
    const double tension = internal_wrench(model, state, number, s)[3];
    for (const rod::Mode& mode : section.modes) {
      if (mode.strain == 1 || mode.strain == 2)
        most = std::max(most, tension * l * l / stiffness(mode.strain, mode.strain));
    }
  }
  return most;
}

double elastic_energy(const rod::Rod& rod, const RodState& state) {
  double energy = 0.0;
  for (int k = 0; k < rod.count(); ++k) {
    const auto q = rod.of_section(state.q, k);
    energy += 0.5 * q.dot(rod.sections[static_cast<std::size_t>(k)].stiffness.lazyProduct(q));
  }
  return energy;
}

double kinetic_energy(const rod::Rod& rod, const RodState& state) {
  double energy = 0.0;
  for (std::size_t m = 0; m < rod.masses.size(); ++m)
    energy += 0.5 * rod.masses[m].mass * state.velocity.col(static_cast<Eigen::Index>(m)).squaredNorm();
  return energy;
}

double buckling_load(const rod::Rod& rod) {
  double least = INFINITY;  // a stout base does not keep the rest from bending
  for (const double s : {0.0, 0.5 * rod.length()}) {
    const rod::Mat6 stiffness = rod::stiffness_at(rod.profile, s);
    least = std::min({least, stiffness(1, 1), stiffness(2, 2)});
  }
  return std::pow(std::numbers::pi / rod.length(), 2) * least;
}

rod::SectionStress section_stress(const Model& model, const State& state, int number, double s) {
  return rod::stress_at(model.rods[number].rod.profile, s, internal_wrench(model, state, number, s));
}

}  // namespace sinew
