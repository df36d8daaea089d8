// What contacts do to the equations of solids, rigid bodies and rods.
#include <gtest/gtest.h>

#include <Eigen/Dense>

#include "sinew/sim/linearization.hpp"
#include "support/scenes.hpp"

namespace sinew {
namespace {

using test::mm;

/// A soft slab, a rigid cube on it and a rod that lies on both; nothing is held, and all have just come to touch.
Scene heap_of_all(double friction) {
  Scene scene;
  scene.time = {0.01, 1.0};
  scene.contact.friction = friction;
  Solid slab;
  slab.mesh = "slab";
  slab.material.law = solid::corotational(1e5, 0.3);
  slab.density = 1000.0;
  scene.solids.emplace_back("slab", slab);
  RigidBody cube;
  cube.shape = BoxShape{Vec3::Constant(20 * mm)};
  cube.mass = 0.02;
  cube.pose.translate = Vec3(20 * mm, 30 * mm, 29.9 * mm);
  scene.bodies.emplace_back("cube", cube);
  Rod rod;
  rod.path = {Vec3(45 * mm, 5 * mm, 21.9 * mm), Vec3(45 * mm, 55 * mm, 21.9 * mm)};
  rod.sections = 6;
  rod.section = Circle{2 * mm};
  rod.material = {1e6, 0.4, 1000.0, 0.0};
  rod.base = {BaseAxis::x, BaseAxis::y, BaseAxis::z, BaseAxis::turn_x, BaseAxis::turn_y, BaseAxis::turn_z};
  scene.rods.emplace_back("rod", rod);
  RigidBody bar;
  bar.shape = BoxShape{Vec3(20 * mm, 10 * mm, 10 * mm)};
  bar.mass = 0.02;
  bar.pose.translate = Vec3(45 * mm, 33 * mm, 28.8 * mm);
  scene.bodies.emplace_back("bar", bar);
  for (const auto& [first, second] : {std::pair("slab", "rod"), std::pair("rod", "bar")}) {
    ContactPair pair;
    pair.first = first;
    pair.second = second;
    scene.contact.pairs.push_back(pair);
  }
  return scene;
}

struct Wrench {
  Vec3 force = Vec3::Zero(), moment = Vec3::Zero();  ///< about the world's origin
  void add(const Vec3& f, const Vec3& m) {
    force += f;
    moment += m;
  }
};

/// What stands in the equations of everything, added up for each kind of body.
std::vector<Wrench> felt(const StepContext& context, const State& iterate, const std::vector<Touch>& touches) {
  std::vector<Wrench> all(3);
  SolidForces solid;
  solid_forces(context, iterate, touches, 0, solid);
  for (Eigen::Index i = 0; i < solid.nodal.sum.cols(); ++i) {
    const Vec3 f = solid.nodal.sum.col(i), x = iterate.solids[0].x.col(i);
    all[0].add(f, x.cross(f));
  }
  Reduced reduced;
  linearize(context, iterate, touches, reduced);
  for (std::size_t i = 0; i < iterate.bodies.size(); ++i) {
    const Eigen::VectorXd r = reduced.problem.r.segment<6>(context.model.bodies[i].unknown);
    all[1].add(r.head<3>(), Vec3(r.tail<3>()) + iterate.bodies[i].p.cross(Vec3(r.head<3>())));
  }
  // The rod's base stands as in the world, so that its coordinates are the sums over all that hangs on it.
  const Eigen::VectorXd r = reduced.problem.r.segment<6>(context.model.rods[0].unknown);
  const Vec3 base(45 * mm, 5 * mm, 21.9 * mm);
  const rod::Mat3 R = context.bases[0].R;
  const Vec3 force = R * r.head<3>(), moment = R * r.tail<3>();
  all[2].add(force, moment + base.cross(force));
  return all;
}

TEST(ContactForces, ActionIsReaction) {
  for (const double friction : {0.0, 0.4}) {
    const Model model = build(heap_of_all(friction),
                              [](const auto&) { return test::block_mesh(6, 6, 2, Vec3(60 * mm, 60 * mm, 20 * mm)); });
    const State start = initial_state(model);
    const StepContext context = make_context(model, start, command_at(model, 0.01), 0.01);
    State iterate = start;
    ContactRoom room;
    find_contacts(context, iterate, room, alarm_distance(context));
    double largest = 0.0;
    for (std::size_t i = 0; i < iterate.contacts.size(); ++i) {
      evaluate_contacts(context, iterate, room);
      const double n = 1.0 + 0.1 * static_cast<double>(i % 7);
      iterate.contacts[i].force = room.touches[i].frame * Vec3(n, 0.7 * friction * n, -0.5 * friction * n);
      iterate.contacts[i].normal = room.touches[i].nearest.normal;
      largest += n;
    }
    evaluate_contacts(context, iterate, room);
    const std::vector<Wrench> with = felt(context, iterate, room.touches), without = felt(context, iterate, {});
    Wrench sum;
    for (std::size_t k = 0; k < with.size(); ++k) {
      const Vec3 force = with[k].force - without[k].force, moment = with[k].moment - without[k].moment;
      EXPECT_GT(force.norm(), 1.0) << k;  // each kind is touched
      sum.add(force, moment);
    }
    EXPECT_LT(sum.force.norm(), 1e-12 * largest) << friction;
    // Friction acts on both surfaces, a gap apart, which is its moment.
    const double arm = friction > 0.0 ? 1 * mm : 1e-12;
    EXPECT_LT(sum.moment.norm(), arm * largest) << friction;
  }
}

}  // namespace
}  // namespace sinew
