// What passes near something without touching it is not stopped, turned or slowed down by it.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <utility>
#include <variant>

#include "sinew/sim/contacts.hpp"
#include "support/surfaces.hpp"

namespace sinew {
namespace {

using test::mm;

enum class Where { above, beside, past_the_corner };

struct Flight {
  double speed, step;  // [m/s], s
};
// A tenth of a millimetre, one and ten in a step, beside thicknesses of 5 mm.
constexpr std::array<Flight, 3> kFlights = {{{0.1, 1e-3}, {0.5, 2e-3}, {2.0, 5e-3}}};

const Vec3 kBrick(10 * mm, 10 * mm, 5 * mm);

std::array<BodyShape, 4> bricks() {
  MeshShape hull = test::mesh_of("brick.stl");
  hull.hull = true;
  return {BoxShape{kBrick}, test::mesh_of("brick.stl"), hull, CylinderShape{5 * mm, 5 * mm}};
}

MeshReader meshes() {
  return test::reader(test::named({{"floor.stl", test::floor_with_block(10 * mm)},
                                   {"step.stl", test::floor_with_block(0.2 * mm)},
                                   {"block.stl", test::box_surface(Vec3(20 * mm, 10 * mm, 10 * mm))},
                                   {"brick.stl", test::box_surface(kBrick)}}));
}

/// The same block of 20 x 10 x 10 mm, with its upper face at z = 10 mm, as part of a floor, as a mesh and as a box.
std::array<Obstacle, 3> blocks() {
  const Vec3 middle(10 * mm, 5 * mm, 5 * mm);
  return {test::obstacle(test::mesh_of("floor.stl"), Vec3::Zero()), test::obstacle(test::mesh_of("block.stl"), middle),
          test::obstacle(BoxShape{Vec3(20 * mm, 10 * mm, 10 * mm)}, middle)};
}

RigidBody brick(const BodyShape& shape, const Vec3& at, const Vec3& velocity) {
  RigidBody own;
  own.shape = shape;
  own.mass = 1e-3;
  own.pose.translate = at;
  own.velocity = velocity;
  return own;
}

Scene weightless(const Flight& flight) {
  Scene scene;
  scene.time = {flight.step, 40 * mm / flight.speed};
  return scene;
}

Vec3 beginning(Where where, double clear) {
  return {-7.7 * mm, where == Where::above ? 5 * mm : 15 * mm + clear,
          where == Where::beside ? 2.8 * mm : 12.5 * mm + clear};
}

TEST(FlightPast, GoesStraightOn) {
  for (const Flight& flight : kFlights) {
    for (const Where where : {Where::above, Where::beside, Where::past_the_corner}) {
      for (const double clear : {0.05 * mm, 0.2 * mm, 1 * mm}) {
        for (std::size_t block = 0; block < 3; ++block) {
          for (std::size_t shape = 0; shape < 4; ++shape) {
            SCOPED_TRACE(std::to_string(flight.speed) + " m/s, where " + std::to_string(static_cast<int>(where)) +
                         ", by " + std::to_string(clear) + " m, block " + std::to_string(block) + ", shape " +
                         std::to_string(shape));
            Scene scene = weightless(flight);
            scene.obstacles.emplace_back("block", blocks()[block]);
            const Vec3 at = beginning(where, clear), velocity(flight.speed, 0, 0);
            scene.bodies.emplace_back("brick", brick(bricks()[shape], at, velocity));
            const rigid::Motion end = test::end_of(build(scene, meshes())).bodies[0];
            ASSERT_NEAR((end.p - at - Vec3(40 * mm, 0, 0)).norm(), 0.0, 1e-9);
            ASSERT_NEAR((end.v - velocity).norm(), 0.0, 1e-9);
            ASSERT_NEAR(end.w.norm(), 0.0, 1e-6);
          }
        }
      }
    }
  }
}

/// Across, past an upright edge of the block that the horizontal ones of the brick cross.
TEST(FlightPast, PastAnEdgeThatItsEdgesCross) {
  for (const Vec3& velocity : {Vec3(2, 0.05, 0), Vec3(2, 1, 0), Vec3(0.5, 0.5, 0.1), Vec3(2, 0.3, -0.5)}) {
    for (const double clear : {0.01 * mm, 0.05 * mm, 0.3 * mm}) {
      for (std::size_t block = 0; block < 3; ++block) {
        for (std::size_t shape = 0; shape < 3; ++shape) {
          SCOPED_TRACE(std::to_string(velocity.x()) + ", " + std::to_string(velocity.y()) + " m/s, by " +
                       std::to_string(clear) + " m, block " + std::to_string(block) + ", shape " +
                       std::to_string(shape));
          Scene scene;
          scene.time = {2e-3, 0.01};
          scene.obstacles.emplace_back("block", blocks()[block]);
          const double x = -5.8 * mm, until = (-5 * mm - x) / velocity.x();  // [s] until it is at the edge
          const Vec3 at(x, 15 * mm + clear - until * velocity.y(), 10 * mm - until * velocity.z());
          scene.bodies.emplace_back("brick", brick(bricks()[shape], at, velocity));
          EXPECT_NEAR((test::end_of(build(scene, meshes())).bodies[0].v - velocity).norm(), 0.0, 1e-9);
        }
      }
    }
  }
}

/// What velocities lead past an edge, and a force pushes against the side behind it within the step, does not go in.
TEST(FlightPast, PushedBackInTheSameStep) {
  for (const double push : {30.0, 35.0, 40.0}) {
    for (const std::size_t shape : {0, 2}) {
      SCOPED_TRACE(std::to_string(push) + " m/s2, shape " + std::to_string(shape));
      Scene scene;
      scene.time = {2e-3, 2e-3};
      scene.gravity = Vec3(0, -push, 0);
      scene.contact.friction = 0.0;
      scene.obstacles.emplace_back("block", blocks()[2]);
      const Vec3 at(-5.8 * mm, 15.02 * mm, 10 * mm), velocity(2, 0.05, 0);
      scene.bodies.emplace_back("brick", brick(bricks()[shape], at, velocity));
      const Model model = build(scene, meshes());
      for (const Overlap& own : overlaps(model, test::end_of(model))) EXPECT_LT(own.depth, 1e-3 * mm);
    }
  }
}

/// A bar that is far larger than what moves, and turns: its ends go far in a step.
TEST(FlightPast, NotOfABarThatSweepsThrough) {
  const auto bars = test::named({{"bar.stl", test::box_surface(Vec3(2.0, 10 * mm, 10 * mm))}});
  const std::array<BodyShape, 2> shapes = {BoxShape{Vec3(2.0, 10 * mm, 10 * mm)}, test::mesh_of("bar.stl")};
  for (const BodyShape& shape : shapes) {
    for (const BodyShape& small : {BodyShape(SphereShape{5 * mm}), BodyShape(BoxShape{Vec3::Constant(10 * mm)})}) {
      SCOPED_TRACE(std::to_string(shape.index()) + " and " + std::to_string(small.index()));
      Scene scene;
      scene.time = {5e-3, 0.1};
      Frame turning;
      turning.motion = {{0.0, scene.time.duration}, {Vec3::Zero(), Vec3(0, 0, 1.0)}, {}};
      scene.frames.emplace_back("turning", turning);
      Obstacle bar;
      std::visit([&bar](const auto& own) { bar.shape = own; }, shape);
      bar.frame = "turning";
      scene.obstacles.emplace_back("bar", bar);
      scene.bodies.emplace_back("small", brick(small, Vec3(900 * mm, 112 * mm, 1 * mm), Vec3(0, 0, -0.01)));
      EXPECT_GT(test::end_of(build(scene, test::reader(bars))).bodies[0].v.norm(), 1.0);
    }
  }
}

TEST(FlightPast, OverALowStep) {
  for (const Flight& flight : kFlights) {
    for (std::size_t shape = 0; shape < 4; ++shape) {
      SCOPED_TRACE(std::to_string(flight.speed) + " m/s, shape " + std::to_string(shape));
      Scene scene = weightless(flight);
      scene.obstacles.emplace_back("floor", test::obstacle(test::mesh_of("step.stl"), Vec3::Zero()));
      const Vec3 at(-7.7 * mm, 5 * mm, 0.25 * mm + 2.5 * mm);
      scene.bodies.emplace_back("brick", brick(bricks()[shape], at, Vec3(flight.speed, 0, 0)));
      const rigid::Motion end = test::end_of(build(scene, meshes())).bodies[0];
      EXPECT_NEAR((end.p - at - Vec3(40 * mm, 0, 0)).norm(), 0.0, 1e-9);
    }
  }
}

/// Its corners rest on the same surface that the block rises from.
TEST(FlightPast, OfABrickThatSlidesBesideABlock) {
  for (std::size_t shape = 0; shape < 2; ++shape) {
    for (const double clear : {0.05 * mm, 0.2 * mm}) {
      SCOPED_TRACE(std::to_string(clear) + " m, shape " + std::to_string(shape));
      Scene scene = weightless(kFlights[1]);
      scene.gravity = Vec3(0, 0, -test::kGravity);
      scene.contact.friction = 0.0;
      scene.obstacles.emplace_back("floor", blocks()[0]);
      const Vec3 at(-7.7 * mm, 15 * mm + clear, 2.5 * mm);
      scene.bodies.emplace_back("brick", brick(bricks()[shape], at, Vec3(0.5, 0, 0)));
      const rigid::Motion end = test::end_of(build(scene, meshes())).bodies[0];
      EXPECT_NEAR((end.p - at - Vec3(40 * mm, 0, 0)).norm(), 0.0, 1e-6);
      EXPECT_NEAR((end.v - Vec3(0.5, 0, 0)).norm(), 0.0, 1e-5);
    }
  }
}

/// A block on a frame goes by what rests, and two bodies go by each other.
TEST(FlightPast, OfWhatMovesByItselfOrIsMoved) {
  for (const Flight& flight : kFlights) {
    for (const Where where : {Where::above, Where::beside}) {
      for (std::size_t shape = 0; shape < 4; ++shape) {
        SCOPED_TRACE(std::to_string(flight.speed) + " m/s, where " + std::to_string(static_cast<int>(where)) +
                     ", shape " + std::to_string(shape));
        const Vec3 at = beginning(where, 0.1 * mm);
        Scene scene = weightless(flight);
        Frame cart;
        cart.motion = {{0.0, scene.time.duration}, {}, {Vec3::Zero(), Vec3(-40 * mm, 0, 0)}};
        scene.frames.emplace_back("cart", cart);
        Obstacle block = blocks()[1];
        block.frame = "cart";
        scene.obstacles.emplace_back("block", block);
        scene.bodies.emplace_back("brick", brick(bricks()[shape], at, Vec3::Zero()));
        EXPECT_NEAR((test::end_of(build(scene, meshes())).bodies[0].p - at).norm(), 0.0, 1e-9);

        Scene free = weightless(flight);
        const Vec3 half(0.5 * flight.speed, 0, 0);
        free.bodies.emplace_back("brick", brick(bricks()[shape], at, half));
        free.bodies.emplace_back("other", brick(bricks()[shape], at - Vec3(-20 * mm, 0, 5.1 * mm), -half));
        const State end = test::end_of(build(free, meshes()));
        EXPECT_NEAR((end.bodies[0].p - at - Vec3(20 * mm, 0, 0)).norm(), 0.0, 1e-9);
        EXPECT_NEAR((end.bodies[1].v + half).norm(), 0.0, 1e-9);
      }
    }
  }
}

/// A little lower, or nearer, they hit it; sides in one plane, along which corners go, hide no edge.
TEST(FlightPast, EndsWhereSomethingIsInTheWay) {
  for (const Flight& flight : kFlights) {
    for (const auto& [where, deep] :
         {std::pair(Where::above, 0.1 * mm), std::pair(Where::above, 1.5 * mm), std::pair(Where::beside, 1.5 * mm)}) {
      for (std::size_t block = 0; block < 3; ++block) {
        for (std::size_t shape = 0; shape < 4; ++shape) {
          SCOPED_TRACE(std::to_string(flight.speed) + " m/s, where " + std::to_string(static_cast<int>(where)) +
                       ", by " + std::to_string(deep) + " m, block " + std::to_string(block) + ", shape " +
                       std::to_string(shape));
          Scene scene = weightless(flight);
          scene.obstacles.emplace_back("block", blocks()[block]);
          const Vec3 velocity(flight.speed, 0, 0);
          scene.bodies.emplace_back("brick", brick(bricks()[shape], beginning(where, -deep), velocity));
          EXPECT_LT(test::end_of(build(scene, meshes())).bodies[0].v.squaredNorm(), 0.9 * velocity.squaredNorm());
        }
      }
    }
  }
}

/// Sides in one plane, along which corners and edges go down, are no way past.
TEST(FlightPast, EqualBoxesFallOnEachOther) {
  const auto cube = test::named({{"cube.stl", test::box_surface(Vec3::Constant(10 * mm))}});
  const std::array<BodyShape, 2> shapes = {BoxShape{Vec3::Constant(10 * mm)}, test::mesh_of("cube.stl")};
  struct Fall {
    double step, beside;  // s, m
    bool box_below;
    std::size_t above;
  };
  for (const auto& [step, beside, box_below, above] :
       {Fall{1e-3, 0.0, true, 0}, Fall{1e-3, 0.0, true, 1}, Fall{1e-3, 0.0, false, 0}, Fall{1e-3, 0.0, false, 1},
        Fall{5e-3, 0.0, false, 0}, Fall{5e-3, 0.0, false, 1}, Fall{1e-3, 1e-9, false, 1}}) {
    SCOPED_TRACE(std::to_string(step) + " s, " + std::to_string(1e9 * beside) + " nm, " + std::to_string(above));
    Scene scene;
    scene.time = {step, 0.01};
    scene.gravity = Vec3(0, 0, -test::kGravity);
    scene.obstacles.emplace_back("lower", box_below ? test::obstacle(BoxShape{Vec3::Constant(10 * mm)}, Vec3::Zero())
                                                    : test::obstacle(test::mesh_of("cube.stl"), Vec3::Zero()));
    scene.bodies.emplace_back("upper", brick(shapes[above], Vec3(beside, 0, 13.3 * mm), Vec3(0, 0, -1)));
    EXPECT_NEAR(test::end_of(build(scene, test::reader(cube))).bodies[0].p.z(), 10 * mm, 1e-6);
  }
}

/// Bars across each other, of which no corner comes near the other one, and which are through in one step.
TEST(FlightPast, CrossedBarsMeetByTheirEdges) {
  const auto bars = test::named({{"y.stl", test::box_surface(Vec3(3 * mm, 30 * mm, 3 * mm))},
                                 {"z.stl", test::box_surface(Vec3(3 * mm, 3 * mm, 30 * mm))}});
  Scene scene;
  scene.time = {5e-3, 0.04};
  scene.contact.friction = 0.0;
  scene.obstacles.emplace_back("post", test::obstacle(test::mesh_of("z.stl"), Vec3::Zero()));
  scene.bodies.emplace_back(
      "bar", brick(test::mesh_of("y.stl"), Vec3(-5.6537 * mm, 2.453 * mm, 16.6447 * mm), Vec3(1.12954, 0, -0.789327)));
  EXPECT_LT(test::end_of(build(scene, test::reader(bars))).bodies[0].p.x(), 0.0);
}

/// However little a step moves: what comes in by less than a millionth of the scene bounces.
TEST(FlightPast, ShortStepsBounce) {
  for (const double step : {1e-3, 1e-4, 2e-5}) {
    Scene scene;
    scene.time = {step, 0.04};
    scene.contact.restitution = 1.0;
    Obstacle wall;
    wall.shape = PlaneShape{Vec3::Zero(), Vec3::UnitX()};
    scene.obstacles.emplace_back("wall", wall);
    for (const double x : {10.1 * mm, 1000 * mm})
      scene.bodies.emplace_back(x < 1.0 ? "ball" : "far", brick(SphereShape{10 * mm}, Vec3(x, 0, 0), Vec3::Zero()));
    scene.bodies[0].second.velocity = Vec3(-0.005, 0, 0);
    EXPECT_NEAR(test::end_of(build(scene, meshes())).bodies[0].v.x(), 0.005, 1e-9) << step;
  }
}

}  // namespace
}  // namespace sinew
