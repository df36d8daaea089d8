#include "sinew/solid/element.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "solid/sample_elements.hpp"
#include "support/difference.hpp"

namespace sinew::solid {
namespace {

double power(double x, int n) { return n == 0 ? 1.0 : x * power(x, n - 1); }
double monomial(const Vec3& x, const std::array<int, 3>& n) {
  return power(x[0], n[0]) * power(x[1], n[1]) * power(x[2], n[2]);
}

/// Integrals over the unit simplex, n! m! k! / (n + m + k + dimension)!, and over [-1, 1].
double over_tetrahedron(const std::array<int, 3>& n) {
  return std::tgamma(n[0] + 1) * std::tgamma(n[1] + 1) * std::tgamma(n[2] + 1) / std::tgamma(n[0] + n[1] + n[2] + 4);
}
double over_triangle(int n, int m) { return std::tgamma(n + 1) * std::tgamma(m + 1) / std::tgamma(n + m + 3); }
double over_line(int n) { return n % 2 == 0 ? 2.0 / (n + 1) : 0.0; }

/// All exponents up to `most`: in total over tetrahedra, in each direction over hexahedra.
std::vector<std::array<int, 3>> exponents(Kind kind, int most) {
  std::vector<std::array<int, 3>> all;
  for (int i = 0; i <= most; ++i) {
    for (int j = 0; j <= most; ++j) {
      for (int k = 0; k <= most; ++k) {
        if (kind == Kind::hex8 || i + j + k <= most) all.push_back({i, j, k});
      }
    }
  }
  return all;
}

Mat3 slope(Kind kind, const NodeVectors& nodes, const Vec3& xi) { return nodes * shape_slopes(kind, xi).transpose(); }

double volume_of(Kind kind, const NodeVectors& nodes) { return volume(nodes, whole_cell(kind)); }

/// Nodes moved by a function of the reference shape.
template <class Map>
NodeVectors moved(Kind kind, const Map& map) {
  NodeVectors nodes = reference_shape(kind);
  for (Eigen::Index i = 0; i < nodes.cols(); ++i) nodes.col(i) = map(Vec3(nodes.col(i)));
  return nodes;
}

TEST(Element, shape_functions_are_one_at_their_node_and_zero_at_the_others) {
  for (const Kind kind : kKinds) {
    const NodeVectors nodes = reference_shape(kind);
    ASSERT_EQ(nodes.cols(), node_count(kind));
    ASSERT_EQ(reference_nodes(kind).size(), static_cast<std::size_t>(node_count(kind)));
    for (int i = 0; i < node_count(kind); ++i) {
      EXPECT_EQ(reference_nodes(kind)[i], nodes.col(i));
      EXPECT_EQ(shape_functions(kind, nodes.col(i)), Eigen::VectorXd::Unit(node_count(kind), i)) << name(kind) << i;
    }
  }
}

TEST(Element, shape_functions_sum_to_one_and_slopes_to_zero_inside_and_outside) {
  for (const Kind kind : kKinds) {
    for (const Vec3& inner : points_inside(kind, 5)) {
      for (const Vec3& xi : {inner, Vec3(3.0 * inner - Vec3::Ones())}) {
        EXPECT_NEAR(shape_functions(kind, xi).sum(), 1.0, 1e-13);
        EXPECT_LT(shape_slopes(kind, xi).rowwise().sum().norm(), 1e-13);
      }
    }
  }
}

TEST(Element, slopes_are_the_derivatives_of_the_shape_functions) {
  for (const Kind kind : kKinds) {
    for (const Vec3& xi : points_inside(kind, 5)) {
      const auto functions = [kind](const Eigen::VectorXd& at) -> Eigen::VectorXd { return shape_functions(kind, at); };
      const Eigen::MatrixXd expected = test::difference(functions, xi, 1e-4);  // exact to rounding: N are quadratic
      EXPECT_GT(expected.norm(), 0.5);
      EXPECT_LT((shape_slopes(kind, xi).transpose() - expected).norm(), 1e-10) << name(kind);
    }
  }
}

TEST(Element, every_kind_reproduces_the_polynomials_it_is_made_of) {
  for (const Kind kind : kKinds) {
    const NodeVectors nodes = reference_shape(kind);
    const auto fields = exponents(kind, kind == Kind::tet10 ? 2 : 1);
    EXPECT_EQ(fields.size(), static_cast<std::size_t>(node_count(kind)));  // no more, no fewer than nodes
    for (const auto& n : fields) {
      NodeValues values(node_count(kind));
      for (int i = 0; i < node_count(kind); ++i) values[i] = monomial(nodes.col(i), n);
      for (const Vec3& inner : points_inside(kind, 4)) {
        const Vec3 xi = 2.0 * inner - Vec3(0.5, 0.2, 0.9);
        EXPECT_NEAR(shape_functions(kind, xi).dot(values), monomial(xi, n), 1e-13) << name(kind);
      }
    }
  }
}

TEST(Element, a_linear_field_has_its_gradient_everywhere_in_distorted_elements) {
  const Mat3 A{{0.2, -1.0, 0.5}, {2.0, 0.3, 0.1}, {0.4, 0.6, -0.8}};
  for (const Kind kind : kKinds) {
    const NodeVectors X = distorted(kind, 0.1), x = (A * X).colwise() + Vec3(1, 2, 3);
    for (const Vec3& xi : points_inside(kind, 10)) {
      const Mat3 F = slope(kind, x, xi) * slope(kind, X, xi).inverse();
      EXPECT_LT((F - A).norm(), 1e-13) << name(kind);
    }
  }
}

TEST(Element, quadratures_integrate_monomials_to_their_degree) {
  const int stiffness_degree[] = {1, 2, 3}, mass_degree[] = {2, 5, 5};
  const std::size_t stiffness_points[] = {1, 4, 8}, mass_points[] = {4, 14, 27};
  for (const Kind kind : kKinds) {
    const int k = static_cast<int>(kind);
    EXPECT_EQ(quadrature(kind).size(), stiffness_points[k]);
    EXPECT_EQ(mass_quadrature(kind).size(), mass_points[k]);
    const auto check = [&](std::span<const GaussPoint> points, int degree) {
      for (const auto& n : exponents(kind, degree)) {
        const double exact =
            kind == Kind::hex8 ? over_line(n[0]) * over_line(n[1]) * over_line(n[2]) : over_tetrahedron(n);
        double sum = 0.0;
        for (const GaussPoint& point : points) sum += point.weight * monomial(point.xi, n);
        EXPECT_NEAR(sum, exact, 1e-15 * (kind == Kind::hex8 ? 8 : 1)) << name(kind) << n[0] << n[1] << n[2];
      }
      for (const GaussPoint& point : points) {
        EXPECT_GT(point.weight, 0.0);
        EXPECT_EQ(outside(kind, point.xi), 0.0);
      }
    };
    check(quadrature(kind), stiffness_degree[k]);
    check(mass_quadrature(kind), mass_degree[k]);
  }
}

TEST(Element, volume_of_a_straight_element_is_that_of_its_edges) {
  const Mat3 A{{2.0, 0.3, -0.2}, {-0.2, 1.1, 0.4}, {0.1, -0.3, 0.8}};
  for (const Kind kind : kKinds) {
    const double reference = kind == Kind::hex8 ? 8.0 : 1.0 / 6.0;
    const auto affine = [&](const Vec3& x) -> Vec3 { return A * x + Vec3(4, 5, 6); };
    EXPECT_NEAR(volume_of(kind, moved(kind, affine)), reference * A.determinant(), 1e-13 * reference);
    const auto mirrored = [&](const Vec3& x) -> Vec3 { return -affine(x); };
    EXPECT_NEAR(volume_of(kind, moved(kind, mirrored)), -reference * A.determinant(), 1e-13 * reference);
  }
}

TEST(Element, volume_of_a_curved_tetrahedron_is_exact) {
  // Each coordinate times (1 + c x): dX/dxi is triangular, its determinant (1 + 2 a x)(1 + b x)(1 + c x), and the
  // integral of x^k over the unit simplex k! / (k + 3)!.
  const double a = 0.4, b = -0.3, c = 0.7;
  const auto map = [&](const Vec3& x) {
    return Vec3(x[0] * (1 + a * x[0]), x[1] * (1 + b * x[0]), x[2] * (1 + c * x[0]));
  };
  const double exact = 1.0 / 6 + (2 * a + b + c) / 24 + (2 * a * b + 2 * a * c + b * c) / 60 + 2 * a * b * c / 120;
  EXPECT_GT(std::abs(exact - 1.0 / 6), 0.01);
  EXPECT_NEAR(volume_of(Kind::tet10, moved(Kind::tet10, map)), exact, 1e-15);
}

TEST(Element, volume_of_a_curved_tetrahedron_agrees_with_fine_sums) {
  const NodeVectors X = distorted(Kind::tet10, 0.1);
  // Cubes of side 1/n map the simplex by (u, v (1 - u), w (1 - u)(1 - v)); the midpoint rule and one extrapolation.
  const auto sum = [&](int n) {
    double total = 0.0;
    for (int i = 0; i < n * n * n; ++i) {
      const double u = (i % n + 0.5) / n, v = (i / n % n + 0.5) / n, w = (i / n / n + 0.5) / n;
      const Vec3 xi(u, v * (1 - u), w * (1 - u) * (1 - v));
      total += slope(Kind::tet10, X, xi).determinant() * (1 - u) * (1 - u) * (1 - v) / (n * n * n);
    }
    return total;
  };
  EXPECT_NEAR(volume_of(Kind::tet10, X), (4.0 * sum(40) - sum(20)) / 3.0, 1e-7);
}

TEST(Element, volume_of_a_twisted_hexahedron_is_exact) {
  // A cube of side 2 whose top is turned by the angle: at height t the section is the square by (1 - t) I + t R, with
  // determinant (1 - t)^2 + 2 t (1 - t) cos + t^2.
  const double angle = 0.9;
  const auto twist = [&](const Vec3& x) {
    const double turn = x[2] > 0 ? angle : 0.0;
    return Vec3(std::cos(turn) * x[0] - std::sin(turn) * x[1], std::sin(turn) * x[0] + std::cos(turn) * x[1], x[2]);
  };
  EXPECT_NEAR(volume_of(Kind::hex8, moved(Kind::hex8, twist)), 8.0 * (2.0 + std::cos(angle)) / 3.0, 1e-14);
}

TEST(Element, integral_of_position_over_the_faces_is_three_volumes) {
  for (const Kind kind : kKinds) {
    const NodeVectors X = distorted(kind, 0.1);
    double flux = 0.0;
    Vec3 area = Vec3::Zero();
    for (const Face& face : faces(kind)) {
      Eigen::Matrix3Xd own(3, face.nodes);
      for (int i = 0; i < face.nodes; ++i) own.col(i) = X.col(face.node[i]);
      double outward = 0.0;
      for (const FacePoint& point : face_quadrature(face)) {
        const Vec3 x = own * face_functions(face, point.xi);
        const Eigen::Matrix<double, 3, 2> tangents = own * face_slopes(face, point.xi).transpose();
        const Vec3 normal = point.weight * tangents.col(0).cross(tangents.col(1));
        outward += normal.dot(x - X.rowwise().mean());
        flux += normal.dot(x);
        area += normal;
      }
      EXPECT_GT(outward, 0.0) << name(kind);
    }
    EXPECT_LT(area.norm(), 1e-13) << name(kind);
    EXPECT_NEAR(flux, 3.0 * volume_of(kind, X), 1e-12) << name(kind);
  }
}

TEST(Element, faces_have_the_shape_of_the_element) {
  for (const Kind kind : kKinds) {
    const NodeVectors reference = reference_shape(kind);
    for (const Face& face : faces(kind)) {
      EXPECT_EQ(face.corners, kind == Kind::hex8 ? 4 : 3);
      for (const Eigen::Vector2d& at : {Eigen::Vector2d(0.2, 0.5), Eigen::Vector2d(-0.4, 0.9)}) {
        const FaceValues N = face_functions(face, at);
        Vec3 xi = Vec3::Zero();  // flat in the reference element, so that this is where the face has its values
        for (int i = 0; i < face.nodes; ++i) xi += N[i] * reference.col(face.node[i]);
        NodeValues expected = shape_functions(kind, xi);
        for (int i = 0; i < face.nodes; ++i) {
          EXPECT_NEAR(expected[face.node[i]], N[i], 1e-14) << name(kind);
          expected[face.node[i]] = 0.0;
        }
        EXPECT_LT(expected.norm(), 1e-14) << name(kind);  // no other node moves the face
      }
    }
  }
}

TEST(Element, slopes_of_faces_are_the_derivatives_of_their_functions) {
  for (const Kind kind : kKinds) {
    const Face face = faces(kind)[1];
    const auto functions = [&face](const Eigen::VectorXd& at) -> Eigen::VectorXd { return face_functions(face, at); };
    const Eigen::Vector2d at(0.2, 0.5);
    EXPECT_LT((face_slopes(face, at).transpose() - test::difference(functions, at, 1e-4)).norm(), 1e-10);
  }
}

TEST(Element, face_quadratures_integrate_monomials_to_their_degree) {
  const int degree[] = {1, 4, 3};
  for (const Kind kind : kKinds) {
    const int most = degree[static_cast<int>(kind)];
    for (const auto& [n, m, unused] : exponents(kind, most)) {
      if (unused > 0) continue;
      double sum = 0.0;
      for (const FacePoint& point : face_quadrature(faces(kind)[0])) {
        sum += point.weight * power(point.xi[0], n) * power(point.xi[1], m);
      }
      EXPECT_NEAR(sum, kind == Kind::hex8 ? over_line(n) * over_line(m) : over_triangle(n, m), 2e-15) << name(kind);
    }
  }
}

TEST(Element, triangles_of_a_face_cover_it_and_turn_as_it_does) {
  const Eigen::Matrix<double, 2, 6> triangle{{0, 1, 0, 0.5, 0.5, 0}, {0, 0, 1, 0, 0.5, 0.5}};
  const Eigen::Matrix<double, 2, 4> square{{-1, 1, 1, -1}, {-1, -1, 1, 1}};
  for (const int nodes : {3, 4, 6}) {
    double area = 0.0;
    for (const auto& [a, b, c] : face_triangles(nodes)) {
      Eigen::Matrix2d edges;
      if (nodes == 4) {
        edges << square.col(b) - square.col(a), square.col(c) - square.col(a);
      } else {
        edges << triangle.col(b) - triangle.col(a), triangle.col(c) - triangle.col(a);
      }
      EXPECT_GT(edges.determinant(), 0.0);
      area += 0.5 * edges.determinant();
    }
    EXPECT_DOUBLE_EQ(area, nodes == 4 ? 4.0 : 0.5);
  }
}

TEST(Element, local_coordinates_undo_the_map_inside_and_nearby_outside) {
  for (const Kind kind : kKinds) {
    const Vec3 centre = reference_shape(kind).rowwise().mean();
    for (const double bump : {0.0, 0.05, 0.1}) {
      const NodeVectors X = distorted(kind, bump);
      for (const Vec3& inner : points_inside(kind, 50)) {
        for (const double from_centre : {1.0, 1.5}) {
          const Vec3 xi = centre + from_centre * (inner - centre);
          if (slope(kind, X, xi).determinant() < 0.1) continue;  // where the map is about to fold there may be two
          const auto found = local_coordinates(kind, X, X * shape_functions(kind, xi));
          ASSERT_TRUE(found) << name(kind) << bump << xi.transpose();
          EXPECT_LT((*found - xi).norm(), 1e-12) << name(kind) << bump;
        }
      }
    }
  }
}

TEST(Element, local_coordinates_of_affine_elements_reach_anywhere) {
  for (const Kind kind : kKinds) {
    const NodeVectors X = distorted(kind, 0.0);
    const Vec3 far(30.0, -70.0, 50.0);
    const auto found = local_coordinates(kind, X, X * shape_functions(kind, far));
    ASSERT_TRUE(found);
    EXPECT_LT((*found - far).norm(), 1e-10);
  }
}

TEST(Element, local_coordinates_are_right_or_none_far_outside) {
  int none = 0;
  for (const Kind kind : {Kind::tet10, Kind::hex8}) {
    const NodeVectors X = distorted(kind, 0.1);
    for (const Vec3& direction : points_inside(Kind::hex8, 200)) {
      const Vec3 x = Vec3(X.rowwise().mean()) + 8.0 * direction;
      const auto found = local_coordinates(kind, X, x);
      if (!found) {
        ++none;
      } else {
        EXPECT_LT((X * shape_functions(kind, *found) - x).norm(), 1e-10);
        EXPECT_GT(slope(kind, X, *found).determinant(), 0.0);
      }
    }
  }
  EXPECT_GT(none, 0);
  EXPECT_LT(none, 300);
}

TEST(Element, local_coordinates_of_a_flat_element_are_none) {
  for (const Kind kind : kKinds) {
    NodeVectors X = reference_shape(kind);
    X.row(2).setZero();
    EXPECT_FALSE(local_coordinates(kind, X, Vec3(0.2, 0.3, 0.1)));
  }
}

TEST(Element, outside_is_the_largest_violation_of_a_bound) {
  for (const Kind kind : {Kind::tet4, Kind::tet10}) {
    EXPECT_EQ(outside(kind, {0.2, 0.3, 0.4}), 0.0);
    EXPECT_EQ(outside(kind, {-0.25, 0.3, -0.1}), 0.25);
    EXPECT_EQ(outside(kind, {0.5, 0.5, 0.25}), 0.25);
  }
  EXPECT_EQ(outside(Kind::hex8, {1.0, -1.0, 0.3}), 0.0);
  EXPECT_EQ(outside(Kind::hex8, {1.25, -1.5, 0.0}), 0.5);
}

}  // namespace
}  // namespace sinew::solid
