#include "sinew/solid/body.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <random>

#include "sinew/lie/rotation.hpp"
#include "sinew/solid/embedding.hpp"
#include "support/difference.hpp"

namespace sinew::solid {
namespace {

const Lame kMaterial = lame(500e3, 0.45);
const double kSizes[] = {0.0, 1e-8, 1e-5, 0.3};

Mat3 random_matrix(unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  return Mat3::NullaryExpr([&] { return uniform(random); });
}

/// Two tetrahedra that share a face, about 10 mm, one node clamped.
Body two_elements(double damping = 0.0) {
  Eigen::Matrix3Xd rest(3, 5);
  rest << 0, 10, 2, 1, 9, 0, 1, 9, 2, 8, 0, 0, 1, 8, 9;
  Body body =
      make_body(1e-3 * rest, {{0, 1, 2, 3}, {1, 2, 3, 4}}, kMaterial, 0.002, {true, false, false, false, false});
  body.damping_stiffness = damping;
  body.damping_mass = damping;
  return body;
}

/// The body turned, and deformed by strains of the given size.
Eigen::Matrix3Xd deformed(const Body& body, double size, const Vec3& turn = Vec3(0.9, -1.3, 0.4)) {
  const Eigen::Matrix3Xd bumps = Eigen::Matrix3Xd::NullaryExpr(3, body.nodes(), [](Eigen::Index i, Eigen::Index j) {
    return std::sin(1.7 * static_cast<double>((3 * j + i + 1) * (j + 2 * i + 1)));
  });
  return lie::exp(turn) * (body.rest + size * 5e-3 * bumps);
}

Eigen::VectorXd flat(const Eigen::Matrix3Xd& x) { return Eigen::Map<const Eigen::VectorXd>(x.data(), x.size()); }
Eigen::Matrix3Xd nodes(const Eigen::VectorXd& x) {
  return Eigen::Map<const Eigen::Matrix3Xd>(x.data(), 3, x.size() / 3);
}

TEST(Corotational, lame_constants_give_back_young_and_poisson) {
  EXPECT_NEAR(kMaterial.mu * (3 * kMaterial.lambda + 2 * kMaterial.mu) / (kMaterial.lambda + kMaterial.mu), 500e3,
              1e-6);
  EXPECT_NEAR(kMaterial.lambda / (2 * (kMaterial.lambda + kMaterial.mu)), 0.45, 1e-14);
}

TEST(Corotational, polar_rotation_is_the_nearest_proper_one) {
  const Mat3 R = lie::exp(Vec3(0.3, 2.0, -1.0));
  const Mat3 S = Mat3::Identity() + 0.2 * (random_matrix(1) + random_matrix(1).transpose());
  EXPECT_LT((polar_rotation(R * S) - R).norm(), 1e-14);
  EXPECT_NEAR(polar_rotation(-Mat3::Identity()).determinant(), 1.0, 1e-14);
  EXPECT_TRUE(polar_rotation(Mat3::Zero()).allFinite());
}

TEST(Corotational, stress_is_the_derivative_of_the_energy) {
  for (double size : kSizes) {
    const Mat3 F = lie::exp(Vec3(0.3, 2.0, -1.0)) * (Mat3::Identity() + size * random_matrix(3));
    const Mat3 P = stress(kMaterial, F, polar_rotation(F));
    const double e = 1e-6;
    for (int i = 0; i < 9; ++i) {
      Mat3 plus = F, minus = F;
      plus(i) += e;
      minus(i) -= e;
      const double difference = (energy_density(kMaterial, plus, polar_rotation(plus)) -
                                 energy_density(kMaterial, minus, polar_rotation(minus))) /
                                (2 * e);
      EXPECT_NEAR(P(i), difference, 1e-3) << size;
    }
    if (size > 1e-6) {
      EXPECT_GT(P.norm(), 1.0);
    }
  }
}

TEST(Corotational, uniaxial_stress_follows_hooke) {
  const double e = 1e-3;
  const Mat3 F = Vec3(1 + e, 1 - 0.45 * e, 1 - 0.45 * e).asDiagonal();
  const Mat3 sigma = corotated_stress(kMaterial, F, Mat3::Identity());
  EXPECT_NEAR(sigma(0, 0), 500e3 * e, 1e-9);
  EXPECT_NEAR(sigma(1, 1), 0.0, 1e-9);
  EXPECT_NEAR(von_mises(sigma), 500e3 * e, 1e-9);
}

TEST(Body, forces_are_the_derivative_of_the_energy_and_balance) {
  const Body body = two_elements();
  for (double size : kSizes) {
    const Eigen::Matrix3Xd x = deformed(body, size);
    const Eigen::Matrix3Xd f = elastic_force(body, x);
    const auto energy = [&](const Eigen::VectorXd& y) {
      return Eigen::VectorXd::Constant(1, elastic_energy(body, nodes(y)));
    };
    const Eigen::MatrixXd D = test::difference(energy, flat(x), 1e-8);
    EXPECT_LT((flat(f) - D.transpose()).norm(), 1e-6 * (1 + f.norm())) << size;
    if (size > 1e-6) {
      EXPECT_GT(f.norm(), 1e-5);
    }
    EXPECT_LT(f.rowwise().sum().norm(), 1e-12 * (1e-9 + f.norm()) + 1e-16);
    Vec3 moment = Vec3::Zero();
    for (int i = 0; i < body.nodes(); ++i) moment += Vec3(x.col(i)).cross(Vec3(f.col(i)));
    EXPECT_LT(moment.norm(), 1e-14 * (1 + f.norm()));
  }
}

TEST(Body, exact_tangent_matches_finite_differences_of_the_residual) {
  for (double damping : {0.0, 0.1}) {
    const Body body = two_elements(damping);
    for (double size : kSizes) {
      const Eigen::Matrix3Xd x0 = deformed(body, 0.5 * size, Vec3(0.8, -1.3, 0.4)), x = deformed(body, size);
      const StepStart start{x0, Eigen::Matrix3Xd::Constant(3, 5, 0.1), rotations(body, x0), 100.0};
      const int n = 3 * body.nodes();
      Eigen::MatrixXd A = Eigen::MatrixXd::Zero(n, n);
      const Eigen::VectorXd mass = mass_diagonal(body, start.rate);
      for (int i = 0; i < n; ++i) A(i, i) = mass[i / 3];
      assemble_tangent(body, start, x, Tangent::exact, [&](int e, int a, int b, const Mat3& block) {
        const int row = 3 * body.tetrahedra[e][a], column = 3 * body.tetrahedra[e][b];
        A.block<3, 3>(row, column) += block;
        if (row != column) A.block<3, 3>(column, row) += block.transpose();
      });
      const Eigen::MatrixXd D = test::difference(
          [&](const Eigen::VectorXd& y) { return flat(residual(body, start, nodes(y), Vec3(0, -9.81, 0))); }, flat(x),
          1e-9);
      const int free = 3 * body.free_nodes;
      EXPECT_GT(D.norm(), 1.0);
      EXPECT_LT((A - D).bottomRightCorner(free, free).norm(), 1e-5 * D.norm()) << size << " " << damping;
    }
  }
}

TEST(Body, rotated_tangent_equals_the_exact_one_at_rest_and_is_semi_definite) {
  const Body body = two_elements();
  const Mat3 F = lie::exp(Vec3(0.4, 0.1, 0.2));
  const Mat3 R = polar_rotation(F);
  for (int a = 0; a < 4; ++a) {
    const Mat3 exact =
        stiffness_block(kMaterial, exact_tangent(kMaterial, F, R), body.gradients[0].col(a), body.gradients[0].col(0));
    const Mat3 rotated =
        stiffness_block(kMaterial, rotated_tangent(kMaterial, R), body.gradients[0].col(a), body.gradients[0].col(0));
    EXPECT_LT((exact - rotated).norm(), 1e-9 * exact.norm());
  }
  const Mat3 crushed = Vec3(0.2, 1.0, 1.0).asDiagonal();
  Eigen::MatrixXd K(12, 12);
  for (int a = 0; a < 4; ++a) {
    for (int b = 0; b < 4; ++b) {
      K.block<3, 3>(3 * a, 3 * b) = stiffness_block(kMaterial, rotated_tangent(kMaterial, polar_rotation(crushed)),
                                                    body.gradients[0].col(a), body.gradients[0].col(b));
    }
  }
  EXPECT_GT(Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(K).eigenvalues().minCoeff(), -1e-6 * K.norm());
}

TEST(Body, exact_tangent_stays_finite_where_the_rotation_is_undetermined) {
  const Mat3 F = Vec3(1.0, -1.0, 0.5).asDiagonal();
  EXPECT_TRUE(stiffness_block(kMaterial, exact_tangent(kMaterial, F, polar_rotation(F)), Vec3(1, 2, 3), Vec3(3, 2, 1))
                  .allFinite());
}

TEST(Body, free_fall_is_the_backward_euler_recurrence) {
  // v1 = v0 + h g, x1 = x0 + h v1 makes the residual vanish: no elastic force in a translation.
  const Body body = two_elements();
  const double h = 0.01;
  const Vec3 g(0, -9.81, 0), v0(0.3, 0.2, 0.1);
  const StepStart start{body.rest, v0.replicate(1, 5), rotations(body, body.rest), 1.0 / h};
  const Eigen::Matrix3Xd x = body.rest.colwise() + h * (v0 + h * g);
  double scale = 0.0;
  EXPECT_LT(residual(body, start, x, g, &scale).norm(), 1e-12);
  EXPECT_NEAR(scale, 9.81 * body.masses.maxCoeff(), 1e-9);
}

TEST(Body, free_vibration_is_the_backward_euler_recurrence) {
  // In a small deformation the step solves (M (1 + a h) / h^2 + (1 + b / h) K) dx = M v0 / h - K u0.
  Body body = two_elements();
  body.damping_mass = 0.3;
  body.damping_stiffness = 0.02;
  const double h = 0.01, tiny = 1e-9;
  const int n = 3 * body.nodes();
  Eigen::MatrixXd K = Eigen::MatrixXd::Zero(n, n);
  for (int e = 0; e < body.elements(); ++e) {
    for (int a = 0; a < 4; ++a) {
      for (int b = 0; b < 4; ++b) {
        K.block<3, 3>(3 * body.tetrahedra[e][a], 3 * body.tetrahedra[e][b]) +=
            body.volumes[e] * stiffness_block(kMaterial, rotated_tangent(kMaterial, Mat3::Identity()),
                                              body.gradients[e].col(a), body.gradients[e].col(b));
      }
    }
  }
  Eigen::VectorXd M(n);
  for (int i = 0; i < n; ++i) M[i] = body.masses[i / 3];
  const Eigen::VectorXd u0 = tiny * Eigen::VectorXd::LinSpaced(n, -1, 2),
                        v0 = 30 * tiny * Eigen::VectorXd::LinSpaced(n, 1, -1);
  Eigen::MatrixXd A = K * (1 + body.damping_stiffness / h);
  A.diagonal() += M * (1 + body.damping_mass * h) / (h * h);
  const Eigen::VectorXd dx = A.ldlt().solve(M.cwiseProduct(v0) / h - K * u0);
  const Eigen::Matrix3Xd x0 = body.rest + nodes(u0);
  const StepStart start{x0, nodes(v0), rotations(body, x0), 1.0 / h};
  double scale = 0.0;
  const Eigen::Matrix3Xd r = residual(body, start, x0 + nodes(dx), Vec3::Zero(), &scale);
  EXPECT_GT(scale, 1e-9);
  EXPECT_LT(r.norm(), 1e-6 * scale);
}

TEST(Body, masses_add_up) { EXPECT_NEAR(two_elements().masses.sum(), 0.002, 1e-18); }

TEST(Embedding, weights_give_the_point_back_inside_and_outside) {
  const Body body = two_elements();
  for (const Vec3& x :
       {Vec3(3e-3, 2e-3, 2e-3), Vec3(7e-3, 5e-3, 6e-3), Vec3(20e-3, -3e-3, 1e-3), Vec3(body.rest.col(2))}) {
    const EmbeddedPoint point = embed(body.rest, body.tetrahedra, x);
    EXPECT_LT((position(point, body.tetrahedra, body.rest) - x).norm(), 1e-15);
    EXPECT_NEAR(point.weights.sum(), 1.0, 1e-12);
  }
}

TEST(Embedding, distance_is_zero_inside_and_that_of_the_nearest_element_outside) {
  Eigen::Matrix3Xd rest(3, 4);
  rest << 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1;
  const std::vector<Tetrahedron> one = {{0, 1, 2, 3}};
  EXPECT_EQ(embed(rest, one, Vec3(0.2, 0.2, 0.2)).distance, 0.0);
  EXPECT_NEAR(embed(rest, one, Vec3(0.2, 0.2, -0.5)).distance, 0.5, 1e-15);    // a face
  EXPECT_NEAR(embed(rest, one, Vec3(0.5, -3.0, -4.0)).distance, 5.0, 1e-14);   // an edge
  EXPECT_NEAR(embed(rest, one, Vec3(-2.0, -3.0, -6.0)).distance, 7.0, 1e-14);  // a corner
  EXPECT_NEAR(embed(rest, one, Vec3(1.0, 1.0, 1.0)).distance, 2.0 / std::sqrt(3.0), 1e-14);
}

}  // namespace
}  // namespace sinew::solid
