// How fast errors fall when a mesh is refined, element by element.
#include <iostream>

#include "validation/solids.hpp"

namespace sinew::test {
namespace {

using solid::Kind;

constexpr double kYoung = 1e6, kSmall = 1e-7;  // strains so small that everything is linear

/// A closed solution, and n cells along each edge of where it lives, all of one shape whatever n is.
struct Problem {
  std::function<std::pair<Vec3, solid::Mat3>(double poisson, const Vec3&)> exact;  ///< u and du/dX
  std::function<solid::Mesh(Kind, int n)> mesh;
  std::function<void(Scene&, const solid::Mesh&, int n)> load;
};

/// Lame's thick-walled cylinder, 1 <= r <= 2, a quarter of it in plane strain: u = (A r + B / r) e_r. Its dilatation is
/// the same everywhere.
const Problem kCylinder = {
    [](double poisson, const Vec3& X) -> std::pair<Vec3, solid::Mat3> {
      const double A = (1 + poisson) * kSmall / 3 * (1 - 2 * poisson), B = (1 + poisson) * kSmall / 3 * 4;
      const Vec3 r(X.x(), X.y(), 0.0);
      const double r2 = r.squaredNorm();
      const solid::Mat3 across = Vec3(1, 1, 0).asDiagonal();
      return {(A + B / r2) * r, (A + B / r2) * across - 2 * B / (r2 * r2) * r * r.transpose()};
    },
    [](Kind kind, int n) {
      return mapped_block(kind, n, n, 1, [n](const Vec3& x) {
        const double r = 1 + x.x(), angle = 0.5 * pi * x.y();
        return Vec3(r * std::cos(angle), r * std::sin(angle), x.z() / n);
      });
    },
    [](Scene& scene, const solid::Mesh& mesh, int n) {
      hold(scene, plane(Vec3::Zero(), Vec3::UnitY()), {false, true, false});
      hold(scene, plane(Vec3::Zero(), Vec3::UnitX()), {true, false, false});
      hold(scene, plane(Vec3::Zero(), Vec3::UnitZ()), {false, false, true});
      hold(scene, plane(Vec3(0, 0, 1.0 / n), Vec3::UnitZ()), {false, false, true});
      load_solid(scene, nodes_where(mesh, [](const Vec3& x) { return x.head<2>().norm() < 1 + 1e-6; }), Vec3::Zero(),
                 kSmall * kYoung);
    }};

/// A column between smooth walls under its weight, in curved cells: u = (x - x^2 / 2) e_x. Its dilatation varies.
const Problem kColumn = {[](double poisson, const Vec3& X) -> std::pair<Vec3, solid::Mat3> {
                           const double most = kSmall * (1 + poisson) * (1 - 2 * poisson) / (1 - poisson);
                           solid::Mat3 gradient = solid::Mat3::Zero();
                           gradient(0, 0) = most * (1 - X.x());
                           return {most * (X.x() - 0.5 * X.x() * X.x()) * Vec3::UnitX(), gradient};
                         },
                         [](Kind kind, int n) {
                           return mapped_block(kind, n, n, 1, [n](const Vec3& x) {
                             return Vec3(x.x() + 0.4 * x.x() * (1 - x.x()) * (x.y() + 0.2),
                                         x.y() + 0.3 * x.y() * (1 - x.y()) * x.x(), x.z() / n);
                           });
                         },
                         [](Scene& scene, const solid::Mesh&, int n) {
                           hold(scene, plane(Vec3::Zero(), Vec3::UnitX()));
                           for (const double y : {0.0, 1.0})
                             hold(scene, plane(Vec3(0, y, 0), Vec3::UnitY()), {false, true, false});
                           for (const double z : {0.0, 1.0 / n})
                             hold(scene, plane(Vec3(0, 0, z), Vec3::UnitZ()), {false, false, true});
                           scene.gravity = kSmall * kYoung / *scene.solids[0].second.density * Vec3::UnitX();
                         }};

/// Relative errors in the mean square over the volume.
struct Errors {
  double displacement = 0.0, gradient = 0.0;
};

Errors errors(const Problem& problem, Kind kind, double poisson, int n) {
  const solid::Mesh mesh = problem.mesh(kind, n);
  Scene scene = solid_scene(solid::neo_hookean(kYoung, poisson));
  problem.load(scene, mesh, n);
  const SolvedSolid solved = solve(scene, mesh);
  const solid::Body& body = solved.model.solids[0].body;
  const Eigen::Matrix3Xd moved = solved.end().solids[0].x - body.rest;
  Errors off, all;
  for (int e = 0; e < body.elements(); ++e) {
    const solid::NodeVectors X = body.at_nodes(e, body.rest), u = body.at_nodes(e, moved);
    for (const solid::GaussPoint& point : solid::mass_quadrature(kind)) {
      const solid::NodeVectors slopes = solid::shape_slopes(kind, point.xi);
      const solid::NodeValues N = solid::shape_functions(kind, point.xi);
      const solid::Mat3 J = X * slopes.transpose();
      const auto [there, gradient] = problem.exact(poisson, X * N);
      const double weight = point.weight * J.determinant();
      off.displacement += weight * (u * N - there).squaredNorm();
      off.gradient += weight * (u * slopes.transpose() * J.inverse() - gradient).squaredNorm();
      all.displacement += weight * there.squaredNorm();
      all.gradient += weight * gradient.squaredNorm();
    }
  }
  return {std::sqrt(off.displacement / all.displacement), std::sqrt(off.gradient / all.gradient)};
}

struct Expected {
  const char* name;
  const Problem& problem;
  Kind kind;
  double poisson;
  int cells;  ///< of the coarsest mesh, in each direction
  double displacement, gradient;
};

void PrintTo(const Expected& own, std::ostream* out) { *out << own.name; }

class SolidOrders : public testing::TestWithParam<Expected> {};

/// Linear shapes: displacement 2, gradient 1. Quadratic ones: 3 and 2 where the dilatation is constant or enters
/// pointwise; its mean over an element is as good as a linear shape.
TEST_P(SolidOrders, errors_fall_as_the_elements_promise) {
  const Expected& own = GetParam();
  Errors coarse = errors(own.problem, own.kind, own.poisson, own.cells), order;
  for (const int n : {2 * own.cells, 4 * own.cells}) {
    const Errors fine = errors(own.problem, own.kind, own.poisson, n);
    order = {std::log2(coarse.displacement / fine.displacement), std::log2(coarse.gradient / fine.gradient)};
    std::cout << n << " cells: displacement " << fine.displacement << " (order " << order.displacement << "), gradient "
              << fine.gradient << " (order " << order.gradient << ")\n";
    coarse = fine;
  }
  EXPECT_GT(order.displacement, own.displacement - 0.2);
  EXPECT_GT(order.gradient, own.gradient - 0.2);
  EXPECT_LT(coarse.displacement, 1e-2);
}

INSTANTIATE_TEST_SUITE_P(Solid, SolidOrders,
                         testing::Values(Expected{"cylinder_tet4", kCylinder, Kind::tet4, 0.3, 4, 2, 1},
                                         Expected{"cylinder_hex8", kCylinder, Kind::hex8, 0.3, 4, 2, 1},
                                         Expected{"cylinder_tet10", kCylinder, Kind::tet10, 0.3, 2, 3, 2},
                                         Expected{"incompressible_hex8", kCylinder, Kind::hex8, 0.4999, 4, 2, 1},
                                         Expected{"incompressible_tet10", kCylinder, Kind::tet10, 0.4999, 2, 2, 1},
                                         Expected{"column_tet4", kColumn, Kind::tet4, 0.3, 4, 2, 1},
                                         Expected{"column_hex8", kColumn, Kind::hex8, 0.3, 4, 2, 1},
                                         Expected{"column_tet10", kColumn, Kind::tet10, 0.3, 2, 3, 2}),
                         [](const auto& test) { return test.param.name; });

}  // namespace
}  // namespace sinew::test
