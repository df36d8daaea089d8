// Rigid bodies and obstacles whose shape is a surface of triangles, or the hull around one.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

#include "sinew/error/input_error.hpp"
#include "support/surfaces.hpp"

namespace sinew {
namespace {

using test::box_of;
using test::box_surface;
using test::end_of;
using test::floor_with_block;
using test::kGravity;
using test::mesh_of;
using test::mm;
using test::named;
using test::obstacle;
using test::on_floor;
using test::reader;

/// A ring about z.
solid::Mesh ring_surface(double ring, double tube, int around, int across) {
  solid::Mesh mesh;
  mesh.nodes.resize(3, around * across);
  for (int i = 0; i < around; ++i) {
    const double a = 2.0 * std::numbers::pi * i / around;
    for (int k = 0; k < across; ++k) {
      const double b = 2.0 * std::numbers::pi * k / across, r = ring + tube * std::cos(b);
      mesh.nodes.col(i * across + k) = Vec3(r * std::cos(a), r * std::sin(a), tube * std::sin(b));
      const auto at = [&](int di, int dk) { return (i + di) % around * across + (k + dk) % across; };
      mesh.faces.push_back({at(0, 0), at(1, 0), at(1, 1)});
      mesh.faces.push_back({at(0, 0), at(1, 1), at(0, 1)});
    }
  }
  return mesh;
}

MeshReader reader(const solid::Mesh& mesh) {
  return [mesh](const std::filesystem::path&) { return mesh; };
}

MeshShape mesh_shape(bool hull) { return {.file = "part.stl", .scale = 1.0, .hull = hull}; }

TEST(MeshContact, ABoxOfTrianglesSlidesAsABoxDoes) {
  const double angle = 25.0 * std::numbers::pi / 180.0;
  std::vector<State> ends;
  for (int kind = 0; kind < 3; ++kind) {
    Scene scene = on_floor(0.005, 0.5, 0.2);
    scene.gravity = kGravity * Vec3(std::sin(angle), 0, -std::cos(angle));
    scene.bodies.emplace_back("block", box_of(50 * mm, 0.1, Vec3(0, 0, 25 * mm)));
    if (kind > 0) scene.bodies[0].second.shape = mesh_shape(kind == 2);
    const Model model = build(scene, reader(box_surface(Vec3::Constant(50 * mm))));
    double gained = 0.0;
    ends.push_back(end_of(model, &gained));
    EXPECT_LE(gained, 1e-12);
    EXPECT_EQ(ends.back().contacts.size(), 4U);
    EXPECT_NEAR((ends.back().bodies[0].p - ends[0].bodies[0].p).norm(), 0.0, 1e-9) << kind;
  }
  EXPECT_GT(ends[0].bodies[0].p.x(), 0.2);
}

/// The axes of a mesh are those of its file, wherever its centre of mass is.
TEST(MeshContact, ItsCentreOfMassAndInertiaAreThoseOfWhatItEncloses) {
  for (const bool hull : {false, true}) {
    Scene scene = on_floor(0.005, 0.0, 0.2);
    RigidBody body;
    body.shape = mesh_shape(hull);
    body.density = 1000.0;
    body.pose.rotate = Vec3(0, 0, 0.5 * std::numbers::pi);
    body.pose.translate = Vec3(1, 0, 0);
    scene.bodies.emplace_back("brick", body);
    const Vec3 size(20 * mm, 30 * mm, 40 * mm), middle(100 * mm, 20 * mm, 50 * mm);
    const Model model = build(scene, reader(box_surface(size, middle)));
    const BodyModel& own = model.bodies[0];
    EXPECT_NEAR((own.start.p - Vec3(1 - 20 * mm, 100 * mm, 50 * mm)).norm(), 0.0, 1e-12);
    EXPECT_NEAR(own.body.mass, 0.024, 1e-12);
    const Vec3 square = size.cwiseAbs2();
    const Vec3 expected =
        0.024 / 12.0 * Vec3(square.y() + square.z(), square.x() + square.z(), square.x() + square.y());
    EXPECT_NEAR((own.body.inertia - rod::Mat3(expected.asDiagonal())).norm(), 0.0, 1e-15);
  }
}

TEST(MeshContact, WarnsOfMillimetres) {
  for (const double scale : {1.0, 0.001}) {
    Scene scene = on_floor(0.005, 0.1, 0.2);
    RigidBody body;
    body.shape = MeshShape{.file = "part.stl", .scale = scale, .hull = false};
    body.mass = 1.0;
    scene.bodies.emplace_back("brick", body);
    const Model model = build(scene, reader(box_surface(Vec3(20, 30, 40), Vec3(0, 0, 20))));
    ASSERT_EQ(model.warnings.size(), scale == 1.0 ? 1U : 0U);
    if (scale == 1.0)
      EXPECT_EQ(to_string(model.warnings[0]).find("bodies.brick.mesh.scale: the mesh is 53.8"), 0U)
          << to_string(model.warnings[0]);
  }
}

/// A ring hangs on a bar through it: its hull would be pushed off.
TEST(MeshContact, ARingHangsOnABar) {
  Scene scene = on_floor(0.002, 1.0, 0.3);
  scene.obstacles.emplace_back("bar", obstacle(CapsuleShape{4 * mm, 200 * mm}, Vec3(0, 0, 300 * mm)));
  RigidBody ring;
  ring.shape = mesh_shape(false);
  ring.mass = 0.02;
  // The bar is along z as the ring's own axis; both are turned so that it is level.
  ring.pose.rotate = scene.obstacles[1].second.pose.rotate = Vec3(0.5 * std::numbers::pi, 0, 0);
  ring.pose.translate = Vec3(3 * mm, 0, 300 * mm - 20 * mm);
  scene.bodies.emplace_back("ring", ring);
  const Model model = build(scene, reader(ring_surface(30 * mm, 5 * mm, 48, 16)));
  double gained = 0.0;
  const State end = end_of(model, &gained);
  EXPECT_LE(gained, 1e-9);
  // Inner radius 25 mm, on a bar of 4 mm: its middle is 21 mm lower, but for facets and swinging.
  EXPECT_NEAR((end.bodies[0].p - Vec3(0, 0, 300 * mm)).norm(), 21 * mm, 0.3 * mm);
  double normal = 0.0;
  for (const ContactState& own : end.contacts) normal += own.force.norm();
  EXPECT_GT(normal, 0.5 * 0.02 * kGravity);
}

TEST(MeshContact, ShapesComeToRestOnAPlateOfTwelveTriangles) {
  struct Case {
    BodyShape shape;
    double half;
  };
  for (const Case& one :
       {Case{BoxShape{Vec3::Constant(20 * mm)}, 10 * mm}, Case{SphereShape{8 * mm}, 8 * mm},
        Case{CylinderShape{10 * mm, 12 * mm}, 6 * mm}, Case{CapsuleShape{5 * mm, 1 * mm}, 5.5 * mm}}) {
    Scene scene = on_floor(0.005, 0.5, 0.5);
    scene.obstacles.emplace_back("plate", obstacle(mesh_shape(false), Vec3(0, 0, 100 * mm)));
    RigidBody body = box_of(1.0, 0.05, Vec3(13 * mm, 7 * mm, 110 * mm + one.half));
    body.shape = one.shape;
    scene.bodies.emplace_back("body", body);
    const Model model = build(scene, reader(box_surface(Vec3(200 * mm, 200 * mm, 10 * mm))));
    double gained = 0.0;
    const State end = end_of(model, &gained);
    EXPECT_LE(gained, 1e-9) << one.shape.index();
    EXPECT_NEAR(end.bodies[0].p.z(), 105 * mm + one.half, 1e-6) << one.shape.index();
    EXPECT_NEAR((end.bodies[0].p - body.pose.translate).head<2>().norm(), 0.0, 1e-4) << one.shape.index();
    Vec3 force = Vec3::Zero();
    for (const ContactState& own : end.contacts)
      force += own.a.on.kind == Collider::Kind::body ? own.force : Vec3(-own.force);
    EXPECT_NEAR(std::abs(force.z()), 0.05 * kGravity, 1e-6) << one.shape.index();
  }
}

Scene soft_block_above(const Vec3& table, const Vec3& at) {
  Scene scene;
  scene.time = {0.02, 1.0};
  scene.gravity = Vec3(0, 0, -kGravity);
  Solid block;
  block.mesh = "block.vtk";
  block.material.law = solid::corotational(300e3, 0.4);
  block.density = 1000.0;
  block.rayleigh = {20.0, 0.1};
  scene.solids.emplace_back("block", block);
  scene.obstacles.emplace_back("table", obstacle(BoxShape{table}, at));
  return scene;
}

/// A soft block rests on a mesh as on the box of the same size, which it overhangs.
TEST(MeshContact, ASoftBlockLiesOnAMeshAsOnABox) {
  std::vector<double> lowest;
  const Vec3 size(40 * mm, 30 * mm, 20 * mm);
  for (const bool mesh : {false, true}) {
    Scene scene = soft_block_above(size, Vec3(31.3 * mm, 5.7 * mm, -11 * mm));
    if (mesh) scene.obstacles[0].second.shape = mesh_shape(false);
    const Model model = build(scene, [&](const std::filesystem::path& path) {
      return path.extension() == ".stl" ? box_surface(size) : test::read_block(path);
    });
    const State end = end_of(model);
    Vec3 force = Vec3::Zero();
    for (const ContactState& own : end.contacts)
      force += own.a.on.kind == Collider::Kind::solid ? own.force : Vec3(-own.force);
    const double weight = kGravity * 1000.0 * 60 * 10 * 10 * mm * mm * mm;
    EXPECT_NEAR(std::abs(force.z()), weight, 0.02 * weight);
    lowest.push_back(end.solids[0].x.row(2).minCoeff());
  }
  EXPECT_NEAR(lowest[1], lowest[0], 1e-6);
}

/// Edges of the block and of the table lie above each other, corners and nodes, too.
TEST(MeshContact, EdgesInOneLineAreNoTrouble) {
  for (const double friction : {0.0, 0.5}) {
    Scene scene = soft_block_above(Vec3(40 * mm, 10 * mm, 20 * mm), Vec3(30 * mm, 5 * mm, -11 * mm));
    scene.contact.friction = friction;
    scene.time.duration = 0.2;
    const Model model = build(scene, test::read_block);
    const State end = end_of(model);
    for (const ContactState& own : end.contacts) EXPECT_GT(own.gap, -1e-7) << friction;
    EXPECT_GT(end.solids[0].x.row(2).minCoeff(), -1.5 * mm) << friction;  // table's top, and ends that hang
  }
}

/// Corners upon corners and edges upon edges, on a mesh.
TEST(MeshContact, EqualCubesStandOnEachOther) {
  for (const bool mesh : {false, true}) {
    for (const double aside : {0.0, 5 * mm}) {
      Scene scene = on_floor(0.005, 0.5, 0.5);
      scene.obstacles.emplace_back("stand", obstacle(mesh_of("cube.stl"), Vec3(0, 0, 100 * mm)));
      scene.bodies.emplace_back("cube", box_of(20 * mm, 0.03, Vec3(aside, 0, 120.05 * mm)));
      if (mesh) scene.bodies[0].second.shape = mesh_of("cube.stl");
      const Model model = build(scene, reader(named({{"cube.stl", box_surface(Vec3::Constant(20 * mm))}})));
      EXPECT_TRUE(model.warnings.empty());
      double pressed = 0.0;
      const RunEnd end = run(model, initial_state(model), [&](const State& state, const StepReport&) {
        double sum = 0.0;
        for (const ContactState& own : state.contacts) sum += own.force.norm();
        pressed = std::max(pressed, sum);
        EXPECT_NEAR(state.bodies[0].p.z(), 120 * mm, 0.06 * mm);
        return true;
      });
      EXPECT_EQ(end, RunEnd::done);
      EXPECT_LT(pressed, 20.0 * 0.03 * kGravity) << mesh << " " << aside;  // it falls from 0.05 mm
    }
  }
}

/// A small ball comes to the edge of a wedge of 20 degrees from aside and does not pass it.
TEST(MeshContact, ABladeStopsABall) {
  const double half = 50 * mm * std::tan(10.0 * std::numbers::pi / 180.0);
  solid::Mesh blade;
  blade.nodes.resize(3, 6);
  blade.nodes << -20 * mm, 20 * mm, -20 * mm, 20 * mm, -20 * mm, 20 * mm,  //
      0, 0, -half, -half, half, half,                                      //
      0, 0, -50 * mm, -50 * mm, -50 * mm, -50 * mm;
  blade.faces = {{0, 2, 1}, {1, 2, 3}, {0, 1, 4}, {1, 5, 4}, {0, 4, 2}, {1, 3, 5}, {2, 4, 3}, {3, 4, 5}};
  for (const double degrees : {0.0, 45.0, 78.0, -60.0}) {
    Scene scene = on_floor(0.001, 0.06, 0.0);
    scene.gravity = Vec3::Zero();
    scene.obstacles.clear();
    scene.obstacles.emplace_back("blade", obstacle(mesh_of("blade.obj"), Vec3::Zero()));
    RigidBody ball = box_of(1.0, 0.01, Vec3::Zero());
    ball.shape = SphereShape{2 * mm};
    const double angle = degrees * std::numbers::pi / 180.0;
    const Vec3 from(0, std::sin(angle), std::cos(angle));
    ball.pose.translate = 10 * mm * from;
    ball.velocity = -0.3 * from;
    scene.bodies.emplace_back("ball", ball);
    const Model model = build(scene, reader(named({{"blade.obj", blade}})));
    const State end = end_of(model);
    EXPECT_GT(end.bodies[0].p.dot(from), 1.9 * mm) << degrees;
  }
}

/// The tip of a pyramid rests in a groove of slope 1/2, on both sides of which its weight W leans with W / (2 cos a);
/// on one side alone it would slide.
TEST(MeshContact, ATipRestsInAGroove) {
  solid::Mesh groove;  // of five corners, along x
  groove.nodes.resize(3, 10);
  const std::array<std::array<double, 2>, 5> section = {{{-30, -30}, {30, -30}, {30, 15}, {0, 0}, {-30, 15}}};
  for (int i = 0; i < 5; ++i) {
    const auto [y, z] = section[static_cast<std::size_t>(i)];
    groove.nodes.col(i) = Vec3(-40 * mm, y * mm, z * mm);
    groove.nodes.col(i + 5) = Vec3(50 * mm, y * mm, z * mm);
    const int next = (i + 1) % 5;
    groove.faces.push_back({i, next, i + 5});
    groove.faces.push_back({next, next + 5, i + 5});
  }
  for (const auto& [a, b, c] : {std::array{0, 1, 3}, std::array{1, 2, 3}, std::array{0, 3, 4}}) {
    groove.faces.push_back({a, c, b});
    groove.faces.push_back({a + 5, b + 5, c + 5});
  }
  solid::Mesh tip;
  tip.nodes.resize(3, 5);
  tip.nodes << 0, 5 * mm, -5 * mm, -5 * mm, 5 * mm,  //
      0, 5 * mm, 5 * mm, -5 * mm, -5 * mm,           //
      0, 20 * mm, 20 * mm, 20 * mm, 20 * mm;
  tip.faces = {{0, 2, 1}, {0, 3, 2}, {0, 4, 3}, {0, 1, 4}, {1, 2, 3}, {1, 3, 4}};
  for (const double y : {0.0, 1e-7, -1e-7}) {  // m beside the bottom
    Scene scene = on_floor(1e-3, 5e-3, 0.0);
    scene.obstacles.clear();
    scene.obstacles.emplace_back("groove", obstacle(mesh_of("groove.stl"), Vec3::Zero()));
    RigidBody body;
    body.shape = mesh_of("tip.stl");
    body.mass = 0.1;
    body.pose.translate = Vec3(0, y, 0.5 * std::abs(y));
    scene.bodies.emplace_back("tip", body);
    const State end = end_of(build(scene, reader(named({{"groove.stl", groove}, {"tip.stl", tip}}))));
    EXPECT_LT(end.bodies[0].v.norm(), 5e-4) << y;  // (a slide: 20 mm/s)
    ASSERT_EQ(end.contacts.size(), 2U) << y;
    for (const ContactState& own : end.contacts)
      EXPECT_NEAR(own.force.norm(), 0.1 * kGravity / 2.0 * std::sqrt(1.25), 1e-2) << y;
  }
}

/// A plate with its top at z = 0 in squares of `cell`, two triangles each.
solid::Mesh plate_surface(int cells_x, int cells_y, double cell) {
  solid::Mesh mesh;
  const int rows = cells_y + 1, of_top = (cells_x + 1) * rows;
  mesh.nodes.resize(3, 2 * of_top);
  for (int i = 0; i < of_top; ++i) {
    const int column = i / rows, row = i % rows;
    const double y = (row - 0.5 * cells_y) * cell;
    mesh.nodes.col(i) = Vec3(column * cell, y, 0);
    mesh.nodes.col(of_top + i) = Vec3(column * cell, y, -10 * mm);
  }
  const auto add = [&mesh](int a, int b, int c, int d) {
    mesh.faces.push_back({a, b, c});
    mesh.faces.push_back({a, c, d});
  };
  for (int i = 0; i < cells_x; ++i) {
    for (int k = 0; k < cells_y; ++k) {
      const int a = i * rows + k, b = a + rows, c = b + 1, d = a + 1;
      add(a, b, c, d);
      add(of_top + a, of_top + d, of_top + c, of_top + b);
    }
    const int left = i * rows, right = left + cells_y;
    add(of_top + left, of_top + left + rows, left + rows, left);
    add(right, right + rows, of_top + right + rows, of_top + right);
  }
  for (int k = 0; k < cells_y; ++k) {
    const int last = cells_x * rows + k;
    add(of_top + k, k, k + 1, of_top + k + 1);
    add(last, of_top + last, of_top + last + 1, last + 1);
  }
  return mesh;
}

/// Nothing without friction stops what slides over a level floor, whatever this is made of.
TEST(MeshContact, SeamsOfALevelFloorStopNothing) {
  const Vec3 brick(30 * mm, 30 * mm, 20 * mm), half(200 * mm, 200 * mm, 20 * mm);
  const auto meshes = named({{"brick.stl", box_surface(brick)},
                             {"half.stl", box_surface(half)},
                             {"plate.stl", plate_surface(20, 8, 20 * mm)}});
  const std::array<BodyShape, 3> shapes = {BoxShape{brick}, CylinderShape{15 * mm, 20 * mm}, mesh_of("brick.stl")};
  for (std::size_t shape = 0; shape < shapes.size(); ++shape) {
    for (const char* floor : {"boxes", "meshes", "plate"}) {
      for (const double turned : {0.0, 0.2}) {
        SCOPED_TRACE(std::to_string(shape) + " on " + floor + ", turned by " + std::to_string(turned));
        Scene scene = on_floor(2e-3, 0.2, 0.0);
        scene.obstacles.clear();
        if (floor == std::string("plate")) {
          scene.obstacles.emplace_back("plate", obstacle(mesh_of("plate.stl"), Vec3::Zero()));
        } else {
          for (const double x : {100 * mm, 300 * mm}) {
            const std::string name = x < 200 * mm ? "here" : "there";
            scene.obstacles.emplace_back(name, floor == std::string("boxes")
                                                   ? obstacle(BoxShape{half}, Vec3(x, 0, -10 * mm))
                                                   : obstacle(mesh_of("half.stl"), Vec3(x, 0, -10 * mm)));
          }
        }
        RigidBody body = box_of(1.0, 0.02, Vec3(100.7 * mm, 3 * mm, 10 * mm));
        body.shape = shapes[shape];
        body.pose.rotate = Vec3(0, 0, turned);
        body.velocity = Vec3(1, 0, 0);
        scene.bodies.emplace_back("brick", body);
        const rigid::Motion at = end_of(build(scene, reader(meshes))).bodies[0];
        EXPECT_NEAR((at.p - Vec3(300.7 * mm, 3 * mm, 10 * mm)).norm(), 0.0, 1e-6);
        EXPECT_NEAR((at.v - Vec3(1, 0, 0)).norm(), 0.0, 1e-5);
        EXPECT_NEAR(at.w.norm(), 0.0, 1e-3);
      }
    }
  }
}

/// Beside and above a block the planes of its sides hold nothing.
TEST(MeshContact, ValleysEndWithTheirEdges) {
  const auto meshes = named({{"high.stl", floor_with_block(10 * mm)},
                             {"low.stl", floor_with_block(0.2 * mm)},
                             {"brick.stl", box_surface(Vec3(10 * mm, 10 * mm, 5 * mm))}});
  struct Way {
    const char* floor;
    double gravity, y, z;  // [m/s^2], m
  };
  for (const auto& [floor, gravity, y, z] :
       {Way{"high.stl", kGravity, 17 * mm, 0.0}, Way{"low.stl", 0.0, 5 * mm, 0.5 * mm}}) {
    SCOPED_TRACE(std::string(floor) + ", y " + std::to_string(y) + ", z " + std::to_string(z));
    Scene scene = on_floor(2e-3, 0.2, 0.0);
    scene.gravity = Vec3(0, 0, -gravity);
    scene.obstacles.clear();
    scene.obstacles.emplace_back("floor", obstacle(mesh_of(floor), Vec3::Zero()));
    RigidBody brick = box_of(1.0, 5e-4, Vec3(-7.7 * mm, y, z + 2.5 * mm));
    brick.shape = mesh_of("brick.stl");
    brick.velocity = Vec3(0.5, 0, 0);
    scene.bodies.emplace_back("brick", brick);
    const rigid::Motion at = end_of(build(scene, reader(meshes))).bodies[0];
    EXPECT_NEAR((at.p - Vec3(92.3 * mm, y, z + 2.5 * mm)).norm(), 0.0, 1e-6);
    EXPECT_NEAR((at.v - Vec3(0.5, 0, 0)).norm(), 0.0, 1e-5);
  }
}

/// A cube that flies down at a block from exactly as high as its top hits it, or the run stops and says so.
TEST(MeshContact, WhatFliesPastARimHitsIt) {
  const auto meshes = named({{"cube.stl", box_surface(Vec3::Constant(20 * mm))}});
  for (const double speed : {0.5, 1.0, 2.5, 8.0}) {
    for (int kind = 0; kind < 4; ++kind) {
      SCOPED_TRACE(std::to_string(speed) + " m/s, " + std::to_string(kind));
      Scene scene = on_floor(5e-3, 0.05, 0.0);
      scene.gravity = Vec3::Zero();
      scene.obstacles.clear();
      const BoxShape box{Vec3::Constant(20 * mm)};
      scene.obstacles.emplace_back(
          "block", kind < 2 ? obstacle(box, Vec3::Zero()) : obstacle(mesh_of("cube.stl"), Vec3::Zero()));
      RigidBody cube = box_of(20 * mm, 8e-3, Vec3(21 * mm, 3 * mm, 20 * mm));
      if (kind % 2 == 1) cube.shape = mesh_of("cube.stl");
      cube.velocity = speed * Vec3(-1, 0, -1);
      scene.bodies.emplace_back("cube", cube);
      const Model model = build(scene, reader(meshes));
      State end = initial_state(model);
      const RunEnd how = run(model, initial_state(model), [&](const State& state, const StepReport&) {
        end = state;
        return true;
      });
      if (how != RunEnd::done) continue;
      EXPECT_LT(end.bodies[0].v.squaredNorm(), 0.6 * cube.velocity.squaredNorm());
    }
  }
}

/// What overlaps is told by how much, and moved apart; what is only fast, or about to be moved, is not told.
TEST(MeshContact, OverlapsAtTheStartAreToldAndMended) {
  const auto meshes = named({{"slab.stl", box_surface(Vec3(100 * mm, 100 * mm, 20 * mm))},
                             {"cube.stl", box_surface(Vec3::Constant(20 * mm))}});
  for (const double deep : {1 * mm, 3 * mm}) {
    Scene scene = on_floor(0.005, 1.0, 0.5);
    scene.obstacles.emplace_back("slab", obstacle(mesh_of("slab.stl"), Vec3(0, 0, 100 * mm)));
    scene.bodies.emplace_back("cube", box_of(20 * mm, 0.03, Vec3(3 * mm, 2 * mm, 120 * mm - deep)));
    scene.bodies[0].second.shape = mesh_of("cube.stl");
    const Model model = build(scene, reader(meshes));
    ASSERT_EQ(model.warnings.size(), 1U);
    const std::string expected = "contact: slab and cube overlap by " + std::to_string(std::lround(1e3 * deep)) + " mm";
    EXPECT_EQ(to_string(model.warnings[0]).substr(0, expected.size()), expected);
    double gained = 0.0;
    EXPECT_NEAR(end_of(model, &gained).bodies[0].p.z(), 120 * mm, 1e-5);
  }
  Scene scene = on_floor(0.02, 0.1, 0.5);
  scene.obstacles.emplace_back("slab", obstacle(BoxShape{Vec3(200 * mm, 200 * mm, 20 * mm)}, Vec3(0, 0, 100 * mm)));
  RigidBody ring;
  ring.shape = mesh_of("ring.stl");
  ring.mass = 0.02;
  ring.velocity = Vec3(0, 0, -5);
  ring.spin = Vec3(0, 0, 100);
  ring.pose.translate = Vec3(0, 0, 200 * mm);
  scene.bodies.emplace_back("ring", ring);
  const Model model = build(scene, reader(named({{"ring.stl", ring_surface(30 * mm, 5 * mm, 32, 12)}})));
  EXPECT_TRUE(model.warnings.empty()) << to_string(model.warnings[0]);
  const State end = end_of(model);
  EXPECT_NEAR(end.bodies[0].p.z(), 115 * mm, 0.3 * mm);
}

/// Each is refused, or not, for what it is.
TEST(MeshContact, OnlyWhatEnclosesAVolumeIsABody) {
  const auto refused = [](const solid::Mesh& mesh, double scale = 1.0, bool hull = false) -> std::string {
    Scene scene = on_floor(0.005, 0.1, 0.5);
    RigidBody body;
    body.shape = MeshShape{.file = "part.stl", .scale = scale, .hull = hull};
    body.density = 1000.0;
    scene.bodies.emplace_back("part", body);
    try {
      build(scene, reader(mesh));
    } catch (const InputError& error) {
      EXPECT_EQ(error.fault().path.substr(0, 16), "bodies.part.mesh");
      return error.fault().rule;
    }
    return "";
  };
  const auto turned = [](solid::Mesh mesh) {
    for (solid::Triangle& t : mesh.faces) std::swap(t[0], t[1]);
    return mesh;
  };
  const auto both = [](solid::Mesh one, const solid::Mesh& other) {
    const auto first = static_cast<int>(one.nodes.cols());
    one.nodes.conservativeResize(3, first + other.nodes.cols());
    one.nodes.rightCols(other.nodes.cols()) = other.nodes;
    for (const solid::Triangle& t : other.faces) one.faces.push_back({t[0] + first, t[1] + first, t[2] + first});
    return one;
  };
  const solid::Mesh cube = box_surface(Vec3::Constant(20 * mm));
  const solid::Mesh core = box_surface(Vec3::Constant(10 * mm), Vec3(mm, 0, 0));
  const solid::Mesh far = box_surface(Vec3::Constant(10 * mm), Vec3(100 * mm, 0, 0));
  EXPECT_EQ(refused(cube), "");
  EXPECT_EQ(refused(both(cube, turned(core))), "") << "a cavity";
  EXPECT_EQ(refused(both(cube, far)), "") << "two parts";
  EXPECT_EQ(refused(turned(cube)), "is inside out");
  EXPECT_EQ(refused(both(cube, turned(far))), "has a part that is inside out");
  solid::Mesh open = cube;
  open.faces.pop_back();
  EXPECT_EQ(refused(open), "has 3 edges where not exactly two triangles meet, turned the same way");
  EXPECT_EQ(refused(open, 1.0, true), "");
  EXPECT_EQ(refused(turned(cube), 1.0, true), "");
  EXPECT_EQ(refused(cube, 1e9), "makes the body 2e+07 m large");
  solid::Mesh sheet;
  sheet.nodes.resize(3, 4);
  sheet.nodes << 0, 0.1, 0.1, 0, 0, 0, 0.1, 0.1, 0.3, 0.3, 0.3, 0.3;
  sheet.faces = {{0, 1, 2}, {0, 2, 3}, {1, 0, 3}, {1, 3, 2}};
  EXPECT_EQ(refused(sheet), "encloses no volume");
  EXPECT_EQ(refused(sheet, 1.0, true), "its points lie in one plane, or are too few");
  EXPECT_EQ(refused({}), "has no triangles");
}

}  // namespace
}  // namespace sinew
