// The list of outputs: nothing twice, nothing without a word, and as many numbers as columns.
#include "sinew/sim/quantities.hpp"

#include <gtest/gtest.h>

#include <set>

#include "sinew/sim/signals.hpp"
#include "support/robots.hpp"

namespace sinew::test {
namespace {

TEST(Quantities, stand_once_each_with_a_word_and_units) {
  std::set<std::pair<Quantity, Subject>> seen;
  for (const OutputKind& own : output_kinds()) {
    EXPECT_TRUE(seen.insert({own.quantity, own.subject}).second);
    EXPECT_FALSE(own.columns.empty());
    std::set<std::string> names;
    for (const Column& column : own.columns) {
      EXPECT_TRUE(names.insert(column.name).second) << column.name;
      EXPECT_FALSE(column.unit.empty()) << column.name;
    }
    int words = 0;
    for (const auto& [word, quantity] : quantity_words()) words += quantity == own.quantity ? 1 : 0;
    EXPECT_EQ(words, own.subject == Subject::pair ? 0 : 1);
  }
  for (const auto& [word, quantity] : quantity_words()) {
    bool known = false;
    for (const Subject subject : {Subject::solid, Subject::rod, Subject::body})
      known |= find_kind(quantity, subject) != nullptr;
    EXPECT_TRUE(known) << word;
  }
}

TEST(Quantities, give_a_number_for_every_column) {
  Scene scene = block();
  scene.time = {0.01, 0.01};
  RigidBody cube;
  cube.shape = BoxShape{Vec3::Constant(2 * mm)};
  cube.density = 1000.0;
  cube.pose.translate = Vec3(0, 0, 50 * mm);
  scene.bodies.emplace_back("cube", cube);
  Obstacle floor;
  floor.shape = PlaneShape{Vec3(0, 0, -100 * mm), Vec3::UnitZ()};
  scene.obstacles.emplace_back("floor", floor);
  for (const OutputKind& own : output_kinds()) {
    Output output;
    output.quantity = own.quantity;
    if (own.subject == Subject::solid) output.solid = "body";
    if (own.subject == Subject::solid) output.point.x = Vec3(25 * mm, 5 * mm, 5 * mm);
    if (own.subject == Subject::rod) output.rod = "cable";
    if (own.subject == Subject::body) output.body = "cube";
    if (own.subject == Subject::pair) output.between = {"cube", "floor"};
    if (own.subject == Subject::pair) output.quantity = Quantity::position;  // goes without saying
    scene.outputs.emplace_back("output" + std::to_string(scene.outputs.size()), output);
  }
  const Model model = build(scene, block_of(600));
  const State state = initial_state(model);
  for (const OutputModel& output : model.outputs) {
    const OutputKind& kind = kind_of(output);
    EXPECT_EQ(kind.values(model, state, output).size(), kind.columns.size()) << output.name;
  }
  EXPECT_EQ(signal_values(model, state).size(), signal_columns(model).size());
}

}  // namespace
}  // namespace sinew::test
