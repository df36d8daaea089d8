// The tangent of contacts: what A has of them, and what the deferred correction adds, against differences.
#include "sinew/sim/contact_correction.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cstdlib>

#include "sinew/sim/linearization.hpp"
#include "support/random.hpp"
#include "support/scenes.hpp"

namespace sinew {
namespace {

using test::mm;

/// Soft blocks, bodies, obstacles and clamped rods, each of which touches all others.
Model crowd(const BodyShape& shape, double friction) {
  Scene scene;
  scene.time = {0.01, 1.0};
  scene.contact.friction = friction;
  for (const auto& [name, at] : {std::pair("slab", Vec3(0, 0, 0)), std::pair("lid", Vec3(5 * mm, 4 * mm, 20.5 * mm))}) {
    Solid solid;
    solid.mesh = name;
    solid.pose.translate = at;
    solid.material.law = solid::corotational(1e5, 0.3);
    solid.density = 1000.0;
    scene.solids.emplace_back(name, solid);
  }
  for (const auto& [name, at] :
       {std::pair("one", Vec3(20 * mm, 8 * mm, 45 * mm)), std::pair("two", Vec3(33 * mm, 12 * mm, 47 * mm))}) {
    RigidBody body;
    body.shape = shape;
    body.mass = 0.02;
    body.pose.translate = at;
    scene.bodies.emplace_back(name, body);
  }
  for (const auto& [name, from, to] :
       {std::tuple("along", Vec3(5 * mm, 20 * mm, 42 * mm), Vec3(55 * mm, 22 * mm, 42.5 * mm)),
        std::tuple("across", Vec3(30 * mm, 5 * mm, 45 * mm), Vec3(32 * mm, 55 * mm, 44 * mm))}) {
    Rod rod;
    rod.path = {from, to};
    rod.sections = 4;
    rod.section = Circle{2 * mm};
    rod.material = {1e6, 0.4, 1000.0, 0.0};
    scene.rods.emplace_back(name, rod);
  }
  Obstacle post;
  post.shape = CapsuleShape{4 * mm, 60 * mm};
  post.pose.translate = Vec3(45 * mm, 20 * mm, 40 * mm);
  scene.obstacles.emplace_back("post", post);
  const std::vector<std::string> soft = {"slab", "lid", "along", "across"},
                                 all = {"slab", "lid", "along", "across", "one", "two", "post", "floor"};
  for (std::size_t i = 0; i < soft.size(); ++i) {
    for (std::size_t j = i < 2 ? i : i + 1; j < all.size(); ++j) {  // (solids also themselves)
      ContactPair pair;
      pair.first = soft[i];
      pair.second = all[j];
      scene.contact.pairs.push_back(pair);
    }
  }
  Obstacle floor;
  floor.shape = PlaneShape{Vec3(0, 0, 0.5 * mm), Vec3(0.05, 0, 1)};
  scene.obstacles.emplace_back("floor", floor);
  return build(scene, [](const std::filesystem::path& file) {
    return file == "stone" ? test::block_mesh(1, 1, 1, Vec3(14 * mm, 12 * mm, 9 * mm))
                           : test::block_mesh(3, 3, 1, Vec3(60 * mm, 60 * mm, 20 * mm));
  });
}

/// Moves everything at random by about `size` [m].
Increment random_increment(const Model& model, const State& iterate, double size, test::Random& random) {
  Increment increment;
  const auto numbers = [&](Eigen::Index count, double most) {
    return Eigen::VectorXd(Eigen::VectorXd::NullaryExpr(count, [&] { return random(-most, most); }));
  };
  for (const SolidState& solid : iterate.solids)
    increment.dx.push_back(numbers(solid.x.size(), size).reshaped(3, solid.x.cols()));
  increment.reduced.dz = numbers(model.unknowns, size);
  for (std::size_t i = 0; i < iterate.bodies.size(); ++i)
    increment.reduced.dz.segment<3>(model.bodies[i].unknown + 3) /= 10 * mm;
  increment.reduced.dlambda = Eigen::VectorXd::Zero(model.rows);
  for (const RodModel& rod : model.rods)
    increment.reduced.dq.push_back(numbers(rod.rod.strain_coordinates(), size / (50 * mm) / (50 * mm)));
  for (const ContactState& own : iterate.contacts)
    increment.forces.contacts.push_back({own.force, Vec3::Zero(), own.normal});
  return increment;
}

/// What contacts leave unbalanced, as the equations of everything have it; and the tangent of rods.
struct Residual {
  std::vector<Eigen::Matrix3Xd> nodes;
  std::vector<Eigen::VectorXd> rods;
  std::vector<Eigen::MatrixXd> tangents;
  Eigen::VectorXd z;
};
Residual residual(const StepContext& context, const State& iterate, const std::vector<Touch>& touches) {
  Residual own;
  for (std::size_t i = 0; i < iterate.solids.size(); ++i) {
    SolidForces with, without;
    solid_forces(context, iterate, touches, static_cast<int>(i), with);
    solid_forces(context, iterate, {}, static_cast<int>(i), without);
    own.nodes.push_back(with.nodal.sum - without.nodal.sum);
  }
  Reduced with, without;
  linearize(context, iterate, touches, with);
  linearize(context, iterate, {}, without);
  own.z = with.problem.r - without.problem.r;
  for (std::size_t i = 0; i < iterate.rods.size(); ++i) {
    own.rods.push_back(with.problem.chains[i].r - without.problem.chains[i].r);
    own.tangents.push_back(linalg::dense(with.problem.chains[i].chain) -
                           linalg::dense(without.problem.chains[i].chain));
  }
  return own;
}

/// How many pairs of kinds of objects have been pressed, in all placements.
using Met = std::set<std::pair<int, int>>;

/// R(x + dx) - R(x) = A_c dx + E, but for what is of second order in dx where rods bend.
void tangent_is_that_of_differences(const Model& model, double friction, test::Random& random, Met& met) {
  constexpr double kStep = 1e-8;  // [m]
  const State start = initial_state(model);
  StepContext context = make_context(model, start, command_at(model, 0.01), 0.01);
  State iterate = start;
  ContactRoom room;
  find_contacts(context, iterate, room, 20 * mm);
  advance_by(context, random_increment(model, iterate, 0.3 * mm, random), 1.0, iterate);
  evaluate_contacts(context, iterate, room);
  for (std::size_t i = 0; i < iterate.contacts.size(); ++i) {
    // (Far ones are as good as near ones, but where the normal is that between two points they turn less.)
    const double n = random(0.1, 2.0), angle = random(0.0, 6.2), slides = random(0.0, 1.0);
    ContactState& own = iterate.contacts[i];
    own.force =
        room.touches[i].frame * n * Vec3(1.0, friction * slides * std::cos(angle), friction * slides * std::sin(angle));
    own.normal = room.touches[i].nearest.normal;
    met.insert(std::minmax(static_cast<int>(own.a.on.kind), static_cast<int>(own.b.on.kind)));
  }
  evaluate_contacts(context, iterate, room);
  add_contact_curvature(context, iterate, room);
  const Increment increment = random_increment(model, iterate, kStep, random);
  // Forces that A knows of, and half as much again of all the same.
  ContactRoom pressed = room, there;
  State trial = iterate;
  std::vector<Vec3> forces_here, more, forces_there;
  for (std::size_t i = 0; i < room.touches.size(); ++i) {
    forces_here.push_back(room.touches[i].force);
    more.push_back(0.5 * forces_here.back());
    pressed.touches[i].force = trial.contacts[i].force = forces_here.back() + more.back();
    trial.contacts[i].normal = room.touches[i].nearest.normal;
  }
  advance_reduced(context, increment.reduced, 1.0, trial);
  for (std::size_t s = 0; s < trial.solids.size(); ++s) trial.solids[s].x += increment.dx[s];
  there.start = room.start;
  there.facings = room.facings;
  there.least = room.least;
  evaluate_contacts(context, trial, there);
  for (const Touch& touch : there.touches) forces_there.push_back(touch.force);
  ContactsBeyond beyond;
  contacts_beyond_tangent(model, {iterate, room, forces_here}, more, {trial, there, forces_there},
                          std::vector<char>(iterate.solids.size(), 1), increment.dx, increment.reduced, beyond);

  const Residual known = residual(context, iterate, room.touches), from = residual(context, iterate, pressed.touches),
                 to = residual(context, trial, there.touches);
  constexpr double kRelative = 1e-5;
  for (std::size_t s = 0; s < iterate.solids.size(); ++s) {
    Eigen::Matrix3Xd sum = beyond.nodes[s];  // E + A_c dx
    for (std::size_t i = 0; i < room.touches.size(); ++i) {
      const contact::GapHessian& K = room.touches[i].stiffness;
      if (K.rows() == 0) continue;
      Eigen::Index first = 0;
      for (const ContactSide& side : {iterate.contacts[i].a, iterate.contacts[i].b}) {
        const int corners = side.local.corners();
        if (side.on == Collider{Collider::Kind::solid, static_cast<int>(s)}) {
          for (int k = 0; k < corners; ++k) {
            for (int l = 0; l < corners; ++l)
              sum.col(side.nodes[k]) +=
                  K.block<3, 3>(first + 3 * k, first + 3 * l) * increment.dx[s].col(side.nodes[l]);
          }
        }
        first += 3 * corners;
      }
    }
    const Eigen::Matrix3Xd change = to.nodes[s] - from.nodes[s];
    EXPECT_LT((sum - change).cwiseAbs().maxCoeff(), kRelative * change.cwiseAbs().maxCoeff()) << "solid " << s;
  }
  for (std::size_t r = 0; r < iterate.rods.size(); ++r) {
    const Eigen::VectorXd change = to.rods[r] - from.rods[r],
                          sum = beyond.rods[r] + known.tangents[r] * increment.reduced.dq[r];
    EXPECT_LT((sum - change).cwiseAbs().maxCoeff(), 10 * kRelative * change.cwiseAbs().maxCoeff()) << "rod " << r;
  }
  const Eigen::VectorXd change = to.z - from.z;
  EXPECT_LT((beyond.z - change).cwiseAbs().maxCoeff(), kRelative * change.cwiseAbs().maxCoeff());
}

void tangents_are_those_of_differences(int placements) {
  test::Random random(7);
  Met met;
  for (const double friction : {0.0, 0.6}) {
    for (const BodyShape& shape :
         {BodyShape(SphereShape{8 * mm}), BodyShape(CapsuleShape{6 * mm, 10 * mm}),
          BodyShape(BoxShape{Vec3(14 * mm, 12 * mm, 10 * mm)}), BodyShape(CylinderShape{7 * mm, 10 * mm}),
          BodyShape(MeshShape{"stone", 1.0, true}), BodyShape(MeshShape{"stone", 1.0, false})}) {
      const Model model = crowd(shape, friction);
      for (int i = 0; i < placements && !testing::Test::HasFailure(); ++i)
        tangent_is_that_of_differences(model, friction, random, met);
    }
  }
  EXPECT_EQ(met.size(), 9u);  // all but obstacles with each other
}

// E and e as one vector: forces [N] of solids and rods, those of z, and rows, each in its units.
TEST(ContactCorrection, units_go_and_come_back) {
  const Model model = crowd(SphereShape{8 * mm}, 0.0);
  constexpr double kForce = 3.0;
  ContactsBeyond beyond;
  clear(model, beyond);
  beyond.u.setZero(6);
  beyond.u[4] = model.size;
  beyond.z[1] = kForce * model.arms[1];
  Eigen::VectorXd x;
  without_units(model, kForce, beyond, x);
  ASSERT_GT(x.size(), 12);
  EXPECT_EQ(x.cwiseAbs().sum(), 2.0);
  EXPECT_EQ(x[x.size() - 2], 1.0);
  EXPECT_EQ(x[x.size() - 6 - beyond.z.size() + 1], 1.0);

  test::Random random(11);
  for (double& value : x) value = random(-2.0, 2.0);
  with_units(model, kForce, x, beyond);
  EXPECT_NEAR(beyond.u[4], x[x.size() - 2] * model.size, 1e-15);
  for (const Eigen::Matrix3Xd& nodes : beyond.nodes) EXPECT_GT(nodes.norm(), 0.0);
  for (const Eigen::VectorXd& strains : beyond.rods) EXPECT_GT(strains.norm(), 0.0);
  Eigen::VectorXd back;
  without_units(model, kForce, beyond, back);
  ASSERT_EQ(back.size(), x.size());
  EXPECT_LT((back - x).cwiseAbs().maxCoeff(), 1e-14);
}

TEST(ContactTangent, is_that_of_differences) { tangents_are_those_of_differences(4); }
// SINEW_PLACEMENTS: of each of six shapes, with friction and without; 834 of them are ten thousand, in five minutes.
TEST(ContactTangent, is_that_of_differences_in_many_placements_slow) {
  const char* const wanted = std::getenv("SINEW_PLACEMENTS");
  tangents_are_those_of_differences(wanted ? std::atoi(wanted) : 100);
}

}  // namespace
}  // namespace sinew
