// Large flat parts of rigid meshes: sheets, and feet of many points.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>

#include "sinew/error/input_error.hpp"
#include "support/surfaces.hpp"

namespace sinew {
namespace {

using test::box_of;
using test::box_surface;
using test::end_of;
using test::kGravity;
using test::mesh_of;
using test::mm;
using test::named;
using test::obstacle;
using test::on_floor;
using test::reader;

/// Many points of a foot carry as its corners do: a box of many triangles slides, tips and rests as one of twelve.
TEST(MeshFoot, OfAFootOfManyPointsTheCornersCarry) {
  const double size = 50 * mm;
  const auto fine_box = [&](int n) {  // squares an edge
    solid::Mesh mesh;
    std::map<std::array<int, 3>, int> number;
    std::vector<Vec3> points;
    const auto at = [&](int i, int j, int k) {
      const auto [entry, fresh] = number.try_emplace({i, j, k}, static_cast<int>(points.size()));
      if (fresh) points.emplace_back(size / n * Vec3(i, j, k) - Vec3::Constant(0.5 * size));
      return entry->second;
    };
    for (int i = 0; i < n; ++i)
      for (int j = 0; j < n; ++j)
        for (int axis = 0; axis < 3; ++axis)
          for (const bool upper : {false, true}) {
            const auto corner = [&](int a, int b) {
              std::array<int, 3> own{};
              own[(axis + 1) % 3] = a, own[(axis + 2) % 3] = b, own[axis] = upper ? n : 0;
              return at(own[0], own[1], own[2]);
            };
            const int p = corner(i, j), q = corner(i + 1, j), r = corner(i + 1, j + 1), s = corner(i, j + 1);
            for (solid::Triangle t : {solid::Triangle{p, q, r}, solid::Triangle{p, r, s}}) {
              if (!upper) std::swap(t[1], t[2]);
              mesh.faces.push_back(t);
            }
          }
    mesh.nodes.resize(3, std::ssize(points));
    for (std::size_t k = 0; k < points.size(); ++k) mesh.nodes.col(static_cast<Eigen::Index>(k)) = points[k];
    return mesh;
  };
  for (const double degrees : {0.0, 25.0, 50.0}) {  // it rests, slides, tips and rolls
    const double angle = degrees * std::numbers::pi / 180.0;
    std::vector<State> ends;
    for (const int n : {1, 16}) {
      Scene scene = on_floor(0.002, 0.2, degrees < 40.0 ? 0.2 : 1.3);
      scene.gravity = kGravity * Vec3(std::sin(angle), 0, -std::cos(angle));
      scene.bodies.emplace_back("block", box_of(size, 0.1, Vec3(0, 0, 0.5 * size)));
      scene.bodies[0].second.shape = mesh_of("part.obj");
      const Model model =
          build(scene, reader(named({{"part.obj", n == 1 ? box_surface(Vec3::Constant(size)) : fine_box(n)}})));
      double gained = 0.0;
      ends.push_back(end_of(model, &gained));
      EXPECT_LE(gained, 1e-9) << degrees;
      EXPECT_LE(ends.back().contacts.size(), static_cast<std::size_t>(degrees < 40.0 ? 4 : 60)) << degrees;
    }
    EXPECT_NEAR((ends[1].bodies[0].p - ends[0].bodies[0].p).norm(), 0.0, 1e-9) << degrees;
    EXPECT_NEAR((ends[1].bodies[0].R - ends[0].bodies[0].R).norm(), 0.0, 1e-8) << degrees;
  }
}

/// A square of two triangles in the plane z = 0, one of them turned over.
solid::Mesh square_sheet(double size) {
  solid::Mesh sheet;
  sheet.nodes.resize(3, 4);
  sheet.nodes << 0, size, size, 0, 0, 0, size, size, 0, 0, 0, 0;
  sheet.nodes.topRows<2>().array() -= 0.5 * size;
  sheet.faces = {{0, 1, 2}, {0, 3, 2}};
  return sheet;
}

TEST(Sheet, StopsWhatComesFromEitherSide) {
  const double thickness = 0.5 * mm;
  const std::vector<std::pair<BodyShape, double>> shapes = {{SphereShape{3 * mm}, 3 * mm},
                                                            {BoxShape{Vec3::Constant(8 * mm)}, 4 * mm},
                                                            {CylinderShape{4 * mm, 6 * mm}, 3 * mm},
                                                            {CapsuleShape{2 * mm, 6 * mm}, 5 * mm},
                                                            {mesh_of("cube.obj"), 3 * mm}};
  const solid::Mesh cube = box_surface(Vec3::Constant(6 * mm));
  for (const auto& [shape, half] : shapes) {
    for (const double side : {1.0, -1.0}) {
      for (const double speed : {0.2, 3.0}) {
        Scene scene = on_floor(0.002, 0.2, 0.0);
        scene.gravity = Vec3::Zero();
        scene.obstacles.clear();
        Obstacle sheet = obstacle(mesh_of("sheet.obj"), Vec3::Zero());
        std::get<MeshShape>(sheet.shape).thickness = thickness;
        scene.obstacles.emplace_back("sheet", sheet);
        RigidBody body = box_of(1.0, 0.01, side * 20 * mm * Vec3(0.1, 0.2, 1.0));
        body.shape = shape;
        body.velocity = Vec3(0, 0, -side * speed);
        scene.bodies.emplace_back("body", body);
        const Model model = build(scene, reader(named({{"sheet.obj", square_sheet(100 * mm)}, {"cube.obj", cube}})));
        const State end = end_of(model);
        EXPECT_NEAR(side * end.bodies[0].p.z(), 0.5 * thickness + half, 1e-6) << shape.index() << " at " << speed;
      }
    }
  }
}

TEST(Sheet, ThatIsNoneIsRefused) {
  const auto refused = [](double thickness, bool hull = false) -> std::string {
    Scene scene = on_floor(0.005, 0.1, 0.5);
    scene.bodies.emplace_back("body", box_of(10 * mm, 0.01, Vec3(0, 0, 20 * mm)));
    Obstacle sheet = obstacle(mesh_of("sheet.obj"), Vec3::Zero());
    std::get<MeshShape>(sheet.shape).thickness = thickness;
    std::get<MeshShape>(sheet.shape).hull = hull;
    scene.obstacles.emplace_back("sheet", sheet);
    solid::Mesh crossed = square_sheet(100 * mm);
    if (thickness == 2 * mm) crossed.faces.push_back({0, 2, 1});
    try {
      build(scene, reader(named({{"sheet.obj", crossed}})));
    } catch (const InputError& error) {
      return error.fault().path + " " + error.fault().rule;
    }
    return "";
  };
  EXPECT_EQ(refused(1 * mm), "");
  EXPECT_EQ(refused(2 * mm), "obstacles.sheet.mesh.file has 1 edges where more than two triangles meet");
  EXPECT_EQ(refused(1 * mm, true), "obstacles.sheet.mesh.hull is the body around it, which has no thickness");
  for (const double wrong : {-1 * mm, 1e-6, 1.0, std::numeric_limits<double>::quiet_NaN()})
    EXPECT_EQ(refused(wrong).substr(0, 31), "obstacles.sheet.mesh.thickness ") << wrong;
  EXPECT_NE(refused(0.0).find("edges where not exactly two triangles meet"), std::string::npos);
}

}  // namespace
}  // namespace sinew
