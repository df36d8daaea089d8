#include "sinew/contact/tree.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

namespace sinew::contact {
namespace {

using Vec3 = Eigen::Vector3d;

Vec3 random_point(std::mt19937& random) {
  std::uniform_real_distribution<double> any(-1.0, 1.0);
  const double x = any(random), y = any(random), z = any(random);
  return {x, y, z};
}

std::vector<Box> random_boxes(std::mt19937& random, int count, double size) {
  std::vector<Box> boxes;
  for (int i = 0; i < count; ++i) {
    const Vec3 at = random_point(random);
    boxes.emplace_back(at, at + size * random_point(random).cwiseAbs());
  }
  return boxes;
}

void expect_all(const Tree& tree, const std::vector<Box>& boxes, const Box& asked) {
  std::vector<int> found, expected;
  tree.each_near(asked, [&](int i) { found.push_back(i); });
  std::sort(found.begin(), found.end());
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    if (boxes[i].intersects(asked)) expected.push_back(static_cast<int>(i));
  }
  EXPECT_EQ(found, expected);
}

TEST(Tree, FindsWhatLookingAtEveryBoxFinds) {
  std::mt19937 random(1);
  for (const int count : {1, 2, 3, 17, 1000}) {
    std::vector<Box> boxes = random_boxes(random, count, 0.1);
    Tree tree(boxes);
    for (int turn = 0; turn < 3; ++turn) {
      for (const Box& asked : random_boxes(random, 50, 0.5)) expect_all(tree, boxes, asked);
      EXPECT_TRUE(std::all_of(boxes.begin(), boxes.end(), [&](const Box& b) { return tree.whole().contains(b); }));
      boxes = random_boxes(random, count, 0.1);
      tree.fit(boxes);
    }
  }
}

TEST(Tree, OfBoxesAllAlikeIsAsGood) {
  const std::vector<Box> boxes(100, Box(Vec3::Zero(), Vec3::Ones()));
  const Tree tree(boxes);
  expect_all(tree, boxes, Box(Vec3::Constant(0.5), Vec3::Constant(2.0)));
  expect_all(tree, boxes, Box(Vec3::Constant(1.5), Vec3::Constant(2.0)));
}

TEST(Tree, OfNothingFindsNothing) {
  const Tree tree{std::vector<Box>{}};
  expect_all(tree, {}, Box(Vec3::Zero(), Vec3::Ones()));
  EXPECT_TRUE(tree.whole().isEmpty());
}

}  // namespace
}  // namespace sinew::contact
