#include "sinew/solid/laws.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include "solid/sample_laws.hpp"
#include "support/difference.hpp"

namespace sinew::solid {
namespace {

class EveryLaw : public testing::TestWithParam<NamedLaw> {
 protected:
  const Law& law = GetParam().law;
  const Lame rest = lame(law);
  const double stiffness = 2.0 * rest.mu + std::abs(rest.lambda);
};
INSTANTIATE_TEST_SUITE_P(Laws, EveryLaw, testing::ValuesIn(kLaws), [](const auto& i) { return i.param.name; });

Vec3 principal_stretches(const Mat3& F) { return Eigen::JacobiSVD<Mat3>(F).singularValues(); }
Mat3 matrix(const Eigen::VectorXd& x) { return Eigen::Map<const Mat3>(x.data()); }
Eigen::VectorXd flat(const Mat3& F) { return F.reshaped(); }

/// Part `which`: 0 w, 1 v, 2 psi.
Part part(const Law& law, int which, const Mat3& F, Derivatives wanted) {
  if (which == 2) return density(law, F, wanted);
  return std::visit([&](const auto& l) { return which == 0 ? l.shape(F, wanted) : l.dilatation(F, wanted); }, law);
}

/// Hooke's law over vec(F).
Mat9 hooke(const Lame& rest) {
  Mat9 K;
  for (int c = 0; c < 9; ++c) {
    Mat3 H = Mat3::Zero();
    H(c) = 1.0;
    K.col(c) = (rest.mu * (H + H.transpose()) + rest.lambda * H.trace() * Mat3::Identity()).reshaped();
  }
  return K;
}

TEST_P(EveryLaw, first_derivatives_are_those_of_the_value) {
  const double e = 1e-5;
  for (const SampleDeformation& d : within(law)) {
    for (int which : {0, 1, 2}) {
      const double scale = which == 1 ? 1.0 : stiffness;
      const Mat3 first = part(law, which, d.F, kFirst).first;
      const Eigen::MatrixXd D = test::difference(
          [&](const Eigen::VectorXd& x) {
            return Eigen::VectorXd::Constant(1, part(law, which, matrix(x), kNone).value);
          },
          flat(d.F), e);
      // e^2 times third derivatives, which grow with the power 17 of one law, and rounding / e
      EXPECT_LT((flat(first) - D.transpose()).norm(), 2e-8 * (scale + first.norm())) << d.name << " part " << which;
      const Vec3 stretch = principal_stretches(d.F);  // w of some laws does not see equal ones
      const double seen = which == 0 ? stretch[0] - stretch[2] : which == 1 ? 1.0 : d.size;
      if (seen > 1e-6) {
        EXPECT_GT(D.norm(), 0.02 * seen * scale) << d.name << " part " << which;
      }
    }
  }
}

TEST_P(EveryLaw, second_derivatives_are_those_of_the_first_and_symmetric) {
  const double e = 1e-5;
  for (const SampleDeformation& d : within(law)) {
    for (int which : {0, 1, 2}) {
      const double scale = which == 1 ? 1.0 : stiffness;
      const Mat9 second = part(law, which, d.F, kSecond).second;
      const Eigen::MatrixXd D = test::difference(
          [&](const Eigen::VectorXd& x) { return flat(part(law, which, matrix(x), kFirst).first); }, flat(d.F), e);
      EXPECT_LT((second - D).norm(), 1e-7 * (scale + second.norm())) << d.name << " part " << which;
      EXPECT_GT(D.norm(), 0.1 * scale) << d.name << " part " << which;
      EXPECT_LT((second - second.transpose()).norm(), 1e-13 * second.norm()) << d.name << " part " << which;
    }
  }
}

TEST_P(EveryLaw, derivatives_of_the_volumetric_part_are_exact) {
  const double e = 1e-5;
  for (double v : {-0.7, 0.0, 0.6, 1.0, 1.4}) {
    const Volumetric U = volumetric(law, v), plus = volumetric(law, v + e), minus = volumetric(law, v - e);
    EXPECT_NEAR(U.first, (plus.value - minus.value) / (2 * e), 1e-9 * stiffness);
    EXPECT_NEAR(U.second, (plus.first - minus.first) / (2 * e), 1e-9 * stiffness);
    if (rest.lambda > 0.0) {  // else there may be nothing to keep apart
      EXPECT_GT(U.second, 0.1 * rest.mu);
    }
  }
}

TEST_P(EveryLaw, values_do_not_depend_on_what_else_is_wanted_and_the_parts_make_the_whole) {
  const Mat3 F = upright()[6].F;
  for (Derivatives wanted : {kNone, kFirst, kSecond}) {
    const Parts both = parts(law, F, wanted);
    for (int which : {0, 1}) {
      const Part full = part(law, which, F, kSecond), asked = part(law, which, F, wanted),
                 together = which == 0 ? both.shape : both.dilatation;
      for (const Part& p : {asked, together}) {
        EXPECT_NEAR(p.value, full.value, 1e-14 * stiffness);
        EXPECT_LE((p.first - (wanted != kNone) * full.first).norm(), 1e-14 * (wanted != kNone) * stiffness);
        if (wanted == kSecond) {
          EXPECT_LE((p.second - full.second).norm(), 1e-14 * stiffness);
        }
      }
    }
    const Volumetric U = volumetric(law, both.dilatation.value);
    const double whole = density(law, F, wanted).value;
    EXPECT_NEAR(whole, both.shape.value + U.value, 1e-14 * stiffness);
    EXPECT_GT(whole, 1e-3 * stiffness);
  }
}

TEST_P(EveryLaw, energy_and_stress_do_not_see_a_rotation_of_space) {
  for (const SampleDeformation& d : within(law)) {
    const Part here = density(law, d.F, kFirst), there = density(law, kOther * d.F, kFirst);
    EXPECT_NEAR(there.value, here.value, 1e-13 * (stiffness + here.value)) << d.name;
    EXPECT_LT((there.first - kOther * here.first).norm(), 1e-13 * (stiffness + here.first.norm())) << d.name;
  }
}

TEST_P(EveryLaw, the_material_has_no_directions) {
  for (const SampleDeformation& d : within(law)) {
    const Part here = density(law, d.F, kFirst), there = density(law, d.F * kOther, kFirst);
    EXPECT_NEAR(there.value, here.value, 1e-13 * (stiffness + here.value)) << d.name;
    EXPECT_LT((there.first - here.first * kOther).norm(), 1e-13 * (stiffness + here.first.norm())) << d.name;
  }
}

TEST_P(EveryLaw, at_rest_there_is_neither_energy_nor_stress_and_stiffness_is_hookes) {
  const Part psi = density(law, Mat3::Identity(), kSecond);
  EXPECT_NEAR(psi.value, 0.0, 1e-15 * stiffness);
  EXPECT_LT(psi.first.norm(), 1e-15 * stiffness);
  EXPECT_LT((psi.second - hooke(rest)).norm(), 1e-14 * stiffness);
  EXPECT_GT(rest.mu, 1.0);
}

TEST_P(EveryLaw, small_strains_follow_hooke_in_any_frame) {
  const Mat3 H = random_matrix(7);
  const Mat3 sigma = matrix(hooke(rest) * flat(H));
  EXPECT_GT(sigma.norm(), 0.1 * rest.mu);
  for (double size : {1e-8, 1e-5}) {
    for (const Mat3& Q : {kTurn, kHalfTurn}) {
      const Part psi = density(law, Q * (Mat3::Identity() + size * H), kFirst);
      // rounding of F by 1e-16, and the next power of the strain (20: the stiffening law)
      EXPECT_LT((psi.first - size * Q * sigma).norm(), (1e-15 + 20 * size * size) * stiffness) << size;
      const double work = 0.5 * size * size * sigma.cwiseProduct(H).sum();
      EXPECT_NEAR(psi.value, work, (1e-15 + 20 * size * size * size) * stiffness);
      if (size > 1e-6) {
        EXPECT_GT(work, 1e-12 * stiffness);
      }
    }
  }
}

TEST_P(EveryLaw, energy_is_nowhere_negative) {
  for (unsigned seed = 0; seed < 3000; ++seed) {
    const Mat3 F = (seed % 3 == 0 ? Mat3(Mat3::Identity()) : Mat3(Mat3::Zero())) + 1.2 * random_matrix(seed);
    EXPECT_GE(density(law, F, kNone).value, 0.0) << F;
  }
  for (const SampleDeformation& d : within(law))
    EXPECT_GE(density(law, d.F, kNone).value, -1e-15 * stiffness) << d.name;
}

TEST_P(EveryLaw, flat_and_inverted_states_are_finite_or_refused) {
  std::vector<SampleDeformation> all = flat_and_inverted();
  all.push_back({"a point", Mat3::Zero(), 1.0});
  all.push_back({"flat, exactly", Vec3(1.0, 2.0, 0.0).asDiagonal(), 1.0});
  for (const SampleDeformation& d : all) {
    if (d.name == "flat") continue;  // its determinant may be rounded to either side
    const Part w = part(law, 0, d.F, kSecond), v = part(law, 1, d.F, kSecond);
    EXPECT_TRUE(v.first.allFinite() && v.second.allFinite() && std::isfinite(v.value)) << d.name;
    if (invertible(law)) {
      EXPECT_TRUE(std::isfinite(w.value) && w.first.allFinite() && w.second.allFinite()) << d.name;
    } else {
      EXPECT_EQ(w.value, std::numeric_limits<double>::infinity()) << d.name;
      EXPECT_EQ(w.first.norm() + w.second.norm(), 0.0) << d.name;
    }
  }
}

// --- Closed curves. Principal nominal stresses of each law, d psi / d l_i by hand.

Vec3 nominal(const Corotational& law, const Vec3& l) {
  return (2 * law.moduli.mu * (l.array() - 1) + law.moduli.lambda * (l.sum() - 3)).matrix();
}
Vec3 nominal(const SaintVenantKirchhoff& law, const Vec3& l) {
  const Vec3 E = 0.5 * (l.cwiseAbs2().array() - 1);
  return l.cwiseProduct((2 * law.moduli.mu * E.array() + law.moduli.lambda * E.sum()).matrix());
}
Vec3 nominal(const NeoHookean& law, const Vec3& l) {
  // Smith et al. 2018: P = mu' (1 - 1/(I + 1)) F + lambda' (J - alpha) cof F
  const double mu = 4.0 / 3.0 * law.moduli.mu, lambda = law.moduli.lambda + 5.0 / 6.0 * law.moduli.mu;
  const double alpha = 1 + mu / lambda - mu / (4 * lambda), J = l.prod();
  return mu * (1 - 1 / (l.squaredNorm() + 1)) * l + lambda * (J - alpha) * J * l.cwiseInverse();
}
Vec3 nominal(const MooneyRivlin& law, const Vec3& l) {
  const double J = l.prod(), I1 = l.squaredNorm();
  const double I2 = l[0] * l[0] * l[1] * l[1] + l[1] * l[1] * l[2] * l[2] + l[2] * l[2] * l[0] * l[0];
  Vec3 P;
  for (int i = 0; i < 3; ++i) {
    const double a = l[i] * l[i];
    P[i] =
        (2 * law.c10 * std::pow(J, -2.0 / 3) * (a - I1 / 3) +
         2 * law.c01 * std::pow(J, -4.0 / 3) * (a * (I1 - a) - 2 * I2 / 3) + bulk_modulus(law.moduli) * (J - 1) * J) /
        l[i];
  }
  return P;
}
Vec3 nominal(const Ogden& law, const Vec3& l) {
  const double J = l.prod();
  Vec3 tau = Vec3::Constant(bulk_modulus(law.moduli) * (J - 1) * J);
  for (int p = 0; p < law.count; ++p) {
    const Vec3 powers = (l / std::cbrt(J)).array().pow(law.terms[p].alpha);
    tau.array() += law.terms[p].mu * (powers.array() - powers.sum() / 3);
  }
  return tau.cwiseQuotient(l);
}

/// Stretches l along the first `loaded` axes, that of the others such that they are free; by bisection.
Vec3 free_sides(const Law& law, int loaded, double l) {
  const auto at = [&](double t) { return Vec3(l, loaded > 1 ? l : t, t); };
  double low = 0.05, high = 3.0;
  for (int i = 0; i < 100; ++i) {
    const double middle = 0.5 * (low + high);
    (density(law, at(middle).asDiagonal(), kFirst).first(2, 2) < 0 ? low : high) = middle;
  }
  return at(low);
}

TEST_P(EveryLaw, follows_its_principal_stresses_in_uniaxial_and_equibiaxial_tension) {
  for (int loaded : {1, 2}) {
    for (double l : {0.8, 0.999, 1.1, 1.25}) {
      const Vec3 stretch = free_sides(law, loaded, l);
      const Mat3 P = density(law, kOther * stretch.asDiagonal() * kTurn, kFirst).first;
      const Vec3 expected = std::visit([&](const auto& one) { return nominal(one, stretch); }, law);
      const Mat3 back = kOther.transpose() * P * kTurn.transpose();
      EXPECT_LT((back - Mat3(expected.asDiagonal())).norm(), 1e-12 * (stiffness + expected.norm())) << l;
      EXPECT_LT(std::abs(expected[2]), 1e-12 * (stiffness + expected.norm())) << l;
      EXPECT_GT(std::abs(expected[0]), 1e-4 * rest.mu) << l;
    }
  }
}

TEST(Laws, follow_their_curves_in_tension) {
  const double E = kYoung, nu = kPoisson;
  const Law linear = corotational(E, nu), green = saint_venant_kirchhoff(E, nu);
  const NeoHookean neo = neo_hookean(E, nu);
  for (double l : {0.8, 1.1, 1.25}) {  // pulled in two directions at 1.32, Saint Venant-Kirchhoff is flat
    const auto pulled = [&](const Law& law, int loaded) {
      const Vec3 stretch = free_sides(law, loaded, l);
      return std::pair(stretch, density(law, stretch.asDiagonal(), kFirst).first(0, 0));
    };
    const double strain = 0.5 * (l * l - 1);
    EXPECT_NEAR(pulled(linear, 1).first[2], 1 - nu * (l - 1), 1e-14);
    EXPECT_NEAR(pulled(linear, 1).second, E * (l - 1), 1e-9 * E);
    EXPECT_NEAR(pulled(linear, 2).second, E / (1 - nu) * (l - 1), 1e-9 * E);
    EXPECT_NEAR(std::pow(pulled(green, 1).first[2], 2), 1 - 2 * nu * strain, 1e-14);
    EXPECT_NEAR(pulled(green, 1).second, E * l * strain, 1e-9 * E);
    EXPECT_NEAR(pulled(green, 2).second, E / (1 - nu) * l * strain, 1e-9 * E);
    for (int loaded : {1, 2}) {  // the free side tells the pressure: P = mu' (1 - 1 / (I + 1)) (l - t^2 / l)
      const auto [stretch, P] = pulled(neo, loaded);
      const double share = 1 / (stretch.squaredNorm() + 1);
      EXPECT_NEAR(P, 4.0 / 3.0 * neo.lame().mu * (1 - share) * (l - stretch[2] * stretch[2] / l), 1e-9 * E);
    }
  }
}

// Cauchy stresses of the incompressible laws: Ogden, Non-linear Elastic Deformations, 7.2; Holzapfel, 6.5.
TEST(Laws, mooney_rivlin_and_ogden_reach_the_incompressible_curves) {
  const double c10 = 1.2e5, c01 = 0.5e5, bulk = 1e12;
  const Law mooney = mooney_rivlin(c10, c01, Bulk{bulk}), rubber = ogden(kRubber, Bulk{bulk});
  for (double l : {0.6, 1.2, 2.0, 3.0}) {
    const auto cauchy = [&](const Law& law, int loaded) {
      const Mat3 F = free_sides(law, loaded, l).asDiagonal();
      return cauchy_stress(density(law, F, kFirst).first, F)(0, 0);
    };
    const double uniaxial = 2 * (l * l - 1 / l) * (c10 + c01 / l);
    const double biaxial = 2 * (l * l - std::pow(l, -4)) * (c10 + c01 * l * l);
    EXPECT_NEAR(cauchy(mooney, 1), uniaxial, 1e-3 * std::abs(uniaxial)) << l;
    EXPECT_NEAR(cauchy(mooney, 2), biaxial, 1e-3 * std::abs(biaxial)) << l;
    double one = 0, two = 0;
    for (const auto& [mu, alpha] : kRubber) {
      one += mu * (std::pow(l, alpha) - std::pow(l, -alpha / 2));
      two += mu * (std::pow(l, alpha) - std::pow(l, -2 * alpha));
    }
    EXPECT_NEAR(cauchy(rubber, 1), one, 1e-3 * std::abs(one)) << l;
    EXPECT_NEAR(cauchy(rubber, 2), two, 1e-3 * std::abs(two)) << l;
  }
}

TEST(Laws, follow_their_curves_in_simple_shear) {
  const Lame rest = lame(kYoung, kPoisson);
  const double mu = rest.mu, lambda = rest.lambda, tolerance = 1e-10 * kYoung;
  for (double g : {1e-3, 0.4, 1.5}) {
    Mat3 F = Mat3::Identity();
    F(0, 1) = g;
    const auto P = [&](const Law& law) { return density(law, F, kFirst).first; };
    const auto sigma = [&](const Law& law) { return cauchy_stress(P(law), F); };

    // R turns by -atan(g / 2), tr S = sqrt(4 + g^2) + 1
    const double d = std::sqrt(4 + g * g), more = lambda * (d - 2), sine = g / d;
    const Mat3 turned = P(corotational(kYoung, kPoisson));
    EXPECT_NEAR(turned(0, 1), 2 * mu * (g - sine) + more * sine, tolerance);
    EXPECT_NEAR(turned(1, 0), 2 * mu * sine - more * sine, tolerance);
    EXPECT_NEAR(turned(0, 0), 2 * mu * (1 - 2 / d) + more * 2 / d, tolerance);

    const Mat3 green = P(saint_venant_kirchhoff(kYoung, kPoisson));
    EXPECT_NEAR(green(1, 0), mu * g, tolerance);
    EXPECT_NEAR(green(0, 1), mu * g + (mu + lambda / 2) * g * g * g, tolerance);
    EXPECT_NEAR(green(1, 1), (mu + lambda / 2) * g * g, tolerance);

    const double kept = 4.0 / 3.0 * mu * (1 - 1 / (4 + g * g));
    const Mat3 neo = sigma(neo_hookean(kYoung, kPoisson));
    EXPECT_NEAR(neo(0, 1), kept * g, tolerance);
    EXPECT_NEAR(neo(0, 0), kept * (1 + g * g) - mu, tolerance);
    EXPECT_NEAR(neo(1, 1), kept - mu, tolerance);

    const Mat3 mooney = sigma(mooney_rivlin(1.2e5, 0.5e5, Poisson{0.3}));
    EXPECT_NEAR(mooney(0, 1), 2 * 1.7e5 * g, tolerance);
    EXPECT_NEAR(mooney(0, 0) - mooney(1, 1), 2 * 1.7e5 * g * g, tolerance);
    EXPECT_NEAR(mooney(2, 2), -2.0 / 3.0 * 0.7e5 * g * g, tolerance);

    // stretches l, 1/l with l - 1/l = g; sigma_1 - sigma_2 seen under the angle with sin 2 chi = 2 / (l + 1/l)
    const double l = 0.5 * (g + d);
    double shear = 0;
    for (const auto& [m, alpha] : kRubber) shear += m * (std::pow(l, alpha) - std::pow(l, -alpha)) / (l + 1 / l);
    const Mat3 rubber = sigma(ogden(kRubber, Poisson{0.3}));
    EXPECT_NEAR(rubber(0, 1), shear, tolerance);
    EXPECT_NEAR(rubber(0, 0) - rubber(1, 1), g * shear, tolerance);
  }
}

// Two paths, one through invariants and one through stretches, to the same function.
TEST(Ogden, with_powers_2_and_minus_2_is_mooney_rivlin) {
  const OgdenTerm terms[] = {{2 * 1.2e5, 2.0}, {-2 * 0.5e5, -2.0}};
  const Ogden ogden_law = ogden(terms, Bulk{2e6});
  const MooneyRivlin mooney = mooney_rivlin(1.2e5, 0.5e5, Bulk{2e6});
  EXPECT_NEAR(ogden_law.moduli.mu, 2 * 1.7e5, 1e-9);
  for (const SampleDeformation& d : upright()) {
    const Part a = density(ogden_law, d.F, kSecond), b = density(mooney, d.F, kSecond);
    EXPECT_NEAR(a.value, b.value, 1e-14 * (2e6 + b.value)) << d.name;
    EXPECT_LT((a.first - b.first).norm(), 1e-14 * (2e6 + b.first.norm())) << d.name;
    EXPECT_LT((a.second - b.second).norm(), 3e-14 * b.second.norm()) << d.name;
    EXPECT_GT(b.second.norm(), 1e5);
  }
}

TEST(Ogden, energy_of_small_strains_keeps_its_digits) {
  const double size = 1e-6;
  const Mat3 F = kTurn * (Mat3::Identity() + size * random_matrix(7));
  const Mat3 H = 0.5 * size * (random_matrix(7) + random_matrix(7).transpose());
  for (const Law& law : {Law(ogden(kRubber, Bulk{1e6})), Law(mooney_rivlin(1e5, 1e5, Bulk{1e6}))}) {
    const double expected = lame(law).mu * H.squaredNorm(), w = part(law, 0, F, kNone).value;
    EXPECT_NEAR(w, expected, 1e-5 * expected);  // the next power of the strain; rounding of I1 would be 1e-4
    EXPECT_GT(expected, 0.0);
  }
}

TEST(Moduli, lame_constants_give_back_young_and_poisson) {
  const Lame rest = lame(500e3, 0.45);
  EXPECT_NEAR(rest.mu * (3 * rest.lambda + 2 * rest.mu) / (rest.lambda + rest.mu), 500e3, 1e-6);
  EXPECT_NEAR(rest.lambda / (2 * (rest.lambda + rest.mu)), 0.45, 1e-14);
  const Lame same = lame_from_bulk(rest.mu, bulk_modulus(rest.mu, Poisson{0.45}));
  EXPECT_NEAR(same.lambda, rest.lambda, 1e-9 * rest.lambda);
  EXPECT_EQ(bulk_modulus(rest.mu, Bulk{7e5}), 7e5);
}

// --- Polar decomposition and the frozen frame

TEST(PolarRotation, is_the_nearest_proper_one) {
  const Vec3 axis = Vec3(2.0, -1.0, 0.5).normalized();
  const double pi = std::numbers::pi;
  for (double angle : {0.0, 1e-8, 1.0, pi - 1e-3, pi - 1e-8, pi}) {
    const Mat3 R = lie::exp(angle * axis);
    EXPECT_LT((polar_rotation(R) - R).norm(), 2e-15) << angle;
    for (double size : {1e-12, 1e-8, 1e-5, 1e-2, 0.3}) {
      const Mat3 S = Mat3::Identity() + size * (random_matrix(1) + random_matrix(1).transpose());
      EXPECT_LT((polar_rotation(R * S) - R).norm(), 3e-15) << angle << " " << size;
    }
    for (const Vec3& l : {Vec3(1e3, 2e3, 3e3), Vec3(1e-5, 1e-5, 1e-5), Vec3(1e2, 1.0, 0.5), Vec3(1.0, 0.8, 1e-3),
                          Vec3(1.0, 0.8, 1e-9), Vec3(1.0, 0.8, 0.0), Vec3(1.0, 0.8, -1e-9), Vec3(1.2, 0.8, -0.5)}) {
      const Mat3 S = kOther * l.asDiagonal() * kOther.transpose();
      const double sharp =
          l.maxCoeff() / (l.sum() - l.maxCoeff());  // R moves by rounding of F over the least l_i + l_j
      EXPECT_LT((polar_rotation(R * S) - R).norm(), 3e-15 * std::max(1.0, sharp)) << angle << " " << l.transpose();
    }
  }
}

TEST(PolarRotation, is_a_rotation_for_every_matrix) {
  std::vector<Mat3> all = {Mat3::Zero(),
                           -Mat3::Identity(),
                           Vec3(1, 0, 0).asDiagonal(),
                           Vec3(-1, 1, 1).asDiagonal(),
                           Vec3(1e-160, 1e-160, 1e-160).asDiagonal(),
                           Vec3(1e120, 1e120, 1e120).asDiagonal()};
  for (unsigned seed = 0; seed < 5000; ++seed) all.push_back(random_matrix(seed));
  for (const Mat3& F : all) {
    const Mat3 R = polar_rotation(F);
    EXPECT_LT((R.transpose() * R - Mat3::Identity()).norm(), 2e-15) << F;
    EXPECT_NEAR(R.determinant(), 1.0, 2e-15) << F;
    const Mat3 S = R.transpose() * F;  // symmetric, and no other rotation is nearer: its least two stretches sum >= 0
    EXPECT_LE((S - S.transpose()).norm(), 1e-14 * F.norm()) << F;
    const Mat3 D = S.trace() * Mat3::Identity() - 0.5 * (S + S.transpose());
    EXPECT_GE(Eigen::SelfAdjointEigenSolver<Mat3>(D).eigenvalues()[0], -1e-14 * F.norm()) << F;
  }
}

TEST(Corotational, rotated_is_positive_semi_definite_and_exact_at_rest) {
  const Corotational law = corotational(kYoung, kPoisson);
  const auto tangent = [&](const Mat3& F) {
    const Parts rotated = law.definite(F, kSecond);
    EXPECT_NEAR(rotated.shape.value, law.shape(F, kNone).value, 1e-14 * kYoung);
    EXPECT_LT((rotated.shape.first - law.shape(F, kFirst).first).norm(), 1e-14 * kYoung);
    EXPECT_LT((rotated.dilatation.first - law.dilatation(F, kFirst).first).norm(), 1e-14);
    return density(rotated, law.volumetric(rotated.dilatation.value), kSecond).second;
  };
  std::vector<SampleDeformation> all = within(law);
  all.push_back({"crushed", kTurn * Vec3(0.2, 1.0, 1.0).asDiagonal(), 1.0});
  all.push_back({"point", Mat3::Zero(), 1.0});
  for (const SampleDeformation& d : all) {
    const Mat9 K = tangent(d.F);
    EXPECT_GT(Eigen::SelfAdjointEigenSolver<Mat9>(K).eigenvalues()[0], -1e-14 * K.norm()) << d.name;
    // R K R^T of linear elasticity
    Mat9 turned = Mat9::Zero();
    const Mat3 R = polar_rotation(d.F);
    for (int i = 0; i < 3; ++i) turned.block<3, 3>(3 * i, 3 * i) = R;
    EXPECT_LT((K - turned * hooke(law.moduli) * turned.transpose()).norm(), 1e-14 * K.norm()) << d.name;
  }
  const Mat9 exact = density(law, kTurn, kSecond).second;
  EXPECT_LT((tangent(kTurn) - exact).norm(), 1e-14 * exact.norm());
  const Mat3 crushed = Vec3(0.2, 1.0, 1.0).asDiagonal();
  EXPECT_LT(Eigen::SelfAdjointEigenSolver<Mat9>(density(law, crushed, kSecond).second).eigenvalues()[0],
            -0.01 * kYoung);
}

TEST(Corotational, is_frozen_where_the_rotation_is_undetermined) {
  const Corotational law = corotational(kYoung, kPoisson);
  const Mat3 F = kTurn * Vec3(1.0, -0.5, 0.5).asDiagonal() * kOther;
  const Mat9 frozen = law.definite(F, kSecond).shape.second;
  EXPECT_LT((law.shape(F, kSecond).second - frozen).norm(), 1e-14 * frozen.norm());
  EXPECT_EQ(law.dilatation(F, kSecond).second.norm(), 0.0);
  EXPECT_GT(frozen.norm(), kYoung);
}

TEST(VonMises, of_uniaxial_stress_is_that_stress) {
  EXPECT_NEAR(von_mises(Vec3(3.0, 0.0, 0.0).asDiagonal()), 3.0, 1e-15);
  EXPECT_NEAR(von_mises(Mat3(5.0 * Mat3::Identity())), 0.0, 1e-15);
}

}  // namespace
}  // namespace sinew::solid
