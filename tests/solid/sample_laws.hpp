// Laws and deformations that tests of laws share.
#pragma once

#include <cmath>
#include <numbers>
#include <ostream>
#include <random>
#include <string>
#include <vector>

#include "sinew/lie/rotation.hpp"
#include "sinew/solid/laws.hpp"

namespace sinew::solid {

inline constexpr double kYoung = 500e3, kPoisson = 0.4;
inline constexpr Derivatives kNone = Derivatives::none, kFirst = Derivatives::first, kSecond = Derivatives::second;

inline const OgdenTerm kRubber[] = {{6.3e5, 1.3}, {1.2e3, 5.0}, {-1e4, -2.0}};  // Ogden 1972
inline const OgdenTerm kStiffening[] = {{2e3, 17.0}};

struct NamedLaw {
  std::string name;
  Law law;
};
inline void PrintTo(const NamedLaw& named, std::ostream* out) { *out << named.name; }

/// What is said of every law holds for each of these.
inline const NamedLaw kLaws[] = {
    {"corotational", corotational(kYoung, kPoisson)},
    {"saint_venant_kirchhoff", saint_venant_kirchhoff(kYoung, kPoisson)},
    {"neo_hookean", neo_hookean(kYoung, kPoisson)},
    {"neo_hookean_poisson_0", neo_hookean(kYoung, 0.0)},
    {"mooney_rivlin", mooney_rivlin(1.2e5, 0.5e5, Poisson{kPoisson})},
    {"ogden", ogden(kRubber, Poisson{kPoisson})},
    {"ogden_stiffening", ogden(kStiffening, Bulk{3e5})},
};

inline Mat3 random_matrix(unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  return Mat3::NullaryExpr([&] { return uniform(random); });
}

inline const Mat3 kTurn = lie::exp(Vec3(0.9, -1.3, 0.4)), kOther = lie::exp(Vec3(-0.2, 0.7, 1.9)),
                  kHalfTurn = lie::exp(Vec3(2.0, -1.0, 0.5).normalized() * (std::numbers::pi - 1e-9));

struct SampleDeformation {
  std::string name;
  Mat3 F;
  double size;  ///< of its strain
};

/// Strains from 0 to O(1), equal and nearly equal stretches, all with large rotations.
inline std::vector<SampleDeformation> upright() {
  std::vector<SampleDeformation> all;
  for (double size : {0.0, 1e-8, 1e-5, 0.3}) {
    for (const Mat3& Q : {kTurn, kHalfTurn})
      all.push_back({"strain " + std::to_string(size), Q * (Mat3::Identity() + size * random_matrix(3)), size});
  }
  for (double gap : {0.0, 1e-12, 1e-8, 1e-5, 1e-3}) {
    const std::string at = " gap " + std::to_string(gap);
    const Vec3 two(1.3 * (1 + gap), 0.7, 1.3), three(1.2 * (1 + gap), 1.2, 1.2 * (1 - gap));
    all.push_back({"two" + at, kTurn * two.asDiagonal() * kOther, 0.3});
    all.push_back({"three" + at, kOther * three.asDiagonal() * kHalfTurn, 0.2});
  }
  all.push_back({"long", kTurn * Vec3(2.5, 0.6, 0.7).asDiagonal() * kOther, 1.0});
  return all;
}

inline std::vector<SampleDeformation> flat_and_inverted() {
  return {{"flat", kTurn * Vec3(1.1, 0.9, 0.0).asDiagonal() * kOther, 1.0},
          {"inverted", kTurn * Vec3(1.3, 0.8, -0.4).asDiagonal() * kOther, 1.0},
          {"mirrored", kOther * (Vec3(1.3, 0.9, -0.5).asDiagonal() * kTurn + 0.1 * random_matrix(5)), 1.0}};
}

inline std::vector<SampleDeformation> within(const Law& law) {
  std::vector<SampleDeformation> all = upright();
  if (invertible(law)) {
    for (const SampleDeformation& d : flat_and_inverted()) all.push_back(d);
  }
  return all;
}

}  // namespace sinew::solid
