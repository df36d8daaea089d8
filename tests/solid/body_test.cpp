// Laws that a body of every kind of element and every law must meet.
#include "sinew/solid/body.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>

#include "sinew/lie/rotation.hpp"
#include "solid/sample_elements.hpp"
#include "support/difference.hpp"
#include "support/meshes.hpp"

namespace sinew::solid {
namespace {

Eigen::Matrix3Xd residual(const Body& body, const StepStart& start, const Eigen::Matrix3Xd& x, const Vec3& gravity,
                          double* scale = nullptr) {
  Deformation deformation;
  deform(body, start, x, deformation);
  Residual own;
  solid::residual(body, start, x, deformation, gravity, own);
  if (scale) *scale = own.scale;
  return own.sum;
}

struct LawUnderTest {
  std::string name;
  Law law;
};

const double kSizes[] = {0.0, 1e-8, 1e-5, 0.1};
const OgdenTerm kOgden[] = {{6.3e5, 1.3}, {1.2e3, 5.0}, {-1e4, -2.0}};
const LawUnderTest kLawsOfBodies[] = {{"corotational", corotational(500e3, 0.45)},
                                      {"saint_venant_kirchhoff", saint_venant_kirchhoff(500e3, 0.4)},
                                      {"neo_hookean", neo_hookean(500e3, 0.45)},
                                      {"mooney_rivlin", mooney_rivlin(1.2e5, 0.5e5, Poisson{0.45})},
                                      {"ogden", ogden(kOgden, Bulk{2e6})}};

/// A block of few elements whose inner nodes are out of place, a face of it held.
Body sample_body(Kind kind, const Law& law, double damping = 0.0, MassMatrix mass = MassMatrix::lumped) {
  Mesh mesh = test::block_mesh(2, 1, 1, Vec3(20e-3, 10e-3, 8e-3), kind);
  for (Eigen::Index i = 0; i < mesh.nodes.cols(); ++i) {
    for (int a = 0; a < 3; ++a) mesh.nodes(a, i) += 0.6e-3 * std::sin(2.3 * static_cast<double>((i + 1) * (2 * a + 1)));
  }
  Eigen::Array<bool, 3, Eigen::Dynamic> held(3, mesh.nodes.cols());
  for (Eigen::Index i = 0; i < mesh.nodes.cols(); ++i) held.col(i).setConstant(mesh.nodes(0, i) < 1e-3);
  const Lame moduli = lame(law);
  Body body = make_body(mesh.nodes, mesh.cells, {{law, 1100.0, {damping * moduli.mu, damping * moduli.lambda}}},
                        std::vector<int>(mesh.cells.size(), 0), held, mass);
  body.damping_mass = damping;
  return body;
}

Eigen::VectorXd flat(const Eigen::Matrix3Xd& x) { return x.reshaped(); }
Eigen::Matrix3Xd nodes(const Eigen::VectorXd& x) { return x.reshaped(3, x.size() / 3); }

/// Turned, and bumpy by strains of about the given size.
Eigen::Matrix3Xd deformed(const Body& body, double size, const Vec3& turn = Vec3(0.9, -1.3, 0.4)) {
  const Eigen::Matrix3Xd bumps = Eigen::Matrix3Xd::NullaryExpr(3, body.nodes(), [](Eigen::Index i, Eigen::Index j) {
    return std::sin(1.7 * static_cast<double>((3 * j + i + 1) * (j + 2 * i + 1)));
  });
  return lie::exp(turn) * (body.rest + size * 5e-3 * bumps);
}

/// The tangent without the mass, over the coordinates of all nodes, held or not.
Eigen::MatrixXd dense_tangent(const Body& body, const StepStart& start, const Eigen::Matrix3Xd& x, Tangent kind) {
  Eigen::MatrixXd K = Eigen::MatrixXd::Zero(3 * body.nodes(), 3 * body.nodes());
  Deformation deformation;
  deform(body, start, x, deformation);
  assemble_tangent(
      body, start, x, deformation, kind,
      [&](int cell, const ElementMatrix& own) {
        const std::span<const int> at = body.cells[static_cast<std::size_t>(cell)].nodes();
        for (std::size_t a = 0; a < at.size(); ++a) {
          for (std::size_t b = 0; b < at.size(); ++b)
            K.block<3, 3>(3 * at[a], 3 * at[b]) +=
                own.block<3, 3>(static_cast<Eigen::Index>(3 * a), static_cast<Eigen::Index>(3 * b));
        }
      },
      [&](const TetBatch& batch, const TetStiffness& own, unsigned left_out) {
        for (int i = 0; i < batch.count; ++i) {
          if (left_out >> i & 1U) continue;
          for (int a = 0; a < 4; ++a) {
            for (int b = 0; b <= a; ++b) {
              Mat3 block;
              for (int e = 0; e < 9; ++e) block(e) = own.block[a * (a + 1) / 2 + b][e][i];
              K.block<3, 3>(3 * batch.node[a][i], 3 * batch.node[b][i]) += block;
              if (a != b) K.block<3, 3>(3 * batch.node[b][i], 3 * batch.node[a][i]) += block.transpose();
            }
          }
        }
      });
  return K;
}

StepStart still(const Body& body) { return {body.rest, body.rest}; }  // (without a rate neither counts)

double smallest_eigenvalue(const Eigen::MatrixXd& K) {
  return Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(K).eigenvalues().minCoeff();
}

class EveryBody : public testing::TestWithParam<std::tuple<Kind, int>> {
 protected:
  Kind kind = std::get<0>(GetParam());
  const Law& law = kLawsOfBodies[std::get<1>(GetParam())].law;
  Body body = sample_body(kind, law);
  double stiffness = 2 * lame(law).mu + std::abs(lame(law).lambda);
};
std::string name_of(const testing::TestParamInfo<std::tuple<Kind, int>>& info) {
  const Kind kind = std::get<0>(info.param);
  const char* const of = kind == Kind::tet4 ? "tet4_" : kind == Kind::tet10 ? "tet10_" : "hex8_";
  return of + kLawsOfBodies[std::get<1>(info.param)].name;
}
INSTANTIATE_TEST_SUITE_P(Solid, EveryBody,
                         testing::Combine(testing::ValuesIn(kKinds),
                                          testing::Range(0, static_cast<int>(std::size(kLawsOfBodies)))),
                         name_of);

TEST_P(EveryBody, forces_are_the_derivative_of_the_energy_and_balance) {
  for (const double size : kSizes) {
    const Eigen::Matrix3Xd x = deformed(body, size);
    const Eigen::Matrix3Xd f = elastic_force(body, x);
    const auto energy = [&](const Eigen::VectorXd& y) {
      return Eigen::VectorXd::Constant(1, elastic_energy(body, nodes(y)));
    };
    const Eigen::MatrixXd D = test::difference(energy, flat(x), 1e-7);
    const double whole = stiffness * 1e-4;  // modulus times an area
    EXPECT_LT((flat(f) - D.transpose()).norm(), 1e-7 * whole) << size;
    if (size > 1e-6) {
      EXPECT_GT(f.norm(), 0.1 * size * whole);
    }
    EXPECT_LT(f.rowwise().sum().norm(), 1e-13 * whole);
    Vec3 moment = Vec3::Zero();
    for (int i = 0; i < body.nodes(); ++i) moment += Vec3(x.col(i)).cross(Vec3(f.col(i)));
    EXPECT_LT(moment.norm(), 1e-15 * whole);
  }
}

TEST_P(EveryBody, rigid_motion_costs_nothing_and_turns_forces) {
  const Mat3 Q = lie::exp(Vec3(-2.0, 1.0, 0.7));
  const Vec3 away(0.3, -0.2, 0.5);
  const Eigen::Matrix3Xd moved = (Q * body.rest).colwise() + away;
  EXPECT_LT(elastic_energy(body, moved), 1e-13 * stiffness * 1e-6);
  EXPECT_LT(elastic_force(body, moved).norm(), 1e-12 * stiffness * 1e-4);
  const Eigen::Matrix3Xd x = deformed(body, 0.1);
  const Eigen::Matrix3Xd turned = (Q * x).colwise() + away;
  EXPECT_NEAR(elastic_energy(body, turned), elastic_energy(body, x), 1e-11 * elastic_energy(body, x));
  EXPECT_LT((elastic_force(body, turned) - Q * elastic_force(body, x)).norm(), 1e-10 * elastic_force(body, x).norm());
}

TEST_P(EveryBody, exact_tangent_matches_finite_differences_of_the_residual) {
  for (const double damping : {0.0, 0.1}) {
    for (const MassMatrix mass : {MassMatrix::lumped, MassMatrix::consistent}) {
      const Body own = sample_body(kind, law, damping, mass);
      for (const double size : kSizes) {
        const Eigen::Matrix3Xd x0 = deformed(own, 0.5 * size, Vec3(0.8, -1.3, 0.4)), x = deformed(own, size);
        const Eigen::Matrix3Xd v0 = Eigen::Matrix3Xd::Constant(3, own.nodes(), 0.1);
        const StepStart start{x0, v0, 100.0};
        Eigen::MatrixXd A = dense_tangent(own, start, x, Tangent::exact);
        for (int a = 0; a < own.nodes(); ++a) {
          for (int b = 0; b < own.nodes(); ++b)
            A.block<3, 3>(3 * a, 3 * b).diagonal().array() += mass_factor(own, start.rate) * own.mass.coeff(a, b);
        }
        const Eigen::MatrixXd D = test::difference(
            [&](const Eigen::VectorXd& y) { return flat(residual(own, start, nodes(y), Vec3(0, -9.81, 0))); }, flat(x),
            2e-8);
        EXPECT_GT(D.norm(), 1.0);
        EXPECT_LT((A - D).norm(), 1e-6 * D.norm()) << size << " " << damping;
        EXPECT_LT((A - A.transpose()).norm(), 1e-12 * A.norm());
      }
    }
  }
}

TEST_P(EveryBody, definite_tangent_is_semi_definite_and_exact_at_rest) {
  const Eigen::Matrix3Xd turned = deformed(body, 0.0);
  const Eigen::MatrixXd exact = dense_tangent(body, still(body), turned, Tangent::exact);
  EXPECT_LT((exact - dense_tangent(body, still(body), turned, Tangent::definite)).norm(), 1e-9 * exact.norm());
  Eigen::Matrix3Xd crushed = body.rest;
  crushed.row(1) *= 0.6;
  const Eigen::MatrixXd K = dense_tangent(body, still(body), crushed, Tangent::definite);
  EXPECT_GT(smallest_eigenvalue(K), -1e-12 * K.norm());
}

TEST_P(EveryBody, definite_tangent_lacks_only_what_is_negative) {
  Eigen::Matrix3Xd crushed = deformed(body, 0.1);
  crushed.row(1) *= 0.6;
  const Eigen::MatrixXd definite = dense_tangent(body, still(body), crushed, Tangent::definite),
                        lacking = definite - dense_tangent(body, still(body), crushed, Tangent::exact);
  EXPECT_GT(smallest_eigenvalue(definite), -1e-12 * definite.norm());
  if (std::holds_alternative<Corotational>(law)) return;  // its own is stiffer here and softer there: R K R^T
  EXPECT_GT(smallest_eigenvalue(lacking), -1e-12 * definite.norm());
  EXPECT_GT(lacking.norm(), 1e-3 * definite.norm());
}

TEST_P(EveryBody, only_rigid_motions_cost_nothing) {
  Mesh one = test::block_mesh(1, 1, 1, Vec3(10e-3, 10e-3, 10e-3), kind);
  one.cells.resize(1);
  const Eigen::Array<bool, 3, Eigen::Dynamic> free =
      Eigen::Array<bool, 3, Eigen::Dynamic>::Constant(3, one.nodes.cols(), false);
  const Body element = make_body(one.nodes, one.cells, {{law, 1100.0, {}}}, {0}, free);
  const Eigen::MatrixXd K = dense_tangent(element, still(element), element.rest, Tangent::exact);
  const Eigen::VectorXd eigenvalues = Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(K).eigenvalues();
  const auto without = 3 * (one.nodes.cols() - node_count(kind));  // coordinates of nodes that are in no element
  EXPECT_LT(eigenvalues.head(without + 6).cwiseAbs().maxCoeff(), 1e-12 * K.norm());
  EXPECT_GT(eigenvalues[without + 6], 1e-4 * K.norm());
}

TEST_P(EveryBody, damping_leaves_rigid_motion_alone_and_resists_stretching) {
  const Body damped = sample_body(kind, law, 0.1);
  const Eigen::Matrix3Xd x0 = deformed(damped, 0.05), none = Eigen::Matrix3Xd::Zero(3, damped.nodes());
  const StepStart start{x0, none, 100.0};
  const auto damping = [&](const Eigen::Matrix3Xd& x) -> Eigen::Matrix3Xd {
    const Eigen::Matrix3Xd v = (x - x0) * start.rate;
    return residual(damped, start, x, Vec3::Zero()) - elastic_force(damped, x) -
           (v * start.rate + damped.damping_mass * v) * damped.mass;
  };
  const Mat3 Q = lie::exp(Vec3(0.2, -0.4, 0.3));  // by half a radian in one step
  const Eigen::Matrix3Xd turned = (Q * x0).colwise() + Vec3(0.1, 0.0, -0.2);
  const Eigen::Matrix3Xd stretched = 1.05 * x0;
  EXPECT_LT(damping(turned).norm(), 1e-9 * damping(stretched).norm());
  EXPECT_GT(damping(stretched).cwiseProduct(stretched - x0).sum(), 0.0);
  // Internal forces: no resultant, and no moment about any point.
  const Eigen::Matrix3Xd f = damping(Q * stretched);
  EXPECT_LT(f.rowwise().sum().norm(), 1e-10 * f.norm());
  Vec3 moment = Vec3::Zero();
  for (int i = 0; i < damped.nodes(); ++i) moment += Vec3((Q * stretched).col(i)).cross(Vec3(f.col(i)));
  EXPECT_LT(moment.norm(), 1e-12 * f.norm());
}

TEST(Body, definite_tangent_of_an_auxetic_law_is_semi_definite) {
  for (const Kind kind : kKinds) {
    const Body body = sample_body(kind, saint_venant_kirchhoff(500e3, -0.3));
    Eigen::Matrix3Xd crushed = body.rest;
    crushed.array().colwise() *= Eigen::Array3d(0.55, 0.54, 0.58);
    const Eigen::MatrixXd exact = dense_tangent(body, still(body), crushed, Tangent::exact);
    EXPECT_LT(smallest_eigenvalue(exact), -1e-6 * exact.norm());
    const Eigen::MatrixXd K = dense_tangent(body, still(body), crushed, Tangent::definite);
    EXPECT_GT(smallest_eigenvalue(K), -1e-12 * K.norm());
  }
}

/// Patch test: under any homogeneous deformation inner nodes are in balance and stress is that of the law.
TEST_P(EveryBody, homogeneous_deformation_balances_inside) {
  Mesh mesh = test::block_mesh(3, 3, 3, Vec3(9e-3, 9e-3, 9e-3), kind);
  const Eigen::Matrix3Xd regular = mesh.nodes;
  const auto inner = [&](Eigen::Index i) {
    return regular.col(i).minCoeff() > 1e-6 && regular.col(i).maxCoeff() < 9e-3 - 1e-6;
  };
  for (Eigen::Index i = 0; i < mesh.nodes.cols();
       ++i) {  // corners out of place, edges straight: all in the middle of two
    if (!inner(i) || (kind == Kind::tet10 && i >= 64)) continue;
    for (int a = 0; a < 3; ++a) mesh.nodes(a, i) += 0.5e-3 * std::sin(2.3 * static_cast<double>((i + 1) * (2 * a + 1)));
  }
  if (kind == Kind::tet10) {
    static constexpr std::size_t kEdges[6][2] = {{0, 1}, {1, 2}, {2, 0}, {0, 3}, {1, 3}, {2, 3}};
    for (const Cell& cell : mesh.cells) {
      for (std::size_t e = 0; e < 6; ++e)
        mesh.nodes.col(cell.node[4 + e]) =
            0.5 * (mesh.nodes.col(cell.node[kEdges[e][0]]) + mesh.nodes.col(cell.node[kEdges[e][1]]));
    }
  }
  const Body patch = make_body(mesh.nodes, mesh.cells, {{law, 1100.0, {}}}, std::vector<int>(mesh.cells.size(), 0),
                               Eigen::Array<bool, 3, Eigen::Dynamic>::Constant(3, mesh.nodes.cols(), false));
  const Mat3 F = lie::exp(Vec3(0.4, 0.3, -0.8)) * Mat3{{1.2, 0.1, 0.0}, {-0.05, 0.9, 0.1}, {0.1, 0.0, 1.05}};
  const Eigen::Matrix3Xd x = F * patch.rest;
  const Eigen::Matrix3Xd f = elastic_force(patch, x);
  int inside = 0;
  for (Eigen::Index i = 0; i < f.cols(); ++i) {
    if (!inner(i)) continue;
    ++inside;
    EXPECT_LT(f.col(i).norm(), 1e-12 * f.norm());
  }
  EXPECT_GE(inside, 8);
  const Mat3 sigma = cauchy_stress(density(law, F, Derivatives::first).first, F);
  for (int cell = 0; cell < patch.elements(); ++cell) {
    const CellMeans means = cell_means(patch, cell, x);
    EXPECT_LT((means.stress - sigma).norm(), 1e-11 * stiffness);
    EXPECT_LT((means.strain - 0.5 * (F.transpose() * F - Mat3::Identity())).norm(), 1e-12);
    EXPECT_NEAR(means.volume_ratio, F.determinant(), 1e-12);
  }
}

TEST_P(EveryBody, mass_adds_up_and_free_fall_is_the_backward_euler_recurrence) {
  for (const MassMatrix mass : {MassMatrix::lumped, MassMatrix::consistent}) {
    const Body own = sample_body(kind, law, 0.0, mass);
    double volume = 0.0;
    for (const Cell& cell : own.cells) volume += solid::volume(own.rest, cell);
    EXPECT_NEAR(own.masses.sum(), 1100.0 * volume, 1e-12 * own.masses.sum());
    if (mass == MassMatrix::lumped) {
      EXPECT_GT(own.masses.minCoeff(), 0.0);
    }
    // v1 = v0 + h g, x1 = x0 + h v1 makes the residual vanish: no elastic force in a translation.
    const double h = 0.01;
    const Vec3 g(0, -9.81, 0), v0(0.3, 0.2, 0.1);
    const Eigen::Matrix3Xd v = v0.replicate(1, own.nodes());
    EXPECT_NEAR(kinetic_energy(own, v), 0.5 * own.masses.sum() * v0.squaredNorm(), 1e-14 * own.masses.sum());
    const StepStart start{own.rest, v, 1.0 / h};
    const Eigen::Matrix3Xd x = own.rest.colwise() + h * (v0 + h * g);
    double scale = 0.0;
    const Eigen::Matrix3Xd r = residual(own, start, x, g, &scale);
    EXPECT_LT(r.norm(), 1e-8 * scale);
    EXPECT_GT(scale, 1e-5);
  }
}

TEST(Body, free_vibration_is_the_backward_euler_recurrence) {
  // In a small deformation the step solves (M (1 + a h) / h^2 + (1 + b / h) K) dx = M v0 / h - K u0.
  for (const Kind kind : kKinds) {
    const double h = 0.01, tiny = 5e-11, damping = 0.02;
    const Body body = sample_body(kind, kLawsOfBodies[0].law, damping);
    const int n = 3 * body.nodes();
    const Eigen::MatrixXd K = dense_tangent(body, still(body), body.rest, Tangent::exact);
    Eigen::MatrixXd M = Eigen::MatrixXd::Zero(n, n);
    for (int i = 0; i < n; ++i) M(i, i) = body.masses[i / 3];
    const Eigen::VectorXd u0 = tiny * Eigen::VectorXd::LinSpaced(n, -1, 2),
                          v0 = 30 * tiny * Eigen::VectorXd::LinSpaced(n, 1, -1);
    const Eigen::MatrixXd A = K * (1 + damping / h) + M * (1 + damping * h) / (h * h);
    const Eigen::VectorXd dx = A.ldlt().solve(M * v0 / h - K * u0);
    const Eigen::Matrix3Xd x0 = body.rest + nodes(u0);
    const Eigen::Matrix3Xd v = nodes(v0);
    const StepStart start{x0, v, 1.0 / h};
    double scale = 0.0;
    const Eigen::Matrix3Xd r = residual(body, start, x0 + nodes(dx), Vec3::Zero(), &scale);
    EXPECT_GT(scale, 1e-9);
    EXPECT_LT(r.norm(), 1e-6 * scale);
  }
}

}  // namespace
}  // namespace sinew::solid
