// Meshes that come apart: pieces, nodes at one place, nodes on faces that do not have them.
#include "sinew/solid/mesh_pieces.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace sinew::solid {
namespace {

using testing::ElementsAre;

Cell hexahedron(std::array<int, kMostNodes> nodes) { return {Kind::hex8, nodes}; }
Cell tetrahedron(int a, int b, int c, int d) { return {Kind::tet4, {a, b, c, d}}; }

/// Corners of a box, in VTK's order.
Eigen::Matrix3Xd box(const Eigen::Vector3d& least, const Eigen::Vector3d& most) {
  Eigen::Matrix3Xd nodes(3, 8);
  for (int i = 0; i < 8; ++i) {
    const bool x = i % 4 == 1 || i % 4 == 2, y = i % 4 > 1, z = i > 3;
    nodes.col(i) << (x ? most : least).x(), (y ? most : least).y(), (z ? most : least).z();
  }
  return nodes;
}

TEST(MeshPieces, AreWhatSharesNodes) {
  const std::vector<Cell> cells = {tetrahedron(0, 1, 2, 3), tetrahedron(7, 8, 9, 10), tetrahedron(3, 4, 5, 6)};
  const Pieces pieces = find_pieces(cells, 12);
  EXPECT_EQ(pieces.count, 2);
  EXPECT_THAT(pieces.of_cell, ElementsAre(0, 1, 0));
  EXPECT_THAT(pieces.of_node, ElementsAre(0, 0, 0, 0, 0, 0, 0, 1, 1, 1, 1, -1));
}

TEST(MeshPieces, CoincidentNodesAreFoundAtAnySize) {
  for (const double scale : {1e-6, 1.0, 1e6}) {
    Eigen::Matrix3Xd nodes(3, 16);
    nodes << box({0, 0, 0}, {1, 1, 1}), box({1, 0, 0}, {2, 1, 1});
    nodes *= scale;
    const std::vector<Cell> cells = {hexahedron({0, 1, 2, 3, 4, 5, 6, 7}), hexahedron({8, 9, 10, 11, 12, 13, 14, 15})};
    EXPECT_EQ(coincident_nodes(nodes, cells).size(), 4u);
    nodes.rightCols(8).row(0).array() += 1e-5 * scale;
    EXPECT_TRUE(coincident_nodes(nodes, cells).empty());
  }
}

/// A face of one cell meets two halves: their middle nodes hang on it, on its edges.
TEST(MeshPieces, HangingNodesAreFound) {
  Eigen::Matrix3Xd nodes(3, 16);
  nodes << box({0, 0, 0}, {1, 1, 1}), box({1, 0, 0.5}, {2, 1, 1});
  nodes.col(8) = Eigen::Vector3d(1, 0, 0.5);
  // The upper half shares the corners at z = 1 with the first cell, and hangs by those at z = 1/2.
  const std::vector<Cell> cells = {hexahedron({0, 1, 2, 3, 4, 5, 6, 7}), hexahedron({8, 9, 10, 11, 5, 13, 14, 6})};
  const Pieces pieces = find_pieces(cells, nodes.cols());
  ASSERT_EQ(pieces.count, 1);
  EXPECT_THAT(hanging_nodes(nodes, cells, pieces), ElementsAre(8, 11));
  nodes.col(8).x() += 1e-3;
  EXPECT_THAT(hanging_nodes(nodes, cells, pieces), ElementsAre(11));
  // Of another piece they only touch.
  const std::vector<Cell> apart = {cells[0], hexahedron({8, 9, 10, 11, 12, 13, 14, 15})};
  EXPECT_TRUE(hanging_nodes(nodes, apart, find_pieces(apart, nodes.cols())).empty());
}

TEST(MeshPieces, SoundMeshesHaveNoneOfIt) {
  Eigen::Matrix3Xd nodes(3, 12);
  nodes << box({0, 0, 0}, {1, 1, 1}), box({1, 0, 0}, {2, 1, 1}).rightCols(4);
  nodes.col(8) = Eigen::Vector3d(2, 0, 0);
  nodes.col(9) = Eigen::Vector3d(2, 1, 0);
  nodes.col(10) = Eigen::Vector3d(2, 1, 1);
  nodes.col(11) = Eigen::Vector3d(2, 0, 1);
  const std::vector<Cell> cells = {hexahedron({0, 1, 2, 3, 4, 5, 6, 7}), hexahedron({1, 8, 9, 2, 5, 11, 10, 6})};
  const Pieces pieces = find_pieces(cells, nodes.cols());
  EXPECT_EQ(pieces.count, 1);
  EXPECT_TRUE(coincident_nodes(nodes, cells).empty());
  EXPECT_TRUE(hanging_nodes(nodes, cells, pieces).empty());
}

}  // namespace
}  // namespace sinew::solid
