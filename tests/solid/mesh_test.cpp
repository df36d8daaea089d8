#include "sinew/solid/mesh.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <vector>

#include "sinew/solid/mesh_summary.hpp"

namespace sinew::solid {
namespace {

Mesh unit_tetrahedron() {
  Mesh mesh;
  mesh.nodes.resize(3, 4);
  mesh.nodes << 0, 1, 0, 0,  //
      0, 0, 1, 0,            //
      0, 0, 0, 1;
  mesh.tetrahedra = {{0, 1, 2, 3}};
  return mesh;
}

/// A box of n x n x n cells, each cut into six tetrahedra around its diagonal.
Mesh box(int n, const Eigen::Vector3d& size) {
  Mesh mesh;
  const int side = n + 1;
  mesh.nodes.resize(3, side * side * side);
  const auto number = [side](int i, int j, int k) { return (k * side + j) * side + i; };
  for (int k = 0; k < side; ++k) {
    for (int j = 0; j < side; ++j) {
      for (int i = 0; i < side; ++i) {
        mesh.nodes.col(number(i, j, k)) = Eigen::Vector3d(i, j, k).cwiseProduct(size) / n;
      }
    }
  }
  const std::array<std::array<int, 3>, 6> orders = {{{0, 1, 2}, {1, 2, 0}, {2, 0, 1}, {1, 0, 2}, {0, 2, 1}, {2, 1, 0}}};
  for (int cell = 0; cell < n * n * n; ++cell) {
    for (std::size_t o = 0; o < orders.size(); ++o) {
      std::array<int, 3> corner = {cell % n, cell / n % n, cell / n / n};
      Tetrahedron tet{};
      tet[0] = number(corner[0], corner[1], corner[2]);
      for (std::size_t step = 0; step < 3; ++step) {
        ++corner[static_cast<std::size_t>(orders[o][step])];
        tet[step + 1] = number(corner[0], corner[1], corner[2]);
      }
      if (o >= 3) std::swap(tet[1], tet[2]);  // odd permutations are left-handed
      mesh.tetrahedra.push_back(tet);
    }
  }
  return mesh;
}

/// By the divergence theorem: positive only if the triangles point outward.
double enclosed(const Eigen::Matrix3Xd& nodes, const std::vector<Triangle>& triangles) {
  double sum = 0.0;
  for (const auto& [a, b, c] : triangles) sum += nodes.col(a).dot(nodes.col(b).cross(nodes.col(c))) / 6.0;
  return sum;
}

TEST(Volume, IsSignedAndASixthOfTheSpanOfTheEdges) {
  Mesh mesh = unit_tetrahedron();
  EXPECT_DOUBLE_EQ(volume(mesh.nodes, {0, 1, 2, 3}), 1.0 / 6.0);
  EXPECT_DOUBLE_EQ(volume(mesh.nodes, {0, 2, 1, 3}), -1.0 / 6.0);
  mesh.nodes.colwise() += Eigen::Vector3d(10, -20, 30);
  EXPECT_NEAR(volume(mesh.nodes, {0, 1, 2, 3}), 1.0 / 6.0, 1e-14);
}

TEST(Surface, OfOneTetrahedronIsItsFourFacesOutward) {
  const Mesh mesh = unit_tetrahedron();
  const std::vector<Triangle> triangles = surface(mesh.tetrahedra);
  ASSERT_EQ(triangles.size(), 4u);
  const Eigen::Vector3d centre = mesh.nodes.rowwise().mean();
  for (const auto& [a, b, c] : triangles) {
    const Eigen::Vector3d corner = mesh.nodes.col(a);
    const Eigen::Vector3d normal = (mesh.nodes.col(b) - corner).cross(mesh.nodes.col(c) - corner);
    EXPECT_GT(normal.dot(corner - centre), 0.0);
  }
}

TEST(Surface, LeavesOutFacesThatTwoTetrahedraShare) {
  const int n = 3;
  const Mesh mesh = box(n, {1, 2, 3});
  const std::vector<Triangle> triangles = surface(mesh.tetrahedra);
  EXPECT_EQ(triangles.size(), static_cast<std::size_t>(6 * 2 * n * n));
  EXPECT_NEAR(enclosed(mesh.nodes, triangles), 6.0, 1e-13);
  for (const Triangle& triangle : triangles) {
    bool on_a_side = false;
    for (int axis = 0; axis < 3; ++axis) {
      for (const double side : {0.0, axis + 1.0}) {
        on_a_side |= std::all_of(triangle.begin(), triangle.end(),
                                 [&](int node) { return std::abs(mesh.nodes(axis, node) - side) < 1e-12; });
      }
    }
    EXPECT_TRUE(on_a_side);
  }
}

TEST(Surface, OfNothingIsNothing) { EXPECT_TRUE(surface({}).empty()); }

TEST(Surface, KeepsTheOrderOfTheTetrahedra) {
  EXPECT_EQ(
      surface({{4, 5, 6, 7}, {0, 1, 2, 3}}),
      (std::vector<Triangle>{{4, 6, 5}, {4, 5, 7}, {5, 6, 7}, {4, 7, 6}, {0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}}));
}

TEST(MeanRatio, IsOneForARegularTetrahedronOfAnySize) {
  Eigen::Matrix3Xd nodes(3, 4);
  nodes << 1, -1, -1, 1,  //
      1, -1, 1, -1,       //
      1, 1, -1, -1;
  const Tetrahedron tet = volume(nodes, {0, 1, 2, 3}) > 0 ? Tetrahedron{0, 1, 2, 3} : Tetrahedron{0, 2, 1, 3};
  EXPECT_NEAR(mean_ratio(nodes, tet), 1.0, 1e-14);
  EXPECT_NEAR(mean_ratio(1e-4 * nodes, tet), 1.0, 1e-14);
  EXPECT_EQ(mean_ratio(nodes, {tet[1], tet[0], tet[2], tet[3]}), 0.0);  // inverted
  EXPECT_EQ(mean_ratio(nodes, {0, 1, 2, 2}), 0.0);                      // flat
}

TEST(MeanRatio, FallsAsATetrahedronIsFlattened) {
  Mesh mesh = unit_tetrahedron();
  double last = 1.0;
  for (const double height : {1.0, 0.3, 0.1, 0.01}) {
    mesh.nodes(2, 3) = height;
    const double quality = mean_ratio(mesh.nodes, mesh.tetrahedra[0]);
    // 3 V = h / 2; squared edges: three along the axes, 1 + 1 + h^2, and three across, 2 + 2 (1 + h^2).
    EXPECT_NEAR(quality, 12 * std::cbrt(height * height / 4) / (6 + 3 * height * height), 1e-14);
    EXPECT_LT(quality, last);
    last = quality;
  }
}

TEST(Summary, SaysWhatIsInTheMesh) {
  Mesh mesh = box(2, {1, 2, 3});
  const Eigen::Index used = mesh.nodes.cols();
  mesh.nodes.conservativeResize(3, used + 2);
  mesh.nodes.rightCols(2).setConstant(1000);  // nodes that nothing uses do not widen the box
  mesh.ignored = {{"triangle", 7}};

  const MeshSummary summary = summarize(mesh);
  EXPECT_EQ(summary.nodes, used + 2);
  EXPECT_EQ(summary.unused_nodes, 2);
  EXPECT_EQ(summary.tetrahedra, 48);
  EXPECT_EQ(summary.ignored.at("triangle"), 7);
  EXPECT_EQ(summary.lower, Eigen::Vector3d(0, 0, 0));
  EXPECT_EQ(summary.upper, Eigen::Vector3d(1, 2, 3));
  EXPECT_DOUBLE_EQ(summary.diagonal, std::sqrt(14.0));
  EXPECT_NEAR(summary.volume, 6.0, 1e-13);
  EXPECT_NEAR(summary.smallest, 6.0 / 48, 1e-14);
  EXPECT_NEAR(summary.largest, 6.0 / 48, 1e-14);
}

TEST(Summary, FindsTheWorstAndTheSmallestElement) {
  Mesh mesh = unit_tetrahedron();
  mesh.nodes.conservativeResize(3, 6);
  mesh.nodes.col(4) = Eigen::Vector3d(0.3, 0.3, -0.01);  // flat, below the first one
  mesh.nodes.col(5) = Eigen::Vector3d(1, 1, 1);
  mesh.tetrahedra = {{0, 1, 2, 3}, {0, 2, 1, 4}, {1, 2, 3, 5}};
  const MeshSummary summary = summarize(mesh);
  EXPECT_EQ(summary.worst_tetrahedron, 1);
  EXPECT_EQ(summary.worst_quality, mean_ratio(mesh.nodes, mesh.tetrahedra[1]));
  EXPECT_NEAR(summary.smallest, 0.01 / 6, 1e-15);
  EXPECT_NEAR(summary.largest, 1.0 / 3, 1e-15);
}

TEST(Summary, OfAMeshWithoutTetrahedraHasOnlyCounts) {
  Mesh mesh;
  mesh.nodes = Eigen::Matrix3Xd::Ones(3, 5);
  const MeshSummary summary = summarize(mesh);
  EXPECT_EQ(summary.nodes, 5);
  EXPECT_EQ(summary.unused_nodes, 5);
  EXPECT_EQ(summary.volume, 0.0);
  EXPECT_EQ(summary.worst_tetrahedron, -1);
}

}  // namespace
}  // namespace sinew::solid
