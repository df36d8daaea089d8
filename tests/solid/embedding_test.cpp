#include "sinew/solid/embedding.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "solid/sample_elements.hpp"

namespace sinew::solid {
namespace {

const Mat3 kGradient{{0.2, -1.0, 0.5}, {2.0, 0.3, 0.1}, {0.4, 0.6, -0.8}};

/// One distorted element of each kind, side by side, 4 apart along x.
Mesh row_of_elements(double bump) {
  Mesh mesh;
  for (const Kind kind : kKinds) {
    const Eigen::Index first = mesh.nodes.cols();
    const double place = 4.0 * static_cast<double>(mesh.cells.size());
    mesh.nodes.conservativeResize(3, first + node_count(kind));
    mesh.nodes.rightCols(node_count(kind)) = distorted(kind, bump).colwise() + Vec3(place, 0, 0);
    mesh.cells.push_back(whole_cell(kind, static_cast<int>(first)));
  }
  return mesh;
}

/// Points in and around the elements of a row.
std::vector<Vec3> points_around(const Mesh& mesh, int count) {
  const Vec3 lower = mesh.nodes.rowwise().minCoeff(), upper = mesh.nodes.rowwise().maxCoeff();
  std::vector<Vec3> points = points_inside(Kind::hex8, count);
  for (Vec3& p : points) p = 0.5 * (lower + upper) + 0.6 * p.cwiseProduct(upper - lower);
  return points;
}

Eigen::Matrix3Xd bumps(Eigen::Index nodes, double size) {
  return Eigen::Matrix3Xd::NullaryExpr(3, nodes, [size](Eigen::Index i, Eigen::Index j) {
    return size * std::sin(2.3 * static_cast<double>((3 * j + i + 1) * (j + 2 * i + 1)));
  });
}

Eigen::Matrix3Xd corners_of_tetrahedron() { return reference_shape(Kind::tet4); }

TEST(Embedding, weights_sum_to_one_and_give_the_point_back_inside_and_outside) {
  for (const double bump : {0.0, 0.1}) {
    const Mesh mesh = row_of_elements(bump);
    int outer = 0;
    for (const Vec3& x : points_around(mesh, 300)) {
      const EmbeddedPoint point = embed(mesh.nodes, mesh.cells, x);
      ASSERT_GE(point.element, 0);
      ASSERT_EQ(point.weights.size(), node_count(mesh.cells[static_cast<std::size_t>(point.element)].kind));
      EXPECT_NEAR(point.weights.sum(), 1.0, 1e-12);
      EXPECT_LT((position(point, mesh.cells, mesh.nodes) - x).norm(), 1e-13);
      if (point.distance > 0.0) ++outer;
    }
    EXPECT_GT(outer, 100);
    EXPECT_LT(outer, 299);
  }
}

TEST(Embedding, follows_affine_deformations_exactly_inside_and_outside) {
  const Mesh mesh = row_of_elements(0.1);
  const auto map = [](const Vec3& x) -> Vec3 { return kGradient * x + Vec3(1, 2, 3); };
  Eigen::Matrix3Xd moved = mesh.nodes;
  for (Eigen::Index i = 0; i < moved.cols(); ++i) moved.col(i) = map(mesh.nodes.col(i));
  for (const Vec3& x : points_around(mesh, 300)) {
    const EmbeddedPoint point = embed(mesh.nodes, mesh.cells, x);
    EXPECT_LT((position(point, mesh.cells, moved) - map(x)).norm(), 1e-12);
  }
}

TEST(Embedding, finds_the_element_that_holds_the_point_in_a_mixed_mesh) {
  for (const double bump : {0.0, 0.1}) {
    const Mesh mesh = row_of_elements(bump);
    for (int e = 0; e < 3; ++e) {
      const Cell& cell = mesh.cells[static_cast<std::size_t>(e)];
      for (const Vec3& xi : points_inside(cell.kind, 50)) {
        const Vec3 x = cell_nodes(mesh.nodes, cell) * shape_functions(cell.kind, xi);
        const EmbeddedPoint point = embed(mesh.nodes, mesh.cells, x);
        EXPECT_EQ(point.element, e);
        EXPECT_EQ(point.distance, 0.0);
        EXPECT_LT((point.local - xi).norm(), 1e-10);
        EXPECT_LT((point.weights - shape_functions(cell.kind, xi)).norm(), 1e-10);
      }
    }
  }
}

TEST(Embedding, distance_is_zero_inside_and_that_of_the_nearest_point_outside) {
  const std::vector<Cell> one = {whole_cell(Kind::tet4)};
  const Eigen::Matrix3Xd corners = corners_of_tetrahedron(), ten = reference_shape(Kind::tet10);
  for (const auto& [rest, cells] :
       {std::pair(corners, one), std::pair(ten, std::vector<Cell>{whole_cell(Kind::tet10)})}) {
    EXPECT_EQ(embed(rest, cells, Vec3(0.2, 0.2, 0.2)).distance, 0.0);
    EXPECT_NEAR(embed(rest, cells, Vec3(0.2, 0.2, -0.5)).distance, 0.5, 1e-15);    // a face
    EXPECT_NEAR(embed(rest, cells, Vec3(0.5, -3.0, -4.0)).distance, 5.0, 1e-14);   // an edge
    EXPECT_NEAR(embed(rest, cells, Vec3(-2.0, -3.0, -6.0)).distance, 7.0, 1e-14);  // a corner
    EXPECT_NEAR(embed(rest, cells, Vec3(1.0, 1.0, 1.0)).distance, 2.0 / std::sqrt(3.0), 1e-14);
  }
  const Eigen::Matrix3Xd cube = reference_shape(Kind::hex8);
  const std::vector<Cell> brick = {whole_cell(Kind::hex8)};
  EXPECT_EQ(embed(cube, brick, Vec3(0.2, -0.9, 1.0)).distance, 0.0);
  EXPECT_NEAR(embed(cube, brick, Vec3(0.7, -0.3, 2.5)).distance, 1.5, 1e-14);
  EXPECT_NEAR(embed(cube, brick, Vec3(4.0, -0.3, 5.0)).distance, 5.0, 1e-14);
  EXPECT_NEAR(embed(cube, brick, Vec3(-3.0, -4.0, 7.0)).distance, 7.0, 1e-14);
}

TEST(Embedding, distance_from_a_frustum_is_that_from_its_plane_faces) {
  // A frustum: its top is half as wide, so that its sides are no parallelograms.
  Eigen::Matrix3Xd rest = reference_shape(Kind::hex8);
  rest.block(0, 4, 2, 4) *= 0.5;
  const std::vector<Cell> cells = {whole_cell(Kind::hex8)};
  EXPECT_NEAR(embed(rest, cells, Vec3(0.4, -0.1, 1.75)).distance, 0.75, 1e-14);
  const Vec3 outward = Vec3(4, 0, 1).normalized();  // of the side through (1, 0, -1) and (1/2, 0, 1)
  for (const double y : {-0.4, 0.3}) {
    EXPECT_NEAR(embed(rest, cells, Vec3(0.75, y, 0.0) + 0.2 * outward).distance, 0.2, 1e-14);
  }
}

TEST(Embedding, a_point_in_the_bulge_of_a_curved_element_is_inside) {
  Eigen::Matrix3Xd rest = reference_shape(Kind::tet10);
  for (const int middle : {4, 5, 6}) rest(2, middle) = -0.1;
  // The quadratic face reaches 4/9 . 3 . 0.1 at its centre, lower than any node.
  const double lowest = -0.4 / 3;
  const std::vector<Cell> cells = {whole_cell(Kind::tet10)};
  EXPECT_EQ(embed(rest, cells, Vec3(1.0 / 3, 1.0 / 3, lowest + 1e-3)).distance, 0.0);
  for (const double gap : {1e-6, 1e-3}) {
    const double distance = embed(rest, cells, Vec3(1.0 / 3, 1.0 / 3, lowest - gap)).distance;
    EXPECT_NEAR(distance, gap, 0.2 * gap);
  }
  // Also beside another element just below, nearer than any node of the curved one.
  Eigen::Matrix3Xd both(3, 14);
  both.leftCols(4) = (3.0 * corners_of_tetrahedron()).colwise() + Vec3(-0.5, -0.5, lowest - 3.01);
  both(2, 1) = both(2, 2) = both(2, 3) = lowest - 0.01;
  both.col(3).head<2>().setConstant(-0.5);
  both.rightCols(10) = rest;
  const EmbeddedPoint point =
      embed(both, {whole_cell(Kind::tet4), whole_cell(Kind::tet10, 4)}, Vec3(1.0 / 3, 1.0 / 3, lowest + 1e-3));
  EXPECT_EQ(point.element, 1);
  EXPECT_EQ(point.distance, 0.0);
}

TEST(Embedding, takes_the_nearest_element_as_a_search_of_all_does) {
  // Many distorted elements of all kinds that overlap or leave gaps, in no order.
  Mesh mesh;
  for (const Vec3& place : points_inside(Kind::hex8, 60, 11)) {
    const Kind kind = kKinds[mesh.cells.size() % 3];
    const Eigen::Index first = mesh.nodes.cols();
    mesh.nodes.conservativeResize(3, first + node_count(kind));
    mesh.nodes.rightCols(node_count(kind)) = distorted(kind, 0.1).colwise() + 6.0 * place;
    mesh.cells.push_back(whole_cell(kind, static_cast<int>(first)));
  }
  int outer = 0;
  for (const Vec3& x : points_around(mesh, 300)) {
    double nearest = 1e9;
    for (const Cell& cell : mesh.cells) nearest = std::min(nearest, embed(mesh.nodes, {cell}, x).distance);
    const EmbeddedPoint point = embed(mesh.nodes, mesh.cells, x);
    EXPECT_NEAR(point.distance, nearest, 1e-12);
    EXPECT_NEAR(embed(mesh.nodes, {mesh.cells[static_cast<std::size_t>(point.element)]}, x).distance, nearest, 1e-12);
    if (nearest > 0.0) ++outer;
  }
  EXPECT_GT(outer, 50);
  EXPECT_LT(outer, 290);
}

TEST(Embedding, of_elements_at_equal_distance_takes_the_one_that_extrapolates_least) {
  // Two bricks with their tops at z = 0, side by side, 10 and 1 deep.
  Eigen::Matrix3Xd rest(3, 16);
  rest.leftCols(8) = reference_shape(Kind::hex8);
  rest.rightCols(8) = reference_shape(Kind::hex8).colwise() + Vec3(2, 0, 0);
  for (int i = 0; i < 16; ++i) rest(2, i) = rest(2, i) > 0 ? 0.0 : i < 8 ? -10.0 : -1.0;
  const Cell deep = whole_cell(Kind::hex8, 0), shallow = whole_cell(Kind::hex8, 8);
  const Vec3 above(1.0, 0.3, 0.5);  // their common edge
  EXPECT_EQ(embed(rest, {deep, shallow}, above).element, 0);
  EXPECT_EQ(embed(rest, {shallow, deep}, above).element, 1);
  EXPECT_EQ(embed(rest, {deep, shallow}, Vec3(1.1, 0.3, 0.5)).element, 1);  // nearer to the shallow one
}

TEST(Embedding, positions_are_continuous_across_shared_faces) {
  // Two curved tetrahedra with a common face 1, 2, 3 and two hexahedra with a common, twisted one.
  Eigen::Matrix3Xd ten(3, 14);
  ten.leftCols(10) = distorted(Kind::tet10, 0.08);
  const Vec3 tip = 2.0 / 3.0 * (ten.col(1) + ten.col(2) + ten.col(3)) - ten.col(0);
  ten.col(10) = tip;
  for (int i = 0; i < 3; ++i) ten.col(11 + i) = 0.5 * (tip + ten.col(i + 1));
  const std::vector<Cell> curved = {whole_cell(Kind::tet10), {Kind::tet10, {1, 2, 3, 10, 5, 9, 8, 11, 12, 13}}};
  Eigen::Matrix3Xd eight(3, 12);
  eight.leftCols(8) = distorted(Kind::hex8, 0.08);
  for (int i = 0; i < 4; ++i) eight.col(8 + i) = eight.col(4 + i) + 1.5 * (eight.col(4 + i) - eight.col(i));
  const std::vector<Cell> twisted = {whole_cell(Kind::hex8), {Kind::hex8, {4, 5, 6, 7, 8, 9, 10, 11}}};

  for (const auto& [rest, cells] : {std::pair(ten, curved), std::pair(eight, twisted)}) {
    for (const Cell& cell : cells) ASSERT_GT(smallest_jacobian(rest, cell), 0.1);
    const Eigen::Matrix3Xd x = rest + bumps(rest.cols(), 0.3);
    const Kind kind = cells[0].kind;
    for (const Vec3& inner : points_inside(kind, 20)) {
      Vec3 on_face = inner / inner.sum(), across(1, 1, 1);
      if (kind == Kind::hex8) on_face = Vec3(inner[0], inner[1], 1.0), across = Vec3(0, 0, 1);
      const NodeVectors X = cell_nodes(rest, cells[0]);
      const Vec3 here = X * shape_functions(kind, on_face - 1e-7 * across),
                 there = X * shape_functions(kind, on_face + 1e-7 * across);
      const EmbeddedPoint one = embed(rest, cells, here), two = embed(rest, cells, there);
      EXPECT_EQ(one.element, 0);
      EXPECT_EQ(two.element, 1);
      EXPECT_EQ(one.distance + two.distance, 0.0);
      EXPECT_LT((position(one, cells, x) - position(two, cells, x)).norm(), 5e-6);
    }
  }
}

TEST(Embedding, positions_are_continuous_across_curved_outer_faces) {
  for (const Kind kind : kKinds) {
    const Eigen::Matrix3Xd rest = distorted(kind, 0.08), x = rest + bumps(rest.cols(), 0.3);
    const std::vector<Cell> cells = {whole_cell(kind)};
    for (const Vec3& inner : points_inside(kind, 20)) {
      Vec3 on_face = inner, across(0, 0, -1);
      on_face[2] = kind == Kind::hex8 ? -1.0 : 0.0;
      const EmbeddedPoint in = embed(rest, cells, rest * shape_functions(kind, on_face - 1e-7 * across)),
                          out = embed(rest, cells, rest * shape_functions(kind, on_face + 1e-7 * across));
      EXPECT_EQ(in.distance, 0.0);
      EXPECT_GT(out.distance, 0.0);
      EXPECT_LT(out.distance, 1e-6);
      EXPECT_LT((position(in, cells, x) - position(out, cells, x)).norm(), 5e-6) << name(kind);
    }
  }
}

TEST(Embedding, a_point_at_a_node_has_its_weight_alone) {
  const Mesh mesh = row_of_elements(0.1);
  for (Eigen::Index i = 0; i < mesh.nodes.cols(); ++i) {
    const EmbeddedPoint point = embed(mesh.nodes, mesh.cells, mesh.nodes.col(i));
    EXPECT_EQ(point.distance, 0.0);
    const std::span<const int> numbers = mesh.cells[static_cast<std::size_t>(point.element)].nodes();
    for (std::size_t n = 0; n < numbers.size(); ++n) EXPECT_NEAR(point.weights[n], numbers[n] == i ? 1.0 : 0.0, 1e-9);
  }
}

TEST(Embedding, in_no_cells_finds_none) { EXPECT_EQ(embed(corners_of_tetrahedron(), {}, Vec3(0, 0, 0)).element, -1); }

TEST(Gradients, of_linear_fields_are_exact_in_distorted_elements) {
  for (const Kind kind : kKinds) {
    const Eigen::Matrix3Xd rest = distorted(kind, 0.1), x = (kGradient * rest).colwise() + Vec3(1, 2, 3);
    for (const Vec3& xi : points_inside(kind, 10)) {
      const NodeVectors g = gradients(rest, whole_cell(kind), xi);
      EXPECT_LT((x * g.transpose() - kGradient).norm(), 1e-13) << name(kind);
      EXPECT_LT(g.rowwise().sum().norm(), 1e-13) << name(kind);
    }
  }
}

TEST(Gradients, are_the_derivatives_of_positions) {
  const Mesh mesh = row_of_elements(0.1);
  const Eigen::Matrix3Xd x = mesh.nodes + bumps(mesh.nodes.cols(), 0.3);
  const Vec3 e(0.6, -0.5, 0.4);
  const double step = 1e-6;
  for (const Cell& cell : mesh.cells) {
    for (const Vec3& xi : points_inside(cell.kind, 5)) {
      const Vec3 X = cell_nodes(mesh.nodes, cell) * shape_functions(cell.kind, xi);
      const auto moved = [&](double t) { return position(embed(mesh.nodes, mesh.cells, X + t * e), mesh.cells, x); };
      const EmbeddedPoint vector = embed_vector(mesh.nodes, mesh.cells, embed(mesh.nodes, mesh.cells, X), e);
      EXPECT_NEAR(vector.weights.sum(), 0.0, 1e-13);
      const Vec3 expected = (moved(step) - moved(-step)) / (2 * step), carried = position(vector, mesh.cells, x);
      EXPECT_GT((expected - e).norm(), 1e-2);
      EXPECT_LT((carried - expected).norm(), 1e-8) << name(cell.kind);
    }
  }
}

}  // namespace
}  // namespace sinew::solid
