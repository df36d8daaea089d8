#include "sinew/error/warning.hpp"

#include <gtest/gtest.h>

#include <limits>

namespace sinew {
namespace {

Warning pushes(double time, double value) {
  return {.code = "tendon_pushes",
          .where = "actuators.a",
          .message = "pushes with " + std::to_string(value),
          .remedy = "pull",
          .time = time,
          .value = value,
          .limit = 0.0,
          .unit = "N",
          .steps = 1};
}

TEST(Warnings, the_same_kind_on_the_same_object_is_one_with_its_first_time_and_its_worst_value) {
  std::vector<Warning> list;
  for (const auto& [time, value] : {std::pair(0.1, 1.0), std::pair(0.2, 3.0), std::pair(0.3, 2.0)})
    merge(pushes(time, value), list);
  Warning other = pushes(0.2, 5.0);
  other.where = "actuators.b";
  merge(other, list);
  ASSERT_EQ(list.size(), 2U);
  EXPECT_EQ(list[0].time, 0.1);
  EXPECT_EQ(list[0].value, 3.0);
  EXPECT_EQ(list[0].message, pushes(0.0, 3.0).message);
  EXPECT_EQ(list[0].steps, 3);
  EXPECT_EQ(list[1].value, 5.0);
  EXPECT_EQ(find_warning(list, "tendon_pushes", "actuators.b"), &list[1]);
  EXPECT_EQ(find_warning(list, "tendon_pushes"), &list[0]);
  EXPECT_EQ(find_warning(list, "penetration"), nullptr);
}

TEST(Warnings, are_told_with_object_time_and_remedy) {
  EXPECT_EQ(to_string(pushes(0.25, 1.0)), "actuators.a: pushes with 1.000000 (from t = 0.25 s); pull");
  Warning bare{.code = "unstable", .message = "the equilibrium is unstable"};
  EXPECT_EQ(to_string(bare), "the equilibrium is unstable");
  EXPECT_EQ(bare, bare);  // though its numbers are none
  EXPECT_FALSE(bare == pushes(0.25, 1.0));
}

}  // namespace
}  // namespace sinew
