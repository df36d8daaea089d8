// Loads on faces: derivatives, closed surfaces, shares, rims.
#include "sinew/solid/pressure.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>

#include "support/difference.hpp"
#include "support/meshes.hpp"

namespace sinew::solid {
namespace {

/// Nodes of a face off any plane, off the middles of its edges.
Eigen::Matrix3Xd curved(int count) {
  Eigen::Matrix3Xd x(3, count);
  if (count == 4) {
    x << 0, 1, 1, 0, 0, 0, 1, 1, 0, 0, 0, 0;
  } else {
    x << Eigen::Matrix<double, 3, 6>{{0, 1, 0, 0.5, 0.5, 0}, {0, 0, 1, 0, 0.5, 0.5}, {0, 0, 0, 0, 0, 0}}.leftCols(
        count);
  }
  for (Eigen::Index i = 0; i < x.size(); ++i) x(i) += 0.15 * std::sin(2.3 * static_cast<double>(i * i + 1));
  return x;
}

class OnFace : public testing::TestWithParam<int> {
 protected:
  const CellFace face{GetParam(), {0, 1, 2, 3, 4, 5}};
  const Eigen::Matrix3Xd x = curved(GetParam());
};
INSTANTIATE_TEST_SUITE_P(Faces, OnFace, testing::Values(3, 4, 6));

TEST_P(OnFace, tangent_is_the_derivative_of_the_force) {
  const auto force = [&](const Eigen::VectorXd& q) -> Eigen::VectorXd {
    return pressure_force(face, 3.0, q.reshaped(3, GetParam())).reshaped();
  };
  const Eigen::MatrixXd K = pressure_tangent(face, 3.0, x);
  const Eigen::MatrixXd D = test::difference(force, x.reshaped(), 1e-5);
  EXPECT_GT(K.norm(), 1.0);
  EXPECT_LT((K + D).norm(), 1e-9 * K.norm());
  EXPECT_GT((K - K.transpose()).norm(), 0.1 * K.norm());  // a face alone has a rim
}

TEST(Pressure, skew_part_of_the_tangent_is_that_of_the_rim) {
  const CellFace face{3, {0, 1, 2}};
  const Eigen::Matrix3Xd x = curved(3), dx = 1.7 * curved(6).rightCols(3), other = curved(4).leftCols(3);
  const Eigen::MatrixXd K = pressure_tangent(face, 3.0, x);
  double around = 0.0;
  for (int i = 0; i < 3; ++i) {  // int of (other x dx) . dl along the edge, all linear
    const int j = (i + 1) % 3;
    const Vec3 a = other.col(i), b = other.col(j), c = dx.col(i), d = dx.col(j);
    around += ((a.cross(c) + b.cross(d)) / 3.0 + (a.cross(d) + b.cross(c)) / 6.0).dot(x.col(j) - x.col(i));
  }
  EXPECT_GT(std::abs(around), 0.01);
  EXPECT_NEAR(other.reshaped().dot((0.5 * (K - K.transpose())) * dx.reshaped()), 0.5 * 3.0 * around, 1e-13);
}

TEST_P(OnFace, lumped_shares_are_positive_and_add_up_to_the_area) {
  const FaceValues shares = lumped_face_shares(face, x);
  EXPECT_GT(shares.minCoeff(), 0.02 * shares.sum());
  EXPECT_NEAR(shares.sum(), face_shares(face, x).sum(), 1e-14);
}

TEST(Pressure, flat_quadratic_triangle_shares_nothing_at_its_corners_but_lumped_a_nineteenth) {
  Eigen::Matrix3Xd x(3, 6);
  x << 0, 2, 0, 1, 1, 0, 0, 0, 2, 0, 1, 1, 0, 0, 0, 0, 0, 0;
  const CellFace face{6, {0, 1, 2, 3, 4, 5}};
  const FaceValues even = face_shares(face, x), lumped = lumped_face_shares(face, x);
  for (int i = 0; i < 3; ++i) {
    EXPECT_NEAR(even[i], 0.0, 1e-14);
    EXPECT_NEAR(even[3 + i], 2.0 / 3.0, 1e-14);
    EXPECT_NEAR(lumped[i], 2.0 / 19.0, 1e-14);  // 1/30 and 8/45 of the area, scaled
    EXPECT_NEAR(lumped[3 + i], 2.0 * 16.0 / 57.0, 1e-14);
  }
}

TEST(Pressure, closed_surface_under_pressure_has_no_resultant_and_a_symmetric_tangent) {
  for (const Kind kind : {Kind::tet4, Kind::tet10, Kind::hex8}) {
    const Mesh mesh = test::block_mesh(2, 2, 1, Vec3(1, 1, 1), kind);
    Eigen::Matrix3Xd x = mesh.nodes;
    for (Eigen::Index i = 0; i < x.size(); ++i) x(i) += 0.05 * std::sin(1.7 * static_cast<double>(i * i + 1));
    const std::vector<CellFace> faces = boundary(mesh.cells);
    EXPECT_TRUE(rim(faces).empty());
    Eigen::MatrixXd K = Eigen::MatrixXd::Zero(x.size(), x.size());
    Vec3 force = Vec3::Zero();
    for (const CellFace& face : faces) {
      const Eigen::MatrixXd own = pressure_tangent(face, 1.0, x);
      for (int b = 0; b < face.count; ++b) {
        for (int a = 0; a < face.count; ++a)
          K.block<3, 3>(3 * face.node[a], 3 * face.node[b]) += own.block<3, 3>(3 * a, 3 * b);
      }
      force += pressure_force(face, 1.0, x).rowwise().sum();
    }
    EXPECT_GT(K.norm(), 0.1);
    EXPECT_LT((K - K.transpose()).norm(), 1e-14 * K.norm()) << name(kind);
    EXPECT_LT(force.norm(), 1e-14);
  }
}

TEST(Pressure, rim_of_a_side_is_its_outline) {
  for (const Kind kind : {Kind::tet4, Kind::tet10, Kind::hex8}) {
    const Mesh mesh = test::block_mesh(2, 3, 1, Vec3(2, 3, 1), kind);
    std::vector<CellFace> top;
    for (const CellFace& face : boundary(mesh.cells)) {
      const auto nodes = face.nodes();
      if (std::all_of(nodes.begin(), nodes.end(), [&](int i) { return mesh.nodes(2, i) == 1.0; })) top.push_back(face);
    }
    const std::vector<Edge> edges = rim(top);
    EXPECT_EQ(edges.size(), 10u) << name(kind);
    for (const Edge& edge : edges) {
      EXPECT_EQ(edge.count, kind == Kind::tet10 ? 3 : 2);
      for (const int i : edge.nodes()) {
        const Vec3 x = mesh.nodes.col(i);
        EXPECT_TRUE(x.x() == 0 || x.x() == 2 || x.y() == 0 || x.y() == 3);
      }
    }
  }
}

}  // namespace
}  // namespace sinew::solid
