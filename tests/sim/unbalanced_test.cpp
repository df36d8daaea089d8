// What an iteration that did not converge leaves is named by where it is.
#include "sinew/sim/unbalanced.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "sinew/sim/newton.hpp"
#include "support/contacts.hpp"
#include "support/scenes.hpp"

namespace sinew {
namespace {

using test::mm;
using testing::HasSubstr;
using testing::MatchesRegex;

/// The detail of a step that has so few iterations that it fails.
std::string left_of(Scene scene, int limit, const solid::Mesh& mesh = {}) {
  scene.newton.limit = limit;
  const Model model = build(scene, [&](const std::filesystem::path&) { return mesh; });
  Workspace workspace = make_workspace(model);
  const double h = scene.time.step;
  const StepResult result = step(model, workspace, command_at(model, h), initial_state(model), h);
  EXPECT_EQ(result.report.status, Status::max_iterations);
  return result.report.detail;
}

TEST(Unbalanced, NamesTheNodeOfASolid) {
  Scene scene = test::cable_block();
  scene.rods.clear();
  scene.couplings.clear();
  scene.actuators.clear();
  scene.gravity = Vec3(0, 0, -500.0);
  EXPECT_THAT(
      left_of(scene, 1, test::read_block("")),
      MatchesRegex("solids\\.[a-z]+, node [0-9]+, at rest near \\(.*\\) m: .* N are not balanced, .* of the largest "
                   "force"));
}

TEST(Unbalanced, NamesTheSectionOfARod) {
  Scene scene = test::lone_rod();
  scene.gravity = Vec3(0, 0, -500.0);
  EXPECT_THAT(left_of(scene, 1), MatchesRegex("rods\\.[a-z]+ from .* to .* mm: .* N are not balanced, .*"));
}

TEST(Unbalanced, NamesTheConstraintThatIsMissed) {
  Scene scene = test::lone_rod();
  Frame hand;
  hand.motion = FrameMotion{{0.0, 0.01}, {}, {Vec3::Zero(), Vec3(0, 0, 40 * mm)}};
  scene.frames.emplace_back("hand", hand);
  Tie tie;
  tie.rod = "rod";
  tie.frame = "hand";
  scene.couplings.emplace_back(tie);
  EXPECT_EQ(left_of(scene, 0), "couplings.0: missed by 40 mm");
}

TEST(Unbalanced, NamesThePairWithMostContacts) {
  Scene scene = test::on_floor(0.01, 0.1, 0.3);
  scene.bodies.emplace_back("one", test::box_of(10 * mm, 0.1, Vec3(0, 0, 5 * mm)));
  scene.bodies.emplace_back("two", test::box_of(10 * mm, 0.1, Vec3(0, 0, 20 * mm)));
  const Model model = build(scene, {});
  State state = initial_state(model);
  EXPECT_EQ(too_many_contacts(model, state), "contacts are too much work");
  for (const int pair : {0, 1, 1, 1, 2}) state.contacts.emplace_back().pair = pair;
  EXPECT_EQ(too_many_contacts(model, state),
            "5 contacts are too much work, 3 of them of " + name_of_pair(model, 1) +
                "; give simpler shapes (`hull: true`), or begin where they do not overlap");
}

TEST(Unbalanced, NamesTheContactAndItsPlace) {
  Scene scene = test::on_floor(0.01, 0.1, 0.3);
  scene.gravity.setZero();
  RigidBody ball;
  ball.shape = SphereShape{20 * mm};
  ball.mass = 0.1;
  ball.pose.translate = Vec3(100 * mm, 0, 18 * mm);
  scene.bodies.emplace_back("ball", ball);
  EXPECT_THAT(left_of(scene, 0),
              MatchesRegex("the contact of (ball and floor|floor and ball) near \\(0\\.1, 0, .*\\) m.*"));
}

TEST(Unbalanced, CountsWhatComesAndGoes) {
  ComingAndGoing own;
  std::vector<ContactState> contacts(2);
  own.begin();
  for (int i = 0; i < 6; ++i) {
    contacts[0].force = Vec3::UnitX();
    contacts[1].force = i % 2 == 0 ? Vec3(Vec3::Zero()) : Vec3(Vec3::UnitX());
    own.look(contacts);
  }
  EXPECT_EQ(own.turns(), (std::vector<int>{0, 5}));
}

}  // namespace
}  // namespace sinew
