#include "sinew/rod/dynamics.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>

#include "rod/random_rods.hpp"
#include "support/difference.hpp"

namespace sinew::rod {
namespace {

class EveryMotion : public testing::TestWithParam<std::tuple<std::size_t, int, double>> {
 protected:
  double size = std::get<2>(GetParam());
  Rod rod = random_rod(kBases[std::get<0>(GetParam())], std::get<1>(GetParam()), size);
  Eigen::VectorXd q = make_coordinates(rod, size);
  Eigen::VectorXd velocity = Eigen::VectorXd::LinSpaced(rod.coordinates(), -0.7, 1.1);
  Configuration at(const Eigen::VectorXd& x) const { return configure(rod, kBase, x); }
  Eigen::MatrixXd mass(const Eigen::VectorXd& x) const { return dense_tangent(at(x), mass_matrix(at(x))); }
};

TEST_P(EveryMotion, mass_matrix_is_symmetric_positive_and_that_of_the_mass_points) {
  const Eigen::MatrixXd M = mass(q);
  Eigen::MatrixXd expected = Eigen::MatrixXd::Zero(M.rows(), M.cols());
  for (const MassPoint& point : rod.masses) {
    const Eigen::MatrixXd J = position_jacobian(at(q), point.s, point.offset);
    expected += point.mass * J.transpose() * J;
  }
  EXPECT_LT((M - expected).norm(), 1e-13 * expected.norm());
  EXPECT_LT((M - M.transpose()).norm(), 1e-14 * M.norm());
  EXPECT_EQ(M.ldlt().info(), Eigen::Success);
  EXPECT_GT(M.ldlt().vectorD().minCoeff(), 0.0);
}

TEST_P(EveryMotion, rate_of_the_mass_matrix_less_twice_coriolis_is_skew) {
  const double e = 1e-5;
  const Eigen::MatrixXd dM = (mass(q + e * velocity) - mass(q - e * velocity)) / (2 * e);
  const Eigen::MatrixXd C = coriolis_matrix(at(q), velocity);
  const Eigen::MatrixXd S = dM - 2.0 * C;
  EXPECT_LT((S + S.transpose()).norm(), 1e-8 * C.norm() + 1e-12);
  EXPECT_GT(dM.norm(), 1e-4 * mass(q).norm()) << "nothing moves";
}

TEST_P(EveryMotion, coriolis_forces_by_recursion_are_those_of_the_matrix) {
  const Eigen::VectorXd expected = coriolis_matrix(at(q), velocity) * velocity;
  EXPECT_GT(expected.norm(), 0.0);
  EXPECT_LT((coriolis_forces(at(q), velocity) - expected).norm(), 1e-12 * expected.norm());
}

TEST_P(EveryMotion, kinetic_energy_is_that_of_the_mass_matrix) {
  EXPECT_NEAR(kinetic_energy(at(q), velocity) / (0.5 * velocity.dot(mass(q) * velocity)), 1.0, 1e-12);
}

INSTANTIATE_TEST_SUITE_P(Rod, EveryMotion,
                         testing::Combine(testing::Range<std::size_t>(0, kBases.size()), testing::Values(0, 2),
                                          testing::ValuesIn(kSizes)));

}  // namespace
}  // namespace sinew::rod
