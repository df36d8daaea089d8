// Eight tetrahedra at a time beside one at a time.
#include "sinew/solid/tet_batch.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <string>

#include "sinew/lie/rotation.hpp"
#include "sinew/solid/body.hpp"

namespace sinew::solid {
namespace {

/// Eleven tetrahedra apart from each other, so that a batch is full and another is not.
constexpr int kCells = 11;

Body sample_body() {
  std::srand(1);
  Eigen::Matrix3Xd rest(3, 4 * kCells);
  std::vector<Cell> cells;
  for (int e = 0; e < kCells; ++e) {
    rest.middleCols<4>(4 * e) << 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1;
    rest.middleCols<4>(4 * e) = 0.01 * (rest.middleCols<4>(4 * e) + 0.2 * Eigen::Matrix<double, 3, 4>::Random());
    Cell cell{Kind::tet4, {}};
    for (int a = 0; a < 4; ++a) cell.node[static_cast<std::size_t>(a)] = 4 * e + a;
    cells.push_back(cell);
  }
  const Eigen::Array<bool, 3, Eigen::Dynamic> held =
      Eigen::Array<bool, 3, Eigen::Dynamic>::Constant(3, rest.cols(), false);
  std::vector<int> material(kCells, 0);
  material[4] = 1;
  return make_body(rest, cells, {{corotational(6e5, 0.45), 1000.0, {30.0, 50.0}}, {corotational(1e5, 0.2), 1000.0, {}}},
                   material, held);
}

Eigen::Matrix3Xd deformed(const Body& body, double size) {
  const Eigen::Matrix3Xd bumps = Eigen::Matrix3Xd::Random(3, body.nodes());
  return lie::exp(Vec3(0.9, -1.3, 0.4)) * (body.rest + size * 0.01 * bumps);
}

class EveryTetKernel : public testing::TestWithParam<const char*> {
 protected:
  void SetUp() override {
    own = tet_kernels(GetParam());
    if (!own) GTEST_SKIP() << "this processor has no " << GetParam();
  }
  const TetKernels* own = nullptr;
};

/// Records of nodes, and one more.
using Records = Eigen::Matrix<double, kRecord, Eigen::Dynamic>;
Records records(const Eigen::Matrix3Xd& first, const Eigen::Matrix3Xd& second) {
  Records all = Records::Zero(kRecord, first.cols() + 1);
  all.topLeftCorner(3, first.cols()) = first;
  all.block(4, 0, 3, second.cols()) = second;
  return all;
}
Records no_forces(const Body& body) { return Records::Zero(kRecord, body.nodes() + 1); }

TEST_P(EveryTetKernel, GivesForcesAndTangentsOfTheElements) {
  const Body body = sample_body();
  ASSERT_EQ(body.batches.size(), 2u);
  for (const double size : {0.0, 1e-8, 1e-5, 0.1}) {
    for (const double rate : {0.0, 100.0}) {
      const Eigen::Matrix3Xd x0 = deformed(body, 0.05),
                             x = x0 + size * 0.01 * Eigen::Matrix3Xd::Random(3, body.nodes());
      const Records nodes = records(x, x - x0);
      for (const TetBatch& batch : body.batches) {
        TetFrames frames;
        TetStiffness definite, exact;
        const unsigned all = (1U << batch.count) - 1U;
        Records forces = no_forces(body);
        own->add_forces(&batch, 1, nodes.data(), rate, body.nodes(), &frames, forces.data());
        EXPECT_EQ(frames.missing & all, 0U);
        EXPECT_EQ(forces.row(3).norm(), 0.0);
        EXPECT_EQ(forces.row(7).norm(), 0.0);
        EXPECT_EQ(forces.bottomRows(4).norm() > 0.0, rate > 0.0 && size > 0.0);
        own->definite(batch, frames, rate, definite);
        own->exact(batch, frames, nodes.data(), rate, exact);
        for (int i = 0; i < batch.count; ++i) {
          const int e = batch.cell[i];
          for (const Tangent kind : {Tangent::definite, Tangent::exact}) {
            ElementResponse elastic, viscous;
            evaluate(body.of(e).law, body.element(e), body.at_nodes(e, x), Derivatives::second, kind, elastic);
            viscous.force.setZero(3, 4);
            viscous.stiffness.setZero(12, 12);
            if (rate > 0.0)
              add_viscosity(body.of(e).viscosity, rate, body.element(e), body.at_nodes(e, x0), body.at_nodes(e, x),
                            Derivatives::second, kind, viscous);
            const Eigen::MatrixXd K = elastic.stiffness + viscous.stiffness;
            const TetStiffness& stiffness = kind == Tangent::exact ? exact : definite;
            for (int a = 0; a < 4; ++a) {
              for (int axis = 0; axis < 3; ++axis) {
                EXPECT_NEAR(forces(axis, batch.node[a][i]), elastic.force(axis, a),
                            1e-12 * elastic.force.norm() + 1e-13);
                if (rate > 0.0)
                  EXPECT_NEAR(forces(4 + axis, batch.node[a][i]), viscous.force(axis, a), 1e-11 * viscous.force.norm());
              }
              for (int b = 0; b <= a; ++b) {
                for (int n = 0; n < 9; ++n)
                  EXPECT_NEAR(stiffness.block[a * (a + 1) / 2 + b][n][i], K(3 * a + n % 3, 3 * b + n / 3),
                              1e-13 * K.norm());
              }
            }
          }
        }
      }
    }
  }
}

TEST_P(EveryTetKernel, LeavesOutWhatIsFlatOrInsideOut) {
  const Body body = sample_body();
  Eigen::Matrix3Xd x = deformed(body, 0.05);
  x.col(4 * 2) = (x.col(4 * 2 + 1) + x.col(4 * 2 + 2) + x.col(4 * 2 + 3)) / 3;  // flat
  x.col(4 * 5) += 3.0 * (x.col(4 * 5 + 1) - x.col(4 * 5));                      // inside out
  TetFrames frames;
  Records forces = no_forces(body);
  own->add_forces(body.batches.data(), 1, records(x, x).data(), 0.0, body.nodes(), &frames, forces.data());
  EXPECT_EQ(frames.missing, 1U << 2 | 1U << 5);
  for (const int e : {2, 5}) EXPECT_EQ(forces.middleCols<4>(4 * e).norm(), 0.0) << e;
  EXPECT_GT(forces.middleCols<4>(4 * 3).norm(), 0.0);
}

TEST_P(EveryTetKernel, GivesTheSameOfBatchesTogetherAsOfEach) {
  const Body body = sample_body();
  Eigen::Matrix3Xd x = deformed(body, 0.05);
  for (const int e : {2, 9}) x.col(4 * e) += 3.0 * (x.col(4 * e + 1) - x.col(4 * e));  // inside out
  const Records nodes = records(x, x - body.rest);
  const int count = static_cast<int>(body.batches.size());
  ASSERT_EQ(count, 2);
  std::vector<TetFrames> together(2), each(2);
  Records all = no_forces(body), sum = no_forces(body);
  own->add_forces(body.batches.data(), count, nodes.data(), 100.0, body.nodes(), together.data(), all.data());
  for (int k = 0; k < count; ++k)
    own->add_forces(&body.batches[k], 1, nodes.data(), 100.0, body.nodes(), &each[k], sum.data());
  for (int k = 0; k < count; ++k) EXPECT_EQ(together[k].missing, each[k].missing) << k;
  EXPECT_EQ(each[0].missing, 1U << 2);
  EXPECT_EQ(each[1].missing & 3U, 1U << 1);
  const auto of_nodes = [&](const Records& forces) { return forces.leftCols(body.nodes()); };
  EXPECT_LT((of_nodes(all) - of_nodes(sum)).norm(), 1e-13 * of_nodes(sum).norm());
}

INSTANTIATE_TEST_SUITE_P(TetBatch, EveryTetKernel, testing::Values("portable", "avx2", "avx512"),
                         [](const auto& tested) { return std::string(tested.param); });

/// A body's forces do not depend on which elements come by eights.
TEST(TetBatch, ElementsLeftOutAreEvaluatedByThemselves) {
  const Body body = sample_body();
  Eigen::Matrix3Xd x = deformed(body, 0.05);
  x.col(4 * 5) += 3.0 * (x.col(4 * 5 + 1) - x.col(4 * 5));
  const Eigen::Matrix3Xd force = elastic_force(body, x);
  for (int e = 0; e < kCells; ++e) {
    ElementResponse response;
    evaluate(body.of(e).law, body.element(e), body.at_nodes(e, x), Derivatives::first, Tangent::exact, response);
    EXPECT_LT((force.middleCols<4>(4 * e) - response.force).norm(), 1e-12 * response.force.norm()) << e;
  }
}

}  // namespace
}  // namespace sinew::solid
