#include "sinew/contact/mesh.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "sinew/contact/shape.hpp"

namespace sinew::contact {
namespace {

std::vector<std::array<int, 3>> triangles_of(const Polyhedron& body) {
  std::vector<std::array<int, 3>> all;
  for (const std::vector<int>& face : body.faces) {
    for (std::size_t i = 1; i + 1 < face.size(); ++i) all.push_back({face[0], face[i], face[i + 1]});
  }
  return all;
}

Eigen::Matrix3Xd points_of(const Polyhedron& body) {
  Eigen::Matrix3Xd points(3, static_cast<Eigen::Index>(body.corners.size()));
  for (std::size_t i = 0; i < body.corners.size(); ++i) points.col(static_cast<Eigen::Index>(i)) = body.corners[i];
  return points;
}

TEST(Mesh, KnowsItsEdgesAndWhatItEncloses) {
  const Polyhedron body = prism(0.7, 1.3, 7);
  const Mesh mesh = make_mesh(points_of(body), triangles_of(body));
  EXPECT_EQ(mesh.used.size(), 14U);
  EXPECT_EQ(mesh.ridges.size(), 14U + mesh.triangles.size() - 2);  // Euler
  for (const Ridge& ridge : mesh.ridges) EXPECT_NE(ridge.sides[0], ridge.sides[1]);
  const Bulk one = bulk(mesh), other = bulk(Convex{body});
  EXPECT_NEAR(one.volume, other.volume, 1e-14);
  EXPECT_NEAR((one.inertia - other.inertia).norm(), 0.0, 1e-14);
  EXPECT_NEAR((reach(mesh, Eigen::Matrix3d::Identity()) - reach(Convex{body}, Eigen::Matrix3d::Identity())).norm(), 0.0,
              1e-15);
}

/// A wedge of 20 degrees, its triangles uneven: what is nearest to a point may be its blade, and the sign of the
/// distance is that of outside all the same.
TEST(Mesh, TellsInsideFromOutsideAtASharpEdge) {
  const double half = std::tan(10.0 * M_PI / 180.0);
  const std::vector<Vec3> corners = {{-1, 0, 0},     {1, 0, 0},      {-1, -half, -1},
                                     {1, -half, -1}, {-1, half, -1}, {1, half, -1}};
  Eigen::Matrix3Xd points(3, 6);
  for (int i = 0; i < 6; ++i) points.col(i) = corners[i];
  const Mesh mesh =
      make_mesh(points, {{0, 2, 1}, {1, 2, 3}, {0, 1, 4}, {1, 5, 4}, {0, 4, 2}, {1, 3, 5}, {2, 4, 3}, {3, 4, 5}});
  ASSERT_EQ(open_edges(mesh.triangles), 0);
  ASSERT_GT(bulk(mesh).volume, 0.0);
  Outward outward;
  find_outward(mesh, mesh.points, outward);
  std::mt19937 engine(7);
  std::uniform_real_distribution<double> range(-1.3, 1.3);
  int in = 0;
  for (int i = 0; i < 4000; ++i) {
    const Vec3 p(range(engine), 0.4 * range(engine), range(engine));
    double least = INFINITY, sign = 0.0;
    for (std::size_t f = 0; f < mesh.triangles.size(); ++f) {
      const std::array<int, 3>& t = mesh.triangles[f];
      const auto weights = on_triangle(p, points.col(t[0]), points.col(t[1]), points.col(t[2]));
      const Vec3 d = p - weights[0] * points.col(t[0]) - weights[1] * points.col(t[1]) - weights[2] * points.col(t[2]);
      if (d.norm() >= least) continue;
      least = d.norm();
      sign = d.dot(outward_at(mesh, outward, static_cast<int>(f), weights));
    }
    const bool inside_it = p.z() < 0.0 && p.z() > -1.0 && std::abs(p.y()) < -half * p.z() && std::abs(p.x()) < 1.0;
    EXPECT_EQ(inside(mesh, mesh.points, mesh.faces, p), inside_it) << p.transpose();
    EXPECT_EQ(sign < 0.0, inside_it) << p.transpose();
    in += inside_it ? 1 : 0;
  }
  EXPECT_GT(in, 100);
}

TEST(Mesh, TellsWhereItIsNotClosed) {
  const Polyhedron body = box(Vec3::Ones());
  std::vector<std::array<int, 3>> triangles = triangles_of(body);
  EXPECT_EQ(open_edges(triangles), 0);
  std::swap(triangles[3][0], triangles[3][1]);
  EXPECT_EQ(open_edges(triangles), 3);  // turned over
  triangles.erase(triangles.begin() + 3);
  EXPECT_EQ(open_edges(triangles), 3);  // a hole
  triangles.push_back(triangles[0]);
  EXPECT_EQ(open_edges(triangles), 6);  // twice there
}

}  // namespace
}  // namespace sinew::contact
