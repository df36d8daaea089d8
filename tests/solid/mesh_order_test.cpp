#include "sinew/solid/mesh_order.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <set>

#include "support/meshes.hpp"

namespace sinew::solid {
namespace {

const Vec3 kSize(3, 2, 1);

Cell cell(int a, int b, int c, int d) { return {Kind::tet4, {a, b, c, d}}; }

/// Two tetrahedra on the triangle 0 1 2.
Mesh two_tetrahedra() {
  Mesh mesh;
  mesh.nodes.resize(3, 5);
  mesh.nodes << 0, 1, 0, 0, 0.2,  //
      0, 0, 1, 0, 0.3,            //
      0, 0, 0, 1, -1;
  mesh.cells = {cell(0, 1, 2, 3), cell(0, 2, 1, 4)};
  return mesh;
}

/// A hexahedron of side 2 with two tetrahedra on its face at x = 2.
Mesh cube_and_roof() {
  Mesh mesh = test::block_mesh(1, 1, 1, Vec3(2, 2, 2), Kind::hex8);  // nodes 1, 3, 5, 7 at x = 2
  mesh.nodes.conservativeResize(3, 9);
  mesh.nodes.col(8) = Vec3(3, 1, 1);
  mesh.cells.push_back(cell(1, 3, 7, 8));
  mesh.cells.push_back(cell(1, 7, 5, 8));
  return mesh;
}

TEST(Quadratic, PutsOneNodeInTheMiddleOfEachEdgeAfterTheOldOnes) {
  const Mesh linear = test::block_mesh(3, 2, 1, kSize), raised = quadratic(linear);
  std::set<std::set<int>> edges;
  for (std::size_t i = 0; i < raised.cells.size(); ++i) {
    const Cell& cell = raised.cells[i];
    EXPECT_EQ(cell.kind, Kind::tet10);
    for (std::size_t k = 0; k < 4; ++k) EXPECT_EQ(cell.node[k], linear.cells[i].node[k]);
    constexpr std::size_t ends[6][2] = {{0, 1}, {1, 2}, {2, 0}, {0, 3}, {1, 3}, {2, 3}};  // of VTK's cell 24
    for (std::size_t e = 0; e < 6; ++e) {
      const int a = cell.node[ends[e][0]], b = cell.node[ends[e][1]], middle = cell.node[4 + e];
      EXPECT_GE(middle, linear.nodes.cols());
      EXPECT_LT((2 * raised.nodes.col(middle) - raised.nodes.col(a) - raised.nodes.col(b)).norm(), 1e-15);
      edges.insert({a, b});
    }
  }
  EXPECT_EQ(raised.nodes.leftCols(linear.nodes.cols()), linear.nodes);
  EXPECT_EQ(raised.nodes.cols(), linear.nodes.cols() + static_cast<Eigen::Index>(edges.size()));
  EXPECT_EQ(meeting_orders(raised.cells), 0);
  EXPECT_FALSE(mismatched_edges(raised.cells));
}

TEST(Quadratic, LeavesOtherCellsAlone) {
  const Mesh bricks = test::block_mesh(2, 1, 1, kSize, Kind::hex8),
             curved = test::block_mesh(2, 1, 1, kSize, Kind::tet10);
  for (const Mesh& mesh : {bricks, curved}) {
    EXPECT_EQ(quadratic(mesh).cells, mesh.cells);
    EXPECT_EQ(quadratic(mesh).nodes, mesh.nodes);
  }
}

TEST(Quadratic, TakesTheMiddleNodesOfNeighboursBentOrNot) {
  Mesh mesh = quadratic(two_tetrahedra());
  const int shared = mesh.cells[0].node[4];  // of the edge 0 1
  mesh.nodes(1, shared) -= 0.1;
  mesh.cells[1] = two_tetrahedra().cells[1];
  EXPECT_EQ(meeting_orders(mesh.cells), 1);
  const Mesh raised = quadratic(mesh);
  EXPECT_EQ(meeting_orders(raised.cells), 0);
  EXPECT_EQ(raised.nodes.cols(), mesh.nodes.cols() + 3);
  EXPECT_EQ(raised.cells[1].node[6], shared);  // its corners are 0 2 1 4
  EXPECT_EQ(raised.nodes.leftCols(mesh.nodes.cols()), mesh.nodes);
  EXPECT_EQ(boundary(raised.cells).size(), 6u);
  for (const CellFace& face : boundary(raised.cells)) EXPECT_EQ(face.count, 6);
}

TEST(Quadratic, CountsTetrahedraThatMeetAnyOfTenNodesAlongAnEdge) {
  const Mesh linear = test::block_mesh(4, 1, 1, kSize);
  EXPECT_EQ(meeting_orders(linear.cells), 0);
  const Mesh mixed = test::half_quadratic(linear);
  int by_hand = 0;
  for (const Cell& cell : mixed.cells) {
    if (cell.kind != Kind::tet4) continue;
    int on_seam = 0;
    for (const int node : cell.nodes()) on_seam += std::abs(mixed.nodes(0, node) - 1.5) < 1e-12 ? 1 : 0;
    by_hand += on_seam >= 2 ? 1 : 0;
  }
  EXPECT_GT(by_hand, 2);
  EXPECT_EQ(meeting_orders(mixed.cells), by_hand);
}

TEST(Quadratic, GivesGroupsTheNodesOfTheirCellsAndFaces) {
  Mesh mesh = two_tetrahedra();
  mesh.groups["cell"] = {{1}, {}, {0, 1, 2, 4}};
  mesh.groups["face"] = {{}, {{3, {0, 1, 3}}}, {0, 1, 3}};
  mesh.groups["line"] = {{}, {}, {0, 3, 4}};  // of edges 3 0, 0 4
  mesh.groups["face and point"] = {{}, {{3, {0, 1, 3}}}, {0, 1, 2, 3}};
  mesh.groups["elsewhere"] = {{}, {{3, {1, 3, 4}}}, {1, 3, 4}};  // 3 4 is no edge
  const Mesh raised = quadratic(mesh);
  const auto middles = [&](const std::set<std::set<int>>& edges) {
    std::vector<int> nodes;
    for (int i = 5; i < raised.nodes.cols(); ++i) {
      for (const std::set<int>& ends : edges) {
        const Vec3 middle = 0.5 * (mesh.nodes.col(*ends.begin()) + mesh.nodes.col(*ends.rbegin()));
        if ((raised.nodes.col(i) - middle).norm() < 1e-12) nodes.push_back(i);
      }
    }
    return nodes;
  };
  const auto expect = [&](const char* name, std::vector<int> nodes, const std::set<std::set<int>>& edges) {
    for (const int middle : middles(edges)) nodes.push_back(middle);
    EXPECT_EQ(raised.groups.at(name).nodes, nodes) << name;
    EXPECT_EQ(raised.groups.at(name).cells, mesh.groups.at(name).cells) << name;
  };
  expect("cell", {0, 1, 2, 4}, {{0, 1}, {1, 2}, {0, 2}, {0, 4}, {1, 4}, {2, 4}});
  expect("face", {0, 1, 3}, {{0, 1}, {1, 3}, {0, 3}});
  expect("line", {0, 3, 4}, {{0, 3}, {0, 4}});
  expect("face and point", {0, 1, 2, 3}, {{0, 1}, {1, 3}, {0, 3}, {0, 2}, {1, 2}, {2, 3}});
  expect("elsewhere", {1, 3, 4}, {});
  const CellFace& face = raised.groups.at("face").faces[0];
  ASSERT_EQ(face.count, 6);
  for (std::size_t i = 0; i < 3; ++i) EXPECT_EQ(face.node[3 + i], middles({{face.node[i], face.node[(i + 1) % 3]}})[0]);
  EXPECT_EQ(raised.groups.at("elsewhere").faces, mesh.groups.at("elsewhere").faces);
}

TEST(Mismatch, FindsTrianglesOnTheFaceOfAHexahedron) {
  Mesh mesh = cube_and_roof();
  EXPECT_EQ(mismatched_faces(mesh.cells), (CellPair{0, 1}));
  EXPECT_EQ(mismatched_faces(quadratic(mesh).cells), (CellPair{0, 1}));
  mesh.cells.erase(mesh.cells.begin() + 1);  // one of them alone, on half of the face
  EXPECT_EQ(mismatched_faces(mesh.cells), (CellPair{0, 1}));
}

TEST(Mismatch, AcceptsHexahedraApartFromTetrahedraOrTouchingAtAnEdge) {
  const Mesh bricks = test::block_mesh(2, 1, 1, kSize, Kind::hex8), others = test::block_mesh(2, 1, 1, kSize);
  EXPECT_FALSE(mismatched_faces(bricks.cells));
  EXPECT_FALSE(mismatched_faces(others.cells));
  EXPECT_FALSE(mismatched_faces(test::together(bricks, others).cells));
  Mesh mesh = cube_and_roof();
  mesh.nodes.conservativeResize(3, 10);
  mesh.nodes.col(9) = Vec3(3, 0, 3);
  mesh.cells.resize(1);
  mesh.cells.push_back(cell(5, 7, 9, 8));
  EXPECT_FALSE(mismatched_faces(mesh.cells));
}

TEST(Mismatch, FindsEdgesWithTwoMiddles) {
  const Mesh one = quadratic(two_tetrahedra());
  EXPECT_FALSE(mismatched_edges(one.cells));
  Mesh two = one;
  two.nodes.conservativeResize(3, one.nodes.cols() + 1);
  two.nodes.rightCols(1) = one.nodes.col(one.cells[1].node[4]);
  two.cells[1].node[4] = static_cast<int>(one.nodes.cols());
  EXPECT_EQ(mismatched_edges(two.cells), (CellPair{0, 1}));
}

}  // namespace
}  // namespace sinew::solid
