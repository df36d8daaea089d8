// Rods, coordinates and bases for the laws that every strain basis, order and size must meet.
#pragma once

#include <algorithm>
#include <random>

#include "sinew/lie/rotation.hpp"
#include "sinew/rod/rod.hpp"

namespace sinew::rod {

/// Every strain basis that matters: each strain alone, the paper's three, all six, and some pairs.
inline const std::vector<std::vector<int>> kBases = {{0}, {1},       {2},    {3},    {4},
                                                     {5}, {0, 1, 2}, {1, 3}, {2, 5}, {0, 1, 2, 3, 4, 5}};
/// Strain sizes: straight, the two scales at which closed forms break, and order one (relative to 1 / section length).
inline const double kSizes[] = {0.0, 1e-8, 1e-5, 1.0};

inline const std::vector<BaseMotion> kEveryMotion = {{false, 0, -1.0}, {false, 1}, {false, 2},
                                                     {true, 0},        {true, 1},  {true, 2}};

inline Coefficients random_coefficients(std::mt19937& random, int columns, double size) {
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  Coefficients Z(6, columns);
  for (double& value : Z.reshaped()) value = 0.3 * size * uniform(random);
  return Z;
}

inline Rod random_rod(const std::vector<int>& basis, int order, double size,
                      std::vector<BaseMotion> base = kEveryMotion) {
  std::mt19937 random(7);
  Discretisation cut;
  cut.ends = {0.0, 0.3, 0.5, 1.1};
  std::array<int, 6> orders{};
  orders.fill(order);
  cut.modes = modes_of(basis, orders);
  for (int i = 0; i < 3; ++i) cut.rest.push_back(random_coefficients(random, order + 1, size));
  Rod rod = make_rod(cut, {{0.0, 1.1, SolidPart{Circle{0.02}, Circle{0.01}, 1e6, 0.4, 1000.0, 10.0}, 0.0}});
  rod.base = std::move(base);
  return rod;
}

inline Eigen::VectorXd make_coordinates(const Rod& rod, double size) {
  std::mt19937 random(11);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  Eigen::VectorXd q(rod.coordinates());
  for (int i = 0; i < q.size(); ++i) q[i] = (i < rod.base_coordinates() ? 0.2 : size) * uniform(random);
  for (int i = 0; i < rod.count(); ++i) {
    for (std::size_t c = 0; c < rod.sections[i].modes.size(); ++c) {
      if (rod.sections[i].modes[c].strain >= 3) q[rod.base_coordinates() + rod.first[i] + static_cast<int>(c)] *= 0.3;
    }
  }
  return q;
}

inline const Placement kBase{lie::exp(Vec3(0.4, -0.2, 0.9)), Vec3(0.5, -1.0, 2.0)};
inline const Vec3 kOffset(0.0, 0.03, -0.02);
inline const double kAbscissae[] = {-0.05, 0.0, 0.1, 0.3, 0.42, 0.83, 1.1, 1.15};

}  // namespace sinew::rod
