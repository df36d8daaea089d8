#include "sinew/rod/section.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <complex>
#include <numbers>
#include <vector>

namespace sinew::rod {
namespace {

using std::numbers::pi;
using Complex = std::complex<double>;

const Shape kCircle = Circle{0.7}, kTube = Tube{1.0, 0.6}, kEllipse = Ellipse{1.3, 0.6},
            kRectangle = Rectangle{1.5, 0.8};
const Shape kShapes[] = {kCircle, kTube, kEllipse, kRectangle};

// ---- The section as points, from its definition alone: y + iz, with a weight inside it and a normal on its rim.

struct Inside {
  Complex at;
  double weight;
};

struct Rim {
  Complex at, normal;
};

/// (rim of the hole as a fraction, half axes) of a round section.
Eigen::Vector3d round_of(const Shape& shape) {
  if (const auto* circle = std::get_if<Circle>(&shape)) return {0.0, circle->radius, circle->radius};
  if (const auto* tube = std::get_if<Tube>(&shape)) return {tube->inner / tube->outer, tube->outer, tube->outer};
  const Ellipse ellipse = std::get<Ellipse>(shape);
  return {0.0, ellipse.y, ellipse.z};
}

/// Four Gauss points on each of n pieces of [a, b]: (position, weight).
std::vector<std::pair<double, double>> gauss(double a, double b, int n) {
  const double points[] = {0.3399810435848563, 0.8611363115940526},
               weights[] = {0.6521451548625461, 0.3478548451374538};
  std::vector<std::pair<double, double>> rule;
  const double half = 0.5 * (b - a) / n;
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < 4; ++j) {
      rule.emplace_back(a + half * (2 * i + 1 + (j < 2 ? 1 : -1) * points[j % 2]), half * weights[j % 2]);
    }
  }
  return rule;
}

std::vector<Inside> inside(const Shape& shape) {
  std::vector<Inside> points;
  if (const auto* box = std::get_if<Rectangle>(&shape)) {
    for (auto [y, a] : gauss(-box->y / 2, box->y / 2, 12)) {
      for (auto [z, b] : gauss(-box->z / 2, box->z / 2, 12)) points.push_back({{y, z}, a * b});
    }
    return points;
  }
  const Eigen::Vector3d round = round_of(shape);
  for (auto [r, weight] : gauss(round[0], 1.0, 4)) {
    for (int i = 0; i < 64; ++i) {
      const Complex unit = std::polar(r, 2 * pi * i / 64);
      points.push_back(
          {{round[1] * unit.real(), round[2] * unit.imag()}, round[1] * round[2] * r * weight * 2 * pi / 64});
    }
  }
  return points;
}

std::vector<Rim> rim(const Shape& shape) {
  std::vector<Rim> points;
  if (const auto* box = std::get_if<Rectangle>(&shape)) {
    for (auto [t, weight] : gauss(-0.5, 0.5, 200)) {
      for (double side : {-0.5, 0.5}) {
        points.push_back({{box->y * side, box->z * t}, {2 * side, 0.0}});
        points.push_back({{box->y * t, box->z * side}, {0.0, 2 * side}});
      }
    }
    return points;
  }
  const Eigen::Vector3d round = round_of(shape);
  for (int i = 0; i < 400; ++i) {
    const Complex unit = std::polar(1.0, 2 * pi * i / 400);
    const Complex normal(unit.real() / round[1], unit.imag() / round[2]);
    const Complex at(round[1] * unit.real(), round[2] * unit.imag());
    points.push_back({at, normal / std::abs(normal)});
    if (round[0] > 0) points.push_back({round[0] * at, -normal / std::abs(normal)});
  }
  return points;
}

template <class F>
double integral(const Shape& shape, F&& f) {
  double sum = 0;
  for (const Inside& point : inside(shape)) sum += point.weight * f(point.at.real(), point.at.imag());
  return sum;
}

TEST(Section, area_and_second_moments_are_the_integrals) {
  for (const Shape& shape : kShapes) {
    const SectionProperties p = properties(shape, 0.3);
    EXPECT_NEAR(p.area, integral(shape, [](double, double) { return 1.0; }), 1e-13);
    EXPECT_NEAR(p.second_y, integral(shape, [](double, double z) { return z * z; }), 1e-13);
    EXPECT_NEAR(p.second_z, integral(shape, [](double y, double) { return y * y; }), 1e-13);
  }
}

// ---- Torsion

TEST(Section, round_sections_twist_with_the_polar_moment) {
  for (const Shape& shape : {kCircle, kTube, Shape(Ellipse{0.7, 0.7})}) {
    const SectionProperties p = properties(shape, 0.3);
    EXPECT_NEAR(p.torsion, p.second_y + p.second_z, 1e-14);
  }
}

TEST(Section, ellipse_torsion_is_the_integral_of_prandtls_function) {
  const double y = 1.3, z = 0.6, scale = y * y * z * z / (y * y + z * z);  // laplacian of the bracket: -2 / scale
  const double J =
      2 * scale * integral(kEllipse, [&](double a, double b) { return 1 - a * a / (y * y) - b * b / (z * z); });
  EXPECT_NEAR(properties(kEllipse, 0.3).torsion, J, 1e-13);
  Vec6 internal = Vec6::Zero();
  internal[0] = -J;
  double steepest = 0;
  for (const Rim& point : rim(kEllipse)) {
    steepest = std::max(steepest, 2 * scale * std::hypot(point.at.real() / (y * y), point.at.imag() / (z * z)));
  }
  EXPECT_NEAR(section_stress(kEllipse, internal).torsion, steepest, 1e-13);
  EXPECT_NEAR(steepest, 2 * J / (pi * y * z * z), 1e-13);
}

/// Saint-Venant: laplacian of psi = -2, psi = 0 on the rim, J = 2 int psi, shear per G and twist |grad psi|. Five-point
/// stencil, solved through the eigenvectors of its one-dimensional part.
std::pair<double, double> torsion_by_differences(const Rectangle& box, int n) {
  const Eigen::MatrixXd ones = Eigen::MatrixXd::Constant(n - 1, n - 1, 2.0);
  Eigen::MatrixXd second = 2.0 * Eigen::MatrixXd::Identity(n - 1, n - 1);
  second.diagonal(1).setConstant(-1.0);
  second.diagonal(-1).setConstant(-1.0);
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> modes(second);
  const Eigen::MatrixXd& V = modes.eigenvectors();
  const double hy = box.y / n, hz = box.z / n;
  Eigen::MatrixXd psi = V.transpose() * ones * V;
  for (int i = 0; i < n - 1; ++i) {
    for (int j = 0; j < n - 1; ++j) {
      psi(i, j) /= modes.eigenvalues()[i] / (hy * hy) + modes.eigenvalues()[j] / (hz * hz);
    }
  }
  psi = (V * psi * V.transpose()).eval();
  const int middle = n / 2 - 1;  // one-sided slope there, of second order
  const double slope_y = (4 * psi(0, middle) - psi(1, middle)) / (2 * hy);
  const double slope_z = (4 * psi(middle, 0) - psi(middle, 1)) / (2 * hz);
  return {2 * psi.sum() * hy * hz, std::max(slope_y, slope_z)};
}

TEST(Section, rectangle_torsion_agrees_with_differences) {
  for (const Rectangle& box : {Rectangle{1, 1}, Rectangle{1.5, 0.8}, Rectangle{0.4, 1.6}}) {
    const auto [coarse, steep] = torsion_by_differences(box, 60);
    const auto [fine, steeper] = torsion_by_differences(box, 120);
    const double J = (4 * fine - coarse) / 3, shear = (4 * steeper - steep) / 3;  // the error is of second order
    EXPECT_NEAR(properties(box, 0.3).torsion / J, 1.0, 1e-5);
    Vec6 internal = Vec6::Zero();
    internal[0] = J;
    EXPECT_NEAR(section_stress(box, internal).torsion / shear, 1.0, 1e-4);
  }
}

TEST(Section, rectangle_torsion_is_the_published_one) {
  // Timoshenko and Goodier, Theory of Elasticity, 3rd ed., table in section 109: J = k1 a b^3, T = tau k2 a b^2.
  const double table[][3] = {{1, 0.1406, 0.208}, {1.2, 0.166, 0.219}, {1.5, 0.196, 0.231}, {2, 0.229, 0.246},
                             {3, 0.263, 0.267},  {5, 0.291, 0.291},   {10, 0.312, 0.312}};
  Vec6 internal = Vec6::Zero();
  internal[0] = 1.0;
  for (const auto& [ratio, k1, k2] : table) {
    for (const Rectangle& box : {Rectangle{ratio, 1}, Rectangle{1, ratio}}) {
      EXPECT_NEAR(properties(box, 0.3).torsion / ratio, k1, 6e-4);
      EXPECT_NEAR(1 / (ratio * section_stress(box, internal).torsion), k2, 6e-4);
    }
  }
  EXPECT_NEAR(properties(Rectangle{1, 1}, 0.3).torsion, 0.140577, 5e-7);
}

TEST(Section, rectangle_torsion_is_the_series_to_rounding) {
  for (double ratio : {1.0, 1.7, 30.0}) {
    double sum = 0;
    for (int n = 20001; n > 0; n -= 2) sum += std::tanh(n * pi * ratio / 2) / std::pow(n, 5);
    const double J = ratio / 3 * (1 - 192 / std::pow(pi, 5) / ratio * sum);
    EXPECT_NEAR(properties(Rectangle{1, ratio}, 0.3).torsion / J, 1.0, 2e-15);
  }
}

// ---- Shear factors

/// Cowper 1966 from his definition: k = 2 (1 + nu) I / [nu / 2 (I' - I) - A / I int y (chi + y z^2) dA], I = int y^2
/// dA, I' = int z^2 dA, shear along y, with chi harmonic and
///     d chi / dn = -n_y [nu y^2 / 2 + (1 - nu / 2) z^2] - n_z (2 + nu) y z
/// on the rim. chi is fitted there with real parts of odd powers of y + iz.
double cowper(const Shape& shape, double nu) {
  std::vector<int> powers = {1, 3};
  if (std::holds_alternative<Tube>(shape)) powers.insert(powers.end(), {-1, -3});
  if (std::holds_alternative<Rectangle>(shape)) {
    for (int k = 5; k < 20; k += 2) powers.push_back(k);
  }
  const auto count = static_cast<Eigen::Index>(powers.size());
  const std::vector<Rim> points = rim(shape);
  Eigen::MatrixXd slopes(static_cast<Eigen::Index>(points.size()), count);
  Eigen::VectorXd wanted(slopes.rows());
  for (Eigen::Index i = 0; i < slopes.rows(); ++i) {
    const auto [at, normal] = points[i];
    const double y = at.real(), z = at.imag();
    wanted[i] = -normal.real() * (nu / 2 * y * y + (1 - nu / 2) * z * z) - normal.imag() * (2 + nu) * y * z;
    for (Eigen::Index j = 0; j < count; ++j) {
      const int k = powers[j];
      slopes(i, j) = (double(k) * std::pow(at, k - 1) * normal).real();  // grad Re f = conj f'
    }
  }
  const Eigen::VectorXd c = slopes.colPivHouseholderQr().solve(wanted);
  const double A = integral(shape, [](double, double) { return 1.0; });
  const double I = integral(shape, [](double y, double) { return y * y; });
  const double across = integral(shape, [](double, double z) { return z * z; });
  const double warping = integral(shape, [&](double y, double z) {
    double chi = 0;
    for (Eigen::Index j = 0; j < count; ++j) chi += c[j] * std::pow(Complex(y, z), powers[j]).real();
    return y * (chi + y * z * z);
  });
  return 2 * (1 + nu) * I / (nu / 2 * (across - I) - A / I * warping);
}

TEST(Section, shear_factors_follow_cowpers_definition) {
  for (double nu : {-0.4, 0.0, 0.3, 0.5}) {
    for (const Shape& shape : {kCircle, kTube, kEllipse})
      EXPECT_NEAR(properties(shape, nu).shear_y, cowper(shape, nu), 1e-12);
    EXPECT_NEAR(properties(kEllipse, nu).shear_z, cowper(Ellipse{0.6, 1.3}, nu), 1e-12);
    EXPECT_NEAR(properties(kRectangle, nu).shear_y, cowper(kRectangle, nu), 1e-5);  // fit limited by its samples
    EXPECT_NEAR(properties(kRectangle, nu).shear_z, cowper(Rectangle{0.8, 1.5}, nu), 1e-5);
    const SectionProperties tube = properties(kTube, nu);
    EXPECT_EQ(tube.shear_y, tube.shear_z);
  }
}

TEST(Section, shear_factors_are_the_published_ones) {
  // Cowper, J. Appl. Mech. 33 (1966): closed forms at nu = 0.3.
  EXPECT_NEAR(properties(kCircle, 0.3).shear_y, 6 * 1.3 / 8.8, 1e-15);
  EXPECT_NEAR(properties(kRectangle, 0.3).shear_y, 13 / 15.3, 1e-15);
  EXPECT_NEAR(properties(Tube{1.0, 1.0 - 1e-9}, 0.3).shear_y, 2 * 1.3 / 4.9, 1e-12);  // thin wall
}

TEST(Section, limits_meet) {
  const SectionProperties circle = properties(kCircle, 0.3);
  for (const Shape& same : {Shape(Tube{0.7, 0.0}), Shape(Ellipse{0.7, 0.7})}) {
    const SectionProperties p = properties(same, 0.3);
    EXPECT_NEAR(p.area, circle.area, 1e-15);
    EXPECT_NEAR(p.torsion, circle.torsion, 1e-15);
    EXPECT_NEAR(p.second_y, circle.second_y, 1e-15);
    EXPECT_NEAR(p.second_z, circle.second_z, 1e-15);
    EXPECT_NEAR(p.shear_y, circle.shear_y, 1e-15);
    EXPECT_NEAR(p.shear_z, circle.shear_z, 1e-15);
  }
  const double wall = 1e-6;
  const SectionProperties thin = properties(Tube{1.0, 1.0 - wall}, 0.3);
  EXPECT_NEAR(thin.area / (2 * pi * wall), 1.0, 1e-6);
  EXPECT_NEAR(thin.torsion / (2 * pi * wall), 1.0, 2e-6);
  EXPECT_NEAR(properties(Rectangle{1, 1e-4}, 0.3).torsion / 1e-12, 1.0 / 3, 1e-4);  // thin strip
}

// ---- Stiffness, viscosity, inertia

TEST(Section, stiffness_viscosity_and_inertia_scale_the_properties) {
  for (const Shape& shape : kShapes) {
    const SectionProperties p = properties(shape, 0.4);
    Vec6 stiffness, viscosity;
    stiffness << 5 * p.torsion, 14 * p.second_y, 14 * p.second_z, 14 * p.area, 5 * p.shear_y * p.area,
        5 * p.shear_z * p.area;  // E = 14 and nu = 0.4 make G = 5
    viscosity << p.torsion, 3 * p.second_y, 3 * p.second_z, 3 * p.area, p.area, p.area;
    EXPECT_LT((section_stiffness(shape, 14, 0.4) - stiffness).norm(), 1e-14);
    EXPECT_LT((section_viscosity(shape, 2.5) - 2.5 * viscosity).norm(), 1e-14);
    const LineInertia inertia = line_inertia(shape, 1100);
    EXPECT_NEAR(inertia.mass, 1100 * p.area, 1e-12);
    EXPECT_NEAR(inertia.about_y, 1100 * p.second_y, 1e-12);
    EXPECT_NEAR(inertia.about_z, 1100 * p.second_z, 1e-12);
  }
}

TEST(Section, incompressible_viscosity_has_the_ratios_of_the_stiffness) {
  const Vec6 ratio = section_stiffness(kEllipse, 3.0, 0.5).cwiseQuotient(section_viscosity(kEllipse, 1.0));  // E = 3 G
  for (int i = 0; i < 4; ++i) EXPECT_NEAR(ratio[i], 1.0, 1e-14);
}

// ---- Stresses

Vec6 internal_forces() {
  Vec6 internal;
  internal << -0.3, 0.4, -0.7, -1.1, 0.0, 0.0;
  return internal;
}

/// Bending stress at a rim point from the strain's definition: elongation there is kappa_y z - kappa_z y.
double bending_at(const Shape& shape, const Vec6& internal, Complex at) {
  const SectionProperties p = properties(shape, 0.3);
  return internal[1] * at.imag() / p.second_y - internal[2] * at.real() / p.second_z;
}

TEST(Section, axial_and_bending_stress_are_the_largest_on_the_rim) {
  const Vec6 internal = internal_forces();
  for (const Shape& shape : kShapes) {
    std::vector<Rim> points = rim(shape);
    if (const auto* box = std::get_if<Rectangle>(&shape)) {
      for (double side : {-0.5, 0.5}) points.push_back({{box->y / 2, side * box->z}, 1.0});
    }
    double largest = 0;
    for (const Rim& point : points) largest = std::max(largest, std::abs(bending_at(shape, internal, point.at)));
    const SectionStress stress = section_stress(shape, internal);
    EXPECT_NEAR(stress.bending / largest, 1.0, 1e-4);  // the rim is sampled
    EXPECT_GE(stress.bending, largest - 1e-14);
    EXPECT_NEAR(stress.axial, -1.1 / properties(shape, 0.3).area, 1e-14);
  }
}

TEST(Section, round_von_mises_is_the_largest_on_the_rim) {
  const Vec6 internal = internal_forces();
  for (const Shape& shape : {kCircle, kTube}) {
    const SectionProperties p = properties(shape, 0.3);
    const double torsion = 0.3 * outer_radius(shape) / p.torsion;
    double largest = 0;
    for (const Rim& point : rim(shape)) {
      const double normal = -1.1 / p.area + bending_at(shape, internal, point.at);
      largest = std::max(largest, std::hypot(normal, std::sqrt(3.0) * torsion));
    }
    EXPECT_NEAR(section_stress(shape, internal).torsion, torsion, 1e-14);
    EXPECT_NEAR(section_stress(shape, internal).von_mises / largest, 1.0, 1e-4);
  }
}

TEST(Section, von_mises_joins_the_largest_stresses_and_the_mean_shear) {
  Vec6 internal = internal_forces();
  internal[4] = 3.0;
  internal[5] = -4.0;
  for (const Shape& shape : kShapes) {
    const SectionStress stress = section_stress(shape, internal);
    const double shear = stress.torsion + 5.0 / properties(shape, 0.3).area;
    EXPECT_NEAR(stress.von_mises, std::hypot(stress.bending - stress.axial, std::sqrt(3.0) * shear), 1e-12);
  }
}

// ---- Outline and taper

TEST(Section, outer_radius_reaches_the_rim) {
  EXPECT_EQ(outer_radius(kCircle), 0.7);
  EXPECT_EQ(outer_radius(kTube), 1.0);
  EXPECT_EQ(outer_radius(kEllipse), 1.3);
  EXPECT_EQ(outer_radius(Ellipse{0.6, 1.3}), 1.3);
  EXPECT_NEAR(outer_radius(kRectangle), 0.85, 1e-15);  // half of hypot(1.5, 0.8)
}

/// A shape's dimensions, in order of declaration.
std::vector<double> dimensions(const Shape& shape) {
  if (const auto* circle = std::get_if<Circle>(&shape)) return {circle->radius};
  if (const auto* tube = std::get_if<Tube>(&shape)) return {tube->outer, tube->inner};
  if (const auto* ellipse = std::get_if<Ellipse>(&shape)) return {ellipse->y, ellipse->z};
  const Rectangle box = std::get<Rectangle>(shape);
  return {box.y, box.z};
}

TEST(Section, blend_meets_both_ends_and_is_linear_between) {
  const Shape others[] = {Circle{0.1}, Tube{0.9, 0.1}, Ellipse{0.2, 2.0}, Rectangle{0.3, 1.0}};
  for (std::size_t i = 0; i < 4; ++i) {
    const std::vector<double> a = dimensions(kShapes[i]), b = dimensions(others[i]);
    EXPECT_EQ(blend(kShapes[i], others[i], 0.25).index(), i);
    EXPECT_EQ(dimensions(blend(kShapes[i], others[i], 0.0)), a);
    EXPECT_EQ(dimensions(blend(kShapes[i], others[i], 1.0)), b);
    const std::vector<double> quarter = dimensions(blend(kShapes[i], others[i], 0.25));
    for (std::size_t j = 0; j < a.size(); ++j) EXPECT_NEAR(quarter[j], 0.75 * a[j] + 0.25 * b[j], 1e-15);
  }
  EXPECT_THROW(blend(kCircle, kTube, 0.5), std::bad_variant_access);
}

}  // namespace
}  // namespace sinew::rod
