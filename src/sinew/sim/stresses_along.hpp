// The stresses that loads need for balance, between the places along a rod at which they are known.
#pragma once

#include <array>

#include "sinew/sim/internal.hpp"

namespace sinew {

/// Gauss points of [0, 1], exact for a line times the polynomials of any section.
struct GaussPoint {
  double t, weight;
};
inline constexpr std::array<GaussPoint, 3> kGaussOfThree = {
    {{0.1127016653792583, 5.0 / 18.0}, {0.5, 8.0 / 18.0}, {0.8872983346207417, 5.0 / 18.0}}};

/// Linear from one column of RodState::internal (t = 0) to the next (t = 1).
inline rod::Vec6 stress_between(const Eigen::MatrixXd& internal, Eigen::Index column, double t) {
  return (1.0 - t) * internal.block<6, 1>(7, column) + t * internal.block<6, 1>(1, column + 1);
}

/// Whether a rod moves so little that its inertia does not bend it.
inline bool almost_rests(const rod::Rod& rod, const RodState& state) {
  constexpr double kAtRest = 1e-2;  // part of its elastic energy: less kinetic energy than that
  return kinetic_energy(rod, state) <= kAtRest * elastic_energy(rod, state);
}

}  // namespace sinew
