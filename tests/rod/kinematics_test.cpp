#include "sinew/rod/kinematics.hpp"

#include <gtest/gtest.h>

#include <numbers>
#include <random>

#include "support/difference.hpp"

namespace sinew::rod {
namespace {

using test::difference;

/// Every strain basis that matters: each strain alone, the paper's three, all six, and some pairs.
const std::vector<std::vector<int>> kBases = {{0}, {1},       {2},    {3},    {4},
                                              {5}, {0, 1, 2}, {1, 3}, {2, 5}, {0, 1, 2, 3, 4, 5}};
/// Strain sizes: straight, the two scales at which closed forms break, and order one (relative to 1 / section length).
const double kSizes[] = {0.0, 1e-8, 1e-5, 1.0};

Rod make_rod(const std::vector<int>& basis, double size,
             std::vector<BaseAxis> base = {BaseAxis::translation, BaseAxis::rotation}) {
  Rod rod;
  rod.ends = {0.0, 0.3, 0.5, 1.1};
  rod.basis = basis;
  rod.base = std::move(base);
  std::mt19937 random(7);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  rod.fixed.setZero(6, 3);
  for (int i = 0; i < 3; ++i) {
    for (int c = 0; c < 6; ++c) {
      if (std::find(basis.begin(), basis.end(), c) == basis.end()) rod.fixed(c, i) = 0.3 * size * uniform(random);
    }
  }
  return rod;
}

Eigen::VectorXd make_coordinates(const Rod& rod, double size) {
  std::mt19937 random(11);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  Eigen::VectorXd q(rod.coordinates());
  for (int i = 0; i < q.size(); ++i) q[i] = (i < rod.base_coordinates() ? 0.2 : size) * uniform(random);
  for (int i = 0; i < rod.sections(); ++i) {
    for (int c = 0; c < rod.strains(); ++c) {
      if (rod.basis[c] >= 3) q[rod.first_coordinate(i) + c] *= 0.3;
    }
  }
  return q;
}

const Placement kBase{lie::exp(Vec3(0.4, -0.2, 0.9)), Vec3(0.5, -1.0, 2.0)};
const Vec3 kOffset(0.0, 0.03, -0.02);
const double kAbscissae[] = {-0.05, 0.0, 0.1, 0.3, 0.42, 0.8, 1.1, 1.15};

class EveryBasis : public testing::TestWithParam<std::tuple<std::size_t, double>> {
 protected:
  Rod rod = make_rod(kBases[std::get<0>(GetParam())], std::get<1>(GetParam()));
  Eigen::VectorXd q = make_coordinates(rod, std::get<1>(GetParam()));
  Configuration at(const Eigen::VectorXd& x) const { return configure(rod, kBase, x); }
};

TEST_P(EveryBasis, position_jacobian_matches_finite_differences) {
  for (double s : kAbscissae) {
    const Eigen::MatrixXd J = position_jacobian(at(q), s, kOffset);
    const Eigen::MatrixXd D =
        difference([&](const Eigen::VectorXd& x) -> Eigen::VectorXd { return position(at(x), s, kOffset); }, q, 1e-6);
    EXPECT_GT(J.norm(), 0.1) << "nothing is compared";
    EXPECT_LT((J - D).norm(), 2e-9) << s;
  }
}

TEST_P(EveryBasis, derivatives_along_the_curve_match_finite_differences) {
  const Configuration shape = at(q);
  for (double s : {0.1, 0.42, 0.8}) {
    const CurvePoint point = curve_point(shape, s);
    const double e = 1e-6;
    const CurvePoint plus = curve_point(shape, s + e), minus = curve_point(shape, s - e);
    EXPECT_GT(point.derivative.norm(), 0.1);
    EXPECT_LT((point.derivative - (plus.position - minus.position) / (2 * e)).norm(), 1e-9);
    EXPECT_LT((point.second - (plus.derivative - minus.derivative) / (2 * e)).norm(), 1e-9);
  }
}

TEST_P(EveryBasis, tangent_gradient_matches_finite_differences) {
  const Vec3 f(0.7, -0.4, 0.5);
  double largest = 0.0;
  for (double s : kAbscissae) {
    const Eigen::VectorXd g = tangent_gradient(at(q), s, f);
    const Eigen::MatrixXd D = difference(
        [&](const Eigen::VectorXd& x) { return Eigen::VectorXd::Constant(1, f.dot(curve_point(at(x), s).derivative)); },
        q, 1e-6);
    largest = std::max(largest, g.norm());
    EXPECT_LT((g - D.transpose()).norm(), 2e-9) << s;
  }
  const bool twist_of_a_straight_rod = rod.basis == std::vector<int>{0} && std::get<1>(GetParam()) < 1e-4;
  EXPECT_TRUE(largest > 0.01 || twist_of_a_straight_rod);  // which turns no tangent
}

TEST_P(EveryBasis, loads_give_the_work_and_its_exact_second_derivative) {
  std::vector<PointLoad> loads;
  for (double s : kAbscissae) loads.push_back({s, kOffset, Vec3(1.0 + s, -0.5, 0.3 * s), 0.0});
  loads.push_back({1.15, Vec3::Zero(), Vec3(0.1, 0.2, -0.7), 0.0});
  const int n = rod.coordinates();
  const auto gradient = [&](const Eigen::VectorXd& x) {
    Eigen::VectorXd g = Eigen::VectorXd::Zero(n);
    Eigen::MatrixXd unused = Eigen::MatrixXd::Zero(n, n);
    add_loads(at(x), loads, g, unused);
    return g;
  };
  Eigen::VectorXd g = Eigen::VectorXd::Zero(n), by_jacobians = Eigen::VectorXd::Zero(n);
  Eigen::MatrixXd H = Eigen::MatrixXd::Zero(n, n);
  add_loads(at(q), loads, g, H);
  for (const PointLoad& load : loads)
    by_jacobians += position_jacobian(at(q), load.s, load.offset).transpose() * load.force;
  EXPECT_GT(g.norm(), 0.1);
  EXPECT_LT((g - by_jacobians).norm(), 1e-13 * (1 + g.norm()));
  EXPECT_LT((H - H.transpose()).norm(), 1e-13 * (1 + H.norm()));
  EXPECT_LT((H - difference(gradient, q, 1e-6)).norm(), 2e-8);
}

TEST_P(EveryBasis, weights_give_the_mass_matrix) {
  std::vector<PointLoad> loads;
  for (double s : kAbscissae) loads.push_back({s, kOffset, Vec3::Zero(), 1.0 + s * s});
  const int n = rod.coordinates();
  Eigen::VectorXd g = Eigen::VectorXd::Zero(n);
  Eigen::MatrixXd M = Eigen::MatrixXd::Zero(n, n), expected = Eigen::MatrixXd::Zero(n, n);
  add_loads(at(q), loads, g, M);
  for (const PointLoad& load : loads) {
    const Eigen::MatrixXd J = position_jacobian(at(q), load.s, load.offset);
    expected += load.weight * J.transpose() * J;
  }
  EXPECT_GT(expected.norm(), 0.1);
  EXPECT_LT((M - expected).norm(), 1e-13 * expected.norm());
}

INSTANTIATE_TEST_SUITE_P(Rod, EveryBasis,
                         testing::Combine(testing::Range<std::size_t>(0, kBases.size()), testing::ValuesIn(kSizes)));

TEST(Kinematics, constant_bending_is_a_circle_whatever_the_sections) {
  for (int sections : {1, 2, 7}) {
    Rod rod;
    for (int i = 0; i <= sections; ++i) rod.ends.push_back(2.0 * std::numbers::pi * i / sections);
    rod.basis = {2};
    rod.fixed.setZero(6, sections);
    const Configuration shape =
        configure(rod, Placement{}, Eigen::VectorXd::Constant(sections, 0.5));  // radius 2, half a circle
    EXPECT_LT((shape.p.back() - Vec3(0.0, 4.0, 0.0)).norm(), 1e-14 * sections) << sections;
    EXPECT_LT((curve_point(shape, std::numbers::pi).position - Vec3(2.0, 2.0, 0.0)).norm(), 1e-14 * sections);
  }
}

TEST(Kinematics, base_slides_out_along_minus_x_and_turns_about_plus_x) {
  const Rod rod = make_rod({2}, 0.0);
  Eigen::VectorXd q = Eigen::VectorXd::Zero(rod.coordinates());
  q[0] = 0.1;
  q[1] = 0.5 * std::numbers::pi;
  const Configuration shape = configure(rod, Placement{}, q);
  EXPECT_LT((shape.p[0] - Vec3(-0.1, 0.0, 0.0)).norm(), 1e-15);
  EXPECT_LT((shape.R[0] * Vec3::UnitY() - Vec3::UnitZ()).norm(), 1e-15);
}

}  // namespace
}  // namespace sinew::rod
