// A rod that is touched at one place has one contact there.
#include <gtest/gtest.h>

#include <algorithm>

#include "sinew/sim/contacts.hpp"
#include "support/scenes.hpp"

namespace sinew {
namespace {

using test::mm;

/// A ball rests on a straight rod of ten sections, a little beside the end of one.
Scene ball_on_rod() {
  Scene scene = test::lone_rod();
  Obstacle ball;
  ball.shape = SphereShape{20 * mm};
  ball.pose.translate = Vec3(0.255, 0, 25 * mm);
  scene.obstacles.emplace_back("ball", ball);
  scene.contact.pairs.push_back({"rod", "ball", {}, {}});
  return scene;
}

TEST(ContactMerging, the_piece_stays_and_takes_over_the_force_of_the_point) {
  const Model model = build(ball_on_rod(), test::read_block);
  const StepContext context = make_context(model, initial_state(model), command_at(model, 0.01), 0.01);
  State found = context.start;
  ContactRoom room;
  find_contacts(context, found, room, 3 * mm);
  ASSERT_EQ(found.contacts.size(), 1u);
  ASSERT_EQ(room.found.size(), 2u);
  const ContactState& kept = found.contacts[0];
  const bool rod_first = kept.a.on.kind == Collider::Kind::rod;
  EXPECT_EQ((rod_first ? kept.a : kept.b).local.corners(), 2);

  const auto gone =
      std::find_if(room.found.begin(), room.found.end(), [&](const auto& own) { return own.second != kept.part; });
  ASSERT_NE(gone, room.found.end());
  State pressed = context.start;
  ContactState& point = pressed.contacts.emplace_back();  // the rod is its first side: the ball presses it down
  point.pair = gone->first;
  point.part = gone->second;
  point.normal = -Vec3::UnitZ();
  point.force = -2.0 * Vec3::UnitZ();
  find_contacts(context, pressed, room, 3 * mm);
  ASSERT_EQ(pressed.contacts.size(), 1u);
  const Vec3 on_rod = (rod_first ? 1.0 : -1.0) * pressed.contacts[0].force;
  EXPECT_EQ(on_rod, -2.0 * Vec3::UnitZ());
  EXPECT_EQ(pressed.contacts[0].normal, 0.5 * pressed.contacts[0].force);
}

TEST(ContactMerging, velocities_lead_as_far_as_nothing_comes_a_tenth_of_a_thickness_into_something) {
  Scene scene = ball_on_rod();
  scene.obstacles[0].second.pose.translate = Vec3(0.255, 0, 27 * mm);
  const Model model = build(scene, test::read_block);
  State start = initial_state(model);
  start.rods[0].velocity.row(2).setConstant(0.5);  // 5 mm in the step, 2 mm from the ball
  const StepContext context = make_context(model, start, command_at(model, 0.01), 0.01);
  State found = context.start;
  ContactRoom room;
  find_contacts(context, found, room, 20 * mm);
  EXPECT_NEAR(room.clear, (2 * mm + 0.1 * 10 * mm) / (5 * mm), 1e-6);
}

}  // namespace
}  // namespace sinew
