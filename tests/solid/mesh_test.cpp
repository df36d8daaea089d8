#include "sinew/solid/mesh.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <utility>
#include <vector>

#include "sinew/solid/mesh_order.hpp"
#include "sinew/solid/mesh_summary.hpp"
#include "solid/sample_elements.hpp"

namespace sinew::solid {
namespace {

Cell tet(int a, int b, int c, int d) { return {Kind::tet4, {a, b, c, d}}; }

Mesh unit_tetrahedron() {
  Mesh mesh;
  mesh.nodes.resize(3, 4);
  mesh.nodes << 0, 1, 0, 0,  //
      0, 0, 1, 0,            //
      0, 0, 0, 1;
  mesh.cells = {tet(0, 1, 2, 3)};
  return mesh;
}

/// A box of n x n x n hexahedra.
Mesh bricks(int n, const Eigen::Vector3d& size) {
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
  for (int cell = 0; cell < n * n * n; ++cell) {
    const int i = cell % n, j = cell / n % n, k = cell / n / n;
    mesh.cells.push_back(
        {Kind::hex8,
         {number(i, j, k), number(i + 1, j, k), number(i + 1, j + 1, k), number(i, j + 1, k), number(i, j, k + 1),
          number(i + 1, j, k + 1), number(i + 1, j + 1, k + 1), number(i, j + 1, k + 1)}});
  }
  return mesh;
}

/// The same, each cut into six tetrahedra around its diagonal.
Mesh box(int n, const Eigen::Vector3d& size) {
  const Mesh whole = bricks(n, size);
  Mesh mesh;
  mesh.nodes = whole.nodes;
  for (const Cell& brick : whole.cells) {
    const auto corner = [&](std::size_t c) { return brick.node[c]; };
    // Along two edges of the brick from its corner 0, then to the opposite corner 6.
    const std::array<std::pair<std::size_t, std::size_t>, 6> paths = {{{1, 2}, {2, 3}, {3, 7}, {7, 4}, {4, 5}, {5, 1}}};
    for (const auto& [a, b] : paths) mesh.cells.push_back(tet(corner(0), corner(a), corner(b), corner(6)));
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
  EXPECT_DOUBLE_EQ(volume(mesh.nodes, tet(0, 1, 2, 3)), 1.0 / 6.0);
  EXPECT_DOUBLE_EQ(volume(mesh.nodes, tet(0, 2, 1, 3)), -1.0 / 6.0);
  mesh.nodes.colwise() += Eigen::Vector3d(10, -20, 30);
  EXPECT_NEAR(volume(mesh.nodes, tet(0, 1, 2, 3)), 1.0 / 6.0, 1e-14);
}

TEST(Surface, OfOneTetrahedronIsItsFourFacesOutward) {
  const Mesh mesh = unit_tetrahedron();
  const std::vector<Triangle> triangles = surface(mesh.cells);
  ASSERT_EQ(triangles.size(), 4u);
  const Eigen::Vector3d centre = mesh.nodes.rowwise().mean();
  for (const auto& [a, b, c] : triangles) {
    const Eigen::Vector3d corner = mesh.nodes.col(a);
    const Eigen::Vector3d normal = (mesh.nodes.col(b) - corner).cross(mesh.nodes.col(c) - corner);
    EXPECT_GT(normal.dot(corner - centre), 0.0);
  }
}

TEST(Surface, LeavesOutFacesThatTwoCellsShare) {
  const int n = 3;
  const Mesh tetrahedra = box(n, {1, 2, 3});
  for (const auto& [mesh, per_square] :
       {std::pair(tetrahedra, 2), std::pair(quadratic(tetrahedra), 8), std::pair(bricks(n, {1, 2, 3}), 2)}) {
    const std::vector<Triangle> triangles = surface(mesh.cells);
    EXPECT_EQ(triangles.size(), static_cast<std::size_t>(6 * per_square * n * n));
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
}

TEST(Surface, OfNothingIsNothing) { EXPECT_TRUE(surface({}).empty()); }

TEST(Boundary, HasAllNodesOfItsFacesOutward) {
  EXPECT_EQ(boundary({whole_cell(Kind::tet10)}),
            (std::vector<CellFace>{
                {6, {0, 2, 1, 6, 5, 4}}, {6, {0, 1, 3, 4, 8, 7}}, {6, {1, 2, 3, 5, 9, 8}}, {6, {0, 3, 2, 7, 9, 6}}}));
  EXPECT_EQ(boundary({whole_cell(Kind::hex8)}), (std::vector<CellFace>{{4, {0, 3, 2, 1}},
                                                                       {4, {4, 5, 6, 7}},
                                                                       {4, {0, 1, 5, 4}},
                                                                       {4, {1, 2, 6, 5}},
                                                                       {4, {2, 3, 7, 6}},
                                                                       {4, {3, 0, 4, 7}}}));
}

TEST(Boundary, TakesFacesWithTheSameCornersForOne) {
  // Both tetrahedra have the corners 1, 2, 3; only one has nodes in the middle of its edges.
  const Cell quadratic{Kind::tet10, {1, 2, 3, 4, 10, 11, 12, 13, 14, 15}};
  const std::vector<CellFace> outer = boundary({tet(0, 1, 2, 3), quadratic});
  ASSERT_EQ(outer.size(), 6u);
  EXPECT_EQ(std::count_if(outer.begin(), outer.end(), [](const CellFace& face) { return face.count == 6; }), 3);
  // A triangle is no part of a quadrilateral with its corners.
  EXPECT_EQ(boundary({whole_cell(Kind::hex8), tet(4, 5, 6, 8)}).size(), 10u);
}

TEST(Surface, KeepsTheOrderOfTheCells) {
  EXPECT_EQ(
      surface({tet(4, 5, 6, 7), tet(0, 1, 2, 3)}),
      (std::vector<Triangle>{{4, 6, 5}, {4, 5, 7}, {5, 6, 7}, {4, 7, 6}, {0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}}));
}

TEST(MeanRatio, IsOneForARegularTetrahedronOfAnySize) {
  Eigen::Matrix3Xd nodes(3, 4);
  nodes << 1, -1, -1, 1,  //
      1, -1, 1, -1,       //
      1, 1, -1, -1;
  const Cell regular = volume(nodes, tet(0, 1, 2, 3)) > 0 ? tet(0, 1, 2, 3) : tet(0, 2, 1, 3);
  EXPECT_NEAR(mean_ratio(nodes, regular), 1.0, 1e-14);
  EXPECT_NEAR(mean_ratio(1e-4 * nodes, regular), 1.0, 1e-14);
  EXPECT_EQ(mean_ratio(nodes, tet(regular.node[1], regular.node[0], 2, 3)), 0.0);  // inverted
  EXPECT_EQ(mean_ratio(nodes, tet(0, 1, 2, 2)), 0.0);                              // flat
}

TEST(MeanRatio, FallsAsATetrahedronIsFlattened) {
  Mesh mesh = unit_tetrahedron();
  double last = 1.0;
  for (const double height : {1.0, 0.3, 0.1, 0.01}) {
    mesh.nodes(2, 3) = height;
    const double quality = mean_ratio(mesh.nodes, mesh.cells[0]);
    // 3 V = h / 2; squared edges: three along the axes, 1 + 1 + h^2, and three across, 2 + 2 (1 + h^2).
    EXPECT_NEAR(quality, 12 * std::cbrt(height * height / 4) / (6 + 3 * height * height), 1e-14);
    EXPECT_LT(quality, last);
    last = quality;
  }
}

TEST(MeanRatio, OfATetrahedronDoesNotSeeCurvedEdges) {
  Mesh mesh = quadratic(unit_tetrahedron());
  const double straight = mean_ratio(mesh.nodes, mesh.cells[0]);
  EXPECT_NEAR(straight, mean_ratio(mesh.nodes, tet(0, 1, 2, 3)), 1e-15);
  mesh.nodes(2, 4) -= 0.1;
  EXPECT_EQ(mean_ratio(mesh.nodes, mesh.cells[0]), straight);
}

TEST(MeanRatio, OfAHexahedronIsOneForACubeAndThatOfItsWorstCorner) {
  Mesh mesh = bricks(1, {2, 2, 2});
  const Cell cube = mesh.cells[0];
  EXPECT_NEAR(mean_ratio(mesh.nodes, cube), 1.0, 1e-14);
  EXPECT_NEAR(mean_ratio(1e-4 * mesh.nodes, cube), 1.0, 1e-14);
  const Mesh sides = bricks(1, {1, 2, 3});  // at each corner: edges 1, 2, 3, determinant 6
  EXPECT_NEAR(mean_ratio(sides.nodes, sides.cells[0]), 3 * std::cbrt(36.0) / 14, 1e-14);
  // A corner moved to the middle of an edge has edges (1, 0, 0), (1, 2, 0), (1, 0, 2) up to signs: determinant 4,
  // squares 1 + 5 + 5. Its neighbour along that edge has 4 and 1 + 4 + 4, the others more.
  for (int corner = 0; corner < 8; ++corner) {
    Mesh pushed = mesh;
    const int moved = cube.node[static_cast<std::size_t>(corner)];
    pushed.nodes(0, moved) += pushed.nodes(0, moved) > 1 ? -1.0 : 1.0;
    EXPECT_NEAR(mean_ratio(pushed.nodes, cube), 3 * std::cbrt(16.0) / 11, 1e-14) << corner;
    pushed.nodes.col(moved) = Eigen::Vector3d(1, 1, 1) + 1.5 * (Eigen::Vector3d(1, 1, 1) - mesh.nodes.col(moved));
    EXPECT_EQ(mean_ratio(pushed.nodes, cube), 0.0) << corner;  // through the opposite corner
  }
}

TEST(SmallestJacobian, IsOneForAffineCellsOfAnySizeAndPlace) {
  for (const Kind kind : kKinds) {
    const Eigen::Matrix3Xd nodes = distorted(kind, 0.0);
    EXPECT_NEAR(smallest_jacobian(nodes, whole_cell(kind)), 1.0, 1e-13);
    EXPECT_NEAR(smallest_jacobian(1e-4 * nodes, whole_cell(kind)), 1.0, 1e-13);
    EXPECT_NEAR(smallest_jacobian(-nodes, whole_cell(kind)), -1.0, 1e-13);
    Eigen::Matrix3Xd flat = nodes;
    flat.row(1).setZero();
    EXPECT_EQ(smallest_jacobian(flat, whole_cell(kind)), 0.0);
    flat.col(2).setConstant(std::numeric_limits<double>::quiet_NaN());
    EXPECT_FALSE(smallest_jacobian(flat, whole_cell(kind)) > 0.0);
  }
}

TEST(SmallestJacobian, FallsToZeroAsTheMiddleOfAnEdgeNearsAQuarter) {
  // With the middle node of the edge 0-1 at x = m the slope along the edge at node 0 is 4 m - 1.
  Mesh mesh = quadratic(unit_tetrahedron());
  for (const double m : {0.45, 0.35, 0.3, 0.26}) {
    mesh.nodes(0, 4) = m;
    const double smallest = smallest_jacobian(mesh.nodes, mesh.cells[0]);
    EXPECT_GT(smallest, 0.0);
    EXPECT_NEAR(smallest, 4 * m - 1, 0.25 * (4 * m - 1));  // the mean size stays near 1
  }
  mesh.nodes(0, 4) = 0.24;
  EXPECT_LT(smallest_jacobian(mesh.nodes, mesh.cells[0]), 0.0);
  EXPECT_GT(volume(mesh.nodes, mesh.cells[0]), 0.1);  // which its volume does not tell
}

TEST(SmallestJacobian, IsNegativeWhereACornerOfAHexahedronIsFolded) {
  Mesh mesh = bricks(1, {2, 2, 2});
  // The corner (2, 2, 2) on the diagonal: its edges are in a plane at 4/3, where its three neighbours are.
  mesh.nodes.col(7).setConstant(1.4);
  EXPECT_GT(smallest_jacobian(mesh.nodes, mesh.cells[0]), 0.0);
  mesh.nodes.col(7).setConstant(1.3);
  EXPECT_LT(smallest_jacobian(mesh.nodes, mesh.cells[0]), 0.0);
}

TEST(Summary, SaysWhatIsInTheMesh) {
  Mesh mesh = box(2, {1, 2, 3});
  const Eigen::Index used = mesh.nodes.cols();
  mesh.nodes.conservativeResize(3, used + 2);
  mesh.nodes.rightCols(2).setConstant(1000);  // nodes that nothing uses do not widen the box
  mesh.ignored = {{"wedge", 7}};

  const MeshSummary summary = summarize(mesh);
  EXPECT_EQ(summary.nodes, used + 2);
  EXPECT_EQ(summary.unused_nodes, 2);
  EXPECT_EQ(summary.cells, 48);
  EXPECT_EQ(summary.kinds, (std::map<Kind, int>{{Kind::tet4, 48}}));
  EXPECT_EQ(summary.ignored.at("wedge"), 7);
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
  mesh.cells = {tet(0, 1, 2, 3), tet(0, 2, 1, 4), tet(1, 2, 3, 5)};
  const MeshSummary summary = summarize(mesh);
  EXPECT_EQ(summary.worst_cell, 1);
  EXPECT_LT((summary.worst_centre - Eigen::Vector3d(1.3 / 4, 1.3 / 4, -0.01 / 4)).norm(), 1e-15);
  EXPECT_EQ(summary.worst_quality, mean_ratio(mesh.nodes, mesh.cells[1]));
  EXPECT_NEAR(summary.smallest, 0.01 / 6, 1e-15);
  EXPECT_NEAR(summary.largest, 1.0 / 3, 1e-15);
}

TEST(Summary, CountsEachKindOfAMixedMesh) {
  Mesh mesh = bricks(2, {1, 1, 1});  // 27 nodes
  const Mesh other = quadratic(unit_tetrahedron());
  mesh.nodes.conservativeResize(3, 27 + 10);
  mesh.nodes.rightCols(10) = other.nodes.colwise() + Eigen::Vector3d(5, 0, 0);
  mesh.cells.push_back(whole_cell(Kind::tet10, 27));
  mesh.cells.push_back(tet(27, 28, 29, 30));
  const MeshSummary summary = summarize(mesh);
  EXPECT_EQ(summary.cells, 10);
  EXPECT_EQ(summary.kinds, (std::map<Kind, int>{{Kind::hex8, 8}, {Kind::tet10, 1}, {Kind::tet4, 1}}));
  EXPECT_EQ(summary.unused_nodes, 0);
  EXPECT_EQ(summary.upper, Eigen::Vector3d(6, 1, 1));
  EXPECT_NEAR(summary.volume, 1.0 + 2.0 / 6, 1e-14);
  EXPECT_EQ(summary.worst_cell, 8);
  EXPECT_LT((summary.worst_centre - Eigen::Vector3d(5.25, 0.25, 0.25)).norm(), 1e-15);  // of corners
}

TEST(Summary, OfAMeshWithoutCellsHasOnlyCounts) {
  Mesh mesh;
  mesh.nodes = Eigen::Matrix3Xd::Ones(3, 5);
  const MeshSummary summary = summarize(mesh);
  EXPECT_EQ(summary.nodes, 5);
  EXPECT_EQ(summary.unused_nodes, 5);
  EXPECT_EQ(summary.volume, 0.0);
  EXPECT_EQ(summary.worst_cell, -1);
}

}  // namespace
}  // namespace sinew::solid
